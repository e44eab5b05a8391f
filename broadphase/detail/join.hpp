// SPDX-License-Identifier: Zlib
#pragma once

// Finds all overlapping couples of a table, or of two: each entry against the half of its
// neighbourhood that lies after it, on its own level, and levels against each other.

#include <broadphase/detail/box_columns.hpp>
#include <broadphase/detail/kernels.hpp>
#include <broadphase/detail/pair_parts.hpp>
#include <broadphase/detail/table.hpp>

#include <cstdint>

namespace hashphase::detail {

/// Appends every two entries of the table whose boxes overlap, each couple once.
template <class Scalar>
void joinTable(const Table<Scalar>& table, ParallelFor parallelFor, PairParts& parts,
               PairList& found, KernelCost& cost);

/// Appends (i, entry) for every box of `queries` and every entry of the table that overlaps it.
template <class Scalar>
void walkTable(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t count,
               ParallelFor parallelFor, PairParts& parts, PairList& found, KernelCost& cost);

/// The same for the boxes from first to last, one past, on the caller's thread.
template <class Scalar>
void walkLevels(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t first,
                std::uint32_t last, PairSink& sink, KernelCost& cost);

}  // namespace hashphase::detail
