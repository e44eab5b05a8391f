// SPDX-License-Identifier: Zlib
#pragma once

#include <array>
#include <cstdint>

namespace hashphase {

/// The axis that points upwards.
enum class UpAxis : std::uint8_t { x, y, z };

/// Returns the two horizontal axes, as on a map, in ascending order: 0 is x, 1 is y, 2 is z.
[[nodiscard]] constexpr std::array<int, 2> mapAxes(UpAxis up) noexcept {
    return {up == UpAxis::x ? 1 : 0, up == UpAxis::z ? 1 : 2};
}

}  // namespace hashphase
