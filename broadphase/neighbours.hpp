// SPDX-License-Identifier: Zlib
#pragma once

// Finds all pairs of proxies within a distance, in one pass. Single queries would test every pair twice.
//
//     Neighbours<float> neighbours;
//     for (const ProxyPair& pair : neighbours.find(grid, 5)) { ... }
//
// Threads   find() reads the grid as a query does, and needs this object for itself.
// See also  RadiusSearch (radius_search.hpp) lists positions within a radius, agent by agent.

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
    /// Returns every two proxies whose boxes are at most `distance` [m] apart, each pair once, in any order. The
    /// distance is between the nearest points, 0 if boxes overlap. A negative or NaN distance finds nothing; a box
    /// with a NaN has no neighbours. The result does not depend on `parallelFor`, and is valid until the next call.
    /// Surplus memory is freed after 256 calls in a row with over eight times the room needed.
    /// Cost: as a grid update, and the pairs; at most all compared with all.
    [[nodiscard]] std::span<const ProxyPair> find(const Grid<Scalar>& grid, Scalar distance,
                                                  ParallelFor parallelFor = serialFor) &;

    /// What the last find() cost; hits are pairs.
    [[nodiscard]] const QueryCost& lastCost() const noexcept { return cost_; }
    /// Bytes held, including unused capacity.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees all memory. Invalidates the pairs that find() returned.
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
