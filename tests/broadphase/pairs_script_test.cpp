// SPDX-License-Identifier: Zlib

// Random scripts over every scene: after each update the pairs are those of brute force, and what
// was reported on the way was true.

#include <tests/support/handlers.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class PairsInScripts : public testing::Test {
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PairsInScripts, Scalars);

GridConfig withCellSize(double cellSize) {
    GridConfig config;
    config.cellSize = cellSize;
    return config;
}

// Automatic; sensible; and two that fit nothing.
constexpr std::array<double, 4> kCellSizes{0, 1.5, 1e-3, 1e4};

template <class Scalar, class EachFrame>
void play(const BoxScene<Scalar>& scene, const GridConfig& config, std::uint64_t seed,
          const ScriptRates& rates, int frames, EachFrame&& eachFrame) {
    SCOPED_TRACE(testing::Message()
                 << scene.name << ", cell size " << config.cellSize << ", seed " << seed);
    Script<Scalar> script(scene, seed, rates);
    PairWorld<Scalar> world(config,
                            [&script](ProxyId a, ProxyId b) { return script.accepts(a, b); });
    script.begin(world);
    for (int frame = 0; frame < frames; ++frame) {
        SCOPED_TRACE(testing::Message() << "frame " << frame);
        if (frame > 0) {
            script.playFrame(world);
        }
        eachFrame(script, world);
        if (testing::Test::HasFatalFailure()) {
            return;
        }
    }
}

TYPED_TEST(PairsInScripts, EqualBruteForceInEveryScene) {
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        for (const double cellSize : kCellSizes) {
            const int frames = scene.count > 300 ? 40 : 80;
            play(scene, withCellSize(cellSize), 0x5eed0001, {}, frames,
                 [](auto& script, auto& world) {
                     world.update();
                     world.checkThoroughly(script.proxies());
                 });
            if (this->HasFatalFailure()) {
                return;
            }
        }
    }
}

TYPED_TEST(PairsInScripts, EqualBruteForceWhenTheFilterRefusesAndChangesItsMind) {
    ScriptRates rates;
    rates.recolour = 0.02;
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        play(scene, {}, 0x5eed0002, rates, 120, [](auto& script, auto& world) {
            world.update();
            world.checkThoroughly(script.proxies());
        });
        if (this->HasFatalFailure()) {
            return;
        }
    }
}

TYPED_TEST(PairsInScripts, EqualBruteForceWhereEverythingComesToRestAndWakesAgain) {
    ScriptRates rates;
    rates.fallAsleep = 0.4;
    rates.replace = 0.005;
    rates.recolour = 0.004;
    GridConfig config;
    config.updatesBeforeRest = 1;
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        play(scene, config, 0x5eed0003, rates, 3 * Script<TypeParam>::kPeriod,
             [](auto& script, auto& world) {
                 world.update();
                 world.checkThoroughly(script.proxies());
             });
        if (this->HasFatalFailure()) {
            return;
        }
    }
}

TYPED_TEST(PairsInScripts, AreNotDisturbedByQueriesAndAnnouncementsInBetween) {
    ScriptRates rates;
    rates.recolour = 0.01;
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        std::size_t found = 0;
        play(scene, {}, 0x5eed0004, rates, 100, [&found](auto& script, auto& world) {
            // Queries file what waits; some proxies are told their pairs at once.
            for (const Placed<TypeParam>& proxy : script.proxies()) {
                if (script.random().chance(0.05)) {
                    CollectCount count;
                    world.grid.visit(BoxRegion<TypeParam>{proxy.box}, count);
                    found += count.count();
                    world.announce(proxy.id);
                }
            }
            world.update();
            world.checkThoroughly(script.proxies());
        });
        EXPECT_GT(found, 0U);
        if (this->HasFatalFailure()) {
            return;
        }
    }
}

TYPED_TEST(PairsInScripts, EqualBruteForceInACrowd) {
    BoxScene<TypeParam> scene = spreadScene<TypeParam>("crowd", 2, 100);
    scene.count = 2000;
    for (const double cellSize : kCellSizes) {
        play(scene, withCellSize(cellSize), 0x5eed0005, {}, 12, [](auto& script, auto& world) {
            world.update();
            world.check(script.proxies());
        });
        if (this->HasFatalFailure()) {
            return;
        }
    }
}

TYPED_TEST(PairsInScripts, AreTheSameSequenceInEveryRun) {
    const auto record = [](const GridConfig& config) {
        std::vector<ProxyPair> sequence;
        play(spreadScene<TypeParam>("evenly spread", 1, 0), config, 0x5eed0006, {}, 60,
             [&sequence](auto&, auto& world) {
                 const PairChanges changes = world.update();
                 sequence.insert(sequence.end(), changes.born.begin(), changes.born.end());
                 sequence.insert(sequence.end(), changes.died.begin(), changes.died.end());
             });
        return sequence;
    };
    const std::vector<ProxyPair> first = record({});
    EXPECT_GT(first.size(), 1000U);
    EXPECT_EQ(record({}), first);
    // Nor do they depend on how the boxes are filed.
    EXPECT_EQ(record(withCellSize(0.7)), first);
}

}  // namespace
}  // namespace hashphase::test
