// SPDX-License-Identifier: Zlib

// Where the filter refuses most of what overlaps, the pairs are remembered, and the refused ones not: the
// same is told, and asked, and neither cost nor memory follows what is refused.

#include <tests/support/count_allocations.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

/// A crowd of which few are pairs, and which can disperse.
template <class Scalar>
class RefusedCrowd {
public:
    explicit RefusedCrowd(std::uint32_t seed, const GridConfig& config = {})
        : world(config, [this](ProxyId a, ProxyId b) { return accepts(a, b); }), random(seed) {
        for (int i = 0; i < kCount; ++i) {
            add();
        }
    }

    static constexpr int kCount = 130;

    [[nodiscard]] bool accepts(ProxyId a, ProxyId b) const {
        return coloursPair(colours[a.index], colours[b.index]);
    }
    [[nodiscard]] Aabb<Scalar> draw() {
        return boxAround<Scalar>(random.pointIn(-reach, reach), random.pointIn(0.8, 1.2));
    }
    void add() {
        const Aabb<Scalar> box = draw();
        const auto mobility = random.chance(0.3) ? Mobility::resting : Mobility::mobile;
        proxies.push_back({world.add(box, mobility), box});
        colour(proxies.back());
    }
    void colour(Placed<Scalar>& proxy) {
        proxy.colour = random.chance(0.95) ? 1 : random.below(3);
        colours.resize(std::max<std::size_t>(colours.size(), proxy.id.index + 1));
        colours[proxy.id.index] = proxy.colour;
    }
    void move(double share) {
        for (Placed<Scalar>& proxy : proxies) {
            if (random.chance(share)) {
                proxy.box = draw();
                world.move(proxy.id, proxy.box);
            }
        }
    }
    void replaceSome() {
        for (int i = 0; i < 3; ++i) {
            Placed<Scalar>& victim = any();
            world.remove(victim.id);
            victim = proxies.back();
            proxies.pop_back();
            add();
        }
    }
    void setSomeGroups() {
        constexpr std::array kAll{ProxyGroups{}, ProxyGroups{2, 1}, ProxyGroups{4, 0}};
        for (int i = 0; i < 4; ++i) {
            world.setGroups(any().id, kAll[random.below(kAll.size())]);
        }
    }
    void sweepSome() {
        for (int i = 0; i < 5; ++i) {
            const Vector3<Scalar> way = random.pointIn(-3, 3).template cast<Scalar>();
            world.sweep(any().id, way, random.chance(0.2) ? Sweep::automatic : Sweep::none);
        }
    }
    void askAgain() {
        world.findPairsNow(any().id);
        std::array<ProxyId, 3> ids;
        for (ProxyId& id : ids) {
            Placed<Scalar>& proxy = any();
            colour(proxy);
            id = proxy.id;
        }
        switch (random.below(3)) {
            case 0:
                world.refilterAll();
                break;
            case 1:
                world.refilter(ids);
                break;
            default:
                for (const ProxyId id : ids) {
                    world.refilter(id);
                }
        }
    }
    void shift() {
        const Vector3<Scalar> by(Scalar(0.5), Scalar(-2), Scalar(1));
        world.shiftOrigin(by);
        for (Placed<Scalar>& proxy : proxies) {
            proxy.box = {proxy.box.min() - by, proxy.box.max() - by};
        }
    }
    [[nodiscard]] Placed<Scalar>& any() {
        return proxies[random.below(static_cast<std::uint32_t>(proxies.size()))];
    }
    void update() {
        world.update();
        world.checkThoroughly(proxies);
    }

    double reach = 0.7;  // [m]: everything overlaps everything
    PairWorld<Scalar> world;
    Random random;
    std::vector<std::uint32_t> colours;
    std::vector<Placed<Scalar>> proxies;
};

template <class Scalar>
class PairsOfRefusedCrowds : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PairsOfRefusedCrowds, Scalars);

TYPED_TEST(PairsOfRefusedCrowds, EqualBruteForceAsTheyGatherAndDisperse) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE(seed);
        GridConfig config;
        config.updatesBeforeRest = 2;
        RefusedCrowd<TypeParam> crowd(seed, config);
        int remembered = 0;
        int changesOfSide = 0;
        constexpr int kPhase = 40;  // frames
        for (int frame = 0; frame < 4 * kPhase; ++frame) {
            SCOPED_TRACE(frame);
            const bool before = crowd.world.pairs.remembersPairs();
            const int inPhase = frame % kPhase;
            const bool isQuiet = inPhase > 10 && inPhase % 10 < 4;
            crowd.reach = frame / kPhase % 2 == 0 ? 0.7 : 30;
            crowd.move(inPhase == 0 ? 1 : isQuiet ? 0 : 0.2);
            if (seed % 2 == 0 && !isQuiet) {
                crowd.setSomeGroups();
            }
            if (seed % 3 == 0 && !isQuiet) {
                crowd.sweepSome();
            }
            if (frame % 5 == 3) {
                crowd.replaceSome();
            }
            if (frame % 4 == 2) {
                crowd.askAgain();
            }
            if (frame % 11 == 7) {
                crowd.shift();
            }
            ASSERT_NO_FATAL_FAILURE(crowd.update());
            const bool after = crowd.world.pairs.remembersPairs();
            remembered += after ? 1 : 0;
            changesOfSide += before != after ? 1 : 0;
        }
        EXPECT_GT(remembered, kPhase);
        EXPECT_LT(remembered, 4 * kPhase);
        EXPECT_GE(changesOfSide, 2);
    }
}

TYPED_TEST(PairsOfRefusedCrowds, EqualBruteForceWhereTheyComeToRestOneByOne) {
    GridConfig config;
    config.updatesBeforeRest = 1;
    RefusedCrowd<TypeParam> crowd(7, config);
    crowd.reach = 30;
    crowd.move(1);
    for (int frame = 0; frame < 200; ++frame) {
        SCOPED_TRACE(frame);
        if (frame < RefusedCrowd<TypeParam>::kCount) {
            crowd.reach = 0.7;
            Placed<TypeParam>& next = crowd.proxies[static_cast<std::size_t>(frame)];
            next.box = crowd.draw();
            crowd.world.move(next.id, next.box);
        } else {
            crowd.move(frame % 7 == 0 ? 0.05 : 0);
        }
        ASSERT_NO_FATAL_FAILURE(crowd.update());
    }
    EXPECT_TRUE(crowd.world.pairs.remembersPairs());
}

/// So many in one place, of which the filter lets none pair.
struct RefusedPileWorld {
    explicit RefusedPileWorld(std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) {
            ids.push_back(grid.add(box));
        }
        bytesOfBoxes = bytesHeld();
    }
    PairChanges update() {
        return pairs.update([&](ProxyId a, ProxyId b) {
            ++asked;
            return accept(a, b);
        });
    }

    Aabb<float> box = makeBox<float>(0, 0, 0, 1, 1, 1);
    std::function<bool(ProxyId, ProxyId)> accept = [](ProxyId, ProxyId) { return false; };
    std::size_t asked = 0;
    Grid<float> grid;
    Pairs<float> pairs{grid};
    std::vector<ProxyId> ids;
    std::size_t bytesOfBoxes = 0;
};

TEST(RefusedPile, TakesNoMemoryBeyondItsBoxes) {
    constexpr std::uint32_t kCount = 4000;
    RefusedPileWorld pile(kCount);
    for (int i = 0; i < 3; ++i) {
        pile.update();
        EXPECT_LT(pile.pairs.memoryBytes(), std::size_t{4} << 20);
    }
    EXPECT_EQ(pile.asked, std::size_t{kCount} * (kCount - 1) / 2);
    pile.pairs.releaseUnusedMemory();
    EXPECT_LT(pile.pairs.memoryBytes(), std::size_t{128} << 10);
}

TEST(RefusedPile, CountsThePairsItRemembersAndGivesBackTheirRoomWhenTheyHaveGone) {
    constexpr std::uint32_t kCount = 1500;
    RefusedPileWorld pile(kCount);
    pile.accept = [](ProxyId a, ProxyId /*b*/) { return a.index < 200; };
    pile.update();
    ASSERT_TRUE(pile.pairs.remembersPairs());
    const std::size_t many = pile.pairs.count();
    ASSERT_GT(many, 200'000U);
    pile.pairs.releaseUnusedMemory();
    EXPECT_GT(pile.pairs.memoryBytes(), 15 * many);
    EXPECT_LT(pile.pairs.memoryBytes(), 40 * many);
    pile.accept = [](ProxyId, ProxyId) { return false; };
    pile.pairs.refilterAll(pile.accept);
    EXPECT_EQ(pile.pairs.count(), 0U);
    for (int i = 0; i < 300; ++i) {
        pile.grid.move(pile.ids[5], makeBox<float>(0, 0, 0, 1, 1, 1 + 0.001 * i));
        pile.update();
    }
    EXPECT_TRUE(pile.pairs.remembersPairs());
    EXPECT_LT(pile.pairs.memoryBytes(), 2 * many);
}

TEST(RefusedPile, RefiltersAFewAtTheirOwnCost) {
    constexpr std::uint32_t kCount = 1000;
    RefusedPileWorld pile(kCount);
    pile.update();
    ASSERT_TRUE(pile.pairs.remembersPairs());
    std::size_t asked = 0;
    const auto acceptAndCount = [&](ProxyId, ProxyId) {
        ++asked;
        return true;
    };
    const std::array ids{pile.ids[3], pile.ids[7], pile.ids[3]};
    EXPECT_EQ(pile.pairs.refilter(ids, acceptAndCount).born.size(), 2 * kCount - 3);
    EXPECT_EQ(asked, 2 * kCount - 3) << "each once";
    EXPECT_EQ(pile.pairs.validate(), "");
}

TEST(RefusedPile, AsksAboutWhatHasChangedOnly) {
    constexpr std::uint32_t kCount = 2000;
    RefusedPileWorld pile(kCount);
    pile.update();
    for (const bool isBack : {false, true, false}) {
        pile.asked = 0;
        pile.grid.move(pile.ids[5], isBack ? pile.box : makeBox<float>(9, 0, 0, 10, 1, 1));
        pile.update();
        EXPECT_EQ(pile.asked, isBack ? kCount - 1 : 0U);
        EXPECT_EQ(pile.pairs.validate(), "");
    }
}

TEST(RefusedPile, BeginsAndEndsPairsByRefilter) {
    constexpr std::uint32_t kCount = 300;
    RefusedPileWorld pile(kCount);
    pile.update();
    ASSERT_TRUE(pile.pairs.remembersPairs());
    pile.accept = [&](ProxyId a, ProxyId /*b*/) { return a == pile.ids[0]; };
    const auto filter = [&](ProxyId a, ProxyId b) { return pile.accept(a, b); };
    EXPECT_EQ(pile.pairs.refilter(pile.ids[3], filter).born.size(), 1U);
    EXPECT_EQ(pile.pairs.refilterAll(filter).born.size(), kCount - 2);
    EXPECT_EQ(pile.pairs.count(), kCount - 1);
    pile.grid.remove(pile.ids[9]);
    EXPECT_EQ(pile.update().died.size(), 1U);
    pile.accept = [](ProxyId, ProxyId) { return false; };
    EXPECT_EQ(pile.pairs.refilterAll(filter).died.size(), kCount - 2);
    EXPECT_EQ(pile.pairs.validate(), "");
}

// Two that sweep may each find the other, one of them, or neither, by the boxes that they have in the grid.
TEST(RefusedPile, AsksOnceAboutTwoThatSweep) {
    PairWorld<float> world({}, [](ProxyId, ProxyId) { return false; });
    Random random(0x5eed0d31);
    const auto box = [&] {
        return boxAround<float>(random.pointIn(-0.7, 0.7), random.pointIn(0.8, 1.2));
    };
    for (int i = 0; i < 200; ++i) {
        world.add(box());
    }
    world.update();
    ASSERT_TRUE(world.pairs.remembersPairs());
    std::vector<ProxyId> sweepers;
    for (int i = 0; i < 300; ++i) {
        sweepers.push_back(world.add(box()));
        if (random.chance(0.8)) {
            const MovingBox<float> way{box(), {5, 0, 0}};
            world.sweep(sweepers.back(), way, Sweep::automatic);
        }
    }
    world.refilterAll();
    EXPECT_GT(world.asked().size(), 100'000U);
    world.refilter(std::span(sweepers).first(50));
    EXPECT_GT(world.asked().size(), 20'000U);
}

// A pile of pairs is asked in parts once; what follows is as fast as ever.
TEST(RefusedPile, WhoseRefusedAreFewRemembersThem) {
    RefusedPileWorld pile(300);
    pile.accept = [](ProxyId, ProxyId) { return true; };
    EXPECT_EQ(pile.update().born.size(), 300U * 299 / 2);
    EXPECT_FALSE(pile.pairs.remembersPairs());
    EXPECT_EQ(pile.pairs.validate(), "");
    pile.asked = 0;
    pile.grid.move(pile.ids[7], makeBox<float>(0.5F, 0, 0, 1.5F, 1, 1));
    EXPECT_TRUE(pile.update().born.empty());
    EXPECT_EQ(pile.asked, 0U);
}

TEST(RefusedPile, OfWhichPairsAreAnnouncedIsBounded) {
    RefusedPileWorld pile(0);
    constexpr std::uint32_t kCount = 2000;
    std::size_t asked = 0;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        pile.ids.push_back(pile.grid.add(pile.box));
        pile.pairs.findPairsNow(pile.ids.back(), [&](ProxyId, ProxyId) {
            ++asked;
            return false;
        });
    }
    EXPECT_GE(asked, std::size_t{kCount} * (kCount - 1) / 2);
    EXPECT_LT(pile.pairs.memoryBytes(), std::size_t{6} << 20);
    pile.update();
    EXPECT_EQ(pile.pairs.validate(), "");
    EXPECT_EQ(pile.pairs.count(), 0U);
}

TEST(RefusedPile, IsRepeatedWhereMemoryRunsOut) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    const std::size_t failures = runOutOfMemory(
        [] {
            auto pile = std::make_unique<RefusedPileWorld>(90);
            pile->accept = [](ProxyId a, ProxyId b) { return (a.index + b.index) % 16 == 0; };
            pile->update();
            for (std::uint32_t i = 0; i < 90; i += 3) {
                pile->grid.move(pile->ids[i], makeBox<float>(0.25F, 0, 0, 1.25F, 1, 1));
            }
            for (int i = 0; i < 60; ++i) {
                pile->ids.push_back(pile->grid.add(pile->box));
            }
            pile->grid.remove(pile->ids[1]);
            return pile;
        },
        [](RefusedPileWorld& pile) {
            pile.update();
            pile.grid.move(pile.ids[2], makeBox<float>(5, 0, 0, 6, 1, 1));
            pile.update();
        },
        [](RefusedPileWorld& pile, std::size_t) {
            pile.update();
            pile.update();
            EXPECT_EQ(pile.pairs.validate(), "");
            std::size_t expected = 0;
            for (std::size_t a = 0; a < pile.ids.size(); ++a) {
                for (std::size_t b = a + 1; b < pile.ids.size(); ++b) {
                    expected +=
                        pile.grid.contains(pile.ids[a]) && pile.grid.contains(pile.ids[b]) &&
                                overlaps(pile.grid.box(pile.ids[a]), pile.grid.box(pile.ids[b])) &&
                                pile.accept(pile.ids[a], pile.ids[b])
                            ? 1
                            : 0;
                }
            }
            EXPECT_EQ(pile.pairs.count(), expected);
        });
    EXPECT_GE(failures, 30U);
}

}  // namespace
}  // namespace hashphase::test
