// SPDX-License-Identifier: Zlib
#pragma once

// Proxies that move so far in a frame that it matters what they pass. A proxy that sweeps stands, for
// Pairs, wherever it passes during the frame: it makes a pair with everything that it touches on its
// way, at the same time, of what stands and of what sweeps as well.
//
// A frame   Grid::move() to where the proxy is when the frame begins, set() how far it moves until
//           the frame ends, then Pairs::update(). Both hold until they are set again.
// Queries   of the grid find the proxy by its box in the grid, which may be another one than that which
//           moves: as large as the way, for those who ask while the proxy is anywhere on it. visit()
//           finds it on its way, more exactly.
// Modes     cost differently and find the same: pairs are confirmed by firstContact(), which is
//           exact.
// Cost      what sweeps costs time, whatever its speed, but for Sweep::box, which reads all that is in
//           the box around its way; what does not sweep costs what it did.
// Threads   visit() is const and may run anywhere; everything else needs the grid for itself.
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
class HASHPHASE_BROADPHASE_EXPORT Sweeps {
public:
    /// Keeps a reference to the grid, which must outlive this object. Hand it to Pairs.
    explicit Sweeps(Grid<Scalar>& grid);
    Sweeps(const Sweeps&) = delete;
    Sweeps& operator=(const Sweeps&) = delete;

    /// Lets the proxy's box move by `displacement` [m] in this frame, from where it is. No
    /// displacement, or Sweep::none, ends that. Where memory runs out, nothing has changed.
    /// Cost: O(1) amortised.
    void set(ProxyId id, const Vector3<Scalar>& displacement, Sweep sweep = Sweep::automatic);

    /// The same for a box of its own, from which alone the pairs of the proxy follow as long as it
    /// sweeps. The proxy's box in the grid is what queries see. Grid::shiftOrigin() shifts both.
    void set(ProxyId id, const MovingBox<Scalar>& way, Sweep sweep = Sweep::automatic);

    /// The box that moves, where it begins, and its displacement; when the proxy does not sweep, its
    /// box, and none.
    [[nodiscard]] MovingBox<Scalar> motion(ProxyId id) const;

    /// Number of proxies that sweep, those included that were removed since the last update.
    [[nodiscard]] std::size_t size() const noexcept { return sweeping_.motions.size(); }

    /// Grid::visit(), but what sweeps is found wherever the box around its way, or around a part of
    /// it, has a key: nothing that it passes is left out, some that it just misses may be found.
    /// A PositionRegion, or one of boxes that lie inside, finds for certain only what does where it
    /// stands: a larger box need not have a key where a smaller one has.
    /// Cost: that of Grid::visit(), and for everything that sweeps one look at its way, or at 64 parts
    /// of it at most, whatever its speed.
    template <class Region, class Collector>
    QueryCost visit(const Region& region, Collector& collector) const;

    /// Of the last Pairs::update().
    [[nodiscard]] const SweepCost& lastCost() const noexcept { return sweeping_.search.cost(); }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back what is not used: room for more than sweep, and for indices that the grid has given back.
    /// The next update takes again what it needs. Not within a query (asserted). Cost: O(indices that the
    /// grid has given back), and moving what is left.
    void releaseUnusedMemory() noexcept;

    /// Says which invariant is broken, in a sentence; empty when all hold:
    /// - Every motion is listed by its index, and no other index is.
    [[nodiscard]] std::string validate() const;

    /// What the library's own parts read.
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
