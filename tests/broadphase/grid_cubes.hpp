// SPDX-License-Identifier: Zlib
#pragma once

// Unit cubes in a row, and how many of them a box finds.

#include <broadphase/grid.hpp>
#include <tests/support/box_scenes.hpp>

#include <cstddef>

namespace hashphase::test {

inline Aabb<float> rowCube(double x) {
    return makeBox<float>(x, 0, 0, x + 1, 1, 1);
}

inline std::size_t countWithinBox(const Grid<float>& grid, const Aabb<float>& box) {
    CollectCount count;
    grid.visit(BoxRegion<float>{box}, count);
    return count.count();
}

}  // namespace hashphase::test
