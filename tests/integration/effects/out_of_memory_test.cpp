// SPDX-License-Identifier: Zlib
//
// Memory runs out at every allocation, and then is there again: nothing is torn.

#include <tests/integration/effects/small_scene.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <vector>

namespace hashphase::test {
namespace {

constexpr float kShortStep = 1.0F / 64;

TEST(SimulationOutOfMemory, AddsABodyWhollyOrNotAtAll) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "allocations do not fail under a sanitizer";
    }
    for (const EffectSet declared : {kSimulated, EffectSet{Effect::motion}}) {
        const std::size_t failures = runOutOfMemory(
            [&] { return std::make_unique<Simulation<float>>(smallSceneEffects(declared)); },
            [](Simulation<float>& simulation) {
                for (int i = 0; i < 20; ++i) {
                    simulation.add({.position = {1.5F * static_cast<float>(i), 1, 0}});
                }
            },
            [](Simulation<float>& simulation, std::size_t) {
                const std::size_t count = simulation.size();
                simulation.add({.position = {0, 1, 5}});
                EXPECT_EQ(simulation.size(), count + 1);
                simulation.advance(kShortStep);
                EXPECT_EQ(simulation.validate(), "");
            });
        EXPECT_GT(failures, 5U);
    }
}

TEST(SimulationOutOfMemory, GoesOnAfterAFrameThatFailed) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "allocations do not fail under a sanitizer";
    }
    const std::size_t failures = runOutOfMemory(
        [] {
            auto simulation = std::make_unique<Simulation<float>>(smallSceneEffects(kSimulated));
            fill(*simulation);
            return simulation;
        },
        [](Simulation<float>& simulation) {
            for (int frame = 0; frame < 3; ++frame) {
                simulation.advance(kShortStep);
            }
        },
        [](Simulation<float>& simulation, std::size_t) {
            simulation.advance(kShortStep);
            simulation.advance(kShortStep);
            EXPECT_EQ(simulation.validate(), "");
        });
    EXPECT_GT(failures, 20U);
}

TEST(SimulationOutOfMemory, GoesOnAfterADeclarationThatFailed) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "allocations do not fail under a sanitizer";
    }
    const EffectSet few{Effect::motion, Effect::culling};
    const std::size_t failures = runOutOfMemory(
        [&] {
            auto simulation = std::make_unique<Simulation<float>>(smallSceneEffects(few));
            fill(*simulation);
            simulation->advance(kShortStep);
            return simulation;
        },
        [](Simulation<float>& simulation) { simulation.declare(smallSceneEffects(kSimulated)); },
        [&](Simulation<float>& simulation, std::size_t) {
            EXPECT_EQ(simulation.observers().declared().set(), simulation.declared().set());
            if (simulation.declared().set() == few) {
                const SceneFootprint bytes = simulation.footprint();
                for (const SceneTable of : {SceneTable::sleepers, SceneTable::walkers,
                                            SceneTable::pairs, SceneTable::zones}) {
                    EXPECT_EQ(bytes[of], 0U) << "nothing has changed";
                }
            } else {
                EXPECT_EQ(simulation.declared().set(), kSimulated) << "the rest is made later";
            }
            simulation.advance(kShortStep);
            EXPECT_EQ(simulation.validate(), "");
            simulation.declare(smallSceneEffects(kSimulated));
            simulation.advance(kShortStep);
            EXPECT_EQ(simulation.validate(), "");
        });
    EXPECT_GT(failures, 20U);
}

}  // namespace
}  // namespace hashphase::test
