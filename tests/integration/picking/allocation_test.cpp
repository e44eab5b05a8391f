// SPDX-License-Identifier: Zlib
//
// A frame like the last one takes no memory.

#include <integration/picking/drag_selection.hpp>
#include <integration/picking/ground.hpp>
#include <integration/picking/pick.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/count_allocations.hpp>

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace hashphase::test {
namespace {

/// Bodies that jump about between two sets of places, and a camera that asks everything.
class PickingFrame {
public:
    PickingFrame() {
        Random random(0x5eed0751);
        for (int i = 0; i < 4000; ++i) {
            const auto box = boxAround<float>(random.pointIn(-30, 30), random.pointIn(0.2, 1));
            boxes_.push_back(box);
            ids_.push_back(grid_.add(box));
        }
    }

    /// Returns how many it found.
    std::size_t play(int number) {
        const Vector3<float> step(number % 2 == 0 ? 0.5F : -0.5F, 0, 0);
        for (std::size_t i = 0; i < ids_.size(); i += 2) {
            boxes_[i].translate(step);
            grid_.move(ids_[i], boxes_[i]);
        }
        grid_.update();
        const Camera<float> view(cameraMatrix<float>({}, {-40, 20, 0}, {0, 0, 0}),
                                 DepthRange::zeroToOne, Viewport{0, 0, 1280, 720});
        const RayRegion<float> ray = view.rayThrough({640, 360});
        const auto test = [](ProxyId, const RayRegion<float>&, float limit) {
            return std::optional(limit);
        };
        std::size_t found = pickNearest(grid_, ray).id.isNull() ? 0 : 1;
        pickAll(grid_, ray, picked_, test);
        found += picked_.size();
        pickAll(grid_, clipToHeights(ray, {-5, 5}), picked_);
        found += picked_.size();
        select(grid_, view, {400, 200}, {800, 500}, selected_);
        found += selected_.size();
        CollectAll all(onMap_);
        onMap_.clear();
        grid_.visit(dragFootprint(view, {400, 200}, {800, 500}, {-5, 5}).region(), all);
        return found + onMap_.size();
    }

private:
    Grid<float> grid_;
    std::vector<ProxyId> ids_;
    std::vector<Aabb<float>> boxes_;
    std::vector<Picked<float>> picked_;
    std::vector<ProxyId> selected_;
    std::vector<ProxyId> onMap_;
};

TEST(SteadyPickingFrame, AllocatesNothing) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "allocations are not counted under a sanitizer";
    }
    PickingFrame frame;
    for (int i = 0; i < 100; ++i) {
        frame.play(i);
    }
    const std::size_t before = allocationCount();
    ASSERT_GT(before, 0U);
    std::size_t found = 0;
    for (int i = 100; i < 120; ++i) {
        found += frame.play(i);
    }
    EXPECT_EQ(allocationCount(), before);
    EXPECT_GT(found, 20U * 100U);
}

}  // namespace
}  // namespace hashphase::test
