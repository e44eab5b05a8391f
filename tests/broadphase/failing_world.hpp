// SPDX-License-Identifier: Zlib
#pragma once

// Worlds for which memory runs out, and what they must be like afterwards.

#include <tests/support/out_of_memory.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

namespace hashphase::test {

/// Grid, sweeps and pairs, some of which refuse each other, and what they must be like.
struct FailingWorld : Population<float, PairWorld> {
    using Draw = std::function<Aabb<float>(Random&)>;

    explicit FailingWorld(std::size_t count, const GridConfig& config = {},
                          Draw itsDraw = spreadScene<float>("spread", 1, 0).draw)
        : Population(config), draw(std::move(itsDraw)) {
        addSome(count);
    }

    void addSome(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            add(draw(random), i % 3 == 0 ? Mobility::resting : Mobility::mobile);
            paint(proxies.size() - 1, static_cast<std::uint32_t>(proxies.size() - 1) % 3);
        }
    }
    void moveSome(std::size_t step) {
        for (std::size_t i = 0; i < proxies.size(); i += step) {
            moveTo(i, draw(random));
        }
    }
    void removeSome(std::size_t step) {
        for (std::size_t i = 0; i < proxies.size(); i += step) {
            removeAt(i);
        }
    }
    void sweepSome(std::size_t step) {
        for (std::size_t i = 0; i < proxies.size(); i += step) {
            const Vector3<float> way = random.pointIn(-30, 30).cast<float>();
            sweep(proxies[i].id, way, Sweep::automatic);
        }
    }
    void checkQueries() {
        EXPECT_EQ(grid.validate() + sweeps.validate(), "");
        EXPECT_EQ(grid.size(), proxies.size());
        if (!proxies.empty()) {
            RegionMaker<float> regions(random, proxies);
            expectLikeBruteForce(regions.box());
            expectLikeBruteForce(regions.ray());
        }
    }
    void updateAndCheckPairs() {
        update();
        check(proxies);
        EXPECT_EQ(pairs.validate(), "");
    }

    Draw draw;
};

/// Which has seen frames enough for most to rest, and then some changes.
inline std::unique_ptr<FailingWorld> longRun() {
    auto world = std::make_unique<FailingWorld>(45);
    for (int frame = 0; frame < 10; ++frame) {
        world->moveSome(9);
        world->update();
    }
    world->addSome(45);
    world->moveSome(2);
    world->removeSome(7);
    return world;
}

// Each overlaps many, and many begin and end to when they tremble.
inline const FailingWorld::Draw kInRoom = boxesIn<float>(-2.5, 2.5, 0.5, 1);
inline constexpr double kTrembling = 0.04;  // [m], less than a quarter of the slack
inline constexpr std::size_t kStanding = 6;

/// In which most tremble, have settled with slack, and have moved within it; some stand.
inline std::unique_ptr<FailingWorld> settledRun(std::size_t count = 90,
                                                const FailingWorld::Draw& draw = kInRoom) {
    auto world = std::make_unique<FailingWorld>(count, GridConfig{.slack = 0.2}, draw);
    for (int frame = 0; frame < 14; ++frame) {
        world->tremble(kStanding, count, kTrembling);
        world->update();
    }
    EXPECT_GE(world->pairs.lastCost().grid.resting, count - kStanding);
    EXPECT_EQ(world->pairs.lastCost().grid.changed, count - kStanding);
    world->tremble(kStanding, count, kTrembling);
    return world;
}

/// Frames in which change(world), which is not in want of memory, comes before the update.
template <class Change>
void playInWant(FailingWorld& world, int frames, const Change& change,
                ParallelFor parallelFor = serialFor) {
    for (int frame = 0; frame < frames; ++frame) {
        {
            const WorkingAllocations lifted;
            change(world, frame);
        }
        updatePairsInWant(world, parallelFor);
    }
}

/// After a failure or none the world goes on as if there had been none.
inline void checkPairsGoOn(FailingWorld& world, std::size_t n) {
    world.checkQueries();
    if (n % 2 == 1) {  // what changes meanwhile comes in addition
        world.moveSome(5);
        world.removeSome(11);
        world.addSome(3);
    }
    for (int frame = 0; frame < 2; ++frame) {
        world.updateAndCheckPairs();
        world.moveSome(13);
    }
    world.checkQueries();
}

/// The same where boxes tremble: they settle again, and few of them move.
inline void checkTremblingGoesOn(FailingWorld& world, std::size_t n) {
    checkPairsGoOn(world, n);
    const auto haveMostSettled = [&] {
        return 2 * world.pairs.lastCost().grid.resting > world.proxies.size();
    };
    for (int frame = 0; frame < 24 && !haveMostSettled(); ++frame) {
        world.tremble(kStanding, world.proxies.size(), kTrembling);
        world.updateAndCheckPairs();
    }
    EXPECT_TRUE(haveMostSettled());
    for (int frame = 0; frame < 2; ++frame) {
        world.tremble(kStanding, kStanding + 9, kTrembling);
        world.updateAndCheckPairs();
    }
    world.checkQueries();
}

struct OutOfMemory : testing::Test {
    using Make = std::function<std::unique_ptr<FailingWorld>()>;

    void SetUp() override {
        if (!kCountsAllocations) {
            GTEST_SKIP() << "this program has another `new`";
        }
    }
    /// The attempt fails at least so often, and the world goes on each time.
    static void expectGoesOn(
        std::size_t fewest, const Make& make, const std::function<void(FailingWorld&)>& attempt,
        const std::function<void(FailingWorld&, std::size_t)>& check = checkPairsGoOn) {
        EXPECT_GE(runOutOfMemory(make, attempt, check), fewest);
    }
};

}  // namespace hashphase::test
