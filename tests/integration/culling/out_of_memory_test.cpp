// SPDX-License-Identifier: Zlib

// What is visible is not culled, though memory ran out when it was looked for.

#include <integration/culling/culler.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <memory>

namespace hashphase::test {
namespace {

TEST(CullerOutOfMemory, KeepsNoSetThatWasNotFoundToItsEnd) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    struct Scene {
        Scene() {
            for (int i = 0; i < 2000; ++i) {
                static_cast<void>(grid.add(boxAround<float>(random.pointIn(-9, 9), {1, 1, 1})));
            }
            grid.update();
        }
        Random random{1};
        Grid<float> grid;
        Culler<float> culler{1};
        ConvexRegion<float> everything{{}};
    };
    const std::size_t failures =
        runOutOfMemory([] { return std::make_unique<Scene>(); },
                       [](Scene& scene) { scene.culler.look(scene.grid, scene.everything); },
                       [](Scene& scene, std::size_t) {
                           scene.culler.look(scene.grid, scene.everything, 0);
                           EXPECT_EQ(scene.culler.count(), 2000U);
                       });
    EXPECT_GE(failures, 2U);
}

}  // namespace
}  // namespace hashphase::test
