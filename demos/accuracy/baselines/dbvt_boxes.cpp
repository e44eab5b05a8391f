// SPDX-License-Identifier: Zlib
#include <demos/accuracy/baselines/dbvt_boxes.hpp>

#include <demos/scenes/box_scene.hpp>
#include <integration/bullet/conversions.hpp>

#include <numeric>

namespace hashphase::demos {

DbvtBoxes::DbvtBoxes(std::span<const Aabb<float>> boxes) : objects_(boxes.size()) {
    std::iota(objects_.begin(), objects_.end(), 0U);
    // Static geometry pairs with nothing, and pairs are not asked for.
    const CollisionFilter filter = kStaticFilter;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        proxies_.push_back(broadphase_.createProxy(
            toBullet(boxes[i].min()), toBullet(boxes[i].max()), BOX_SHAPE_PROXYTYPE, &objects_[i],
            filter.group, filter.mask, nullptr));
    }
    broadphase_.optimize();
}

DbvtBoxes::~DbvtBoxes() {
    for (btBroadphaseProxy* proxy : proxies_) {
        broadphase_.destroyProxy(proxy, nullptr);
    }
}

}  // namespace hashphase::demos
