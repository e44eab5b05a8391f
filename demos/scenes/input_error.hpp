// SPDX-License-Identifier: Zlib
#pragma once

// What is wrong with something the user handed in: a file, a name, a number.

#include <stdexcept>

namespace hashphase::demos {

/// what() is a sentence that names the fault, its place, and what would be right.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace hashphase::demos
