// SPDX-License-Identifier: Zlib

// What proxies may not pair by their groups costs nothing; and the filter asked again about many at once. What
// groups and filters make of a pair is in pairs_test.cpp.

#include <tests/support/pair_world.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

constexpr ProxyGroups kParked{1, 0};
constexpr ProxyGroups kStatic{2, ~2U};
constexpr ProxyGroups kMoving{1, ~0U};
constexpr ProxyGroups kDebris{1, 2};

Aabb<float> boxAt(double x, double z = 0, double edge = 2) {
    return makeBox<float>(x, 0, z, x + edge, edge, z + edge);
}

/// Boxes at one place, or side by side.
struct Pile {
    Pile(std::uint32_t count, const ProxyGroups& groups, double apart, double edge = 2) {
        const auto mobility = groups == kStatic ? Mobility::resting : Mobility::mobile;
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto box = boxAt(apart * (i % 100), apart * (i / 100), edge);
            ids.push_back(grid.add(box, mobility, groups));
        }
    }
    /// Boxes tested by so many updates in which another proxy moves elsewhere.
    std::uint64_t update(int count) {
        std::uint64_t tested = 0;
        for (int i = 0; i < count; ++i) {
            pairs.update();
            tested += pairs.lastCost().boxesTested;
            grid.move(mover, boxAt(-1000 + i));
        }
        return tested;
    }
    /// How many pairs there are when it has come by.
    std::size_t meetMover() {
        grid.move(mover, boxAt(1));
        pairs.update();
        EXPECT_EQ(pairs.validate(), "");
        return pairs.count();
    }
    [[nodiscard]] std::size_t memoryBytes() const {
        return grid.memoryBytes() + pairs.memoryBytes();
    }

    Grid<float> grid;
    Pairs<float> pairs{grid};
    std::vector<ProxyId> ids;
    ProxyId mover = grid.add(boxAt(-1000), Mobility::mobile, kMoving);
};

TEST(PairGroups, CostNothingWhereBoxesThatMayNotPairLieAtOnePlace) {
    constexpr std::uint32_t kCount = 10000;
    for (const ProxyGroups& groups : {kParked, kStatic, kDebris, ProxyGroups{0, ~0U}}) {
        SCOPED_TRACE(testing::Message() << "group " << groups.group << ", mask " << groups.mask);
        Pile pile(kCount, groups, 0);
        Pile spread(kCount, groups, 3);
        const std::uint64_t tested = pile.update(30);
        EXPECT_LE(tested, spread.update(30) + 50 * kCount);
        EXPECT_LE(pile.memoryBytes(), spread.memoryBytes() + (1U << 20));
        EXPECT_EQ(pile.pairs.refusedCount(), 0U);
        EXPECT_EQ(pile.pairs.count(), 0U);
        EXPECT_EQ(pile.grid.validate(), "");
        EXPECT_EQ(pile.pairs.validate(), "");
        // One of them comes into play, and one that moves comes by.
        pile.grid.setGroups(pile.ids[7], kMoving);
        pile.grid.move(pile.ids[7], boxAt(9));
        pile.pairs.update();
        EXPECT_LE(pile.pairs.lastCost().boxesTested, 20 * kCount);
        EXPECT_EQ(pile.pairs.count(), 0U);
        EXPECT_EQ(pile.meetMover(), mayPair(groups, kMoving) ? kCount - 1 : 0U);
    }
}

TEST(PairGroups, CostNothingAmongHugeBoxesThatAreListedWithoutCells) {
    constexpr std::uint32_t kCount = 4000;
    Pile pile(kCount, kStatic, 0, std::numeric_limits<double>::infinity());
    EXPECT_LE(pile.update(5), 100 * kCount);
    EXPECT_EQ(pile.grid.validate(), "");
    EXPECT_EQ(pile.pairs.count(), 0U);
    EXPECT_EQ(pile.meetMover(), kCount);
}

TEST(PairGroups, TellApartWhatSharesACrowdedCell) {
    Population<float, PairWorld> world(GridConfig{.cellSize = 8});
    constexpr std::array kKinds{kParked, kStatic, kMoving, kDebris, ProxyGroups{4, 5}};
    const auto setAnyGroups = [&](std::size_t i) {
        world.setGroups(world.proxies[i].id, kKinds[world.random.below(kKinds.size())]);
    };
    for (std::size_t i = 0; i < 800; ++i) {
        const double side = world.random.chance(0.5) ? 1 : 6;
        world.add(boxesIn<float>(0., side, 0.1, 0.4)(world.random));
        setAnyGroups(i);
    }
    for (int frame = 0; frame < 24; ++frame) {
        for (int k = 0; k < (frame < 12 ? 100 : 1); ++k) {
            const std::size_t i = world.any();
            world.moveTo(i, shifted(world.random, world.proxies[i].box, 0.2));
            setAnyGroups(world.any());
        }
        world.updateAndCheck();
        ASSERT_FALSE(HasFailure());
    }
}

TEST(PairGroups, OfAnyNumberOfKindsAreRight) {
    Population<float, PairWorld> world;
    for (std::uint32_t i = 0; i < 700; ++i) {
        world.setGroups(world.add(boxAt(0.002 * i)), {1 + i, (i * 2654435761U) >> 7});
    }
    world.updateAndCheck();
    EXPECT_GT(world.pairs.count(), 1000U);
}

// --- Many at once --------------------------------------------------------------------------------

/// Asked again about so many at once, or about all.
class RefilterMany : public testing::TestWithParam<std::size_t> {};

TEST_P(RefilterMany, DoesWhatAsManySingleCallsDo) {
    bool isOn = true;
    const auto filter = [&](ProxyId, ProxyId) { return isOn; };
    Population<float, PairWorld> one({}, filter);
    Population<float, PairWorld> many({}, filter);
    const BoxScene<float> scene = spreadScene<float>("spread", 1, 0);
    one.addMany(600, scene.draw);
    many.addMany(600, scene.draw);
    std::vector<ProxyId> ids;
    for (const Placed<float>& proxy : one.proxies) {
        ids.push_back(proxy.id);
    }
    for (int frame = 0; frame < 40; ++frame) {
        const std::size_t moving = frame % 10 < 5 ? 200 : 0;
        for (std::size_t i = 0; i < moving; ++i) {
            const Aabb<float> box = scene.draw(one.random);
            one.moveTo(i, box);
            many.moveTo(i, box);
        }
        isOn = !isOn;
        const bool areAll = GetParam() == ids.size();
        const std::size_t first = areAll ? 0 : moving / 2;
        const auto some =
            std::span(ids).subspan(first).first(std::min(GetParam(), ids.size() - first));
        for (const ProxyId id : some) {
            one.refilter(id);
        }
        if (areAll) {
            many.refilterAll();
        } else {
            many.refilter(some);
        }
        ASSERT_EQ(one.set(), many.set());
        one.update();
        many.update();
        ASSERT_EQ(one.set(), many.set());
        ASSERT_EQ(one.pairs.refusedCount(), many.pairs.refusedCount());
        ASSERT_EQ(many.pairs.validate(), "");
    }
}

INSTANTIATE_TEST_SUITE_P(Few, RefilterMany, testing::Values(20));
INSTANTIATE_TEST_SUITE_P(Half, RefilterMany, testing::Values(300));
INSTANTIATE_TEST_SUITE_P(All, RefilterMany, testing::Values(600));

}  // namespace
}  // namespace hashphase::test
