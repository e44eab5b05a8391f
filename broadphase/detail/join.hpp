// SPDX-License-Identifier: Zlib
#pragma once

// Finds all overlapping couples of a table, or of two: each entry against the half of its
// neighbourhood that lies after it, on its own level, and levels against each other.

#include <broadphase/detail/box_columns.hpp>
#include <broadphase/detail/kernels.hpp>
#include <broadphase/detail/pair_parts.hpp>
#include <broadphase/detail/table.hpp>
#include <broadphase/export.hpp>

#include <cstdint>

namespace hashphase::detail {

/// Appends every two entries of the table whose boxes overlap, each couple once. With groups[2 * slot] of
/// every slot, and with what those of the table have together, it leaves out those that may not pair.
template <class Scalar>
void joinTable(const Table<Scalar>& table, ParallelFor parallelFor, PairParts& parts,
               PairList& found, KernelCost& cost, const ProxyGroups* groups = nullptr,
               const ProxyGroups& together = {});

/// Appends (i, entry) for every box of `queries` and every entry of the table that overlaps it; with
/// `groups`, that may pair with it.
template <class Scalar>
void walkTable(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t count,
               ParallelFor parallelFor, PairParts& parts, PairList& found, KernelCost& cost,
               const GroupsView* groups = nullptr);

/// The same for a few boxes, on the caller's thread; sooner where those that follow each other are
/// near each other.
template <class Scalar>
HASHPHASE_BROADPHASE_EXPORT void walkTogether(const Table<Scalar>& table,
                                              const Columns<Scalar>& queries, std::uint32_t count,
                                              PairSink& sink, KernelCost& cost);

}  // namespace hashphase::detail
