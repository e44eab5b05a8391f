// SPDX-License-Identifier: Zlib
//
// Pictures that were looked at and found right, in golden/.

#include <demos/viewer/draw/image_difference.hpp>
#include <demos/viewer/draw/png.hpp>
#include <tests/viewer/sample_pictures.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace hashphase::demos {
namespace {

constexpr const char* kRewrite = "HASHPHASE_REWRITE_GOLDEN_PICTURES";

/// Compares with the picture of that name; or replaces it where the variable kRewrite is set.
void expectGolden(const std::string& name, const Image& actual) {
    const std::filesystem::path golden =
        std::filesystem::path(HASHPHASE_GOLDEN_PICTURES) / (name + ".png");
    if (std::getenv(kRewrite) != nullptr) {
        writePng(golden, actual);
        return;
    }
    const ImageDifference difference = imageDifference(readPng(golden), actual);
    if (looksTheSame(difference)) {
        return;
    }
    const std::filesystem::path folder = HASHPHASE_WRONG_PICTURES;
    const std::filesystem::path wrong = folder / (name + "-actual.png");
    const std::filesystem::path map = folder / (name + "-difference.png");
    writePng(wrong, actual);
    if (difference.isComparable) {
        writePng(map, difference.map);
    }
    ADD_FAILURE() << "The picture is another one than " << golden << ": "
                  << 100 * difference.shareOff << " % of its pixels are off, by " << difference.mean
                  << " of 255 on average.\nDrawn: " << wrong << "\nDifference: " << map
                  << "\nIf it is right as drawn, run this test with " << kRewrite
                  << "=1 in the environment, look at the new picture, and commit it.";
}

TEST(GoldenPictures, SpheresOnHills) {
    const SampleWorld world;
    expectGolden("spheres_on_hills", drawn(world.picture()));
}

TEST(GoldenPictures, FromAbove) {
    const SampleWorld world;
    Picture picture = world.picture();
    picture.camera = sampleCamera({0, 160, 0}, {0, 0, 0});
    expectGolden("from_above", drawn(picture));
}

TEST(GoldenPictures, HeatMapAndGridLines) {
    const SampleWorld world;
    Picture picture = world.picture();
    picture.spheres = {};
    picture.gridLines = world.cells();
    picture.heatMap = world.heatMap();
    expectGolden("heat_map_and_grid_lines", drawn(picture));
}

TEST(GoldenPictures, BoxesCapsulesAndLines) {
    const SampleWorld world;
    Picture picture = world.picture();
    picture.spheres = {};
    picture.boxes = world.boxes;
    picture.capsules = world.capsules;
    picture.lines = world.lines;
    picture.camera = sampleCamera({4, 12, 26}, {0, 0, 0});
    expectGolden("boxes_capsules_and_lines", drawn(picture));
}

TEST(GoldenPictures, DraggedRectangle) {
    const SampleWorld world;
    Picture picture = world.picture();
    picture.rectangle = DrawnRectangle{{200, 55}, {80, 135}};
    expectGolden("dragged_rectangle", drawn(picture));
}

TEST(GoldenPictures, DarkTheme) {
    const SampleWorld world;
    Picture picture = world.picture();
    picture.theme = Theme::dark;
    picture.gridLines = world.cells();
    expectGolden("dark_theme", drawn(picture));
}

}  // namespace
}  // namespace hashphase::demos
