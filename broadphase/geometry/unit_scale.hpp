// SPDX-License-Identifier: Zlib
#pragma once

#include <algorithm>

#include <broadphase/core/compiler.hpp>
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

}  // namespace hashphase::detail
