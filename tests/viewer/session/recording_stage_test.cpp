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

}  // namespace
}  // namespace hashphase::demos
