// SPDX-License-Identifier: Zlib
#pragma once

// Coordinates after a shift of the origin: x - shift, rounded. A subtraction is monotone after rounding
// too, so boxes that overlap do so ever after; what is apart may come to touch, where low digits are
// lost. Here is told where that cannot happen.

#include <broadphase/aabb.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// Whether `difference` is x - shift without rounding. The error of a subtraction is zero exactly when
/// both terms come back from it (Knuth, "The Art of Computer Programming", 4.2.2).
template <class Scalar>
[[nodiscard]] inline bool isExactDifference(Scalar x, Scalar shift, Scalar difference) noexcept {
    return ((x - difference == shift) & (difference + shift == x)) != 0;
}

/// Whether x is so large, or infinite, that the shift is lost in it, and so would be twice the shift:
/// no exact difference can then have got past it.
template <class Scalar>
[[nodiscard]] inline bool isLostIn(Scalar x, Scalar shift) noexcept {
    return x - 2 * shift == x || std::isinf(x);
}

/// x - shift within what Scalar can tell: of that from which others are measured, and which shifts that
/// add up must not make infinite.
template <class Scalar, class Wide>
[[nodiscard]] inline Wide shiftedWithin(Wide x, Scalar shift) noexcept {
    constexpr auto most = static_cast<Wide>(std::numeric_limits<Scalar>::max());
    return std::clamp(x - static_cast<Wide>(shift), -most, most);
}

template <class Scalar>
[[nodiscard]] inline Aabb<Scalar> shiftedBox(const Aabb<Scalar>& box,
                                             const Vector3<Scalar>& shift) noexcept {
    return {box.min() - shift, box.max() - shift};
}

/// Whether the box may have come to touch others when it was shifted: by rounding, of a coordinate in
/// which the shift is not wholly lost. Two boxes of which neither has overlap just when they did before.
template <class Scalar>
[[nodiscard]] inline bool isRounded(const Aabb<Scalar>& box,
                                    const Vector3<Scalar>& shift) noexcept {
    const Scalar* low = box.min().data();
    const Scalar* high = box.max().data();
    const Scalar* by = shift.data();
    bool isExact = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        isExact &= isExactDifference(low[axis], by[axis], low[axis] - by[axis]);
        isExact &= isExactDifference(high[axis], by[axis], high[axis] - by[axis]);
    }
    if (isExact) {
        return false;
    }
    bool isKept = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const Scalar x : {low[axis], high[axis]}) {
            isKept =
                isKept && (isExactDifference(x, by[axis], x - by[axis]) || isLostIn(x, by[axis]));
        }
    }
    return !isKept && !hasNan(box);
}

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
