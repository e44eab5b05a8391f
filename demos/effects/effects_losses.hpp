// SPDX-License-Identifier: Zlib
#pragma once

// What an effect does in a scene, and what the scene lacks without it, in words with numbers.

#include <demos/effects/effects_prices.hpp>

#include <string>

namespace hashphase::demos {

/// What the effect did in the whole scene, a frame.
[[nodiscard]] std::string workOf(const EffectPrices& prices, Effect effect);

/// What is wrong, or lacks, in the scene without it, as it was measured: of the variant that has the
/// effects `without`, against the whole.
[[nodiscard]] std::string lossOf(const EffectPrices& prices, Effect effect, EffectSet without);

}  // namespace hashphase::demos
