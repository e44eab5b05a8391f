// SPDX-License-Identifier: Zlib
#pragma once

// Finds what a ray may meet in the cells of a table: for few rays, which are not worth a tree.

#include <broadphase/function_ref.hpp>
#include <broadphase/hash/table.hpp>
#include <broadphase/query_cost.hpp>
#include <broadphase/regions.hpp>

#include <cstdint>
#include <span>

namespace hashphase::detail {

/// As searchRay(), without a tree. Where the way passes so many cells that they cost more to read than all
/// boxes, these are tested one after another. What is handed to take() at a time is sorted from near to far.
/// An entry may be erased meanwhile. Allocates nothing.
template <class Scalar>
bool searchCells(const Table<Scalar>& table, const RayRegion<Scalar>& region, double limit,
                 FunctionRef<double(std::span<const std::uint32_t>)> take, QueryCost& cost);

}  // namespace hashphase::detail
