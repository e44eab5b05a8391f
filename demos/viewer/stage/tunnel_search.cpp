// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/tunnel_search.hpp>

#include <demos/viewer/stage/body_shape.hpp>

#include <integration/picking/pick.hpp>

namespace hashphase::demos {

void TunnelSearch::notePlaces(const Stage& stage) {
    before_.resize(stage.indexLimit());
    for (std::uint32_t index = 0; index < before_.size(); ++index) {
        before_[index] = stage.body(index).centre;
    }
}

void TunnelSearch::find(const Stage& stage) {
    for (std::uint32_t index = 0; index < before_.size() && marks_.size() < kMostMarks; ++index) {
        const StageBody mover = stage.body(index);
        const Vector3<float> way = mover.centre - before_[index];
        if (mover.shape != StageBody::Shape::sphere || mover.isStatic ||
            way.squaredNorm() <= mover.size.x() * mover.size.x()) {
            continue;
        }
        const RayRegion<float> path(before_[index], mover.centre);
        pickAll(*stage.grid(), path, picked_);
        for (const Picked<float>& met : picked_) {
            const StageBody wall = stage.body(met.id.index);
            const bool isThrough = wall.shape == StageBody::Shape::box && wall.isStatic &&
                                   meets(wall, before_[index], way).value_or(0) > 0 &&
                                   meets(wall, mover.centre, -way).value_or(0) > 0;
            if (isThrough) {
                marks_.push_back({before_[index], mover.centre});
                break;
            }
        }
    }
}

}  // namespace hashphase::demos
