// SPDX-License-Identifier: Zlib

// Random scripts over every scene: after each update the pairs are those of brute force, and what
// was reported on the way was true.

#include <tests/support/handlers.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
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
                    world.findPairsNow(proxy.id);
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

TYPED_TEST(PairsInScripts, EqualBruteForceWhenTheyComeLateAndGo) {
    ScriptRates rates;
    rates.recolour = 0.004;
    GridConfig config;
    config.updatesBeforeRest = 1;
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        std::size_t born = 0;
        play(scene, config, 0x5eed0007, rates, 2 * Script<TypeParam>::kPeriod,
             [&born](auto& script, auto& world) {
                 if (script.random().chance(0.2)) {
                     world.renewPairs(script.random().chance(0.5));
                 }
                 if (script.random().chance(0.1) && !script.proxies().empty()) {
                     world.findPairsNow(script.proxies().front().id);
                 }
                 born += world.update().born.size();
                 world.checkThoroughly(script.proxies());
             });
        EXPECT_GT(born, 0U) << scene.name;
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

// --- Change by change ----------------------------------------------------------------------------

/// A few boxes that come, move and go, and who overlaps whom: by brute force, and as the pairs
/// report births and deaths.
template <class Scalar>
class SmallWorld {
public:
    static constexpr std::uint32_t kObjects = 24;

    SmallWorld(const GridConfig& config, std::uint64_t seed)
        : random_(seed), grid_(config), pairs_(grid_) {}

    /// Most of them move; so few do not change that a box may come to rest.
    void changeOne() {
        const std::uint32_t object = random_.below(kObjects);
        const double choice = random_.unit();
        if (ids_[object].isNull()) {
            boxes_[object] = draw();
            ids_[object] =
                grid_.add(boxes_[object], choice < 0.3 ? Mobility::resting : Mobility::mobile);
            objectOf_.resize(std::max<std::size_t>(objectOf_.size(), ids_[object].index + 1));
            objectOf_[ids_[object].index] = object;
        } else if (choice < 0.1) {
            grid_.remove(ids_[object]);
            ids_[object] = {};
        } else if (choice < 0.9) {
            boxes_[object] = choice < 0.5 ? shifted(random_, boxes_[object], 0.3) : draw();
            grid_.move(ids_[object], boxes_[object]);
        }
        for (std::uint32_t other = 0; other < kObjects; ++other) {
            set(expected_, object, other,
                other != object && !ids_[object].isNull() && !ids_[other].isNull() &&
                    overlaps(boxes_[object], boxes_[other]));
        }
    }

    /// False when a birth or a death is reported that is none.
    [[nodiscard]] bool update() {
        const PairChanges changes = pairs_.update([](ProxyId, ProxyId) { return true; });
        bool isTrue = true;
        for (const bool isBirth : {false, true}) {
            for (const ProxyPair& pair : isBirth ? changes.born : changes.died) {
                const std::uint32_t a = objectOf_[pair.first.index];
                const std::uint32_t b = objectOf_[pair.second.index];
                isTrue = isTrue && ((present_[a] >> b) & 1) == (isBirth ? 0U : 1U);
                set(present_, a, b, isBirth);
            }
        }
        births += changes.born.size();
        return isTrue;
    }

    [[nodiscard]] bool isLikeBruteForce() const {
        std::size_t count = 0;
        for (const std::uint32_t others : expected_) {
            count += static_cast<std::size_t>(std::popcount(others));
        }
        return present_ == expected_ && 2 * pairs_.count() == count;
    }
    [[nodiscard]] std::string validate() const { return grid_.validate() + pairs_.validate(); }

    std::size_t births = 0;

private:
    using Row = std::array<std::uint32_t, kObjects>;  // a bit for each other object

    static void set(Row& row, std::uint32_t a, std::uint32_t b, bool isPair) {
        row[a] = isPair ? row[a] | 1U << b : row[a] & ~(1U << b);
        row[b] = isPair ? row[b] | 1U << a : row[b] & ~(1U << a);
    }
    /// On a lattice, so that many touch, or anywhere; some as large as the room.
    Aabb<Scalar> draw() {
        const bool isOnLattice = random_.chance(0.5);
        Vector3<double> low = random_.pointIn(-3, 3);
        low = isOnLattice ? Vector3<double>(low.array().floor()) : low;
        const double size = random_.chance(0.05) ? 5 : 1;
        return {low.cast<Scalar>(), (low.array() + size).matrix().template cast<Scalar>()};
    }

    Random random_;
    Grid<Scalar> grid_;
    Pairs<Scalar> pairs_;
    std::array<ProxyId, kObjects> ids_{};
    std::array<Aabb<Scalar>, kObjects> boxes_;
    std::vector<std::uint32_t> objectOf_;  // by the index of its proxy
    Row expected_{};
    Row present_{};
};

// With an update after each: half a million in each precision.
TYPED_TEST(PairsInScripts, EqualBruteForceAfterEachOfAMillionChanges) {
    constexpr int kChanges = 125'000;
    for (const double cellSize : kCellSizes) {
        SCOPED_TRACE(cellSize);
        GridConfig config = withCellSize(cellSize);
        config.updatesBeforeRest = 2;
        SmallWorld<TypeParam> world(config, 0x5eed0007);
        for (int change = 0; change < kChanges; ++change) {
            world.changeOne();
            ASSERT_TRUE(world.update()) << change;
            ASSERT_TRUE(world.isLikeBruteForce()) << change;
            if (change % 1000 == 0) {
                ASSERT_EQ(world.validate(), "") << change;
            }
        }
        EXPECT_GT(world.births, std::size_t{kChanges} / 2);
    }
}

}  // namespace
}  // namespace hashphase::test
