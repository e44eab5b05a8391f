// SPDX-License-Identifier: Zlib
#pragma once

// Which proxies a viewer sees: within a range and a cone, and with nothing in between.
//
//     Viewer<float> guard{.eye = eye, .direction = forward, .range = 30, .halfAngle = 0.8F, .self = id};
//     if (canSee(grid, guard, player)) { ... }
//
// Seen      A viewer sees a proxy when the proxy's position (position_region.hpp) is in the viewer's cone,
//           and the straight line from the eye to the position meets no blocker's box before its end. Only
//           boxes count: where exact shapes are to block, ask Bullet for the closest hit along the line
//           (SpatialHashBroadphase::closestRay()).
// Blockers  A filter chooses them. The viewer's own proxy and the target's never block, nor does a box that
//           holds the eye: the ground, a terrain or a house is around many an eye, and its box does not tell
//           what stands in the way.
// Closed    The cone contains its surface, and a line that grazes a box meets it; both but for rounding.
// Threads   Reads the grid, as queries do. Sight::look() asks the filters on all threads of its loop.
// Bad data  A viewer sees nothing with a range or half angle that is negative or NaN, an eye that is not
//           finite, or a direction that is zero or not finite where there is a cone. A proxy so far away that
//           the distance overflows is not seen.

#include <broadphase/grid.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/ai/export.hpp>

#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <type_traits>
#include <vector>

namespace hashphase {

/// An agent that looks, and where it looks to. By default it looks everywhere from the origin.
template <class Scalar>
struct Viewer {
    Vector3<Scalar> eye = Vector3<Scalar>::Zero();           ///< [m]
    Vector3<Scalar> direction = Vector3<Scalar>::UnitX();    ///< of any length
    Scalar range = std::numeric_limits<Scalar>::infinity();  ///< [m]
    /// Between the direction and the cone's surface [rad]. With pi or more the viewer looks everywhere, and
    /// the direction does not matter.
    Scalar halfAngle = std::numbers::pi_v<Scalar>;
    ProxyId self{};  ///< the viewer's own proxy, if it has one
};

/// Every proxy whose position is in the viewer's cone, whatever stands in the way. Key: squared distance
/// [m^2] from the eye. A position at the eye itself is in every cone.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT SightRegion {
public:
    explicit SightRegion(const Viewer<Scalar>& viewer);

    /// See regions.hpp.
    [[nodiscard]] Scalar key(const Aabb<Scalar>& box) const noexcept;
    [[nodiscard]] Aabb<Scalar> bounds() const noexcept;

private:
    [[nodiscard]] bool isInCone(const Vector3<Scalar>& position) const noexcept;
    [[nodiscard]] bool looksEverywhere() const noexcept {
        return halfAngle_ >= std::numbers::pi_v<Scalar>;
    }

    PositionRegion<Scalar> ball_;
    Vector3<Scalar> direction_;  // about as long as 1
    Scalar halfAngle_;
};

/// True when the line between the two points [m] meets no blocker's box before `to`. Blockers are the
/// proxies that the filter accepts, without `viewer` and `target`. False when an end, or the distance, is not
/// finite. Cost: a ray that stops at the first blocker found; at most one test for each proxy.
template <class Scalar>
[[nodiscard]] HASHPHASE_AI_EXPORT bool hasLineOfSight(
    const Grid<Scalar>& grid, const Vector3<std::type_identity_t<Scalar>>& from,
    const Vector3<std::type_identity_t<Scalar>>& to, ProxyFilter blockers = acceptAll,
    ProxyId viewer = {}, ProxyId target = {});

/// True when the viewer sees the proxy `target`. False for the viewer's own proxy, and for a proxy that is
/// not in the grid or was removed. Cost: at most that of hasLineOfSight().
template <class Scalar>
[[nodiscard]] HASHPHASE_AI_EXPORT bool canSee(const Grid<Scalar>& grid,
                                              const Viewer<Scalar>& viewer, ProxyId target,
                                              ProxyFilter blockers = acceptAll);

/// Finds all proxies that the viewer sees and that `targets` accepts. Replaces what `seen` held; sorted by
/// id. Returns the cost. Cost: the cells around the cone, and a ray for each target in the cone; at most one
/// test for each proxy, and one for each proxy and target.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost visibleFrom(const Grid<Scalar>& grid, const Viewer<Scalar>& viewer,
                                          std::vector<ProxyId>& seen,
                                          ProxyFilter targets = acceptAll,
                                          ProxyFilter blockers = acceptAll);

/// visibleFrom() for many viewers. Keeps its memory: a frame like the last one allocates nothing.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT Sight {
public:
    /// Looks for all viewers, and forgets those of the last call. Returns the cost of all. The result does
    /// not depend on `parallelFor`. Not from within one of the filters (asserted).
    QueryCost look(const Grid<Scalar>& grid, std::span<const Viewer<Scalar>> viewers,
                   ProxyFilter targets = acceptAll, ProxyFilter blockers = acceptAll,
                   ParallelFor parallelFor = serialFor);

    /// The proxies that a viewer saw, sorted by id; `viewer` is its place in look()'s span (asserted). Valid
    /// until the next look().
    [[nodiscard]] std::span<const ProxyId> seenBy(std::size_t viewer) const;

private:
    struct Found {
        std::vector<ProxyId> seen;
        QueryCost cost;
    };
    std::vector<Found> found_;  // never shrinks
    std::size_t viewerCount_ = 0;
};

extern template class SightRegion<float>;
extern template class SightRegion<double>;
extern template class Sight<float>;
extern template class Sight<double>;

}  // namespace hashphase
