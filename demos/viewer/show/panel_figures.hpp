// SPDX-License-Identifier: Zlib
#pragma once

// The parts of the panel that only tell.

#include <demos/viewer/session/session.hpp>
#include <demos/viewer/show/picture_maker.hpp>

#include <imgui.h>

#include <span>
#include <string>

namespace hashphase::demos {

[[nodiscard]] ImVec4 colourOf(Colour colour);

/// Begins a window that only tells, of this place in the picture: the `pivot` of it, from 0 to 1, is there.
void beginStill(const char* name, ImVec2 place, ImVec2 pivot);

/// In the line of what was written last, at its right end.
void alignRight(const std::string& text);
void numberRow(const std::string& name, const std::string& number);

/// Phases of a frame, and Bullet's own zones.
void showPhases(const Session& session);
void showZones(const Session& session);

/// How many bodies are in each zone of interest, behind all that comes after it.
void showZoneLabels(const Session& session);

/// Beside the panel, which is so wide: who is picked, the radar, what colours tell, badges, keys.
void showCard(const Session& session);
void showRadar(const Session& session);
void showLegends(const Session& session, std::span<const Legend> legends);
void showBadges(const Session& session);
void showHelp(const Session& session, float left);

}  // namespace hashphase::demos
