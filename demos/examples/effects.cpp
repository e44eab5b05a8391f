// SPDX-License-Identifier: Zlib
//
// A scene declares what it calls for. You should see what 60 frames of the same 2,000 spheres cost, as
// numbers, while more and more effects are declared: exactly 0 for each that is not, and no change of
// the others by one that only looks, as proximity and zones do.

#include <integration/effects/simulation.hpp>

#include <cstdio>
#include <random>

using namespace hashphase;

namespace {

void run(const char* name, const SceneEffects& effects) {
    Simulation<float> simulation(effects);
    std::mt19937 random(1);
    const auto uniform = [&random] { return static_cast<float>(random()) * 0x1p-32F - 0.5F; };
    for (int i = 0; i < 2000; ++i) {
        const Vector3<float> place{uniform(), uniform(), uniform()};
        const Vector3<float> velocity{uniform(), uniform(), uniform()};
        simulation.add({.position = 50 * place, .velocity = 5 * velocity});
    }
    if (effects.zones) {
        (void)simulation.observers().zones().add({SphereRegion<float>({0, 0, 0}, 10)});
    }

    SceneCost sum;
    for (int frame = 0; frame < 60; ++frame) {
        sum += simulation.advance(1.0F / 60);
    }
    const auto number = [&sum](SceneCounter counter) {
        return static_cast<unsigned long long>(sum[counter]);
    };
    std::printf("%-24s %7llu %6llu %7llu %7llu %9llu %6llu %6llu KiB\n", name,
                number(SceneCounter::bodiesMoved), number(SceneCounter::pairsBorn),
                number(SceneCounter::contactsSolved), number(SceneCounter::agentsScanned),
                number(SceneCounter::neighboursTested), number(SceneCounter::zonesTested),
                static_cast<unsigned long long>(totalBytes(simulation.footprint()) / 1024));
}

}  // namespace

int main() {
    std::printf("%-24s %7s %6s %7s %7s %9s %6s %10s\n", "declared", "moved", "pairs", "bounces",
                "agents", "looked at", "zones", "memory");
    SceneEffects effects;
    run("nothing", effects);
    effects.motion.emplace();
    run("motion", effects);
    effects.pairs.emplace();
    run("+ pairs", effects);
    effects.response = ResponseEffect{.restitution = 0.8};
    run("+ response", effects);
    effects.proximity = ProximityEffect{.radius = 5};
    run("+ proximity", effects);
    effects.zones.emplace();
    run("+ zones", effects);
}
