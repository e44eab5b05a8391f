// SPDX-License-Identifier: Zlib
#pragma once

// Finds all overlapping couples of a table, or of two: each entry against the half of its
// neighbourhood that lies after it, on its own level, and levels against each other.

#include <broadphase/detail/kernels.hpp>
#include <broadphase/detail/pair_parts.hpp>
#include <broadphase/detail/walk.hpp>
#include <broadphase/regions.hpp>

#include <cstdint>

namespace hashphase::detail {

/// A reader for walkTable() that calls found(entry) for every entry that overlaps a box.
template <class Scalar, class Found>
class OverlapReader {
public:
    OverlapReader(const Table<Scalar>& table, const Aabb<Scalar>& box, Found& found) noexcept
        : columns_(table.columns()), box_(box), found_(found) {}

    static constexpr double limit() noexcept { return std::numeric_limits<double>::infinity(); }

    template <class IsOwn>
    bool read(const EntryRange& range, const IsOwn& isOwn) const {
        for (std::uint32_t entry = range.first; entry < range.last; entry += kLanes) {
            const std::uint32_t lanes = std::min(range.last - entry, kLanes);
            std::uint32_t mask = box_.overlapMask(columns_, entry) & ((1U << lanes) - 1);
            for (; mask != 0; mask &= mask - 1) {
                const std::uint32_t hit =
                    entry + static_cast<std::uint32_t>(std::countr_zero(mask));
                if (isOwn(hit)) {
                    found_(hit);
                }
            }
        }
        return true;
    }

private:
    Columns<Scalar> columns_;
    BoxLanes<Scalar> box_;
    Found& found_;
};

/// Calls found(slot) for every entry of the table that overlaps the box.
template <class Scalar, class Found>
void forOverlapsInTable(const Table<Scalar>& table, const Aabb<Scalar>& box, QueryCost& cost,
                        Found&& found) {
    const auto foundEntry = [&](std::uint32_t entry) { found(table.slot(entry)); };
    walkTable(table, BoxRegion<Scalar>{box}, cost,
              OverlapReader<Scalar, decltype(foundEntry)>(table, box, foundEntry));
}

/// Appends every two entries of the table whose boxes overlap, each couple once.
template <class Scalar>
void joinTable(const Table<Scalar>& table, ParallelFor parallelFor, PairParts& parts,
               PairList& found, KernelCost& cost);

/// Appends (i, entry) for every box of `queries` and every entry of the table that overlaps it.
/// `queries` has the columns min x, y, z, max x, y, z.
template <class Scalar>
void walkTable(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t count,
               ParallelFor parallelFor, PairParts& parts, PairList& found, KernelCost& cost);

}  // namespace hashphase::detail
