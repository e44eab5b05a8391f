// SPDX-License-Identifier: Zlib
//
// A frame like the last one takes no memory, what Bullet's own arrays take included.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/counted_bullet.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

class BulletAllocations : public testing::Test {
protected:
    void SetUp() override {
        if (!kCountsAllocations) {
            GTEST_SKIP() << "this program has another `new`";
        }
    }

private:
    CountedBullet counted_;
};

/// Boxes that swing about where they began, each at its own pace; every fourth one stays there.
struct Swing : Boxes {
    explicit Swing(int count) {
        BulletRandom random(1);
        const double half = std::cbrt(count) * 0.55;
        for (int object = 0; object < count; ++object) {
            homes.push_back(boxAround(random.vector(-half, half), random.vector(0.3, 0.6)));
            paces.push_back(random.vector(0.05, 0.1));
            create(homes.back());
        }
    }
    void frames(int from, int to) {
        for (int number = from; number < to; ++number) {
            for (std::size_t object = 0; object < proxies.size(); ++object) {
                const btVector3 angle = paces[object] * btScalar(object % 4 == 0 ? 0 : number);
                const btVector3 by(btSin(angle.x()), btSin(angle.y()), btSin(angle.z()));
                set(proxies[object], {homes[object].min + by, homes[object].max + by});
            }
            step();
            pairsWatched += broadphase.lastCost().pairsWatched;
        }
    }

    std::vector<Box> homes;
    std::vector<btVector3> paces;
    std::uint64_t pairsWatched = 0;
};

TEST_F(BulletAllocations, AreNoneInAFrameLikeTheLastOne) {
    Swing swing(4000);
    swing.frames(0, 400);
    swing.pairsWatched = 0;
    const std::size_t before = allocationCount();
    ASSERT_GT(before, 0U);
    swing.frames(400, 600);
    EXPECT_EQ(allocationCount(), before);
    EXPECT_GT(swing.pairsWatched, 200U * 4000U);
    EXPECT_EQ(swing.broadphase.validate(), "");
}

TEST_F(BulletAllocations, OfAnEmptyWorldAreFewBytesInNoMoreBlocksThanOfBtDbvtBroadphase) {
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

TEST_F(BulletAllocations, OfTenBodiesAreAFewKilobytes) {
    const std::size_t before = bytesHeld();
    Swing swing(10);
    swing.frames(0, 20);
    ReportTo<btBroadphaseAabbCallback> report;
    swing.broadphase.aabbTest({-9, -9, -9}, {9, 9, 9}, report);
    EXPECT_EQ(report.found.size(), 10U);
    const std::size_t told = swing.memoryBytes();
    EXPECT_LT(told, (sizeof(btScalar) == sizeof(float) ? 22U : 28U) * 1024U);
    // What else is held is the test's own, and less than the two themselves take.
    EXPECT_GE(told + sizeof(Swing) + sizeof(PairCache) + sizeof(SpatialHashBroadphase) +
                  16 * (sizeof(Box) + sizeof(btVector3) + 2 * sizeof(void*)),
              bytesHeld() - before);
}

/// A heap of boxes, of which all but some are destroyed.
struct Heap : Boxes {
    void createSome(int count) {
        for (int i = 0; i < count; ++i) {
            create(anywhere(),
                   i % 3 == 0 ? btBroadphaseProxy::StaticFilter : btBroadphaseProxy::DefaultFilter);
        }
    }
    void destroyAllBut(std::size_t count) {
        broadphase.destroyProxies(std::span(proxies).subspan(count), nullptr);
        proxies.resize(count);
    }
    void frames(int count) {
        for (int frame = 0; frame < count; ++frame) {
            set(proxies.back(), anywhere());
            step();
        }
    }
    Box anywhere() { return boxAround(random.vector(-8, 8), {1, 1, 1}); }

    BulletRandom random{3};
};

TEST(AfterAPeak, TheBroadphaseGivesBackWhatWasNotUsedForAWhile) {
    for (const bool byCall : {false, true}) {
        Heap alone;
        alone.createSome(60);
        alone.frames(20);
        Heap heap;
        heap.createSome(4000);
        heap.frames(3);
        ASSERT_GT(heap.pairCount(), 20000);
        const std::size_t atPeak = heap.memoryBytes();
        heap.destroyAllBut(60);
        heap.frames(2);
        EXPECT_GT(heap.memoryBytes(), atPeak / 2);
        const std::vector<btBroadphaseProxy*> left = heap.proxies;
        if (byCall) {
            heap.broadphase.releaseUnusedMemory();
        } else {
            heap.frames(300);
        }
        heap.frames(2);
        EXPECT_LT(heap.memoryBytes(), 3 * alone.memoryBytes());
        EXPECT_EQ(heap.proxies, left) << "proxies stay where they are";
        for (int round = 0; round < 2; ++round) {
            heap.check();
            heap.createSome(300);  // another peak
            heap.frames(2);
        }
        heap.destroyAllBut(0);
        alone.destroyAllBut(0);
        heap.step();
        heap.broadphase.releaseUnusedMemory();
        EXPECT_LT(heap.memoryBytes(), std::size_t{6} * 1024);
    }
}

}  // namespace
}  // namespace hashphase::test
