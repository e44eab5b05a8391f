// SPDX-License-Identifier: Zlib

// What proxies may not pair by their groups costs nothing, and pairs begin and stay as groups say.

#include <tests/support/box_scenes.hpp>
#include <tests/support/pair_world.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

constexpr ProxyGroups kParked{1, 0};
constexpr ProxyGroups kStatic{2, ~2U};
constexpr ProxyGroups kMoving{1, ~0U};
constexpr ProxyGroups kDebris{1, 2};

Aabb<float> boxAt(double x, double y = 0, double z = 0) {
    return makeBox<float>(x, y, z, x + 2, y + 2, z + 2);
}

/// Boxes at one place, or side by side.
struct Pile {
    Pile(std::uint32_t count, const ProxyGroups& groups, double apart, double edge = 2) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const double x = apart * (i % 100);
            const double z = apart * (i / 100);
            ids.push_back(grid.add(makeBox<float>(x, 0, z, x + edge, edge, z + edge),
                                   groups == kStatic ? Mobility::resting : Mobility::mobile,
                                   groups));
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
        const std::uint64_t testedApart = spread.update(30);
        EXPECT_LE(tested, testedApart + 50 * kCount);
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
        pile.grid.move(pile.mover, boxAt(1));
        pile.pairs.update();
        const bool meetsAll = mayPair(groups, kMoving);
        EXPECT_EQ(pile.pairs.count(), meetsAll ? kCount - 1 : 0U);
        EXPECT_EQ(pile.pairs.validate(), "");
    }
}

TEST(PairGroups, CostNothingAmongHugeBoxesThatAreListedWithoutCells) {
    constexpr std::uint32_t kCount = 4000;
    Pile pile(kCount, kStatic, 0, std::numeric_limits<double>::infinity());
    EXPECT_LE(pile.update(5), 100 * kCount);
    EXPECT_EQ(pile.grid.validate(), "");
    EXPECT_EQ(pile.pairs.count(), 0U);
    pile.grid.move(pile.mover, boxAt(1));
    pile.pairs.update();
    EXPECT_EQ(pile.pairs.count(), kCount);
}

TEST(PairGroups, TellApartWhatSharesACrowdedCell) {
    Random random(0x5eed0110);
    GridConfig config;
    config.cellSize = 8;
    PairWorld<float> world(config);
    constexpr std::array kKinds{kParked, kStatic, kMoving, kDebris, ProxyGroups{4, 5}};
    std::vector<Placed<float>> proxies;
    for (std::uint32_t i = 0; i < 1500; ++i) {
        const Vector3<double> center = random.pointIn(0, random.chance(0.5) ? 1 : 6);
        const Aabb<float> box = boxAround<float>(center, random.pointIn(0.1, 0.4));
        proxies.push_back({world.add(box), box});
        world.setGroups(proxies.back().id, kKinds[random.below(kKinds.size())]);
    }
    for (int frame = 0; frame < 24; ++frame) {
        for (std::uint32_t k = 0; k < (frame < 12 ? 100U : 1U); ++k) {
            Placed<float>& proxy = proxies[random.below(1500)];
            proxy.box = shifted(random, proxy.box, 0.2);
            world.move(proxy.id, proxy.box);
            world.setGroups(proxies[random.below(1500)].id, kKinds[random.below(kKinds.size())]);
        }
        world.update();
        ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
    }
}

TEST(PairGroups, HideNothingFromQueries) {
    Pile pile(1000, kParked, 0);
    for (int i = 0; i < 3; ++i) {
        CollectCount found;
        pile.grid.visit(BoxRegion<float>{boxAt(1)}, found);
        EXPECT_EQ(found.count(), 1000U);
        pile.pairs.update();
    }
}

/// Two that overlap.
struct Two {
    Two(const ProxyGroups& ofA, const ProxyGroups& ofB, int updates) {
        world.setGroups(a, ofA);
        world.setGroups(b, ofB);
        for (int i = 0; i < updates; ++i) {
            update();
        }
    }
    bool update() {
        world.update();
        world.checkThoroughly(
            std::array{Placed<double>{a, world.grid.box(a)}, Placed<double>{b, world.grid.box(b)}});
        return isPair();
    }
    [[nodiscard]] bool isPair() const { return world.set().contains(makePair(a, b)); }

    PairWorld<double> world;
    ProxyId a = world.add(makeBox<double>(0, 0, 0, 2, 2, 2), Mobility::resting);
    ProxyId b = world.add(makeBox<double>(1, 0, 0, 3, 2, 2), Mobility::resting);
};

TEST(PairGroups, BeginAPairWhenTheyAreSetSoThatItMayBe) {
    for (const int updates : {0, 1, 40}) {
        Two two(kParked, kMoving, updates);
        EXPECT_FALSE(two.isPair());
        two.world.setGroups(two.a, kMoving);
        EXPECT_TRUE(two.update());
        EXPECT_TRUE(two.update());
    }
}

TEST(PairGroups, KeepAPairUntilItPartsWhenTheyAreSetSoThatItMayNotBe) {
    for (const int updates : {1, 40}) {
        Two two(kMoving, kMoving, updates);
        two.world.setGroups(two.b, kParked);
        EXPECT_TRUE(two.update());
        two.world.move(two.b, makeBox<double>(1.5, 0, 0, 3, 2, 2));
        EXPECT_TRUE(two.update());
        two.world.move(two.b, makeBox<double>(9, 0, 0, 11, 2, 2));
        EXPECT_FALSE(two.update());
        two.world.move(two.b, makeBox<double>(1, 0, 0, 3, 2, 2));
        EXPECT_FALSE(two.update());
    }
}

TEST(PairGroups, KeepAPairThatMayBeAgainWithoutAskingTheFilter) {
    Two two(kMoving, kMoving, 2);
    two.world.setGroups(two.b, kParked);
    EXPECT_TRUE(two.update());
    two.world.setGroups(two.b, kMoving);
    EXPECT_TRUE(two.update());
    EXPECT_TRUE(two.world.asked().empty());
}

TEST(PairGroups, EndAPairByRefilter) {
    for (const int updates : {0, 1, 40}) {
        for (const bool beforeRefilter : {false, true}) {
            Two two(kMoving, kMoving, 2);
            two.world.setGroups(two.b, kParked);
            for (int i = 0; i < updates; ++i) {
                two.update();
            }
            EXPECT_TRUE(two.isPair());
            if (beforeRefilter) {
                two.world.refilterAll();
            } else {
                two.world.refilter(two.a);
            }
            EXPECT_FALSE(two.isPair());
            EXPECT_FALSE(two.update());
            two.world.setGroups(two.b, kMoving);
            EXPECT_TRUE(two.update());
        }
    }
}

TEST(PairGroups, OfAnyNumberOfKindsAreRight) {
    PairWorld<float> world;
    std::vector<Placed<float>> proxies;
    for (std::uint32_t i = 0; i < 700; ++i) {
        const Aabb<float> box = boxAt(0.002 * i);
        proxies.push_back({world.add(box), box});
        world.setGroups(proxies.back().id, {1 + i, (i * 2654435761U) >> 7});
    }
    world.update();
    world.checkThoroughly(proxies);
    EXPECT_GT(world.pairs.count(), 1000U);
}

// --- Many at once --------------------------------------------------------------------------------

TEST(RefilterMany, DoesWhatAsManySingleCallsDo) {
    for (const int form : {0, 1, 2}) {
        Random random(0x5eed0111);
        const BoxScene<float> scene = spreadScene<float>("spread", 1, 0);
        bool isOn = true;
        PairWorld<float> one({}, [&](ProxyId, ProxyId) { return isOn; });
        PairWorld<float> many({}, [&](ProxyId, ProxyId) { return isOn; });
        std::vector<ProxyId> ids;
        for (int i = 0; i < 600; ++i) {
            const Aabb<float> box = scene.draw(random);
            ids.push_back(one.add(box));
            many.add(box);
        }
        for (int frame = 0; frame < 40; ++frame) {
            const std::size_t moving = frame % 10 < 5 ? 200 : 0;
            for (std::size_t i = 0; i < moving; ++i) {
                const Aabb<float> box = scene.draw(random);
                one.move(ids[i], box);
                many.move(ids[i], box);
            }
            isOn = !isOn;
            const std::size_t count = form == 0 ? 20 : form == 1 ? 300 : ids.size();
            const auto some =
                std::span(ids).subspan(moving / 2).first(std::min(count, ids.size() - moving / 2));
            for (const ProxyId id : form == 2 ? std::span<const ProxyId>(ids) : some) {
                one.refilter(id);
            }
            if (form == 2) {
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
}

TEST(RefilterMany, AsksOnceAboutEachPair) {
    Two two(kMoving, kMoving, 2);
    two.world.refilterAll();
    EXPECT_EQ(two.world.asked(), std::vector{makePair(two.a, two.b)});
    const std::array ids{two.a, two.b, two.a};
    two.world.refilter(ids);
    EXPECT_EQ(two.world.asked(), std::vector{makePair(two.a, two.b)});
    two.world.refilter(std::span<const ProxyId>());
    EXPECT_TRUE(two.world.asked().empty());
}

}  // namespace
}  // namespace hashphase::test
