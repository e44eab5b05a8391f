// SPDX-License-Identifier: Zlib
//
// What can be said of a picture in numbers.

#include <demos/viewer/draw/image.hpp>
#include <tests/viewer/draw/sample_pictures.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>

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

bool isRed(const std::uint8_t* pixel) {
    return pixel[0] > 2 * pixel[1] && pixel[0] > 2 * pixel[2];
}

bool isGreen(const std::uint8_t* pixel) {
    return pixel[1] > 2 * pixel[0] && pixel[1] > 2 * pixel[2];
}

/// Where pixels are red.
struct RedArea {
    int count = 0;
    Eigen::Vector2f middle = Eigen::Vector2f::Zero();
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
                area.middle += pixel + Eigen::Vector2f::Constant(0.5F);
                area.first = area.first.cwiseMin(pixel);
                area.last = area.last.cwiseMax(pixel + Eigen::Vector2f::Ones());
            }
        }
    }
    area.middle /= static_cast<float>(std::max(area.count, 1));
    return area;
}

class SphereOnScreen : public testing::TestWithParam<float> {};

TEST_P(SphereOnScreen, IsWhereTheProjectionSays) {
    const float distance = GetParam();
    const DrawnSphere sphere{{0, 0, -distance}, 1, kRed};
    const RedArea area = redArea(drawn(pictureOf({&sphere, 1})));
    const float radius = radiusOnScreen(1, distance);
    EXPECT_NEAR(area.middle.x(), kSampleWidth / 2.0, 0.5);
    EXPECT_NEAR(area.middle.y(), kSampleHeight / 2.0, 0.5);
    const Eigen::Vector2f extent = area.last - area.first;
    EXPECT_NEAR(extent.x() / 2, radius, 1);
    EXPECT_NEAR(extent.y() / 2, radius, 1);
    EXPECT_NEAR(std::sqrt(static_cast<float>(area.count) / 3.1416F), radius, 0.5F);
}

// Large ones are drawn as quads, small ones as points.
INSTANTIATE_TEST_SUITE_P(Distances, SphereOnScreen,
                         testing::Values(2.5F, 4.0F, 9.0F, 12.0F, 20.0F, 40.0F));

TEST(SpheresOnScreen, AreDrawnOutTowardsTheCornersAsPerspectiveWantsIt) {
    for (const float scale : {1.0F, 0.5F}) {
        // The cone of directions that touch the sphere, cut by the screen.
        const Vector3<float> centre(3.6F, 1.5F, -6);
        const DrawnSphere sphere{centre, scale, kRed};
        const Image image = drawn(pictureOf({&sphere, 1}));
        const float cosine = std::sqrt(1 - scale * scale / centre.squaredNorm());
        const float focal = kSampleHeight / 2.0F / std::tan(0.5F);
        int wrong = 0, inside = 0;
        for (int y = 0; y < kSampleHeight; ++y) {
            for (int x = 0; x < kSampleWidth; ++x) {
                const Vector3<float> ray(static_cast<float>(x) + 0.5F - kSampleWidth / 2.0F,
                                         kSampleHeight / 2.0F - static_cast<float>(y) - 0.5F,
                                         -focal);
                const float off =
                    std::acos(ray.normalized().dot(centre.normalized())) - std::acos(cosine);
                const bool isEdge = std::abs(off) < 1 / focal;
                inside += off < 0 ? 1 : 0;
                wrong += !isEdge && isRed(image.at(x, y)) != (off < 0) ? 1 : 0;
            }
        }
        EXPECT_GT(inside, 50);
        EXPECT_EQ(wrong, 0) << "radius " << scale;
    }
}

TEST(SpheresOnScreen, AreLitFromAboveBothLargeAndSmall) {
    for (const float distance : {4.0F, 20.0F}) {
        const DrawnSphere sphere{{0, 0, -distance}, 1, kRed};
        const Image image = drawn(pictureOf({&sphere, 1}));
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

TEST(SpheresOnScreen, NearOnesHideFarOnesInAnyOrder) {
    const DrawnSphere front{{0, 0, -5}, 1, kRed}, back{{0, 0, -9}, 1.5F, kGreen};
    for (const auto& spheres : {std::array{front, back}, std::array{back, front}}) {
        const Image image = drawn(pictureOf(spheres));
        EXPECT_TRUE(isRed(image.at(kSampleWidth / 2, kSampleHeight / 2)));
    }
}

TEST(SpheresOnScreen, InterpenetrateWhereTheirSurfacesMeet) {
    // Of equal size and height, one to the right and a little behind: the boundary is not the
    // nearer one's outline.
    const DrawnSphere left{{-0.5F, 0, -6}, 1, kRed}, right{{0.5F, 0, -6}, 1, kGreen};
    const Image image = drawn(pictureOf(std::array{left, right}));
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
    const std::array spheres{DrawnSphere{{0, 0, 0.2F}, 1, kRed},
                             DrawnSphere{{0, 0, -0.2F}, 1, kRed}, DrawnSphere{{0, 0, 9}, 1, kRed}};
    EXPECT_EQ(redArea(drawn(pictureOf(spheres))).count, 0);
}

// Edges are soft: what is behind must be there already, or the sky shows through. Of two that are drawn in the
// same way: quads, points, dots.
TEST(SpheresOnScreen, HaveNoFringeOfTheSkyBeforeEachOther) {
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
        for (const auto& spheres : {std::array{front, back}, std::array{back, front}}) {
            const Image image = drawn(pictureOf(spheres));
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
    const DrawnCapsule capsule{{1, 0.5F, -6}, {1, 0.5F, -6}, 1, kRed};
    const DrawnSphere sphere{{1, 0.5F, -6}, 1, kRed};
    Picture picture = pictureOf({});
    picture.capsules = {&capsule, 1};
    const RedArea area = redArea(drawn(picture));
    const RedArea expected = redArea(drawn(pictureOf({&sphere, 1})));
    EXPECT_LT((area.first - expected.first).norm(), 1.5F);
    EXPECT_LT((area.last - expected.last).norm(), 1.5F);
}

TEST(BoxesOnScreen, CoverWhatTheirCornersSpan) {
    const DrawnBox box{{0, 0, -10}, {3, 2, 1}, {0, 0, 0, 1}, kRed};
    Picture picture = pictureOf({});
    picture.boxes = {&box, 1};
    const RedArea area = redArea(drawn(picture));
    const Eigen::Vector2f upperLeft = onScreen(picture.camera, {-3, 2, -9});
    const Eigen::Vector2f lowerRight = onScreen(picture.camera, {3, -2, -9});
    EXPECT_LT((area.first - upperLeft).cwiseAbs().maxCoeff(), 1);
    EXPECT_LT((area.last - lowerRight).cwiseAbs().maxCoeff(), 1);
}

TEST(BoxesOnScreen, HideEachOtherWhicheverIsNamedFirst) {
    const DrawnBox near{{0, 0, -10}, {1, 1, 1}, {0, 0, 0, 1}, kRed};
    const DrawnBox far{{0, 0, -20}, {1, 1, 1}, {0, 0, 0, 1}, {20, 40, 220}};
    const auto seen = [](std::initializer_list<DrawnBox> boxes) {
        Picture picture = pictureOf({});
        picture.boxes = boxes;
        return drawn(picture);
    };
    const Image alone = seen({near});
    EXPECT_NE(alone, seen({}));
    EXPECT_EQ(seen({near, far}), alone);
    EXPECT_EQ(seen({far, near}), alone);
}

TEST(BoxesOnScreen, ShowNothingFromInside) {
    const Eigen::Quaternionf turned(
        Eigen::AngleAxisf(0.7F, Vector3<float>(0.3F, 1, 0.2F).normalized()));
    const DrawnBox box{{0, 0, 0}, {3, 2, 4}, turned.coeffs(), kRed};
    Picture picture = pictureOf({});
    const Image without = drawn(picture);
    picture.boxes = {&box, 1};
    EXPECT_EQ(drawn(picture), without);
}

TEST(LinesOnScreen, AreHiddenUnlessTheyAreOnTop) {
    const DrawnBox box{{0, 0, -10}, {3, 3, 1}, {0, 0, 0, 1}, {250, 250, 250}};
    DrawnLine line{{-1, 0, -20}, {1, 0, -20}, kRed, false};
    Picture picture = pictureOf({});
    picture.boxes = {&box, 1};
    picture.lines = {&line, 1};
    const Image hidden = drawn(picture);
    line.isOnTop = true;
    const Image onTop = drawn(picture);
    const auto greenIn = [](const Image& image) {
        return image.at(kSampleWidth / 2, kSampleHeight / 2)[1];
    };
    EXPECT_LT(greenIn(onTop), greenIn(hidden) - 20);
}

TEST(LinesOnScreen, PassTheEye) {
    const DrawnLine line{{0, -1, 10}, {0, -1, -100}, kRed, false};
    Picture picture = pictureOf({});
    picture.lines = {&line, 1};
    const RedArea area = redArea(drawn(picture));
    EXPECT_NEAR(area.middle.x(), kSampleWidth / 2.0, 1);
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
    (void)drawn(pictureOf({}));
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
        try {
            const Renderer renderer(width, 100);
            ADD_FAILURE() << width;
        } catch (const DrawError& error) {
            const std::string fault = error.what();
            EXPECT_NE(fault.find("A picture of " + std::to_string(width) + " x 100 pixels cannot"),
                      std::string::npos)
                << fault;
        }
    }
}

}  // namespace
}  // namespace hashphase::demos
