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

#include <demos/scenes/effects_scene_settings.hpp>
#include <integration/effects/scene_effects.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace hashphase::demos {

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

}  // namespace hashphase::demos
