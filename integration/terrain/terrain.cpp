// SPDX-License-Identifier: Zlib
#include <integration/terrain/terrain.hpp>

#include <integration/terrain/terrain_changes.inl>
#include <integration/terrain/terrain_queries.inl>

#include <broadphase/diagnostics.hpp>

namespace hashphase {

template <class Scalar>
Terrain<Scalar>::Terrain(Grid<Scalar>& grid, UpAxis up)
    : grid_(&grid), up_(static_cast<int>(up)), alongX_((up_ + 2) % 3), alongZ_((up_ + 1) % 3) {}

template <class Scalar>
Terrain<Scalar>::~Terrain() {
    HASHPHASE_ASSERT(changed_.empty(),
                     "Terrain: the terrain was destroyed before a ChangedGround of it. Destroy "
                     "that first: declare it after the terrain.");
    for (ChangedGround<Scalar>* changed : changed_) {
        changed->terrain_ = nullptr;
    }
    changed_.clear();
    clear();
}

template <class Scalar>
void Terrain<Scalar>::setSeamTolerance(std::optional<Scalar> tolerance) {
    const bool isGood = !tolerance || (*tolerance >= 0 && detail::isFinite(*tolerance) &&
                                       static_cast<double>(*tolerance) <= kFarthest);
    HASHPHASE_ASSERT(isGood,
                     "Terrain::setSeamTolerance(): the tolerance is negative, NaN or too large. "
                     "Pass 0 to Terrain::kFarthest [m].");
    if (isGood) {
        setTolerance_ = tolerance;
    }
}

template <class Scalar>
detail::GroundTriangle<Scalar> Terrain<Scalar>::groundTriangle(const Corners& corners) const {
    const double area =
        detail::orientation(above(corners[0]), above(corners[1]), above(corners[2]));
    detail::GroundTriangle<Scalar> triangle{};
    triangle.hasHeights = area < 0 || area > 0;
    triangle.isTurned = area < 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point& corner = corners[triangle.isTurned ? (3 - i) % 3 : i];
        triangle.x[i] = corner[alongX_];
        triangle.z[i] = corner[alongZ_];
        triangle.y[i] = corner[up_];
    }
    if (triangle.hasHeights) {
        triangle.sizeExponent = detail::sizeExponentOf(triangle);
        triangle.normal = detail::normalOf(triangle);
        triangle.hasNormal = triangle.normal != Vector3<double>::Zero();
    }
    return triangle;
}

template <class Scalar>
void Terrain<Scalar>::shiftOrigin(const Point& shift) {
    HASHPHASE_ASSERT(
        shift.allFinite(),
        "Terrain::shiftOrigin(): the shift is NaN or infinite. Pass finite coordinates [m].");
    if (!shift.allFinite()) {
        return;
    }
    for (std::uint32_t number = 0; number < size(); ++number) {
        Corners shifted = corners(number);
        for (Point& corner : shifted) {
            corner -= shift;
        }
        const std::uint8_t seamGroup = triangles_[number].seamGroup;
        triangles_[number] = groundTriangle(shifted);
        triangles_[number].seamGroup = seamGroup;
    }
    bounds_.translate(-shift);
    nextBounds_.translate(-shift);
    seamGroups_.shiftOrigin(shift[alongX_], shift[alongZ_]);
    for (ChangedGround<Scalar>* changed : changed_) {
        changed->shiftOrigin(shift);
    }
}

template <class Scalar>
typename Terrain<Scalar>::Corners Terrain<Scalar>::corners(std::uint32_t triangle) const {
    HASHPHASE_ASSERT(triangle < size(),
                     "Terrain::corners(): there is no such triangle. Pass a number below size().");
    const detail::GroundTriangle<Scalar>& stored = triangles_[triangle];
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
        Point& corner = corners[stored.isTurned ? (3 - i) % 3 : i];
        corner[alongX_] = stored.x[i];
        corner[alongZ_] = stored.z[i];
        corner[up_] = stored.y[i];
    }
    return corners;
}

template <class Scalar>
Vector3<Scalar> Terrain<Scalar>::normal(std::uint32_t triangle) const {
    HASHPHASE_ASSERT(triangle < size(),
                     "Terrain::normal(): there is no such triangle. Pass a number below size().");
    const auto& stored = triangles_[triangle].normal;
    Point normal;
    normal[alongX_] = static_cast<Scalar>(stored.x());
    normal[up_] = static_cast<Scalar>(stored.y());
    normal[alongZ_] = static_cast<Scalar>(stored.z());
    return normal;
}

template <class Scalar>
ProxyId Terrain<Scalar>::proxy(std::uint32_t triangle) const {
    HASHPHASE_ASSERT(triangle < size(),
                     "Terrain::proxy(): there is no such triangle. Pass a number below size().");
    return proxies_[triangle];
}

template <class Scalar>
std::size_t Terrain<Scalar>::memoryBytes() const noexcept {
    return triangles_.capacity() * sizeof(triangles_[0]) + proxies_.capacity() * sizeof(ProxyId) +
           triangleOfProxy_.capacity() * sizeof(std::uint32_t) + seamGroups_.memoryBytes() +
           free_.memoryBytes();
}

template class HASHPHASE_INSTANCE_EXPORT Terrain<float>;
template class HASHPHASE_INSTANCE_EXPORT Terrain<double>;

}  // namespace hashphase
