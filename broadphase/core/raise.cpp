// SPDX-License-Identifier: Zlib
#include <broadphase/core/raise.hpp>

#include <broadphase/core/raise.inl>

#include <stdexcept>

namespace hashphase::detail {

void raiseLengthError(const char* sentence) {
    raise(std::length_error(sentence));
}

void raiseInvalidArgument(const std::string& sentence) {
    raise(std::invalid_argument(sentence));
}

void raiseOutOfRange(const char* sentence) {
    raise(std::out_of_range(sentence));
}

}  // namespace hashphase::detail
