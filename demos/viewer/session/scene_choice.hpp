// SPDX-License-Identifier: Zlib
#pragma once

// Which scene is on stage, and how large.

#include <demos/scenes/effects_file.hpp>
#include <demos/viewer/stage/stage.hpp>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

/// What can be chosen by name.
struct ViewerScene {
    std::string name;
    std::string description;
    std::size_t objects = 0;  // unless others are asked for
};

/// "wander" first, then Bullet's.
[[nodiscard]] std::span<const ViewerScene> viewerScenes();

inline constexpr std::size_t kMostObjects = 1'000'000;
inline constexpr std::uint64_t kMostSeed = std::numeric_limits<std::uint32_t>::max();

struct SceneChoice {
    std::string name = "wander";
    /// Instead of a name, where not empty: the path of a scene file (.json), or of a recording (.aabbs).
    std::string file;
    std::optional<std::size_t> objects;
    std::uint64_t seed = 1;
};

/// Puts it on stage, as it is declared by itself. Throws InputError for unknown names, numbers of objects
/// that cannot be, and broken files.
[[nodiscard]] std::unique_ptr<Stage> makeStage(const SceneChoice& choice);

}  // namespace hashphase::demos
