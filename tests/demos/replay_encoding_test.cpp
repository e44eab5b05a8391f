// SPDX-License-Identifier: Zlib
#include <demos/replay/replay_selection.hpp>
#include <tests/demos/replay_streams.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kEndless = std::numeric_limits<float>::infinity();
const Aabb<float> kTenMetres(Vector3<float>::Zero(), Vector3<float>::Constant(10));

Aabb<float> unitBoxAt(float x, float y, float z) {
    const Vector3<float> low(x, y, z);
    return {low, low + Vector3<float>::Ones()};
}

std::vector<std::uint32_t> firstNumbers(std::size_t count) {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < count; ++i) {
        numbers.push_back(i);
    }
    return numbers;
}

TEST(ReplayTrack, GivesBoxesBackToHalfAStep) {
    const auto frames = driftingFrames(50, 20);
    const Aabb<float> bounds(Vector3<float>::Constant(-10), Vector3<float>::Constant(22));
    ReplayTrack track(bounds, firstNumbers(50));
    for (const auto& boxes : frames) {
        track.add(boxes, overlappingPairs(boxes));
    }
    const auto samples = readBoxes(track.stream(), 50, frames.size());
    const double step = 32.0 / 65535;
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        std::vector<std::uint16_t> overlapCounts(50);
        for (const PairKey pair : overlappingPairs(frames[frame])) {
            ++overlapCounts[firstOf(pair)];
            ++overlapCounts[secondOf(pair)];
        }
        for (std::size_t i = 0; i < 50; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto k = static_cast<int>(axis);
                const Aabb<float>& box = frames[frame][i];
                EXPECT_NEAR(samples[frame][i][axis] * step - 10, box.center()[k], step * 0.501);
                EXPECT_NEAR(samples[frame][i][axis + 3] * step, box.sizes()[k], step * 0.501);
            }
            EXPECT_EQ(samples[frame][i][6], overlapCounts[i]);
        }
    }
    EXPECT_EQ(std::count(track.isCut().begin(), track.isCut().end(), 1), 0);
}

TEST(ReplayTrack, TakesAFewBytesForAFrameInWhichNothingMoves) {
    const std::vector<Aabb<float>> boxes = driftingFrames(1'000, 1).front();
    ReplayTrack track(kTenMetres, firstNumbers(1'000));
    track.add(boxes, {});
    const std::size_t first = track.stream().size();
    track.add(boxes, {});
    EXPECT_EQ(track.stream().size(), first + 3) << "0, and 999 in two groups of seven bits";
    const auto samples = readBoxes(track.stream(), 1'000, 2);
    EXPECT_EQ(samples[0], samples[1]);
    track.removeLast();
    EXPECT_EQ(track.stream().size(), first);
}

TEST(ReplayTrack, CutsOffWhatIsHugeOrHasNoNumbers) {
    const float most = std::numeric_limits<float>::max();
    const std::vector<Aabb<float>> boxes{
        unitBoxAt(1, 1, 1),
        {Vector3<float>::Constant(-kEndless), Vector3<float>::Constant(kEndless)},
        {Vector3<float>::Constant(-most), Vector3<float>::Constant(most)},
        {Vector3<float>(kNan, 1, 1), Vector3<float>(2, 2, 2)},
        unitBoxAt(1e30F, 0, 0)};
    ReplayTrack track(kTenMetres, firstNumbers(boxes.size()));
    track.add(boxes, {});
    const auto samples = readBoxes(track.stream(), boxes.size(), 1).front();
    using Sample = ReplayTrack::Sample;
    const Sample whole{32768, 32768, 32768, 65535, 65535, 65535, 0};
    EXPECT_EQ(samples[1], whole);
    EXPECT_EQ(samples[2], whole);
    EXPECT_EQ(samples[3], Sample{}) << "no size";
    EXPECT_EQ(samples[4], (Sample{65535, 3277, 3277, 0, 6554, 6554, 0})) << "at the world's end";
    EXPECT_EQ(track.isCut(), (std::vector<std::uint8_t>{0, 1, 1, 1, 1}));
}

TEST(ReplayTrack, HoldsNothingWhereThereAreNoObjects) {
    ReplayTrack track(kTenMetres, {});
    track.add({}, {});
    track.add({}, {});
    EXPECT_TRUE(track.stream().empty());
}

TEST(ReplayPairs, AreThoseOfEachFrame) {
    const auto frames = driftingFrames(300, 30);
    ReplayPairs pairs(1'000'000);
    std::size_t inAll = 0;
    for (const auto& boxes : frames) {
        pairs.add(overlappingPairs(boxes));
        inAll += overlappingPairs(boxes).size();
    }
    const auto read = readPairs(pairs.stream(), frames.size());
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        EXPECT_EQ(read[frame], overlappingPairs(frames[frame])) << frame;
        EXPECT_EQ(pairs.counts()[frame], read[frame].size());
        EXPECT_EQ(pairs.listedCounts()[frame], read[frame].size());
    }
    EXPECT_LT(pairs.stream().size(), inAll) << "less than a byte for a pair in a frame";
}

TEST(ReplayPairs, AreCountedButNotListedWhereThereAreTooMany) {
    const std::vector<PairKey> few{pairKey(0, 1), pairKey(0, 100'000)};
    const std::vector<PairKey> many{pairKey(0, 1), pairKey(1, 2), pairKey(1, 3)};
    ReplayPairs pairs(2);
    for (const auto& frame : {few, many, few, {}}) {
        pairs.add(frame);
    }
    EXPECT_EQ(readPairs(pairs.stream(), 4), (std::vector<std::vector<PairKey>>{few, {}, few, {}}));
    EXPECT_EQ(pairs.counts(), (std::vector<std::size_t>{2, 3, 2, 0}));
    EXPECT_EQ(pairs.listedCounts(), (std::vector<std::size_t>{2, 0, 2, 0}));
    pairs.removeLast();
    EXPECT_EQ(readPairs(pairs.stream(), 3).back(), few);
}

TEST(ReplaySelection, TakesThoseAroundTheMiddleOfTooMany) {
    std::vector<Aabb<float>> boxes;
    for (int i = 0; i < 100; ++i) {
        boxes.push_back(unitBoxAt(static_cast<float>(i), 0, 0));
    }
    const ReplaySelection selection = selectForReplay(boxes, Aabb<float>(), 10);
    ASSERT_EQ(selection.objects.size(), 10U);
    EXPECT_GE(selection.objects.front(), 44U);
    EXPECT_LE(selection.objects.back(), 55U);
    EXPECT_TRUE(std::is_sorted(selection.objects.begin(), selection.objects.end()));
    EXPECT_EQ(selectForReplay(boxes, Aabb<float>(), 100).objects, firstNumbers(100));
    EXPECT_TRUE(selectForReplay(boxes, Aabb<float>(), 0).objects.empty());
}

TEST(ReplaySelection, KeepsTheResolutionWhereAFewAreFarAway) {
    std::vector<Aabb<float>> boxes = driftingFrames(1'000, 1).front();
    boxes[3] = unitBoxAt(1e30F, 0, 0);
    boxes[4] = {Vector3<float>::Constant(-kEndless), Vector3<float>::Constant(kEndless)};
    boxes[5] = {Vector3<float>::Constant(kNan), Vector3<float>::Constant(kNan)};
    Aabb<float> world;
    for (const Aabb<float>& box : boxes) {
        world.extend(box);
    }
    const ReplaySelection selection = selectForReplay(boxes, world, 1'000);
    EXPECT_FLOAT_EQ(selection.typicalEdge, 1.25F);
    EXPECT_TRUE(selection.bounds.contains(kTenMetres));
    EXPECT_LT(selection.bounds.sizes().maxCoeff(), 60);
    const Aabb<float> tight(Vector3<float>::Zero(), Vector3<float>::Constant(9.25F));
    const ReplaySelection within = selectForReplay(boxes, tight, 1'000);
    EXPECT_EQ(within.bounds.min(), tight.min());
    EXPECT_EQ(within.bounds.max(), tight.max());
}

TEST(ReplaySelection, IsFiniteForNothingAndForAPoint) {
    const Vector3<float> point = Vector3<float>::Constant(5);
    for (const std::vector<Aabb<float>>& boxes :
         {std::vector<Aabb<float>>{}, std::vector<Aabb<float>>{{point, point}}}) {
        const ReplaySelection selection = selectForReplay(boxes, Aabb<float>(), 10);
        EXPECT_TRUE(selection.bounds.min().allFinite());
        EXPECT_TRUE(selection.bounds.max().allFinite());
        EXPECT_EQ(selection.typicalEdge, 1);
        EXPECT_EQ(selection.objects.size(), boxes.size());
    }
}

}  // namespace
}  // namespace hashphase::demos
