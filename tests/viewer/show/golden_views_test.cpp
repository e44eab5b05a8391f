// SPDX-License-Identifier: Zlib
//
// What the viewer shows of its scenes, against pictures that were looked at; and the panel over it.

#include <demos/viewer/draw/headless_context.hpp>
#include <demos/viewer/draw/renderer.hpp>
#include <demos/viewer/session/session.hpp>
#include <demos/viewer/show/picture_maker.hpp>
#include <demos/viewer/show/viewer.hpp>
#include <tests/support/temporary_folder.hpp>
#include <tests/viewer/pictures.hpp>
#include <tests/viewer/show/play.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

constexpr int kWidth = 240;
constexpr int kHeight = 150;

Image seen(const Session& session) {
    const HeadlessContext context;
    Renderer renderer(session.width, session.height);
    PictureMaker maker;
    renderer.draw(maker.make(session));
    return renderer.read();
}

/// The picture after these commands, of which steps are simulated at once.
Image after(const SceneChoice& choice, const std::vector<const char*>& commands, int width = kWidth,
            int height = kHeight) {
    Session session(choice, width, height);
    play(session, commands);
    return seen(session);
}

const SceneChoice kWander{.name = "wander", .file = {}, .objects = 4000, .seed = 1};
const SceneChoice kPile{.name = "pile", .file = {}, .objects = 300, .seed = 1};
const SceneChoice kStorm{.name = "bullet-storm", .file = {}, .objects = 100, .seed = 1};

struct GoldenView {
    std::string name;
    SceneChoice scene;
    std::vector<const char*> commands;
};

class GoldenViews : public testing::TestWithParam<GoldenView> {};

TEST_P(GoldenViews, AreDrawnAsTheyWere) {
    expectGolden("show/golden/" + GetParam().name, after(GetParam().scene, GetParam().commands));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, GoldenViews,
    testing::Values(
        GoldenView{"camera_above", kWander, {"step 20", "camera top"}},
        GoldenView{"camera_free", kWander, {"step 20", "eye 200 30 400 10 -15"}},
        GoldenView{"camera_that_follows",
                   kWander,
                   {"pose top 200 7 200 40 0 0 0 0 0 0 0 0 0 20 0 -0.4", "pick 217 75",
                    "camera follow", "step 20"}},
        GoldenView{
            "frozen_frustum_from_outside",
            kWander,
            {"step 20", "eye 120 30 300 -40 -14", "freeze on", "eye 220 170 520 0 -32", "step 1"}},
        GoldenView{"picked_and_its_pairs",
                   kPile,
                   {"step 40", "camera free", "pick 120 90", "overlay boxes on"}},
        GoldenView{"selected_in_a_rectangle",
                   kWander,
                   {"camera top", "step 20", "box 45 40 150 110", "drag 45 40 150 110"}},
        GoldenView{"bucket_loads",
                   kWander,
                   {"cell 16", "step 20", "overlay bodies off", "overlay heat on",
                    "eye 200 150 510 0 -34"}},
        GoldenView{
            "zones_of_interest", kWander, {"effect zones on", "step 20", "eye 200 30 400 10 -15"}},
        GoldenView{
            "discrete_misses_in_the_dark", kStorm, {"theme dark", "camera free", "step 12"}}),
    [](const auto& view) { return view.param.name; });

TEST(Zones, AreNotDrawnAnyMoreWhenTheyAreTurnedOff) {
    const char* const eye = "eye 200 30 400 10 -15";
    const Image never = after(kWander, {"step 21", eye});
    EXPECT_FALSE(looksTheSame(after(kWander, {"effect zones on", "step 21", eye}), never));
    EXPECT_TRUE(looksTheSame(
        after(kWander, {"effect zones on", "step 20", "effect zones off", "step 1", eye}), never));
}

// --- What is laid over a scene -------------------------------------------------------------------

// A ring and the light one around it are the last lines. From far away and from nearby, in the middle of
// the screen and at its corner.
TEST(PictureMaker, RingsWhatIsPickedWhereItIsOnTheScreen) {
    for (const float away : {200.0F, 20.0F, 3.5F}) {
        for (const float aside : {0.0F, 0.5F}) {
            SCOPED_TRACE(testing::Message() << away << " m away, to the side by " << aside);
            Session session(kWander, kWidth, kHeight);
            session.isPlaying = false;
            session.advance();
            session.run("pose top 200 7 200 40 0 0 0 0 0 0 0 0 0 20 0 -0.4");
            for (int x = 10; x < kWidth && !session.card; x += 3) {
                session.pick({x, kHeight / 2});
            }
            ASSERT_TRUE(session.card);
            const StageBody body = session.card->body;
            session.camera.place(body.centre + Vector3<float>(aside * away, aside * away, away), 0,
                                 0);
            PictureMaker maker;
            const Picture& picture = maker.make(session);
            ASSERT_GT(picture.lines.size(), 64U);
            const CameraPose pose = session.pose();
            const Vector3<float> axis = (body.centre - pose.eye).normalized();
            const auto tangentOf =
                [&](const Vector3<float>& place) {  // from the middle of the body
                    const float ahead = axis.dot(place - pose.eye);
                    return (place - pose.eye - ahead * axis).norm() / ahead;
                };
            float reach = 0;
            const Aabb<float> box = boxAround(body);
            for (int i = 0; i < 8; ++i) {
                reach =
                    std::max(reach, tangentOf(box.corner(static_cast<Aabb<float>::CornerType>(i))));
            }
            for (const DrawnLine& line : picture.lines.last(64)) {
                EXPECT_GT(tangentOf(line.from), reach);
                EXPECT_LT(tangentOf(line.from), std::max(1.2F * reach, 0.016F) + 0.003F);
                const float depth = (cameraView(pose).viewProjection * line.from.homogeneous()).w();
                EXPECT_GT(depth, kNearPlane);
                EXPECT_LT(depth, 2);  // nothing hides it
            }
        }
    }
}

/// The share of pixels that are others than in a picture of the same size.
double shareOfOthers(const Image& one, const Image& other) {
    std::size_t count = 0;
    for (int y = 0; y < one.height; ++y) {
        for (int x = 0; x < one.width; ++x) {
            const bool isSame = std::equal(one.at(x, y), one.at(x, y) + 3, other.at(x, y));
            count += isSame ? 0 : 1;
        }
    }
    return static_cast<double>(count) / (static_cast<double>(one.width) * one.height);
}

TEST(PictureMaker, DrawsBodiesAsDotsOverTheMapOfLoads) {
    const SceneChoice crowd{.name = "wander", .file = {}, .objects = 30'000, .seed = 1};
    const auto picture = [&crowd](const char* bodies) {
        return after(crowd, {"camera top", "step 5", "overlay heat on", bodies}, 800, 800);
    };
    const Image dots = picture("overlay bodies on");
    const Image map = picture("overlay bodies off");
    EXPECT_GT(shareOfOthers(dots, map), 0.02);
    EXPECT_LT(shareOfOthers(dots, map), 0.3);
}

TEST(PictureMaker, DrawsEachShapeAsADotOnlyWhileTheMapOfLoadsIsShown) {
    Session session(kPile, kWidth, kHeight);
    PictureMaker maker;
    session.run("effect culling off");
    const auto picture = [&](const char* command) -> const Picture& {
        session.run(command);
        session.advance();
        return maker.make(session);
    };
    const Picture& dots = picture("overlay heat on");
    EXPECT_EQ(dots.spheres.size(), 300U);
    EXPECT_TRUE(dots.boxes.empty());
    EXPECT_TRUE(dots.capsules.empty());
    const Picture& bodies = picture("overlay heat off");
    EXPECT_EQ(bodies.spheres.size(), 100U);
    EXPECT_EQ(bodies.boxes.size(), 100U);
    EXPECT_EQ(bodies.capsules.size(), 100U);
}

// --- Pace ----------------------------------------------------------------------------------------

TEST(Viewer, LeavesOutContactShadeWhilePicturesTakeLong) {
    const HeadlessContext context;
    Viewer viewer(64, 48);
    const auto draw = [&](int pictures, double seconds) {
        for (int i = 0; i < pictures; ++i) {
            viewer.keepPace(seconds);
        }
        return viewer.contactFrom();
    };
    EXPECT_EQ(draw(100, 0.016), kContactFrom);
    EXPECT_GT(draw(100, 0.1), 5 * kContactFrom);
    const float most = viewer.contactFrom();
    EXPECT_EQ(draw(10, 0.1), most);
    EXPECT_EQ(draw(10, 0.033), most);
    EXPECT_LT(draw(10, 0.016), most);
    EXPECT_EQ(draw(100, 0.016), kContactFrom);
}

// --- Clicks --------------------------------------------------------------------------------------

TEST(Panel, RunsWhatIsClicked) {
    const HeadlessContext context;
    Viewer viewer(900, 700);
    Session session(kWander, 900, 700);
    const auto show = [&](bool isPressed) {
        viewer.show(session, {.x = 60, .y = 145, .left = isPressed}, 0.016);
    };
    show(false);
    show(false);
    EXPECT_TRUE(viewer.panel().hasPointer());
    ASSERT_TRUE(session.isPlaying);
    show(true);
    show(false);
    EXPECT_FALSE(session.isPlaying);
}

// --- The panel -----------------------------------------------------------------------------------

Image cut(int x, int y, int width, int height, const Image& image) {
    Image part{width, height, {}};
    for (int row = y; row < y + height; ++row) {
        const std::uint8_t* const begin = image.at(x, row);
        part.pixels.insert(part.pixels.end(), begin, begin + 4 * part.width);
    }
    return part;
}

/// The part of the picture right of x and below y.
Image from(int x, int y, const Image& image) {
    return cut(x, y, image.width - x, image.height - y, image);
}

/// The session with the panel over it, as a screenshot.
Image screenshotOf(Viewer& viewer, Session& session) {
    const TemporaryFolder folder;
    viewer.layOut(session);
    session.askForScreenshot(folder.file("picture.png"));
    viewer.show(session, {}, 0);
    return readPng(folder.file("picture.png"));
}

TEST(Panel, IsDrawnOverEachSceneInBothThemes) {
    const HeadlessContext context;
    Viewer viewer(900, 700);
    for (const char* scene : {"wander", "pile", "bullet-storm"}) {
        for (const char* theme : {"theme light", "theme dark"}) {
            Session session({.name = scene, .file = {}, .objects = 200, .seed = 1}, 900, 700);
            const auto picture = [&](std::initializer_list<const char*> commands) {
                for (const char* command : commands) {
                    session.run(command);
                    session.advance();
                }
                session.isPlaying = false;
                return screenshotOf(viewer, session);
            };
            const Image without = picture({"pause off", theme, "panel off"});
            const Image with = picture({"panel on"});
            const Image checked = picture({"check on", "step 1", "help on"});
            EXPECT_FALSE(looksTheSame(without, with));
            EXPECT_FALSE(looksTheSame(with, checked));
            // The panel is to the left, the scene to the right is as it was.
            EXPECT_TRUE(looksTheSame(from(360, 0, with), from(360, 0, without))) << scene << theme;
            // What colours tell is said in the lower right corner, where else there is the scene.
            const Image told = picture({"help off", "check off", "overlay heat on"});
            const Image untold = picture({"panel off"});
            EXPECT_FALSE(looksTheSame(from(700, 600, told), from(700, 600, untold)))
                << scene << theme;
        }
    }
}

TEST(Panel, ShowsABadgeWhileTheFrustumIsFrozenAndNoPanel) {
    const HeadlessContext context;
    Viewer viewer(900, 700);
    Session session(kWander, 900, 700);
    session.isPlaying = false;
    session.run("panel off");
    session.run("eye 200 60 390 0 -25");
    session.advance();
    const auto upperMiddle = [&](const char* command) {
        session.run(command);
        return cut(360, 4, 180, 34, screenshotOf(viewer, session));
    };
    const Image free = upperMiddle("freeze off");
    EXPECT_FALSE(looksTheSame(upperMiddle("freeze on"), free));
    EXPECT_TRUE(looksTheSame(upperMiddle("freeze off"), free));
}

TEST(Panel, ShowsTheRadarAsAMapSeenFromAbove) {
    const HeadlessContext context;
    Viewer viewer(900, 700);
    Session session(kWander, 900, 700);
    session.run("camera top");
    session.run("effect radar on");
    session.run("overlay bodies off");
    for (int frame = 0; frame < 30; ++frame) {
        session.advance();
    }
    const Image picture = screenshotOf(viewer, session);
    expectGolden("show/golden/radar", cut(660, 150, 240, 270, picture));
}

}  // namespace
}  // namespace hashphase::demos
