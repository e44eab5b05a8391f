// SPDX-License-Identifier: Zlib
#pragma once

// The grid of Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by
// Spatial Hashing", in space: one cell size for all. Every frame all buckets are wiped, every object
// is hashed into the cells that it touches, and the objects of a cell are compared with each other.
// Cells that share a bucket are told apart, and a pair that meets in several cells is listed once.

#include <demos/accuracy/pairs/pair_method.hpp>

namespace hashphase::demos {

enum class FiledCells {
    kAll,      // every cell that the box touches
    kCorners,  // those of its corners, as printed: whoever spans three cells leaves out the middle
};

/// Keeps no pair cache: the pairs of a frame are listed and forgotten.
[[nodiscard]] PairMethod paperGridMethod(std::string name, double cellSize, FiledCells filed);

/// In how many cells the boxes lie altogether.
[[nodiscard]] double filedCellCount(std::span<const BulletBox> boxes, double cellSize);

}  // namespace hashphase::demos
