// SPDX-License-Identifier: Zlib
#include <integration/bullet/bullet_parallel_for.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <tests/support/random.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

using UniqueIds = std::vector<std::pair<int, int>>;

UniqueIds pairsOf(btBroadphaseInterface& broadphase) {
    UniqueIds ids;
    const btBroadphasePairArray& pairs =
        broadphase.getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i) {
        ids.emplace_back(pairs[i].m_pProxy0->m_uniqueId, pairs[i].m_pProxy1->m_uniqueId);
    }
    return ids;
}

TEST(Threads, GiveTheSamePairsInTheSameOrder) {
    Random random(0x5eed0901);
    ThreadedFor threadedFor(3, 0x5eed0902);
    SpatialHashConfig config;
    config.parallelFor = [&](std::size_t count, std::size_t grain, LoopBody body) {
        threadedFor(count, grain, body);
    };
    SpatialHashBroadphase serial;
    SpatialHashBroadphase parallel(config);
    std::vector<std::pair<btBroadphaseProxy*, btBroadphaseProxy*>> proxies;
    for (int frame = 0; frame < 4; ++frame) {
        for (std::size_t i = 0; i < 12000; ++i) {
            const Vector3<double> at = random.pointIn(0, 50);
            const btVector3 low(static_cast<btScalar>(at[0]), static_cast<btScalar>(at[1]),
                                static_cast<btScalar>(at[2]));
            const btVector3 high = low + btVector3(1, 1, 1);
            if (frame == 0) {
                const auto create = [&](SpatialHashBroadphase& broadphase) {
                    return broadphase.createProxy(low, high, 0, nullptr, 1, -1, nullptr);
                };
                proxies.emplace_back(create(serial), create(parallel));
            } else {
                serial.setAabb(proxies[i].first, low, high, nullptr);
                parallel.setAabb(proxies[i].second, low, high, nullptr);
            }
        }
        serial.calculateOverlappingPairs(nullptr);
        parallel.calculateOverlappingPairs(nullptr);
        ASSERT_GT(pairsOf(serial).size(), 1000U);
        ASSERT_EQ(pairsOf(parallel), pairsOf(serial));
    }
    EXPECT_GT(threadedFor.mostRanges(), 1U);
}

TEST(BulletFor, RunsEveryIterationOnce) {
    for (const std::size_t count : {0, 1, 7, 1000}) {
        std::vector<int> times(count, 0);
        bulletFor(count, 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                ++times[i];
            }
        });
        EXPECT_EQ(std::ranges::count(times, 1), static_cast<std::ptrdiff_t>(count));
    }
}

}  // namespace
}  // namespace hashphase::test
