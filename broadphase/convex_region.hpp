// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/aabb.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace hashphase {

/// How much of a box has to lie in a volume.
enum class Containment : std::uint8_t { touching, inside };

/// Everything that touches a convex volume, or lies wholly inside: the points p with
/// plane.signedDistance(p) >= 0 for each of its planes. Key: 0.
///
/// A box touches unless one of the planes has all of it outside. That never leaves out what touches
/// the volume, but finds a few boxes more, near its edges and corners; HexahedronRegion knows
/// better. Closed, and rounding errs to the side of a hit. No planes at all are all of space.
/// Normals may have any length. A NaN in a plane makes the region empty.
template <class Scalar>
class ConvexRegion {
public:
    using Plane = Eigen::Hyperplane<Scalar, 3>;
    static constexpr std::size_t kMostPlanes = 16;

    /// At most kMostPlanes planes (asserted).
    explicit ConvexRegion(std::span<const Plane> planes,
                          Containment containment = Containment::touching);

    [[nodiscard]] Scalar key(const Aabb<Scalar>& box) const noexcept;

    /// Everything; or nothing, where the region is empty.
    [[nodiscard]] Aabb<Scalar> bounds() const noexcept {
        using Limits = std::numeric_limits<Scalar>;
        const auto all =
            Vector3<Scalar>::Constant(isEmpty_ ? Limits::quiet_NaN() : Limits::infinity());
        return {-all, all};
    }

    [[nodiscard]] std::span<const Plane> planes() const noexcept {
        return std::span(planes_).first(planeCount_);
    }
    [[nodiscard]] Containment containment() const noexcept { return containment_; }

private:
    std::array<Plane, kMostPlanes> planes_;
    Containment containment_;
    std::size_t planeCount_;
    bool isEmpty_ = false;
};

extern template class ConvexRegion<float>;
extern template class ConvexRegion<double>;

}  // namespace hashphase
