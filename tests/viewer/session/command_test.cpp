// SPDX-License-Identifier: Zlib

#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/commands.hpp>
#include <demos/viewer/session/script.hpp>
#include <demos/viewer/session/session.hpp>
#include <tests/viewer/session/steps.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

Session smallSession() {
    return Session({.name = "wander", .file = {}, .objects = 200, .seed = 1}, 800, 600);
}

TEST(ViewerScript, ComplainsOfWhatIsNotSo) {
    Session session = smallSession();
    const auto said = runScript(session, "step 2\nexpect frame = 3\nexpect bodies > 199\n");
    ASSERT_EQ(said.size(), 1U);
    EXPECT_EQ(said.front(), "frame 2: frame is 2, but was to be = 3");
    EXPECT_EQ(session.failureCount, 1);
}

TEST(ViewerScript, NamesTheLineOfAFault) {
    Session session = smallSession();
    try {
        runScript(session, "# a comment\n\nstep 1\npik 3 4\n");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).substr(0, 49),
                  "script:4: There is no command 'pik'; did you mean");
    }
}

TEST(ViewerScript, SaysHowFarItHasComeAndWhatHasComeOfIt) {
    Session session = smallSession();
    session.isPlaying = false;
    Script script("step 3\n\nstep 2\nexpect frame = 5\n", "script");
    script.feed(session);
    EXPECT_EQ(script.verdict(session), "script: stopped at line 1 of 4");
    for (int frame = 0; frame < 4; ++frame) {
        session.advance();
        script.feed(session);
    }
    EXPECT_EQ(script.verdict(session), "script: stopped at line 3 of 4");
    session.advance();
    script.feed(session);
    EXPECT_EQ(script.verdict(session), "script: all expectations hold");
    Script last("step 2", "script");
    last.feed(session);
    EXPECT_EQ(last.verdict(session), "script: stopped at line 1 of 1");
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

TEST(Commands, CountMarkedBodiesThatAreStillThere) {
    Session session = smallSession();
    session.run("box 0 0 800 600");
    session.run("recolour");
    session.run("box 0 0 400 600");
    const std::size_t removed = session.selected.size();
    EXPECT_GT(removed, 0U);
    EXPECT_LT(removed, 200U);
    session.run("delete");
    EXPECT_EQ(session.reading("recoloured"), 200 - static_cast<double>(removed));
    EXPECT_EQ(session.reading("recoloured"), session.reading("bodies"));
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

// --- Whether pairs are right ---------------------------------------------------------------------

TEST(Check, KnowsNoPairsOfBodiesThatWereRemoved) {
    for (const char* broadphase : {"hash", "dbvt"}) {
        Session session({.name = "wander", .file = {}, .objects = 3000, .seed = 1}, 800, 600);
        session.run("check on");
        step(session, 10);
        session.run(std::string("broadphase ") + broadphase);
        step(session, 1);
        const double all = session.reading("pairs");
        session.run("box 300 200 500 400");
        session.run("delete");
        EXPECT_EQ(session.check(), nullptr);
        std::vector<PairKey> pairs;
        session.stage->listPairs(pairs);
        EXPECT_LT(pairs.size(), all) << broadphase;
        EXPECT_GT(pairs.size(), 0U) << broadphase;
        EXPECT_EQ(session.reading("pairs"), pairs.size()) << broadphase;
        for (const PairKey pair : pairs) {
            EXPECT_TRUE(session.stage->contains(firstOf(pair)) &&
                        session.stage->contains(secondOf(pair)))
                << broadphase;
        }
        step(session, 5);
        EXPECT_EQ(session.reading("missing"), 0) << broadphase;
        session.run("box 0 0 800 600");
        session.run("delete");
        EXPECT_EQ(session.reading("bodies"), 0) << broadphase;
        EXPECT_EQ(session.reading("pairs"), 0) << broadphase;
    }
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
