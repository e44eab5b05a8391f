// SPDX-License-Identifier: Zlib
#pragma once

// What cells have to hold, by brute force.

#include <broadphase/filed_cells.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <span>

namespace hashphase::test {

/// How many of the boxes have their least corner in the cell. Cells begin at corners of boxes, and are half open.
template <class Scalar>
std::size_t cornersIn(const Aabb<Scalar>& cell, std::span<const Aabb<Scalar>> boxes) {
    return static_cast<std::size_t>(std::ranges::count_if(boxes, [&](const Aabb<Scalar>& box) {
        return (box.min().array() >= cell.min().array()).all() &&
               (box.min().array() < cell.max().array()).all();
    }));
}

/// Expects cells of one size that hold the least corner of each box once, and as many of them as their load says.
template <class Scalar>
void expectCellsOf(std::span<const Aabb<Scalar>> boxes, std::span<const FiledCell<Scalar>> cells) {
    std::size_t filed = 0;
    for (const FiledCell<Scalar>& cell : cells) {
        EXPECT_TRUE(cell.box.sizes().isApprox(cells.front().box.sizes(), Scalar(1e-3)))
            << cell.box.sizes().transpose();
        EXPECT_EQ(cornersIn(cell.box, boxes), cell.load) << cell.box.min().transpose();
        EXPECT_GT(cell.load, 0U);
        filed += cell.load;
    }
    EXPECT_EQ(filed, boxes.size());
}

}  // namespace hashphase::test
