// SPDX-License-Identifier: Zlib
//
// Pictures that were looked at and found right, in golden/.

#include <tests/viewer/draw/sample_pictures.hpp>
#include <tests/viewer/expect_golden.hpp>

#include <gtest/gtest.h>

namespace hashphase::demos {
namespace {

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
