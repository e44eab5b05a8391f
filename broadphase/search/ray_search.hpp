// SPDX-License-Identifier: Zlib
#pragma once

// Finds what a ray may meet, from near to far.

#include <broadphase/function_ref.hpp>
#include <broadphase/query_cost.hpp>
#include <broadphase/regions.hpp>
#include <broadphase/tree/box_tree.hpp>

#include <cstdint>
#include <span>

namespace hashphase::detail {

/// Hands the indices of all boxes of the tree that the ray may meet up to the key `limit`, those of a
/// few neighbours at a time and roughly from near to far, to take(indices). It returns the new limit,
/// which is no larger, or a negative number or NaN, which ends the search. Returns false when it
/// has.
template <class Scalar>
bool searchRay(const BoxTree& tree, const RayRegion<Scalar>& region, double limit,
               FunctionRef<double(std::span<const std::uint32_t>)> take, QueryCost& cost);

}  // namespace hashphase::detail
