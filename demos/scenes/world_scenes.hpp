// SPDX-License-Identifier: Zlib
#pragma once

// Scenes with Bullet's dynamics, each a function that fills a world.

#include <demos/scenes/world_contents.hpp>

#include <cstdint>
#include <span>
#include <string_view>

namespace hashphase::demos {

/// A dynamics scene that can be asked for by name.
struct WorldSceneKind {
    std::string_view name;
    std::string_view description;
    std::size_t defaultObjects;
    void (*fill)(WorldContents& contents, std::size_t objects, std::uint64_t seed);
};

/// Every built-in scene with dynamics.
[[nodiscard]] std::span<const WorldSceneKind> worldSceneKinds();

}  // namespace hashphase::demos
