// SPDX-License-Identifier: Zlib

#include <demos/viewer/session/scene_choice.hpp>
#include <demos/viewer/session/session.hpp>
#include <tests/viewer/session/steps.hpp>

#include <gtest/gtest.h>

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
    EXPECT_EQ(session.stage().effects().motion->bounds.max().x(), 799);
    EXPECT_EQ(session.pose().eye.x(), 400);
    step(session, 1);
    EXPECT_EQ(session.visibleCount(), 120'000U);
}

}  // namespace
}  // namespace hashphase::demos
