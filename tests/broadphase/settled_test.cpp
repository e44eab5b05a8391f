// SPDX-License-Identifier: Zlib

// Boxes that move within their slack: they stay filed, and every answer is by the boxes as they are.

#include <tests/support/box_scenes.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/population.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

namespace hashphase::test {
namespace {

/// Boxes of 1 to 2 m that tremble about their places, and their pairs.
template <class Scalar>
struct TremblingWorld : Population<Scalar, PairWorld> {
    static constexpr std::uint32_t kCount = 300;

    explicit TremblingWorld(const GridConfig& config = {}) : Population<Scalar, PairWorld>(config) {
        this->addMany(kCount, spreadScene<Scalar>("trembling", 1, 0).draw);
        this->updateAndCheck();
    }

    void play(int updates, double by = 0.01) {
        for (int i = 0; i < updates; ++i) {
            this->tremble(0, kCount, by);
            this->updateAndCheck();
        }
    }
    [[nodiscard]] const UpdateCost& cost() const { return this->pairs.lastCost().grid; }
};

template <class Scalar>
class Settled : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Settled, Scalars);

TYPED_TEST(Settled, StayFiledWhileTheyTremble) {
    TremblingWorld<TypeParam> world;
    world.play(100);
    std::uint64_t filed = 0;
    for (int i = 0; i < 20; ++i) {
        world.play(1);
        filed += world.cost().filed;
        EXPECT_EQ(world.cost().changed, world.kCount);
        EXPECT_GT(world.cost().resting, world.kCount * 95 / 100);
    }
    EXPECT_LT(filed, 20 * world.kCount / 10);
}

TYPED_TEST(Settled, StayFiledWhileTheyCreepForALongTimeAndBreathe) {
    TremblingWorld<TypeParam> world;
    std::uint64_t filed = 0;
    for (int update = 0; update < 200; ++update) {
        for (std::size_t i = 0; i < world.proxies.size(); ++i) {
            const auto by = static_cast<TypeParam>(i % 2 == 0 ? 0.002 : -0.002);
            Aabb<TypeParam> box = world.proxies[i].box;
            box.min().array() += by;
            box.max().array() += i % 3 == 0 ? by : update % 2 == 0 ? by : -by;
            world.moveTo(i, box);
        }
        world.updateAndCheck();
        filed += update < 100 ? 0 : world.cost().filed;
    }
    EXPECT_LT(filed, 100 * world.kCount * 2 / 5);
}

TYPED_TEST(Settled, AreFoundWhereTheyAreBeforeAndAfterTheUpdate) {
    TremblingWorld<TypeParam> world;
    world.play(40);
    ASSERT_GT(world.cost().resting, 0U);
    std::size_t found = 0;
    for (int i = 0; i < 10; ++i) {
        world.tremble();
        found += world.expectQueriesLikeBruteForce(i % 3 == 0 ? 60 : 4);  // few read the list
        world.tremble(world.kCount / 2);
        found += world.expectQueriesLikeBruteForce(4);
        world.updateAndCheck();
        found += world.expectQueriesLikeBruteForce(8);
    }
    EXPECT_GT(found, 1000U);
}

TYPED_TEST(Settled, StayAsLongAsTheyAreWithinTheBoxByWhichTheyAreFiledAndNoLonger) {
    TremblingWorld<TypeParam> world;
    const TypeParam infinity = std::numeric_limits<TypeParam>::infinity();
    const auto& proxies = world.grid.store().proxies;
    std::size_t stayed = 0, left = 0;
    for (std::size_t number = 0; number < 200; ++number) {
        if (number % 25 == 0) {
            world.play(40);
        }
        const std::size_t at = world.any();
        const detail::Record<TypeParam>& record = proxies.records[world.proxies[at].id.index];
        if (!record.hasSlack) {
            continue;
        }
        const Aabb<TypeParam> filed = record.before;
        // As large as that, flat, larger by the least there is, inverted by it, or with a NaN.
        Aabb<TypeParam> box = filed;
        const int axis = world.random.axis();
        const bool isMin = world.random.chance(0.5);
        TypeParam& side = isMin ? box.min()[axis] : box.max()[axis];
        const TypeParam opposite = isMin ? box.max()[axis] : box.min()[axis];
        const TypeParam outwards = isMin ? -infinity : infinity;
        const auto how = number % 5;
        side = how == 0   ? side
               : how == 2 ? std::nextafter(side, outwards)
               : how == 4 ? std::numeric_limits<TypeParam>::quiet_NaN()
                          : opposite;
        if (how == 3) {  // inverted, and both sides within
            (isMin ? box.max()[axis] : box.min()[axis]) = std::nextafter(opposite, outwards);
        }
        world.moveTo(at, box);
        EXPECT_EQ(bool{record.hasSlack}, how < 2) << how;
        (record.hasSlack ? stayed : left) += 1;
        world.expectQueriesLikeBruteForce(2);
        world.updateAndCheck();
    }
    EXPECT_GT(stayed, 30U);
    EXPECT_GT(left, 50U);
}

TYPED_TEST(Settled, LeaveTheirSlackAtAnyTime) {
    TremblingWorld<TypeParam> world;
    world.play(40);
    for (int update = 0; update < 60; ++update) {
        world.tremble();
        for (int i = 0; i < 5; ++i) {  // far away, into a small corner of its box, or bad
            const std::size_t at = world.any();
            const Aabb<TypeParam> box = world.proxies[at].box;
            const Vector3<TypeParam> middle = box.center();
            const Aabb<TypeParam> inside(middle, middle + box.sizes() / 8);
            world.moveTo(at, i == 0   ? shifted(world.random, world.proxies[at].home, 5)
                             : i == 1 ? inside
                             : i == 2 ? Aabb<TypeParam>(box.max(), box.min())
                             : i == 3 ? hostileBox<TypeParam>(world.random)
                                      : world.proxies[world.any()].home);
        }
        world.updateAndCheck();
        world.expectQueriesLikeBruteForce(2);
    }
}

// Few wait, among many that are settled, no longer than it takes to see that they are calm.
TYPED_TEST(Settled, SettleAgainSoonWhereTheyHaveBeenPut) {
    TremblingWorld<TypeParam> world;
    world.play(100);
    for (std::size_t i = 0; i < 6; ++i) {
        world.proxies[i].home = world.proxies[i + 100].home;
    }
    world.play(1);
    EXPECT_LE(world.cost().resting, world.kCount - 6);
    world.play(40);
    EXPECT_GE(world.cost().resting, world.kCount - 2) << "but for who has just left";
}

TYPED_TEST(Settled, MeetWhatTravelsWhatStandsAndWhatComes) {
    TremblingWorld<TypeParam> world;
    world.addMany(60, spreadScene<TypeParam>("static", 1, 0).draw, 1);
    std::size_t pairs = 0;
    for (int update = 0; update < 120; ++update) {
        world.tremble(update % 40 < 30 ? 20 : 0, world.kCount);  // some travel, and come to rest
        for (std::size_t i = 0; i < 20 && update % 40 < 30; ++i) {
            world.moveTo(i, shifted(world.random, world.proxies[i].box, 0.4));
        }
        if (update % 7 == 0) {
            world.moveTo(world.kCount + world.random.below(60),
                         shifted(world.random, world.proxies[world.random.below(300)].home, 0.1));
        }
        if (update % 5 == 0) {
            const std::size_t painted = world.random.below(300);
            world.paint(painted, 1 + world.random.below(2));
            world.refilter(world.proxies[painted].id);
            world.findPairsNow(world.proxies[world.random.below(300)].id);
        }
        if (update % 31 == 0) {
            const auto by = static_cast<TypeParam>(update % 2 == 0 ? 1024 : 0.1);
            world.shift(Vector3<TypeParam>::Constant(by));
        }
        world.updateAndCheck();
        pairs += world.set().size();
    }
    EXPECT_GT(pairs, 1000U);
}

TYPED_TEST(Settled, AreFewAmongManyThatStand) {
    TremblingWorld<TypeParam> world;
    world.addMany(1300, boxesIn<TypeParam>(-20, 20, 0.5, 1), 1);
    world.updateAndCheck();
    world.play(60);
    EXPECT_GT(world.cost().resting, 1300 + world.kCount / 2);
    world.tremble(world.kCount - 5, world.kCount);
    world.updateAndCheck();
}

TYPED_TEST(Settled, SettleOnlyWhereThereMayBeSlack) {
    TremblingWorld<TypeParam> never({.slack = 0});
    never.play(40);
    EXPECT_EQ(never.cost().resting, 0U);
    EXPECT_EQ(never.cost().filed, never.kCount);

    TremblingWorld<TypeParam> fixed({.slack = 0.1});
    fixed.play(40);
    EXPECT_EQ(fixed.cost().resting, fixed.kCount);
    EXPECT_EQ(fixed.cost().filed, 0U);

    TremblingWorld<TypeParam> small({.slack = 0.001});
    small.play(40);
    EXPECT_EQ(small.cost().resting, 0U);
}

TYPED_TEST(Settled, HoldInAGridWithoutPairs) {
    Population<TypeParam> world;
    world.addMany(200, spreadScene<TypeParam>("trembling", 1, 0).draw);
    UpdateCost cost;
    for (int update = 0; update < 60; ++update) {
        world.tremble();
        world.expectQueriesLikeBruteForce(2);
        cost = world.grid.update();
        world.expectQueriesLikeBruteForce(2);
        ASSERT_EQ(world.grid.validate(), "");
    }
    EXPECT_GT(cost.resting, 180U);
}

// What rests has just been filed, and moves within its slack afterwards.
TYPED_TEST(Settled, AreMetByRaysWhoseTreeAFilterHasMade) {
    Grid<TypeParam> grid;
    Pairs<TypeParam> pairs(grid);
    Random random(7);
    const auto draw = spreadScene<TypeParam>("trembling", 1, 0).draw;
    const auto home = drawBoxes<TypeParam>(random, 300, draw);
    std::vector<ProxyId> ids;
    for (const Aabb<TypeParam>& box : home) {
        ids.push_back(grid.add(box));
    }
    const auto hither = makeBox<TypeParam>(50, 50, 50, 51, 51, 51);
    const ProxyId fares = grid.add(hither);
    static_cast<void>(grid.add(hither, Mobility::resting));
    std::size_t asked = 0;
    for (int update = 0; update < 100; ++update) {
        for (std::size_t i = 0; i < home.size(); ++i) {
            grid.move(ids[i], shifted(random, home[i], 0.01));
        }
        grid.move(fares, update % 2 == 0 ? hither : makeBox<TypeParam>(70, 50, 50, 71, 51, 51));
        static_cast<void>(pairs.update([&](ProxyId, ProxyId) {
            ++asked;
            grid.expectRays(100000);
            return true;
        }));
        for (const ProxyId id : ids) {
            const Aabb<TypeParam>& box = grid.box(id);
            const Vector3<TypeParam> to(box.center()[0], box.center()[1], box.max()[2]);
            std::vector<ProxyId> found;
            CollectAll all(found);
            grid.visit(RayRegion<TypeParam>(to + Vector3<TypeParam>(0, 0, 1), to), all);
            ASSERT_TRUE(std::ranges::find(found, id) != found.end()) << update;
        }
    }
    EXPECT_GT(asked, 10U);
}

TYPED_TEST(Settled, AreMetByManySweepsThatGoAlongRays) {
    constexpr std::size_t kFlying = 120;
    TremblingWorld<TypeParam> world(GridConfig{.slack = 1});
    world.add(makeBox<TypeParam>(-5000, -5000, 0, -4999, -4999, 1), Mobility::resting);
    world.add(makeBox<TypeParam>(4999, 4999, 0, 5000, 5000, 1), Mobility::resting);
    const std::size_t first = world.proxies.size();
    for (std::size_t i = first; i < first + kFlying; ++i) {
        const auto at = world.random.pointIn(-10, 10);
        world.add(boxAround<TypeParam>({-4000, at[1] - 450, at[2]}, {0.3, 0.3, 0.3}));
        world.sweep(world.proxies[i].id, Vector3<TypeParam>(8000, 900, 0), Sweep::automatic);
    }
    world.play(40, 0.2);
    EXPECT_GT(world.cost().resting, 250U);
    EXPECT_GT(world.sweeps.sweeping().search.cost().rays, 50U);
}

// Their candidates fill several parts.
TEST(SettledMany, HaveTheSamePairsOnThreads) {
    constexpr std::size_t kCount = 12'000;
    Random random(7);
    const auto draw = [](Random& drawn) {
        return boxAround<float>(drawn.pointIn(0, 26), {0.5, 0.5, 0.5});
    };
    const auto home = drawBoxes<float>(random, kCount, draw);
    ThreadedFor onThreads(3, 0x5eed0701);
    Grid<float> alone, together;
    Pairs<float> pairsAlone(alone), pairsTogether(together);
    std::vector<ProxyId> ids;
    for (const Aabb<float>& box : home) {
        ids.push_back(alone.add(box));
        ASSERT_EQ(together.add(box), ids.back());
    }
    std::size_t turned = 0;
    for (int update = 0; update < 40; ++update) {
        for (std::size_t i = 0; i < kCount; ++i) {
            const Aabb<float> box = shifted(random, home[i], 0.01);
            alone.move(ids[i], box);
            together.move(ids[i], box);
        }
        const PairChanges expected = pairsAlone.update();
        const PairChanges changes = pairsTogether.update(acceptAllPairs, onThreads);
        ASSERT_TRUE(std::ranges::equal(changes.born, expected.born)) << update;
        ASSERT_TRUE(std::ranges::equal(changes.died, expected.died)) << update;
        turned += update < 30 ? 0 : changes.born.size() + changes.died.size();
    }
    EXPECT_GT(pairsAlone.lastCost().grid.resting, kCount / 2);
    EXPECT_GT(pairsAlone.lastCost().pairsWatched, 8192U);
    EXPECT_GT(turned, 100U);
    EXPECT_EQ(pairsTogether.validate(), "");
}

// By what does not move them: they settle again, though by then few looks are taken at how boxes move.
TYPED_TEST(Settled, AreCollectedAfterTheyWereWokenAndSettleAgain) {
    for (const bool isShifted : {false, true}) {
        TremblingWorld<TypeParam> world;
        world.play(200);
        for (std::size_t i = 0; i < world.proxies.size(); ++i) {  // so that the shift rounds none
            const auto rounded = [](const Vector3<TypeParam>& corner) -> Vector3<TypeParam> {
                return (corner * 1024).array().round() / 1024;
            };
            const Aabb<TypeParam> box = world.proxies[i].box;
            world.moveTo(i, {rounded(box.min()), rounded(box.max())});
        }
        world.updateAndCheck();
        ASSERT_GT(world.cost().resting, 200U);
        const auto collected = [&] {
            std::vector<ProxyPair> all;
            world.pairs.collect(all);
            return std::set<ProxyPair>(all.begin(), all.end());
        };
        ASSERT_GT(world.set().size(), 100U);
        EXPECT_EQ(collected(), world.set());
        if (isShifted) {
            world.shift({1024, 0, 0});
        } else {
            world.grid.releaseUnusedMemory();
        }
        EXPECT_FALSE(world.grid.store().tables.resting.isSettled());
        EXPECT_EQ(collected(), world.set());
        world.play(40);
        EXPECT_GT(world.cost().resting, 200U);
    }
}

// Among themselves, and with what is mobile.
TYPED_TEST(Settled, ThatHaveMovedAreFilteredAgainBetweenUpdates) {
    Grid<TypeParam> grid({.slack = 0.5});
    Pairs<TypeParam> pairs(grid);
    const auto placed = [](std::size_t i, double dx = 0) {
        return boxAround<TypeParam>({1.2 * static_cast<double>(i) + dx, 0, 0}, {0.5, 0.5, 0.5});
    };
    std::vector<ProxyId> ids;
    for (std::size_t i = 0; i < 100; ++i) {
        ids.push_back(grid.add(placed(i)));
    }
    for (int update = 0; update < 60; ++update) {
        for (std::size_t i = 0; i < ids.size(); ++i) {
            grid.move(ids[i], placed(i, update % 2 == 0 ? 0.01 : 0));
        }
        static_cast<void>(pairs.update());
    }
    ASSERT_EQ(pairs.lastCost().grid.resting, ids.size());
    ASSERT_EQ(pairs.count(), 0U);
    const ProxyId mobile = grid.add(placed(100, -0.1));
    grid.move(ids[99], placed(99, 0.2));
    grid.move(ids[50], placed(50, 0.3));
    const PairChanges changes = pairs.refilterAll(acceptAllPairs);
    const std::vector<ProxyPair> expected{makePair(ids[50], ids[51]), makePair(ids[99], mobile)};
    EXPECT_TRUE(std::ranges::equal(changes.born, expected));
    EXPECT_TRUE(pairs.update().born.empty());
    EXPECT_EQ(pairs.validate(), "");
}

// What they needed while they were mobile is given back.
TYPED_TEST(Settled, TakeLessMemoryAfterALongWhile) {
    constexpr std::size_t kCount = 3000;
    Population<TypeParam> world;
    world.addMany(kCount, spreadScene<TypeParam>("trembling", 1, 0).draw);
    const auto play = [&](int updates) {
        for (int update = 0; update < updates; ++update) {
            world.tremble();
            world.grid.update();
        }
        return world.grid.memoryBytes();
    };
    const std::size_t soon = play(40);
    const std::size_t late = play(600);
    EXPECT_LT(late + kCount * 2 * sizeof(detail::PaddedBox<TypeParam>), soon);
    EXPECT_EQ(world.grid.validate(), "");
}

}  // namespace
}  // namespace hashphase::test
