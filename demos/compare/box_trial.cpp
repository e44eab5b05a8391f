// SPDX-License-Identifier: Zlib
#include <demos/compare/box_trial.hpp>

#include <demos/compare/stopwatch.hpp>

#include <numeric>
#include <utility>

namespace hashphase::demos {
namespace {

// Bullet's cache searches all its pairs for those of a proxy that is destroyed; emptied beforehand,
// it has none to search.
void emptyBulletsCache(btBroadphaseInterface& broadphase) {
    auto* cache = dynamic_cast<btHashedOverlappingPairCache*>(broadphase.getOverlappingPairCache());
    while (cache != nullptr && cache->getNumOverlappingPairs() > 0) {
        const btBroadphasePair& last =
            cache->getOverlappingPairArray()[cache->getNumOverlappingPairs() - 1];
        cache->removeOverlappingPair(last.m_pProxy0, last.m_pProxy1, nullptr);
    }
}

}  // namespace

BoxTrial::BoxTrial(std::unique_ptr<BoxScene> scene, ReferenceMethod reference)
    : scene_(std::move(scene)), reference_(reference), objects_(scene_->boxes().size()) {
    std::iota(objects_.begin(), objects_.end(), 0U);
    readCorners();
}

BoxTrial::~BoxTrial() {
    for (const Contestant& contestant : contestants_) {
        if (contestant.freesProxies) {
            continue;
        }
        emptyBulletsCache(*contestant.broadphase);
        for (btBroadphaseProxy* proxy : contestant.proxies) {
            if (proxy != nullptr) {
                contestant.broadphase->destroyProxy(proxy, nullptr);
            }
        }
    }
}

void BoxTrial::add(const BroadphaseKind& kind) {
    Contestant contestant{nullptr, {}, kind.freesProxies, {}};
    contestant.proxies.resize(corners_.size());
    {
        const HeapScope scope(contestant.heap);
        contestant.broadphase = kind.make({scene_->bounds(), corners_.size()});
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const CollisionFilter filter =
                scene_->filters().empty() ? CollisionFilter{} : scene_->filters()[i];
            contestant.proxies[i] = contestant.broadphase->createProxy(
                corners_[i].min, corners_[i].max, BOX_SHAPE_PROXYTYPE, &objects_[i], filter.group,
                filter.mask, nullptr);
        }
    }
    contestants_.push_back(std::move(contestant));
}

void BoxTrial::beginFrame() {
    if (begun_) {
        scene_->advance();
        readCorners();
    }
    begun_ = true;
    findExactPairs(reference_, scene_->boxes(), scene_->filters(), exact_);
}

Observation BoxTrial::runFrame(std::size_t contestant) {
    Contestant& current = contestants_[contestant];
    btBroadphaseInterface& broadphase = *current.broadphase;
    Observation seen;
    {
        const HeapScope scope(current.heap);
        const Stopwatch watch;
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            broadphase.setAabb(current.proxies[i], corners_[i].min, corners_[i].max, nullptr);
        }
        seen.setAabbMs = watch.milliseconds();
        broadphase.calculateOverlappingPairs(nullptr);
        seen.calculateMs = watch.milliseconds() - seen.setAabbMs;
    }
    listPairs(
        *broadphase.getOverlappingPairCache(),
        [](const btBroadphaseProxy& proxy) {
            return *static_cast<const std::uint32_t*>(proxy.m_clientObject);
        },
        reported_);
    seen.reported = reported_;
    seen.exact = exact_;
    seen.boxes = scene_->boxes();
    return seen;
}

std::optional<double> BoxTrial::removeObjects(std::size_t contestant, std::size_t count) {
    Contestant& current = contestants_[contestant];
    const Stopwatch watch;
    for (std::size_t i = 0; i < count; ++i) {
        btBroadphaseProxy*& proxy = current.proxies[i * current.proxies.size() / count];
        current.broadphase->destroyProxy(proxy, nullptr);
        proxy = nullptr;
    }
    return watch.milliseconds();
}

std::optional<std::int64_t> BoxTrial::memoryBytes(std::size_t contestant) const {
    return contestants_[contestant].heap.bytes();
}

void BoxTrial::readCorners() {
    corners_.clear();
    for (const Aabb<float>& box : scene_->boxes()) {
        corners_.push_back({btVector3(box.min().x(), box.min().y(), box.min().z()),
                            btVector3(box.max().x(), box.max().y(), box.max().z())});
    }
}

}  // namespace hashphase::demos
