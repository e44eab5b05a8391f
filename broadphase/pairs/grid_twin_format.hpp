// SPDX-License-Identifier: Zlib
#pragma once

// What the bytes of a grid begin with, and what they say of an index.

#include <broadphase/core/sealed_bytes.hpp>

#include <cstdint>

namespace hashphase::detail {

inline constexpr Seal kGridSeal{0x31737068'64697267, 1, "a snapshot of a grid"};

// Flags of an index.
inline constexpr std::uint8_t kIsAlive = 1;
inline constexpr std::uint8_t kWasSeen = 2;  // it had a proxy at the last update
inline constexpr std::uint8_t kSweeps = 4;   // since that update
inline constexpr std::uint8_t kRestsAtOnce = 8;

}  // namespace hashphase::detail
