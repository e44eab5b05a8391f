// SPDX-License-Identifier: Zlib
#pragma once

// When two moving boxes first touch, in rational numbers: without any rounding.

#include <broadphase/moving_box.hpp>

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace hashphase::test {

/// False when the boxes are so far apart on their whole ways that no rounding could matter.
template <class Scalar>
[[nodiscard]] bool mayMeet(const MovingBox<Scalar>& a, const MovingBox<Scalar>& b) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto isBeyond = [axis](const MovingBox<Scalar>& low, const MovingBox<Scalar>& high) {
            using Wide = long double;
            const Wide top = Wide(low.box.max()[axis]) + std::max<Wide>(low.displacement[axis], 0);
            const Wide bottom =
                Wide(high.box.min()[axis]) + std::min<Wide>(high.displacement[axis], 0);
            return bottom - top > (std::abs(bottom) + std::abs(top)) / 16;
        };
        if (isBeyond(a, b) || isBeyond(b, a)) {
            return false;
        }
    }
    return true;
}

/// firstContact() in rational numbers.
template <class Scalar>
[[nodiscard]] std::optional<mpq_class> firstContactByRationals(const MovingBox<Scalar>& a,
                                                               const MovingBox<Scalar>& b) {
    if (hasNan(a.box) || hasNan(b.box) || !a.displacement.allFinite() ||
        !b.displacement.allFinite() || !mayMeet(a, b)) {
        return std::nullopt;
    }
    mpq_class begin = 0;
    mpq_class end = 1;
    // The time in which low + lowMoves * t <= high + highMoves * t; false when there is none.
    const auto narrow = [&](double low, double high, double lowMoves, double highMoves) {
        if (std::isinf(low) || std::isinf(high)) {
            return low <= high;
        }
        const mpq_class width = mpq_class(low) - mpq_class(high);
        const mpq_class closing = mpq_class(highMoves) - mpq_class(lowMoves);
        if (closing == 0) {
            return width <= 0;
        }
        const mpq_class time = width / closing;
        if (closing > 0 && time > begin) {
            begin = time;
        } else if (closing < 0 && time < end) {
            end = time;
        }
        return true;
    };
    for (int axis = 0; axis < 3; ++axis) {
        const auto moveA = static_cast<double>(a.displacement[axis]);
        const auto moveB = static_cast<double>(b.displacement[axis]);
        if (!narrow(a.box.min()[axis], b.box.max()[axis], moveA, moveB) ||
            !narrow(b.box.min()[axis], a.box.max()[axis], moveB, moveA)) {
            return std::nullopt;
        }
    }
    return begin <= end ? std::optional(begin) : std::nullopt;
}

}  // namespace hashphase::test
