// SPDX-License-Identifier: Zlib
#pragma once

// Proxies that move so far in a frame that it matters what they pass, such as bullets. A proxy that sweeps
// makes a pair with every proxy that it touches on its way. Two proxies that sweep make a pair when they
// touch at the same time.
//
//     Sweeps<float> sweeps(grid);
//     Pairs<float> pairs(grid, &sweeps);
//     sweeps.set(bullet, velocity * seconds);
//     pairs.update();  // what the bullet touches on its way
//
// A frame   Grid::move() to where the proxy is when the frame begins, set() how far it moves until the frame
//           ends, then Pairs::update(). Both hold until they are set again.
// Queries   of the grid find the proxy by its box in the grid. This may be another box than the one that
//           moves: one around the whole way finds the proxy wherever it is on the way. visit() finds it on
//           its way, more exactly.
// Modes     find the same pairs at different costs: firstContact(), which is exact, confirms each pair.
// Cost      A proxy that sweeps costs time, whatever its speed; with Sweep::box the cost grows with the box
//           around its way, which is read as a whole. Proxies that do not sweep cost nothing more.
// Threads   visit() is const and may run on any thread; everything else needs the grid for itself.
// Units     metres; times are fractions of the frame, 0 to 1.
// Bad data  A displacement that is NaN or infinite counts as none, and is reported once through the
//           message handler.
// Misuse    An id that the grid does not contain is asserted.
//
// After Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by Spatial
// Hashing", 2005: hashing over time, by a box or by a line of cells, chosen by behaviour.

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

/// Knows how far proxies move in a frame, for Pairs and for queries.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Sweeps {
public:
    /// Keeps a reference to the grid, which must outlive this object (asserted). Hand the object to Pairs.
    explicit Sweeps(Grid<Scalar>& grid);
    Sweeps(const Sweeps&) = delete;
    Sweeps& operator=(const Sweeps&) = delete;

    /// Lets the proxy's box move by `displacement` [m] in each frame, from where it is, until set() is called
    /// again. A displacement of zero, or Sweep::none, ends the sweep. Not within a query that takes no
    /// changes (asserted). Where memory runs out, nothing has changed. Cost: O(1) amortised.
    void set(ProxyId id, const Vector3<Scalar>& displacement, Sweep sweep = Sweep::automatic);

    /// Lets `way.box` move instead of the proxy's box. While the proxy sweeps, its pairs follow from `way`
    /// alone; queries of the grid see the box in the grid. Grid::shiftOrigin() shifts both.
    void set(ProxyId id, const MovingBox<Scalar>& way, Sweep sweep = Sweep::automatic);

    /// Returns the box that moves, where it begins, and its displacement [m]. For a proxy that does not
    /// sweep: its box in the grid, and a displacement of zero.
    [[nodiscard]] MovingBox<Scalar> motion(ProxyId id) const;

    /// Number of proxies that sweep, including proxies removed from the grid since the last update.
    [[nodiscard]] std::size_t size() const noexcept { return sweeping_.motions.size(); }

    /// As Grid::visit(), but looks for a proxy that sweeps on its way: by the box around the way, or by boxes
    /// around parts of it. Finds every proxy that passes through the region, and perhaps some that just miss
    /// it. The key is the smallest one of these boxes.
    /// With a PositionRegion, or a region for boxes that lie inside, only the box where the proxy stands is
    /// found for certain: a larger box need not have a key where a smaller one has.
    /// Cost: as Grid::visit(), and for each proxy that sweeps one look at its way, or at up to 64 parts of
    /// the way, whatever its speed.
    template <class Region, class Collector>
    QueryCost visit(const Region& region, Collector& collector) const;

    /// What the sweeps cost in the last Pairs::update().
    [[nodiscard]] const SweepCost& lastCost() const noexcept { return sweeping_.search.cost(); }
    /// Bytes held, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back unused memory: room for more proxies than sweep, and for indices that the grid has given
    /// back. The next update takes again what it needs. Not within a query (asserted). Cost: O(indices that
    /// the grid has given back), and moving what is left.
    void releaseUnusedMemory() noexcept;

    /// Says which invariant is broken, in a sentence; empty when all hold:
    /// - Every motion is listed by its index, and no other index is.
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
    // Parts of about its own size; so long a way that it would take more of them is seen less sharply.
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
    // Neither by iterators nor by reference: the collector may change what sweeps. What begins to is
    // not looked for.
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
