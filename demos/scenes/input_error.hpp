// SPDX-License-Identifier: Zlib
#pragma once

// What is wrong with something the user handed in: a file, a name, a number.

#include <stdexcept>
#include <string>
#include <system_error>

namespace hashphase::demos {

/// what() is a sentence that names the fault, its place, and what would be right.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// What the system says of an `errno`, to follow what cannot be done: ": Permission denied". Empty for 0.
[[nodiscard]] inline std::string reasonOf(int error) {
    return error == 0 ? "" : ": " + std::generic_category().message(error);
}

}  // namespace hashphase::demos
