// SPDX-License-Identifier: Zlib
//
// What effects take of memory, to the byte, and that a frame like the last one takes none.

#include <tests/integration/effects/small_scene.hpp>
#include <tests/support/count_allocations.hpp>

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

using Point = Vector3<float>;

/// Bodies that go side by side on a plain: boxes overlap, spheres do not touch. So they go the same
/// way whatever is declared.
void fillCalmly(Simulation<float>& simulation) {
    const EffectSet declared = simulation.declared().set();
    for (int i = 0; i < 12; ++i) {
        for (int k = 0; k < 12; ++k) {
            const Vector3<float> place(1.5F * static_cast<float>(i) + (k % 2 == 0 ? 0 : 0.75F),
                                       0.5F, 0.95F * static_cast<float>(k));
            simulation.add({.position = place, .radius = 0.5F, .velocity = {1, 0, 0.25F}});
        }
    }
    if (declared.contains(Effect::terrain)) {
        const std::vector<Point> corners{Point(-99, 0, -99), Point(99, 0, -99), Point(-99, 0, 99),
                                         Point(99, 0, -99),  Point(99, 0, 99),  Point(-99, 0, 99)};
        simulation.ground().add(corners);
    }
    if (declared.contains(Effect::zones)) {
        static_cast<void>(
            simulation.observers().zones().add({SphereRegion<float>({10, 1, 10}, 5)}));
    }
}

void runCalmly(Simulation<float>& simulation, int frames) {
    for (int frame = 0; frame < frames; ++frame) {
        if (simulation.declared().picking) {
            static_cast<void>(simulation.pick({{-9, 0.5F, 1}, {30, 0.5F, 1}}));
        }
        simulation.advance(1.0F / 64);
    }
}

std::vector<EffectSet> someSubsets() {
    const EffectSet base{Effect::motion, Effect::pairs};
    std::vector<EffectSet> subsets{{}, {Effect::motion}, base, kSimulated};
    for (const Effect a : kAllEffects) {
        for (const Effect b : kAllEffects) {
            const EffectSet subset = base | EffectSet{a, b};
            if (a <= b && (subset - kSimulated).isEmpty()) {
                subsets.push_back(subset);
            }
        }
    }
    return subsets;
}

TEST(Footprint, IsThatOfEachEffectAddedUpToTheByte) {
    std::map<std::size_t, std::uint64_t> bytesOf;  // by table
    for (const EffectSet declared : someSubsets()) {
        if (!declared.contains(Effect::pairs)) {
            continue;  // without motion, and without pairs, other things happen
        }
        Simulation<float> simulation(test::declared(declared));
        fillCalmly(simulation);
        runCalmly(simulation, 12);
        ASSERT_EQ(simulation.cost()[SceneCounter::contactsSolved], 0U);
        const SceneFootprint footprint = simulation.footprint();
        for (std::size_t i = 0; i < kSceneTableCount; ++i) {
            const SceneItem& item = sceneTables()[i];
            const std::uint64_t bytes = footprint[static_cast<SceneTable>(i)];
            if (item.owners.isEmpty() || declared.containsAny(item.owners)) {
                const auto [known, isNew] = bytesOf.emplace(i, bytes);
                EXPECT_EQ(bytes, known->second) << item.name << " with " << namesOf(declared);
            } else {
                EXPECT_EQ(bytes, 0U) << item.name << " with " << namesOf(declared);
            }
        }
    }
}

TEST(Footprint, IsWhatTheHeapHolds) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    for (const EffectSet declared : someSubsets()) {
        const std::size_t before = bytesHeld();
        const auto simulation = std::make_unique<Simulation<float>>(test::declared(declared));
        fillCalmly(*simulation);
        runCalmly(*simulation, 12);
        EXPECT_EQ(totalBytes(simulation->footprint()), bytesHeld() - before) << namesOf(declared);
    }
}

TEST(Footprint, OfWhatIsTakenBackIsGone) {
    Simulation<float> simulation(declared(kSimulated));
    fillCalmly(simulation);
    runCalmly(simulation, 3);
    const EffectSet few{Effect::motion, Effect::culling};
    simulation.declare(declared(few));
    runCalmly(simulation, 3);
    for (std::size_t i = 0; i < kSceneTableCount; ++i) {
        const SceneItem& item = sceneTables()[i];
        EXPECT_EQ(simulation.footprint()[static_cast<SceneTable>(i)] > 0,
                  item.owners.isEmpty() || few.containsAny(item.owners))
            << item.name;
    }
    EXPECT_EQ(simulation.validate(), "");
}

TEST(EffectsFrame, LikeTheLastOneAllocatesNothing) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    for (const EffectSet declared : someSubsets()) {
        Simulation<float> simulation(smallSceneEffects(declared));
        fill(simulation);
        for (int frame = 0; frame < 400; ++frame) {
            simulation.advance(0.002F);
        }
        const std::size_t before = allocationCount();
        for (int frame = 0; frame < 20; ++frame) {
            simulation.advance(0.002F);
        }
        EXPECT_EQ(allocationCount() - before, 0U) << namesOf(declared);
    }
}

}  // namespace
}  // namespace hashphase::test
