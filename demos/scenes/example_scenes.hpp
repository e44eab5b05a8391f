// SPDX-License-Identifier: Zlib
#pragma once

// The scene files of examples/, as the program brings them along.

#include <span>
#include <string_view>

namespace hashphase::demos {

struct ExampleScene {
    std::string_view name;  // of the file, without its extension
    std::string_view text;
};

/// The default one first.
[[nodiscard]] std::span<const ExampleScene> exampleScenes();

}  // namespace hashphase::demos
