// SPDX-License-Identifier: Zlib
#pragma once

// What each effect of a scene costs: the scene with and without it, frame by frame in turn.
//
// Alone    the effect, what it needs, and motion where the scene has it; less the same without the
//          effect.
// In all   the whole scene; less the scene without the effect and what needs it.

#include <demos/effects/effects_world.hpp>
#include <demos/experiment/findings.hpp>
#include <demos/report/time_limit.hpp>

#include <functional>
#include <string>
#include <string_view>

namespace hashphase::demos {

struct PricingSettings {
    std::string scene;           // its name
    std::uint32_t frames = 120;  // measured
    std::uint32_t warmUpFrames = 10;
    TimeLimit limit{std::nullopt};  // beyond it no frame begins, but one is measured at least
    std::function<void(std::size_t done, std::string_view what)> tellProgress =
        [](std::size_t, std::string_view) {};
    std::size_t (*allocationCount)() = nullptr;  // where the program counts them
};

/// What was measured, as rows that effects.sql names. Throws Interrupted before the first frame is measured.
[[nodiscard]] Measurements priceEffects(const EffectsFile& file, const PricingSettings& settings);

/// How many steps it tells of.
[[nodiscard]] std::size_t pricingSteps(const EffectsFile& file, const PricingSettings& settings);

/// The price list that effects.sql makes of it.
[[nodiscard]] Findings effectsFindings(Measurements& measured);

/// The declaration with those effects alone.
[[nodiscard]] SceneEffects onlyThese(const SceneEffects& effects, EffectSet these);

}  // namespace hashphase::demos
