// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_prices.hpp>

#include <demos/console/format.hpp>
#include <demos/report/frame_clock.hpp>

#include <algorithm>
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
    for (const Effect effect : kAllEffects) {
        if (!declared.contains(effect)) {
            continue;
        }
        for (const auto& [with, without] : {aloneOf(declared, effect), inAllOf(declared, effect)}) {
            for (const EffectSet set : {with, without}) {
                if (std::ranges::find(sets, set) == sets.end()) {
                    sets.push_back(set);
                }
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
            prices_.variants.emplace_back().effects = effects;
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
        addChecks();
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
    }

    void addChecks() {
        std::size_t zeros = 0;
        std::string strays;
        for (const PricedVariant& variant : prices_.variants) {
            const auto look = [&](const auto& items, const auto& numbers, auto first) {
                for (std::size_t i = 0; i < items.size(); ++i) {
                    const SceneItem& item = items[i];
                    if (!item.owners.isEmpty() && !variant.effects.containsAny(item.owners)) {
                        ++zeros;
                        strays += numbers[static_cast<decltype(first)>(i)] == 0
                                      ? ""
                                      : " " + std::string(item.name) + " with " +
                                            namesOf(variant.effects) + ";";
                    }
                }
            };
            look(sceneCounters(), variant.cost, SceneCounter{});
            look(sceneTables(), variant.footprint, SceneTable{});
        }
        prices_.checks = {{"What is not declared does nothing and takes no memory", strays.empty(),
                           strays.empty() ? withThousands(zeros) +
                                                " counters and tables of undeclared effects are 0"
                                          : "not 0:" + strays},
                          {"What is declared finds the same, to the bit, whatever else is declared",
                           differences_ == 0,
                           withThousands(differences_) + " of " + withThousands(comparisons_) +
                               " results differ"}};
    }

    const PricingSettings& settings_;
    EffectsProbe probe_;
    EffectPrices prices_;
    std::vector<std::unique_ptr<EffectsWorld>> worlds_;
    std::size_t comparisons_ = 0;
    std::size_t differences_ = 0;
    int probes_ = 0;
};

Price priceOf(const EffectPrices& prices, const Comparison& compared) {
    const PricedVariant& with = prices.variant(compared.with);
    const PricedVariant& without = prices.variant(compared.without);
    std::vector<double> differences = with.frameMs;
    for (std::size_t i = 0; i < differences.size(); ++i) {
        differences[i] -= without.frameMs[i];
    }
    return {spreadOf(std::move(differences)),
            static_cast<std::int64_t>(totalBytes(with.footprint)) -
                static_cast<std::int64_t>(totalBytes(without.footprint))};
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
    return *std::ranges::find(variants, effects, &PricedVariant::effects);
}

EffectPrices priceEffects(const EffectsFile& file, const PricingSettings& settings) {
    EffectPrices prices = Pricing(file, settings).run();
    const EffectSet declared = file.effects.set();
    for (const Effect effect : kAllEffects) {
        if (declared.contains(effect)) {
            const Comparison inAll = inAllOf(declared, effect);
            prices.prices.push_back({effect, priceOf(prices, aloneOf(declared, effect)),
                                     priceOf(prices, inAll), workOf(prices, effect),
                                     lossOf(prices, effect, inAll.without)});
        }
    }
    return prices;
}

}  // namespace hashphase::demos
