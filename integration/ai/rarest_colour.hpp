// SPDX-License-Identifier: Zlib
#pragma once

// The paper's AI routine: every agent counts the colours within a radius and takes the rarest one.
// After Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by Spatial
// Hashing".
//
// A frame    update() reads all colours, then changes them: no agent sees a new colour before the next
//            frame, so the result does not depend on any order.
// Threads    update() reads the grid, as queries do, and needs this object for itself.
// Units      metres, or whatever the grid's are.
// Bad data   As for a radius search (broadphase/radius_search.hpp): an agent without a finite centre keeps
//            its colour, and within a negative or NaN radius there are no neighbours. An agent whose colour
//            is not below the number of colours is not counted, and takes a colour.

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
    /// Lets every agent take the rarest colour: sets colours[ProxyId::index] to the colour, of 0 to
    /// colourCount - 1, that fewest of the other agents within `radius` [m] of its centre have; of equally
    /// rare colours the lowest. Agents are the proxies that the filter accepts. An agent does not count
    /// itself: alone it takes colour 0. An agent that `changes` refuses, asked once about each, is counted
    /// and keeps its colour. There are 1 to RadiusSearch::kMostGroups colours, and one place for each agent
    /// (asserted). Returns the cost of counting. Cost: that of RadiusSearch::countGroups().
    QueryCost update(const Grid<Scalar>& grid, Scalar radius, std::uint32_t colourCount,
                     std::span<std::uint32_t> colours, ProxyFilter filter = acceptAll,
                     ProxyFilter changes = acceptAll, ParallelFor parallelFor = serialFor);

    /// update() for these agents only, each named once and alive (asserted). An agent without a position
    /// keeps its colour. Cost: a query for each agent (Grid::visitEach()); less than update() where they are
    /// few.
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
