// SPDX-License-Identifier: Zlib
//
// Pictures that were looked at and found right, in golden/.

#include <tests/viewer/draw/sample_pictures.hpp>
#include <tests/viewer/expect_golden.hpp>

#include <gtest/gtest.h>

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
    expectGolden(GetParam().name, drawn(picture));
}

INSTANTIATE_TEST_SUITE_P(
    Changes, GoldenPicture,
    testing::Values(Golden{"spheres_on_hills", [](const SampleWorld&, Picture&) {}},
                    Golden{"from_above",
                           [](const SampleWorld&, Picture& picture) {
                               picture.camera = sampleCamera({0, 160, 0}, {0, 0, 0});
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

}  // namespace
}  // namespace hashphase::demos
