// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/core/compiler.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::detail {

/// A power of two that brings `length` near 1, where squares neither overflow nor vanish; what is
/// multiplied by it is not rounded. Of 0 the largest, of infinity the smallest there is.
template <class Scalar>
[[nodiscard]] Scalar unitScale(Scalar length) noexcept {
    constexpr int most = std::numeric_limits<Scalar>::max_exponent - 2;
    const bool isOrdinary = isFinite(length) && length > 0;
    const int exponent = isOrdinary ? std::ilogb(length) : (length > 0 ? most : -most);
    return std::ldexp(Scalar(1), std::clamp(-exponent, -most, most));
}

/// The squared length of an offset, or -1 where it is longer than `radius`, whose unitScale() is `scale`, and
/// where one of them is NaN. The test is scaled, so that it holds where squares leave the range of numbers; the
/// square is not, so that it does not depend on the radius. (Nor is it scaled back: a divisor that is squared
/// first, as by -ffast-math, would vanish.)
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline Scalar squareWithin(Scalar x, Scalar y, Scalar z,
                                                                  Scalar radius,
                                                                  Scalar scale) noexcept {
    const auto squareOf = [](Scalar a, Scalar b, Scalar c) { return a * a + b * b + c * c; };
    const Scalar square = squareOf(x * scale, y * scale, z * scale);
    const Scalar reach = radius * scale;
    if (HASHPHASE_OVERLOOKS_NAN && (isNan(reach) || isNan(square))) {
        return -1;
    }
    return reach >= 0 && square <= reach * reach ? squareOf(x, y, z) : Scalar(-1);
}

}  // namespace hashphase::detail
