// SPDX-License-Identifier: Zlib

// Few proxies, which are compared with each other and not filed: pairs and queries are those of brute force, also
// where they become many, and few again.

#include <tests/support/handlers.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

/// Boxes of about 1 m, in so small a room that each overlaps some.
template <class Scalar>
struct RoomWorld : Population<Scalar, PairWorld> {
    using Population<Scalar, PairWorld>::Population;

    [[nodiscard]] Aabb<Scalar> draw() {
        const Vector3<double> middle = this->random.pointIn(-2, 2);
        const Vector3<double> half = this->random.pointIn(0.2, 0.7);
        return {(middle - half).template cast<Scalar>(), (middle + half).template cast<Scalar>()};
    }
    void addSome(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            this->add(draw());
        }
    }
    /// Moves about such a share of them; those that leave the room come in again.
    void nudge(double share, double by = 0.1) {
        for (std::size_t i = 0; i < this->proxies.size(); ++i) {
            if (this->random.chance(share)) {
                const Aabb<Scalar> box = shifted(this->random, this->proxies[i].box, by);
                const bool isInside = box.center().cwiseAbs().maxCoeff() < 2.5;
                this->moveTo(i, isInside ? box : draw());
            }
        }
    }
    void endFrame() {
        this->updateAndCheck();
        const UpdateCost& cost = this->pairs.lastCost().grid;
        comparedCount += cost.changed > 0 && cost.filed == 0 ? 1 : 0;
        filedCount += cost.filed > 0 ? 1 : 0;
    }

    // Updates that have compared what changed, and that have filed it.
    std::size_t comparedCount = 0;
    std::size_t filedCount = 0;
};

template <class Scalar>
class Few : public testing::Test {
protected:
    using World = RoomWorld<Scalar>;
    static constexpr std::size_t kFew = detail::Store<Scalar>::kFewProxies;

    static constexpr std::uint32_t kKinds = 9;

    /// Something else than a move of a box, of one of kKinds kinds.
    static void changeOne(World& world, std::uint32_t kind) {
        Random& random = world.random;
        const std::size_t i = world.any();
        const ProxyId id = world.proxies[i].id;
        switch (kind) {
            case 0:
                world.paint(i, random.below(3));
                world.refilter(id);
                break;
            case 1:
                world.setGroups(id, {1U << random.below(3), random.chance(0.5) ? ~0U : 1U});
                break;
            case 2:
                world.findPairsNow(id);
                break;
            case 3: {
                Aabb<Scalar> box = world.draw();
                box.min()[1] = std::numeric_limits<Scalar>::quiet_NaN();
                world.moveTo(i, random.chance(0.5) ? box : world.draw());
                break;
            }
            case 4:
                world.sweep(id, Vector3<Scalar>(static_cast<Scalar>(random.below(4)), 1, 0),
                            random.chance(0.5) ? Sweep::automatic : Sweep::none);
                break;
            case 5:
                world.shift({0, 0, random.chance(0.5) ? Scalar(0.5) : Scalar(0.1)});
                break;
            case 6:
                world.refilterAll();
                break;
            case 7:
                world.renewPairs(random.chance(0.5));
                break;
            default:
                world.add(world.draw(), Mobility::resting);
                break;
        }
    }
    /// No sweep, which keeps a world from being compared, and no NaN.
    static void calm(World& world) {
        for (std::size_t i = 0; i < world.proxies.size(); ++i) {
            world.sweep(world.proxies[i].id, Vector3<Scalar>::Zero(), Sweep::none);
            if (hasNan(world.proxies[i].box)) {
                world.moveTo(i, world.draw());
            }
        }
    }

private:
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Few, Scalars);

TYPED_TEST(Few, AreComparedAndFoundWhereTheyAre) {
    for (std::size_t count = 1; count <= this->kFew + 1; ++count) {
        SCOPED_TRACE(count);
        RoomWorld<TypeParam> world;
        world.addSome(count);
        world.endFrame();
        for (int update = 0; update < 60; ++update) {
            const bool isAsked = update < 30;  // many queries file
            world.comparedCount = isAsked ? 0 : world.comparedCount;
            world.nudge(1, update % 4 == 3 ? 1 : 0.02);
            world.expectQueriesLikeBruteForce(isAsked ? 2 : 0);
            world.endFrame();
            world.expectQueriesLikeBruteForce(isAsked ? 2 : 0);
            std::vector<ProxyPair> all;
            world.pairs.collect(all);
            ASSERT_TRUE(std::ranges::equal(all, world.set()));
        }
        EXPECT_EQ(world.comparedCount, count <= this->kFew ? 30U : 0U);
    }
}

TYPED_TEST(Few, EqualBruteForceAsTheyBecomeManyAndFewAgain) {
    for (const double cellSize : {0.0, 1.0}) {
        SCOPED_TRACE(cellSize);
        RoomWorld<TypeParam> world(GridConfig{.cellSize = cellSize, .updatesBeforeRest = 4});
        Random& random = world.random;
        std::size_t aim = 4;
        for (int frame = 0; frame < 4000 && !this->HasFailure(); ++frame) {
            SCOPED_TRACE(frame);
            aim = frame % 50 == 0 ? 1 + random.below(2 * this->kFew) : aim;
            if (world.proxies.size() < aim && random.chance(0.4)) {
                world.addSome(1 + random.below(4));
            } else if (world.proxies.size() > aim && random.chance(0.4)) {
                world.removeAt(world.any());
            }
            // One kind at a time, and then all.
            const std::uint32_t kind = static_cast<std::uint32_t>(frame) / 50 % (this->kKinds + 1);
            if (frame % 50 == 0) {
                this->calm(world);
            }
            const bool someStand = frame / 500 % 2 == 0;
            world.nudge(someStand ? 0.6 : 1, random.chance(0.2) ? 1 : 0.05);
            if (random.chance(0.2) && !world.proxies.empty()) {
                this->changeOne(world, kind < this->kKinds ? kind : random.below(this->kKinds));
            }
            world.nudge(0.1, 1);
            if (random.chance(0.1) && !world.proxies.empty()) {
                world.expectQueriesLikeBruteForce(1);
            }
            world.endFrame();
        }
        EXPECT_GT(world.comparedCount, 700U);
        EXPECT_GT(world.filedCount, 500U);
    }
}

// Also those that the filter refuses, and asks about again whenever one has moved.
TYPED_TEST(Few, AreAskedAboutAndRefused) {
    RoomWorld<TypeParam> world;
    world.addSome(12);
    for (std::size_t i = 0; i < world.proxies.size(); ++i) {
        world.paint(i, static_cast<std::uint32_t>(i % 3));
    }
    world.endFrame();
    std::size_t asked = 0;
    for (int update = 0; update < 200; ++update) {
        const std::size_t i = world.any();
        world.paint(i, world.random.below(3));
        world.refilter(world.proxies[i].id);
        world.nudge(0.7, 0.2);
        world.endFrame();
        asked += world.asked().size();
    }
    EXPECT_GT(asked, 200U);
    EXPECT_GT(world.pairs.refusedCount(), 0U);
    EXPECT_GT(world.comparedCount, 150U);
}

TYPED_TEST(Few, MeetWhatRests) {
    RoomWorld<TypeParam> world;
    world.add(makeBox<TypeParam>(-9, -9, -9, 9, 0, 9), Mobility::resting);
    for (int i = 0; i < 4; ++i) {
        world.add(world.draw(), Mobility::resting);
    }
    world.addSome(8);
    const auto nudgeOthers = [&] {
        for (std::size_t i = 5; i < world.proxies.size(); ++i) {
            world.moveTo(i, shifted(world.random, world.proxies[i].box, 0.3));
        }
        world.endFrame();
    };
    for (int update = 0; update < 50; ++update) {
        nudgeOthers();  // by then they have come to rest
    }
    EXPECT_EQ(world.pairs.lastCost().grid.resting, 5U);
    world.comparedCount = 0;
    for (int update = 0; update < 100; ++update) {
        nudgeOthers();
    }
    EXPECT_EQ(world.comparedCount, 100U);
    world.moveTo(1, world.draw());  // which wakes
    world.endFrame();
    for (int update = 0; update < 60; ++update) {
        nudgeOthers();
    }
    EXPECT_EQ(world.pairs.lastCost().grid.resting, 5U);
}

TYPED_TEST(Few, ThatAreLeftOfManyWhichHadSettledAreComparedAgain) {
    RoomWorld<TypeParam> world;
    world.addMany(300, spreadScene<TypeParam>("trembling", 1, 0).draw);
    const auto play = [&](int updates) {
        for (int update = 0; update < updates; ++update) {
            world.tremble();
            world.endFrame();
        }
    };
    play(60);
    EXPECT_GT(world.pairs.lastCost().grid.resting, 200U);
    world.keepOnly([](std::size_t i) { return i < 10; });
    play(3);
    EXPECT_EQ(world.pairs.lastCost().grid.resting, 0U);
    world.comparedCount = 0;
    play(60);
    EXPECT_EQ(world.comparedCount, 60U);
}

TYPED_TEST(Few, AreFiledOnceByManyQueries) {
    RoomWorld<TypeParam> world;
    world.addSome(16);
    world.endFrame();
    for (int update = 0; update < 20; ++update) {
        world.nudge(1);
        world.endFrame();
        const std::uint64_t filings = world.grid.filingCount();
        world.expectQueriesLikeBruteForce(40);
        EXPECT_EQ(world.grid.filingCount(), filings + 1);
        ASSERT_EQ(world.grid.validate() + world.pairs.validate(), "");
    }
    EXPECT_LE(world.filedCount, 21U);
}

TYPED_TEST(Few, AreFoundInAGridWithoutPairs) {
    Population<TypeParam> world;
    world.addMany(10, spreadScene<TypeParam>("few", 1, 0).draw);
    world.grid.update();
    for (int update = 0; update < 100; ++update) {
        for (std::size_t i = 0; i < world.proxies.size(); ++i) {
            world.moveTo(i, shifted(world.random, world.proxies[i].box, 0.3));
        }
        const bool isAsked = update < 50;  // many queries file
        EXPECT_TRUE(world.grid.update().filed == 0 || update <= 50) << update;
        ASSERT_EQ(world.grid.validate(), "");
        world.expectQueriesLikeBruteForce(isAsked ? 2 : 0);
    }
}

// Indices of those that came and went are in the list of changes already.
TYPED_TEST(Few, ThatComeAfterMemoryWasGivenBackHaveRoomInTheListOfChanges) {
    for (const std::size_t others : {std::size_t{1}, std::size_t{14}}) {
        Grid<TypeParam> grid;
        Random random(7);
        const auto draw = spreadScene<TypeParam>("few", 1, 0).draw;
        std::vector<ProxyId> ids;
        for (std::size_t i = 0; i < 10 + others; ++i) {
            ids.push_back(grid.add(draw(random)));
        }
        grid.update();
        for (std::size_t i = 0; i < 10; ++i) {
            grid.remove(ids[i]);
        }
        grid.update();
        std::vector<ProxyId> come;
        for (int i = 0; i < 9; ++i) {
            come.push_back(grid.add(draw(random)));
        }
        for (const ProxyId id : come) {
            grid.remove(id);
        }
        grid.move(ids.back(), draw(random));
        EXPECT_EQ(grid.update().filed, 0U);  // compared
        grid.releaseUnusedMemory();
        ids.push_back(grid.add(draw(random)));
        for (std::size_t i = 10; i < ids.size(); ++i) {
            grid.move(ids[i], draw(random));
        }
        EXPECT_EQ(grid.validate(), "");
    }
}

}  // namespace
}  // namespace hashphase::test
