// SPDX-License-Identifier: Zlib

#include <demos/viewer/session/session.hpp>
#include <demos/viewer/stage/recording_stage.hpp>
#include <tests/support/temporary_folder.hpp>
#include <tests/viewer/session/stages.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

/// Boxes of so many frames of the session, in that file.
void capture(Session& session, const std::string& path, int frames) {
    session.run("capture " + path + " " + std::to_string(frames));
    while (session.isWaiting()) {
        session.advance();
    }
}

class RecordingStages : public testing::Test {
protected:
    [[nodiscard]] std::string path() const { return folder_.file("boxes.aabbs"); }

    void capture(const char* scene, std::size_t objects, int frames) const {
        Session session({.name = scene, .file = {}, .objects = objects, .seed = 3});
        demos::capture(session, path(), frames);
    }

private:
    TemporaryFolder folder_;
};

TEST_F(RecordingStages, PlaysWhatWasCapturedAndBeginsAgain) {
    Session session({.name = "wander", .file = {}, .objects = 200, .seed = 3});
    std::vector<Aabb<float>> before;
    std::vector<CollisionFilter> filters;
    session.stage->listBoxes(before, filters);
    demos::capture(session, path(), 5);
    std::vector<Aabb<float>> after;
    session.stage->listBoxes(after, filters);
    RecordingStage stage(path(), 0);
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
}

TEST_F(RecordingStages, GoesOnWithTheFileThatItOpenedWhateverTakesItsName) {
    capture("wander", 200, 2);
    RecordingStage stage(path(), 0);
    const std::uint64_t first = stage.placesHash();
    capture("wander", 5, 2);
    for (int frame = 0; frame < 2; ++frame) {
        stage.step();
        EXPECT_NE(stage.placesHash(), first);
    }
    stage.step();
    EXPECT_EQ(stage.placesHash(), first);
    EXPECT_EQ(stage.size(), 200U);
}

}  // namespace
}  // namespace hashphase::demos
