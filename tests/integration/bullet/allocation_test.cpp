// SPDX-License-Identifier: Zlib
//
// A frame like the last one takes no memory, what Bullet's own arrays take included.

#include <tests/integration/bullet/bullet_scenes.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <tests/support/count_allocations.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <LinearMath/btAabbUtil2.h>
#include <LinearMath/btAlignedAllocator.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

/// Boxes that swing about where they began, each at its own pace; every fourth one stays there.
class Swing {
public:
    explicit Swing(int count) {
        BulletRandom random(1);
        const double half = std::cbrt(count) * 0.55;
        for (int object = 0; object < count; ++object) {
            homes_.push_back(boxAround(random.vector(-half, half), random.vector(0.3, 0.6)));
            paces_.push_back(random.vector(0.05, 0.1));
            proxies_.push_back(broadphase.createProxy(
                homes_.back().min, homes_.back().max, BOX_SHAPE_PROXYTYPE, nullptr,
                btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter, nullptr));
        }
    }

    ~Swing() {
        for (btBroadphaseProxy* proxy : proxies_) {
            broadphase.destroyProxy(proxy, nullptr);
        }
    }

    void frame(int number) {
        for (std::size_t object = 0; object < proxies_.size(); ++object) {
            if (object % 4 == 0) {
                continue;
            }
            const btVector3 angle = paces_[object] * btScalar(number);
            const btVector3 offset(btSin(angle.x()), btSin(angle.y()), btSin(angle.z()));
            broadphase.setAabb(proxies_[object], homes_[object].min + offset,
                               homes_[object].max + offset, nullptr);
        }
        broadphase.calculateOverlappingPairs(nullptr);
    }

    SpatialHashBroadphase broadphase;

private:
    std::vector<Box> homes_;
    std::vector<btVector3> paces_;
    std::vector<btBroadphaseProxy*> proxies_;
};

struct AllHits : btBroadphaseAabbCallback {
    int count = 0;
    bool process(const btBroadphaseProxy* /*proxy*/) override {
        ++count;
        return true;
    }
};

TEST(SteadyFrame, AllocatesNothing) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "allocations are not counted under a sanitizer";
    }
    btAlignedAllocSetCustom(countedAllocate, std::free);
    {
        Swing swing(4000);
        constexpr int kWarm = 400;
        for (int number = 0; number < kWarm; ++number) {
            swing.frame(number);
        }
        const std::size_t before = allocationCount();
        ASSERT_GT(before, 0U);
        std::uint64_t pairsWatched = 0;
        for (int number = kWarm; number < kWarm + 200; ++number) {
            swing.frame(number);
            pairsWatched += swing.broadphase.lastCost().pairsWatched;
        }
        EXPECT_EQ(allocationCount(), before);
        EXPECT_GT(pairsWatched, 200U * 4000U);
        EXPECT_EQ(swing.broadphase.validate(), "");
    }
    btAlignedAllocSetCustom(nullptr, nullptr);
}

/// Counts what Bullet's own arrays take, too.
class CountedBullet {
public:
    CountedBullet() { btAlignedAllocSetCustom(countedAllocate, std::free); }
    ~CountedBullet() { btAlignedAllocSetCustom(nullptr, nullptr); }
    CountedBullet(const CountedBullet&) = delete;
    CountedBullet& operator=(const CountedBullet&) = delete;
};

TEST(SmallWorld, IsMadeInAFewBytesAndAllocations) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "allocations are not counted under a sanitizer";
    }
    const CountedBullet counted;
    std::size_t allocations = allocationCount();
    const btDbvtBroadphase dbvt;
    const std::size_t ofDbvt = allocationCount() - allocations;
    const std::size_t bytesBefore = bytesHeld();
    allocations = allocationCount();
    const SpatialHashBroadphase broadphase;
    EXPECT_LE(allocationCount() - allocations, ofDbvt);
    EXPECT_LT(sizeof(broadphase) + bytesHeld() - bytesBefore, 4096U);
    EXPECT_LT(broadphase.memoryBytes(), 4096U);
    EXPECT_GE(broadphase.memoryBytes(), sizeof(broadphase) + bytesHeld() - bytesBefore);
}

TEST(SmallWorld, OfTenBodiesTakesAFewKilobytes) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "allocations are not counted under a sanitizer";
    }
    const CountedBullet counted;
    const std::size_t before = bytesHeld();
    Swing swing(10);
    for (int number = 0; number < 20; ++number) {
        swing.frame(number);
    }
    AllHits hits;
    swing.broadphase.aabbTest({-9, -9, -9}, {9, 9, 9}, hits);
    EXPECT_EQ(hits.count, 10);
    const std::size_t told = swing.broadphase.memoryBytes();
    EXPECT_LT(told, (sizeof(btScalar) == sizeof(float) ? 22U : 28U) * 1024U);
    EXPECT_GE(told + sizeof(Swing) + 16 * (sizeof(Box) + sizeof(btVector3) + sizeof(void*)),
              bytesHeld() - before);
}

/// A heap of boxes at a broadphase, of which all but some are destroyed.
class Heap {
public:
    void create(int count) {
        for (int i = 0; i < count; ++i) {
            const Box box = boxAround(random_.vector(-8, 8), {1, 1, 1});
            proxies.push_back(broadphase.createProxy(
                box.min, box.max, BOX_SHAPE_PROXYTYPE, nullptr,
                i % 3 == 0 ? btBroadphaseProxy::StaticFilter : btBroadphaseProxy::DefaultFilter,
                btBroadphaseProxy::AllFilter, nullptr));
        }
    }
    void destroyAllBut(std::size_t count) {
        const std::span<btBroadphaseProxy* const> rest = std::span(proxies).subspan(count);
        broadphase.destroyProxies(rest, nullptr);
        proxies.resize(count);
    }
    void frames(int count) {
        for (int frame = 0; frame < count; ++frame) {
            const Box box = boxAround(random_.vector(-8, 8), {1, 1, 1});
            broadphase.setAabb(proxies.back(), box.min, box.max, nullptr);
            broadphase.calculateOverlappingPairs(nullptr);
        }
    }
    [[nodiscard]] int overlaps() const {
        int count = 0;
        for (std::size_t i = 0; i < proxies.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                count += TestAabbAgainstAabb2(proxies[i]->m_aabbMin, proxies[i]->m_aabbMax,
                                              proxies[k]->m_aabbMin, proxies[k]->m_aabbMax)
                             ? 1
                             : 0;
            }
        }
        return count;
    }

    SpatialHashBroadphase broadphase;
    std::vector<btBroadphaseProxy*> proxies;

private:
    BulletRandom random_{3};
};

TEST(AfterAPeak, TheBroadphaseGivesBackWhatWasNotUsedForAWhile) {
    for (const bool byCall : {false, true}) {
        Heap alone;
        alone.create(60);
        alone.frames(20);
        Heap heap;
        heap.create(4000);
        heap.frames(3);
        ASSERT_GT(heap.broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 20000);
        const std::size_t atPeak = heap.broadphase.memoryBytes();
        heap.destroyAllBut(60);
        heap.frames(2);
        EXPECT_GT(heap.broadphase.memoryBytes(), atPeak / 2);
        const std::vector<btBroadphaseProxy*> left = heap.proxies;
        if (byCall) {
            heap.broadphase.releaseUnusedMemory();
        } else {
            heap.frames(300);
        }
        heap.frames(2);
        EXPECT_LT(heap.broadphase.memoryBytes(), 3 * alone.broadphase.memoryBytes());
        EXPECT_EQ(heap.proxies, left) << "proxies stay where they are";
        for (int round = 0; round < 2; ++round) {
            EXPECT_EQ(heap.broadphase.getOverlappingPairCache()->getNumOverlappingPairs(),
                      heap.overlaps());
            EXPECT_EQ(heap.broadphase.validate(), "");
            heap.create(300);  // another peak
            heap.frames(2);
        }
        heap.destroyAllBut(0);
        alone.destroyAllBut(0);
        heap.broadphase.calculateOverlappingPairs(nullptr);
        heap.broadphase.releaseUnusedMemory();
        EXPECT_LT(heap.broadphase.memoryBytes(), std::size_t{6} * 1024);
    }
}

}  // namespace
}  // namespace hashphase::test
