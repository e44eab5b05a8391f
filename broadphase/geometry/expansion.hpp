// SPDX-License-Identifier: Zlib
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace hashphase::detail {

/// A sum without rounding: numbers of which none overlaps another, smallest first. Holds as long as
/// no part is below the smallest normal number. After J. R. Shewchuk, "Adaptive Precision
/// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997.
template <std::size_t kMostParts>
class Expansion {
public:
    void add(double number) noexcept {
        // Shewchuk's Grow-Expansion, by Knuth's Two-Sum.
        double sum = number;
        for (std::size_t i = 0; i < count_; ++i) {
            const double total = sum + parts_[i];
            const double ofPart = total - sum;
            parts_[i] = (sum - (total - ofPart)) + (parts_[i] - ofPart);
            sum = total;
        }
        parts_[count_++] = sum;
    }

    void addProduct(double a, double b) noexcept {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }

    /// Rounded, with the sum's sign: the largest part that is not 0 outweighs all others.
    [[nodiscard]] double value() const noexcept {
        double sum = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            sum += parts_[i];
        }
        return sum;
    }

private:
    std::array<double, kMostParts> parts_{};
    std::size_t count_ = 0;
};

}  // namespace hashphase::detail
