// SPDX-License-Identifier: Zlib
#pragma once

// On which side of a line a point lies, by the sign of a determinant that is never wrong.
//
// After J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates", 1997: a bound on the rounding tells when the sign is certain; where it is not, all
// products are summed without rounding.

#include <cmath>

namespace hashphase::detail {

/// A point as seen from above.
struct Point2 {
    double x = 0;
    double z = 0;
};

/// orientation() without a rounding error; slow.
[[nodiscard]] double exactOrientation(const Point2& a, const Point2& b, const Point2& c) noexcept;

/// Twice an area, and whether rounding may have changed its sign.
struct Area {
    double value;
    bool isCertain;
};

/// Twice the area of a, b, c, positive when they turn from x to z.
[[nodiscard]] inline Area roundedOrientation(const Point2& a, const Point2& b,
                                             const Point2& c) noexcept {
    constexpr double kErrorBound = 3.3306690738754716e-16;  // (3 + 16 u) u for u = 2^-53
    const double left = (a.x - c.x) * (b.z - c.z);
    const double right = (a.z - c.z) * (b.x - c.x);
    const double area = left - right;
    return {area, std::abs(area) >= kErrorBound * (std::abs(left) + std::abs(right))};
}

/// The same, never with the wrong sign, and 0 only when the points are on a line. For coordinates of
/// up to 1e150, and as long as no product that is not 0 is below 1e-290.
[[nodiscard]] inline double orientation(const Point2& a, const Point2& b,
                                        const Point2& c) noexcept {
    const Area area = roundedOrientation(a, b, c);
    return area.isCertain ? area.value : exactOrientation(a, b, c);
}

}  // namespace hashphase::detail
