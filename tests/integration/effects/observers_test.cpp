// SPDX-License-Identifier: Zlib
//
// Levels of detail: what is declared to be late is, by so much and no more, and the rest is exact.

#include <integration/effects/observers.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <ostream>
#include <set>
#include <vector>

namespace hashphase::test {
namespace {

using Point = Vector3<float>;

/// Agents that walk about, and twins of what looks at them.
class Walk {
public:
    explicit Walk(std::uint64_t seed) : random_(seed) {
        for (int i = 0; i < 400; ++i) {
            places_.push_back(random_.pointIn({0, 0, 0}, {60, 2, 60}).cast<float>());
            ids_.push_back(grid.add(boxAt(places_.back())));
        }
    }
    void step() {
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            places_[i] += random_.pointIn({-0.5, 0, -0.5}, {0.5, 0, 0.5}).cast<float>();
            grid.move(ids_[i], boxAt(places_[i]));
        }
        grid.update();
    }
    [[nodiscard]] const std::vector<Point>& places() const { return places_; }

    Grid<float> grid;

private:
    static Aabb<float> boxAt(const Point& place) {
        return {place - Point::Constant(0.5F), place + Point::Constant(0.5F)};
    }

    Random random_;
    std::vector<Point> places_;
    std::vector<ProxyId> ids_;
};

/// Printed by its settings, not by its bytes, some of which are padding.
struct LateEffect : ProximityEffect {
    friend void PrintTo(const LateEffect& effect, std::ostream* out) {
        *out << "turns " << effect.turns << ", farFrames " << effect.farFrames;
    }
};

/// Far agents look in each nth frame, or in each nth of their turns; the others always, or in turn.
class LateAgents : public testing::TestWithParam<LateEffect> {};

TEST_P(LateAgents, LookWhenTheyAreToAndKeepTheirColourUntilThen) {
    const ProximityEffect& effect = GetParam();
    SceneEffects effects;
    effects.proximity = ProximityEffect{.radius = effect.radius};
    Observers<float> all(effects);
    effects.proximity = effect;
    Observers<float> some(effects);
    const Point player(30, 1, 30);
    some.setInterest(player);
    Walk walk(0x5eed0fef);
    const auto agents = static_cast<std::uint32_t>(walk.places().size());
    for (std::uint32_t frame = 0; frame < 24; ++frame) {
        SCOPED_TRACE(frame);
        if (effect.turns > 1 && frame % 5 == 3) {  // whatever else is declared meanwhile
            effects.culling.emplace();
            some.declare(effects);
        }
        walk.step();
        // The same colours for both, so that those who look take the same.
        std::vector<std::uint32_t> before(agents);
        for (std::uint32_t i = 0; i < agents; ++i) {
            before[i] = (i + frame) % 4;
            all.setColour(i, before[i]);
            some.setColour(i, before[i]);
        }
        all.observe({walk.grid});
        const SceneCost& cost = some.observe({walk.grid});
        std::uint64_t looking = 0;
        for (std::uint32_t i = 0; i < agents; ++i) {
            const double away = static_cast<double>((walk.places()[i] - player).norm());
            const std::uint32_t frames =
                effect.turns * (away > effect.interestRadius ? effect.farFrames : 1);
            // Without turns, all of those who are late look in the same frame.
            const bool looks =
                (effect.turns > 1 ? i % frames == frame % frames : frame % frames == 0);
            looking += looks ? 1 : 0;
            ASSERT_GT(std::abs(away - effect.interestRadius), 1e-5) << "as near as rounding";
            ASSERT_EQ(some.colours()[i], looks ? all.colours()[i] : before[i]) << "agent " << i;
        }
        EXPECT_EQ(cost[SceneCounter::agentsLate], agents - looking);
        EXPECT_TRUE(looking == agents || cost[SceneCounter::agentsScanned] < agents);
        EXPECT_EQ(all.cost()[SceneCounter::agentsLate], 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Observers, LateAgents,
    testing::Values(LateEffect{{.radius = 5, .interestRadius = 15, .farFrames = 4}},
                    LateEffect{{.radius = 5, .turns = 4}},
                    LateEffect{{.radius = 5, .interestRadius = 15, .farFrames = 2, .turns = 3}}));

TEST(Observers, LookIntoFarZonesEachNthFrameAndTellAllThen) {
    SceneEffects effects;
    effects.zones = ZonesEffect{};
    Observers<float> all(effects);
    effects.zones = ZonesEffect{.interestRadius = 10, .farFrames = 3};
    Observers<float> some(effects);
    some.setInterest(Point(0, 0, 0));
    std::vector<ZoneId> zones;
    for (Observers<float>* each : {&all, &some}) {
        zones = {each->zones().add({SphereRegion<float>({5, 0, 5}, 4)}),
                 each->zones().add({SphereRegion<float>({50, 0, 50}, 6)})};
    }
    const ZoneId near = zones[0];
    const ZoneId far = zones[1];
    Walk walk(0x5eed0ff0);
    std::set<ProxyId> inside;  // of the far zone, by the events of those that are late
    for (int frame = 0; frame < 12; ++frame) {
        walk.step();
        all.observe({walk.grid});
        const SceneCost& cost = some.observe({walk.grid});
        EXPECT_EQ(cost[SceneCounter::zonesLate], frame % 3 == 0 ? 0U : 1U);
        EXPECT_EQ(cost[SceneCounter::zonesTested], frame % 3 == 0 ? 2U : 1U);
        for (const ZoneEvent& event : some.zoneEvents().entered) {
            EXPECT_TRUE(event.zone == near || inside.insert(event.proxy).second);
        }
        for (const ZoneEvent& event : some.zoneEvents().left) {
            EXPECT_TRUE(event.zone == near || inside.erase(event.proxy) == 1);
        }
        const auto occupants = [](Observers<float>& observers, ZoneId zone) {
            const auto found = observers.zones().occupants(zone);
            return std::vector<ProxyId>(found.begin(), found.end());
        };
        EXPECT_EQ(occupants(some, near), occupants(all, near));
        EXPECT_EQ(occupants(some, far), std::vector<ProxyId>(inside.begin(), inside.end()));
        if (frame % 3 == 0) {
            EXPECT_EQ(occupants(some, far), occupants(all, far));
        }
    }
    EXPECT_FALSE(inside.empty());
}

TEST(Observers, FindTheViewAnewWhenTheCameraMovesOrItIsTime) {
    SceneEffects effects;
    effects.culling = CullingEffect{.restingCameraFrames = 4};
    Observers<float> observers(effects);
    const auto halfSpace = [](float x) {
        const Eigen::Hyperplane<float, 3> plane(Point(1, 0, 0), -x);
        return ConvexRegion<float>(std::span(&plane, 1));
    };
    Walk walk(0x5eed0ff1);
    std::vector<std::uint64_t> late;
    for (int frame = 0; frame < 10; ++frame) {
        walk.step();
        observers.setView(halfSpace(frame < 6 ? 20 : 30));  // it moves once
        late.push_back(observers.observe({walk.grid})[SceneCounter::framesCulledLate]);
    }
    EXPECT_EQ(late, (std::vector<std::uint64_t>{0, 1, 1, 1, 0, 1, 0, 1, 1, 1}));
}

TEST(Observers, ScanTheRadarEachNthFrame) {
    SceneEffects effects;
    effects.radar = RadarEffect{.cellSize = 3, .frames = 3};
    Observers<float> observers(effects);
    Walk walk(0x5eed0ff2);
    std::uint64_t late = 0;
    std::vector<std::uint32_t> before;
    for (int frame = 0; frame < 9; ++frame) {
        walk.step();
        late += observers.observe({walk.grid})[SceneCounter::radarsLate];
        const auto now = observers.radarCounts();
        const std::vector<std::uint32_t> counts(now.begin(), now.end());
        EXPECT_GT(std::accumulate(counts.begin(), counts.end(), 0U), 0U);
        EXPECT_EQ(counts == before, frame % 3 != 0) << "frame " << frame;
        before = counts;
    }
    EXPECT_EQ(late, 6U);
}

// A scan with more cells than the last one moves its counts, and may run out of memory after that.
TEST(Observers, GiveNoCountsThatAScanHasFreed) {
    Walk walk(0x5eed0ff4);
    walk.step();
    const auto make = [&] {
        SceneEffects effects;
        effects.radar = RadarEffect{.columns = 2, .rows = 2};
        auto observers = std::make_unique<Observers<float>>(effects);
        observers->observe({walk.grid});
        effects.radar = RadarEffect{.columns = 40, .rows = 40};
        observers->declare(effects);
        return observers;
    };
    const std::size_t whole = std::size_t{40} * 40 * RadarEffect{}.groupCount;
    bool hasNone = false;
    bool hasAll = false;
    runOutOfMemory(
        make, [&](Observers<float>& observers) { observers.observe({walk.grid}); },
        [&](const Observers<float>& observers, std::size_t) {
            const auto counts = observers.radarCounts();
            hasNone = hasNone || counts.empty();
            hasAll = hasAll || counts.size() == whole;
            EXPECT_TRUE(counts.empty() || counts.size() == whole);
            std::uint32_t sum = 0;
            for (const std::uint32_t count : counts) {
                sum += count;
            }
            EXPECT_LE(sum, 400U);
        });
    EXPECT_EQ(hasNone, kCountsAllocations);
    EXPECT_TRUE(hasAll);
}

TEST(Observers, FindWhoTakesPart) {
    Walk walk(0x5eed0ff3);
    walk.step();
    SceneEffects effects;
    for (const Effect effect :
         {Effect::culling, Effect::radar, Effect::zones, Effect::proximity, Effect::picking}) {
        effects.declare(effect);
    }
    Observers<float> observers(effects);
    const ZoneId zone = observers.zones().add({SphereRegion<float>({30, 1, 30}, 50)});
    std::vector<EffectSet> takePart(400);
    for (std::size_t i = 0; i < takePart.size(); i += 8) {
        takePart[i] = EffectSet::all();
    }
    const ObservedScene<float> scene{.grid = walk.grid, .effects = takePart};
    const SceneCost& cost = observers.observe(scene);
    EXPECT_EQ(observers.culler().count(), 50U);
    EXPECT_EQ(observers.zones().occupants(zone).size(), 50U);
    EXPECT_EQ(cost[SceneCounter::agentsScanned], 50U);
    const Picked<float> picked =
        observers.pick(scene, {walk.places()[8] - Point(0, 9, 0), walk.places()[8]});
    EXPECT_EQ(picked.id.index % 8, 0U);
    EXPECT_FALSE(picked.id.isNull());

    // Whom nobody may see any more is gone at once.
    const std::vector<EffectSet> nobody(400);
    observers.observe({.grid = walk.grid, .effects = nobody, .present = {}});
    EXPECT_EQ(observers.culler().count(), 0U);
    EXPECT_EQ(observers.zoneEvents().left.size(), 50U);
    const SceneCost& after =
        observers.observe({.grid = walk.grid, .effects = nobody, .present = {}});
    EXPECT_EQ(after[SceneCounter::cullingBoxesTested] + after[SceneCounter::zoneBoxesTested] +
                  after[SceneCounter::radarBoxesTested] + after[SceneCounter::agentsScanned],
              0U);
}

}  // namespace
}  // namespace hashphase::test
