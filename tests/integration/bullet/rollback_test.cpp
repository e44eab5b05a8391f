// SPDX-License-Identifier: Zlib
//
// Boxes that are set back to an earlier frame: what rollback stands on.

#include <tests/integration/bullet/player.hpp>

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

constexpr std::size_t kRolledBodies = 150;
constexpr std::size_t kRolledFrames = 40;
constexpr std::size_t kBack = 17;  // the frame to which boxes are set back

/// Unique ids of a pair, and whether it came.
using PairChange = std::tuple<int, int, bool>;
/// Unique ids of the first and the second proxy of each pair, in the array's order.
using Listed = std::vector<std::pair<int, int>>;

struct ChangeList : btOverlappingPairCallback {
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
        changes.emplace_back(a->m_uniqueId, b->m_uniqueId, true);
        return nullptr;
    }
    void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                btDispatcher* /*dispatcher*/) override {
        changes.emplace_back(a->m_uniqueId, b->m_uniqueId, false);
        return nullptr;
    }
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy* /*proxy*/,
                                               btDispatcher* /*dispatcher*/) override {}
    std::vector<PairChange> changes;
};

/// Bodies that drift and jump; some rest for a while, so that they are filed as resting ones.
std::vector<std::vector<Box>> framesOfBoxes() {
    Random random(11);
    std::vector<std::vector<Box>> frames(kRolledFrames);
    for (std::size_t body = 0; body < kRolledBodies; ++body) {
        Vector3<double> at = random.pointIn(0, 9);
        const Vector3<double> half = random.pointIn(0.3, 0.9);
        for (std::size_t frame = 0; frame < kRolledFrames; ++frame) {
            const bool rests = body % 3 == 0 && frame > 5 && frame < 30;
            at = rests                 ? at
                 : random.chance(0.02) ? Vector3<double>(random.pointIn(0, 9))
                                       : Vector3<double>(at + random.pointIn(-0.3, 0.3));
            const auto box = boxAround<btScalar>(at, half);
            frames[frame].push_back({toBullet(box.min()), toBullet(box.max())});
        }
    }
    return frames;
}

struct Rollback {
    Rollback(PairOrder order, bool isTold, int eagerEach) : cache(order), broadphase(&cache) {
        if (isTold) {
            cache.setInternalGhostPairCallback(&list);
        }
        for (std::size_t i = 0; i < kRolledBodies; ++i) {
            const bool isEager = eagerEach > 0 && static_cast<int>(i) % eagerEach == 0;
            const Box& box = frames[0][i];
            proxies.push_back(broadphase.createProxy(
                box.min, box.max, BOX_SHAPE_PROXYTYPE, nullptr,
                isEager ? btBroadphaseProxy::SensorTrigger : btBroadphaseProxy::DefaultFilter,
                btBroadphaseProxy::AllFilter, nullptr));
        }
        broadphase.calculateOverlappingPairs(nullptr);
    }
    /// Sets the boxes of the frame; returns what changed, in order.
    std::vector<PairChange> go(std::size_t frame) {
        list.changes.clear();
        for (std::size_t i = 0; i < kRolledBodies; ++i) {
            broadphase.setAabb(proxies[i], frames[frame][i].min, frames[frame][i].max, nullptr);
        }
        broadphase.calculateOverlappingPairs(nullptr);
        return list.changes;
    }
    Listed listed() {
        Listed pairs;
        const btBroadphasePairArray& array = cache.getOverlappingPairArray();
        for (int i = 0; i < array.size(); ++i) {
            pairs.emplace_back(array[i].m_pProxy0->m_uniqueId, array[i].m_pProxy1->m_uniqueId);
        }
        return pairs;
    }

    std::vector<std::vector<Box>> frames = framesOfBoxes();
    ChangeList list;
    PairCache cache;
    SpatialHashBroadphase broadphase;
    std::vector<btBroadphaseProxy*> proxies;
};

TEST(Rollback, BringsTheSameBirthsAndDeathsInTheSameOrderWhateverTheOrderOfTheArray) {
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        for (const int eagerEach : {0, 4}) {
            Rollback world(order, true, eagerEach);
            std::vector<std::vector<PairChange>> first(kRolledFrames);
            for (std::size_t frame = 1; frame < kRolledFrames; ++frame) {
                first[frame] = world.go(frame);
            }
            std::vector<PairChange> back = world.go(kBack);
            EXPECT_GT(back.size(), 20U);
            for (std::size_t frame = kBack + 1; frame < kRolledFrames; ++frame) {
                EXPECT_FALSE(first[frame].empty());
                ASSERT_EQ(world.go(frame), first[frame]) << "frame " << frame;
            }
            // The way back depends on the two frames alone, not on those between.
            Rollback other(order, true, eagerEach);
            other.go(kRolledFrames - 1);
            ASSERT_EQ(other.go(kBack), back);
        }
    }
}

TEST(Rollback, BringsTheSameArrayInCanonicalOrder) {
    Rollback world(PairOrder::canonical, false, 0);
    std::vector<Listed> first(kRolledFrames);
    for (std::size_t frame = 0; frame < kRolledFrames; ++frame) {
        world.go(frame);
        first[frame] = world.listed();
    }
    for (std::size_t frame = kBack; frame < kRolledFrames; ++frame) {
        world.go(frame);
        ASSERT_EQ(world.listed(), first[frame]) << "frame " << frame;
    }
    Rollback other(PairOrder::canonical, false, 0);
    other.go(kRolledFrames - 1);
    ASSERT_EQ(other.listed(), first[kRolledFrames - 1]);
}

TEST(Rollback, BringsTheSamePairsInOrderOfArrivalInPlacesThatDependOnHistory) {
    Rollback world(PairOrder::arrival, false, 0);
    for (std::size_t frame = 0; frame <= kBack; ++frame) {
        world.go(frame);
    }
    Listed first = world.listed();
    for (std::size_t frame = kBack + 1; frame < kRolledFrames; ++frame) {
        world.go(frame);
    }
    world.go(kBack);
    Listed second = world.listed();
    EXPECT_NE(first, second);
    std::sort(first.begin(), first.end());
    std::sort(second.begin(), second.end());
    EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace hashphase::test
