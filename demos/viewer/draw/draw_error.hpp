// SPDX-License-Identifier: Zlib
#pragma once

// Why there is no picture.

#include <stdexcept>

namespace hashphase::demos {

/// what() is a sentence that names what failed and, where something can be done, what.
class DrawError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace hashphase::demos
