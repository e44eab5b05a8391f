// SPDX-License-Identifier: Zlib
#include <demos/compare/compare_command.hpp>
#include <demos/report/page.hpp>
#include <demos/report/report_command.hpp>
#include <tests/demos/replay_frames.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <regex>
#include <sstream>

namespace hashphase::demos {
namespace {

std::string tabOf(const ReplayRecording& recording) {
    Page page;
    addReplayTab(recording, 500, page);
    return page.tabs.empty() ? "" : page.tabs.front().content;
}

bool includes(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(ReplayRecording, TellsCountsAndTheFirstWrongPair) {
    const auto frames = driftingFrames(200, 6);
    const Json json = recorded(replaySettings(), frames).json();
    EXPECT_EQ(json["frames"], 6);
    EXPECT_EQ(json["objects"], 200);
    EXPECT_EQ(json["objectsCut"], 0);
    EXPECT_EQ(json["broadphases"][0]["missing"], Json({0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(json["broadphases"][1]["missing"], Json({0, 0, 1, 1, 1, 1}));
    EXPECT_EQ(json["broadphases"][1]["extra"], Json({0, 0, 0, 0, 0, 0}));
    ASSERT_EQ(json["tracks"].size(), 1U) << "all see the same boxes";
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        EXPECT_EQ(json["tracks"][0]["pairsInAll"][frame], overlappingPairs(frames[frame]).size());
        EXPECT_EQ(json["tracks"][0]["pairs"][frame], overlappingPairs(frames[frame]).size());
    }
    EXPECT_TRUE(json["broadphases"][0]["first"].is_null());
    const Json& first = json["broadphases"][1]["first"];
    const PairKey pair = overlappingPairs(frames[2]).front();
    const std::string a = std::to_string(firstOf(pair));
    const std::string b = std::to_string(secondOf(pair));
    EXPECT_EQ(first["frame"], 2);
    EXPECT_EQ(first["places"], Json({firstOf(pair), secondOf(pair)}));
    EXPECT_TRUE(includes(first["words"], "Objects " + a + " and " + b + " overlap by ")) << first;
}

TEST(ReplayRecording, TellsTheFinestCellsOfWhatHasCells) {
    ReplayRecording recording(replaySettings());
    for (const float cellSize : {1.0F, 2.5F}) {
        const FrameBoxes boxes = driftingFrames(5, 1)[0];
        recording.add(0, {boxes, {}, {}, {}, cellSize});
        recording.add(1, {boxes, {}, {}, {}});
        recording.finishFrame();
    }
    EXPECT_EQ(recording.json()["broadphases"][0]["cellSize"], 2.5F) << "in the last frame";
    EXPECT_TRUE(recording.json()["broadphases"][1]["cellSize"].is_null());
}

TEST(ReplayRecording, EndsWhereTheSettingsSay) {
    const auto frames = driftingFrames(200, 6);
    ReplaySettings few = replaySettings();
    few.frames = 3;
    EXPECT_EQ(recorded(few, frames).json()["frames"], 3);
    EXPECT_TRUE(recorded(few, frames).isFull());

    ReplaySettings small = replaySettings();
    small.bytes = 12'000;
    const ReplayRecording cut = recorded(small, frames);
    const Json json = cut.json();
    EXPECT_TRUE(cut.isFull());
    EXPECT_GT(json["frames"], 1);
    EXPECT_LT(json["frames"], 6);
    EXPECT_LT(json.dump().size(), 12'000U + 1'000U);
    EXPECT_EQ(json["broadphases"][1]["missing"].size(), json["frames"]);
    EXPECT_TRUE(includes(tabOf(cut), json["frames"].dump() + " of 500 frames"));

    ReplaySettings none = replaySettings();
    none.frames = 0;
    EXPECT_TRUE(ReplayRecording(none).isFull());
    none = replaySettings();
    none.bytes = 1'000;
    EXPECT_EQ(recorded(none, frames).json()["frames"], 0);
    EXPECT_EQ(tabOf(recorded(none, frames)), "");
}

TEST(ReplayRecording, SaysWhatItLeavesOut) {
    auto frames = driftingFrames(200, 2);
    frames[1][7].translate(Vector3<float>(1e6F, 0, 0));
    ReplaySettings settings = replaySettings();
    settings.noun = "crates";
    settings.pairs = 5;
    const std::string all = tabOf(recorded(settings, frames));
    EXPECT_TRUE(includes(all, "a test: the first 2 of 500 frames with all 200 crates.")) << all;
    EXPECT_TRUE(includes(all, "In 2 of the frames there are more than 5 pairs, which are counted"));
    EXPECT_TRUE(includes(all, "The picture cuts off 1 of the crates at its border: outside the"));
    EXPECT_FALSE(includes(all, "terrain"));
    settings.objects = 50;
    const ReplayRecording some = recorded(settings, frames);
    EXPECT_TRUE(includes(tabOf(some), "with 50 of 200 crates: those nearest to the middle"));
    EXPECT_LT(some.json()["tracks"][0]["pairs"][0], some.json()["tracks"][0]["pairsInAll"][0]);
}

TEST(ReplayRecording, TakesOneFrameAndNoObjects) {
    EXPECT_EQ(recorded(replaySettings(), driftingFrames(3, 1)).json()["frames"], 1);
    const ReplayRecording empty = recorded(replaySettings(), driftingFrames(0, 2));
    EXPECT_EQ(empty.json()["frames"], 2);
    EXPECT_EQ(empty.json()["tracks"][0]["boxStream"], "");
    EXPECT_TRUE(includes(tabOf(empty), "with all 0 objects"));
}

TEST(ReplayRecording, KeepsTheBoxesOfEachBroadphaseWhereTheyDiffer) {
    ReplaySettings settings = replaySettings();
    settings.sharesBoxes = false;
    const Json json = recorded(settings, driftingFrames(20, 3)).json();
    EXPECT_EQ(json["tracks"].size(), 2U);
    EXPECT_EQ(json["broadphases"][1]["track"], 1);
}

// --- The ground ----------------------------------------------------------------------------------

TEST(ReplayGround, IsALatticeOfNearlySquareCellsInStepsOfItsHeights) {
    const Aabb<float> bounds(Vector3<float>(2, 0, 1), Vector3<float>(10, 40, 3));
    const ReplayGround ground = sampleGround(heightOfSlope, bounds);
    EXPECT_EQ(ground.columns, 129U);
    EXPECT_EQ(ground.rows, 33U);
    EXPECT_FLOAT_EQ(ground.lowest, heightOfSlope(2, 0));
    EXPECT_FLOAT_EQ(ground.highest, heightOfSlope(10, 0));
    ASSERT_EQ(ground.heights.size(), 129U * 33U);
    const float step = (ground.highest - ground.lowest) / 255;
    for (std::size_t i = 0; i < ground.heights.size(); ++i) {
        const float x = 2 + 8 * static_cast<float>(i % 129) / 128;
        const float height = ground.lowest + step * static_cast<float>(ground.heights[i]);
        EXPECT_NEAR(height, heightOfSlope(x, 0), 0.501F * step) << i;
    }
}

TEST(ReplayGround, MayBeLevelAndIsNoneWithoutHeightsOrRoom) {
    const auto level = [](float /*x*/, float /*z*/) { return 3.0F; };
    const ReplayGround ground = sampleGround(level, kTenMetres);
    EXPECT_EQ(ground.lowest, ground.highest);
    EXPECT_TRUE(std::ranges::all_of(ground.heights, [](auto each) { return each == 0; }));
    EXPECT_TRUE(groundJson(sampleGround({}, kTenMetres)).is_null());
    const Aabb<float> line(Vector3<float>::Zero(), Vector3<float>(10, 10, 0));
    EXPECT_TRUE(groundJson(sampleGround(level, line)).is_null());
}

TEST(ReplayGround, CoversTheRecordedBoundsAndCountsAmongTheBytes) {
    const auto frames = driftingFrames(200, 6);
    ReplaySettings settings = replaySettings();
    settings.bounds = kTenMetres;
    settings.bytes = 12'000;
    EXPECT_TRUE(recorded(settings, frames).json()["ground"].is_null());
    const std::size_t without = recorded(settings, frames).json()["frames"];
    settings.ground = heightOfSlope;
    settings.bytes += 4 * 129 * 129 / 3;
    const ReplayRecording recording = recorded(settings, frames);
    const Json json = recording.json();
    EXPECT_EQ(json["frames"], without);
    EXPECT_EQ(json["ground"]["heights"].get<std::string>().size(), 22'188U);
    EXPECT_FLOAT_EQ(json["ground"]["lowest"], heightOfSlope(json["low"][0], 0));
    EXPECT_FLOAT_EQ(json["ground"]["highest"], heightOfSlope(json["high"][0], 0));
    EXPECT_TRUE(includes(tabOf(recording), "The terrain is drawn from 129 x 129 heights."));
    EXPECT_TRUE(recorded(settings, driftingFrames(0, 1)).json()["ground"].is_null());
}

// --- Who is recorded -----------------------------------------------------------------------------

TEST(ReplaySelection, TakesThoseAroundTheMiddleOfTooMany) {
    FrameBoxes boxes;
    for (int i = 0; i < 100; ++i) {
        const Vector3<float> low(static_cast<float>(i), 0, 0);
        boxes.emplace_back(low, low + Vector3<float>::Ones());
    }
    const ReplaySelection selection = selectForReplay(boxes, Aabb<float>(), 10);
    ASSERT_EQ(selection.objects.size(), 10U);
    EXPECT_GE(selection.objects.front(), 44U);
    EXPECT_LE(selection.objects.back(), 55U);
    EXPECT_TRUE(std::ranges::is_sorted(selection.objects));
    EXPECT_EQ(selectForReplay(boxes, Aabb<float>(), 100).objects, firstNumbers(100));
    EXPECT_TRUE(selectForReplay(boxes, Aabb<float>(), 0).objects.empty());
}

TEST(ReplaySelection, KeepsTheResolutionWhereAFewAreFarAway) {
    FrameBoxes boxes = driftingFrames(1'000, 1).front();
    boxes[3].translate(Vector3<float>(1e30F, 0, 0));
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
    for (const FrameBoxes& boxes : {FrameBoxes{}, FrameBoxes{{point, point}}}) {
        const ReplaySelection selection = selectForReplay(boxes, Aabb<float>(), 10);
        EXPECT_TRUE(selection.bounds.min().allFinite());
        EXPECT_TRUE(selection.bounds.max().allFinite());
        EXPECT_EQ(selection.typicalEdge, 1);
        EXPECT_EQ(selection.objects.size(), boxes.size());
    }
}

// --- In pages ------------------------------------------------------------------------------------

std::string pageOfCommand(std::vector<std::string> arguments, const TemporaryFolder& folder) {
    const std::array subcommands{
        compareCommand(),
        reportCommand({{compareCommand(), {"--objects", "50", "--frames", "12"}}})};
    const std::string path = folder.file("page.html");
    arguments.insert(arguments.end(), {"--html", path});
    const Typed ran = typed(arguments, subcommands);
    EXPECT_EQ(ran.exitCode, kExitOk) << ran.err;
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ReplayTab, IsInPagesOfComparisonsUnlessNotWanted) {
    const TemporaryFolder folder;
    const std::vector<std::string> brief{"compare", "--objects", "50", "--frames", "12"};
    const std::string page = pageOfCommand(brief, folder);
    EXPECT_TRUE(includes(page, "of paper: the first 12 of 12 frames"));
    EXPECT_TRUE(includes(page, "\"ground\":{\"columns\":129,\"rows\":129,"));
    EXPECT_TRUE(std::regex_search(page, std::regex("\"name\":\"hash\"[^}]*\"cellSize\":[0-9]")));
    EXPECT_TRUE(includes(page, "\"cellSize\":null")) << "of trees";
    std::vector<std::string> other = brief;
    other.insert(other.end(), {"--scene", "uniform", "--broadphases", "dbvt,hash,simple"});
    const std::string boxes = pageOfCommand(other, folder);
    EXPECT_TRUE(includes(boxes, "\"ground\":null"));
    EXPECT_TRUE(includes(boxes, "\"opensOn\":1")) << "ours, wherever it was named";
    std::vector<std::string> fewer = brief;
    fewer.insert(fewer.end(), {"--replay-frames", "4"});
    EXPECT_TRUE(includes(pageOfCommand(fewer, folder), "of paper: the first 4 of 12 frames"));
    fewer.back() = "0";
    EXPECT_FALSE(includes(pageOfCommand(fewer, folder), "role=\"tab\""));
    EXPECT_TRUE(
        includes(pageOfCommand({"report", "--quick"}, folder), "the first 12 of 12 frames"));
}

}  // namespace
}  // namespace hashphase::demos
