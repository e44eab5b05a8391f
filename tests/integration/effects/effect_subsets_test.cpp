// SPDX-License-Identifier: Zlib
//
// Every subset of the effects, on a small scene: what is not declared costs exactly nothing, and what is
// declared gives the same results, to the bit, whatever else is.

#include <integration/effects/simulation.hpp>
#include <tests/integration/effects/small_scene.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

/// The results of one effect in a run, or of all that changes where bodies are, as numbers.
using Results = std::vector<std::uint64_t>;

struct SceneRun {
    std::map<Effect, Results> found;  // by those that look
    Results places;
    SceneCost cost;
    SceneFootprint footprint;
    std::string broken;
};

void append(Results& results, const Vector3<float>& point) {
    for (int axis = 0; axis < 3; ++axis) {
        results.push_back(std::bit_cast<std::uint32_t>(point[axis]));
    }
}

void append(Results& results, std::span<const ZoneEvent> events) {
    results.push_back(events.size());
    for (const ZoneEvent& event : events) {
        results.push_back(std::uint64_t{event.zone.index} << 32 | event.proxy.index);
    }
}

void append(Results& results, std::span<const ProxyPair> pairs) {
    results.push_back(pairs.size());
    for (const ProxyPair& pair : pairs) {
        results.push_back(std::uint64_t{pair.first.index} << 32 | pair.second.index);
    }
}

void askWhenAsked(Simulation<float>& simulation, EffectSet declared, SceneRun& run) {
    if (declared.contains(Effect::picking)) {
        simulation.grid().expectRays(1000);  // else so few walk through cells
        const Picked<float> picked = simulation.pick({{0, 1.5F, 0}, {20, 1.5F, 20}});
        run.found[Effect::picking].push_back(picked.id.index);
        append(run.found[Effect::picking], picked.point);
    }
    if (declared.contains(Effect::boxSelection)) {
        std::vector<ProxyId> selected;
        simulation.select(smallSceneView(), {100, 100}, {500, 400}, selected);
        for (const ProxyId id : selected) {
            run.found[Effect::boxSelection].push_back(id.index);
        }
        run.found[Effect::boxSelection].push_back(~std::uint64_t{0});
    }
}

void readFrame(const Simulation<float>& simulation, EffectSet declared, SceneRun& run) {
    const Observers<float>& observers = simulation.observers();
    if (declared.contains(Effect::culling)) {
        observers.culler().forEach(
            [&](std::uint32_t index) { run.found[Effect::culling].push_back(index); });
        run.found[Effect::culling].push_back(~std::uint64_t{0});
    }
    if (declared.contains(Effect::proximity)) {
        const auto colours = observers.colours();
        run.found[Effect::proximity].insert(run.found[Effect::proximity].end(), colours.begin(),
                                            colours.end());
    }
    if (declared.contains(Effect::zones)) {
        append(run.found[Effect::zones], observers.zoneEvents().entered);
        append(run.found[Effect::zones], observers.zoneEvents().stayed);
        append(run.found[Effect::zones], observers.zoneEvents().left);
    }
    if (declared.contains(Effect::radar)) {
        const auto counts = observers.radarCounts();
        run.found[Effect::radar].insert(run.found[Effect::radar].end(), counts.begin(),
                                        counts.end());
    }
    if (declared.contains(Effect::pairs)) {
        append(run.found[Effect::pairs], simulation.pairChanges().born);
        append(run.found[Effect::pairs], simulation.pairChanges().died);
    }
}

/// Some frames of the small scene, with what is declared; `forced` runs though it is not.
SceneRun runScene(EffectSet declared, EffectSet forced = {}) {
    constexpr int kFrames = 4;
    Simulation<float> simulation(smallSceneEffects(declared | forced));
    fill(simulation, 120);  // so many that cells are worth while
    SceneRun run;
    for (int frame = 0; frame < kFrames; ++frame) {
        askWhenAsked(simulation, declared | forced, run);
        run.cost += simulation.advance(0.05F);
        readFrame(simulation, declared, run);
    }
    for (std::uint32_t body = 0; body < simulation.size(); ++body) {
        append(run.places, simulation.position({body, 1}));
        if (declared.contains(Effect::motion)) {
            append(run.places, simulation.velocity({body, 1}));
        }
    }
    run.footprint = simulation.footprint();
    run.broken = simulation.validate();
    return run;
}

/// Says what of a run belongs to effects that are not declared; empty when all is well.
std::string strayOf(EffectSet declared, const SceneRun& run) {
    for (std::size_t i = 0; i < kSceneCounterCount; ++i) {
        const SceneItem& item = sceneCounters()[i];
        if (!declared.containsAny(item.owners) && run.cost[static_cast<SceneCounter>(i)] != 0) {
            return std::string(item.name) + " is not 0";
        }
    }
    for (std::size_t i = 0; i < kSceneTableCount; ++i) {
        const SceneItem& item = sceneTables()[i];
        if (!item.owners.isEmpty() && !declared.containsAny(item.owners) &&
            run.footprint[static_cast<SceneTable>(i)] != 0) {
            return std::string(item.name) + " takes memory";
        }
    }
    return {};
}

template <class Visit>
void forEachSubset(const Visit& visit) {
    std::vector<Effect> effects;
    for (const Effect effect : kAllEffects) {
        if (kSimulated.contains(effect)) {
            effects.push_back(effect);
        }
    }
    for (std::uint32_t bits = 0; bits < 1U << effects.size(); ++bits) {
        EffectSet subset;
        for (std::size_t i = 0; i < effects.size(); ++i) {
            if ((bits >> i & 1) != 0) {
                subset.insert(effects[i]);
            }
        }
        visit(subset);
    }
}

TEST(EffectSubsets, CostNothingThatIsNotDeclaredAndChangeNoResultThatIs) {
    std::map<std::string, Results> placesOf;  // by what changes places
    std::map<std::string, Results> foundBy;   // by that, and by who looks
    std::size_t runCount = 0;
    forEachSubset([&](EffectSet declared) {
        if (!effectsError(smallSceneEffects(declared)).empty()) {
            return;
        }
        ++runCount;
        const SceneRun run = runScene(declared);
        const std::string names = namesOf(declared);
        ASSERT_EQ(strayOf(declared, run), "") << "declared: " << names;
        ASSERT_EQ(run.broken, "") << "declared: " << names;
        const std::string dynamics = namesOf(declared & kMovingEffects);
        const auto [places, isNew] = placesOf.emplace(dynamics, run.places);
        ASSERT_TRUE(isNew || places->second == run.places)
            << "bodies went elsewhere because of " << names;
        for (const auto& [effect, results] : run.found) {
            const auto [found, isFirst] =
                foundBy.emplace(dynamics + ": " + std::string(nameOf(effect)), results);
            ASSERT_TRUE(isFirst || found->second == results)
                << nameOf(effect) << " found something else because of " << names;
        }
    });
    EXPECT_GT(runCount, 1000U);
}

// Else nobody would notice that something is missing above.
TEST(EffectSubsets, AllHaveSomethingToDo) {
    const SceneRun run = runScene(kSimulated);
    const std::vector<std::string_view> quiet{"framesCulledLate", "agentsLate", "zonesLate",
                                              "radarsLate",       "wokeUp",     "sleepersAsked"};
    for (std::size_t i = 0; i < kSceneCounterCount; ++i) {
        const std::string_view name = sceneCounters()[i].name;
        if (std::find(quiet.begin(), quiet.end(), name) == quiet.end()) {
            EXPECT_GT(run.cost[static_cast<SceneCounter>(i)], 0U) << name;
        }
    }
    for (std::size_t i = 0; i < kSceneTableCount; ++i) {
        EXPECT_GT(run.footprint[static_cast<SceneTable>(i)], 0U) << sceneTables()[i].name;
    }
}

// What the test above is worth: a phase that is forced on is noticed.
TEST(EffectSubsets, NoticeAPhaseThatIsForcedOn) {
    for (const Effect forced : kAllEffects) {
        EffectSet declared = kSimulated;
        declared.erase(forced);
        if (!kSimulated.contains(forced) || !effectsError(smallSceneEffects(declared)).empty()) {
            continue;  // others need it
        }
        EXPECT_NE(strayOf(declared, runScene(declared, {forced})), "") << nameOf(forced);
    }
    const EffectSet pairs{Effect::motion, Effect::pairs};
    EXPECT_NE(strayOf({Effect::motion}, runScene({Effect::motion}, pairs)), "");
    EXPECT_NE(strayOf({}, runScene({}, {Effect::motion})), "");
}

}  // namespace
}  // namespace hashphase::test
