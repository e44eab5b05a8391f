// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/scenes/world_scenes.hpp>
#include <demos/viewer/session/scene_choice.hpp>
#include <demos/viewer/session/stage_queries.hpp>
#include <demos/viewer/stage/stage.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace hashphase::demos {

inline const BroadphaseKind& kindNamed(std::string_view name) {
    return rowNamed("broadphase", name, broadphaseKinds());
}

inline const WorldSceneKind& worldNamed(std::string_view name) {
    return rowNamed("scene", name, worldSceneKinds());
}

inline SceneEffects worldEffects() {
    SceneEffects effects;
    for (const Effect effect :
         {Effect::motion, Effect::pairs, Effect::response, Effect::sleeping, Effect::rotation,
          Effect::friction, Effect::picking, Effect::boxSelection, Effect::culling}) {
        effects.declare(effect);
    }
    return effects;
}

inline void expectPairs(const Stage& stage, bool exact, const std::string& when) {
    const PairCheck check = checkPairs(stage);
    EXPECT_TRUE(check.missing.empty()) << when;
    EXPECT_TRUE(!exact || check.extra.empty()) << when;
}

/// As many agents of each colour as of any other.
inline void expectEvenColours(const Stage& stage) {
    std::array<std::uint32_t, ProximityEffect().colourCount> counts{};
    for (const std::uint32_t colour : stage.observers().colours()) {
        ++counts.at(colour);
    }
    const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
    EXPECT_GT(*least, 0U);
    EXPECT_LE(*most - *least, 1U);
}

}  // namespace hashphase::demos
