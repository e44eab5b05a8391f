// SPDX-License-Identifier: Zlib
#pragma once

// Sweeps are for proxies that move far in a frame, such as bullets, and must not miss pairs along their paths.
//
// A sweeping proxy pairs with every proxy that it touches along its path. Two sweeping proxies pair if their moving
// boxes touch at some moment. Crossing paths are not enough.
//
//     Sweeps<float> sweeps(grid);
//     Pairs<float> pairs(grid, &sweeps);
//     sweeps.set(bullet, velocity * seconds);
//     pairs.update();  // the proxies that the bullet touches along its path
//
// A frame   Call Grid::move() with the box at the start of the frame, set() with the displacement, then
//           Pairs::update(). Box and displacement stay until you set them again.
// Queries   Grid queries use the box in the grid. This box may differ from the moving box, for example contain the
//           whole path. Sweeps::visit() searches along the path, more exactly.
// Modes     All modes except Sweep::none find the same pairs, at different costs: the exact firstContact() confirms
//           each pair.
// Cost      A sweep takes time even if its path is short. With Sweep::box, the cost grows with the box around the
//           path. Proxies that do not sweep cost no more than without sweeps.
// Threads   visit() may run on several threads at the same time. During other calls, no other thread may use the
//           grid or Sweeps.
// Units     metres; times are fractions of the frame, 0 to 1
// Bad data  A proxy with a NaN or infinite displacement does not sweep. The message handler reports the first case.
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

/// The displacements of proxies in a frame, for Pairs and for queries.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Sweeps {
public:
    /// Keeps a reference to the grid, which must outlive this object (asserted). Pass this object to Pairs.
    explicit Sweeps(Grid<Scalar>& grid);
    Sweeps(const Sweeps&) = delete;
    Sweeps& operator=(const Sweeps&) = delete;

    /// Lets the proxy's box sweep by `displacement` [m] in each frame, until the next set() of this proxy. A zero
    /// displacement or Sweep::none ends the sweep. On std::bad_alloc, changes nothing. Asserted: not called within
    /// visitEach(), a ConvexRegion query or a PairFilter (grid.hpp, Callbacks). Cost: O(1) amortised.
    void set(ProxyId id, const Vector3<Scalar>& displacement, Sweep sweep = Sweep::automatic);

    /// Lets `way.box` sweep instead of the box in the grid. The proxy's pairs depend only on `way`. Grid queries
    /// still use the box in the grid. Grid::shiftOrigin() shifts both boxes.
    void set(ProxyId id, const MovingBox<Scalar>& way, Sweep sweep = Sweep::automatic);

    /// Returns the moving box at the start of its path, and its displacement [m]. If the proxy does not sweep: the
    /// box in the grid, and a zero displacement.
    [[nodiscard]] MovingBox<Scalar> motion(ProxyId id) const;

    /// Number of sweeping proxies, including proxies removed from the grid since the last update.
    [[nodiscard]] std::size_t size() const noexcept { return sweeping_.motions.size(); }

    /// Like Grid::visit(), but finds sweeping proxies along their paths. Tests the box at the start of the path. With
    /// Sweep::box, also tests the box around the path. With other modes, also tests boxes around up to 64 parts of
    /// the path. The key is the smallest key of these boxes. Finds every proxy that passes through the region. May
    /// also find proxies that pass near it. With a PositionRegion or Containment::inside, a sweeping proxy is certain
    /// to be found only if its box at the start of the path is in the region. Cost: as Grid::visit(), plus a test for
    /// each part of each path.
    template <class Region, class Collector>
    QueryCost visit(const Region& region, Collector& collector) const;

    /// Returns what the sweeps cost in the last Pairs::update().
    [[nodiscard]] const SweepCost& lastCost() const noexcept { return sweeping_.search.cost(); }
    /// Bytes held, including unused capacity.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees unused capacity, including memory for indices from Grid::indexLimit() on. To lower this limit, call
    /// Grid::releaseUnusedMemory() first. Also frees scratch memory that the next update allocates again. Asserted:
    /// this thread runs no query. Cost: O(freed indices), plus a copy of the remaining data.
    void releaseUnusedMemory() noexcept;

    /// Invariant: each motion is stored at the index of its proxy, and no other index has a motion. Returns a
    /// sentence if the invariant is broken; else an empty string.
    [[nodiscard]] std::string validate() const;

    /// Internal data. It may change with any version.
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
    if (hasNan(way.box)) {
        return std::nullopt;  // region.key() might find it
    }
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
    // A part is about as long as the box. If the path is over 64 times as long, parts are longer.
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
    // By index: the collector may change the sweeps. Skips sweeps that begin during this loop.
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
