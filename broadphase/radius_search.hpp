// SPDX-License-Identifier: Zlib
#pragma once

// Finds, for every agent, the other agents within a radius. Does so in one pass, as AI needs in every frame.
//
//     search.take(grid, 10);
//     search.forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) { ... });
//
// A frame     Call take(), which copies the positions of all proxies. Then search any number of times.
// Agents      An agent is a proxy as a point: the centre of its box (positionOf() in position_region.hpp). Each
//             take() numbers the agents from 0, in spatial order.
// Neighbours  The neighbours of an agent are the other agents with (dx^2 + dy^2) + dz^2 <= radius^2. Each operation
//             rounds to Scalar. For radii below 2^-60 or above 2^60 (double: below 2^-480 or above 2^480), dx, dy, dz
//             and the radius are first multiplied by the same power of two. If a finds b, b finds a. Results are
//             equal on all instruction sets, with any number of threads.
// Bad data    A proxy with a NaN, infinite or inverted box is not an agent: see leftOutCount(). A negative or NaN
//             radius gives no neighbours. An infinite radius gives all other agents.
// Threads     Const functions may run on several threads at the same time. During other calls, no other thread may
//             use this object, except that visit() may call const functions. take() reads the grid, as queries do.
// Units       metres, or the grid's unit of length
// See also    Neighbours (neighbours.hpp), which lists pairs of boxes.

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

/// Finds neighbours. Keeps its memory: a frame that needs no more memory and uses no more threads than before
/// allocates nothing.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT RadiusSearch {
public:
    using Point = Vector3<Scalar>;

    /// The largest groupCount that countGroups() accepts.
    static constexpr std::uint32_t kMostGroups = detail::kMostGroups;

    RadiusSearch();
    ~RadiusSearch();
    RadiusSearch(const RadiusSearch&) = delete;
    RadiusSearch& operator=(const RadiusSearch&) = delete;

    // --- The agents ------------------------------------------------------------------------------

    /// Makes agents of all proxies that the filter accepts, for searches with `radius` [m]. Calls the filter on this
    /// thread and the threads of `parallelFor`, twice for some proxies. If memory runs out or the filter throws,
    /// take() throws, and there are no agents. Frees unused memory after 256 calls in a row with over eight times the
    /// needed capacity. Asserted: the filter changes neither the grid nor this object.
    /// Cost: O(proxies), in a few passes.
    void take(const Grid<Scalar>& grid, Scalar radius, ProxyFilter filter = acceptAll,
              ParallelFor parallelFor = serialFor);

    /// Number of agents.
    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(ids_.size());
    }

    /// Number of accepted proxies that are not agents because they have no position.
    [[nodiscard]] std::uint32_t leftOutCount() const noexcept { return leftOut_; }

    /// id(agent) and ids()[agent] return the proxy of an agent. position() returns the position of an agent [m].
    /// Asserted: agent < size().
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

    // --- Searches --------------------------------------------------------------------------------

    /// Calls visit(std::uint32_t agent, std::span<const std::uint32_t> neighbours) for every agent, on the threads of
    /// `parallelFor`. The span is valid until visit() returns. The order of neighbours does not depend on
    /// `parallelFor`. Returns the cost; `hits` is the number of neighbours of all agents. Asserted: visit() calls
    /// only const functions of this object. Cost: O(n m) for n agents, with m agents in the cells around each; at
    /// most O(n^2).
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

    /// Sets counts[agent * groupCount + group] to the agent's number of neighbours in that group. Calls
    /// groupOf(ProxyId) once per agent, on the threads of `parallelFor`. Does not count neighbours whose group is
    /// groupCount or more. Asserted: counts.size() == size() * groupCount; groupCount <= kMostGroups.
    /// Cost: as count(), plus a pass over the agents.
    QueryCost countGroups(std::uint32_t groupCount, FunctionRef<std::uint32_t(ProxyId)> groupOf,
                          std::span<std::uint32_t> counts, ParallelFor parallelFor = serialFor);

    /// Bytes held, including unused capacity.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees all memory, and removes all agents. Asserted: no filter or visitor is running.
    void releaseMemory() noexcept;

private:
    /// Position and generation of a proxy.
    struct Staged {
        std::array<Scalar, 3> position;
        std::uint32_t generation;  // 0 if not alive, or refused by the filter
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

    // Returns the ProxyId::index at this place.
    [[nodiscard]] std::uint32_t indexAt(std::size_t place) const noexcept {
        return few_.empty() ? static_cast<std::uint32_t>(place) : few_[place];
    }

    std::vector<std::uint32_t> few_;  // all used indices if they are few, else empty
    std::size_t placeCount_ = 0;      // few_.size(), or Grid::indexLimit() if few_ is empty
    std::vector<Staged> staged_;      // indexed by place: see indexAt()
    std::vector<std::uint32_t> cellOfPlace_;
    detail::PeakWatch peaks_;
    std::uint32_t agentCount_ = 0;
    std::uint32_t leftOut_ = 0;
    detail::PointSample sample_;
    detail::WrappedGrid wrappedGrid_;

    std::vector<std::uint32_t> cellStart_;  // first agent of each cell; at the end, size()
    std::vector<std::uint32_t> places_;     // place of each agent, sorted by cell
    std::vector<ProxyId> ids_;
    std::array<std::vector<Scalar>, 3> columns_;  // positions of agents, then padding
    std::vector<std::uint32_t> numbers_;          // 0, 1, 2 ...; shrinks only in releaseMemory()
    std::vector<std::uint8_t> groups_;
    detail::RadiusView<Scalar> view_{};

    mutable std::mutex tilesMutex_;
    std::vector<std::unique_ptr<Tile>> tiles_;  // idle tiles; each working thread borrows one
};

extern template class RadiusSearch<float>;
extern template class RadiusSearch<double>;

}  // namespace hashphase
