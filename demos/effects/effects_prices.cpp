// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_prices.hpp>

#include <demos/console/format.hpp>
#include <demos/effects/effects_losses.hpp>
#include <demos/effects/effects_probe.hpp>
#include <demos/report/frame_clock.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

namespace hashphase::demos {
namespace {

constexpr std::uint32_t kProbedFrames = 20;  // one in so many

/// What of an effect's price is taken from what.
struct Comparison {
    EffectSet with;
    EffectSet without;
};

Comparison aloneOf(EffectSet declared, Effect effect) {
    const EffectSet base = needsOf(effect) | (declared & EffectSet{Effect::motion});
    return {base | EffectSet{effect}, base - EffectSet{effect}};
}

Comparison inAllOf(EffectSet declared, Effect effect) {
    EffectSet without = declared;
    for (const Effect other : kAllEffects) {
        if (other == effect || needsOf(other).contains(effect)) {
            without.erase(other);
        }
    }
    return {declared, without};
}

/// All that has to run, each once: the whole scene first, then nothing.
std::vector<EffectSet> setsToRun(EffectSet declared) {
    std::vector<EffectSet> sets{declared, {}};
    const auto add = [&sets](EffectSet set) {
        if (std::find(sets.begin(), sets.end(), set) == sets.end()) {
            sets.push_back(set);
        }
    };
    for (const Effect effect : kAllEffects) {
        if (declared.contains(effect)) {
            for (const auto& [with, without] :
                 {aloneOf(declared, effect), inAllOf(declared, effect)}) {
                add(with);
                add(without);
            }
        }
    }
    return sets;
}

class Pricing {
public:
    Pricing(const EffectsFile& file, const PricingSettings& settings)
        : settings_(settings), probe_(file.scene) {
        prices_.file = file;
        for (const EffectSet effects : setsToRun(file.effects.set())) {
            worlds_.push_back(
                std::make_unique<EffectsWorld>(file.scene, onlyThese(file.effects, effects)));
            prices_.variants.emplace_back();
            prices_.variants.back().effects = effects;
        }
    }

    EffectPrices run() {
        const std::uint32_t all = settings_.warmUpFrames + settings_.frames;
        for (std::uint32_t frame = 0; frame < all; ++frame) {
            if (settings_.isTimeUp() && prices_.frames > 0) {
                prices_.timeLimitHit = true;
                break;
            }
            runFrame(frame);
        }
        finish();
        return std::move(prices_);
    }

private:
    void runFrame(std::uint32_t frame) {
        const bool isMeasured = frame >= settings_.warmUpFrames;
        const std::size_t count = worlds_.size();
        for (std::size_t turn = 0; turn < count; ++turn) {
            const std::size_t i = (turn + frame) % count;
            settings_.tellProgress(frame * count + turn, namesOf(prices_.variants[i].effects));
            EffectsWorld& world = *worlds_[i];
            world.beginFrame(frame);
            const std::size_t allocations = allocationCount();
            const FrameClock clock;
            world.runFrame();
            const double milliseconds = clock.milliseconds();
            if (isMeasured) {
                note(i, milliseconds, allocationCount() - allocations);
            }
        }
        if (isMeasured) {
            compareResults();
            if (prices_.frames % kProbedFrames == 0) {
                probe();
            }
            ++prices_.frames;
        }
    }

    [[nodiscard]] std::size_t allocationCount() const {
        return settings_.allocationCount != nullptr ? settings_.allocationCount() : 0;
    }

    void note(std::size_t i, double milliseconds, std::size_t allocations) {
        PricedVariant& variant = prices_.variants[i];
        const Simulation<float>& simulation = worlds_[i]->simulation();
        variant.frameMs.push_back(milliseconds);
        variant.cost += simulation.cost();
        if (settings_.allocationCount != nullptr) {
            variant.allocations =
                variant.allocations.value_or(0) + static_cast<double>(allocations);
        }
        if (variant.effects.contains(Effect::culling)) {
            variant.visible += static_cast<double>(simulation.observers().culler().count());
        }
        if (variant.effects.contains(Effect::pairs)) {
            variant.present += static_cast<double>(simulation.pairCount());
        }
    }

    /// Of those of which bodies go the same ways, those who look must find the same.
    void compareResults() {
        for (std::size_t i = 0; i < worlds_.size(); ++i) {
            const EffectSet effects = prices_.variants[i].effects;
            if ((effects & kMovingEffects) != (prices_.whole().effects & kMovingEffects)) {
                continue;
            }
            differences_ += worlds_[i]->placesResult() != worlds_[0]->placesResult() ? 1 : 0;
            for (const Effect effect : kAllEffects) {
                if (effects.contains(effect) && !kMovingEffects.contains(effect)) {
                    ++comparisons_;
                    differences_ +=
                        worlds_[i]->resultOf(effect) != worlds_[0]->resultOf(effect) ? 1 : 0;
                }
            }
        }
    }

    void probe() {
        for (std::size_t i = 0; i < worlds_.size(); ++i) {
            PricedVariant& variant = prices_.variants[i];
            variant.interpenetrating += static_cast<double>(probe_.interpenetrating(*worlds_[i]));
            variant.offGround += static_cast<double>(probe_.offGround(*worlds_[i]));
        }
        ++probes_;
    }

    void finish() {
        const auto frames = static_cast<double>(std::max<std::size_t>(prices_.frames, 1));
        for (std::size_t i = 0; i < worlds_.size(); ++i) {
            PricedVariant& variant = prices_.variants[i];
            variant.footprint = worlds_[i]->simulation().footprint();
            variant.visible /= frames;
            variant.present /= frames;
            variant.interpenetrating /= std::max(probes_, 1);
            variant.offGround /= std::max(probes_, 1);
            if (variant.allocations) {
                *variant.allocations /= frames;
            }
        }
        addChecks();
    }

    void addChecks();

    const PricingSettings& settings_;
    EffectsProbe probe_;
    EffectPrices prices_;
    std::vector<std::unique_ptr<EffectsWorld>> worlds_;
    std::size_t comparisons_ = 0;
    std::size_t differences_ = 0;
    int probes_ = 0;
};

void Pricing::addChecks() {
    std::size_t zeros = 0;
    std::string strays;
    const auto look = [&](const PricedVariant& variant, const SceneItem& item,
                          std::uint64_t number) {
        if (item.owners.isEmpty() || variant.effects.containsAny(item.owners)) {
            return;
        }
        ++zeros;
        if (number != 0) {
            strays += " " + std::string(item.name) + " with " + namesOf(variant.effects) + ";";
        }
    };
    for (const PricedVariant& variant : prices_.variants) {
        for (std::size_t i = 0; i < kSceneCounterCount; ++i) {
            look(variant, sceneCounters()[i], variant.cost[static_cast<SceneCounter>(i)]);
        }
        for (std::size_t i = 0; i < kSceneTableCount; ++i) {
            look(variant, sceneTables()[i], variant.footprint[static_cast<SceneTable>(i)]);
        }
    }
    prices_.checks.push_back(
        {"What is not declared does nothing and takes no memory", strays.empty(),
         strays.empty() ? withThousands(zeros) + " counters and tables of undeclared effects are 0"
                        : "not 0:" + strays});
    prices_.checks.push_back(
        {"What is declared finds the same, to the bit, whatever else is declared",
         differences_ == 0,
         withThousands(differences_) + " of " + withThousands(comparisons_) + " results differ"});
}

}  // namespace

std::size_t pricingSteps(const EffectsFile& file, const PricingSettings& settings) {
    const std::size_t framesOfEach = std::size_t{settings.frames} + settings.warmUpFrames;
    return framesOfEach * setsToRun(file.effects.set()).size();
}

SceneEffects onlyThese(const SceneEffects& effects, EffectSet these) {
    SceneEffects some = effects;
    for (const Effect effect : kAllEffects) {
        if (!these.contains(effect)) {
            some.remove(effect);
        } else {
            some.declare(effect);
        }
    }
    return some;
}

const PricedVariant& EffectPrices::variant(EffectSet effects) const {
    return *std::find_if(variants.begin(), variants.end(),
                         [&](const PricedVariant& each) { return each.effects == effects; });
}

EffectPrices priceEffects(const EffectsFile& file, const PricingSettings& settings) {
    EffectPrices prices = Pricing(file, settings).run();
    const EffectSet declared = file.effects.set();
    const auto difference = [&](const Comparison& compared) {
        const PricedVariant& with = prices.variant(compared.with);
        const PricedVariant& without = prices.variant(compared.without);
        std::vector<double> differences;
        for (std::size_t i = 0; i < with.frameMs.size(); ++i) {
            differences.push_back(with.frameMs[i] - without.frameMs[i]);
        }
        return spreadOf(std::move(differences));
    };
    const auto bytes = [&](const Comparison& compared) {
        return static_cast<std::int64_t>(totalBytes(prices.variant(compared.with).footprint)) -
               static_cast<std::int64_t>(totalBytes(prices.variant(compared.without).footprint));
    };
    for (const Effect effect : kAllEffects) {
        if (declared.contains(effect)) {
            const Comparison alone = aloneOf(declared, effect);
            const Comparison inAll = inAllOf(declared, effect);
            EffectPrice price;
            price.effect = effect;
            price.alone = difference(alone);
            price.inAll = difference(inAll);
            price.bytesAlone = bytes(alone);
            price.bytesInAll = bytes(inAll);
            price.work = workOf(prices, effect);
            price.lost = lossOf(prices, effect, inAll.without);
            prices.prices.push_back(std::move(price));
        }
    }
    return prices;
}

}  // namespace hashphase::demos
