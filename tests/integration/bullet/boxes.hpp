// SPDX-License-Identifier: Zlib
#pragma once

// Boxes of a broadphase alone, and the judge of their pairs, who looks at every two of them.

#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/callbacks.hpp>
#include <tests/support/count_allocations.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace hashphase::test {

/// A broadphase, the cache that it was given if any, and those of its proxies that are alive.
struct AnyBoxes {
    explicit AnyBoxes(std::unique_ptr<btBroadphaseInterface> broadphase,
                      std::unique_ptr<btOverlappingPairCache> cache = nullptr)
        : given(std::move(cache)), over(std::move(broadphase)) {}
    /// Ours over a cache, or over its own.
    explicit AnyBoxes(std::unique_ptr<btOverlappingPairCache> cache,
                      const SpatialHashConfig& config = {})
        : given(std::move(cache)), over(hashOver(given.get(), config)) {}
    ~AnyBoxes() {
        pairCache().setOverlapFilterCallback(nullptr);
        pairCache().setInternalGhostPairCallback(nullptr);
        destroyAll();  // btDbvtBroadphase leaks what is left to it
    }
    AnyBoxes(const AnyBoxes&) = delete;
    AnyBoxes& operator=(const AnyBoxes&) = delete;

    btBroadphaseProxy* create(const Box& box, int group = btBroadphaseProxy::DefaultFilter,
                              int mask = btBroadphaseProxy::AllFilter, void* client = nullptr) {
        btBroadphaseProxy* const proxy =
            over->createProxy(box.min, box.max, BOX_SHAPE_PROXYTYPE, client, group, mask, nullptr);
        const WorkingAllocations working;
        proxies.push_back(proxy);
        return proxy;
    }
    void set(btBroadphaseProxy* proxy, const Box& box) {
        over->setAabb(proxy, box.min, box.max, nullptr);
    }
    void move(btBroadphaseProxy* proxy, const btVector3& by) {
        set(proxy, {proxy->m_aabbMin + by, proxy->m_aabbMax + by});
    }
    void destroy(btBroadphaseProxy* proxy) {
        over->destroyProxy(proxy, nullptr);
        std::erase(proxies, proxy);
    }
    void destroyAll() {
        while (!proxies.empty()) {
            destroy(proxies.back());
        }
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            over->calculateOverlappingPairs(nullptr);
        }
    }

    [[nodiscard]] btOverlappingPairCache& pairCache() const {
        return *over->getOverlappingPairCache();
    }
    [[nodiscard]] SpatialHashBroadphase& hash() const {
        return dynamic_cast<SpatialHashBroadphase&>(*over);
    }
    [[nodiscard]] int pairCount() const { return pairCache().getNumOverlappingPairs(); }
    [[nodiscard]] bool isPair(std::size_t i, std::size_t j) const {
        return pairCache().findPair(proxies[i], proxies[j]) != nullptr;
    }
    /// In the order of the array.
    [[nodiscard]] std::vector<Uids> list() const { return uidList(pairCache()); }

    /// All that overlap and may pair by group and mask, sorted.
    [[nodiscard]] std::vector<Uids> overlaps() const {
        std::vector<Uids> pairs;
        for (const btBroadphaseProxy* a : proxies) {
            for (const btBroadphaseProxy* b : proxies) {
                if (a->m_uniqueId < b->m_uniqueId && overlap(boxOf(*a), boxOf(*b)) &&
                    groupsCollide(*a, *b)) {
                    pairs.push_back(uidsOf(*a, *b));
                }
            }
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

    std::unique_ptr<btOverlappingPairCache> given;
    std::unique_ptr<btBroadphaseInterface> over;
    std::vector<btBroadphaseProxy*> proxies;  // in the order of creation
};

/// Our broadphase over a pair cache of ours.
struct Boxes : AnyBoxes {
    explicit Boxes(const SpatialHashConfig& config = {}, PairOrder order = PairOrder::arrival)
        : AnyBoxes(std::make_unique<PairCache>(order), config) {}

    [[nodiscard]] std::size_t memoryBytes() const {
        return broadphase.memoryBytes() + cache.memoryBytes();
    }
    [[nodiscard]] const PairCost& cost() const { return broadphase.lastCost(); }

    /// After a step the pairs are those that overlap, and all accounts agree.
    void check() {
        step();
        EXPECT_EQ(broadphase.validate(), "");
        EXPECT_EQ(cache.validate(), "");
        EXPECT_EQ(broadphase.grid().size(), proxies.size());
        std::vector<Uids> pairs = list();
        std::sort(pairs.begin(), pairs.end());
        EXPECT_EQ(pairs, overlaps());
    }

    PairCache& cache = dynamic_cast<PairCache&>(*given);
    SpatialHashBroadphase& broadphase = hash();
};

/// A broadphase of this configuration has the pairs of a serial one, in the same order, in frames in which
/// thousands of boxes are thrown about.
inline void expectPairsOfSerialFrames(const SpatialHashConfig& config, int frameCount) {
    BulletRandom random(0x5eed0901);
    Boxes serial;
    Boxes parallel(config);
    for (int frame = 0; frame < frameCount; ++frame) {
        for (std::size_t i = 0; i < 12000; ++i) {
            const btVector3 low = random.vector(0, 50);
            for (Boxes* boxes : {&serial, &parallel}) {
                const Box box{low, low + btVector3(1, 1, 1)};
                if (frame == 0) {
                    boxes->create(box);
                } else {
                    boxes->set(boxes->proxies[i], box);
                }
            }
        }
        serial.step();
        parallel.step();
        ASSERT_GT(serial.pairCount(), 1000);
        ASSERT_EQ(parallel.list(), serial.list());
    }
}

}  // namespace hashphase::test
