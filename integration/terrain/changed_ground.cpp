// SPDX-License-Identifier: Zlib
#include <integration/terrain/changed_ground.hpp>

#include <broadphase/diagnostics.hpp>
#include <broadphase/regions.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace hashphase {
namespace {

// Whether what touches one of the boxes is just what touches the box around both: they touch, and differ along
// one axis at most. So do the halves of a quad, and a triangle that has risen.
template <class Scalar>
bool makeOneBox(const Aabb<Scalar>& a, const Aabb<Scalar>& b) noexcept {
    int sameCount = 0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        sameCount += a.min()[axis] == b.min()[axis] && a.max()[axis] == b.max()[axis] ? 1 : 0;
    }
    return sameCount >= 2 && overlaps(a, b);
}

}  // namespace

/// A collector that leaves out the terrain's own triangles.
template <class Scalar>
struct ChangedGround<Scalar>::Others {
    const Terrain<Scalar>* terrain = nullptr;  // null in a grid that is not the terrain's
    std::vector<ProxyId>* standing = nullptr;

    void add(ProxyId id, Scalar /*key*/) {
        if (terrain == nullptr || !terrain->triangleOf(id)) {
            standing->push_back(id);
        }
    }
    [[nodiscard]] static constexpr double limit() noexcept {
        return std::numeric_limits<double>::infinity();
    }
};

template <class Scalar>
ChangedGround<Scalar>::ChangedGround(Terrain<Scalar>& terrain, std::size_t mostBoxes)
    : terrain_(&terrain), mostBoxes_(std::max<std::size_t>(mostBoxes, 2)) {
    boxes_.reserve(mostBoxes_);
    terrain.changed_.push_back(this);
}

template <class Scalar>
ChangedGround<Scalar>::~ChangedGround() {
    if (terrain_ != nullptr) {
        std::erase(terrain_->changed_, this);
    }
}

template <class Scalar>
QueryCost ChangedGround<Scalar>::findStanding(const Grid<Scalar>& grid,
                                              std::type_identity_t<Scalar> reach,
                                              std::vector<ProxyId>& standing,
                                              ProxyFilter filter) const {
    HASHPHASE_ASSERT(reach >= 0,
                     "ChangedGround::findStanding(): reach is negative or NaN. Pass 0 m or more.");
    standing.clear();
    QueryCost cost;
    if (!(reach >= 0) || terrain_ == nullptr) {
        return cost;
    }
    constexpr std::size_t atOnce = 16;
    std::array<BoxRegion<Scalar>, atOnce> regions;
    std::array<Others, atOnce> found;
    found.fill({&grid == terrain_->grid_ ? terrain_ : nullptr, &standing});
    const Vector3<Scalar> around = Vector3<Scalar>::Constant(reach);
    for (std::size_t first = 0; first < boxes_.size(); first += atOnce) {
        const std::size_t few = std::min(atOnce, boxes_.size() - first);
        for (std::size_t i = 0; i < few; ++i) {
            const Box& box = boxes_[first + i];
            regions[i].box = {box.min() - around, box.max() + around};
        }
        cost += grid.visitEach(std::span<const BoxRegion<Scalar>>(regions).first(few),
                               std::span(found).first(few));
    }
    std::sort(standing.begin(), standing.end());
    standing.erase(std::unique(standing.begin(), standing.end()), standing.end());
    std::erase_if(standing, [&](ProxyId id) { return !filter(id); });
    return cost;
}

template <class Scalar>
void ChangedGround<Scalar>::note(const Box& box) noexcept {
    if (!boxes_.empty() && makeOneBox(boxes_.back(), box)) {
        boxes_.back().extend(box);
        return;
    }
    if (boxes_.size() == mostBoxes_) {
        joinNeighbours();
    }
    boxes_.push_back(box);
}

template <class Scalar>
void ChangedGround<Scalar>::joinNeighbours() noexcept {
    std::size_t joinedCount = 0;
    for (std::size_t i = 0; i < boxes_.size(); i += 2) {
        Box box = boxes_[i];
        if (i + 1 < boxes_.size()) {
            box.extend(boxes_[i + 1]);
        }
        boxes_[joinedCount++] = box;
    }
    boxes_.resize(joinedCount);
}

template <class Scalar>
void ChangedGround<Scalar>::shiftOrigin(const Vector3<Scalar>& shift) noexcept {
    for (Box& box : boxes_) {
        box.translate(-shift);
    }
}

template class HASHPHASE_INSTANCE_EXPORT ChangedGround<float>;
template class HASHPHASE_INSTANCE_EXPORT ChangedGround<double>;

}  // namespace hashphase
