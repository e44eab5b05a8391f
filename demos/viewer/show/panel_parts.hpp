// SPDX-License-Identifier: Zlib
#pragma once

// What the parts of the panel have in common.

#include <demos/viewer/draw/picture.hpp>

#include <imgui.h>

#include <string>

namespace hashphase::demos {

inline constexpr float kPanelWidth = 350;  // [pixels]

/// A window that only tells.
inline constexpr ImGuiWindowFlags kStill =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs |
    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing;

[[nodiscard]] inline ImVec4 colourOf(Colour colour) {
    return ImGui::ColorConvertU32ToFloat4(
        IM_COL32(colour.red, colour.green, colour.blue, colour.alpha));
}

/// In the line of what was written last, at its right end.
inline void alignRight(const std::string& text) {
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width);
    ImGui::TextUnformatted(text.c_str());
}

inline void numberRow(const char* name, const std::string& number) {
    ImGui::TextUnformatted(name);
    alignRight(number);
}

}  // namespace hashphase::demos
