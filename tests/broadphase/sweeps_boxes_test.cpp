// SPDX-License-Identifier: Zlib

// Proxies that sweep with a box of their own: the grid has another one, which queries see. And several
// Sweeps of one grid.

#include <broadphase/neighbours.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/bullet_world.hpp>
#include <tests/support/oracles.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class SweptBoxes : public testing::Test {
protected:
    static Aabb<Scalar> cubeAt(double x) { return makeBox<Scalar>(x, 0, 0, x + 1, 1, 1); }

    /// Bullets whose boxes in the grid are as large as their ways; boxes of their own fly.
    static void fileAsLargeAsTheirWays(BulletWorld<Scalar>& world, const Bullets<Scalar>& bullets) {
        for (std::size_t i = 0; i < bullets.ways.size(); ++i) {
            const MovingBox<Scalar> way{bullets.boxes[i], bullets.ways[i]};
            world.grid.move(world.ids[i], sweptBounds(way));
            world.sweeps.set(world.ids[i], way);
        }
    }

    /// What the grid finds, by each kind of query, is what its boxes say.
    void expectQueriesByBoxes(const Grid<Scalar>& grid) {
        std::vector<Placed<Scalar>> proxies;
        grid.forEach([&](ProxyId id, const Aabb<Scalar>& box) { proxies.push_back({id, box}); });
        expectQueriesLikeBruteForce<Scalar>(grid, proxies, random_, 20);
        RegionMaker<Scalar> make(random_, proxies);
        std::vector<BoxRegion<Scalar>> boxes;
        for (int i = 0; i < 20; ++i) {
            boxes.push_back(make.box());
            expectLikeBruteForce<Scalar>(grid, proxies, PositionRegion<Scalar>(make.point(), 9));
        }
        std::vector<CollectKeys<Scalar>> found(boxes.size());
        grid.visitEach(std::span<const BoxRegion<Scalar>>(boxes), std::span(found));
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            EXPECT_EQ(differences(found[i].sorted(), find(grid, boxes[i])), "");
        }
        Neighbours<Scalar> neighbours;
        EXPECT_EQ(neighbours.find(grid, 0).size(),
                  pairsByBruteForce(std::span<const Placed<Scalar>>(proxies)).size());
        EXPECT_EQ(grid.validate(), "");
    }

    Random random_{0x5eed0d0f};
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SweptBoxes, Scalars);

TYPED_TEST(SweptBoxes, MakeTheSamePairsAtTheSameCostHoweverLargeInTheGrid) {
    const Bullets<TypeParam> bullets(4000, 300, 40, this->random_);
    BulletWorld<TypeParam> small(bullets, Sweep::automatic);
    BulletWorld<TypeParam> large(bullets, Sweep::automatic);
    this->fileAsLargeAsTheirWays(large, bullets);
    EXPECT_EQ(differences(large.update(), small.update()), "");
    for (int frame = 0; frame < 2; ++frame) {  // as long as they fly, and when they stand again
        EXPECT_EQ(large.pairs.lastCost().boxesTested, small.pairs.lastCost().boxesTested);
        EXPECT_EQ(large.pairs.lastCost().pairsWatched, small.pairs.lastCost().pairsWatched);
        EXPECT_EQ(large.sweeps.lastCost().boxesTested, small.sweeps.lastCost().boxesTested);
        EXPECT_EQ(large.sweeps.lastCost().contactsTested, small.sweeps.lastCost().contactsTested);
        EXPECT_EQ(small.pairs.validate() + large.pairs.validate(), "");
        for (std::size_t i = 0; i < bullets.ways.size(); ++i) {
            small.sweeps.set(small.ids[i], {0, 0, 0});
            large.sweeps.set(large.ids[i], {0, 0, 0});
            large.grid.move(large.ids[i], bullets.boxes[i]);
        }
        EXPECT_EQ(differences(large.update(), small.update()), "");
    }
}

TYPED_TEST(SweptBoxes, AreWhatTheGridsQueriesSee) {
    const Bullets<TypeParam> bullets(1200, 200, 25, this->random_);
    BulletWorld<TypeParam> world(bullets, Sweep::automatic);
    this->fileAsLargeAsTheirWays(world, bullets);
    this->expectQueriesByBoxes(world.grid);
    world.update();
    this->expectQueriesByBoxes(world.grid);
    const Vector3<TypeParam> shift(0.3F, 1024, -7);
    world.grid.shiftOrigin(shift);
    this->expectQueriesByBoxes(world.grid);
    EXPECT_EQ(world.sweeps.motion(world.ids[0]).box.min(),
              Vector3<TypeParam>(bullets.boxes[0].min() - shift));
    // A few changes wait in a list; so many are filed anew.
    for (const std::size_t count : {5U, 150U}) {
        for (std::size_t i = 0; i < count; ++i) {
            if (!world.grid.contains(world.ids[i])) {
                continue;
            }
            if (i % 3 == 0) {
                world.grid.remove(world.ids[i]);
            } else {
                world.sweeps.set(world.ids[i], {0, 0, TypeParam(i % 2)});
                world.grid.move(world.ids[i], bullets.boxes[i]);
            }
        }
        this->expectQueriesByBoxes(world.grid);
    }
    world.update();
    this->expectQueriesByBoxes(world.grid);
}

// Of Pairs that go, nothing stays behind that hides a proxy from others.
TYPED_TEST(SweptBoxes, AreOrdinaryOnesForPairsWithoutSweeps) {
    Grid<TypeParam> grid;
    Sweeps<TypeParam> sweeps(grid);
    sweeps.set(grid.add(this->cubeAt(0)), {5, 0, 0});
    const ProxyId other = grid.add(this->cubeAt(0));
    {
        Pairs<TypeParam> swept(grid, &sweeps);
        EXPECT_EQ(swept.update().born.size(), 1U);
    }
    Pairs<TypeParam> pairs(grid);
    EXPECT_EQ(pairs.update().born.size(), 1U);
    EXPECT_EQ(pairs.validate(), "");
    grid.remove(other);
    EXPECT_EQ(pairs.update().died.size(), 1U);
}

// Each of them knows its own ways; those of the ones that are given count.
TYPED_TEST(SweptBoxes, MakePairsByTheSweepsThatAreGiven) {
    Grid<TypeParam> grid;
    const ProxyId mover = grid.add(this->cubeAt(0));
    const ProxyId near = grid.add(this->cubeAt(10));
    const ProxyId far = grid.add(this->cubeAt(20));
    Sweeps<TypeParam> first(grid);
    Sweeps<TypeParam> second(grid);
    auto third = std::make_unique<Sweeps<TypeParam>>(grid);
    first.set(mover, {10, 0, 0});
    second.set(mover, MovingBox<TypeParam>{this->cubeAt(20), {5, 0, 0}});
    third->set(mover, {0, 5, 0});
    Pairs<TypeParam> pairs(grid);
    EXPECT_TRUE(pairs.update().born.empty());
    std::vector<ProxyPair> now;
    const auto expectPairsWith = [&](const std::vector<ProxyId>& expected) {
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
    expectPairsWith({near});
    pairs.setSweeps(&second);
    EXPECT_TRUE(pairs.findPairsNow(mover, acceptAllPairs).died.empty());
    grid.shiftOrigin({8, 0, 0});
    EXPECT_EQ(second.motion(mover).box.min().x(), 12);
    now = {makePair(mover, near), makePair(mover, far)};
    pairs.setSweeps(nullptr);  // before it has been heard of: only its announced pair
    expectPairsWith({});
    pairs.setSweeps(third.get());
    expectPairsWith({});
    pairs.setSweeps(nullptr);
    third = nullptr;  // neither the first nor the last that the grid knows
    pairs.setSweeps(&first);
    expectPairsWith({near});
}

// Where its way begins, and not where the grid has it.
TYPED_TEST(SweptBoxes, MakePairsBetweenUpdatesWhereTheirWaysBegin) {
    Grid<TypeParam> grid;
    Sweeps<TypeParam> sweeps(grid);
    Pairs<TypeParam> pairs(grid, &sweeps);
    const ProxyId target = grid.add(this->cubeAt(100));
    const ProxyId bullet = grid.add(this->cubeAt(50));
    const ProxyId other = grid.add(this->cubeAt(70));
    sweeps.set(bullet, MovingBox<TypeParam>{this->cubeAt(0), {5, 0, 0}});
    sweeps.set(other, MovingBox<TypeParam>{this->cubeAt(3), {0, 5, 0}});
    std::size_t asked = 0;
    const auto accept = [&asked](ProxyId, ProxyId) {
        ++asked;
        return true;
    };
    const auto expectOneBorn = [&](const auto& find) {
        static_cast<void>(pairs.update());
        const std::size_t before = pairs.count();
        grid.move(target, this->cubeAt(0));
        asked = 0;
        const PairChanges changes = find();
        ASSERT_EQ(changes.born.size(), 1U);
        EXPECT_EQ(changes.born[0], makePair(target, bullet));
        EXPECT_EQ(asked, 1U);
        EXPECT_TRUE(pairs.update(accept).born.empty());
        EXPECT_EQ(pairs.validate(), "");
        grid.move(target, this->cubeAt(100));
        static_cast<void>(pairs.update());
        EXPECT_EQ(pairs.count(), before);
    };
    expectOneBorn([&] { return pairs.findPairsNow(target, std::span(&bullet, 1), accept); });
    expectOneBorn([&] { return pairs.findPairsNow(target, accept); });
    const auto refiltered = [&](const PairChanges& changes) {
        asked = 1;  // of those that stand, too
        return changes;
    };
    expectOneBorn([&] { return refiltered(pairs.refilter(target, accept)); });
    expectOneBorn([&] { return refiltered(pairs.refilter(bullet, accept)); });
    const std::array both{bullet, target};
    expectOneBorn([&] { return refiltered(pairs.refilter(both, accept)); });
    expectOneBorn([&] { return refiltered(pairs.refilterAll(accept)); });
    // The grid has it at the target, too.
    grid.move(bullet, this->cubeAt(0.5));
    expectOneBorn([&] { return pairs.findPairsNow(target, accept); });
    // Only the grid has it there.
    static_cast<void>(pairs.update());
    sweeps.set(bullet, MovingBox<TypeParam>{this->cubeAt(-50), {5, 0, 0}});
    grid.move(target, this->cubeAt(0));
    EXPECT_TRUE(pairs.findPairsNow(target, accept).born.empty());
    // Two that sweep.
    sweeps.set(bullet, MovingBox<TypeParam>{this->cubeAt(3), {0, 5, 0}});
    EXPECT_EQ(pairs.findPairsNow(other, accept).born.size(), 1U);
}

}  // namespace
}  // namespace hashphase::test
