// SPDX-License-Identifier: Zlib
#pragma once

// Worlds that are hard on a physics engine: towers, pyramids, houses of cards, chains, ragdolls,
// heavy bodies on light ones, bullets; near the origin and far from it.
//
// They are stepped and measured by hard_run.hpp. Nothing in them is random but the bullets' places,
// which are the same every time.
//
// Units  metres, seconds, kilograms.

#include <demos/scenes/world_contents.hpp>

#include <array>
#include <string>
#include <vector>

namespace hashphase::demos {

/// What bullets are to do to the walls, which stand in their way one each.
enum class Bullets {
    none,
    stop,  // to be stopped: Bullet's continuous collision detection is on, for each of them
    pass,  // to be noticed: no response, and Bullet's boxes around start and end are off
};

struct HardWorld {
    std::string name;    // "tower"; with the distance from the origin: "tower@2^10"
    std::string title;   // "boxes, one on top of the other": what there are `size` of
    int size = 0;        // of boxes, storeys, links ... in the world
    double offset = 0;   // of the whole world from the origin, along each axis [m]
    int steps = 0;       // of 1/60 s: after these, what comes to rest has done so
    bool rests = false;  // whether everything is asleep by then, near the origin
    Bullets bullets = Bullets::none;

    /// Fills an empty world around `origin`, with `size` of what it is made of.
    void (*fill)(WorldContents& contents, const btVector3& origin, int size) = nullptr;
};

/// tower, pyramid, cards, chain, ragdolls, heavy-100, heavy-1000, bullets-stop, bullets-pass; all
/// at the origin.
[[nodiscard]] std::vector<HardWorld> hardWorlds();

/// The distances at which the worlds are tried, along each axis [m], and what they are called.
/// Numbers in single precision are 0.1 mm apart at 2^10, and 2 mm at 2^14.
inline constexpr std::array kHardOffsets{0.0, 1024.0, 16'384.0};

/// The world, that far from the origin along each axis: a power of 2 [m].
[[nodiscard]] HardWorld movedTo(double offset, HardWorld world);

}  // namespace hashphase::demos
