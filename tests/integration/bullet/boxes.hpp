// SPDX-License-Identifier: Zlib
#pragma once

// Boxes of our broadphase alone, and the judge of their pairs, who looks at every two of them.

#include <tests/integration/bullet/pair_journal.hpp>
#include <tests/integration/bullet/player.hpp>
#include <tests/support/count_allocations.hpp>

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace hashphase::test {

[[nodiscard]] inline Box boxOf(const btBroadphaseProxy& proxy) {
    return {proxy.m_aabbMin, proxy.m_aabbMax};
}

/// Of 1 m, along x.
[[nodiscard]] inline Box cubeAt(btScalar x) {
    return {{x, 0, 0}, {x + 1, 1, 1}};
}

/// A pair cache of ours, a broadphase over it, and those of its proxies that are alive.
struct Boxes {
    explicit Boxes(const SpatialHashConfig& config = {}, PairOrder order = PairOrder::arrival)
        : cache(order), broadphase(&cache, config) {}
    ~Boxes() {
        cache.setOverlapFilterCallback(nullptr);
        cache.setInternalGhostPairCallback(nullptr);
        for (btBroadphaseProxy* const proxy : proxies) {
            broadphase.destroyProxy(proxy, nullptr);
        }
    }
    Boxes(const Boxes&) = delete;
    Boxes& operator=(const Boxes&) = delete;

    btBroadphaseProxy* create(const Box& box, int group = btBroadphaseProxy::DefaultFilter,
                              int mask = btBroadphaseProxy::AllFilter, void* client = nullptr) {
        btBroadphaseProxy* const proxy = broadphase.createProxy(
            box.min, box.max, BOX_SHAPE_PROXYTYPE, client, group, mask, nullptr);
        const WorkingAllocations working;
        proxies.push_back(proxy);
        return proxy;
    }
    void set(btBroadphaseProxy* proxy, const Box& box) {
        broadphase.setAabb(proxy, box.min, box.max, nullptr);
    }
    void destroy(btBroadphaseProxy* proxy) {
        broadphase.destroyProxy(proxy, nullptr);
        std::erase(proxies, proxy);
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            broadphase.calculateOverlappingPairs(nullptr);
        }
    }

    [[nodiscard]] int pairCount() { return cache.getNumOverlappingPairs(); }
    [[nodiscard]] bool isPair(std::size_t i, std::size_t j) {
        return cache.findPair(proxies[i], proxies[j]) != nullptr;
    }
    [[nodiscard]] std::size_t memoryBytes() const {
        return broadphase.memoryBytes() + cache.memoryBytes();
    }
    /// In the order of the array.
    [[nodiscard]] std::vector<Uids> list() { return uidList(cache); }

    /// All that overlap and may pair by group and mask, sorted.
    [[nodiscard]] std::vector<Uids> overlaps() const {
        std::vector<Uids> pairs;
        for (const btBroadphaseProxy* a : proxies) {
            for (const btBroadphaseProxy* b : proxies) {
                if (a->m_uniqueId < b->m_uniqueId && overlap(boxOf(*a), boxOf(*b)) &&
                    groupsCollide(a->m_collisionFilterGroup, a->m_collisionFilterMask,
                                  b->m_collisionFilterGroup, b->m_collisionFilterMask)) {
                    pairs.push_back(uidsOf(*a, *b));
                }
            }
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

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

    PairCache cache;
    SpatialHashBroadphase broadphase;
    std::vector<btBroadphaseProxy*> proxies;  // in the order of creation
};

}  // namespace hashphase::test
