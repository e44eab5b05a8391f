// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace hashphase::demos {

/// RFC 4648, padded.
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace hashphase::demos
