// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/rival_pairs.hpp>

namespace hashphase::demos {

RivalPairs::RivalPairs(const BroadphaseKind& kind, const Aabb<float>& bounds,
                       std::size_t indexLimit)
    : broadphase_(kind, {.bounds = bounds, .objects = indexLimit}), isThere_(indexLimit) {}

void RivalPairs::update(std::span<const Aabb<float>> boxes,
                        std::span<const CollisionFilter> filters, PhaseClock& clock) {
    toBulletBoxes(boxes, bulletBoxes_);
    clock.skip();
    const HeapScope scope(broadphase_.heap());
    for (std::uint32_t index = 0; index < boxes.size(); ++index) {
        const bool isThere = !boxes[index].min().hasNaN();
        if (isThere && isThere_[index] != 0) {
            broadphase_.set(index, bulletBoxes_[index]);
        } else if (isThere) {
            broadphase_.create(index, bulletBoxes_[index],
                               filters.empty() ? CollisionFilter{} : filters[index]);
        } else if (isThere_[index] != 0) {
            broadphase_.destroy(index);
        }
        isThere_[index] = isThere ? 1 : 0;
    }
    clock.end("set boxes");
    broadphase_.findPairs();
    clock.end("find pairs");
    broadphase_.listPairs(pairs_);
    clock.skip();
}

}  // namespace hashphase::demos
