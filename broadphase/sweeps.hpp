// SPDX-License-Identifier: Zlib
#pragma once

// Sweeps: for proxies that move far in a frame, such as bullets, and must not miss pairs on their way.
//
// A sweeping proxy pairs with every proxy that it touches on its way; two of them, if they touch at the same time.
//
//     Sweeps<float> sweeps(grid);
//     Pairs<float> pairs(grid, &sweeps);
//     sweeps.set(bullet, velocity * seconds);
//     pairs.update();  // the proxies that the bullet touches on its way
//
// A frame   Grid::move() the proxy to where it begins the frame, set() how far it moves, then Pairs::update(). Both
//           hold until set again.
// Queries   of the grid use the box in the grid, which may differ from the moving one, for example around the whole
//           way. visit() finds the proxy on its way, more exactly.
// Modes     find the same pairs at different costs: the exact firstContact() confirms each pair.
// Cost      Sweeping takes time at any speed; Sweep::box reads the whole box around the way. Other proxies cost no
//           more.
// Threads   visit() may run on any thread; all else needs the grid for itself.
// Units     metres; times are fractions of the frame, 0 to 1
// Bad data  A NaN or infinite displacement counts as none. The message handler reports the first one.
// Misuse    Asserted: the grid contains the id.
// Source    Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by Spatial Hashing", 2005

#include <broadphase/core/query_scope.hpp>
#include <broadphase/export.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/moving_box.hpp>
#include <broadphase/proxy_filter.hpp>
#include <broadphase/search/contact_search.hpp>
#include <broadphase/sweep_mode.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// How far proxies move in a frame, for Pairs and for queries.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Sweeps {
public:
    /// Keeps a reference to the grid, which must outlive this object (asserted). Pass the object to Pairs.
    explicit Sweeps(Grid<Scalar>& grid);
    Sweeps(const Sweeps&) = delete;
    Sweeps& operator=(const Sweeps&) = delete;

    /// Lets the proxy's box sweep by `displacement` [m] in each frame, until the next set(). Zero, or Sweep::none,
    /// ends the sweep. Throws std::bad_alloc, and changes nothing. Asserted: not within a query that forbids changes.
    /// Cost: O(1) amortised.
    void set(ProxyId id, const Vector3<Scalar>& displacement, Sweep sweep = Sweep::automatic);

    /// Lets `way.box` sweep instead. The proxy's pairs then follow from `way` alone; queries of the grid use the box
    /// in the grid. Grid::shiftOrigin() shifts both.
    void set(ProxyId id, const MovingBox<Scalar>& way, Sweep sweep = Sweep::automatic);

    /// Returns the box that moves, where it begins, and its displacement [m]. Without a sweep: the box in the grid,
    /// and a displacement of zero.
    [[nodiscard]] MovingBox<Scalar> motion(ProxyId id) const;

    /// Number of sweeping proxies, including those removed from the grid since the last update.
    [[nodiscard]] std::size_t size() const noexcept { return sweeping_.motions.size(); }

    /// As Grid::visit(), but finds sweeping proxies on their ways: by the box around the way, or boxes around up to
    /// 64 parts. Finds every proxy that passes through the region, and perhaps near misses. Key: the smallest key of
    /// these boxes. A PositionRegion, or a region for boxes inside, finds for certain only the box where the way
    /// begins. Cost: as Grid::visit(), plus the parts of each sweeping proxy's way.
    template <class Region, class Collector>
    QueryCost visit(const Region& region, Collector& collector) const;

    /// Returns what the sweeps cost in the last Pairs::update().
    [[nodiscard]] const SweepCost& lastCost() const noexcept { return sweeping_.search.cost(); }
    /// Bytes held, including unused capacity.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees surplus room, also for indices that the grid has dropped, and scratch that the next update allocates
    /// again. Asserted: not within a query. Cost: O(dropped indices), and moving the rest.
    void releaseUnusedMemory() noexcept;

    /// Returns the broken invariant as a sentence; empty when it holds: every motion is listed by its index, and no
    /// other index is.
    [[nodiscard]] std::string validate() const;

    /// For the library's own parts. It may change with any version.
    [[nodiscard]] detail::Sweeping<Scalar>& sweeping() noexcept { return sweeping_; }

private:
    using Box = Aabb<Scalar>;
    using Motion = detail::Motion<Scalar>;

    [[nodiscard]] std::optional<Scalar> keyOnTheWay(const auto& region, const Motion& motion) const;
    void set(const Motion& motion);

    Grid<Scalar>& grid_;
    detail::Sweeping<Scalar> sweeping_;
    bool reportedBadData_ = false;
};

template <class Scalar>
std::optional<Scalar> Sweeps<Scalar>::keyOnTheWay(const auto& region, const Motion& motion) const {
    const MovingBox<Scalar> way = sweeping_.motions.wayOf(motion);
    const auto keyOf = [&](const Box& box) -> std::optional<Scalar> {
        const Scalar key = region.key(box);
        return key >= 0 ? std::optional(key) : std::nullopt;
    };
    std::optional<Scalar> least = keyOf(way.box);
    const auto add = [&least](const std::optional<Scalar>& key) {
        if (key && (!least || *key < *least)) {
            least = key;
        }
    };
    const std::optional<Scalar> ofAll = keyOf(sweptBounds(way));
    if (!ofAll || motion.sweep == Sweep::box) {
        add(ofAll);
        return least;
    }
    // Parts of about the box's size; a longer way has larger parts.
    constexpr double mostParts = 64;
    const auto size = static_cast<double>(way.box.sizes().maxCoeff());
    const auto distance = static_cast<double>(way.displacement.cwiseAbs().maxCoeff());
    const int count = static_cast<int>(
        distance < mostParts * size ? std::max(std::ceil(distance / size), 1.0) : mostParts);
    for (int i = 0; i < count; ++i) {
        add(keyOf(sweptBounds(way, static_cast<double>(i) / count, (i + 1.0) / count)));
    }
    return least;
}

template <class Scalar>
template <class Region, class Collector>
QueryCost Sweeps<Scalar>::visit(const Region& region, Collector& collector) const {
    const auto stands = [this](ProxyId id) { return !sweeping_.motions.sweeps(id); };
    CollectIf standing(collector, stands);
    QueryCost cost = grid_.visit(region, standing);
    const detail::QueryScope scope(&grid_.store(), detail::QueryScope::Changes::allowed);
    // No iterators or references: the collector may change the sweeps. Sweeps that begin meanwhile are not searched.
    const std::vector<Motion>& motions = sweeping_.motions.all;
    const std::size_t count = motions.size();
    for (std::size_t i = 0; i < count && collector.limit() >= 0; ++i) {
        const Motion motion = motions[i];
        if (!grid_.contains(motion.id)) {
            continue;
        }
        ++cost.boxesTested;
        const std::optional<Scalar> key = keyOnTheWay(region, motion);
        if (key && detail::isWanted(*key, collector)) {
            ++cost.hits;
            collector.add(motion.id, *key);
        }
    }
    return cost;
}

extern template class Sweeps<float>;
extern template class Sweeps<double>;

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
