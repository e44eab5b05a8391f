// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies that a viewer sees: in range, in a cone, and not hidden by a blocker.
//
// Seen      A proxy is seen if its position (position_region.hpp) is in range and in the cone, and the line from the
//           eye to the position meets no blocker's box before the position. To test shapes, use
//           SpatialHashBroadphase::closestRay().
// Blockers  A filter chooses blockers. The viewer, the target, and boxes that contain the eye (such as a house) never
//           block.
// Closed    The cone includes its surface. A line that only touches a box meets the box. In both cases, rounding may
//           change the result.
// Threads   For all functions, the thread rules of grid queries hold (grid.hpp). Sight::look() calls the filters on
//           all threads of `parallelFor`. During look(), no other thread may use the Sight object.
// Bad data  A viewer sees nothing if its range or half angle is negative or NaN, or its eye is not finite. With a
//           half angle below pi, it also sees nothing if its direction is zero or not finite. A proxy is not seen if
//           its distance along an axis overflows.

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

/// An agent that looks. By default, looks from the origin in all directions.
template <class Scalar>
struct Viewer {
    Vector3<Scalar> eye = Vector3<Scalar>::Zero();           ///< [m]
    Vector3<Scalar> direction = Vector3<Scalar>::UnitX();    ///< axis of the cone; any length but 0
    Scalar range = std::numeric_limits<Scalar>::infinity();  ///< [m]
    /// Angle between the direction and the cone's surface [rad]. If pi or more, the direction is ignored.
    Scalar halfAngle = std::numbers::pi_v<Scalar>;
    ProxyId self{};  ///< the viewer's own proxy, if it has one
};

/// A query region: finds every proxy whose position is in the viewer's range and cone, even behind blockers, and even
/// the viewer's own proxy. The key of a found proxy is its squared distance [m^2] from the eye. A position at the eye
/// is in every cone.
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
    Vector3<Scalar> direction_;  // of length about 1
    Scalar halfAngle_;
};

/// Returns true if the line from `from` to `to` [m] meets no blocker's box before `to`. `viewer` and `target` never
/// block. Returns false if an end or the length of the line is not finite. Cost: one ray query, which stops at the
/// first blocker that it finds.
template <class Scalar>
[[nodiscard]] HASHPHASE_AI_EXPORT bool hasLineOfSight(
    const Grid<Scalar>& grid, const Vector3<std::type_identity_t<Scalar>>& from,
    const Vector3<std::type_identity_t<Scalar>>& to, ProxyFilter blockers = acceptAll,
    ProxyId viewer = {}, ProxyId target = {});

/// Returns true if the viewer sees `target`. Returns false if `target` is the viewer's own proxy or not in the grid.
/// Cost: at most as hasLineOfSight().
template <class Scalar>
[[nodiscard]] HASHPHASE_AI_EXPORT bool canSee(const Grid<Scalar>& grid,
                                              const Viewer<Scalar>& viewer, ProxyId target,
                                              ProxyFilter blockers = acceptAll);

/// Finds all proxies that `targets` accepts and that the viewer sees. Replaces `seen`, sorted by id. Returns the
/// cost. Cost: one Grid::visit() of the cone, and one ray query for each target in the cone.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost visibleFrom(const Grid<Scalar>& grid, const Viewer<Scalar>& viewer,
                                          std::vector<ProxyId>& seen,
                                          ProxyFilter targets = acceptAll,
                                          ProxyFilter blockers = acceptAll);

/// As visibleFrom(), for many viewers. Reuses its memory: allocates only if a frame needs more than before.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT Sight {
public:
    /// Finds the proxies that each viewer sees. Forgets earlier results. Returns the cost. Asserted: filters do not
    /// call look().
    QueryCost look(const Grid<Scalar>& grid, std::span<const Viewer<Scalar>> viewers,
                   ProxyFilter targets = acceptAll, ProxyFilter blockers = acceptAll,
                   ParallelFor parallelFor = serialFor);

    /// Returns the proxies that this viewer saw in the last look(), sorted by id. Valid until the next look().
    /// Asserted: `viewer` is an index into `viewers` of the last look().
    [[nodiscard]] std::span<const ProxyId> seenBy(std::size_t viewer) const;

private:
    struct Found {
        std::vector<ProxyId> seen;
        QueryCost cost;
    };
    std::vector<Found> found_;  // by viewer; never shrinks
    std::size_t viewerCount_ = 0;
};

extern template class SightRegion<float>;
extern template class SightRegion<double>;
extern template class Sight<float>;
extern template class Sight<double>;

}  // namespace hashphase
