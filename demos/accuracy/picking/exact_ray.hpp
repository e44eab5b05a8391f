// SPDX-License-Identifier: Zlib
#pragma once

// The truth about a ray and a box, in integers: nothing is rounded.
//
// Exact for coordinates that are multiples of kLattice and below 2^40 of them.

#include <broadphase/aabb.hpp>

#include <array>
#include <compare>
#include <cstdint>
#include <optional>

namespace hashphase::demos {

inline constexpr float kLattice = 0x1p-13F;  // [m]

/// A share of a ray's length.
class Fraction {
public:
    /// The denominator is not 0.
    Fraction(std::int64_t numerator, std::int64_t denominator)
        : numerator_(denominator < 0 ? -numerator : numerator),
          denominator_(denominator < 0 ? -denominator : denominator) {}

    /// Rounded.
    [[nodiscard]] double value() const {
        return static_cast<double>(numerator_) / static_cast<double>(denominator_);
    }

    friend std::strong_ordering operator<=>(const Fraction& a, const Fraction& b);
    friend bool operator==(const Fraction& a, const Fraction& b) { return (a <=> b) == 0; }

private:
    std::int64_t numerator_;
    std::int64_t denominator_;  // above 0
};

/// The segment between two points, closed.
class ExactRay {
public:
    /// Throws std::logic_error for coordinates beside the lattice.
    ExactRay(const Vector3<float>& from, const Vector3<float>& to);

    /// Where the ray enters the closed box, 0 when it begins inside; nothing when it misses it.
    [[nodiscard]] std::optional<Fraction> entry(const Aabb<float>& box) const;

private:
    std::array<std::int64_t, 3> from_;
    std::array<std::int64_t, 3> direction_;
};

}  // namespace hashphase::demos
