// SPDX-License-Identifier: Zlib
#pragma once

// Stages and sessions as tests make, move and judge them.

#include <demos/scenes/input_error.hpp>
#include <demos/scenes/world_scenes.hpp>
#include <demos/viewer/session/scene_choice.hpp>
#include <demos/viewer/session/session.hpp>
#include <demos/viewer/session/stage_queries.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace hashphase::demos {

/// Simulates so many frames.
inline void step(Session& session, std::uint64_t frames) {
    session.askForSteps(frames);
    while (session.isWaiting()) {
        session.advance();
    }
}

/// What is wrong with a command; "none" where it can be run.
inline std::string faultOf(Session& session, const std::string& line) {
    try {
        session.run(line);
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

inline const BroadphaseKind& kindNamed(std::string_view name) {
    return rowNamed("broadphase", name, broadphaseKinds());
}

inline const WorldSceneKind& worldNamed(std::string_view name) {
    return rowNamed("scene", name, worldSceneKinds());
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
