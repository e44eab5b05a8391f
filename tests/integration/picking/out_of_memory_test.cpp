// SPDX-License-Identifier: Zlib

// What is picked, and selected, is found when it is asked for again after memory ran out.

#include <integration/picking/drag_selection.hpp>
#include <integration/picking/pick.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/picking_oracle.hpp>

#include <gtest/gtest.h>

#include <optional>
#include <tuple>
#include <vector>

namespace hashphase::test {
namespace {

TEST(PickingOutOfMemory, IsTheSameWhenAskedAgain) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    struct Asked {
        Asked() {
            for (int i = 0; i < 200; ++i) {
                static_cast<void>(grid.add(boxAround<float>(random.pointIn(-9, 9), {2, 2, 2})));
            }
        }
        void ask() {
            const Camera<float> view(cameraMatrix<float>({}, {-40, 20, 0}, {0, 0, 0}),
                                     DepthRange::zeroToOne, kViewport);
            const Pixel middle = middleOf(kViewport);
            const RayRegion<float> ray = view.rayThrough(middle);
            nearest = pickNearest(grid, ray).id;
            pickAll(grid, ray, all);
            pickAll(grid, ray, tested, [](ProxyId, const RayRegion<float>&, float limit) {
                return std::optional<float>(limit);
            });
            select(grid, view, middle, middle + Pixel(90, 90), selected);
        }
        [[nodiscard]] auto answer() const {
            std::vector<ProxyId> picked;
            for (const Picked<float>& each : all) {
                picked.push_back(each.id);
            }
            return std::tuple(nearest, picked, tested.size(), selected);
        }
        Random random{1};
        Grid<float> grid;
        ProxyId nearest;
        std::vector<Picked<float>> all;
        std::vector<Picked<float>> tested;
        std::vector<ProxyId> selected;
    };
    EXPECT_GE(askOutOfMemory<Asked>(), 10U);
}

}  // namespace
}  // namespace hashphase::test
