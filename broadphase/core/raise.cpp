// SPDX-License-Identifier: Zlib

#include <broadphase/core/raise.hpp>

#include <stdexcept>

namespace hashphase::detail {

void raiseLengthError(const char* sentence) {
    throw std::length_error(sentence);
}

void raiseInvalidArgument(const std::string& sentence) {
    throw std::invalid_argument(sentence);
}

}  // namespace hashphase::detail
