// SPDX-License-Identifier: Zlib
//
// Bodies in a world: that the pairs are right shows in what becomes of them.

#include <demos/stability/cases/cases.hpp>

#include <demos/console/format.hpp>
#include <demos/stability/isolation.hpp>
#include <demos/stability/physics_cases.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace hashphase::demos {
namespace {

// The broadphase of physics_cases.hpp that is meant; nullptr where there is none.
const PhysicsBroadphase* find(const std::vector<PhysicsBroadphase>& all,
                              const CaseContext& context) {
    // In the order that hardBroadphases() promises.
    static constexpr std::array<std::string_view, 6> kNames{
        "hash", "simple", "dbvt", "dbvt-deferred", "", "axis-sweep"};
    const auto at = std::find(kNames.begin(), kNames.end(), context.kind.name);
    const auto place = context.kind.ours ? 0 : at - kNames.begin();
    return place < static_cast<std::ptrdiff_t>(all.size()) ? &all[static_cast<std::size_t>(place)]
                                                           : nullptr;
}

std::string story(const PhysicsOutcome& outcome) {
    const double millimetres = outcome.worstPenetration * 1000;
    return outcome.scene + ": at most " + fixed(millimetres, 1) + " mm deep, " +
           (outcome.settleStep < 0 ? "not at rest"
                                   : "at rest after " + std::to_string(outcome.settleStep)) +
           ", energy +" + fixed(outcome.energyDrift, 2) + " J.";
}

// The worlds with these names, over the broadphase in question, btSimpleBroadphase and btDbvtBroadphase.
CaseOutcome runWorlds(const CaseContext& context, std::span<const std::string_view> names,
                      int quickSize) {
    CaseTally tally;
    for (HardWorld world : hardWorlds()) {
        if (std::find(names.begin(), names.end(), world.name) == names.end()) {
            continue;
        }
        const int steps = context.isQuick ? std::min(world.steps, 400) : world.steps;
        world.size = context.isQuick ? std::min(world.size, quickSize) : world.size;
        const std::vector<PhysicsBroadphase> all = hardBroadphases(world);
        const PhysicsBroadphase* asked = find(all, context);
        if (asked == nullptr) {
            return {};
        }
        std::vector<PhysicsOutcome> outcomes = runPhysicsCase(world, steps, std::array{*asked});
        {
            const LimitPause pause;
            const std::vector<PhysicsOutcome> others =
                runPhysicsCase(world, steps, std::array{all[1], all[2]});
            outcomes.insert(outcomes.end(), others.begin(), others.end());
        }
        tally.expect(outcomes[0].trajectoryHash == outcomes[1].trajectoryHash,
                     world.name + " moves as under btSimpleBroadphase");
        if (context.kind.ours) {
            for (const std::string& fault : faultsOf(outcomes[0], outcomes)) {
                tally.expect(false, fault);
            }
        }
        tally.note(story(outcomes[0]));
    }
    return tally.outcome();
}

CaseOutcome piles(const CaseContext& context) {
    static constexpr std::array<std::string_view, 3> kWorlds{"tower", "pyramid", "cards"};
    return runWorlds(context, kWorlds, 4);
}

CaseOutcome massRatios(const CaseContext& context) {
    static constexpr std::array<std::string_view, 2> kWorlds{"heavy-100", "heavy-1000"};
    return runWorlds(context, kWorlds, 4);
}

constexpr std::array kPhysicsCases{
    HardCase{
        "H36", "a tower, a pyramid, a house of cards",
        "the three worlds of bodies for as many steps as they take to come to rest (--quick: small "
        "ones, 400 steps), over lists in an order that depends on the pairs alone",
        "every body moves as under btSimpleBroadphase, to the last bit, and sleeps no later than "
        "under btDbvtBroadphase",
        piles},
    HardCase{"H37", "heavy bodies on light ones",
             "mass ratios of 100 and 1,000, the heavy ones on top, over such lists",
             "the solver's errors, and no others: every body moves as under btSimpleBroadphase",
             massRatios},
};

}  // namespace

std::span<const HardCase> bodyCases() {
    return kPhysicsCases;
}

}  // namespace hashphase::demos
