// SPDX-License-Identifier: Zlib
#pragma once

// Finds all pairs of proxies within a distance, in one pass. A query for each proxy would test every pair twice.
//
//     Neighbours<float> neighbours;
//     for (const ProxyPair& pair : neighbours.find(grid, 5)) { ... }
//
// Threads   find() reads the grid, as queries do. No other thread may use this object during find().
// See also  RadiusSearch (radius_search.hpp) lists, for each agent, the agents within a radius.

#include <broadphase/export.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/search/join.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase {

/// Finds pairs of near proxies. Keeps its memory: a frame that needs no more memory than before allocates nothing.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Neighbours {
public:
    /// Returns all pairs of proxies whose boxes are at most `distance` [m] apart, in any order. Each pair appears
    /// once. The distance is between nearest points, and 0 if boxes overlap. A negative or NaN distance finds
    /// nothing. A box with a NaN has no neighbours. Neither the pairs nor their order depends on `parallelFor`. The
    /// result is valid until the next find(). Frees unused memory after 256 calls in a row with over eight times the
    /// needed capacity.
    /// Cost: as Grid::update(), plus O(pairs); at most O(n^2) for n proxies.
    [[nodiscard]] std::span<const ProxyPair> find(const Grid<Scalar>& grid, Scalar distance,
                                                  ParallelFor parallelFor = serialFor) &;

    /// Returns the cost of the last find(); its `hits` are pairs.
    [[nodiscard]] const QueryCost& lastCost() const noexcept { return cost_; }
    /// Bytes held, including unused capacity.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees all memory. Invalidates the pairs that find() returned.
    void releaseMemory() noexcept;

private:
    std::vector<ProxyId> ids_;
    std::vector<detail::PaddedBox<Scalar>> boxes_;
    std::vector<detail::PaddedBox<Scalar>> grown_;
    std::vector<std::uint32_t> proxyIndices_;  // 0, 1, 2 ...: indices in ids_
    detail::Table<Scalar> table_;
    detail::PairParts parts_;
    detail::PairList candidates_;
    std::vector<ProxyPair> found_;  // starts with the result; shrinks only in releaseMemory()
    QueryCost cost_;
    detail::PeakWatch peaks_;
};

extern template class Neighbours<float>;
extern template class Neighbours<double>;

}  // namespace hashphase
