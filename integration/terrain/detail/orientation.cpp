// SPDX-License-Identifier: Zlib
#include <integration/terrain/detail/orientation.hpp>

#include <array>
#include <cstddef>

namespace hashphase::detail {
namespace {

/// A sum without rounding: numbers of which none overlaps another, smallest first.
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
    std::array<double, 12> parts_{};
    std::size_t count_ = 0;
};

}  // namespace

double exactOrientation(const Point2& a, const Point2& b, const Point2& c) noexcept {
    Expansion sum;
    sum.addProduct(a.x, b.z);
    sum.addProduct(-a.z, b.x);
    sum.addProduct(b.x, c.z);
    sum.addProduct(-b.z, c.x);
    sum.addProduct(c.x, a.z);
    sum.addProduct(-c.z, a.x);
    return sum.value();
}

}  // namespace hashphase::detail
