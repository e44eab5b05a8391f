// SPDX-License-Identifier: Zlib

#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/commands.hpp>
#include <demos/viewer/session/session.hpp>
#include <tests/support/temporary_folder.hpp>
#include <tests/viewer/session/stages.hpp>

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

Session smallSession() {
    return Session({.name = "wander", .file = {}, .objects = 200, .seed = 1}, 800, 600);
}

TEST(Commands, GiveAnEffectBackWhatTheSceneDeclaresOfIt) {
    Session session = smallSession();
    const SceneEffects own = session.stage->effects();
    for (const char* effect : {"motion", "response", "proximity"}) {
        session.run(std::string("effect ") + effect + " off");
    }
    session.run("effect terrain on");
    session.run("effect response on");
    session.run("effect proximity on");
    const SceneEffects& effects = session.stage->effects();
    EXPECT_EQ(effects.response->restitution, own.response->restitution);
    EXPECT_NE(effects.response->restitution, ResponseEffect().restitution);
    EXPECT_EQ(effects.proximity->radius, own.proximity->radius);
    EXPECT_EQ(effects.proximity->turns, own.proximity->turns);
    EXPECT_EQ(effects.motion->bounds.max().x(), 399);
    session.run("effect radar on");  // which the scene does not declare
    EXPECT_EQ(effects.radar->columns, RadarEffect().columns);
}

TEST(Loads, AreCountedWhereCellsAreSmallerThanTheRoundingOfCoordinates) {
    for (const float place : {255'143'500.0F, -255'143'500.0F, 1e30F}) {
        for (const double cellSize : {0.1, 1e-30, 1e30}) {
            GridConfig config;
            config.cellSize = cellSize;
            Grid<float> grid(config);
            const Aabb<float> box(Vector3<float>::Constant(place), Vector3<float>::Constant(place));
            static_cast<void>(grid.add(box));
            grid.update();
            EXPECT_TRUE(CellLoads().isEmpty());
            const CellLoads loads(grid, box);
            EXPECT_FALSE(loads.isEmpty());
            for (const std::uint32_t count : {loads.columns, loads.rows}) {
                EXPECT_GE(count, 1U) << place << ' ' << cellSize;
                EXPECT_LE(count, CellLoads::kMostColumns) << place << ' ' << cellSize;
            }
            EXPECT_EQ(loads.shades.size(), std::size_t{loads.columns} * loads.rows);
        }
    }
}

TEST(Commands, AreBoundToKeysOnceEach) {
    std::set<std::string_view> keys;
    for (const KeyBinding& binding : keyBindings()) {
        EXPECT_TRUE(keys.insert(binding.key).second) << binding.key;
        EXPECT_NE(findCommand(binding.command), nullptr) << binding.command;
    }
}

// --- Scenes --------------------------------------------------------------------------------------

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

// --- What is found -------------------------------------------------------------------------------

/// The body that is nearest to the camera under the pixel, asked one by one.
std::optional<std::uint32_t> bruteForcePick(Session& session, const Pixel& pixel) {
    const RayRegion<float> ray = session.view().rayThrough(pixel);
    std::optional<std::uint32_t> nearest;
    double best = 2;
    for (std::uint32_t index = 0; index < session.stage->grid()->indexLimit(); ++index) {
        const StageBody body = session.stage->body(index);
        const Vector3<double> way = ray.direction().cast<double>();
        const Vector3<double> apart = (body.centre - ray.from()).cast<double>();
        const double along = apart.dot(way) / way.squaredNorm();
        const double aside = (apart - along * way).norm();
        if (aside < double{body.size.x()} * 0.999 && along > 0 && along < best) {
            best = along;
            nearest = index;
        }
    }
    return nearest;
}

TEST(Picking, FindsWhoIsUnderThePixel) {
    Session session = smallSession();
    session.run("pose top 200 7 200 120 0 0 0 0 0 0 0 0 0 20 0 0");
    step(session, 5);
    int found = 0;
    for (int x = 10; x < 800; x += 10) {
        for (int y = 15; y < 600; y += 30) {
            const Pixel pixel(x, y);
            if (const auto expected = bruteForcePick(session, pixel)) {
                session.pick(pixel);
                ASSERT_TRUE(session.card) << x << ' ' << y;
                EXPECT_EQ(session.card->index, *expected) << x << ' ' << y;
                ++found;
            }
        }
    }
    EXPECT_GT(found, 5);
}

TEST(Picking, TellsWhoIsNear) {
    Session session({.name = "wander", .file = {}, .objects = 30'000, .seed = 1}, 800, 600);
    session.run("pose top 200 7 200 40 0 0 0 0 0 0 0 0 0 20 0 0");
    step(session, 3);
    session.run("pick 400 300");
    if (!session.card) {
        session.run("pick 420 300");
    }
    ASSERT_TRUE(session.card);
    const InfoCard card = *session.card;
    std::uint64_t near = 0;
    std::uint64_t touching = 0;
    for (std::uint32_t index = 0; index < 30'000; ++index) {
        const StageBody body = session.stage->body(index);
        const Vector3<float> apart = (body.centre - card.body.centre).cwiseAbs();
        const Vector3<float> fromBox = (apart - body.size).cwiseMax(0);
        near += index != card.index && fromBox.norm() <= card.radius ? 1 : 0;
        touching += index != card.index && apart.maxCoeff() <= 2 ? 1 : 0;
    }
    EXPECT_EQ(card.neighbours, near);
    EXPECT_EQ(card.candidates, touching);
    EXPECT_GT(near, 5U);
}

}  // namespace
}  // namespace hashphase::demos
