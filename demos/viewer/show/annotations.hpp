// SPDX-License-Identifier: Zlib
#pragma once

// Words as data: badges at the picture's upper border, counts at zones of interest, and a swap of broadphases.

#include <demos/viewer/draw/picture.hpp>
#include <demos/viewer/session/session.hpp>

#include <functional>
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

/// What a frame takes with this broadphase and with the one before: "hash 0.41 ms, before: dbvt 4.80 ms". Empty
/// where the broadphase was not swapped.
[[nodiscard]] std::string swapText(const Session& session);

/// A text at a place of the picture.
struct Label {
    Eigen::Vector2f middle;  // [pixels]
    std::string text;
    float radius = 0;  // of the zone [m]
};

/// How many bodies each zone of interest holds, at its centre, if that is in the picture.
[[nodiscard]] std::vector<Label> zoneLabels(const Session& session);

/// The same where none overlaps another: one that would lie on that of a larger zone, or of an earlier one as large,
/// is a line lower, else a line higher, and left out if these places are taken, too. Sizes are in pixels.
[[nodiscard]] std::vector<Label> placedApart(
    std::vector<Label> labels, const std::function<Eigen::Vector2f(const std::string&)>& sizeOf);

}  // namespace hashphase::demos
