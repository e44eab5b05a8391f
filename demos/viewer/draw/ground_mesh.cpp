// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/ground_mesh.hpp>

#include <bit>
#include <unordered_map>

namespace hashphase::demos {

namespace {

struct PositionHash {
    std::size_t operator()(const Vector3<float>& position) const {
        std::uint64_t hash = 0;
        for (const float coordinate : position) {
            // Adding zero makes -0 and 0, which are equal, one.
            hash = (hash ^ std::bit_cast<std::uint32_t>(coordinate + 0.0F)) * 0x9E3779B97F4A7C15U;
            hash ^= hash >> 32;
        }
        return hash;
    }
};

}  // namespace

GroundMesh makeGroundMesh(std::span<const Vector3<float>> corners) {
    GroundMesh mesh;
    mesh.indices.reserve(corners.size());
    std::unordered_map<Vector3<float>, std::uint32_t, PositionHash> known;
    known.reserve(corners.size() / 4);

    // Corners at one place become one vertex.
    for (const Vector3<float>& corner : corners) {
        const auto [place, isNew] =
            known.try_emplace(corner, static_cast<std::uint32_t>(mesh.vertices.size()));
        if (isNew) {
            mesh.vertices.push_back({corner, Vector3<float>::Zero()});
            mesh.bounds.extend(corner);
        }
        mesh.indices.push_back(place->second);
    }

    // Each triangle adds its normal, as long as twice its area, to its corners.
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        GroundVertex& a = mesh.vertices[mesh.indices[i]];
        GroundVertex& b = mesh.vertices[mesh.indices[i + 1]];
        GroundVertex& c = mesh.vertices[mesh.indices[i + 2]];
        Vector3<float> normal = (b.position - a.position).cross(c.position - a.position);
        if (normal.y() < 0) {
            normal = -normal;
        }
        a.normal += normal;
        b.normal += normal;
        c.normal += normal;
    }
    for (GroundVertex& vertex : mesh.vertices) {
        vertex.normal = vertex.normal.isZero() ? Vector3<float>(Vector3<float>::UnitY())
                                               : vertex.normal.normalized();
    }
    return mesh;
}

}  // namespace hashphase::demos
