// SPDX-License-Identifier: Zlib
#pragma once

// Numbers as people read them.

#include <cstdint>
#include <string>

namespace hashphase::demos {

/// 30000 -> "30,000".
[[nodiscard]] std::string withThousands(std::uint64_t number);

/// A number with that many digits after the point.
[[nodiscard]] std::string fixed(double number, int digits);

/// Milliseconds with three significant digits: "0.0123", "1.23", "12.3", "123".
[[nodiscard]] std::string milliseconds(double number);

/// A number with all its digits, up to 15, and no more: "0.1", "30000", "1e+20".
[[nodiscard]] std::string plain(double number);

/// Bytes as "123 B", "12.3 KiB", "4.56 MiB", "7.89 GiB"; may be negative.
[[nodiscard]] std::string byteSize(std::int64_t bytes);

}  // namespace hashphase::demos
