// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_losses.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

std::string amount(double number) {
    return number < 9.95 && number != std::floor(number)
               ? fixed(number, 1)
               : withThousands(static_cast<std::uint64_t>(std::llround(number)));
}

/// Numbers of the whole scene, a frame.
class PerFrame {
public:
    explicit PerFrame(const EffectPrices& prices)
        : cost_(prices.whole().cost), frames_(static_cast<double>(prices.frames)) {}

    [[nodiscard]] double operator()(SceneCounter counter) const {
        return static_cast<double>(cost_[counter]) / std::max(frames_, 1.0);
    }
    [[nodiscard]] std::string text(SceneCounter counter, const char* noun) const {
        return amount((*this)(counter)) + " " + noun;
    }

private:
    const SceneCost& cost_;
    double frames_;
};

std::string lateText(double late, const char* what) {
    return late > 0 ? "; " + amount(late) + " " + what : std::string();
}

std::string lateFramesText(double share) {
    return share > 0 ? "; late in " + fixed(100 * share, 0) + " % of frames with it"
                     : std::string();
}

std::string lossOfLooking(const EffectPrices& prices, Effect effect, const PerFrame& whole) {
    const auto objects = static_cast<double>(prices.file.scene.objects);
    switch (effect) {
        case Effect::picking:
            return whole.text(SceneCounter::picks, "clicks without an answer");
        case Effect::boxSelection:
            return whole.text(SceneCounter::selections, "rectangles without an answer");
        case Effect::culling:
            return amount(objects - prices.whole().visible) + " bodies drawn in vain" +
                   lateFramesText(whole(SceneCounter::framesCulledLate));
        case Effect::proximity:
            return amount(objects) + " agents that see nobody" +
                   lateText(whole(SceneCounter::agentsLate), "are late with it");
        case Effect::zones:
            return whole.text(SceneCounter::zonesTested, "zones that tell nothing") +
                   lateText(whole(SceneCounter::zonesLate), "are late with it");
        case Effect::radar:
            return "no radar" + lateFramesText(whole(SceneCounter::radarsLate));
        default:
            return {};
    }
}

}  // namespace

std::string workOf(const EffectPrices& prices, Effect effect) {
    const PerFrame whole(prices);
    using enum SceneCounter;
    switch (effect) {
        case Effect::motion:
            return whole.text(bodiesMoved, "bodies moved");
        case Effect::terrain:
            return whole.text(groundsAsked, "bodies, ") + whole.text(trianglesTested, "triangles");
        case Effect::pairs:
            return whole.text(boxesTested, "boxes tested, ") + whole.text(pairsBorn, "births");
        case Effect::response:
            return whole.text(contactsTested, "contacts, ") + whole.text(contactsSolved, "bounces");
        case Effect::sweep:
            return whole.text(sweepsSolved, "sweeps, ") + whole.text(sweepBoxesTested, "boxes");
        case Effect::sleeping:
            return whole.text(fellAsleep, "fell asleep, ") + whole.text(wokeUp, "woke");
        case Effect::picking:
            return whole.text(picks, "rays, ") + whole.text(pickBoxesTested, "boxes");
        case Effect::boxSelection:
            return whole.text(selections, "rectangles, ") +
                   whole.text(selectionBoxesTested, "boxes");
        case Effect::culling:
            return whole.text(cellRowsCulled, "rows of cells, ") +
                   whole.text(cullingBoxesTested, "boxes");
        case Effect::proximity:
            return whole.text(agentsScanned, "agents, ") +
                   whole.text(neighboursTested, "distances");
        case Effect::zones:
            return whole.text(zonesTested, "zones, ") + whole.text(zoneBoxesTested, "boxes");
        case Effect::radar:
            return whole.text(radarScans, "scans, ") + whole.text(radarBoxesTested, "boxes");
        default:
            return {};
    }
}

std::string lossOf(const EffectPrices& prices, Effect effect, EffectSet without) {
    const PerFrame whole(prices);
    const PricedVariant& lacking = prices.variant(without);
    switch (effect) {
        case Effect::motion:
            return whole.text(SceneCounter::bodiesMoved, "bodies stand still");
        case Effect::terrain:
            return amount(lacking.offGround) + " bodies off the ground (" +
                   amount(prices.whole().offGround) + " with it)";
        case Effect::pairs:
            return amount(prices.whole().present) + " pairs that nobody knows";
        case Effect::response:
            return amount(lacking.interpenetrating) + " pairs inside each other (" +
                   amount(prices.whole().interpenetrating) + " with it)";
        case Effect::sweep:
            return whole.text(SceneCounter::sweepersStopped, "bodies fly through what they hit");
        case Effect::sleeping: {
            const auto moved = static_cast<double>(lacking.cost[SceneCounter::bodiesMoved]) /
                               std::max(static_cast<double>(prices.frames), 1.0);
            return amount(moved - whole(SceneCounter::bodiesMoved)) +
                   " more bodies move where nobody looks";
        }
        default:
            return lossOfLooking(prices, effect, whole);
    }
}

}  // namespace hashphase::demos
