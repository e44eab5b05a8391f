// SPDX-License-Identifier: Zlib
#pragma once

// Who is near whom: all neighbours of all proxies at once, as agents ask in every frame. A query for
// each of them looks at every pair twice, and at its surroundings anew; here boxes are grown by
// half the distance and joined, as pairs are found.
//
// Threads   find() reads the grid, as queries do, and needs this object for itself.

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
class HASHPHASE_BROADPHASE_EXPORT Neighbours {
public:
    /// Every two proxies of the grid whose boxes are at most `distance` [m] apart (closed, by the
    /// straight line between the nearest points; 0 apart where they overlap), each pair once, in
    /// any order. Valid until the next call. None for a negative or NaN distance. The result does
    /// not depend on `parallelFor`. Cost: that of an update of the grid, and of the pairs; at most
    /// that of comparing all with all. Gives back memory that has been room for more than eight times as
    /// many proxies, or pairs, in 256 calls in a row.
    [[nodiscard]] std::span<const ProxyPair> find(const Grid<Scalar>& grid, Scalar distance,
                                                  ParallelFor parallelFor = serialFor) &;

    /// What the last find() cost; hits are pairs.
    [[nodiscard]] const QueryCost& lastCost() const noexcept { return cost_; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back all memory; what was found is not valid any more.
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
