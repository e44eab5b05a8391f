// SPDX-License-Identifier: Zlib

// Many regions at once, and what rays cost a grid that is asked for none.

#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>
#include <thread>
#include <vector>

namespace hashphase::test {
namespace {

/// Two threads, the odd ranges on the second.
void forOnTwoThreads(std::size_t count, std::size_t grain, LoopBody body) {
    const auto run = [&](std::size_t begin) {
        for (; begin < count; begin += 2 * grain) {
            body(begin, std::min(begin + grain, count));
        }
    };
    std::thread second([&] { run(grain); });
    run(0);
    second.join();
}

template <class Scalar>
class RayBatch : public testing::Test {
protected:
    RayBatch() {
        world_.addMany(3000, boxesIn<Scalar>(-12, 12, 0.25, 0.75), 2);
        world_.update();
    }

    /// Some wait in the list, some have left the table, and the trees are to be made. Each region finds what it
    /// finds alone; where rays are asked, in the same order and at the same cost.
    template <class Region>
    void expectLikeAlone(const std::vector<Region>& regions, bool areRays) {
        for (const ParallelFor parallelFor :
             {ParallelFor(serialFor), ParallelFor(forOnTwoThreads)}) {
            for (std::size_t i = 0; i < 3000; i += 75) {
                world_.moveTo(i, shifted(world_.random, world_.proxies[i].box, 2));
            }
            std::vector<std::vector<ProxyId>> found(regions.size());
            std::vector<CollectAll> collectors(found.begin(), found.end());
            const QueryCost cost = world_.grid.visitEach(
                std::span<const Region>(regions), std::span<CollectAll>(collectors), parallelFor);
            QueryCost sum;
            for (std::size_t i = 0; i < regions.size(); ++i) {
                std::vector<ProxyId> alone;
                CollectAll collector(alone);
                sum += world_.grid.visit(regions[i], collector);
                if (!areRays) {
                    std::sort(alone.begin(), alone.end());
                    std::sort(found[i].begin(), found[i].end());
                }
                ASSERT_EQ(found[i], alone) << i;
            }
            EXPECT_EQ(cost.hits, sum.hits);
            EXPECT_TRUE(!areRays || cost.rowsVisited == sum.rowsVisited);
            EXPECT_TRUE(!areRays || cost.boxesTested == sum.boxesTested);
            EXPECT_GT(cost.hits, 1000U);
        }
        std::vector<CollectCount> none;
        EXPECT_EQ(world_.grid.visitEach(std::span<const Region>(), std::span(none)).hits, 0U);
    }

    Population<Scalar> world_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RayBatch, Scalars);

TYPED_TEST(RayBatch, FindsForEachRayWhatItFindsAloneInTheSameOrder) {
    RegionMaker<TypeParam> make(this->world_.random, this->world_.proxies);
    std::vector<RayRegion<TypeParam>> rays;
    for (int i = 0; i < 500; ++i) {
        rays.push_back(make.ray(i % 3 == 0));
    }
    this->expectLikeAlone(rays, true);
}

// In any order, those that are looked for in vain and everywhere among them.
TYPED_TEST(RayBatch, FindsForEachBoxAndSphereWhatItFindsAlone) {
    using Limits = std::numeric_limits<TypeParam>;
    RegionMaker<TypeParam> make(this->world_.random, this->world_.proxies);
    std::vector<BoxRegion<TypeParam>> boxes;
    std::vector<SphereRegion<TypeParam>> spheres;
    for (int i = 0; i < 700; ++i) {
        boxes.push_back(make.box());
        spheres.push_back(make.sphere());
    }
    const Vector3<TypeParam> zero = Vector3<TypeParam>::Zero();
    const Vector3<TypeParam> far = Vector3<TypeParam>::Constant(Limits::infinity());
    const Vector3<TypeParam> nan = Vector3<TypeParam>::Constant(Limits::quiet_NaN());
    boxes.push_back({Aabb<TypeParam>(-far, far)});
    boxes.push_back({Aabb<TypeParam>(zero, nan)});
    spheres.emplace_back(zero, Limits::infinity());
    spheres.emplace_back(far, TypeParam(1));
    spheres.emplace_back(nan, TypeParam(1));
    spheres.emplace_back(zero, TypeParam(-1));
    this->expectLikeAlone(boxes, false);
    this->expectLikeAlone(spheres, false);
}

TYPED_TEST(RayBatch, CostsAGridThatIsAskedForNoRaysNothing) {
    const Grid<TypeParam>& grid = this->world_.grid;
    RegionMaker<TypeParam> make(this->world_.random, this->world_.proxies);
    const std::size_t bytes = grid.memoryBytes();
    CollectCount count;
    grid.visit(make.box(), count);
    grid.visit(make.sphere(), count);
    EXPECT_EQ(grid.memoryBytes(), bytes);
    grid.visit(make.ray(), count);
    const std::size_t withTrees = grid.memoryBytes();
    EXPECT_GT(withTrees, bytes);
    // Trees, and what it takes to make them, are a fixed number of bytes a proxy.
    EXPECT_LT(withTrees, bytes + 160 * 3000);
    this->world_.update();
    grid.visit(make.ray(), count);
    EXPECT_EQ(grid.memoryBytes(), withTrees);
}

}  // namespace
}  // namespace hashphase::test
