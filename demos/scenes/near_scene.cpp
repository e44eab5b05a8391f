// SPDX-License-Identifier: Zlib
#include <demos/scenes/near_scene.hpp>

#include <algorithm>

namespace hashphase::demos {

NearScene::NearScene(std::size_t objects, std::uint64_t seed, const NearMotion& motion)
    : bodies_(uniformBoxes(objects, seed).bodies), motion_(motion), random_(~seed) {
    for (std::size_t i = 0; i < objects; ++i) {
        bodies_[i].step = motion.travellers > 0 && i % motion.travellers == 0 ? bodies_[i].step : 0;
        const float share = motion.creep;
        creep_.emplace_back(random_.between(-share, share), random_.between(-share, share),
                            random_.between(-share, share));
    }
    boxes_.resize(objects);
    for (std::size_t i = 0; i < objects; ++i) {
        place(i);
    }
}

// A creeping box turns round at the walls of the room.
void NearScene::advance() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        BrownianBoxes::Body& body = bodies_[i];
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            body.centre[axis] +=
                body.step > 0 ? random_.between(-body.step, body.step) : creep_[i][axis];
            const float low = body.roomForCentre.min()[axis];
            const float high = body.roomForCentre.max()[axis];
            if (body.centre[axis] < low || body.centre[axis] > high) {
                creep_[i][axis] = -creep_[i][axis];
                body.centre[axis] = std::clamp(body.centre[axis], low, high);
            }
        }
        place(i);
    }
}

void NearScene::place(std::size_t object) {
    const BrownianBoxes::Body& body = bodies_[object];
    Vector3<float> centre = body.centre;
    Vector3<float> halfEdges = body.halfEdges;
    if (body.step == 0) {
        for (Eigen::Index axis = 0; axis < 3 && motion_.tremble > 0; ++axis) {
            centre[axis] += random_.between(-motion_.tremble, motion_.tremble);
        }
        if (motion_.breathe > 0) {
            halfEdges.array() += random_.between(-motion_.breathe, motion_.breathe);
        }
    }
    boxes_[object] = {centre - halfEdges, centre + halfEdges};
}

Aabb<float> NearScene::bounds() const {
    const Vector3<float> reach = Vector3<float>::Constant(motion_.tremble + motion_.breathe);
    Aabb<float> all;
    for (const BrownianBoxes::Body& body : bodies_) {
        all.extend(body.roomForCentre.min() - body.halfEdges - reach);
        all.extend(body.roomForCentre.max() + body.halfEdges + reach);
    }
    return all;
}

}  // namespace hashphase::demos
