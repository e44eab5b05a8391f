// SPDX-License-Identifier: Zlib
//
// What can be said of a picture in numbers.

#include <demos/viewer/draw/headless_context.hpp>
#include <tests/support/temporary_folder.hpp>
#include <tests/viewer/draw/sample_pictures.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <thread>
#include <vector>

namespace hashphase::demos {
namespace {

constexpr Colour kRed{220, 20, 20};
constexpr Colour kGreen{20, 200, 20};

/// Looks along -z from the origin.
Picture pictureOf(std::span<const DrawnSphere> spheres) {
    Picture picture;
    picture.camera = sampleCamera({0, 0, 0}, {0, 0, -1});
    picture.spheres = spheres;
    return picture;
}

Image seen(const std::vector<DrawnSphere>& spheres, const std::vector<DrawnBox>& boxes = {},
           const std::vector<DrawnCapsule>& capsules = {},
           const std::vector<DrawnLine>& lines = {}) {
    Picture picture = pictureOf(spheres);
    picture.boxes = boxes;
    picture.capsules = capsules;
    picture.lines = lines;
    return drawn(picture);
}

bool isRed(const std::uint8_t* pixel) {
    return pixel[0] > 2 * pixel[1] && pixel[0] > 2 * pixel[2];
}

bool isGreen(const std::uint8_t* pixel) {
    return pixel[1] > 2 * pixel[0] && pixel[1] > 2 * pixel[2];
}

/// Where pixels are red.
struct RedArea {
    int count = 0;
    Eigen::Vector2f first = Eigen::Vector2f::Constant(1e9F);
    Eigen::Vector2f last = Eigen::Vector2f::Constant(-1e9F);
};

RedArea redArea(const Image& image) {
    RedArea area;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            if (isRed(image.at(x, y))) {
                const Eigen::Vector2f pixel(static_cast<float>(x), static_cast<float>(y));
                ++area.count;
                area.first = area.first.cwiseMin(pixel);
                area.last = area.last.cwiseMax(pixel + Eigen::Vector2f::Ones());
            }
        }
    }
    return area;
}

// The cone of directions that touch the sphere, cut by the screen. Large ones are drawn as quads, small ones as
// points, and towards the corners they are drawn out.
TEST(SpheresOnScreen, AreWherePerspectiveWantsThem) {
    std::vector<DrawnSphere> spheres;
    for (const float distance : {2.5F, 4.0F, 9.0F, 12.0F, 20.0F, 40.0F}) {
        spheres.push_back({{0, 0, -distance}, 1, kRed});
    }
    for (const float radius : {1.0F, 0.5F}) {
        spheres.push_back({{3.6F, 1.5F, -6}, radius, kRed});
    }
    for (const DrawnSphere& sphere : spheres) {
        const Image image = seen({sphere});
        const Vector3<float>& centre = sphere.centre;
        const float angle = std::asin(sphere.radius / centre.norm());
        const float focal = kSampleHeight / 2.0F / std::tan(0.5F);
        int wrong = 0, inside = 0;
        for (int y = 0; y < kSampleHeight; ++y) {
            for (int x = 0; x < kSampleWidth; ++x) {
                const Vector3<float> ray(static_cast<float>(x) + 0.5F - kSampleWidth / 2.0F,
                                         kSampleHeight / 2.0F - static_cast<float>(y) - 0.5F,
                                         -focal);
                const float off = std::acos(ray.normalized().dot(centre.normalized())) - angle;
                inside += off < 0 ? 1 : 0;
                const bool isEdge = std::abs(off) < 1 / focal;
                wrong += !isEdge && isRed(image.at(x, y)) != (off < 0) ? 1 : 0;
            }
        }
        EXPECT_GT(inside, 40);
        EXPECT_EQ(wrong, 0) << centre.transpose();
        if (centre.x() == 0) {  // else its long edge is soft
            const auto red = static_cast<float>(redArea(image).count);
            EXPECT_NEAR(std::sqrt(red / 3.1416F), radiusOnScreen(1, centre.norm()), 0.5F);
        }
    }
}

TEST(SpheresOnScreen, AreLitFromAboveBothLargeAndSmall) {
    for (const float distance : {4.0F, 20.0F}) {
        const Image image = seen({{{0, 0, -distance}, 1, kRed}});
        const int reach = static_cast<int>(0.7F * radiusOnScreen(1, distance));
        const int middle = kSampleHeight / 2;
        EXPECT_GT(image.at(kSampleWidth / 2, middle - reach)[0],
                  image.at(kSampleWidth / 2, middle + reach)[0] + 20)
            << "at " << distance << " m";
    }
}

// Those of 3.5 pixels and less are drawn in another way, which nobody should see.
TEST(SpheresOnScreen, AreTheSameWhereTheyAreTiny) {
    for (const Vector3<float>& eye :
         {Vector3<float>(0, 0, 1), Vector3<float>(0, 1, 0), Vector3<float>(-1, 0.3F, -1)}) {
        const auto ofRadius = [&](float pixels) {
            const float distance = 0.5F * kSampleHeight / std::tan(0.5F) / pixels;
            const DrawnSphere sphere{{0, 0, 0}, 1, kRed};
            Picture picture;
            picture.camera = sampleCamera(distance * eye.normalized(), {0, 0, 0});
            picture.spheres = {&sphere, 1};
            return drawn(picture);
        };
        const Image larger = ofRadius(3.51F);
        const Image tiny = ofRadius(3.49F);
        int most = 0;
        for (std::size_t i = 0; i < larger.pixels.size(); ++i) {
            most = std::max(most, std::abs(int{larger.pixels[i]} - int{tiny.pixels[i]}));
        }
        EXPECT_LE(most, 16);
        EXPECT_NE(tiny, ofRadius(3.3F));
    }
}

TEST(SpheresOnScreen, InterpenetrateWhereTheirSurfacesMeet) {
    // Of equal size and height, one to the right and a little behind: the boundary is not the
    // nearer one's outline.
    const Image image = seen({{{-0.5F, 0, -6}, 1, kRed}, {{0.5F, 0, -6}, 1, kGreen}});
    const int middle = kSampleWidth / 2;
    EXPECT_TRUE(isRed(image.at(middle - 3, kSampleHeight / 2)));
    EXPECT_TRUE(isGreen(image.at(middle + 3, kSampleHeight / 2)));
}

TEST(SpheresOnScreen, SinkIntoTheGroundByHalf) {
    const std::vector<Vector3<float>> ground{{-50, -3, 0},   {50, -3, 0}, {-50, -3, -90},
                                             {-50, -3, -90}, {50, -3, 0}, {50, -3, -90}};
    for (const float depth : {10.0F, 40.0F}) {
        const DrawnSphere sphere{{0, -3, -depth}, 1, kRed};
        Picture picture = pictureOf({&sphere, 1});
        picture.ground = {ground, 1};
        picture.contactFrom = std::numeric_limits<float>::infinity();
        const Image image = drawn(picture);
        // It is seen down to where its nearest point meets the ground, and no further.
        const float lowest = onScreen(picture.camera, {0, -3, -depth + 1}).y();
        const RedArea area = redArea(image);
        EXPECT_NEAR(area.last.y(), lowest, 1) << "at " << depth << " m";
        picture.ground = {};
        EXPECT_GT(redArea(drawn(picture)).count, area.count * 4 / 3);
    }
}

TEST(SpheresOnScreen, NeverBecomeSmallerThanTheLeastRadius) {
    const DrawnSphere sphere{{0, 0, -60}, 0.05F, kRed};
    Picture picture = pictureOf({&sphere, 1});
    for (const float leastRadius : {2.0F, 5.0F}) {
        picture.leastRadius = leastRadius;
        const auto count = static_cast<float>(redArea(drawn(picture)).count);
        EXPECT_NEAR(std::sqrt(count / 3.1416F), leastRadius, 0.5F);
    }
    picture.leastRadius = 0;
    EXPECT_EQ(redArea(drawn(picture)).count, 0);
}

TEST(SpheresOnScreen, AreNotSeenFromInsideOrBehind) {
    EXPECT_EQ(
        redArea(seen({{{0, 0, 0.2F}, 1, kRed}, {{0, 0, -0.2F}, 1, kRed}, {{0, 0, 9}, 1, kRed}}))
            .count,
        0);
}

// Edges are soft: what is behind must be there already, or the sky shows through. Of two that are drawn in the
// same way: quads, points, dots.
TEST(SpheresOnScreen, HideEachOtherWithoutAFringeOfTheSky) {
    struct Case {
        float away;
        float radiusBehind;
    };
    for (const auto& [away, radiusBehind] : {Case{1, 4}, Case{8, 4}, Case{25, 2.9F}}) {
        SCOPED_TRACE(away);
        const DrawnSphere front{{0, 0, -5 * away}, 1, kRed};
        const DrawnSphere back{{0, 0, -6 * away - 3}, radiusBehind, kGreen};
        const float inside = radiusOnScreen(back.radius, 6 * away + 3) - 1;
        const float outline = radiusOnScreen(front.radius, 5 * away);
        for (const Image& image : {seen({front, back}), seen({back, front})}) {
            EXPECT_TRUE(isRed(image.at(kSampleWidth / 2, kSampleHeight / 2)));
            int soft = 0;
            for (int y = 0; y < image.height; ++y) {
                for (int x = 0; x < image.width; ++x) {
                    const float fromMiddle =
                        std::hypot(static_cast<float>(x) + 0.5F - kSampleWidth / 2.0F,
                                   static_cast<float>(y) + 0.5F - kSampleHeight / 2.0F);
                    if (fromMiddle < inside) {
                        ASSERT_LT(image.at(x, y)[2], 110) << x << ", " << y;
                        soft += std::abs(fromMiddle - outline) < 0.4F ? 1 : 0;
                    }
                }
            }
            EXPECT_GT(soft, 0);
        }
    }
}

TEST(CapsulesOnScreen, AreSpheresWhenTheirEndsAreOne) {
    const Vector3<float> end(1, 0.5F, -6);
    const RedArea area = redArea(seen({}, {}, {{end, end, 1, kRed}}));
    const RedArea expected = redArea(seen({{end, 1, kRed}}));
    EXPECT_LT((area.first - expected.first).norm(), 1.5F);
    EXPECT_LT((area.last - expected.last).norm(), 1.5F);
}

TEST(BoxesOnScreen, CoverWhatTheirCornersSpan) {
    const RedArea area = redArea(seen({}, {{{0, 0, -10}, {3, 2, 1}, {0, 0, 0, 1}, kRed}}));
    const DrawnCamera camera = pictureOf({}).camera;
    const Eigen::Vector2f upperLeft = onScreen(camera, {-3, 2, -9});
    const Eigen::Vector2f lowerRight = onScreen(camera, {3, -2, -9});
    EXPECT_LT((area.first - upperLeft).cwiseAbs().maxCoeff(), 1);
    EXPECT_LT((area.last - lowerRight).cwiseAbs().maxCoeff(), 1);
}

TEST(BoxesOnScreen, HideEachOtherWhicheverIsNamedFirst) {
    const DrawnBox near{{0, 0, -10}, {1, 1, 1}, {0, 0, 0, 1}, kRed};
    const DrawnBox far{{0, 0, -20}, {1, 1, 1}, {0, 0, 0, 1}, {20, 40, 220}};
    const Image alone = seen({}, {near});
    EXPECT_NE(alone, seen({}));
    EXPECT_EQ(seen({}, {near, far}), alone);
    EXPECT_EQ(seen({}, {far, near}), alone);
}

TEST(BoxesOnScreen, ShowNothingFromInside) {
    const Eigen::Quaternionf turned(
        Eigen::AngleAxisf(0.7F, Vector3<float>(0.3F, 1, 0.2F).normalized()));
    EXPECT_EQ(seen({}, {{{0, 0, 0}, {3, 2, 4}, turned.coeffs(), kRed}}), seen({}));
}

TEST(LinesOnScreen, AreHiddenUnlessTheyAreOnTop) {
    const DrawnBox box{{0, 0, -10}, {3, 3, 1}, {0, 0, 0, 1}, {250, 250, 250}};
    const auto greenOf = [&](bool isOnTop) {
        const Image image = seen({}, {box}, {}, {{{-1, 0, -20}, {1, 0, -20}, kRed, isOnTop}});
        return image.at(kSampleWidth / 2, kSampleHeight / 2)[1];
    };
    EXPECT_LT(greenOf(true), greenOf(false) - 20);
}

TEST(LinesOnScreen, PassTheEye) {
    const RedArea area = redArea(seen({}, {}, {}, {{{0, -1, 10}, {0, -1, -100}, kRed, false}}));
    EXPECT_NEAR((area.first.x() + area.last.x()) / 2, kSampleWidth / 2.0, 1);
    EXPECT_NEAR(area.last.y(), kSampleHeight, 1);
    EXPECT_GT(area.first.y(), kSampleHeight / 2.0F);
    // Two pixels wide all the way.
    EXPECT_EQ(area.count, 2 * static_cast<int>(area.last.y() - area.first.y()));
}

TEST(Renderer, DrawsTheSamePictureTwiceToTheByte) {
    const SampleWorld world;
    Picture picture = world.picture();
    picture.boxes = world.boxes;
    picture.capsules = world.capsules;
    picture.lines = world.lines;
    const Image first = drawn(picture);
    static_cast<void>(seen({}));
    EXPECT_EQ(drawn(picture), first);
}

TEST(Renderer, TakesOverAnotherGroundByItsVersion) {
    const SampleWorld world;
    Picture picture = world.picture();
    picture.spheres = {};
    const Image before = drawn(picture);
    std::vector<Vector3<float>> lowered = world.corners;
    for (Vector3<float>& corner : lowered) {
        corner.y() -= 10;
    }
    picture.ground = {lowered, 2};
    EXPECT_NE(drawn(picture), before);
    picture.ground = {world.corners, 3};
    EXPECT_EQ(drawn(picture), before);
}

TEST(Renderer, DrawsContactShadeOnlyBelowWhatIsNearTheGround) {
    const SampleWorld world;
    DrawnSphere sphere{{0, SampleWorld::height(0, 0) + 2, 0}, 2, kRed};
    Picture picture = world.picture();
    picture.spheres = {&sphere, 1};
    const auto differs = [&] {
        picture.contactFrom = kContactFrom;
        const Image with = drawn(picture);
        picture.contactFrom = std::numeric_limits<float>::infinity();
        return drawn(picture) != with;
    };
    EXPECT_TRUE(differs());
    sphere.centre.y() += 8;
    EXPECT_FALSE(differs());
}

TEST(Renderer, RefusesAHeatMapThatLacksCells) {
    const SampleWorld world;
    Picture picture = world.picture();
    picture.heatMap = world.heatMap();
    picture.heatMap->loads = picture.heatMap->loads.first(7);
    EXPECT_THROW((void)drawn(picture), DrawError);
}

TEST(Renderer, ChangesItsSize) {
    static_cast<void>(sampleRenderer());
    Renderer renderer(10, 20);
    renderer.resize(31, 17);
    renderer.draw(pictureOf({}));
    const Image image = renderer.read();
    EXPECT_EQ(image.width, 31);
    EXPECT_EQ(image.height, 17);
    EXPECT_EQ(image.pixels.size(), 4U * 31 * 17);
    EXPECT_EQ(image.at(30, 16)[3], 255);
}

TEST(Renderer, RefusesASizeThatIsNone) {
    static_cast<void>(sampleRenderer());
    for (const int width : {0, -5, 1 << 30}) {
        const std::string fault = messageOf<DrawError>([&] { const Renderer none(width, 100); });
        const std::string begin = "A picture of " + std::to_string(width) + " x 100 pixels cannot";
        EXPECT_TRUE(fault.starts_with(begin)) << fault;
    }
}

// --- Without a window ----------------------------------------------------------------------------

/// Ends the process with 0 when a context was refused, after saying why.
[[noreturn]] void openWithoutDrivers() {
    setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null", 1);
    try {
        const HeadlessContext context;
    } catch (const DrawError& error) {
        std::cerr << error.what();
        std::exit(0);
    }
    std::exit(1);
}

TEST(HeadlessContextDeathTest, SaysWhatToInstallWhereNoDriverIs) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(openWithoutDrivers(), testing::ExitedWithCode(0),
                "No picture can be drawn without a window.*"
                "apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri");
}

TEST(HeadlessContext, OutlivesAnotherOne) {
    Image image;
    std::thread([&image] {  // other tests' context stays current in this one
        auto first = std::make_unique<HeadlessContext>();
        const HeadlessContext second;
        first.reset();
        Renderer renderer(16, 16);
        renderer.draw({});
        image = renderer.read();
    })
        .join();
    ASSERT_EQ(image.pixels.size(), 4U * 16 * 16);
    EXPECT_GT(image.pixels[0], 100) << "of the sky";
    EXPECT_EQ(image.pixels[3], 255);
}

}  // namespace
}  // namespace hashphase::demos
