// SPDX-License-Identifier: Zlib

// Where the filter refuses most of what overlaps, the pairs are remembered, and the refused ones not: the
// same is told, and asked, and neither cost nor memory follows what is refused.

#include <tests/support/call_each.hpp>
#include <tests/support/count_allocations.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

/// A crowd of which few are pairs, and which can disperse.
template <class Scalar>
struct RefusedCrowd : Population<Scalar, PairWorld> {
    static constexpr std::size_t kCount = 130;

    explicit RefusedCrowd(std::uint32_t seed, const GridConfig& config = {})
        : Population<Scalar, PairWorld>(config) {
        this->random = Random(seed);
        addUpTo(kCount);
    }
    Aabb<Scalar> draw() { return boxesIn<Scalar>(-reach, reach, 0.8, 1.2)(this->random); }
    void addUpTo(std::size_t count) {
        while (this->proxies.size() < count) {
            this->add(draw(), this->random.chance(0.3) ? Mobility::resting : Mobility::mobile);
            paintAny(this->proxies.size() - 1);
        }
    }
    void paintAny(std::size_t i) {
        this->paint(i, this->random.chance(0.95) ? 1 : this->random.below(3));
    }
    void moveSome(double share) {
        for (std::size_t i = 0; i < this->proxies.size(); ++i) {
            if (this->random.chance(share)) {
                this->moveTo(i, draw());
            }
        }
    }
    void replaceSome() {
        for (int i = 0; i < 3; ++i) {
            this->removeAt(this->any());
        }
        addUpTo(kCount);
    }
    void setSomeGroups() {
        constexpr std::array kAll{ProxyGroups{}, ProxyGroups{2, 1}, ProxyGroups{4, 0}};
        for (int i = 0; i < 4; ++i) {
            this->setGroups(anyId(), kAll[this->random.below(kAll.size())]);
        }
    }
    void sweepSome() {
        for (int i = 0; i < 5; ++i) {
            const Vector3<Scalar> way = this->random.pointIn(-3, 3).template cast<Scalar>();
            const bool begins = this->random.chance(0.2);
            this->sweep(anyId(), way, begins ? Sweep::automatic : Sweep::none);
        }
    }
    void askAgain() {
        this->findPairsNow(anyId());
        std::array<ProxyId, 3> ids;
        for (ProxyId& id : ids) {
            const std::size_t i = this->any();
            paintAny(i);
            id = this->proxies[i].id;
        }
        const std::uint32_t form = this->random.below(3);
        if (form == 0) {
            this->refilterAll();
        } else if (form == 1) {
            this->refilter(ids);
        }
        for (std::size_t i = 0; form == 2 && i < ids.size(); ++i) {
            this->refilter(ids[i]);
        }
    }
    void ignoreSome() {
        for (int i = 0; i < 20; ++i) {
            const ProxyId a = anyId();
            const ProxyId b = anyId();
            if (a != b && this->random.chance(0.6)) {
                this->ignore(makePair(a, b));
            } else if (a != b) {
                this->stopIgnoring(makePair(a, b));
            }
        }
    }
    [[nodiscard]] ProxyId anyId() { return this->proxies[this->any()].id; }

    double reach = 0.7;  // [m]: everything overlaps everything
};

template <class Scalar>
class PairsOfRefusedCrowds : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PairsOfRefusedCrowds, Scalars);

TYPED_TEST(PairsOfRefusedCrowds, EqualBruteForceAsTheyGatherAndDisperse) {
    for (const std::uint32_t seed : {1U, 2U, 3U, 6U}) {  // of 2 groups are set, of 3 some sweep
        SCOPED_TRACE(seed);
        RefusedCrowd<TypeParam> crowd(seed, {.updatesBeforeRest = 2});
        int remembered = 0;
        int changesOfSide = 0;
        constexpr int kPhase = 40;  // frames
        for (int frame = 0; frame < 4 * kPhase; ++frame) {
            SCOPED_TRACE(frame);
            const bool before = crowd.pairs.remembersPairs();
            const int inPhase = frame % kPhase;
            const bool isQuiet = inPhase > 10 && inPhase % 10 < 4;
            crowd.reach = frame / kPhase % 2 == 0 ? 0.7 : 30;
            crowd.moveSome(inPhase == 0 ? 1 : isQuiet ? 0 : 0.2);
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
            if (frame % 3 == 1) {
                crowd.ignoreSome();
            }
            if (frame % 11 == 7) {
                crowd.shift({TypeParam(0.5), -2, 1});
            }
            crowd.updateAndCheck();
            ASSERT_FALSE(this->HasFailure());
            const bool after = crowd.pairs.remembersPairs();
            remembered += after ? 1 : 0;
            changesOfSide += before != after ? 1 : 0;
        }
        EXPECT_GT(remembered, kPhase);
        EXPECT_LT(remembered, 4 * kPhase);
        EXPECT_GE(changesOfSide, 2);
    }
}

TYPED_TEST(PairsOfRefusedCrowds, EqualBruteForceWhereTheyComeToRestOneByOne) {
    RefusedCrowd<TypeParam> crowd(7, {.updatesBeforeRest = 1});
    crowd.reach = 30;
    crowd.moveSome(1);
    crowd.reach = 0.7;
    for (std::size_t frame = 0; frame < 200; ++frame) {
        SCOPED_TRACE(frame);
        if (frame < crowd.kCount) {
            crowd.moveTo(frame, crowd.draw());
        } else {
            crowd.moveSome(frame % 7 == 0 ? 0.05 : 0);
        }
        crowd.updateAndCheck();
        ASSERT_FALSE(this->HasFailure());
    }
    EXPECT_TRUE(crowd.pairs.remembersPairs());
}

TEST(RefusedCrowdOutOfMemory, IsRepeated) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    using Crowd = RefusedCrowd<float>;
    const std::size_t failures = runOutOfMemory(
        [] {
            auto crowd = std::make_unique<Crowd>(8);
            crowd->update();
            crowd->moveSome(0.3);
            crowd->addUpTo(180);
            crowd->removeAt(1);
            return crowd;
        },
        [](Crowd& crowd) {
            updatePairsInWant(crowd);
            crowd.grid.move(crowd.proxies[2].id, crowd.proxies[2].box = crowd.draw());
            updatePairsInWant(crowd);
        },
        [](Crowd& crowd, std::size_t) {
            crowd.update();
            crowd.check(crowd.proxies);
            EXPECT_EQ(crowd.pairs.validate(), "");
        });
    EXPECT_GE(failures, 30U);
}

// --- Piles at one place --------------------------------------------------------------------------

/// So many in one place, of which the filter lets none pair.
struct RefusedPile : testing::Test {
    void addMany(std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) {
            ids.push_back(grid.add(box));
        }
    }
    PairChanges update() { return pairs.update(filter); }
    void moveUpTo(std::size_t i, double top) {
        grid.move(ids[i], makeBox<float>(0, 0, 0, 1, 1, top));
    }

    Aabb<float> box = makeBox<float>(0, 0, 0, 1, 1, 1);
    std::function<bool(ProxyId, ProxyId)> accept = [](ProxyId, ProxyId) { return false; };
    std::size_t asked = 0;
    std::function<bool(ProxyId, ProxyId)> filter = [this](ProxyId a, ProxyId b) {
        ++asked;
        return accept(a, b);
    };
    Grid<float> grid;
    Pairs<float> pairs{grid};
    std::vector<ProxyId> ids;
};

TEST_F(RefusedPile, TakesNoMemoryBeyondItsBoxes) {
    constexpr std::uint32_t kCount = 4000;
    addMany(kCount);
    for (int i = 0; i < 3; ++i) {
        update();
        EXPECT_LT(pairs.memoryBytes(), std::size_t{4} << 20);
    }
    EXPECT_EQ(asked, std::size_t{kCount} * (kCount - 1) / 2);
    pairs.releaseUnusedMemory();
    EXPECT_LT(pairs.memoryBytes(), std::size_t{128} << 10);
}

TEST_F(RefusedPile, CountsThePairsItRemembersAndGivesBackTheirRoomWhenTheyHaveGone) {
    addMany(1500);
    accept = [](ProxyId a, ProxyId /*b*/) { return a.index < 200; };
    update();
    ASSERT_TRUE(pairs.remembersPairs());
    const std::size_t many = pairs.count();
    ASSERT_GT(many, 200'000U);
    pairs.releaseUnusedMemory();
    EXPECT_GT(pairs.memoryBytes(), 15 * many);
    EXPECT_LT(pairs.memoryBytes(), 40 * many);
    accept = [](ProxyId, ProxyId) { return false; };
    pairs.refilterAll(filter);
    EXPECT_EQ(pairs.count(), 0U);
    for (int i = 0; i < 300; ++i) {
        moveUpTo(5, 1 + 0.001 * i);
        update();
    }
    EXPECT_TRUE(pairs.remembersPairs());
    EXPECT_LT(pairs.memoryBytes(), 2 * many);
}

TEST_F(RefusedPile, AsksAboutWhatHasChangedOnly) {
    constexpr std::uint32_t kCount = 2000;
    addMany(kCount);
    update();
    for (const bool isBack : {false, true, false}) {
        asked = 0;
        grid.move(ids[5], isBack ? box : makeBox<float>(9, 0, 0, 10, 1, 1));
        update();
        EXPECT_EQ(asked, isBack ? kCount - 1 : 0U);
        EXPECT_EQ(pairs.validate(), "");
    }
    grid.move(ids[5], box);
    update();
    // Of a few that are asked about again, each pair once.
    asked = 0;
    accept = [](ProxyId, ProxyId) { return true; };
    const std::array few{ids[3], ids[7], ids[3]};
    EXPECT_EQ(pairs.refilter(few, filter).born.size(), 2 * kCount - 3);
    EXPECT_EQ(asked, 2 * kCount - 3);
    EXPECT_EQ(pairs.validate(), "");
}

TEST_F(RefusedPile, BeginsAndEndsPairsByRefilter) {
    constexpr std::uint32_t kCount = 300;
    addMany(kCount);
    update();
    ASSERT_TRUE(pairs.remembersPairs());
    accept = [&](ProxyId a, ProxyId /*b*/) { return a == ids[0]; };
    EXPECT_EQ(pairs.refilter(ids[3], filter).born.size(), 1U);
    EXPECT_EQ(pairs.refilterAll(filter).born.size(), kCount - 2);
    EXPECT_EQ(pairs.count(), kCount - 1);
    grid.remove(ids[9]);
    EXPECT_EQ(update().died.size(), 1U);
    accept = [](ProxyId, ProxyId) { return false; };
    EXPECT_EQ(pairs.refilterAll(filter).died.size(), kCount - 2);
    EXPECT_EQ(pairs.validate(), "");
}

// Two that sweep may each find the other, one of them, or neither, by the boxes that they have in the grid.
TEST(RefusedPileOfSweeps, AsksOnceAboutTwoThatSweep) {
    PairWorld<float> world({}, [](ProxyId, ProxyId) { return false; });
    Random random(0x5eed0d31);
    const auto draw = boxesIn<float>(-0.7, 0.7, 0.8, 1.2);
    for (int i = 0; i < 200; ++i) {
        world.add(draw(random));
    }
    world.update();
    ASSERT_TRUE(world.pairs.remembersPairs());
    std::vector<ProxyId> sweepers;
    for (int i = 0; i < 300; ++i) {
        sweepers.push_back(world.add(draw(random)));
        if (random.chance(0.8)) {
            world.sweep(sweepers.back(), MovingBox<float>{draw(random), {5, 0, 0}},
                        Sweep::automatic);
        }
    }
    world.refilterAll();
    EXPECT_GT(world.asked().size(), 100'000U);
    world.refilter(std::span(sweepers).first(50));
    EXPECT_GT(world.asked().size(), 20'000U);
}

// What had settled goes in the update from which on the pairs are remembered, after which the mobile ones are to be
// filed again: by the first query, which here would be one of the filter's.
TEST(RefusedPilesAfterSettledOnes, AreAskedAboutAgainByAFilterThatQueries) {
    constexpr int kPiles = 5;
    constexpr int kPerPile = 80;  // so few that they are asked about at once
    const GridConfig config{.cellSize = 2, .slack = 0.1};
    Grid<float> grid(config);
    Pairs<float> pairs(grid);
    Random random(0x5eed0d32);
    const auto placed = [](double x, double y) {
        return boxAround<float>({x, y, 0.5}, {0.5, 0.5, 0.5});
    };
    std::vector<ProxyId> settled;
    for (int i = 0; i < 10; ++i) {
        settled.push_back(grid.add(placed(10 * i, 100)));
    }
    for (int update = 0; update < 60; ++update) {
        for (std::size_t i = 0; i < settled.size(); ++i) {
            const auto x = 10 * static_cast<double>(i);
            grid.move(settled[i], shifted(random, placed(x, 100), 0.01));
        }
        static_cast<void>(pairs.update());
    }
    ASSERT_EQ(pairs.lastCost().grid.resting, settled.size());
    std::vector<ProxyId> piled;
    for (int i = 0; i < kPiles * kPerPile; ++i) {
        const int pile = i / kPerPile;
        piled.push_back(grid.add(placed(20 * pile + 0.7, 0.7)));
    }
    for (const ProxyId id : settled) {
        grid.remove(id);
    }
    static_cast<void>(pairs.update([](ProxyId, ProxyId) { return false; }));
    ASSERT_TRUE(pairs.remembersPairs());
    ASSERT_TRUE(grid.store().tables.mustRefileMobile.load());

    for (std::size_t i = 0; i < piled.size(); i += 10) {
        grid.remove(piled[i]);
    }
    constexpr std::size_t kLeft = kPerPile - kPerPile / 10;
    constexpr std::size_t kPairs = kPiles * (kLeft * (kLeft - 1) / 2);
    static_assert(kPairs > detail::PairState<float>::kPart);
    const PairChanges changes = pairs.refilterAll([&](ProxyId, ProxyId) {
        grid.expectQueries(1);
        return true;
    });
    EXPECT_EQ(changes.born.size(), kPairs);
    EXPECT_EQ(pairs.count(), kPairs);
    EXPECT_EQ(pairs.validate(), "");
}

// What had settled would go, and the mobile ones be filed again by a query, while another one reads them.
TEST(RefusedPilesAfterSettledOnes, ThatACollectorRefusesAreRememberedFromTheNextUpdateOn) {
    const auto refuse = [](ProxyId, ProxyId) { return false; };
    Grid<float> grid({.cellSize = 2, .slack = 0.1});
    Pairs<float> pairs(grid);
    Random random(0x5eed0d33);
    std::vector<ProxyId> settled;
    const auto placed = [&](std::size_t i) {
        return boxAround<float>({10.0 * static_cast<double>(i), 100, 0.5}, {0.5, 0.5, 0.5});
    };
    for (std::size_t i = 0; i < 40; ++i) {
        settled.push_back(grid.add(placed(i)));
    }
    for (int update = 0; update < 60; ++update) {
        for (std::size_t i = 0; i < settled.size(); ++i) {
            grid.move(settled[i], shifted(random, placed(i), 0.01));
        }
        static_cast<void>(pairs.update());
    }
    ASSERT_EQ(pairs.lastCost().grid.resting, settled.size());
    constexpr std::size_t kCount = 300;
    const auto box = makeBox<float>(0, 0, 0, 1, 1, 1);
    std::vector<ProxyId> ids;
    for (std::size_t i = 0; i < kCount; ++i) {
        ids.push_back(grid.add(box));
    }
    EXPECT_EQ(pairs.update().born.size(), kCount * (kCount - 1) / 2);
    ASSERT_FALSE(pairs.remembersPairs());
    const std::uint64_t filings = grid.filingCount();
    std::size_t found = 0;
    CallEach collector{[&](ProxyId, float) {
        if (++found == 1) {
            EXPECT_EQ(pairs.refilterAll(refuse).died.size(), kCount * (kCount - 1) / 2);
        }
        CollectCount within;
        grid.visit(BoxRegion<float>{box}, within);
        EXPECT_EQ(within.count(), kCount);
    }};
    grid.visit(SphereRegion<float>({0, 0, 0}, 1e9F), collector);
    EXPECT_EQ(found, kCount + settled.size());
    EXPECT_EQ(grid.filingCount(), filings);
    EXPECT_FALSE(pairs.remembersPairs());
    grid.move(ids[0], makeBox<float>(0, 0, 0, 1, 1, 2));
    EXPECT_TRUE(pairs.update(refuse).born.empty());
    EXPECT_TRUE(pairs.remembersPairs());
    EXPECT_EQ(pairs.validate(), "");
    EXPECT_EQ(grid.validate(), "");
}

// A pile of pairs is asked in parts once; what follows is as fast as ever.
TEST_F(RefusedPile, WhoseRefusedAreFewRemembersThem) {
    addMany(300);
    accept = [](ProxyId, ProxyId) { return true; };
    EXPECT_EQ(update().born.size(), 300U * 299 / 2);
    EXPECT_FALSE(pairs.remembersPairs());
    EXPECT_EQ(pairs.validate(), "");
    asked = 0;
    moveUpTo(7, 1.5);
    EXPECT_TRUE(update().born.empty());
    EXPECT_EQ(asked, 0U);
}

TEST_F(RefusedPile, OfWhichPairsAreAnnouncedIsBounded) {
    constexpr std::uint32_t kCount = 2000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        addMany(1);
        pairs.findPairsNow(ids.back(), filter);
    }
    EXPECT_GE(asked, std::size_t{kCount} * (kCount - 1) / 2);
    EXPECT_LT(pairs.memoryBytes(), std::size_t{6} << 20);
    update();
    EXPECT_EQ(pairs.validate(), "");
    EXPECT_EQ(pairs.count(), 0U);
}

}  // namespace
}  // namespace hashphase::test
