// SPDX-License-Identifier: Zlib
#pragma once

// Who is seen from where: within a range and a cone, and with nothing in between.
//
// Seen      A proxy is seen when its position (position_region.hpp) is in the viewer's cone, and the
//           straight line from the eye to it meets no blocker's box before its end. Only boxes are
//           looked at: where exact shapes are to block, ask Bullet for the closest hit along the
//           same line (SpatialHashBroadphase::closestRay()).
// Blockers  are chosen by a filter. The viewer's own proxy and the target's never block, nor does a
//           box that holds the eye: from within, a box does not tell what stands in the way, and the
//           ground, a terrain or a house is around many an eye.
// Closed    The cone contains its surface, and a line that grazes a box meets it; both but for
//           rounding.
// Threads   Reads the grid, as queries do; the filters are asked on all threads.
// Bad data  A range or half angle that is negative or NaN, an eye that is not finite, a direction
//           that is zero or not finite where there is a cone: nobody is seen. Nor is who is so far
//           away that the distance overflows.

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

/// Who looks, and where to.
template <class Scalar>
struct Viewer {
    Vector3<Scalar> eye = Vector3<Scalar>::Zero();
    Vector3<Scalar> direction = Vector3<Scalar>::UnitX();    ///< of any length
    Scalar range = std::numeric_limits<Scalar>::infinity();  ///< [m]
    /// Between the direction and the cone's surface [rad]; pi or more looks everywhere, whatever the
    /// direction.
    Scalar halfAngle = std::numbers::pi_v<Scalar>;
    ProxyId self{};  ///< the viewer's own proxy, if it has one
};

/// Every proxy whose position is in the viewer's cone; nothing is in the way. Key: squared distance
/// [m^2] from the eye. At the eye itself one is in every cone.
template <class Scalar>
class HASHPHASE_AI_EXPORT SightRegion {
public:
    explicit SightRegion(const Viewer<Scalar>& viewer);

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

/// True when the line meets no box before `to` that the filter makes a blocker, those of `viewer`
/// and `target` aside. False when an end, or the distance, is not finite. Cost: a ray that stops at
/// the first blocker found; at most one test for each proxy.
template <class Scalar>
[[nodiscard]] HASHPHASE_AI_EXPORT bool hasLineOfSight(
    const Grid<Scalar>& grid, const Vector3<std::type_identity_t<Scalar>>& from,
    const Vector3<std::type_identity_t<Scalar>>& to, ProxyFilter blockers = acceptAll,
    ProxyId viewer = {}, ProxyId target = {});

/// True when the viewer sees the proxy. Not itself, nor one that is not in the grid (any more). Cost:
/// at most that of hasLineOfSight().
template <class Scalar>
[[nodiscard]] HASHPHASE_AI_EXPORT bool canSee(const Grid<Scalar>& grid,
                                              const Viewer<Scalar>& viewer, ProxyId target,
                                              ProxyFilter blockers = acceptAll);

/// Finds all whom the viewer sees of those that `targets` accepts, sorted, in place of what `seen`
/// held. Cost: the cells around the cone, and a ray for each target in it; at most one test for each
/// proxy, and for each proxy and target.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost visibleFrom(const Grid<Scalar>& grid, const Viewer<Scalar>& viewer,
                                          std::vector<ProxyId>& seen,
                                          ProxyFilter targets = acceptAll,
                                          ProxyFilter blockers = acceptAll);

/// visibleFrom() for many. Keeps its memory: a frame like the last one allocates nothing.
template <class Scalar>
class HASHPHASE_AI_EXPORT Sight {
public:
    /// Looks for all viewers, in place of those before. The result does not depend on `parallelFor`.
    QueryCost look(const Grid<Scalar>& grid, std::span<const Viewer<Scalar>> viewers,
                   ProxyFilter targets = acceptAll, ProxyFilter blockers = acceptAll,
                   ParallelFor parallelFor = serialFor);

    /// Whom the viewer at this place in look()'s span (asserted) saw, sorted. Valid until the next
    /// look().
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
