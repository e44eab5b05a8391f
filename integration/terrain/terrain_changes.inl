// SPDX-License-Identifier: Zlib
#pragma once

// How triangles come, change and go: terrain.cpp compiles it. A call first looks at all that it was handed, and
// makes room for it; from then on nothing can fail.

#include <integration/terrain/terrain.hpp>

#include <integration/terrain/changed_ground.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hashphase {
namespace detail {

template <class Scalar>
[[nodiscard]] Vector3<Scalar> nanPoint() noexcept {
    return Vector3<Scalar>::Constant(std::numeric_limits<Scalar>::quiet_NaN());
}

/// How many triangles have so many corners.
[[nodiscard]] inline std::size_t triangleCount(std::size_t cornerCount) {
    HASHPHASE_ASSERT(cornerCount % 3 == 0,
                     "Terrain: the number of corners or indices is not a multiple of 3. Pass 3 for "
                     "each triangle.");
    return cornerCount % 3 == 0 ? cornerCount / 3 : 0;
}

/// The corners of a triangle; NaN where there is no such vertex.
template <class Scalar>
[[nodiscard]] std::array<Vector3<Scalar>, 3> cornersAt(std::span<const Vector3<Scalar>> corners,
                                                       std::size_t triangle) {
    return {corners[3 * triangle], corners[3 * triangle + 1], corners[3 * triangle + 2]};
}
template <class Scalar>
[[nodiscard]] std::array<Vector3<Scalar>, 3> cornersAt(std::span<const Vector3<Scalar>> vertices,
                                                       std::span<const std::uint32_t> indices,
                                                       std::size_t triangle) {
    std::array<Vector3<Scalar>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t index = indices[3 * triangle + k];
        corners[k] = index < vertices.size() ? vertices[index] : nanPoint<Scalar>();
    }
    return corners;
}

template <class Scalar>
[[nodiscard]] Aabb<Scalar> boxOf(const std::array<Vector3<Scalar>, 3>& corners) noexcept {
    Aabb<Scalar> box(corners[0]);
    box.extend(corners[1]);
    box.extend(corners[2]);
    return box;
}

}  // namespace detail

/// What a call is to do.
template <class Scalar>
struct Terrain<Scalar>::Plan {
    AddedTriangles triangles;
    Aabb<Scalar> box;  // of those that are not refused
};

template <class Scalar>
AddedTriangles Terrain<Scalar>::add(std::span<const Point> corners) {
    return addAll(detail::triangleCount(corners.size()),
                  [&](std::size_t i) { return detail::cornersAt(corners, i); });
}

template <class Scalar>
AddedTriangles Terrain<Scalar>::add(std::span<const Point> vertices,
                                    std::span<const std::uint32_t> indices) {
    return addAll(detail::triangleCount(indices.size()),
                  [&](std::size_t i) { return detail::cornersAt(vertices, indices, i); });
}

template <class Scalar>
AddedTriangles Terrain<Scalar>::replace(std::uint32_t first, std::span<const Point> corners) {
    return replaceAll(first, detail::triangleCount(corners.size()),
                      [&](std::size_t i) { return detail::cornersAt(corners, i); });
}

template <class Scalar>
AddedTriangles Terrain<Scalar>::replace(std::uint32_t first, std::span<const Point> vertices,
                                        std::span<const std::uint32_t> indices) {
    return replaceAll(first, detail::triangleCount(indices.size()),
                      [&](std::size_t i) { return detail::cornersAt(vertices, indices, i); });
}

template <class Scalar>
AddedTriangles Terrain<Scalar>::addAll(std::size_t count, CornersOf cornersOf) {
    const std::uint32_t first = free_.firstFit(count, size());
    HASHPHASE_ASSERT(count <= kNone - first,
                     "Terrain::add(): the terrain would have 2^32 triangles or more. Add "
                     "fewer, or use another terrain.");
    if (count > kNone - first) {
        return {};
    }
    Plan plan = prepare(first, count, cornersOf);
    const std::size_t limit = std::max<std::size_t>(size(), first + count);
    triangles_.resize(limit, detail::noTriangle<Scalar>());
    proxies_.resize(limit);
    free_.take(first, plan.triangles.count);
    write(plan, cornersOf);
    return std::move(plan.triangles);
}

template <class Scalar>
AddedTriangles Terrain<Scalar>::replaceAll(std::uint32_t first, std::size_t count,
                                           CornersOf cornersOf) {
    HASHPHASE_ASSERT(areTaken(first, count),
                     "Terrain::replace(): some of these triangles do not exist. Pass numbers that "
                     "add() returned and that were not removed.");
    if (!areTaken(first, count)) {
        return {};
    }
    Plan plan = prepare(first, count, cornersOf);
    write(plan, cornersOf);
    tightenBounds(plan.triangles.count);
    return std::move(plan.triangles);
}

// Names those that are refused, and makes room for all that comes.
template <class Scalar>
auto Terrain<Scalar>::prepare(std::uint32_t first, std::size_t count, CornersOf cornersOf) -> Plan {
    const auto isGood = [](const Point& corner) {
        return (corner.array().abs() <= std::numeric_limits<Scalar>::max()).all() &&
               (corner.template cast<double>().array().abs() <= kFarthest).all();
    };
    Plan plan{{first, static_cast<std::uint32_t>(count), {}}, {}};
    std::size_t newProxyCount = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t number = first + i;
        const Corners corners = cornersOf(i);
        if (!std::all_of(corners.begin(), corners.end(), isGood)) {
            plan.triangles.refused.push_back(static_cast<std::uint32_t>(number));
            continue;
        }
        plan.box.extend(detail::boxOf(corners));
        newProxyCount += number < size() && !proxies_[number].isNull() ? 0 : 1;
    }
    seamGroups_.reserveOne();
    detail::ensureCapacity(triangles_, first + count);
    detail::ensureCapacity(proxies_, first + count);
    if (newProxyCount > 0) {
        detail::ensureCapacity(triangleOfProxy_, grid_->indexLimit() + newProxyCount);
        grid_->store().makeRoom(grid_->size() + newProxyCount);
    }
    return plan;
}

template <class Scalar>
void Terrain<Scalar>::write(const Plan& plan, CornersOf cornersOf) {
    const auto& [first, count, refused] = plan.triangles;
    std::uint8_t seamGroup = 0;
    if (!plan.box.isEmpty()) {
        const Aabb<double> box = plan.box.template cast<double>();
        const double heights = std::max(std::abs(box.min()[up_]), std::abs(box.max()[up_]));
        seamGroup = seamGroups_.add((box.max() - box.min()).maxCoeff() + heights,
                                    count - static_cast<std::uint32_t>(refused.size()));
    }
    auto nextRefused = refused.begin();
    for (std::uint32_t i = 0; i < count; ++i) {
        if (nextRefused != refused.end() && *nextRefused == first + i) {
            unsetTriangle(first + i);
            ++nextRefused;
        } else {
            setTriangle(first + i, cornersOf(i), seamGroup);
        }
    }
}

template <class Scalar>
void Terrain<Scalar>::setTriangle(std::uint32_t number, const Corners& corners,
                                  std::uint8_t seamGroup) {
    const Aabb<Scalar> box = detail::boxOf(corners);
    ProxyId& id = proxies_[number];
    const bool isNew = id.isNull();
    if (isNew) {
        id = grid_->add(box, Mobility::resting);
        if (triangleOfProxy_.size() <= id.index) {
            triangleOfProxy_.resize(id.index + std::size_t{1}, kNone);
        }
        triangleOfProxy_[id.index] = number;
        noteChange(box);
    } else {
        seamGroups_.remove(triangles_[number].seamGroup);
        if (corners != this->corners(number)) {
            noteChange(grid_->box(id));
            noteChange(box);
        }
        grid_->move(id, box);
    }
    triangles_[number] = groundTriangle(corners);
    triangles_[number].seamGroup = seamGroup;
    includeInBounds(box);
}

template <class Scalar>
void Terrain<Scalar>::unsetTriangle(std::uint32_t number) {
    const ProxyId id = proxies_[number];
    if (id.isNull()) {
        return;
    }
    noteChange(grid_->box(id));
    seamGroups_.remove(triangles_[number].seamGroup);
    triangleOfProxy_[id.index] = kNone;
    grid_->remove(id);
    proxies_[number] = {};
    triangles_[number] = detail::noTriangle<Scalar>();
}

template <class Scalar>
void Terrain<Scalar>::remove(std::uint32_t first, std::uint32_t count) {
    HASHPHASE_ASSERT(areTaken(first, count),
                     "Terrain::remove(): some of these triangles do not exist. Pass numbers that "
                     "add() returned and that were not removed.");
    if (!areTaken(first, count)) {
        return;
    }
    free_.reserveOne();
    for (std::uint32_t i = 0; i < count; ++i) {
        unsetTriangle(first + i);
    }
    free_.free(first, count);
    tightenBounds(count);
}

template <class Scalar>
void Terrain<Scalar>::clear() {
    for (std::uint32_t number = 0; number < size(); ++number) {
        unsetTriangle(number);
    }
    triangles_.clear();
    proxies_.clear();
    triangleOfProxy_.clear();
    free_.clear();
    seamGroups_.clear();
    bounds_.setEmpty();
    nextBounds_.setEmpty();
    boundsNext_ = 0;
}

template <class Scalar>
bool Terrain<Scalar>::areTaken(std::uint32_t first, std::size_t count) const noexcept {
    return first <= size() && count <= size() - first &&
           !free_.hasAny(first, static_cast<std::uint32_t>(count));
}

template <class Scalar>
void Terrain<Scalar>::includeInBounds(const Aabb<Scalar>& box) noexcept {
    nextBounds_.extend(box);
    bounds_.extend(box);
    tilesPerMetre_ = bounds_.sizes().cwiseInverse() * Scalar(kTilesPerSide);
}

// Looks at a few triangles for each that has changed. When it has seen all, what has left meanwhile counts no more.
template <class Scalar>
void Terrain<Scalar>::tightenBounds(std::uint32_t changedCount) noexcept {
    constexpr std::uint64_t kLooksPerChange = 2;
    for (std::uint64_t i = 0; i < kLooksPerChange * changedCount; ++i) {
        if (boundsNext_ == size()) {
            bounds_ = std::exchange(nextBounds_, {});
            boundsNext_ = 0;
        }
        if (const ProxyId id = proxies_[boundsNext_++]; !id.isNull()) {
            nextBounds_.extend(grid_->box(id));
        }
    }
    tilesPerMetre_ = bounds_.sizes().cwiseInverse() * Scalar(kTilesPerSide);
}

template <class Scalar>
void Terrain<Scalar>::noteChange(const Aabb<Scalar>& box) noexcept {
    for (ChangedGround<Scalar>* changed : changed_) {
        changed->note(box);
    }
}

}  // namespace hashphase
