// SPDX-License-Identifier: Zlib

// Proxies that sweep with a box of their own: the grid has another one, which queries see.

#include <broadphase/neighbours.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/bullet_world.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class SweptBoxes : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SweptBoxes, Scalars);

/// Bullets whose boxes in the grid are as large as their ways; boxes of their own fly.
template <class Scalar>
void fileAsLargeAsTheirWays(BulletWorld<Scalar>& world, const Bullets<Scalar>& bullets) {
    for (std::size_t i = 0; i < bullets.ways.size(); ++i) {
        const MovingBox<Scalar> way{bullets.boxes[i], bullets.ways[i]};
        world.grid.move(world.ids[i], sweptBounds(way));
        world.sweeps.set(world.ids[i], way);
    }
}

TYPED_TEST(SweptBoxes, MakeTheSamePairsAtTheSameCostHoweverLargeInTheGrid) {
    Random random(0x5eed0d0f);
    const Bullets<TypeParam> bullets(4000, 300, 40, random);
    BulletWorld<TypeParam> small(bullets, Sweep::automatic);
    BulletWorld<TypeParam> large(bullets, Sweep::automatic);
    fileAsLargeAsTheirWays(large, bullets);
    EXPECT_EQ(differences(large.update(), small.update()), "");
    for (int frame = 0; frame < 2; ++frame) {  // as long as they fly, and when they stand again
        EXPECT_EQ(large.pairs.lastCost().boxesTested, small.pairs.lastCost().boxesTested);
        EXPECT_EQ(large.pairs.lastCost().pairsWatched, small.pairs.lastCost().pairsWatched);
        EXPECT_EQ(large.sweeps.lastCost().boxesTested, small.sweeps.lastCost().boxesTested);
        EXPECT_EQ(large.sweeps.lastCost().contactsTested, small.sweeps.lastCost().contactsTested);
        for (const BulletWorld<TypeParam>* world : {&small, &large}) {
            EXPECT_EQ(world->pairs.validate(), "");
        }
        for (std::size_t i = 0; i < bullets.ways.size(); ++i) {
            small.sweeps.set(small.ids[i], {0, 0, 0});
            large.sweeps.set(large.ids[i], {0, 0, 0});
            large.grid.move(large.ids[i], bullets.boxes[i]);
        }
        EXPECT_EQ(differences(large.update(), small.update()), "");
    }
}

/// What the grid finds, by each kind of query, is what its boxes say.
template <class Scalar>
void expectQueriesByBoxes(const Grid<Scalar>& grid, Random& random) {
    std::vector<Placed<Scalar>> proxies;
    grid.forEach([&](ProxyId id, const Aabb<Scalar>& box) { proxies.push_back({id, box}); });
    RegionMaker<Scalar> make(random, proxies);
    std::vector<BoxRegion<Scalar>> boxes;
    for (int i = 0; i < 20; ++i) {
        boxes.push_back(make.box());
        expectLikeBruteForce<Scalar>(grid, proxies, boxes.back());
        expectLikeBruteForce<Scalar>(grid, proxies, make.sphere());
        expectLikeBruteForce<Scalar>(grid, proxies, make.ray(i % 2 == 0));
        expectLikeBruteForce<Scalar>(grid, proxies, make.convex());
        expectLikeBruteForce<Scalar>(grid, proxies, PositionRegion<Scalar>(make.point(), 9));
    }
    std::vector<CollectKeys<Scalar>> found(boxes.size());
    grid.visitEach(std::span<const BoxRegion<Scalar>>(boxes), std::span(found));
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        EXPECT_EQ(differences(found[i].sorted(), find(grid, boxes[i])), "");
    }
    Neighbours<Scalar> neighbours;
    EXPECT_EQ(
        neighbours.find(grid, 0).size(),
        pairsByBruteForce(std::span<const Placed<Scalar>>(proxies), [](const Placed<Scalar>& a,
                                                                       const Placed<Scalar>& b) {
            return overlaps(a.box, b.box);
        }).size());
    EXPECT_EQ(grid.validate(), "");
}

TYPED_TEST(SweptBoxes, AreWhatTheGridsQueriesSee) {
    Random random(0x5eed0d10);
    const Bullets<TypeParam> bullets(1200, 200, 25, random);
    BulletWorld<TypeParam> world(bullets, Sweep::automatic);
    fileAsLargeAsTheirWays(world, bullets);
    expectQueriesByBoxes(world.grid, random);
    world.update();
    expectQueriesByBoxes(world.grid, random);
    const Vector3<TypeParam> shift(0.3F, 1024, -7);
    world.grid.shiftOrigin(shift);
    expectQueriesByBoxes(world.grid, random);
    EXPECT_EQ(world.sweeps.motion(world.ids[0]).box.min(),
              Vector3<TypeParam>(bullets.boxes[0].min() - shift));
    // A few changes wait in a list; so many are filed anew.
    for (const std::size_t count : {5, 150}) {
        for (std::size_t i = 0; i < count; ++i) {
            if (i % 3 == 0 && world.grid.contains(world.ids[i])) {
                world.grid.remove(world.ids[i]);
            } else if (world.grid.contains(world.ids[i])) {
                world.sweeps.set(world.ids[i], {0, 0, TypeParam(i % 2)});
                world.grid.move(world.ids[i], bullets.boxes[i]);
            }
        }
        expectQueriesByBoxes(world.grid, random);
    }
    world.update();
    expectQueriesByBoxes(world.grid, random);
}

// What is asked between updates, of one that sweeps and of others: where the ways begin counts.
TYPED_TEST(SweptBoxes, AreAnnouncedWhereTheirWaysBegin) {
    PairWorld<TypeParam> world;
    const auto place = [](TypeParam x) { return makeBox<TypeParam>(x, 0, 0, x + 1, 1, 1); };
    const ProxyId bullet = world.add(makeBox<TypeParam>(0, 0, 0, 101, 1, 1));
    world.sweep(bullet, MovingBox<TypeParam>{place(0), {100, 0, 0}}, Sweep::automatic);
    const ProxyId atStart = world.add(place(TypeParam(0.5)));
    const ProxyId onTheWay = world.add(place(50));
    world.findPairsNow(onTheWay);
    EXPECT_TRUE(world.set().empty());
    world.findPairsNow(bullet);
    EXPECT_EQ(world.set().size(), 1U);
    world.findPairsNow(atStart);
    const PairChanges changes = world.update();
    EXPECT_TRUE(changes.died.empty());
    EXPECT_EQ(changes.born.size(), 1U) << "the one on the way";
    world.findPairsNow(bullet);
    world.refilter(bullet);
    EXPECT_EQ(world.set().size(), 2U);

    world.remove(atStart);
    world.refilter(bullet);  // not about the dead
    EXPECT_EQ(world.update().died.size(), 1U);
}

// Of Pairs that go, nothing stays behind that hides a proxy from others.
TYPED_TEST(SweptBoxes, AreOrdinaryOnesForPairsWithoutSweeps) {
    Grid<TypeParam> grid;
    Sweeps<TypeParam> sweeps(grid);
    const ProxyId a = grid.add(makeBox<TypeParam>(0, 0, 0, 1, 1, 1));
    const ProxyId b = grid.add(makeBox<TypeParam>(0, 0, 0, 1, 1, 1));
    sweeps.set(a, {5, 0, 0});
    {
        Pairs<TypeParam> swept(grid, &sweeps);
        EXPECT_EQ(swept.update().born.size(), 1U);
    }
    Pairs<TypeParam> pairs(grid);
    EXPECT_EQ(pairs.update().born.size(), 1U);
    EXPECT_EQ(pairs.validate(), "");
    grid.remove(b);
    EXPECT_EQ(pairs.update().died.size(), 1U);
}

// Each of them knows its own ways; those of the ones that are given count.
TYPED_TEST(SweptBoxes, MakePairsByTheSweepsThatAreGiven) {
    Grid<TypeParam> grid;
    const auto place = [](TypeParam x) { return makeBox<TypeParam>(x, 0, 0, x + 1, 1, 1); };
    const ProxyId mover = grid.add(place(0));
    const ProxyId near = grid.add(place(10));
    const ProxyId far = grid.add(place(20));
    Sweeps<TypeParam> first(grid);
    Sweeps<TypeParam> second(grid);
    auto third = std::make_unique<Sweeps<TypeParam>>(grid);
    first.set(mover, {10, 0, 0});
    second.set(mover, MovingBox<TypeParam>{place(20), {5, 0, 0}});
    third->set(mover, {0, 5, 0});
    Pairs<TypeParam> pairs(grid);
    EXPECT_TRUE(pairs.update().born.empty());
    std::vector<ProxyPair> now;
    const auto partner = [&](const std::vector<ProxyId>& expected) {
        const std::vector<ProxyPair> before = std::exchange(now, {});
        for (const ProxyId id : expected) {
            now.push_back(makePair(mover, id));
        }
        const PairChanges changes = pairs.update();
        EXPECT_TRUE(std::ranges::equal(changes.born, now));
        EXPECT_TRUE(std::ranges::equal(changes.died, before));
        EXPECT_EQ(pairs.validate(), "");
    };
    pairs.setSweeps(&first);
    partner({near});
    pairs.setSweeps(&second);
    EXPECT_TRUE(pairs.findPairsNow(mover, acceptAllPairs).died.empty());
    grid.shiftOrigin({8, 0, 0});
    EXPECT_EQ(second.motion(mover).box.min().x(), 12);
    now = {makePair(mover, near), makePair(mover, far)};
    pairs.setSweeps(nullptr);  // before it has been heard of: only its announced pair
    partner({});
    pairs.setSweeps(third.get());
    partner({});
    pairs.setSweeps(nullptr);
    third = nullptr;  // neither the first nor the last that the grid knows
    pairs.setSweeps(&first);
    partner({near});
}

}  // namespace
}  // namespace hashphase::test
