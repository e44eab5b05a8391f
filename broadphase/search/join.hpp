// SPDX-License-Identifier: Zlib
#pragma once

// Finds all overlapping pairs of a table, or of two: each entry against the half of its
// neighbourhood that lies after it, on its own level, and levels against each other.

#include <broadphase/geometry/box_columns.hpp>
#include <broadphase/hash/table.hpp>
#include <broadphase/search/pair_parts.hpp>
#include <broadphase/simd/kernels.hpp>

#include <algorithm>
#include <cstdint>
#include <span>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// How many entries of the table share a cell, or its list, at most.
template <class Scalar>
[[nodiscard]] std::uint32_t mostTogether(const Table<Scalar>& table) {
    const auto levels = table.levels();
    return std::max(table.largestCell(), levels.empty() ? 0 : levels.back().count());
}

/// Appends every two entries of the table whose boxes overlap, each pair once. With groups[2 * index] of
/// every index, and with what those of the table have together, it leaves out those that may not pair.
template <class Scalar>
void joinTable(const Table<Scalar>& table, ParallelFor parallelFor, PairParts& parts,
               PairList& found, KernelCost& cost, const ProxyGroups* groups = nullptr,
               const ProxyGroups& together = {});

/// The same on the caller's thread. The sink must not end a join.
template <class Scalar>
void joinTable(const Table<Scalar>& table, PairSink& sink, KernelCost& cost,
               const ProxyGroups* groups);

/// Appends what `count` of its searches, evenly spaced, would append. Returns how many searches there are.
template <class Scalar>
std::size_t joinSample(const Table<Scalar>& table, std::size_t count, PairSink& sink,
                       KernelCost& cost, const ProxyGroups* groups);

/// Appends (i, entry) for every box of `queries` and every entry of the table that overlaps it; with
/// `groups`, that may pair with it.
template <class Scalar>
void queryTable(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t count,
                ParallelFor parallelFor, PairParts& parts, PairList& found, KernelCost& cost,
                const GroupsView* groups = nullptr);

/// The same for queries from first to last, on the caller's thread. Returns false when the sink has
/// ended the search.
template <class Scalar>
bool queryTable(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t first,
                std::uint32_t last, PairSink& sink, KernelCost& cost, const GroupsView* groups);

/// The same for a few boxes; sooner where those that follow each other are near each other.
template <class Scalar>
bool queryBatch(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t count,
                PairSink& sink, KernelCost& cost);

/// Calls visit(a, b) for the indices of every two entries of the table whose boxes overlap, in the memory of a
/// block of them; with `groups`, that may pair.
template <class Scalar, class Visit>
void forOverlaps(const Table<Scalar>& table, const ProxyGroups* groups, KernelCost& cost,
                 const Visit& visit) {
    findInBlocks([&](PairSink& sink) { joinTable(table, sink, cost, groups); },
                 [&](std::span<const IndexPair> found) {
                     for (const auto [a, b] : found) {
                         visit(table.proxyIndex(a), table.proxyIndex(b));
                     }
                 });
}

/// The same for every box of `queries` and every entry of the table: visit(i, index).
template <class Scalar, class Visit>
void forOverlaps(const Columns<Scalar>& queries, std::uint32_t count, const Table<Scalar>& table,
                 const GroupsView* groups, KernelCost& cost, const Visit& visit) {
    findInBlocks([&](PairSink& sink) { queryTable(table, queries, 0, count, sink, cost, groups); },
                 [&](std::span<const IndexPair> found) {
                     for (const auto [i, entry] : found) {
                         visit(i, table.proxyIndex(entry));
                     }
                 });
}

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
