// SPDX-License-Identifier: Zlib
//
// A frame like the last one takes no memory. Counts every `new` of this program.

#include <integration/picking/drag_selection.hpp>
#include <integration/picking/ground.hpp>
#include <integration/picking/pick.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/cameras.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <optional>
#include <vector>

// Sanitizers have a `new` of their own, which finds faults that this one would hide.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

std::atomic<std::size_t> allocations{0};

void* allocate(std::size_t size, std::size_t alignment) {
    ++allocations;
    const std::size_t rounded = (size + alignment) / alignment * alignment;
    if (void* memory = std::aligned_alloc(alignment, rounded)) {
        return memory;
    }
    throw std::bad_alloc();
}

}  // namespace

// Not inlined: compilers take free() for a mismatch where they see only one half of the pair.
[[gnu::noinline]] void* operator new(std::size_t size) {
    return allocate(size, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

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
        const View<float> view(cameraMatrix<float>({}, {-40, 20, 0}, {0, 0, 0}),
                               DepthRange::zeroToOne, Viewport{0, 0, 1280, 720});
        const RayRegion<float> ray = view.rayThrough({640, 360});
        const auto test = [](ProxyId, const RayRegion<float>&, float limit) {
            return std::optional(limit);
        };
        std::size_t found = pickNearest(grid_, ray).id.isNull() ? 0 : 1;
        found += pickAll(grid_, ray, picked_, test).size();
        found += pickAll(grid_, clipToHeights(ray, {-5, 5}), picked_).size();
        found += select(grid_, view, {400, 200}, {800, 500}, selected_).size();
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
    PickingFrame frame;
    for (int i = 0; i < 100; ++i) {
        frame.play(i);
    }
    const std::size_t before = allocations;
    ASSERT_GT(before, 0U);
    std::size_t found = 0;
    for (int i = 100; i < 120; ++i) {
        found += frame.play(i);
    }
    EXPECT_EQ(allocations, before);
    EXPECT_GT(found, 20U * 100U);
}

}  // namespace
}  // namespace hashphase::test

#endif
