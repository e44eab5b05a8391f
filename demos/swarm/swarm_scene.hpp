// SPDX-License-Identifier: Zlib
#pragma once

// Populations of spheres that wander. Where one is in a frame follows from its number and the frame alone, so that
// every process can say where any of them is, and one process can check what many have found.

#include <broadphase/aabb.hpp>

#include <cstdint>
#include <span>
#include <string_view>

namespace hashphase::demos {

enum class SwarmKind : std::uint8_t { uniform, clusters, traveller, corner, sizes };

struct SwarmKindName {
    SwarmKind kind;
    std::string_view name;
    std::string_view description;
};

/// All kinds, the first one the default.
[[nodiscard]] std::span<const SwarmKindName> swarmKinds();

/// A population of `count` spheres, on average about half a pair for each.
class SwarmScene {
public:
    SwarmScene(SwarmKind kind, std::uint64_t count, std::uint64_t seed);

    /// The box around the sphere `number` (0 to count() - 1) in a frame. Cost: some 50 ns.
    [[nodiscard]] Aabb<float> box(std::uint64_t number, std::uint32_t frame) const;

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    /// The edge of the cube in which nearly all spheres are [m].
    [[nodiscard]] float side() const noexcept { return side_; }

private:
    [[nodiscard]] Vector3<float> home(std::uint64_t number, std::uint64_t bits) const;

    SwarmKind kind_;
    std::uint64_t count_;
    std::uint64_t seed_;
    float side_;
};

}  // namespace hashphase::demos
