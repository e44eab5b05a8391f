// SPDX-License-Identifier: Zlib
#pragma once

// Scenes of effects as JSON files, so that a declaration can be changed without compiling:
//
//     {
//       "scene": {"objects": 1000, "moving": 0.5},
//       "effects": {"motion": true, "pairs": true, "culling": {"margin": 2}},
//       "grid": {"cellSize": 4}
//     }
//
// Names     those of EffectsScene, SceneEffects and GridConfig, and of their enumerators
// Effects   true or an object of settings declares one; false, or leaving it out, does not
// Defaults  what is left out has its default
// No bound  "none", where a number may be infinite

#include <integration/effects/scene_effects.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace hashphase::demos {

/// Who is in a scene of effects, where, and for how long: spheres on a square, and zones of interest.
/// Each range is in effects_fields.cpp.
struct EffectsScene {
    std::uint32_t objects = 1000;
    double radius = 1;          ///< of every body [m]
    double domain = 400;        ///< side of the square, which begins at (0, 0) [m]
    std::uint32_t terrain = 0;  ///< squares of ground along a side, of two triangles each; 0: none
    double speed = 10;          ///< of a body that moves, on average [m/s]
    double moving = 1;          ///< share of the bodies that move
    double fast = 0;            ///< share of the bodies that fly
    double fastSpeed = 300;     ///< of a body that flies [m/s]
    std::uint32_t seed = 1;
    std::uint32_t zones = 0;
    std::uint32_t frames = 120;
    double timeStep = 1.0 / 60;  ///< [s]
};

struct EffectsFile {
    std::string title;
    EffectsScene scene;
    SceneEffects effects;
    std::string schema;  ///< where an editor finds the schema; never looked for
};

/// Reads the text. Throws InputError that begins with `name` and the line, and for broken syntax the
/// column, names the field, and says what would be right; what it returns has no effectsError().
[[nodiscard]] EffectsFile parseEffectsFile(std::string_view text, const std::string& name);

/// The same of a file, by its path. Throws InputError as readText() does, too.
[[nodiscard]] EffectsFile readEffectsFile(const std::filesystem::path& path);

/// A text that is read back as equal: all settings of what is declared. There must be no
/// effectsError().
[[nodiscard]] std::string effectsFileText(const EffectsFile& file);

/// The JSON schema of such files (draft 2020-12), for editors and validators. It knows all but what
/// fields have to do with each other, and names that are given twice.
[[nodiscard]] std::string effectsFileSchema();

/// The scene files of examples/, as the program brings them along.
struct ExampleScene {
    std::string_view name;  // of the file, without its extension
    std::string_view text;
};

/// The default one first.
[[nodiscard]] std::span<const ExampleScene> exampleScenes();

}  // namespace hashphase::demos
