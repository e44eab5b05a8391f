// SPDX-License-Identifier: Zlib
#include <integration/ai/sight.hpp>

#include <broadphase/core/query_scope.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/geometry/unit_scale.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase {
namespace {

/// The direction, neither so long nor so short that squares leave the range of numbers.
template <class Scalar>
Vector3<Scalar> ofOrdinaryLength(const Vector3<Scalar>& vector) noexcept {
    return vector * detail::unitScale(vector.cwiseAbs().maxCoeff());
}

/// The angle between two vectors of ordinary lengths, exact for small ones as well [rad].
template <class Scalar>
Scalar angleBetween(const Vector3<Scalar>& a, const Vector3<Scalar>& b) noexcept {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Stops at the first blocker found on a ray, whichever it is; not at what holds its beginning.
class CollectBlocker {
public:
    CollectBlocker(ProxyFilter blockers, ProxyId viewer, ProxyId target) noexcept
        : blockers_(blockers), viewer_(viewer), target_(target) {}

    template <class Scalar>
    void add(ProxyId id, Scalar key) {
        isBlocked_ =
            isBlocked_ || (key > 0 && key < 1 && id != viewer_ && id != target_ && blockers_(id));
    }
    [[nodiscard]] double limit() const noexcept { return isBlocked_ ? -1.0 : 1.0; }
    [[nodiscard]] bool isBlocked() const noexcept { return isBlocked_; }

private:
    ProxyFilter blockers_;
    ProxyId viewer_;
    ProxyId target_;
    bool isBlocked_ = false;
};

template <class Scalar>
bool isClear(const Grid<Scalar>& grid, const Vector3<Scalar>& from, const Vector3<Scalar>& to,
             ProxyFilter blockers, ProxyId viewer, ProxyId target, QueryCost& cost) {
    const RayRegion<Scalar> line(from, to);
    if (line.isEmpty()) {
        return false;
    }
    CollectBlocker collector(blockers, viewer, target);
    cost += grid.visit(line, collector);
    return !collector.isBlocked();
}

}  // namespace

template <class Scalar>
SightRegion<Scalar>::SightRegion(const Viewer<Scalar>& viewer)
    : ball_(viewer.eye, viewer.range),
      direction_(ofOrdinaryLength(viewer.direction)),
      halfAngle_(viewer.halfAngle) {
    const bool hasCone = viewer.direction.allFinite() && !viewer.direction.isZero(Scalar(0));
    if (!(halfAngle_ >= 0) || !(hasCone || looksEverywhere())) {
        ball_ = {viewer.eye, -1};
    }
}

template <class Scalar>
bool SightRegion<Scalar>::isInCone(const Vector3<Scalar>& position) const noexcept {
    const Vector3<Scalar> offset = position - ball_.center();
    if (looksEverywhere() || offset.isZero(Scalar(0))) {
        return true;
    }
    return offset.allFinite() && angleBetween(ofOrdinaryLength(offset), direction_) <= halfAngle_;
}

template <class Scalar>
Scalar SightRegion<Scalar>::key(const Aabb<Scalar>& box) const noexcept {
    const Vector3<Scalar> position = positionOf(box);
    const Scalar key = ball_.keyAt(position);
    return key >= 0 && isInCone(position) ? key : Scalar(-1);
}

// Along an axis, a cone of length 1 reaches as far as the direction in it that is nearest to the
// axis: 1 if the axis lies in the cone, else the cosine of the angle from the axis to its surface.
template <class Scalar>
Aabb<Scalar> SightRegion<Scalar>::bounds() const noexcept {
    using Limits = std::numeric_limits<Scalar>;
    Aabb<Scalar> bounds = ball_.bounds();
    if (looksEverywhere() || !bounds.min().allFinite() || !bounds.max().allFinite()) {
        return bounds;
    }
    constexpr Scalar rounding = 16 * Limits::epsilon();
    for (int axis = 0; axis < 3; ++axis) {
        const Vector3<Scalar> unit = Vector3<Scalar>::Unit(axis);
        const auto reach = [&](const Vector3<Scalar>& along, Scalar farthest) {
            const Scalar aside = angleBetween(along, direction_) - halfAngle_;
            const Scalar share = aside <= 0 ? Scalar(1) : std::max(std::cos(aside), Scalar(0));
            return std::min(farthest, (share + rounding) * farthest + Limits::min());
        };
        const Scalar eye = ball_.center()[axis];
        const Scalar margin = rounding * std::abs(eye);
        const Scalar low = eye - reach(-unit, eye - bounds.min()[axis]) - margin;
        const Scalar high = eye + reach(unit, bounds.max()[axis] - eye) + margin;
        bounds.min()[axis] = low;
        bounds.max()[axis] = high;
    }
    return bounds;
}

template <class Scalar>
bool hasLineOfSight(const Grid<Scalar>& grid, const Vector3<std::type_identity_t<Scalar>>& from,
                    const Vector3<std::type_identity_t<Scalar>>& to, ProxyFilter blockers,
                    ProxyId viewer, ProxyId target) {
    QueryCost cost;
    return isClear<Scalar>(grid, from, to, blockers, viewer, target, cost);
}

template <class Scalar>
bool canSee(const Grid<Scalar>& grid, const Viewer<Scalar>& viewer, ProxyId target,
            ProxyFilter blockers) {
    if (target == viewer.self || !grid.contains(target)) {
        return false;
    }
    const Aabb<Scalar>& box = grid.box(target);
    return SightRegion<Scalar>(viewer).key(box) >= 0 &&
           hasLineOfSight(grid, viewer.eye, positionOf(box), blockers, viewer.self, target);
}

template <class Scalar>
QueryCost visibleFrom(const Grid<Scalar>& grid, const Viewer<Scalar>& viewer,
                      std::vector<ProxyId>& seen, ProxyFilter targets, ProxyFilter blockers) {
    seen.clear();
    CollectAll all(seen);
    const auto isTarget = [&](ProxyId id) { return id != viewer.self && targets(id); };
    CollectIf inCone(all, isTarget);
    QueryCost cost = grid.visit(SightRegion<Scalar>(viewer), inCone);
    std::sort(seen.begin(), seen.end());
    std::erase_if(seen, [&](ProxyId id) {
        const Vector3<Scalar> position = positionOf(grid.box(id));
        return !isClear(grid, viewer.eye, position, blockers, viewer.self, id, cost);
    });
    return cost;
}

template <class Scalar>
QueryCost Sight<Scalar>::look(const Grid<Scalar>& grid, std::span<const Viewer<Scalar>> viewers,
                              ProxyFilter targets, ProxyFilter blockers, ParallelFor parallelFor) {
    HASHPHASE_ASSERT(
        !detail::QueryScope::isWithin(this),
        "Sight::look() was called from within its own filters. Call it after that look() returns.");
    constexpr std::size_t grain = 16;
    viewerCount_ = 0;  // nobody has seen anybody, should memory run out
    found_.resize(std::max(found_.size(), viewers.size()));
    // A query for each viewer, and one for each that it may see.
    constexpr std::size_t kAny = 1 << 20;  // each looks along many rays
    grid.expectQueries(viewers.empty() ? 0 : std::numeric_limits<std::size_t>::max());
    if (!viewers.empty()) {
        grid.expectRays(kAny);
    }
    parallelFor(viewers.size(), grain, [&](std::size_t begin, std::size_t end) {
        const detail::QueryScope scope(this);
        for (std::size_t i = begin; i < end; ++i) {
            found_[i].cost = visibleFrom(grid, viewers[i], found_[i].seen, targets, blockers);
        }
    });
    viewerCount_ = viewers.size();
    QueryCost cost;
    for (std::size_t i = 0; i < viewerCount_; ++i) {
        cost += found_[i].cost;
    }
    return cost;
}

template <class Scalar>
std::span<const ProxyId> Sight<Scalar>::seenBy(std::size_t viewer) const {
    HASHPHASE_ASSERT(viewer < viewerCount_,
                     "Sight::seenBy(): there is no such viewer. Pass an index into the viewers of "
                     "the last look().");
    return found_[viewer].seen;
}

template class HASHPHASE_INSTANCE_EXPORT SightRegion<float>;
template class HASHPHASE_INSTANCE_EXPORT SightRegion<double>;
template class HASHPHASE_INSTANCE_EXPORT Sight<float>;
template class HASHPHASE_INSTANCE_EXPORT Sight<double>;
template bool hasLineOfSight(const Grid<float>&, const Vector3<float>&, const Vector3<float>&,
                             ProxyFilter, ProxyId, ProxyId);
template bool hasLineOfSight(const Grid<double>&, const Vector3<double>&, const Vector3<double>&,
                             ProxyFilter, ProxyId, ProxyId);
template bool canSee(const Grid<float>&, const Viewer<float>&, ProxyId, ProxyFilter);
template bool canSee(const Grid<double>&, const Viewer<double>&, ProxyId, ProxyFilter);
template QueryCost visibleFrom(const Grid<float>&, const Viewer<float>&, std::vector<ProxyId>&,
                               ProxyFilter, ProxyFilter);
template QueryCost visibleFrom(const Grid<double>&, const Viewer<double>&, std::vector<ProxyId>&,
                               ProxyFilter, ProxyFilter);

}  // namespace hashphase
