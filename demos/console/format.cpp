// SPDX-License-Identifier: Zlib
#include <demos/console/format.hpp>

#include <array>
#include <cmath>
#include <cstdio>

namespace hashphase::demos {

std::string withThousands(std::uint64_t number) {
    const std::string digits = std::to_string(number);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) {
            text += ',';
        }
        text += digits[i];
    }
    return text;
}

std::string fixed(double number, int digits) {
    std::array<char, 400> text{};
    std::snprintf(text.data(), text.size(), "%.*f", digits, number);
    return text.data();
}

std::string plain(double number) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.15g", number);
    return text.data();
}

std::string milliseconds(double number) {
    const double size = std::abs(number);
    if (size >= 99.95) {
        return fixed(number, 0);
    }
    return fixed(number, size >= 9.995 ? 1 : size >= 0.9995 ? 2 : size >= 0.09995 ? 3 : 4);
}

std::string byteSize(std::int64_t bytes) {
    constexpr std::array kUnits{"B", "KiB", "MiB", "GiB"};
    auto size = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (std::abs(size) >= 1024 && unit + 1 < kUnits.size()) {
        size /= 1024;
        ++unit;
    }
    const int digits = unit == 0 || std::abs(size) >= 100 ? 0 : std::abs(size) >= 10 ? 1 : 2;
    return fixed(size, digits) + " " + kUnits[unit];
}

}  // namespace hashphase::demos
