// SPDX-License-Identifier: Zlib
#pragma once

// Which scene is on stage, and how large.

#include <demos/console/format.hpp>
#include <demos/scenes/effects_file.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/stage/stage.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// What can be chosen by name.
struct ViewerScene {
    std::string name;
    std::string description;
    std::size_t objects = 0;  // unless others are asked for
    std::function<std::unique_ptr<Stage>(const struct SceneChoice& choice, std::size_t objects)>
        make;
};

/// "wander" first, then Bullet's.
[[nodiscard]] std::span<const ViewerScene> viewerScenes();

/// The row of a table that has this name. Throws InputError, which says which there are, where there is none.
template <class Rows>
[[nodiscard]] const auto& rowNamed(std::string_view what, std::string_view name, const Rows& rows) {
    std::vector<std::string> names;
    for (const auto& row : rows) {
        if (row.name == name) {
            return row;
        }
        names.emplace_back(row.name);
    }
    throw InputError(unknownNameSentence(what, name, names));
}

inline constexpr std::size_t kMostObjects = 1'000'000;
inline constexpr std::uint64_t kMostSeed = std::numeric_limits<std::uint32_t>::max();

struct SceneChoice {
    std::string name = "wander";
    /// Instead of a name, where not empty: the path of a scene file (.json), or of a recording (.aabbs).
    std::string file;
    std::optional<std::size_t> objects;
    std::uint64_t seed = 1;
};

/// What people call it: its name, or its file.
[[nodiscard]] const std::string& titleOf(const SceneChoice& choice);

/// Whether it is a recording of boxes, which no seed changes.
[[nodiscard]] bool isBoxRecording(const SceneChoice& choice);

/// The seed that it has by itself, which is a scene file's own. Throws InputError for broken files.
[[nodiscard]] std::uint64_t ownSeed(const SceneChoice& choice);

/// How many objects a scene has that was chosen by name: those that were asked for, or its own.
[[nodiscard]] std::size_t objectCount(const SceneChoice& choice);

/// Puts it on stage, as it is declared by itself. Throws InputError for unknown names, numbers of objects
/// that cannot be, and broken files.
[[nodiscard]] std::unique_ptr<Stage> makeStage(const SceneChoice& choice);

}  // namespace hashphase::demos
