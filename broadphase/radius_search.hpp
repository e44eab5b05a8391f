// SPDX-License-Identifier: Zlib
#pragma once

// Finds the neighbours of all agents within a radius, at once, as AI needs in every frame.
//
//     search.take(grid, 10);
//     search.forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) { ... });
//
// A frame     take() copies the positions of all proxies; then ask any number of questions.
// Agents      proxies at the centres of their boxes (positionOf() in position_region.hpp). Each take() numbers them
//             from 0, in spatial order.
// Neighbours  the other agents with (dx^2 + dy^2) + dz^2 <= radius^2, each operation rounded to Scalar. Radii outside
//             2^-60 to 2^60 (double: 2^-480 to 2^480) are first scaled by a power of two. So the relation is
//             symmetric, and equal on all instruction sets and any number of threads.
// Bad data    A proxy with a NaN, infinite or inverted box is no agent: see leftOutCount(). A negative or NaN radius
//             gives no neighbours, an infinite one all other agents.
// Threads     All except accessors needs this object for itself. take() reads the grid, as queries do.
// Units       metres, or the grid's unit of length
// See also    Neighbours (neighbours.hpp) lists pairs of boxes.

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

/// Finds neighbours. Keeps its memory: a frame like the last one allocates nothing, except for additional threads.
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

    /// Takes the present proxies that the filter accepts, for questions about `radius` [m]. The filter runs on the
    /// threads of `parallelFor`, for some proxies twice. If memory runs out or the filter throws, there are no
    /// agents. Surplus memory is freed after 256 calls in a row with over eight times the room needed. Asserted: the
    /// filter changes neither the grid nor this object. Cost: a few passes over the grid's proxies.
    void take(const Grid<Scalar>& grid, Scalar radius, ProxyFilter filter = acceptAll,
              ParallelFor parallelFor = serialFor);

    /// Number of agents.
    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(ids_.size());
    }

    /// Number of accepted proxies without a position, which are no agents.
    [[nodiscard]] std::uint32_t leftOutCount() const noexcept { return leftOut_; }

    /// Returns the proxy of an agent, or its position [m]; ids() returns all ids by agent. Asserted: agent < size().
    [[nodiscard]] ProxyId id(std::uint32_t agent) const {
        HASHPHASE_ASSERT(agent < size(),
                         "RadiusSearch::id(): there is no such agent. Pass a number below size().");
        return ids_[agent];
    }
    [[nodiscard]] std::span<const ProxyId> ids() const noexcept { return ids_; }
    [[nodiscard]] Point position(std::uint32_t agent) const {
        HASHPHASE_ASSERT(
            agent < size(),
            "RadiusSearch::position(): there is no such agent. Pass a number below size().");
        return {columns_[0][agent], columns_[1][agent], columns_[2][agent]};
    }

    // --- Questions -------------------------------------------------------------------------------

    /// Calls visit(std::uint32_t agent, std::span<const std::uint32_t> neighbours) for every agent, on the threads of
    /// `parallelFor`. The neighbours are valid during the call; their order does not depend on `parallelFor`. Returns
    /// the cost; hits are neighbours. Asserted: visit() asks this object only for ids and positions. Cost: each agent
    /// against the cells around it; at most all with all.
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

    /// Sets counts[agent] to the agent's number of neighbours. Cheaper than forEach(). Asserted: counts.size() ==
    /// size().
    QueryCost count(std::span<std::uint32_t> counts, ParallelFor parallelFor = serialFor);

    /// Sets counts[agent * groupCount + group] to the agent's number of neighbours in that group. Asks
    /// groupOf(ProxyId) once per agent, on the threads of `parallelFor`. Agents with a group of groupCount or more
    /// are not counted. Asserted: counts.size() == size() * groupCount; groupCount <= kMostGroups. Cost: as count(),
    /// and a pass over the agents.
    QueryCost countGroups(std::uint32_t groupCount, FunctionRef<std::uint32_t(ProxyId)> groupOf,
                          std::span<std::uint32_t> counts, ParallelFor parallelFor = serialFor);

    /// Bytes held, including unused capacity.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees all memory, and removes all agents. Asserted: not within a filter or a visitor.
    void releaseMemory() noexcept;

private:
    /// Position and generation of a proxy.
    struct Staged {
        std::array<Scalar, 3> position;
        std::uint32_t generation;  // 0: not alive, or refused by the filter
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

    std::vector<std::uint32_t> few_;  // indices, if few have proxies
    std::size_t placeCount_ = 0;      // number of these indices, or of all
    std::vector<Staged> staged_;      // by place among them
    std::vector<std::uint32_t> cellOfPlace_;
    detail::PeakWatch peaks_;
    std::uint32_t agentCount_ = 0;
    std::uint32_t leftOut_ = 0;
    detail::PointSample sample_;
    detail::WrappedGrid wrappedGrid_;

    std::vector<std::uint32_t> cellStart_;  // first agent of each cell, and the end
    std::vector<std::uint32_t> places_;     // of agents, by cell
    std::vector<ProxyId> ids_;
    std::array<std::vector<Scalar>, 3> columns_;  // positions; kColumnPadding longer
    std::vector<std::uint32_t> numbers_;          // 0, 1, 2 ...; never shrinks
    std::vector<std::uint8_t> groups_;
    detail::RadiusView<Scalar> view_{};

    std::mutex tilesMutex_;
    std::vector<std::unique_ptr<Tile>> tiles_;  // idle; one per thread at work at once
};

extern template class RadiusSearch<float>;
extern template class RadiusSearch<double>;

}  // namespace hashphase
