// SPDX-License-Identifier: Zlib
#pragma once

// When a point that moves straight on meets a box, in integers: nothing is rounded. The truth about
// rays and, as a box beside another one is a point beside a larger box, about boxes that move.

#include <broadphase/aabb.hpp>

#include <array>
#include <compare>
#include <cstdint>
#include <optional>

namespace hashphase::demos {

/// A share of a way.
struct Fraction {
    std::int64_t numerator = 0;
    std::int64_t denominator = 1;  // above 0

    /// Rounded.
    [[nodiscard]] double value() const {
        return static_cast<double>(numerator) / static_cast<double>(denominator);
    }
    /// How far a share that was computed lies from it.
    [[nodiscard]] double errorOf(double share) const;

    friend std::strong_ordering operator<=>(const Fraction& a, const Fraction& b);
    friend bool operator==(const Fraction& a, const Fraction& b) { return (a <=> b) == 0; }
    /// Rounded, but 0 only where they are equal.
    friend double operator-(const Fraction& a, const Fraction& b);
};

/// Multiples of a unit.
using WholePoint = std::array<std::int64_t, 3>;

/// The coordinate as a multiple of the unit, a power of two. Throws std::logic_error where it is
/// none, or more than `most` of them, up to 2^40.
[[nodiscard]] std::int64_t wholeUnits(float coordinate, float unit, float most);

/// Where on its way from 0 the point enters the closed box, 0 when it begins inside; nothing when
/// it misses it.
[[nodiscard]] std::optional<Fraction> exactEntry(const WholePoint& way, const WholePoint& low,
                                                 const WholePoint& high);

inline constexpr float kLattice = 0x1p-13F;  // [m]

/// The segment between two points, closed. Their coordinates, and those of boxes, are multiples of
/// kLattice: others throw std::logic_error.
class ExactRay {
public:
    ExactRay(const Vector3<float>& from, const Vector3<float>& to);

    [[nodiscard]] std::optional<Fraction> entry(const Aabb<float>& box) const;

private:
    WholePoint from_;
    WholePoint way_;
};

}  // namespace hashphase::demos
