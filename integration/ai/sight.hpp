// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies that a viewer sees: within a range and a cone, without a blocker in between.
//
// Seen      A proxy is seen if its position (position_region.hpp) is in the cone, and the line from the eye to the
//           position meets no blocker's box before its end. For exact shapes, use
//           SpatialHashBroadphase::closestRay().
// Blockers  A filter chooses them. The viewer, the target, and boxes that contain the eye, such as a house, never
//           block.
// Closed    The cone contains its surface, and a line that grazes a box meets it, except for rounding.
// Threads   Reads the grid, as queries do. Sight::look() asks the filters on all threads of its loop.
// Bad data  A viewer sees nothing with a negative or NaN range or half angle, an eye that is not finite, or a cone
//           whose direction is zero or not finite. A proxy is not seen if the distance overflows.

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

/// An agent that looks. By default it looks everywhere from the origin.
template <class Scalar>
struct Viewer {
    Vector3<Scalar> eye = Vector3<Scalar>::Zero();           ///< [m]
    Vector3<Scalar> direction = Vector3<Scalar>::UnitX();    ///< of any length
    Scalar range = std::numeric_limits<Scalar>::infinity();  ///< [m]
    /// Angle between the direction and the cone's surface [rad]. With pi or more the direction is ignored.
    Scalar halfAngle = std::numbers::pi_v<Scalar>;
    ProxyId self{};  ///< the viewer's own proxy, if it has one
};

/// Every proxy whose position is in the viewer's cone, also behind blockers. Key: squared distance [m^2] from the
/// eye. A position at the eye is in every cone.
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

/// Returns true if the line between the two points [m] meets no blocker's box before `to`. Ignores `viewer` and
/// `target`. Returns false if an end or the distance is not finite. Cost: a ray that stops at the first blocker.
template <class Scalar>
[[nodiscard]] HASHPHASE_AI_EXPORT bool hasLineOfSight(
    const Grid<Scalar>& grid, const Vector3<std::type_identity_t<Scalar>>& from,
    const Vector3<std::type_identity_t<Scalar>>& to, ProxyFilter blockers = acceptAll,
    ProxyId viewer = {}, ProxyId target = {});

/// Returns true if the viewer sees `target`; false for its own proxy, and for one that is not in the grid. Cost: at
/// most as hasLineOfSight().
template <class Scalar>
[[nodiscard]] HASHPHASE_AI_EXPORT bool canSee(const Grid<Scalar>& grid,
                                              const Viewer<Scalar>& viewer, ProxyId target,
                                              ProxyFilter blockers = acceptAll);

/// Finds all proxies that `targets` accepts and the viewer sees. Replaces `seen`, sorted by id. Returns the cost.
/// Cost: Grid::visit() of the cone, and a ray for each target in it.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost visibleFrom(const Grid<Scalar>& grid, const Viewer<Scalar>& viewer,
                                          std::vector<ProxyId>& seen,
                                          ProxyFilter targets = acceptAll,
                                          ProxyFilter blockers = acceptAll);

/// visibleFrom() for many viewers. Keeps its memory: a frame like the last one allocates nothing.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT Sight {
public:
    /// Looks for all viewers, and forgets earlier results. Returns the cost. Asserted: not called from a filter.
    QueryCost look(const Grid<Scalar>& grid, std::span<const Viewer<Scalar>> viewers,
                   ProxyFilter targets = acceptAll, ProxyFilter blockers = acceptAll,
                   ParallelFor parallelFor = serialFor);

    /// Returns the proxies that a viewer saw, sorted by id, valid until the next look(). Asserted: `viewer` is an
    /// index of look()'s span.
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
