// SPDX-License-Identifier: Zlib

#include <demos/viewer/session/scene_choice.hpp>
#include <demos/viewer/session/session.hpp>
#include <tests/support/temporary_folder.hpp>
#include <tests/viewer/session/steps.hpp>

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace hashphase::demos {
namespace {

TEST(SceneChoice, GivesWanderersAsMuchRoomEachAsTheThirtyThousandHave) {
    const auto pairsOf = [](std::size_t objects, float side) {
        const auto stage = makeStage({.name = "wander", .file = {}, .objects = objects, .seed = 1});
        EXPECT_EQ(stage->bounds().max().x(), side);
        EXPECT_EQ(stage->effects().motion->bounds.max().x(), double{side} - 1);
        for (int frame = 0; frame < 3; ++frame) {
            stage->step();
        }
        return static_cast<double>(stage->pairCount());
    };
    const double few = pairsOf(30'000, 400);
    const double many = pairsOf(120'000, 800);
    EXPECT_NEAR(many / few, 4, 0.2);
    static_cast<void>(pairsOf(1'000, 400));
}

TEST(SceneChoice, ShowsAllOfASceneThatHasGrown) {
    Session session({.name = "wander", .file = {}, .objects = 1000, .seed = 1}, 800, 600);
    session.run("camera top");
    session.run("objects 120000");
    EXPECT_EQ(session.stage->effects().motion->bounds.max().x(), 799);
    EXPECT_EQ(session.pose().eye.x(), 400);
    step(session, 1);
    EXPECT_EQ(session.visibleCount(), 120'000U);
}

TEST(SceneChoice, RefusesAFileWithAnEffectThatNoSimulationHas) {
    const TemporaryFolder folder;
    const std::string path = folder.file("scene.json");
    const auto write = [&path](const std::string& effects) {
        std::ofstream(path) << R"({"scene": {"objects": 20}, "effects": {"motion": true)" << effects
                            << "}}";
    };
    write("");
    Session session({.name = {}, .file = path, .objects = {}, .seed = 1});
    step(session, 3);
    for (const char* effects :
         {R"(, "rotation": true)", R"(, "pairs": true, "response": true, "friction": true)"}) {
        write(effects);
        const std::string fault = faultOf(session, "restart");
        EXPECT_EQ(fault.substr(0, path.size() + 2), path + ": ") << fault;
        EXPECT_EQ(faultOf(session, "objects 30"), fault);
        EXPECT_EQ(session.frame, 3U);
        EXPECT_EQ(session.stage->size(), 20U);
    }
    write(R"(, "pairs": true)");
    session.run("restart");
    EXPECT_EQ(session.frame, 0U);
}

}  // namespace
}  // namespace hashphase::demos
