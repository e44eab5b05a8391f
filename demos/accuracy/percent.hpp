// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase::demos {

/// 0 of nothing is 0 %.
[[nodiscard]] inline double percentOf(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace hashphase::demos
