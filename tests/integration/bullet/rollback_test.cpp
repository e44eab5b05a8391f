// SPDX-License-Identifier: Zlib
//
// Boxes that are set back to an earlier frame: what rollback stands on.

#include <tests/integration/bullet/boxes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace hashphase::test {
namespace {

constexpr std::size_t kBodies = 150;
constexpr std::size_t kFrames = 40;
constexpr std::size_t kBack = 17;  // the frame to which boxes are set back

using PairChanges = std::vector<PairJournal::Told>;

/// Bodies that drift and jump; some rest for a while, so that they are filed as resting ones.
std::vector<std::vector<Box>> framesOfBoxes() {
    BulletRandom random(11);
    std::vector<std::vector<Box>> frames(kFrames);
    for (std::size_t body = 0; body < kBodies; ++body) {
        btVector3 at = random.vector(0, 9);
        const btVector3 half = random.vector(0.3, 0.9);
        for (std::size_t frame = 0; frame < kFrames; ++frame) {
            if (random.chance(0.02)) {
                at = random.vector(0, 9);
            } else if (body % 3 != 0 || frame <= 5 || frame >= 30) {
                at += random.vector(-0.3, 0.3);
            }
            frames[frame].push_back(boxAround(at, half));
        }
    }
    return frames;
}

struct Rollback : Boxes {
    explicit Rollback(PairOrder order, bool isTold = false, std::size_t eagerEach = 0)
        : Boxes(eager(), order) {
        cache.setInternalGhostPairCallback(isTold ? &told : nullptr);
        for (std::size_t i = 0; i < kBodies; ++i) {
            create(frames[0][i], eagerEach > 0 && i % eagerEach == 0
                                     ? btBroadphaseProxy::SensorTrigger
                                     : btBroadphaseProxy::DefaultFilter);
        }
        step();
    }
    static SpatialHashConfig eager() {
        SpatialHashConfig config;
        config.eagerGroups = btBroadphaseProxy::SensorTrigger;
        return config;
    }
    /// Sets the boxes of the frame; returns what changed, in order.
    PairChanges go(std::size_t frame) {
        told.all.clear();
        for (std::size_t i = 0; i < kBodies; ++i) {
            set(proxies[i], frames[frame][i]);
        }
        step();
        return told.all;
    }
    /// Through frames, the last of which is given; returns the array.
    std::vector<Uids> listAfter(std::size_t first, std::size_t last) {
        for (std::size_t frame = first; frame <= last; ++frame) {
            go(frame);
        }
        return list();
    }

    std::vector<std::vector<Box>> frames = framesOfBoxes();
    PairJournal told;
};

TEST(Rollback, BringsTheSameBirthsAndDeathsInTheSameOrderWhateverTheOrderOfTheArray) {
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        for (const std::size_t eagerEach : {0U, 4U}) {
            Rollback world(order, true, eagerEach);
            std::vector<PairChanges> first(kFrames);
            for (std::size_t frame = 1; frame < kFrames; ++frame) {
                first[frame] = world.go(frame);
            }
            const PairChanges back = world.go(kBack);
            EXPECT_GT(back.size(), 20U);
            for (std::size_t frame = kBack + 1; frame < kFrames; ++frame) {
                EXPECT_FALSE(first[frame].empty());
                ASSERT_EQ(world.go(frame), first[frame]) << "frame " << frame;
            }
            // The way back depends on the two frames alone, not on those between.
            Rollback other(order, true, eagerEach);
            other.go(kFrames - 1);
            ASSERT_EQ(other.go(kBack), back);
        }
    }
}

TEST(Rollback, BringsTheSameArrayInCanonicalOrder) {
    Rollback world(PairOrder::canonical);
    std::vector<std::vector<Uids>> first(kFrames);
    for (std::size_t frame = 0; frame < kFrames; ++frame) {
        first[frame] = world.listAfter(frame, frame);
    }
    for (std::size_t frame = kBack; frame < kFrames; ++frame) {
        ASSERT_EQ(world.listAfter(frame, frame), first[frame]) << "frame " << frame;
    }
    EXPECT_EQ(Rollback(PairOrder::canonical).listAfter(kFrames - 1, kFrames - 1), first.back());
}

}  // namespace
}  // namespace hashphase::test
