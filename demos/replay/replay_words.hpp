// SPDX-License-Identifier: Zlib
#pragma once

// What a replay says in words.

#include <demos/scenes/pair_key.hpp>

#include <broadphase/aabb.hpp>

#include <string>

namespace hashphase::demos {

/// "Objects 3 and 17 overlap by 0.25 along y, but their pair is missing: 3 is [0 0 0 to 1 1 1], ..."
[[nodiscard]] std::string wrongPairWords(PairKey pair, bool isMissing, const Aabb<float>& first,
                                         const Aabb<float>& second);

}  // namespace hashphase::demos
