// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/scenes/world_scenes.hpp>
#include <demos/viewer/session/pair_check.hpp>
#include <demos/viewer/stage/stage.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace hashphase::demos {

inline const BroadphaseKind& kindNamed(std::string_view name) {
    const auto kinds = broadphaseKinds();
    return *std::find_if(kinds.begin(), kinds.end(),
                         [name](const BroadphaseKind& kind) { return kind.name == name; });
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

inline const WorldSceneKind& worldNamed(std::string_view name) {
    const auto kinds = worldSceneKinds();
    return *std::find_if(kinds.begin(), kinds.end(),
                         [name](const WorldSceneKind& kind) { return kind.name == name; });
}

inline void expectPairs(const Stage& stage, bool exact, const std::string& when) {
    PairCheck check;
    check.look(stage);
    EXPECT_TRUE(check.missing().empty()) << when;
    EXPECT_TRUE(!exact || check.extra().empty()) << when;
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
