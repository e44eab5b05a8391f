// SPDX-License-Identifier: Zlib
#pragma once

// Finds what sweeping proxies touch on their ways, in a grid that has just been filed.

#include <broadphase/core/peak_watch.hpp>
#include <broadphase/geometry/box_columns.hpp>
#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/query_cost.hpp>
#include <broadphase/search/pair_parts.hpp>
#include <broadphase/simd/kernels.hpp>
#include <broadphase/store/motions.hpp>
#include <broadphase/sweep_mode.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// A part of a frame.
struct Part {
    double from = 0;
    double to = 1;
};

template <class Scalar>
class ContactSearch {
public:
    explicit ContactSearch(Store<Scalar>& store) : store_(store) {}

    /// Looks for everything that the motions' proxies touch on their ways, from the start on: what
    /// stands in the store's tables of it, and each other.
    void find(std::span<const Motion<Scalar>> motions, ParallelFor parallelFor);

    /// What find() found: two indices each, the smaller one on top; sorted.
    [[nodiscard]] std::span<const std::uint64_t> contacts() const noexcept { return contacts_; }
    [[nodiscard]] const SweepCost& cost() const noexcept { return cost_; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;
    /// Gives back all that only find() uses, and what it found.
    void releaseUnusedMemory() noexcept;

private:
    using Point = Vector3<Scalar>;

    /// A way that would take so many segments.
    struct LongSweep {
        std::uint32_t motion;
        Part within;
        double segments;
    };

    void cutIntoSegments();
    void cut(std::uint32_t motion, const Aabb<double>& world, Scalar cellSize);
    void cutFewRays();
    void addSegments(std::uint32_t motion, const MovingBox<Scalar>& way, const Part& part,
                     int count);
    void meetStanding(ParallelFor parallelFor);
    void meetStandingByRay(ParallelFor parallelFor);
    void addMetByRay(const Reading<Scalar>& reading, const Filing<Scalar>& filing,
                     const Motion<Scalar>& motion, PairSink& sink, QueryCost& cost) const;
    void meetEachOther(ParallelFor parallelFor);
    void addMeeting(ParallelFor parallelFor);
    template <class ValueOf>
    [[nodiscard]] double quantile(double share, const ValueOf& valueOf);
    [[nodiscard]] int sliceCount();
    void walkSegments(const Table<Scalar>& table, std::size_t first, std::size_t last,
                      PairSink& candidates, KernelCost& cost) const;
    void addTouching(const Table<Scalar>& table, std::span<const IndexPair> candidates,
                     PairSink& sink) const;

    Store<Scalar>& store_;
    std::span<const Motion<Scalar>> motions_;  // of the present find()
    SweepCost cost_;
    std::vector<std::uint64_t> contacts_;

    // Scratch.
    BoxColumns<Scalar> segments_;
    std::vector<SweptBox<Scalar>> ways_;  // of the motions
    std::vector<std::uint32_t> motionOfSegment_;
    std::vector<LongSweep> rays_;
    std::vector<double> sample_;
    PairParts parts_;
    PairList candidates_;
    PairList touchingNow_;
    PairList touching_;  // two indices each
    std::vector<std::uint64_t> sorted_;
    std::vector<std::uint32_t> motionNumbers_;
    std::vector<PaddedBox<Scalar>> slice_;
    Table<Scalar> sliceTable_;
};

/// All about what sweeps: see sweeps.hpp.
template <class Scalar>
struct Sweeping {
    Motions<Scalar> motions;
    ContactSearch<Scalar> search;
    PeakWatch peaks;

    explicit Sweeping(Store<Scalar>& store) : motions(store), search(store) {}

    void beginUpdate() {
        const std::size_t indexCount = motions.store.proxies.records.size();
        const std::size_t dropped = std::max(motions.ofProxy.size(), indexCount) - indexCount;
        if (peaks.isPast(motions.all.size(), std::max(motions.all.capacity(), dropped))) {
            releaseUnusedMemory();
        }
        motions.beginUpdate();
    }
    void releaseUnusedMemory() noexcept {
        motions.releaseUnusedMemory();
        search.releaseUnusedMemory();
    }
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
