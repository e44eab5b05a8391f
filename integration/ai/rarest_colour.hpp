// SPDX-License-Identifier: Zlib
#pragma once

// The paper's AI routine: every agent takes the rarest colour (a number) around it. Source: Hastings, Mesit and Guha,
// "Optimization of Large-Scale, Real-Time Simulations by Spatial Hashing".
//
// Frame     Updates read all colours before they change any, so the order of agents does not matter.
// Threads   For updates, the thread rules of grid queries hold (grid.hpp). During an update, no other thread may use
//           this object. Filters run on all threads of `parallelFor`.
// Units     as the grid, usually metres
// Bad data  Agents without a position (position_region.hpp) keep their colours. If the radius is negative or NaN,
//           agents have no neighbours. An agent whose colour is colourCount or more is not counted, but gets a new
//           colour.
// Misuse    Asserted: callbacks do not update this object. Without assertions, such an update does nothing.

#include <broadphase/radius_search.hpp>
#include <integration/ai/export.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace hashphase {

/// Changes the colours of agents. Reuses its memory: allocates only if a frame needs more than before.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT RarestColour {
public:
    /// Agents are the proxies that `filter` accepts. Gives every agent the colour, from 0 to colourCount - 1, that
    /// the fewest other agents within `radius` [m] have. If colours are equally rare, takes the lowest. `colours` is
    /// indexed by ProxyId::index. Calls `changes` once for each agent. Agents that `changes` refuses keep their
    /// colours, but neighbours count them. Returns the cost of counting. Asserted: colourCount is from 1 to
    /// RadiusSearch::kMostGroups, and each agent has an element in `colours`. Cost: as RadiusSearch::countGroups().
    QueryCost update(const Grid<Scalar>& grid, Scalar radius, std::uint32_t colourCount,
                     std::span<std::uint32_t> colours, ProxyFilter filter = acceptAll,
                     ProxyFilter changes = acceptAll, ParallelFor parallelFor = serialFor);

    /// As update(), but changes only the colours of `agents`, including agents that `filter` refuses. `filter` only
    /// chooses the neighbours that are counted. Asserted: `agents` are in the grid, and `colours` has at least
    /// Grid::indexLimit() elements. Cost: a query for each agent (Grid::visitEach()): for few agents, cheaper than
    /// update().
    QueryCost updateSome(const Grid<Scalar>& grid, Scalar radius, std::uint32_t colourCount,
                         std::span<std::uint32_t> colours, std::span<const ProxyId> agents,
                         ProxyFilter filter = acceptAll, ParallelFor parallelFor = serialFor);

    /// Returns the search that holds the agents of the last update().
    [[nodiscard]] const RadiusSearch<Scalar>& search() const noexcept { return search_; }
    [[deprecated("search()")]] [[nodiscard]] const RadiusSearch<Scalar>& crowd() const noexcept {
        return search_;
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    /// Returns whether this thread is within a callback of an update.
    [[nodiscard]] bool isUpdating() const noexcept;

    RadiusSearch<Scalar> search_;
    std::vector<std::uint32_t> counts_;  // index: agent * colourCount + colour
    std::vector<std::uint32_t> rarest_;  // for each agent of updateSome()
};

extern template class RarestColour<float>;
extern template class RarestColour<double>;

}  // namespace hashphase
