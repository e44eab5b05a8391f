// SPDX-License-Identifier: Zlib
#pragma once

#include <algorithm>
#include <cstddef>

namespace hashphase::detail {

/// Makes room for `count` elements in all, before something begins that must not be left half done.
/// At least doubled, or who asks for a few more each time would move all each time.
template <class Array>
void ensureCapacity(Array& array, std::size_t count) {
    if (array.capacity() < count) {
        array.reserve(std::max<std::size_t>(count, 2 * array.capacity()));
    }
}

/// Empties arrays and gives their memory back, which `array = {}` does not.
template <class... Arrays>
void freeArrays(Arrays&... arrays) noexcept {
    (Arrays().swap(arrays), ...);
}

}  // namespace hashphase::detail
