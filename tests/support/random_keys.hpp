// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>
#include <random>

namespace hashphase::test {

// Few different keys, so that they meet again; some at both ends of the range.
inline std::uint64_t randomKey(std::mt19937_64& random) {
    const std::uint64_t small = random() % 700;
    return random() % 2 == 0 ? small << 32 | (small + 1) : ~std::uint64_t{0} - small;
}

}  // namespace hashphase::test
