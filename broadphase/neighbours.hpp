// SPDX-License-Identifier: Zlib
#pragma once

// Which proxies are near which: all neighbours of all proxies at once, as agents ask in every frame. A query
// for each proxy would look at every pair twice. Here all boxes grow by half the distance, and one pass finds
// those that overlap, as for pairs.
//
//     Neighbours<float> neighbours;
//     for (const ProxyPair& pair : neighbours.find(grid, 5)) { ... }
//
// Threads   find() reads the grid, as queries do, and needs this object for itself.
// Others    RadiusSearch (radius_search.hpp) lists positions within a radius, agent by agent.

#include <broadphase/export.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/search/join.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase {

/// Finds neighbours. Keeps its memory: a frame like the last one allocates nothing.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Neighbours {
public:
    /// Returns every two proxies of the grid whose boxes are at most `distance` [m] apart, each pair once, in
    /// any order. The distance is that between the nearest points (closed), 0 where boxes overlap. A negative
    /// or NaN distance finds no pair; a box with a NaN has no neighbours. The result does not depend on
    /// `parallelFor`, and is valid until the next call.
    /// Cost: as an update of the grid, and the pairs; at most that of comparing all with all. Gives back
    /// memory that has been room for more than eight times as many proxies, or pairs, in 256 calls in a row.
    [[nodiscard]] std::span<const ProxyPair> find(const Grid<Scalar>& grid, Scalar distance,
                                                  ParallelFor parallelFor = serialFor) &;

    /// What the last find() cost; hits are pairs.
    [[nodiscard]] const QueryCost& lastCost() const noexcept { return cost_; }
    /// Bytes held, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back all memory. The pairs that find() returned are not valid any more.
    void releaseMemory() noexcept;

private:
    std::vector<ProxyId> ids_;
    std::vector<detail::PaddedBox<Scalar>> boxes_;
    std::vector<detail::PaddedBox<Scalar>> grown_;
    std::vector<std::uint32_t> proxyIndices_;  // 0, 1, 2 ...
    detail::Table<Scalar> table_;
    detail::PairParts parts_;
    detail::PairList candidates_;
    std::vector<ProxyPair> found_;  // never shrinks
    QueryCost cost_;
    detail::PeakWatch peaks_;
};

extern template class Neighbours<float>;
extern template class Neighbours<double>;

}  // namespace hashphase
