// SPDX-License-Identifier: Zlib
#include <demos/compare/filled_broadphase.hpp>

#include <demos/compare/trial.hpp>
#include <demos/scenes/destroy_proxies.hpp>

#include <numeric>

namespace hashphase::demos {

std::optional<float> cellSizeOf(const btBroadphaseInterface& broadphase) {
    const auto* ours = dynamic_cast<const SpatialHashBroadphase*>(&broadphase);
    return ours != nullptr ? std::optional(static_cast<float>(ours->grid().cellSize()))
                           : std::nullopt;
}

void toBulletBoxes(std::span<const Aabb<float>> boxes, std::vector<BulletBox>& converted) {
    converted.clear();
    for (const Aabb<float>& box : boxes) {
        converted.push_back({btVector3(box.min().x(), box.min().y(), box.min().z()),
                             btVector3(box.max().x(), box.max().y(), box.max().z())});
    }
}

FilledBroadphase::FilledBroadphase(const BroadphaseKind& kind, const BroadphaseNeeds& needs)
    : freesProxies_(kind.freesProxies), objects_(needs.objects), proxies_(needs.objects) {
    std::iota(objects_.begin(), objects_.end(), 0U);
    const HeapScope scope(heap_);
    broadphase_ = kind.make(needs);
}

FilledBroadphase::~FilledBroadphase() {
    if (!freesProxies_) {
        destroyProxies(*broadphase_, proxies_);
    }
}

void FilledBroadphase::create(std::uint32_t object, const BulletBox& box, CollisionFilter filter) {
    proxies_[object] =
        broadphase_->createProxy(box.min, box.max, BOX_SHAPE_PROXYTYPE, &objects_[object],
                                 filter.group, filter.mask, nullptr);
}

void FilledBroadphase::destroy(std::uint32_t object) {
    broadphase_->destroyProxy(proxies_[object], nullptr);
    proxies_[object] = nullptr;
}

void FilledBroadphase::createInBatch(std::span<const std::uint32_t> objects,
                                     std::span<const BulletBox> boxes,
                                     std::span<const CollisionFilter> filters) {
    definitions_.clear();
    for (const std::uint32_t object : objects) {
        const CollisionFilter filter = filters.empty() ? CollisionFilter{} : filters[object];
        definitions_.push_back(
            {boxes[object].min, boxes[object].max, &objects_[object], filter.group, filter.mask});
    }
    batch_.resize(objects.size());
    dynamic_cast<SpatialHashBroadphase&>(*broadphase_).createProxies(definitions_, batch_, nullptr);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        proxies_[objects[i]] = batch_[i];
    }
}

void FilledBroadphase::destroyInBatch(std::span<const std::uint32_t> objects) {
    batch_.clear();
    for (const std::uint32_t object : objects) {
        batch_.push_back(proxies_[object]);
        proxies_[object] = nullptr;
    }
    dynamic_cast<SpatialHashBroadphase&>(*broadphase_).destroyProxies(batch_, nullptr);
}

void FilledBroadphase::setAll(std::span<const BulletBox> boxes) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        broadphase_->setAabb(proxies_[i], boxes[i].min, boxes[i].max, nullptr);
    }
}

void FilledBroadphase::setAllInBatch(std::span<const btVector3> mins,
                                     std::span<const btVector3> maxs) {
    dynamic_cast<SpatialHashBroadphase&>(*broadphase_).setAabbs(proxies_, mins, maxs, nullptr);
}

void FilledBroadphase::listPairs(std::vector<PairKey>& pairs) const {
    demos::listPairs(*broadphase_->getOverlappingPairCache(), objectOf, pairs);
}

}  // namespace hashphase::demos
