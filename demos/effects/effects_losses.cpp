// SPDX-License-Identifier: Zlib
#include <demos/console/format.hpp>
#include <demos/effects/effects_prices.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace hashphase::demos {
namespace {

std::string amount(double number, const char* noun) {
    return (number < 9.95 && number != std::floor(number)
                ? fixed(number, 1)
                : withThousands(static_cast<std::uint64_t>(std::llround(number)))) +
           " " + noun;
}

/// Two counters, and what they count.
struct Work {
    Effect effect;
    SceneCounter counter;
    const char* noun;
    SceneCounter counterOfMore{};
    const char* more = nullptr;
};

using enum SceneCounter;
constexpr std::array kWorks{
    Work{Effect::motion, bodiesMoved, "bodies moved"},
    Work{Effect::terrain, groundsAsked, "bodies", trianglesTested, "triangles"},
    Work{Effect::pairs, boxesTested, "boxes tested", pairsBorn, "births"},
    Work{Effect::response, contactsTested, "contacts", contactsSolved, "bounces"},
    Work{Effect::sweep, sweepsSolved, "sweeps", sweepBoxesTested, "boxes"},
    Work{Effect::sleeping, fellAsleep, "fell asleep", wokeUp, "woke"},
    Work{Effect::picking, picks, "rays", pickBoxesTested, "boxes"},
    Work{Effect::boxSelection, selections, "rectangles", selectionBoxesTested, "boxes"},
    Work{Effect::culling, cellRowsCulled, "rows of cells", cullingBoxesTested, "boxes"},
    Work{Effect::proximity, agentsScanned, "agents", neighboursTested, "distances"},
    Work{Effect::zones, zonesTested, "zones", zoneBoxesTested, "boxes"},
    Work{Effect::radar, radarScans, "scans", radarBoxesTested, "boxes"},
};

}  // namespace

double EffectPrices::perFrame(const PricedVariant& of, SceneCounter counter) const {
    return static_cast<double>(of.cost[counter]) /
           static_cast<double>(std::max<std::size_t>(frames, 1));
}

std::string workOf(const EffectPrices& prices, Effect effect) {
    const auto work = std::ranges::find(kWorks, effect, &Work::effect);
    if (work == kWorks.end()) {
        return {};
    }
    const auto text = [&](SceneCounter counter, const char* noun) {
        return amount(prices.perFrame(prices.whole(), counter), noun);
    };
    return text(work->counter, work->noun) +
           (work->more != nullptr ? ", " + text(work->counterOfMore, work->more) : "");
}

std::string lossOf(const EffectPrices& prices, Effect effect, EffectSet without) {
    const PricedVariant& whole = prices.whole();
    const PricedVariant& lacking = prices.variant(without);
    const auto objects = static_cast<double>(prices.file.scene.objects);
    const auto counted = [&](SceneCounter counter, const char* noun) {
        return amount(prices.perFrame(whole, counter), noun);
    };
    const auto late = [&](SceneCounter counter) {
        const double number = prices.perFrame(whole, counter);
        return number > 0 ? "; " + amount(number, "are late with it") : "";
    };
    const auto lateFrames = [&](SceneCounter counter) {
        const double share = prices.perFrame(whole, counter);
        return share > 0 ? "; late in " + fixed(100 * share, 0) + " % of frames with it" : "";
    };
    switch (effect) {
        case Effect::motion:
            return counted(bodiesMoved, "bodies stand still");
        case Effect::terrain:
            return amount(lacking.offGround, "bodies off the ground (") +
                   amount(whole.offGround, "with it)");
        case Effect::pairs:
            return amount(whole.present, "pairs that nobody knows");
        case Effect::response:
            return amount(lacking.interpenetrating, "pairs inside each other (") +
                   amount(whole.interpenetrating, "with it)");
        case Effect::sweep:
            return counted(sweepersStopped, "bodies fly through what they hit");
        case Effect::sleeping:
            return amount(
                prices.perFrame(lacking, bodiesMoved) - prices.perFrame(whole, bodiesMoved),
                "more bodies move where nobody looks");
        case Effect::picking:
            return counted(picks, "clicks without an answer");
        case Effect::boxSelection:
            return counted(selections, "rectangles without an answer");
        case Effect::culling:
            return amount(objects - whole.visible, "bodies drawn in vain") +
                   lateFrames(framesCulledLate);
        case Effect::proximity:
            return amount(objects, "agents that see nobody") + late(agentsLate);
        case Effect::zones:
            return counted(zonesTested, "zones that tell nothing") + late(zonesLate);
        case Effect::radar:
            return "no radar" + lateFrames(radarsLate);
        default:
            return {};
    }
}

}  // namespace hashphase::demos
