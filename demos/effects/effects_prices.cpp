// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_prices.hpp>

#include <demos/report/frame_clock.hpp>

#include <algorithm>
#include <memory>

namespace hashphase::demos {
namespace {

constexpr std::string_view kEffectsDeclaration =
#include <demos/effects/effects.sql>
    ;

constexpr std::uint32_t kProbedFrames = 20;  // one in so many

/// What an effect's price is taken from.
struct Compared {
    EffectSet alone, aloneWithout, allWithout;
};

Compared comparedFor(EffectSet declared, Effect effect) {
    const EffectSet base = needsOf(effect) | (declared & EffectSet{Effect::motion});
    EffectSet without = declared;
    for (const Effect other : kAllEffects) {
        if (other == effect || needsOf(other).contains(effect)) {
            without.erase(other);
        }
    }
    return {base | EffectSet{effect}, base - EffectSet{effect}, without};
}

/// All that has to run, each once: the whole scene first, then nothing.
std::vector<EffectSet> setsToRun(EffectSet declared) {
    std::vector<EffectSet> sets{declared};
    const auto add = [&sets](EffectSet set) {
        if (std::ranges::find(sets, set) == sets.end()) {
            sets.push_back(set);
        }
    };
    add({});
    for (const Effect effect : kAllEffects) {
        if (declared.contains(effect)) {
            const auto& [alone, aloneWithout, allWithout] = comparedFor(declared, effect);
            add(alone);
            add(aloneWithout);
            add(allWithout);
        }
    }
    return sets;
}

std::string jsonOf(EffectSet effects) {
    std::string text = "[";
    for (const Effect effect : kAllEffects) {
        if (effects.contains(effect)) {
            text += (text.size() > 1 ? ",\"" : "\"") + std::string(nameOf(effect)) + '"';
        }
    }
    return text + "]";
}

class Pricing {
public:
    Pricing(const EffectsFile& file, const PricingSettings& settings)
        : file_(file),
          settings_(settings),
          sets_(setsToRun(file.effects.set())),
          costs_(sets_.size()),
          probe_(file.scene) {
        for (const EffectSet effects : sets_) {
            throwIfInterrupted();
            worlds_.push_back(
                std::make_unique<EffectsWorld>(file.scene, onlyThese(file.effects, effects)));
            measured_.add("variants", {{"effects", namesOf(effects)}, {"list", jsonOf(effects)}});
        }
        // Of a scene without effects, the second has no row, nor has the first one of a run without frames.
        measured_.create("results", {"effect", "differs"});
        measured_.create("compared", {"effect", "alone", "alone_without", "all_without"});
    }

    Measurements run() {
        const std::uint32_t all = settings_.warmUpFrames + settings_.frames;
        bool isStopped = false;
        for (std::uint32_t frame = 0; frame < all && !isStopped; ++frame) {
            isStopped = frames_ > 0 && settings_.limit.isOver();
            if (!isStopped) {
                runFrame(frame);
            }
        }
        addPrices();
        addNumbers();
        measured_.add("run", {{"scene", settings_.scene},
                              {"objects", file_.scene.objects},
                              {"frames", frames_},
                              {"interrupted", isInterrupted()},
                              {"stopped", isStopped ? Datum(settings_.limit.reason()) : Datum()}});
        return std::move(measured_);
    }

private:
    void runFrame(std::uint32_t frame) {
        const bool isMeasured = frame >= settings_.warmUpFrames;
        const std::size_t count = worlds_.size();
        for (std::size_t turn = 0; turn < count; ++turn) {
            const std::size_t i = (turn + frame) % count;
            settings_.tellProgress(frame * count + turn, namesOf(sets_[i]));
            if (frames_ == 0) {
                throwIfInterrupted();
            }
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
            if (frames_ % kProbedFrames == 0) {
                probe();
            }
            ++frames_;
        }
    }

    [[nodiscard]] std::size_t allocationCount() const {
        return settings_.allocationCount != nullptr ? settings_.allocationCount() : 0;
    }

    void note(std::size_t i, double milliseconds, std::size_t allocations) {
        const Simulation<float>& simulation = worlds_[i]->simulation();
        costs_[i] += simulation.cost();
        Datum allocated, visible, pairs;
        if (settings_.allocationCount != nullptr) {
            allocated = allocations;
        }
        if (sets_[i].contains(Effect::culling)) {
            visible = simulation.observers().culler().count();
        }
        if (sets_[i].contains(Effect::pairs)) {
            pairs = simulation.pairCount();
        }
        measured_.add("frames", {{"variant", i + 1},
                                 {"frame", frames_},
                                 {"ms", milliseconds},
                                 {"allocations", allocated},
                                 {"visible", visible},
                                 {"pairs", pairs}});
    }

    /// Of those of which bodies go the same ways, those who look must find the same.
    void compareResults() {
        const EffectsWorld& whole = *worlds_[0];
        for (std::size_t i = 0; i < worlds_.size(); ++i) {
            const EffectSet effects = sets_[i];
            const EffectsWorld& world = *worlds_[i];
            if ((effects & kMovingEffects) != (sets_[0] & kMovingEffects)) {
                continue;
            }
            measured_.add("results", {{"effect", Datum()},
                                      {"differs", world.placesResult() != whole.placesResult()}});
            for (const Effect effect : kAllEffects) {
                if (effects.contains(effect) && !kMovingEffects.contains(effect)) {
                    measured_.add("results",
                                  {{"effect", nameOf(effect)},
                                   {"differs", world.resultOf(effect) != whole.resultOf(effect)}});
                }
            }
        }
    }

    void probe() {
        for (std::size_t i = 0; i < worlds_.size(); ++i) {
            measured_.add("probes", {{"variant", i + 1},
                                     {"interpenetrating", probe_.interpenetrating(*worlds_[i])},
                                     {"off_ground", probe_.offGround(*worlds_[i])}});
        }
    }

    void addPrices() {
        const EffectSet declared = file_.effects.set();
        const auto variantOf = [&](EffectSet effects) {
            return std::ranges::find(sets_, effects) - sets_.begin() + 1;
        };
        for (const Effect effect : kAllEffects) {
            if (declared.contains(effect)) {
                const auto& [alone, aloneWithout, allWithout] = comparedFor(declared, effect);
                measured_.add("compared", {{"effect", nameOf(effect)},
                                           {"alone", variantOf(alone)},
                                           {"alone_without", variantOf(aloneWithout)},
                                           {"all_without", variantOf(allWithout)}});
            }
        }
    }

    void addNumbers() {
        for (std::size_t i = 0; i < sets_.size(); ++i) {
            const auto add = [&](const char* kind, const auto& items, const auto& numbers,
                                 auto first) {
                for (std::size_t item = 0; item < items.size(); ++item) {
                    const auto& [name, owners, description] = items[item];
                    measured_.add(
                        "numbers",
                        {{"variant", i + 1},
                         {"kind", kind},
                         {"name", name},
                         {"number", numbers[static_cast<decltype(first)>(item)]},
                         {"is_declared", owners.isEmpty() || sets_[i].containsAny(owners)}});
                }
            };
            add("counter", sceneCounters(), costs_[i], SceneCounter{});
            add("table", sceneTables(), worlds_[i]->simulation().footprint(), SceneTable{});
        }
    }

    const EffectsFile& file_;
    const PricingSettings& settings_;
    std::vector<EffectSet> sets_;
    std::vector<std::unique_ptr<EffectsWorld>> worlds_;  // of each
    std::vector<SceneCost> costs_;                       // the sums of all measured frames
    EffectsProbe probe_;
    std::size_t frames_ = 0;  // measured
    Measurements measured_;
};

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

Measurements priceEffects(const EffectsFile& file, const PricingSettings& settings) {
    return Pricing(file, settings).run();
}

Findings effectsFindings(Measurements& measured) {
    return findingsOf(kEffectsDeclaration, measured);
}

}  // namespace hashphase::demos
