// SPDX-License-Identifier: Zlib
#include <demos/compare/compare_command.hpp>
#include <demos/replay/replay_recording.hpp>
#include <demos/replay/replay_tab.hpp>
#include <demos/report/report_command.hpp>
#include <tests/demos/replay_streams.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <iterator>
#include <regex>
#include <sstream>

namespace hashphase::demos {
namespace {

ReplaySettings replaySettings() {
    ReplaySettings settings;
    settings.scene = "a test";
    settings.broadphases = {"right", "wrong"};
    return settings;
}

/// Records the frames until the recording is full; "wrong" misses the first pair from frame 2 on.
ReplayRecording recorded(ReplaySettings settings,
                         const std::vector<std::vector<Aabb<float>>>& frames) {
    ReplayRecording recording(std::move(settings));
    for (std::size_t frame = 0; frame < frames.size() && !recording.isFull(); ++frame) {
        const std::vector<PairKey> exact = overlappingPairs(frames[frame]);
        recording.add(0, {frames[frame], exact, {}, {}});
        const std::size_t missed = frame < 2 || exact.empty() ? 0 : 1;
        recording.add(1, {frames[frame], exact, std::span(exact).first(missed), {}});
        recording.finishFrame();
    }
    return recording;
}

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
    const ReplayRecording recording = recorded(replaySettings(), frames);
    EXPECT_EQ(recording.frameCount(), 6U);
    EXPECT_EQ(recording.missingCount(0), 0U);
    EXPECT_EQ(recording.missingCount(1), 4U);
    EXPECT_EQ(recording.extraCount(1), 0U);
    EXPECT_EQ(recording.cutCount(), 0U);
    const Json json = recording.json();
    EXPECT_EQ(json["objects"], 200);
    ASSERT_EQ(json["tracks"].size(), 1U) << "all see the same boxes";
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        EXPECT_EQ(json["tracks"][0]["pairsInAll"][frame], overlappingPairs(frames[frame]).size());
        EXPECT_EQ(json["tracks"][0]["pairs"][frame], overlappingPairs(frames[frame]).size());
    }
    EXPECT_TRUE(json["broadphases"][0]["first"].is_null());
    const Json& first = json["broadphases"][1]["first"];
    const PairKey pair = overlappingPairs(frames[2]).front();
    EXPECT_EQ(first["frame"], 2);
    EXPECT_EQ(first["places"], Json({firstOf(pair), secondOf(pair)}));
    EXPECT_TRUE(includes(first["words"].get<std::string>(),
                         "Objects " + std::to_string(firstOf(pair)) + " and " +
                             std::to_string(secondOf(pair)) + " overlap by "))
        << first;
}

TEST(ReplayRecording, TellsTheFinestCellsOfWhatHasCells) {
    ReplaySettings settings = replaySettings();
    ReplayRecording recording(settings);
    for (const float cellSize : {1.0F, 2.5F}) {
        const auto boxes = driftingFrames(5, 1)[0];
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
    EXPECT_EQ(recorded(few, frames).frameCount(), 3U);
    EXPECT_TRUE(recorded(few, frames).isFull());

    ReplaySettings small = replaySettings();
    small.bytes = 12'000;
    const ReplayRecording cut = recorded(small, frames);
    EXPECT_TRUE(cut.isFull());
    EXPECT_GT(cut.frameCount(), 1U);
    EXPECT_LT(cut.frameCount(), 6U);
    EXPECT_LT(cut.json().dump().size(), 12'000U + 1'000U);
    EXPECT_EQ(cut.json()["broadphases"][1]["missing"].size(), cut.frameCount());
    EXPECT_TRUE(includes(tabOf(cut), std::to_string(cut.frameCount()) + " of 500 frames"));

    ReplaySettings none = replaySettings();
    none.frames = 0;
    EXPECT_TRUE(ReplayRecording(none).isFull());
    none = replaySettings();
    none.bytes = 1'000;
    EXPECT_EQ(recorded(none, frames).frameCount(), 0U);
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
    EXPECT_TRUE(includes(all, "1 of the crates reach beyond the drawn world"));
    settings.objects = 50;
    const ReplayRecording some = recorded(settings, frames);
    EXPECT_TRUE(includes(tabOf(some), "of 200 crates the 50 that stand nearest to the middle"));
    EXPECT_LT(some.json()["tracks"][0]["pairs"][0], some.json()["tracks"][0]["pairsInAll"][0]);
}

TEST(ReplayRecording, TakesOneFrameAndNoObjects) {
    EXPECT_EQ(recorded(replaySettings(), driftingFrames(3, 1)).frameCount(), 1U);
    const ReplayRecording empty = recorded(replaySettings(), driftingFrames(0, 2));
    EXPECT_EQ(empty.frameCount(), 2U);
    EXPECT_EQ(empty.json()["objects"], 0);
    EXPECT_TRUE(includes(tabOf(empty), "with all 0 objects"));
}

TEST(ReplayRecording, KeepsTheBoxesOfEachBroadphaseWhereTheyDiffer) {
    ReplaySettings settings = replaySettings();
    settings.sharesBoxes = false;
    const Json json = recorded(settings, driftingFrames(20, 3)).json();
    EXPECT_EQ(json["tracks"].size(), 2U);
    EXPECT_EQ(json["broadphases"][1]["track"], 1);
}

TEST(ReplayRecording, IsReadByJavaScriptAsItWasWritten) {
    if (std::string(HASHPHASE_NODE).empty()) {
        GTEST_SKIP() << "Node.js is needed (Debian: nodejs).";
    }
    const auto frames = driftingFrames(150, 12);
    const Json json = recorded(replaySettings(), frames).json();
    const TemporaryFolder folder;
    const std::string command = "'" HASHPHASE_NODE "' '" HASHPHASE_READ_REPLAY_SCRIPT "' '" +
                                folder.write("replay.json", json.dump()) + "' >'" +
                                folder.file("read.json") + "'";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    const Json read = Json::parse(std::ifstream(folder.file("read.json")));
    ASSERT_EQ(read.size(), frames.size());
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        std::vector<PairKey> pairs;
        for (std::size_t i = 0; i < read[frame]["pairs"].size(); i += 2) {
            pairs.push_back(pairKey(read[frame]["pairs"][i], read[frame]["pairs"][i + 1]));
        }
        EXPECT_EQ(pairs, overlappingPairs(frames[frame])) << "frame " << frame;
        for (std::size_t i = 0; i < frames[frame].size(); ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(read[frame]["centres"][i][static_cast<std::size_t>(axis)],
                            frames[frame][i].center()[axis], 1e-3);
            }
        }
    }
}

std::string pageOfCommand(std::vector<std::string> arguments, const TemporaryFolder& folder) {
    std::ostringstream out;
    std::ostringstream err;
    const std::array subcommands{
        compareCommand(),
        reportCommand({{compareCommand(), {"--objects", "50", "--frames", "12"}}})};
    const std::string path = folder.file("page.html");
    arguments.insert(arguments.end(), {"--html", path});
    EXPECT_EQ(runProgram(arguments, subcommands, {out, err, false, "hashphase test"}), kExitOk)
        << err.str();
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ReplayTab, IsInPagesOfComparisonsUnlessNotWanted) {
    const TemporaryFolder folder;
    const std::vector<std::string> brief{"compare", "--objects", "50", "--frames", "12"};
    const std::string page = pageOfCommand(brief, folder);
    EXPECT_TRUE(includes(page, "of paper: the first 12 of 12 frames"));
    EXPECT_TRUE(std::regex_search(page, std::regex("\"name\":\"hash\"[^}]*\"cellSize\":[0-9]")));
    EXPECT_TRUE(includes(page, "\"cellSize\":null")) << "of trees";
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
