// SPDX-License-Identifier: Zlib
#pragma once

// What each effect of a scene costs: the scene with and without it, frame by frame in turn.
//
// Alone    the effect, what it needs, and motion where the scene has it; less the same without the
//          effect.
// In all   the whole scene; less the scene without the effect and what needs it.

#include <demos/effects/effects_world.hpp>
#include <demos/report/check.hpp>
#include <demos/report/provenance.hpp>
#include <demos/report/statistics.hpp>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// The scene with some of its effects, as it was measured.
struct PricedVariant {
    EffectSet effects;
    std::vector<double> frameMs;  // by measured frame
    SceneCost cost;               // the sum of all measured frames
    SceneFootprint footprint;     // in the end
    double visible = 0;           // these are means of the measured frames: bodies in view
    double present = 0;           // pairs
    double interpenetrating = 0;  // pairs of spheres
    double offGround = 0;         // bodies that should stand on it
    std::optional<double> allocations;
};

struct Price {
    Spread time;  // [ms a frame]
    std::int64_t bytes = 0;
};

/// What an effect costs, and what a scene loses without it.
struct EffectPrice {
    Effect effect{};
    Price alone;
    Price inAll;
    std::string work;  // "10,000 bodies, 12,345 triangles"
    std::string lost;  // without it
};

struct EffectPrices {
    EffectsFile file;
    std::string name;  // of the scene; this and the next are for the caller to fill in
    Provenance provenance;
    std::size_t frames = 0;  // measured
    bool timeLimitHit = false;
    std::vector<PricedVariant> variants;  // the whole scene first, then nothing
    std::vector<EffectPrice> prices;      // in the order of kAllEffects
    std::vector<Check> checks;

    [[nodiscard]] const PricedVariant& whole() const { return variants.front(); }
    /// The variant with these effects, which is among them.
    [[nodiscard]] const PricedVariant& variant(EffectSet effects) const;
    [[nodiscard]] double perFrame(const PricedVariant& of, SceneCounter counter) const;
};

struct PricingSettings {
    std::uint32_t frames = 120;  // measured
    std::uint32_t warmUpFrames = 10;
    std::function<bool()> isTimeUp = [] { return false; };
    std::function<void(std::size_t done, std::string_view what)> tellProgress =
        [](std::size_t, std::string_view) {};
    std::size_t (*allocationCount)() = nullptr;  // where the program counts them
};

[[nodiscard]] EffectPrices priceEffects(const EffectsFile& file, const PricingSettings& settings);

/// How many steps it tells of.
[[nodiscard]] std::size_t pricingSteps(const EffectsFile& file, const PricingSettings& settings);

/// The declaration with those effects alone.
[[nodiscard]] SceneEffects onlyThese(const SceneEffects& effects, EffectSet these);

/// What the effect did in the whole scene, a frame.
[[nodiscard]] std::string workOf(const EffectPrices& prices, Effect effect);

/// What is wrong, or lacks, in the scene without it, as it was measured: of the variant that has the
/// effects `without`, against the whole.
[[nodiscard]] std::string lossOf(const EffectPrices& prices, Effect effect, EffectSet without);

}  // namespace hashphase::demos
