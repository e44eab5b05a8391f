// SPDX-License-Identifier: Zlib

#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/commands.hpp>
#include <demos/viewer/session/script.hpp>
#include <demos/viewer/session/session.hpp>
#include <tests/viewer/session/steps.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

Session smallSession() {
    return Session({.name = "wander", .file = {}, .objects = 200, .seed = 1}, 800, 600);
}

TEST(ViewerScript, DrivesEachFeatureAndFindsWhatItExpects) {
    Session session = smallSession();
    const std::vector<std::string> said = runScript(session, readFile(HASHPHASE_FEATURES_SCRIPT));
    std::string all;
    for (const std::string& line : said) {
        all += line + '\n';
    }
    EXPECT_EQ(session.failureCount(), 0) << all;
}

TEST(ViewerScript, HasEachCommandThatWritesNoFile) {
    std::set<std::string> used;
    std::istringstream lines(readFile(HASHPHASE_FEATURES_SCRIPT));
    for (std::string line; std::getline(lines, line);) {
        used.emplace(firstWord(line));
    }
    for (const CommandKind& kind : commandKinds()) {
        const std::string name(kind.name);
        if (name != "screenshot" && name != "save" && name != "capture") {
            EXPECT_TRUE(used.contains(name)) << name;
        }
    }
}

TEST(ViewerScript, ComplainsOfWhatIsNotSo) {
    Session session = smallSession();
    const auto said = runScript(session, "step 2\nexpect frame = 3\nexpect bodies > 199\n");
    ASSERT_EQ(said.size(), 1U);
    EXPECT_EQ(said.front(), "frame 2: frame is 2, but was to be = 3");
    EXPECT_EQ(session.failureCount(), 1);
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
    session.setPlaying(false);
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

TEST(Commands, SayWhatIsWrongAndWhatWouldBeRight) {
    Session session = smallSession();
    EXPECT_EQ(faultOf(session, "pick 3"), "Y is missing. The command is: pick X Y");
    EXPECT_EQ(faultOf(session, "pick 3 x"),
              "Y is a number from -1000000 to 1000000, not 'x'. The command is: pick X Y");
    EXPECT_EQ(faultOf(session, "pick 3 nan"),
              "Y is a number from -1000000 to 1000000, not 'nan'. The command is: pick X Y");
    EXPECT_EQ(faultOf(session, "pick 3 4 5"), "'5' is one word too many. The command is: pick X Y");
    EXPECT_EQ(faultOf(session, "objects 0"),
              "N is a whole number from 1 to 1000000, not '0'. The command is: objects N");
    EXPECT_EQ(faultOf(session, "pause maybe"),
              "'maybe' is neither on nor off. The command is: pause [on|off]");
    EXPECT_EQ(faultOf(session, "camera follow"),
              "Nobody is picked to be followed: click on a body, or run \"pick X Y\".");
    EXPECT_EQ(faultOf(session, "effect rotation on"),
              "This scene cannot have rotation; it can have motion, terrain, pairs, response, "
              "sweep, sleeping, picking, boxSelection, culling, proximity, zones, radar.");
    EXPECT_EQ(faultOf(session, "expect missing = 0"),
              "Pairs are not verified: run \"check on\" and a step, with pairs and without sweep.");
    EXPECT_EQ(faultOf(session, "cell 1e31"),
              "SIZE is a number from 0 to 1e+30 [m], not '1e31'. The command is: cell SIZE");
    EXPECT_EQ(faultOf(session, "cell none"),
              "SIZE is a number from 0 to 1e+30 [m], not 'none'. The command is: cell SIZE");
    EXPECT_EQ(faultOf(session, "radius -1"),
              "R is a number, 0 or more, or 'none' [m], not '-1'. The command is: radius R");
    EXPECT_EQ(faultOf(session, "overlay stars").substr(0, 30), "There is no overlay 'stars'; t");
    EXPECT_EQ(faultOf(session, "overlay boxes perhaps"),
              "'perhaps' is neither on nor off. The command is: overlay "
              "bodies|grid|heat|boxes|pairs [on|off]");
    EXPECT_EQ(faultOf(session, "  # nothing"), "none");
    session.run("effect culling off");
    EXPECT_EQ(faultOf(session, "freeze on"),
              "Without culling there is no frustum to freeze: run \"effect culling on\".");
}

TEST(Commands, TakeNumbersHoweverTheyAreWritten) {
    Session session = smallSession();
    EXPECT_TRUE(runScript(session, "step 1e1\r\nexpect frame = 1e1\n").empty());
    EXPECT_TRUE(runScript(session, "step +5\nexpect frame = 15.0\n").empty());
    EXPECT_NE(faultOf(session, "step 0x10").find("N is a whole number from "), std::string::npos);
}

TEST(Commands, ChangeNothingWhereTheyFail) {
    Session session = smallSession();
    step(session, 3);
    const std::size_t logged = session.log().commands().size();
    EXPECT_NE(faultOf(session, "scene nowhere"), "none");
    EXPECT_NE(faultOf(session, "effect culling perhaps"), "none");
    EXPECT_EQ(session.frame(), 3U);
    EXPECT_TRUE(session.stage().effects().culling.has_value());
    EXPECT_EQ(session.log().commands().size(), logged);
}

TEST(Commands, DeclareWhatAnEffectNeedsAndTakeBackWhatNeedsIt) {
    Session session = smallSession();
    session.run("effect pairs off");
    EXPECT_FALSE(session.stage().effects().response);
    session.run("effect response on");
    EXPECT_TRUE(session.stage().effects().pairs.has_value());
}

TEST(Commands, KeepWhatIsDeclaredThroughARestart) {
    Session session = smallSession();
    session.run("effect culling off");
    session.run("broadphase dbvt");
    session.run("cell 7");
    step(session, 2);
    session.run("restart");
    EXPECT_EQ(session.frame(), 0U);
    EXPECT_FALSE(session.stage().effects().culling);
    EXPECT_EQ(session.stage().effects().grid.cellSize, 7);
    EXPECT_EQ(session.stage().broadphase().name, "dbvt");
}

TEST(Commands, GiveAnEffectBackWhatTheSceneDeclaresOfIt) {
    Session session = smallSession();
    const SceneEffects own = session.stage().effects();
    for (const char* effect : {"motion", "response", "proximity"}) {
        session.run(std::string("effect ") + effect + " off");
    }
    session.run("effect terrain on");
    session.run("effect response on");
    session.run("effect proximity on");
    const SceneEffects& effects = session.stage().effects();
    EXPECT_EQ(effects.response->restitution, own.response->restitution);
    EXPECT_NE(effects.response->restitution, ResponseEffect().restitution);
    EXPECT_EQ(effects.proximity->radius, own.proximity->radius);
    EXPECT_EQ(effects.proximity->turns, own.proximity->turns);
    EXPECT_EQ(effects.motion->bounds.max().x(), 399);
    session.run("effect radar on");  // which the scene does not declare
    EXPECT_EQ(effects.radar->columns, RadarEffect().columns);
}

TEST(Commands, TakeANumberSignWithinAWord) {
    Session session = smallSession();
    EXPECT_EQ(faultOf(session, "scene a#b # no scene").substr(0, 27),
              "There is no scene 'a#b'; th");
    EXPECT_EQ(faultOf(session, "step#2").substr(0, 28), "There is no command 'step#2'");
    EXPECT_EQ(faultOf(session, "size 500 400 #300"), "none");
    EXPECT_EQ(session.width(), 500);
}

TEST(Commands, CountMarkedBodiesThatAreStillThere) {
    Session session = smallSession();
    session.run("box 0 0 800 600");
    session.run("recolour");
    session.run("box 0 0 400 600");
    const std::size_t removed = session.selected().size();
    EXPECT_GT(removed, 0U);
    EXPECT_LT(removed, 200U);
    session.run("delete");
    EXPECT_EQ(session.reading("recoloured"), 200 - static_cast<double>(removed));
    EXPECT_EQ(session.reading("recoloured"), session.reading("bodies"));
}

// --- Broadphases ---------------------------------------------------------------------------------

TEST(Broadphases, AreTakenByTurnsButForThoseThatWouldTakeTooLong) {
    Session session({.name = "wander", .file = {}, .objects = 5001, .seed = 1}, 800, 600);
    std::string order;
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(session.takeMessages().empty());
        session.run("broadphase next");
        order += std::string(session.stage().broadphase().name) + ' ';
    }
    EXPECT_EQ(order, "dbvt dbvt-deferred hash ");
    EXPECT_EQ(session.takeMessages(),
              std::vector<std::string>{
                  "passed over axis-sweep (for up to 5,000) and simple (for up to 3,000), as there "
                  "are 5,001 bodies; \"broadphase NAME\" takes one all the same"});
    Session small = smallSession();
    for (const BroadphaseKind& kind : broadphaseKinds()) {
        EXPECT_EQ(small.stage().broadphase().name, kind.name);
        small.run("broadphase next");
    }
    EXPECT_EQ(small.stage().broadphase().name, "hash");
    EXPECT_TRUE(small.takeMessages().empty());
}

TEST(Broadphases, AreSwappedInWhereTheyAreNamedAndSayBeforehandThatTheyTakeLong) {
    Session session({.name = "wander", .file = {}, .objects = 3001, .seed = 1}, 800, 600);
    session.run("check on");
    session.run("broadphase simple");
    EXPECT_EQ(session.takeMessages(),
              std::vector<std::string>{"simple takes a time that grows with the square of the "
                                       "bodies: 3,001 are many, above 3,000 the scene may stand "
                                       "still for long."});
    for (const std::uint64_t frame : {0U, 0U, 1U, 2U}) {
        session.advance();
        EXPECT_EQ(session.frame(), frame);
    }
    EXPECT_EQ(session.stage().broadphase().name, "simple");
    EXPECT_GT(session.reading("exact"), 0);
    EXPECT_EQ(session.reading("missing"), 0);
}

// --- Standing still ------------------------------------------------------------------------------

TEST(Pause, DropsStepsThatAreWaitedFor) {
    for (const char* pause : {"pause", "pause on"}) {
        Session session = smallSession();
        session.run("step 50");
        session.advance();
        session.run(pause);
        EXPECT_FALSE(session.isWaiting()) << pause;
        EXPECT_FALSE(session.isPlaying()) << pause;
        session.advance();
        EXPECT_EQ(session.frame(), 1U) << pause;
        session.run("pause");
        EXPECT_TRUE(session.isPlaying()) << pause;
    }
}

// --- Loads ---------------------------------------------------------------------------------------

TEST(Loads, AreThoseOfTheLastFrameOrThereAreNone) {
    Session session = smallSession();
    const std::string fault =
        "Loads are not counted: run \"overlay heat on\" and a step, with an effect that asks the "
        "grid.";
    EXPECT_EQ(faultOf(session, "expect largestLoad = 0"), fault);
    session.run("overlay heat on");
    step(session, 1);
    EXPECT_GE(session.reading("largestLoad"), 1);
    for (const char* effect : {"pairs", "picking", "boxSelection", "culling", "proximity"}) {
        session.run(std::string("effect ") + effect + " off");
    }
    step(session, 1);
    ASSERT_EQ(session.stage().grid(), nullptr);
    EXPECT_EQ(faultOf(session, "expect largestLoad = 0"), fault);
    session.run("effect picking on");
    step(session, 1);
    EXPECT_GE(session.reading("columns"), 1);
    session.run("overlay heat off");
    step(session, 1);
    EXPECT_EQ(faultOf(session, "expect columns = 0"), fault);
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
            CellLoads loads;
            EXPECT_TRUE(loads.isEmpty());
            loads.count(grid, box);
            EXPECT_FALSE(loads.isEmpty());
            for (const std::uint32_t count : {loads.columns(), loads.rows()}) {
                EXPECT_GE(count, 1U) << place << ' ' << cellSize;
                EXPECT_LE(count, CellLoads::kMostColumns) << place << ' ' << cellSize;
            }
            EXPECT_EQ(loads.shades().size(), std::size_t{loads.columns()} * loads.rows());
        }
    }
}

// --- What there is -------------------------------------------------------------------------------

TEST(Commands, ForgetADraggedRectangleWhereTheSceneBeginsAgain) {
    Session session = smallSession();
    session.run("drag 10 10 90 90");
    EXPECT_TRUE(session.rectangle());
    session.run("restart");
    EXPECT_FALSE(session.rectangle());
}

TEST(Commands, AreBoundToKeysOnceEach) {
    std::set<std::string_view> keys;
    for (const KeyBinding& binding : keyBindings()) {
        EXPECT_TRUE(keys.insert(binding.key).second) << binding.key;
        EXPECT_NE(findCommand(binding.command), nullptr) << binding.command;
    }
}

// --- What is found -------------------------------------------------------------------------------

/// The body that is nearest to the camera under the pixel, asked one by one.
std::optional<std::uint32_t> bruteForcePick(Session& session, const Pixel& pixel) {
    const RayRegion<float> ray = session.view().rayThrough(pixel);
    std::optional<std::uint32_t> nearest;
    double best = 2;
    for (std::uint32_t index = 0; index < session.stage().grid()->indexLimit(); ++index) {
        const StageBody body = session.stage().body(index);
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
                ASSERT_TRUE(session.card()) << x << ' ' << y;
                EXPECT_EQ(session.card()->index, *expected) << x << ' ' << y;
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
    if (!session.card()) {
        session.run("pick 420 300");
    }
    ASSERT_TRUE(session.card());
    const InfoCard card = *session.card();
    std::uint64_t near = 0;
    std::uint64_t touching = 0;
    for (std::uint32_t index = 0; index < 30'000; ++index) {
        const StageBody body = session.stage().body(index);
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
