// SPDX-License-Identifier: Zlib
#pragma once

// Finds what boxes overlap in a table.

#include <broadphase/export.hpp>
#include <broadphase/function_ref.hpp>
#include <broadphase/hash/table.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <cstdint>
#include <span>

namespace hashphase::detail {

/// Hands (i, entry) for every box i of the first `count` of `queries` and every entry of the table
/// that overlaps it to take(pairs), some at a time, until it returns false. Returns false when it
/// has. Of a single box, what some rows have is handed over before the next ones are read; of
/// several, which had better be near each other, what has come together. An entry may be erased
/// meanwhile. Allocates nothing.
template <class Scalar>
HASHPHASE_BROADPHASE_EXPORT bool searchBoxes(const Table<Scalar>& table,
                                             const Columns<Scalar>& queries, std::uint32_t count,
                                             FunctionRef<bool(std::span<const IndexPair>)> take,
                                             KernelCost& cost);

}  // namespace hashphase::detail
