// SPDX-License-Identifier: Zlib
#pragma once

// When a broadphase is told that a box has moved: ways to save work, at the price of pairs that are
// false or missed.

#include <demos/accuracy/pairs/pair_method.hpp>

namespace hashphase::demos {

enum class FalsePairs {
    kKept,     // what overlaps by the fat boxes is listed
    kRefused,  // every listed pair is tested by the boxes as they are
};

/// Every box is set in every frame, and no object ever rests: whatever moved, all are filed again.
[[nodiscard]] PairMethod refileAllMethod();

/// Boxes grown by `margin` [m] on all sides, and set again only when an object has left its own, as
/// btDbvtBroadphase does with 5 cm.
[[nodiscard]] PairMethod fatMethod(double margin, FalsePairs falsePairs);

/// Boxes set and pairs found in each `period`-th frame only; the pairs stand until the next.
[[nodiscard]] PairMethod staleMethod(int period);

}  // namespace hashphase::demos
