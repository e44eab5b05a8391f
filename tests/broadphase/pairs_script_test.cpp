// SPDX-License-Identifier: Zlib

// Random scripts over every scene: after each update the pairs are those of brute force, and what
// was reported on the way was true.

#include <tests/support/handlers.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/population.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class PairsInScripts : public testing::Test {
protected:
    using Frame = std::function<void(Script<Scalar>&, PairWorld<Scalar>&)>;

    /// A script by so many frames, each of which eachFrame() ends.
    static void play(const BoxScene<Scalar>& scene, const GridConfig& config, std::uint64_t seed,
                     const ScriptRates& rates, int frames, const Frame& eachFrame) {
        SCOPED_TRACE(testing::Message()
                     << scene.name << ", cell size " << config.cellSize << ", seed " << seed);
        Script<Scalar> script(scene, seed, rates);
        PairWorld<Scalar> world(config,
                                [&script](ProxyId a, ProxyId b) { return script.accepts(a, b); });
        script.begin(world);
        for (int frame = 0; frame < frames && !testing::Test::HasFailure(); ++frame) {
            SCOPED_TRACE(testing::Message() << "frame " << frame);
            if (frame > 0) {
                script.playFrame(world);
            }
            eachFrame(script, world);
        }
    }
    /// The same in every scene.
    static void playAll(const GridConfig& config, std::uint64_t seed, const ScriptRates& rates,
                        int frames, const Frame& eachFrame) {
        for (const BoxScene<Scalar>& scene : allBoxScenes<Scalar>()) {
            play(scene, config, seed, rates, scene.count > 300 ? frames / 2 : frames, eachFrame);
        }
    }
    static void updateAndCheck(Script<Scalar>& script, PairWorld<Scalar>& world) {
        world.update();
        world.checkThoroughly(script.proxies());
    }

private:
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PairsInScripts, Scalars);

// Automatic; sensible; and two that fit nothing.
constexpr std::array<double, 4> kCellSizes{0, 1.5, 1e-3, 1e4};

TYPED_TEST(PairsInScripts, EqualBruteForceInEveryScene) {
    for (const double cellSize : kCellSizes) {
        this->playAll({.cellSize = cellSize}, 0x5eed0001, {}, 80, this->updateAndCheck);
    }
}

TYPED_TEST(PairsInScripts, EqualBruteForceWhenTheFilterRefusesAndChangesItsMind) {
    this->playAll({}, 0x5eed0002, {.recolour = 0.02}, 120, this->updateAndCheck);
}

TYPED_TEST(PairsInScripts, EqualBruteForceWithAnySlack) {
    for (const double slack : {0.0, 0.01, 0.3, 1e30}) {
        this->playAll({.updatesBeforeRest = 2, .slack = slack}, 0x5eed0008, {.recolour = 0.004}, 60,
                      this->updateAndCheck);
    }
}

TYPED_TEST(PairsInScripts, EqualBruteForceWhereEverythingComesToRestAndWakesAgain) {
    const ScriptRates rates{.fallAsleep = 0.4, .recolour = 0.004, .replace = 0.005};
    this->playAll({.updatesBeforeRest = 1}, 0x5eed0003, rates, 3 * Script<TypeParam>::kPeriod,
                  this->updateAndCheck);
}

TYPED_TEST(PairsInScripts, AreNotDisturbedByQueriesAndAnnouncementsInBetween) {
    std::size_t found = 0;
    const auto askAndUpdate = [&](auto& script, auto& world) {
        // Queries file what waits; some proxies are told their pairs at once.
        for (const Placed<TypeParam>& proxy : script.proxies()) {
            if (script.random().chance(0.05)) {
                found += find(world.grid, BoxRegion<TypeParam>{proxy.box}).size();
                world.findPairsNow(proxy.id);
            }
        }
        this->updateAndCheck(script, world);
    };
    this->playAll({}, 0x5eed0004, {.recolour = 0.01}, 100, askAndUpdate);
    EXPECT_GT(found, 1000U);
}

TYPED_TEST(PairsInScripts, EqualBruteForceWhereSomeAreIgnored) {
    const auto ignoreAndUpdate = [&](auto& script, auto& world) {
        const std::vector<ProxyPair> present(world.set().begin(), world.set().end());
        for (const ProxyPair& pair : present) {
            const bool areAlive =
                world.grid.contains(pair.first) && world.grid.contains(pair.second);
            if (areAlive && script.random().chance(0.1)) {
                world.ignore(pair);
            }
        }
        std::vector<ProxyPair> ignored;
        world.pairs.collectIgnored(ignored);
        for (const ProxyPair& pair : ignored) {
            if (script.random().chance(0.1)) {
                world.stopIgnoring(pair);
            }
        }
        this->updateAndCheck(script, world);
    };
    for (const double slack : {0.0, 0.01}) {
        this->playAll({.updatesBeforeRest = 2, .slack = slack}, 0x5eed0009, {.recolour = 0.01}, 60,
                      ignoreAndUpdate);
    }
}

TYPED_TEST(PairsInScripts, EqualBruteForceWhenTheyComeLateAndGo) {
    const auto renewAndUpdate = [&](auto& script, auto& world) {
        if (script.random().chance(0.2)) {
            world.renewPairs(script.random().chance(0.5));
        }
        if (script.random().chance(0.1) && !script.proxies().empty()) {
            world.findPairsNow(script.proxies().front().id);
        }
        this->updateAndCheck(script, world);
    };
    this->playAll({.updatesBeforeRest = 1}, 0x5eed0007, {.recolour = 0.004},
                  2 * Script<TypeParam>::kPeriod, renewAndUpdate);
}

TYPED_TEST(PairsInScripts, EqualBruteForceInACrowd) {
    BoxScene<TypeParam> scene = spreadScene<TypeParam>("crowd", 2, 100);
    scene.count = 2000;
    for (const double cellSize : kCellSizes) {
        this->play(scene, {.cellSize = cellSize}, 0x5eed0005, {}, 12,
                   [](auto& script, auto& world) {
                       world.update();
                       world.check(script.proxies());
                   });
    }
}

TYPED_TEST(PairsInScripts, AreTheSameSequenceInEveryRunHoweverBoxesAreFiled) {
    const auto record = [this](const GridConfig& config) {
        std::vector<ProxyPair> sequence;
        this->play(spreadScene<TypeParam>("evenly spread", 1, 0), config, 0x5eed0006, {}, 60,
                   [&](auto&, auto& world) {
                       const PairChanges changes = world.update();
                       sequence.insert(sequence.end(), changes.born.begin(), changes.born.end());
                       sequence.insert(sequence.end(), changes.died.begin(), changes.died.end());
                   });
        return sequence;
    };
    const std::vector<ProxyPair> first = record({});
    EXPECT_GT(first.size(), 1000U);
    EXPECT_EQ(record({}), first);
    EXPECT_EQ(record({.cellSize = 0.7}), first);
}

// --- Change by change ----------------------------------------------------------------------------

/// Which proxies overlap, or are pairs: by index, a bit for each other one.
using Rows = std::array<std::uint64_t, 64>;

void setPair(Rows& rows, ProxyId a, ProxyId b, bool isPair) {
    const auto set = [&](std::uint64_t& row, std::uint32_t other) {
        row = isPair ? row | std::uint64_t{1} << other : row & ~(std::uint64_t{1} << other);
    };
    set(rows.at(a.index), b.index);
    set(rows.at(b.index), a.index);
}

/// On a lattice, so that many touch, or anywhere; some as large as the room.
template <class Scalar>
Aabb<Scalar> drawTouching(Random& random) {
    const bool isOnLattice = random.chance(0.5);
    Vector3<double> low = random.pointIn(-3, 3);
    low = isOnLattice ? Vector3<double>(low.array().floor()) : low;
    const double size = random.chance(0.05) ? 5 : 1;
    return {low.cast<Scalar>(), (low.array() + size).matrix().template cast<Scalar>()};
}

/// Adds, moves or removes one of a few; so few do not change that a box may come to rest.
template <class Scalar>
Placed<Scalar> changeOne(Population<Scalar>& world) {
    constexpr std::uint32_t kMost = 24;
    Random& random = world.random;
    const std::uint32_t i = random.below(kMost);
    const double choice = random.unit();
    if (i >= world.proxies.size()) {
        world.add(drawTouching<Scalar>(random),
                  choice < 0.3 ? Mobility::resting : Mobility::mobile);
        return world.proxies.back();
    }
    if (choice < 0.1) {
        const Placed<Scalar> gone = world.proxies[i];
        world.removeAt(i);
        return gone;
    }
    if (choice < 0.9) {
        world.moveTo(i, choice < 0.5 ? shifted(random, world.proxies[i].box, 0.3)
                                     : drawTouching<Scalar>(random));
    }
    return world.proxies[i];
}

// With an update after each: half a million in each precision.
TYPED_TEST(PairsInScripts, EqualBruteForceAfterEachOfAMillionChanges) {
    constexpr int kChanges = 125'000;
    for (const double cellSize : kCellSizes) {
        SCOPED_TRACE(cellSize);
        Population<TypeParam> world(GridConfig{.cellSize = cellSize, .updatesBeforeRest = 2});
        Pairs<TypeParam> pairs(world.grid);
        Rows expected{};
        Rows present{};
        std::size_t births = 0;
        for (int change = 0; change < kChanges; ++change) {
            const Placed<TypeParam> changed = changeOne(world);
            for (const Placed<TypeParam>& other : world.proxies) {
                if (other.id != changed.id) {
                    const bool isThere = world.grid.contains(changed.id);
                    setPair(expected, changed.id, other.id,
                            isThere && overlaps(changed.box, other.box));
                }
            }
            const PairChanges changes = pairs.update();
            for (const ProxyPair& pair : changes.died) {
                ASSERT_NE(present.at(pair.first.index) >> pair.second.index & 1, 0U) << change;
                setPair(present, pair.first, pair.second, false);
            }
            for (const ProxyPair& pair : changes.born) {
                ASSERT_EQ(present.at(pair.first.index) >> pair.second.index & 1, 0U) << change;
                setPair(present, pair.first, pair.second, true);
            }
            births += changes.born.size();
            ASSERT_EQ(present, expected) << change;
            ASSERT_EQ(change % 1000 == 0 ? world.grid.validate() + pairs.validate() : "", "");
        }
        EXPECT_GT(births, std::size_t{kChanges} / 2);
    }
}

}  // namespace
}  // namespace hashphase::test
