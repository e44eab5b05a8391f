// SPDX-License-Identifier: Zlib
#pragma once

// Scenes with dynamics that are hard on a broadphase, or whose answer is known.
//
// Units  metres, seconds, kilograms.

#include <demos/scenes/world_contents.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace hashphase::demos {

/// A scene that is filled, and then perhaps meddled with before each step.
struct PhysicsScene {
    std::string name;
    void (*fill)(WorldContents& contents, std::size_t objects, std::uint64_t seed);
    std::size_t quickObjects;
    std::size_t fullObjects;
    void (*disturb)(WorldContents& contents, int step) = nullptr;
};

/// Eight: the four worlds of `compare`; spheres in a lattice that fall into a box; balls that
/// bounce for ever; spinning compounds that fall into a heap; a pile out of which bodies are taken
/// and dropped again.
[[nodiscard]] std::vector<PhysicsScene> physicsScenes();

/// A floor whose top is at height 0, and four walls `halfWidth` from the middle.
void addOpenBox(WorldContents& contents, btScalar halfWidth);

/// About so many spheres of 1 m in a cubic lattice of that spacing, the lowest at `height`, each
/// off its place by up to `jitter` along every axis.
void addLattice(WorldContents& contents, std::size_t spheres, btScalar spacing, btScalar height,
                btScalar jitter, std::uint64_t seed);

/// A row of balls of 1 m, 2 m apart, above a plane from which they bounce back without loss. Ball i
/// is body 1 + i and begins at bouncingHeight(i).
void addBouncingBalls(WorldContents& contents, std::size_t balls);
[[nodiscard]] double bouncingHeight(std::size_t ball);

}  // namespace hashphase::demos
