// SPDX-License-Identifier: Zlib
//
// Pictures that were looked at and found right, in golden/; and the eye that compares them.

#include <tests/support/temporary_folder.hpp>
#include <tests/viewer/draw/sample_pictures.hpp>
#include <tests/viewer/pictures.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

namespace hashphase::demos {
namespace {

/// Spheres on hills, after a change.
struct Golden {
    std::string name;
    void (*change)(const SampleWorld& world, Picture& picture);
};

class GoldenPicture : public testing::TestWithParam<Golden> {};

TEST_P(GoldenPicture, IsDrawnAsItWas) {
    const SampleWorld world;
    Picture picture = world.picture();
    GetParam().change(world, picture);
    expectGolden("draw/golden/" + GetParam().name, drawn(picture));
}

INSTANTIATE_TEST_SUITE_P(
    Changes, GoldenPicture,
    testing::Values(Golden{"spheres_on_hills", [](const SampleWorld&, Picture&) {}},
                    Golden{"from_above",
                           [](const SampleWorld&, Picture& picture) {
                               picture.camera = sampleCamera({0, 160, 0}, {0, 0, 0});
                               picture.camera.viewProjection.topRows<2>() *= -1;  // north is up
                           }},
                    Golden{"heat_map_and_grid_lines",
                           [](const SampleWorld& world, Picture& picture) {
                               picture.spheres = {};
                               picture.gridLines = world.cells();
                               picture.heatMap = world.heatMap();
                           }},
                    Golden{"boxes_capsules_and_lines",
                           [](const SampleWorld& world, Picture& picture) {
                               picture.spheres = {};
                               picture.boxes = world.boxes;
                               picture.capsules = world.capsules;
                               picture.lines = world.lines;
                               picture.camera = sampleCamera({4, 12, 26}, {0, 0, 0});
                           }},
                    Golden{"dragged_rectangle",
                           [](const SampleWorld&, Picture& picture) {
                               picture.rectangle = DrawnRectangle{{200, 55}, {80, 135}};
                           }},
                    Golden{"dark_theme",
                           [](const SampleWorld& world, Picture& picture) {
                               picture.theme = Theme::dark;
                               picture.gridLines = world.cells();
                           }}),
    [](const auto& golden) { return golden.param.name; });

Image sphereAt(float x) {
    const DrawnSphere sphere{{x, 0, -10}, 1, {230, 159, 0}};
    Picture picture;
    picture.camera = sampleCamera({0, 0, 0}, {0, 0, -10});
    picture.spheres = {&sphere, 1};
    return drawn(picture);
}

/// The picture, with something added to each channel.
template <class Off>
Image changed(Image image, const Off& off) {
    for (std::uint8_t& channel : image.pixels) {
        channel = static_cast<std::uint8_t>(std::clamp(channel + off(), 0, 255));
    }
    return image;
}

TEST(ImageDifference, IsWhatAnEyeSees) {
    const Image image = sphereAt(0);
    std::mt19937 random(5);
    EXPECT_TRUE(looksTheSame(image, changed(image, [&] { return int(random() % 5) - 2; })));
    EXPECT_FALSE(looksTheSame(image, changed(image, [] { return -3; }))) << "it is darker";
    EXPECT_FALSE(looksTheSame(image, sphereAt(0.2F))) << "it has moved by a few pixels";
    EXPECT_GT(ImageDifference(image, sphereAt(0.2F)).shareOff, 0.001);
    EXPECT_FALSE(looksTheSame(image, Image{17, 9, std::vector<std::uint8_t>(17 * 9 * 4)}));
}

TEST(Png, IsReadAsItWasWritten) {
    const TemporaryFolder folder;
    const Image image = sphereAt(0);
    savePng(folder.file("a.png"), image);
    EXPECT_EQ(readPng(folder.file("a.png")), image);
}

}  // namespace
}  // namespace hashphase::demos
