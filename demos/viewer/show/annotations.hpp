// SPDX-License-Identifier: Zlib
#pragma once

// Words over the picture, as data: badges at its upper border, and counts at zones of interest.

#include <demos/viewer/draw/picture.hpp>
#include <demos/viewer/session/session.hpp>

#include <string>
#include <vector>

namespace hashphase::demos {

/// A state of the session that must not be overlooked.
struct Badge {
    std::string text;
    Colour colour;         // behind the text
    bool isAlert = false;  // the text is light, on a dark colour
};

/// From the upper one to the lower one: whether all pairs are right, while they are verified, and that the frustum
/// is frozen.
[[nodiscard]] std::vector<Badge> badges(const Session& session);

/// A text at a place of the picture.
struct Label {
    Eigen::Vector2f middle;  // [pixels]
    std::string text;
};

/// How many bodies each zone of interest holds, at its centre, if that is in the picture.
[[nodiscard]] std::vector<Label> zoneLabels(const Session& session);

}  // namespace hashphase::demos
