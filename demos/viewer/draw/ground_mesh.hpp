// SPDX-License-Identifier: Zlib
#pragma once

// Ground as it is drawn: corners at one place are one vertex, with a smooth normal.

#include <demos/viewer/draw/picture.hpp>

#include <vector>

namespace hashphase::demos {

struct GroundVertex {
    Vector3<float> position;
    Vector3<float> normal;  // upwards, of length one
};

struct GroundMesh {
    std::vector<GroundVertex> vertices;
    std::vector<std::uint32_t> indices;  // three a triangle
    Eigen::AlignedBox3f bounds;
};

/// Of triangles, three corners each; their order around the triangle does not matter. A corner's
/// normal is the mean of its triangles', by area. Cost: one look-up in a hash table for each
/// corner.
[[nodiscard]] GroundMesh makeGroundMesh(std::span<const Vector3<float>> corners);

}  // namespace hashphase::demos
