// SPDX-License-Identifier: Zlib
#pragma once

// The paper's AI routine: every agent takes the rarest colour within a radius. After Hastings, Mesit and Guha,
// "Optimization of Large-Scale, Real-Time Simulations by Spatial Hashing".
//
// Frame     update() reads all colours before it changes any: the result does not depend on any order.
// Threads   update() reads the grid, as queries do, and needs this object for itself. It asks filters on all threads.
// Units     the grid's, usually metres
// Bad data  An agent without a position (position_region.hpp) keeps its colour. A negative or NaN radius has no
//           neighbours. An agent with a colour of colourCount or more is not counted, and takes a colour.

#include <broadphase/radius_search.hpp>
#include <integration/ai/export.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace hashphase {

/// Changes colours. Keeps its memory: a frame like the last one allocates nothing.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT RarestColour {
public:
    /// Gives every agent, a proxy that `filter` accepts, the colour from 0 to colourCount - 1 that the fewest other
    /// agents within `radius` [m] have; of equally rare ones the lowest. `colours` is by ProxyId::index. `changes` is
    /// asked once about each agent; a refused agent keeps its colour, and is counted. Returns the cost of counting.
    /// Asserted: 1 to RadiusSearch::kMostGroups colours, and a place in `colours` for each agent. Cost: as
    /// RadiusSearch::countGroups().
    QueryCost update(const Grid<Scalar>& grid, Scalar radius, std::uint32_t colourCount,
                     std::span<std::uint32_t> colours, ProxyFilter filter = acceptAll,
                     ProxyFilter changes = acceptAll, ParallelFor parallelFor = serialFor);

    /// update() for these agents only. Asserted: they are alive, and `colours` has Grid::indexLimit() places or more.
    /// Cost: a query for each agent (Grid::visitEach()): less than update() for few agents.
    QueryCost updateSome(const Grid<Scalar>& grid, Scalar radius, std::uint32_t colourCount,
                         std::span<std::uint32_t> colours, std::span<const ProxyId> agents,
                         ProxyFilter filter = acceptAll, ParallelFor parallelFor = serialFor);

    /// The agents of the last update().
    [[nodiscard]] const RadiusSearch<Scalar>& search() const noexcept { return search_; }
    [[deprecated("search()")]] [[nodiscard]] const RadiusSearch<Scalar>& crowd() const noexcept {
        return search_;
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    RadiusSearch<Scalar> search_;
    std::vector<std::uint32_t> counts_;  // by agent, then by colour
    std::vector<std::uint32_t> rarest_;  // of updateSome(), by agent
};

extern template class RarestColour<float>;
extern template class RarestColour<double>;

}  // namespace hashphase
