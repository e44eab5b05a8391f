// SPDX-License-Identifier: Zlib

#include <integration/effects/scene_cost.hpp>
#include <integration/effects/scene_effects.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

SceneEffects everything() {
    SceneEffects effects;
    for (const Effect effect : kAllEffects) {
        effects.declare(effect);
    }
    return effects;
}

TEST(EffectSet, IsASet) {
    EffectSet set{Effect::pairs, Effect::zones};
    EXPECT_TRUE(set.contains(Effect::pairs));
    EXPECT_FALSE(set.contains(Effect::motion));
    set.insert(Effect::motion);
    set.erase(Effect::pairs);
    EXPECT_EQ(set, (EffectSet{Effect::zones, Effect::motion}));
    EXPECT_EQ(namesOf(set), "motion, zones");
    EXPECT_EQ(namesOf({}), "nothing");
    EXPECT_EQ(set | EffectSet{Effect::radar},
              (EffectSet{Effect::zones, Effect::motion, Effect::radar}));
    EXPECT_EQ(set & EffectSet{Effect::zones}, EffectSet{Effect::zones});
    EXPECT_EQ(set - EffectSet{Effect::zones}, EffectSet{Effect::motion});
    EXPECT_TRUE(EffectSet::all().containsAny(set));
    EXPECT_FALSE(set.containsAny({Effect::radar}));
    EXPECT_TRUE(EffectSet().isEmpty());
    std::set<std::string_view> names;
    for (const Effect effect : kAllEffects) {
        EXPECT_TRUE(EffectSet::all().contains(effect));
        names.insert(nameOf(effect));
    }
    EXPECT_EQ(names.size(), kAllEffects.size());
}

TEST(SceneEffects, TellsWhatIsDeclared) {
    SceneEffects effects;
    EXPECT_TRUE(effects.set().isEmpty());
    effects.declare(Effect::zones);
    effects.zones->farFrames = 7;
    effects.declare(Effect::zones);
    EXPECT_EQ(effects.zones->farFrames, 7U);  // declared already
    effects.declare(Effect::motion);
    EXPECT_EQ(effects.set(), (EffectSet{Effect::zones, Effect::motion}));
    effects.remove(Effect::zones);
    EXPECT_FALSE(effects.zones);
    EXPECT_EQ(everything().set(), EffectSet::all());
    EXPECT_EQ(effectsError(everything()), "");
    EXPECT_EQ(effectsError({}), "");
}

TEST(SceneEffects, TellsWhatEachNeeds) {
    EXPECT_EQ(needsOf(Effect::friction),
              (EffectSet{Effect::response, Effect::pairs, Effect::motion}));
    EXPECT_TRUE(needsOf(Effect::culling).isEmpty());
    for (const Effect effect : kAllEffects) {
        SceneEffects effects;
        effects.declare(effect);
        EXPECT_EQ(effectsError(effects).empty(), needsOf(effect).isEmpty()) << nameOf(effect);
        for (const Effect needed : kAllEffects) {
            if (needsOf(effect).contains(needed)) {
                effects.declare(needed);
            }
        }
        EXPECT_EQ(effectsError(effects), "");
    }
}

TEST(SceneEffects, NamesWhatContradictsItself) {
    const auto errorWithout = [](Effect effect) {
        SceneEffects effects = everything();
        effects.remove(effect);
        return effectsError(effects);
    };
    EXPECT_EQ(errorWithout(Effect::motion),
              "terrain is declared without motion, but it puts moved bodies on the ground. Declare "
              "motion too, or leave out terrain.");
    EXPECT_EQ(errorWithout(Effect::pairs),
              "response is declared without pairs, but it acts on pairs. Declare pairs too, or "
              "leave out response.");
    EXPECT_EQ(errorWithout(Effect::response),
              "friction is declared without response, but it acts between bodies that bounce off "
              "each other. Declare response too, or leave out friction.");
    for (const Effect effect : {Effect::terrain, Effect::sweep, Effect::sleeping, Effect::rotation,
                                Effect::friction, Effect::picking, Effect::boxSelection,
                                Effect::culling, Effect::proximity, Effect::zones, Effect::radar}) {
        EXPECT_EQ(errorWithout(effect), "");
    }
}

template <class Change>
std::string errorAfter(const Change& change) {
    SceneEffects effects = everything();
    change(effects);
    return effectsError(effects);
}

TEST(SceneEffects, NamesTheSettingThatIsWrong) {
    EXPECT_EQ(errorAfter([](SceneEffects& e) { e.response->restitution = 1.5; }),
              "response.restitution is 1.5, but must be between 0 and 1.");
    EXPECT_EQ(errorAfter([](SceneEffects& e) { e.sweep->mode = Sweep::none; }),
              "sweep.mode is none, but must be automatic, box or line. To sweep nothing, leave out "
              "sweep.");
    EXPECT_EQ(errorAfter([](SceneEffects& e) { e.sweep->fastFrom = kNan; }),
              "sweep.fastFrom is nan, but must be 0 or more diameters a frame.");
    EXPECT_EQ(errorAfter([](SceneEffects& e) { e.proximity->farFrames = 4; }),
              "proximity.farFrames is 4, but no distance counts as far. Set "
              "proximity.interestRadius too [m].");
    EXPECT_EQ(errorAfter([](SceneEffects& e) { e.proximity->turns = 0; }),
              "proximity.turns is 0, but must be from 1 to 1000000.");
    EXPECT_EQ(errorAfter([](SceneEffects& e) { e.proximity->colourCount = 33; }),
              "proximity.colourCount is 33, but must be from 1 to 32.");
    EXPECT_EQ(errorAfter([](SceneEffects& e) { e.zones->farFrames = 0; }),
              "zones.farFrames is 0, but must be from 1 to 1000000.");
    EXPECT_EQ(
        errorAfter([](SceneEffects& e) { e.radar->columns = 1U << 31; }),
        "radar: columns * rows * groupCount is 6.87195e+10, but must be from 1 to 268435456.");
    EXPECT_EQ(errorAfter([](SceneEffects& e) { e.grid.levelRatio = 1; }),
              "GridConfig::levelRatio is 1, but must be between 2 and 64.");
}

TEST(SceneEffects, AcceptsNoSettingOutOfItsRange) {
    const std::vector<void (*)(SceneEffects&)> changes{
        [](SceneEffects& e) {
            e.motion->bounds.min().x() = 1;
            e.motion->bounds.max().x() = 0;
        },
        [](SceneEffects& e) { e.motion->bounds.max().y() = kNan; },
        [](SceneEffects& e) { e.response->restitution = kNan; },
        [](SceneEffects& e) { e.sweep->fastFrom = -1; },
        [](SceneEffects& e) { e.sleeping->interestRadius = kNan; },
        [](SceneEffects& e) { e.sleeping->slowBelow = -1; },
        [](SceneEffects& e) { e.sleeping->framesBeforeSleep = 0; },
        [](SceneEffects& e) { e.culling->margin = kInfinity; },
        [](SceneEffects& e) { e.culling->restingCameraFrames = 0; },
        [](SceneEffects& e) { e.proximity->radius = -1; },
        [](SceneEffects& e) { e.proximity->colourCount = 0; },
        [](SceneEffects& e) { e.proximity->interestRadius = -1; },
        [](SceneEffects& e) { e.zones->interestRadius = kNan; },
        [](SceneEffects& e) { e.radar->cellSize = 0; },
        [](SceneEffects& e) { e.radar->cellSize = 1e-300; },
        [](SceneEffects& e) { e.culling->margin = 1e300; },
        [](SceneEffects& e) { e.motion->bounds.min().x() = kInfinity; },
        [](SceneEffects& e) { e.motion->bounds.max().z() = -1e300; },
        [](SceneEffects& e) { e.radar->groupCount = 0; },
        [](SceneEffects& e) { e.radar->frames = 0; },
    };
    for (std::size_t i = 0; i < changes.size(); ++i) {
        EXPECT_NE(errorAfter(changes[i]), "") << i;
    }
}

TEST(SceneCost, NamesEverythingOnce) {
    std::set<std::string_view> names;
    for (const SceneItem& item : sceneCounters()) {
        names.insert(item.name);
        EXPECT_FALSE(item.description.empty()) << item.name;
        EXPECT_FALSE(item.owners.isEmpty()) << item.name;
    }
    for (const SceneItem& item : sceneTables()) {
        names.insert(item.name);
        EXPECT_FALSE(item.description.empty()) << item.name;
    }
    names.erase("");
    // pairs, zones and the like name a table each, no counter.
    EXPECT_EQ(names.size(), kSceneCounterCount + kSceneTableCount);
    EXPECT_EQ(sceneCounters().back().name, "radarsLate");  // as the last enumerator
    EXPECT_EQ(sceneTables().back().name, "groups");
    EXPECT_EQ(static_cast<std::size_t>(SceneCounter::radarsLate) + 1, kSceneCounterCount);
    EXPECT_EQ(static_cast<std::size_t>(SceneTable::groups) + 1, kSceneTableCount);
}

}  // namespace
}  // namespace hashphase::test
