// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>
#include <vector>

namespace hashphase::demos {

/// Appends the number in groups of seven bits, the lowest first, of which all but the last have bit 7
/// set: small numbers take one byte.
inline void appendGroups(std::vector<std::uint8_t>& bytes, std::uint32_t number) {
    while (number > 127) {
        bytes.push_back(static_cast<std::uint8_t>(number | 128U));
        number >>= 7;
    }
    bytes.push_back(static_cast<std::uint8_t>(number));
}

}  // namespace hashphase::demos
