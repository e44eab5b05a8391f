// SPDX-License-Identifier: Zlib

// Rays between changes, many regions at once, and what rays cost a grid that is asked for none.

#include <tests/support/box_scenes.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
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
    explicit RayBatch(std::uint32_t count = 3000) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vector3<double> half = random_.pointIn(0.25, 0.75);
            const auto box = boxAround<Scalar>(random_.pointIn(-12, 12), half);
            const auto mobility = i % 2 == 0 ? Mobility::resting : Mobility::mobile;
            proxies_.push_back({grid_.add(box, mobility), box});
        }
        grid_.update();
    }

    void move(std::size_t i) {
        proxies_[i].box = shifted(random_, proxies_[i].box, 2);
        grid_.move(proxies_[i].id, proxies_[i].box);
    }

    Random random_{0x5eed0b01};
    Grid<Scalar> grid_;
    std::vector<Placed<Scalar>> proxies_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RayBatch, Scalars);

TYPED_TEST(RayBatch, FindsForEachRayWhatItFindsAloneInTheSameOrder) {
    using Ray = RayRegion<TypeParam>;
    RegionMaker<TypeParam> make(this->random_, this->proxies_);
    std::vector<Ray> rays;
    for (int i = 0; i < 500; ++i) {
        rays.push_back(make.ray(i % 3 == 0));
    }
    for (const ParallelFor parallelFor : {ParallelFor(serialFor), ParallelFor(forOnTwoThreads)}) {
        // Some wait in the list, some have left the table, and the trees are to be made.
        for (std::size_t i = 0; i < 40; ++i) {
            this->move(i * 70);
        }
        std::vector<std::vector<ProxyId>> found(rays.size());
        std::vector<CollectAll> collectors(found.begin(), found.end());
        const QueryCost cost = this->grid_.visitEach(
            std::span<const Ray>(rays), std::span<CollectAll>(collectors), parallelFor);
        QueryCost sum;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            std::vector<ProxyId> alone;
            CollectAll collector(alone);
            sum += this->grid_.visit(rays[i], collector);
            ASSERT_EQ(found[i], alone);
        }
        EXPECT_EQ(cost.rowsVisited, sum.rowsVisited);
        EXPECT_EQ(cost.boxesTested, sum.boxesTested);
        EXPECT_EQ(cost.hits, sum.hits);
        EXPECT_GT(cost.hits, 1000U);
    }
    std::vector<CollectCount> none;
    EXPECT_EQ(this->grid_.visitEach(std::span<const Ray>(), std::span<CollectCount>(none)).hits,
              0U);
}

// Boxes and spheres in any order, those that are looked for in vain and everywhere among them.
TYPED_TEST(RayBatch, FindsForEachBoxAndSphereWhatItFindsAlone) {
    using Scalar = TypeParam;
    using Limits = std::numeric_limits<Scalar>;
    RegionMaker<Scalar> make(this->random_, this->proxies_);
    const auto expectLikeAlone = [this]<class Region>(const std::vector<Region>& regions,
                                                      ParallelFor parallelFor) {
        std::vector<std::vector<ProxyId>> found(regions.size());
        std::vector<CollectAll> collectors(found.begin(), found.end());
        const QueryCost cost = this->grid_.visitEach(
            std::span<const Region>(regions), std::span<CollectAll>(collectors), parallelFor);
        std::size_t hits = 0;
        for (std::size_t i = 0; i < regions.size(); ++i) {
            std::vector<ProxyId> alone;
            CollectAll collector(alone);
            this->grid_.visit(regions[i], collector);
            std::sort(alone.begin(), alone.end());
            std::sort(found[i].begin(), found[i].end());
            ASSERT_EQ(found[i], alone) << i;
            hits += alone.size();
        }
        EXPECT_EQ(cost.hits, hits);
        EXPECT_GT(hits, 1000U);
    };
    for (const ParallelFor parallelFor : {ParallelFor(serialFor), ParallelFor(forOnTwoThreads)}) {
        for (std::size_t i = 0; i < 40; ++i) {
            this->move(i * 70);
        }
        std::vector<BoxRegion<Scalar>> boxes;
        std::vector<SphereRegion<Scalar>> spheres;
        for (int i = 0; i < 700; ++i) {
            boxes.push_back(make.box());
            spheres.push_back(make.sphere());
        }
        const Vector3<Scalar> zero = Vector3<Scalar>::Zero();
        const Vector3<Scalar> far = Vector3<Scalar>::Constant(Limits::infinity());
        const Vector3<Scalar> nan = Vector3<Scalar>::Constant(Limits::quiet_NaN());
        boxes.push_back({Aabb<Scalar>(-far, far)});
        boxes.push_back({Aabb<Scalar>(zero, nan)});
        spheres.emplace_back(zero, Limits::infinity());
        spheres.emplace_back(far, Scalar(1));
        spheres.emplace_back(nan, Scalar(1));
        spheres.emplace_back(zero, Scalar(-1));
        expectLikeAlone(boxes, parallelFor);
        expectLikeAlone(spheres, parallelFor);
    }
}

// A collector that has enough is offered no more.
TYPED_TEST(RayBatch, OffersNothingToACollectorThatHasEnough) {
    const BoxRegion<TypeParam> all{
        Aabb<TypeParam>(Vector3<TypeParam>::Constant(-100), Vector3<TypeParam>::Constant(100))};
    const std::vector<BoxRegion<TypeParam>> regions(3, all);
    std::vector<CollectAny> any(3);
    const QueryCost cost =
        this->grid_.visitEach(std::span<const BoxRegion<TypeParam>>(regions), std::span(any));
    EXPECT_EQ(cost.hits, 3U);
    EXPECT_FALSE(any[2].found().isNull());
}

TYPED_TEST(RayBatch, IsRightAfterEveryKindOfChange) {
    RegionMaker<TypeParam> make(this->random_, this->proxies_);
    const auto expectRight = [&] {
        for (int i = 0; i < 5; ++i) {
            expectLikeBruteForce<TypeParam>(this->grid_, this->proxies_, make.ray(i % 2 == 0));
        }
        ASSERT_EQ(this->grid_.validate(), "");
    };
    for (int round = 0; round < 30; ++round) {
        SCOPED_TRACE(round);
        expectRight();
        // One moves: the trees stay, it waits. Its old place answers no more.
        this->move(this->random_.below(3000));
        expectRight();
        // One of each table goes, and another comes, perhaps into its slot.
        for (int k = 0; k < 2; ++k) {
            Placed<TypeParam>& proxy = this->proxies_[this->random_.below(3000)];
            this->grid_.remove(proxy.id);
            proxy.box = shifted(this->random_, proxy.box, 5);
            proxy.id = this->grid_.add(proxy.box);
        }
        expectRight();
        // So many move that the next query files them.
        for (std::size_t i = 0; i < 300 && round % 5 == 4; ++i) {
            this->move(i * 10);
        }
        expectRight();
        if (round % 3 == 2) {
            this->grid_.update();
        }
        ASSERT_FALSE(this->HasFailure());
    }
}

TYPED_TEST(RayBatch, CostsAGridThatIsAskedForNoRaysNothing) {
    const std::size_t bytes = this->grid_.memoryBytes();
    RegionMaker<TypeParam> make(this->random_, this->proxies_);
    CollectCount count;
    this->grid_.visit(make.box(), count);
    this->grid_.visit(make.sphere(), count);
    EXPECT_EQ(this->grid_.memoryBytes(), bytes);
    this->grid_.visit(make.ray(), count);
    const std::size_t withTrees = this->grid_.memoryBytes();
    EXPECT_GT(withTrees, bytes);
    // Trees, and what it takes to make them, are a fixed number of bytes a proxy.
    EXPECT_LT(withTrees, bytes + 160 * 3000);
    this->grid_.update();
    this->grid_.visit(make.ray(), count);
    EXPECT_EQ(this->grid_.memoryBytes(), withTrees);
}

TYPED_TEST(RayBatch, ClosestReadsLittleOfALongWay) {
    std::uint64_t closest = 0;
    std::uint64_t all = 0;
    for (int i = 0; i < 1000; ++i) {
        Vector3<double> from = this->random_.pointIn(-12, 12);
        from[0] = -20;
        const RayRegion<TypeParam> ray(
            from.template cast<TypeParam>(),
            Vector3<TypeParam>(20, from.cast<TypeParam>()[1], from.cast<TypeParam>()[2]));
        CollectClosest<TypeParam> nearest;
        closest += this->grid_.visit(ray, nearest).boxesTested;
        CollectCount count;
        all += this->grid_.visit(ray, count).boxesTested;
    }
    EXPECT_LT(3 * closest, all);
}

}  // namespace
}  // namespace hashphase::test
