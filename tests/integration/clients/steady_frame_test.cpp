// SPDX-License-Identifier: Zlib
//
// A frame like the last one takes no memory.

#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <integration/culling/culler.hpp>
#include <integration/picking/drag_selection.hpp>
#include <integration/picking/ground.hpp>
#include <integration/picking/pick.hpp>
#include <tests/integration/terrain/meshes.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/count_allocations.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace hashphase::test {
namespace {

/// Bodies that swing about their homes, agents that look around and a camera: everything is asked.
class SwingingBodies {
public:
    static constexpr int kPeriod = 126;  // frames

    SwingingBodies() {
        Random random(0x5eed0f01);
        for (int i = 0; i < 2000; ++i) {
            homes_.push_back(random.pointIn(-20, 20));
            ids_.push_back(grid_.add(boxAround<float>(homes_.back(), {0.5, 0.5, 0.5})));
            colours_.push_back(random.below(4));
        }
        for (Viewer<float>& viewer : viewers_) {
            viewer.eye = random.pointIn(-20, 20).cast<float>();
            viewer.range = 8;
            viewer.halfAngle = 1;
            static_cast<void>(zones_.add({SphereRegion<float>(viewer.eye, 4)}));
        }
    }

    /// Returns how much was found.
    std::size_t play(int frame) {
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            const double turn = 2 * std::numbers::pi * (frame % kPeriod) / kPeriod;
            const double swing = std::sin(turn + static_cast<double>(i));
            const Vector3<double> offset = Vector3<double>::Constant(swing);
            grid_.move(ids_[i], boxAround<float>(homes_[i] + offset, {0.5, 0.5, 0.5}));
        }
        grid_.update();
        return askByAgents() + askByCamera();
    }

private:
    std::size_t askByAgents() {
        for (const Viewer<float>& viewer : viewers_) {
            findWithin(grid_, viewer.eye, 5, found_);
            estimateWithin(grid_, viewer.eye, 5, found_);
            findNearest(grid_, viewer.eye, 8, 100, nearest_);
        }
        sight_.look(grid_, viewers_);
        radar_.scan(grid_, {}, 3, [](ProxyId id) { return id.index % 3; });
        rarest_.update(grid_, 2, 4, colours_);
        const ZoneEvents events = zones_.update(grid_);
        return events.entered.size() + events.left.size();
    }

    std::size_t askByCamera() {
        const Camera<float> view(cameraMatrix<float>({}, {-40, 20, 0}, {0, 0, 0}),
                                 DepthRange::zeroToOne, Viewport{0, 0, 1280, 720});
        culler_.look(grid_, frustumRegion<float>(view.viewProjection(), view.depthRange()));
        const RayRegion<float> ray = view.rayThrough({640, 360});
        const auto test = [](ProxyId, const RayRegion<float>&, float limit) {
            return std::optional(limit);
        };
        std::size_t count = culler_.count() + (pickNearest(grid_, ray).id.isNull() ? 0 : 1);
        pickAll(grid_, ray, picked_, test);
        count += picked_.size();
        pickAll(grid_, clipToHeights(ray, {-5, 5}), picked_);
        count += picked_.size();
        select(grid_, view, {400, 200}, {800, 500}, found_);
        count += found_.size();
        CollectAll onMap(onMap_);
        onMap_.clear();
        grid_.visit(dragFootprint(view, {400, 200}, {800, 500}, {-5, 5}).region(), onMap);
        return count + onMap_.size();
    }

    Grid<float> grid_;
    std::vector<ProxyId> ids_;
    std::vector<Vector3<double>> homes_;
    std::vector<std::uint32_t> colours_;
    std::vector<Viewer<float>> viewers_ = std::vector<Viewer<float>>(50);
    Zones<float> zones_;
    Sight<float> sight_;
    Radar<float> radar_;
    RarestColour<float> rarest_;
    Culler<float> culler_;
    std::vector<ProxyId> found_;
    std::vector<ProxyId> onMap_;
    std::vector<KeyedProxy<float>> nearest_;
    std::vector<Picked<float>> picked_;
};

TEST(SteadyFrame, OfAllClientsAllocatesNothing) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "allocations are not counted under a sanitizer";
    }
    SwingingBodies bodies;
    int frame = 0;
    // By then the grid has given back what the first ones took.
    while (frame < 3 * SwingingBodies::kPeriod) {
        bodies.play(frame++);
    }
    const std::size_t before = allocationCount();
    ASSERT_GT(before, 0U);
    std::size_t found = 0;
    while (frame < 5 * SwingingBodies::kPeriod) {
        found += bodies.play(frame++);
    }
    EXPECT_EQ(allocationCount(), before);
    EXPECT_GT(found, SwingingBodies::kPeriod * 200U);
}

template <class Scalar>
class TerrainQueries : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TerrainQueries, Scalars);

TYPED_TEST(TerrainQueries, AllocateNothing) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "allocations are not counted under a sanitizer";
    }
    Random random(0x5eed2401);
    const GroundWorld<TypeParam> world(roughGround<TypeParam>(random, 60, 1, 3, 0.15));
    std::vector<Vector3<TypeParam>> points;
    const std::vector<TypeParam> radii(20000, TypeParam(0.8));
    for (std::size_t i = 0; i < radii.size(); ++i) {
        points.push_back(random.pointIn({0, 0, 0}, {60, 5, 60}).template cast<TypeParam>());
    }
    std::vector<std::optional<Ground<TypeParam>>> found(points.size());
    const std::size_t before = allocationCount();
    ASSERT_GT(before, 0U);
    world.terrain.surfacesBelow(points, found);
    world.terrain.restingHeights(points, radii, found);
    for (const Vector3<TypeParam>& point : points) {
        static_cast<void>(world.terrain.surfaceBelow(point));
    }
    EXPECT_EQ(allocationCount(), before);
}

}  // namespace
}  // namespace hashphase::test
