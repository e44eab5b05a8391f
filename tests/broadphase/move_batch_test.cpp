// SPDX-License-Identifier: Zlib
//
// Many boxes set at once, on any number of threads, against as many single calls.

#include <broadphase/grid.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/random.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

using Box = Aabb<float>;

/// A frame's moves, and what else happens.
struct Plan {
    double moved = 1;  // share of the proxies
    bool isShuffled = false;
    double namedTwice = 0;  // share of the moves that name any proxy
    double nan = 0;
    double kept = 0;  // moves to the present box
};

/// A grid with pairs and sweeps, whose boxes are set in batches or one by one.
class Moved {
public:
    static constexpr std::uint32_t kCount = 9000;

    explicit Moved(std::size_t threadCount) : threads_(threadCount, 0x5eed0a01 + threadCount) {
        Random random(0x5eed0a02);
        for (std::uint32_t i = 0; i < kCount; ++i) {
            ids.push_back(
                grid.add(draw(random), i % 3 == 0 ? Mobility::resting : Mobility::mobile));
        }
    }

    static Box draw(Random& random) { return cubesIn<float>(-20.0, 20.0, 0.5)(random); }

    /// With 0 threads one by one.
    void move(std::span<const ProxyId> moved, std::span<const Box> boxes, std::size_t threadCount) {
        if (threadCount > 0) {
            grid.move(moved, boxes, threads_);
            return;
        }
        for (std::size_t i = 0; i < moved.size(); ++i) {
            grid.move(moved[i], boxes[i]);
        }
    }

    Grid<float> grid;
    Sweeps<float> sweeps{grid};
    Pairs<float> pairs{grid, &sweeps};
    std::vector<ProxyId> ids;
    ThreadedFor threads_;
};

void expectSame(Moved& batch, Moved& single) {
    const auto& a = batch.grid.store();
    const auto& b = single.grid.store();
    EXPECT_TRUE(std::ranges::equal(a.proxies.waiting, b.proxies.waiting));
    EXPECT_EQ(a.proxies.mobile, b.proxies.mobile);
    EXPECT_EQ(a.proxies.woken, b.proxies.woken);
    EXPECT_EQ(a.proxies.nanCount, b.proxies.nanCount);
    EXPECT_EQ(a.cost.changed, b.cost.changed);
    EXPECT_EQ(a.tables.restingErased, b.tables.restingErased);
    for (std::size_t i = 0; i < a.proxies.records.size(); ++i) {
        const auto& one = a.proxies.records[i];
        const auto& other = b.proxies.records[i];
        ASSERT_TRUE(isSameBits(one.box, other.box));
        ASSERT_TRUE(isSameBits(one.before, other.before));
        ASSERT_EQ(one.changedAt, other.changedAt);
        ASSERT_EQ(one.listedAt, other.listedAt);
        ASSERT_EQ(one.residency, other.residency);
        ASSERT_EQ(one.listedIn, other.listedIn);
        ASSERT_EQ(one.restsAtOnce, other.restsAtOnce);
        ASSERT_EQ(one.isNan, other.isNan);
    }
    ASSERT_EQ(batch.grid.validate(), "");
}

class MoveBatches : public testing::TestWithParam<std::size_t> {};

TEST_P(MoveBatches, DoWhatSingleCallsDoOnAnyNumberOfThreads) {
    const std::size_t threadCount = GetParam();
    const CaughtMessages quiet;
    Moved batch(threadCount);
    Moved single(threadCount);
    const std::vector<Plan> plans{
        {},
        {.isShuffled = true},
        {.moved = 0.3, .kept = 0.5},
        {.moved = 0.9, .isShuffled = true, .nan = 0.05},
        {.moved = 0.5, .isShuffled = true, .namedTwice = 0.1, .nan = 0.01, .kept = 0.2},
        {.moved = 0}};
    Random random(0x5eed0a03);
    std::size_t pairCount = 0;
    for (int frame = 0; frame < 36; ++frame) {
        SCOPED_TRACE(testing::Message() << threadCount << " threads, frame " << frame);
        const Plan& plan = plans[static_cast<std::size_t>(frame < 24 ? frame % 5 : 5)];
        for (int round = 0; round < 2; ++round) {  // a second one changes what waits already
            std::vector<ProxyId> ids;
            std::vector<Box> boxes;
            for (std::uint32_t i = 0; i < Moved::kCount; ++i) {
                if (!random.chance(plan.moved)) {
                    continue;
                }
                const std::uint32_t inOrder = plan.isShuffled ? i * 4001 % Moved::kCount : i;
                ids.push_back(batch.ids[random.chance(plan.namedTwice) ? random.below(Moved::kCount)
                                                                       : inOrder]);
                boxes.push_back(random.chance(plan.kept) ? single.grid.box(ids.back())
                                                         : Moved::draw(random));
                if (random.chance(plan.nan)) {
                    boxes.back().min()[1] = std::numeric_limits<float>::quiet_NaN();
                }
            }
            for (int i = 0; i < 50; ++i) {
                const ProxyId id = batch.ids[random.below(Moved::kCount)];
                const Vector3<float> way = random.pointIn(-3, 3).cast<float>();
                batch.sweeps.set(id, way, Sweep::automatic);
                single.sweeps.set(id, way, Sweep::automatic);
            }
            if (frame % 7 == 3) {  // queries file what has changed, and the next change takes it
                batch.grid.expectQueries(100'000);
                single.grid.expectQueries(100'000);
            }
            batch.move(ids, boxes, threadCount);
            single.move(ids, boxes, 0);
            expectSame(batch, single);
            ASSERT_FALSE(testing::Test::HasFailure());
        }
        const PairChanges one = batch.pairs.update(acceptAllPairs, batch.threads_);
        const PairChanges other = single.pairs.update();
        ASSERT_TRUE(std::ranges::equal(one.born, other.born));
        ASSERT_TRUE(std::ranges::equal(one.died, other.died));
        pairCount += one.born.size();
    }
    EXPECT_GT(pairCount, 1000U);
    EXPECT_GT(batch.threads_.mostRanges(), 1U);
}

INSTANTIATE_TEST_SUITE_P(Threads, MoveBatches, testing::Values(1, 2, 3, 8));

TEST(MoveBatch, IsEmptyOrShortAsWell) {
    Grid<float> grid;
    const ProxyId id = grid.add(makeBox<float>(0, 0, 0, 1, 1, 1));
    const Box box = makeBox<float>(5, 5, 5, 6, 6, 6);
    grid.move({}, {}, serialFor);
    grid.move(std::span(&id, 1), std::span(&box, 1), serialFor);
    EXPECT_TRUE(isSameBits(grid.box(id), box));
    EXPECT_EQ(grid.validate(), "");
}

}  // namespace
}  // namespace hashphase::test
