// SPDX-License-Identifier: Zlib
#include <integration/terrain/terrain.hpp>

#include <integration/terrain/terrain_queries.inl>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/on_failure.hpp>
#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace hashphase {

template <class Scalar>
Terrain<Scalar>::Terrain(Grid<Scalar>& grid, UpAxis up)
    : grid_(&grid), up_(static_cast<int>(up)), alongX_((up_ + 2) % 3), alongZ_((up_ + 1) % 3) {}

template <class Scalar>
Terrain<Scalar>::~Terrain() {
    clear();
}

template <class Scalar>
AddedTriangles Terrain<Scalar>::add(std::span<const Point> corners) {
    HASHPHASE_ASSERT(corners.size() % 3 == 0, "Each triangle has three corners.");
    return addAll(corners.size() / 3, [&](std::size_t i) {
        return Corners{corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
    });
}

template <class Scalar>
AddedTriangles Terrain<Scalar>::add(std::span<const Point> vertices,
                                    std::span<const std::uint32_t> indices) {
    HASHPHASE_ASSERT(indices.size() % 3 == 0, "Each triangle has three corners.");
    const Point none = Point::Constant(std::numeric_limits<Scalar>::quiet_NaN());
    return addAll(indices.size() / 3, [&](std::size_t i) {
        Corners corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t index = indices[3 * i + k];
            corners[k] = index < vertices.size() ? vertices[index] : none;
        }
        return corners;
    });
}

// All of them or, should memory run out, none.
template <class Scalar>
template <class CornersOf>
AddedTriangles Terrain<Scalar>::addAll(std::size_t count, const CornersOf& cornersOf) {
    AddedTriangles added;
    added.first = size();
    const Aabb<Scalar> boundsBefore = bounds_;
    const Point tilesBefore = tilesPerMetre_;
    Aabb<Scalar> box;
    const detail::OnFailure addNone([&] {
        removeFrom(added.first);
        bounds_ = boundsBefore;
        tilesPerMetre_ = tilesBefore;
    });
    grid_->reserve(grid_->size() + count);
    detail::ensureCapacity(triangles_, triangles_.size() + count);
    detail::ensureCapacity(proxies_, proxies_.size() + count);
    for (std::size_t i = 0; i < count; ++i) {
        addOne(cornersOf(i), added, box);
    }
    if (!box.isEmpty()) {
        noteReach(box);
    }
    return added;
}

template <class Scalar>
void Terrain<Scalar>::noteReach(const Aabb<Scalar>& mesh) {
    const Aabb<double> box = mesh.template cast<double>();
    const double heights = std::max(std::abs(box.min()[up_]), std::abs(box.max()[up_]));
    const double extent = (box.max() - box.min()).maxCoeff();
    meshReach_ =
        std::max(meshReach_, static_cast<Scalar>(std::min(extent + heights, kLargestMesh)));
}

template <class Scalar>
void Terrain<Scalar>::addOne(const Corners& corners, AddedTriangles& added,
                             Aabb<Scalar>& boxOfAll) {
    HASHPHASE_ASSERT(size() < kNone, "A terrain holds fewer than 2^32 - 1 triangles.");
    const std::uint32_t number = size();
    ++added.count;
    const auto isGood = [](const Point& corner) {
        return (corner.array().abs() <= std::numeric_limits<Scalar>::max()).all() &&
               (corner.template cast<double>().array().abs() <= kFarthest).all();
    };
    if (!std::all_of(corners.begin(), corners.end(), isGood)) {
        const Point nan = Point::Constant(std::numeric_limits<Scalar>::quiet_NaN());
        added.refused.push_back(number);
        triangles_.push_back(groundTriangle({nan, nan, nan}));
        proxies_.emplace_back();
        return;
    }
    Aabb<Scalar> box(corners[0]);
    box.extend(corners[1]);
    box.extend(corners[2]);
    boxOfAll.extend(box);
    bounds_.extend(box);
    tilesPerMetre_ = bounds_.sizes().cwiseInverse() * Scalar(kTilesPerSide);
    triangles_.push_back(groundTriangle(corners));
    const ProxyId id = grid_->add(box, Mobility::resting);
    proxies_.push_back(id);
    if (triangleOfProxy_.size() <= id.index) {
        triangleOfProxy_.resize(id.index + std::size_t{1}, kNone);
    }
    triangleOfProxy_[id.index] = number;
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
void Terrain<Scalar>::clear() {
    removeFrom(0);
    triangleOfProxy_.clear();
    bounds_.setEmpty();
    meshReach_ = 0;
    shifted_.setZero();
    isShifted_ = false;
}

template <class Scalar>
void Terrain<Scalar>::removeFrom(std::size_t first) {
    for (std::size_t i = first; i < proxies_.size(); ++i) {
        const ProxyId id = proxies_[i];
        if (id.isNull()) {
            continue;
        }
        grid_->remove(id);
        if (id.index < triangleOfProxy_.size()) {
            triangleOfProxy_[id.index] = kNone;
        }
    }
    triangles_.resize(first);
    proxies_.resize(first);
}

template <class Scalar>
void Terrain<Scalar>::shiftOrigin(const Point& shift) {
    HASHPHASE_ASSERT(shift.allFinite(), "The origin is shifted by what is finite.");
    if (!shift.allFinite()) {
        return;
    }
    for (std::uint32_t number = 0; number < size(); ++number) {
        Corners shifted = corners(number);
        for (Point& corner : shifted) {
            corner -= shift;
        }
        triangles_[number] = groundTriangle(shifted);
    }
    bounds_.translate(-shift);
    shifted_ += shift;
    isShifted_ = !shifted_.isZero(0);
}

template <class Scalar>
typename Terrain<Scalar>::Corners Terrain<Scalar>::corners(std::uint32_t triangle) const {
    HASHPHASE_ASSERT(triangle < size(), "Triangles have numbers below size().");
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
    HASHPHASE_ASSERT(triangle < size(), "Triangles have numbers below size().");
    const auto& stored = triangles_[triangle].normal;
    Point normal;
    normal[alongX_] = static_cast<Scalar>(stored.x());
    normal[up_] = static_cast<Scalar>(stored.y());
    normal[alongZ_] = static_cast<Scalar>(stored.z());
    return normal;
}

template <class Scalar>
ProxyId Terrain<Scalar>::proxy(std::uint32_t triangle) const {
    HASHPHASE_ASSERT(triangle < size(), "Triangles have numbers below size().");
    return proxies_[triangle];
}

template <class Scalar>
std::size_t Terrain<Scalar>::memoryBytes() const noexcept {
    return triangles_.capacity() * sizeof(triangles_[0]) + proxies_.capacity() * sizeof(ProxyId) +
           triangleOfProxy_.capacity() * sizeof(std::uint32_t);
}

template class HASHPHASE_INSTANCE_EXPORT Terrain<float>;
template class HASHPHASE_INSTANCE_EXPORT Terrain<double>;

}  // namespace hashphase
