// SPDX-License-Identifier: Zlib

#include <demos/viewer/session/session.hpp>
#include <demos/viewer/stage/recording_stage.hpp>
#include <tests/viewer/session/stages.hpp>
#include <tests/viewer/session/steps.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

TEST(RecordingStage, PlaysWhatWasCapturedAndBeginsAgain) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / "hashphase_stage_test.aabbs";
    Session session({.name = "wander", .file = {}, .objects = 200, .seed = 3});
    std::vector<Aabb<float>> before;
    std::vector<CollisionFilter> filters;
    session.stage().listBoxes(before, filters);
    session.run("capture " + path.string() + " 5");
    while (session.isWaiting()) {
        session.advance();
    }
    std::vector<Aabb<float>> after;
    session.stage().listBoxes(after, filters);
    RecordingStage stage(path, 0);
    const auto expectBoxes = [&](const std::vector<Aabb<float>>& boxes) {
        std::vector<Aabb<float>> played;
        stage.listBoxes(played, filters);
        ASSERT_EQ(played.size(), boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            ASSERT_EQ(played[i].min(), boxes[i].min());
            ASSERT_EQ(played[i].max(), boxes[i].max());
        }
    };
    expectBoxes(before);
    for (int frame = 0; frame < 5; ++frame) {
        stage.step();
        expectPairs(stage, true, "played");
        stage.setBroadphase(kindNamed(frame % 2 == 0 ? "dbvt" : "hash"));
    }
    expectBoxes(after);
    stage.step();
    expectBoxes(before);
    std::filesystem::remove(path);
}

TEST(RecordingStage, GoesOnWithTheFileThatItOpenedWhateverTakesItsName) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / "hashphase_replaced_recording_test.aabbs";
    const auto capture = [&path](std::size_t objects) {
        Session session({.name = "wander", .file = {}, .objects = objects, .seed = 3});
        session.run("capture " + path.string() + " 2");
        while (session.isWaiting()) {
            session.advance();
        }
    };
    capture(200);
    RecordingStage stage(path, 0);
    const std::uint64_t first = stage.placesHash();
    capture(5);
    for (int frame = 0; frame < 2; ++frame) {
        stage.step();
        EXPECT_NE(stage.placesHash(), first);
    }
    stage.step();
    EXPECT_EQ(stage.placesHash(), first);
    EXPECT_EQ(stage.size(), 200U);
    std::filesystem::remove(path);
}

TEST(RecordingStage, HasNoPairsWhileTheyAreNotDeclared) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / "hashphase_recorded_pairs_test.aabbs";
    Session session({.name = "pile", .file = {}, .objects = 200, .seed = 3});
    session.run("capture " + path.string() + " 5");
    while (session.isWaiting()) {
        session.advance();
    }
    RecordingStage stage(path, 0);
    const SceneEffects all = stage.effects();
    SceneEffects without = all;
    without.remove(Effect::pairs);
    std::vector<PairKey> pairs;
    for (const char* name : {"hash", "dbvt"}) {
        stage.setBroadphase(kindNamed(name));
        stage.step();
        EXPECT_GT(stage.pairCount(), 0U) << name;
        stage.declare(without);
        for (int frame = 0; frame < 2; ++frame) {
            stage.listPairs(pairs);
            EXPECT_TRUE(pairs.empty()) << name;
            EXPECT_EQ(stage.pairCount(), 0U) << name;
            stage.step();
        }
        stage.declare(all);
        EXPECT_EQ(stage.pairCount(), 0U) << name << ": those of the past";
        stage.step();
        EXPECT_GT(stage.pairCount(), 0U) << name;
        expectPairs(stage, false, name);
    }
    std::filesystem::remove(path);
}

TEST(RecordingStage, ColoursAgentsOnceWhenTheyBeginToLookAround) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / "hashphase_recorded_colours_test.aabbs";
    Session session({.name = "wander", .file = {}, .objects = 200, .seed = 3});
    session.run("capture " + path.string() + " 2");
    while (session.isWaiting()) {
        session.advance();
    }
    RecordingStage stage(path, 0);
    SceneEffects effects = stage.effects();
    effects.declare(Effect::proximity);
    stage.declare(effects);
    expectEvenColours(stage);
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace hashphase::demos
