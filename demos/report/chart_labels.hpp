// SPDX-License-Identifier: Zlib
#pragma once

// Where the labels of points stand, so that they hide neither each other nor points.

#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

/// A point in pixels, y downwards, with the text that belongs to it; empty: none.
struct LabelledPoint {
    double x = 0;
    double y = 0;
    std::string label;
};

/// Where a label stands, relative to its point.
struct LabelPlace {
    const char* align = "left";  // the side of the text that is at dx
    double dx = 0;               // [px]
    double dy = 0;
};

/// A place for each label: of eight around the point the first that is free, else the one where it
/// hides least. None begins left of 0 or ends right of the width, where that can be helped.
[[nodiscard]] std::vector<LabelPlace> placeLabels(std::span<const LabelledPoint> points,
                                                  double width);

}  // namespace hashphase::demos
