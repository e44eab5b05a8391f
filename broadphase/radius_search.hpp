// SPDX-License-Identifier: Zlib
#pragma once

// Finds the agents within a radius of each agent, for all agents at once, as AI asks in every frame.
//
//     search.take(grid, 10);
//     search.forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) { ... });
//
// A frame    take() copies where all proxies are; then ask as often as you like.
// Agents     are proxies, numbered from 0 in spatial order by each take(), at the centres of their
//            boxes: see positionOf() in position_region.hpp.
// Neighbours of an agent are the other agents at most `radius` away: (dx^2 + dy^2) + dz^2 <= radius^2, each
//            operation rounded to Scalar. With a radius beyond 2^60 or below 2^-60 (double: 2^480, 2^-480),
//            the differences and the radius are first multiplied by a power of two that brings the radius
//            near 1. So of two agents either both or none is the other's neighbour, and the answer is the
//            same with all instruction sets and on any number of threads.
// Bad data   A proxy without a position, because its box has a NaN or an infinite face or is inverted, is no
//            agent: see leftOutCount(). Within a negative or NaN radius no agent has neighbours; within an
//            infinite one all other agents are neighbours.
// Threads    Everything but the accessors needs this object for itself; take() reads the grid, as
//            queries do.
// Units      metres, or whatever the grid's are.
//
// Neighbours (neighbours.hpp) lists pairs of boxes instead.

#include <broadphase/export.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/hash/wrapped_grid.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/proxy_filter.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <type_traits>
#include <vector>

namespace hashphase {

/// Finds neighbours. Keeps its memory: a frame like the last one allocates nothing, unless more threads
/// work at the same time than ever before.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT RadiusSearch {
public:
    using Point = Vector3<Scalar>;

    /// The most groups that countGroups() takes.
    static constexpr std::uint32_t kMostGroups = detail::kMostGroups;

    RadiusSearch();
    ~RadiusSearch();
    RadiusSearch(const RadiusSearch&) = delete;
    RadiusSearch& operator=(const RadiusSearch&) = delete;

    // --- The agents ------------------------------------------------------------------------------

    /// Takes the proxies that the filter accepts, as they are now, for questions about `radius` [m].
    /// The filter is asked on the loop's threads, about some proxies twice; it changes neither the grid
    /// nor this object (asserted). Where memory runs out, or the filter throws, there are no agents.
    /// Cost: a few passes over the proxies of the grid, whether or not they are filed. Gives back memory
    /// that has been room for more than eight times as many proxies in 256 calls in a row.
    void take(const Grid<Scalar>& grid, Scalar radius, ProxyFilter filter = acceptAll,
              ParallelFor parallelFor = serialFor);

    /// Number of agents.
    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(ids_.size());
    }

    /// Number of proxies that are no agents because they have no position.
    [[nodiscard]] std::uint32_t leftOutCount() const noexcept { return leftOut_; }

    /// The proxy of an agent, and its position [m], by the agent's number below size() (asserted). ids()
    /// returns all ids by that number.
    [[nodiscard]] ProxyId id(std::uint32_t agent) const {
        HASHPHASE_ASSERT(agent < size(), "Agents have numbers below size().");
        return ids_[agent];
    }
    [[nodiscard]] std::span<const ProxyId> ids() const noexcept { return ids_; }
    [[nodiscard]] Point position(std::uint32_t agent) const {
        HASHPHASE_ASSERT(agent < size(), "Agents have numbers below size().");
        return {columns_[0][agent], columns_[1][agent], columns_[2][agent]};
    }

    // --- Questions -------------------------------------------------------------------------------

    /// Calls visit(std::uint32_t agent, std::span<const std::uint32_t> neighbours) for every agent, on the
    /// threads of `parallelFor`. The neighbours' numbers are valid during the call, in an order that does not
    /// depend on `parallelFor`. visit() may ask this object for ids and positions, and for no more
    /// (asserted). Returns the cost; hits are neighbours. Cost: comparing each agent with those in the cells
    /// around it; at most all with all.
    template <std::invocable<std::uint32_t, std::span<const std::uint32_t>> Visit>
    QueryCost forEach(Visit&& visit, ParallelFor parallelFor = serialFor) {
        using Target = std::remove_reference_t<Visit>;
        const auto call = [](void* owner, std::uint32_t agent, const std::uint32_t* neighbours,
                             std::size_t count) {
            (*static_cast<Target*>(owner))(agent, std::span(neighbours, count));
        };
        return list({call, const_cast<void*>(static_cast<const void*>(std::addressof(visit)))},
                    parallelFor);
    }

    /// Sets counts[agent] to how many neighbours the agent has; size() numbers (asserted). Cheaper
    /// than forEach().
    QueryCost count(std::span<std::uint32_t> counts, ParallelFor parallelFor = serialFor);

    /// Sets counts[agent * groupCount + group] to how many neighbours of that group the agent has;
    /// size() * groupCount numbers (asserted), with a groupCount of at most kMostGroups (asserted).
    /// groupOf(ProxyId) is asked once for every agent, on the loop's threads; an agent whose group is not
    /// below groupCount is not counted. Cost: that of count(), and a pass over the agents.
    QueryCost countGroups(std::uint32_t groupCount, FunctionRef<std::uint32_t(ProxyId)> groupOf,
                          std::span<std::uint32_t> counts, ParallelFor parallelFor = serialFor);

    /// Bytes held, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back all memory, and with it all agents. Not within a filter or a visitor (asserted).
    void releaseMemory() noexcept;

private:
    /// Where a proxy is, and which one.
    struct Staged {
        std::array<Scalar, 3> position;
        std::uint32_t generation;  // 0: none that the filter accepts
    };
    struct Tile;

    static bool stageProxy(const Grid<Scalar>& grid, std::uint32_t proxyIndex, ProxyFilter filter,
                           Staged& staged);
    void stage(const Grid<Scalar>& grid, ProxyFilter filter, ParallelFor parallelFor);
    void chooseCells(const Grid<Scalar>& grid, Scalar radius, ProxyFilter filter);
    void sort(ParallelFor parallelFor);
    void prepare(Scalar radius);
    QueryCost list(const detail::RadiusVisitor& visitor, ParallelFor parallelFor);
    template <class Kernel>
    QueryCost ask(ParallelFor parallelFor, const Kernel& kernel);
    [[nodiscard]] std::unique_ptr<Tile> borrowTile();
    void returnTile(std::unique_ptr<Tile> tile);

    [[nodiscard]] std::uint32_t indexAt(std::size_t place) const noexcept {
        return few_.empty() ? static_cast<std::uint32_t>(place) : few_[place];
    }

    std::vector<std::uint32_t> few_;  // indices, where few have proxies
    std::size_t placeCount_ = 0;      // of those indices, or of all
    std::vector<Staged> staged_;      // by place among them
    std::vector<std::uint32_t> cellOfPlace_;
    detail::PeakWatch peaks_;
    std::uint32_t agentCount_ = 0;
    std::uint32_t leftOut_ = 0;
    detail::PointSample sample_;
    detail::WrappedGrid wrappedGrid_;

    std::vector<std::uint32_t> cellStart_;  // the first agent of each cell, and the end
    std::vector<std::uint32_t> places_;     // of agents, by cell
    std::vector<ProxyId> ids_;
    std::array<std::vector<Scalar>, 3> columns_;  // positions; kColumnPadding longer
    std::vector<std::uint32_t> numbers_;          // 0, 1, 2 ...; never shrinks
    std::vector<std::uint8_t> groups_;
    detail::RadiusView<Scalar> view_{};

    std::mutex tilesMutex_;
    std::vector<std::unique_ptr<Tile>> tiles_;  // idle; as many as threads were at work at once
};

extern template class RadiusSearch<float>;
extern template class RadiusSearch<double>;

}  // namespace hashphase
