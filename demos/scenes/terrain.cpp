// SPDX-License-Identifier: Zlib
#include <demos/scenes/terrain.hpp>

#include <array>
#include <cmath>
#include <cstddef>

namespace hashphase::demos {
namespace {

struct Octave {
    float wavelength;  // [m]
    float amplitude;   // [m]
};

// Their amplitudes add up to kHighest.
constexpr std::array kOctaves{Octave{80, 9}, Octave{35, 4}, Octave{12, 1}};

float smoothStep(float t) {
    return t * t * (3 - 2 * t);
}

}  // namespace

float Terrain::height(float x, float z) const {
    float height = 0;
    for (std::size_t i = 0; i < kOctaves.size(); ++i) {
        const Octave& octave = kOctaves[i];
        height += octave.amplitude * noise(x / octave.wavelength, z / octave.wavelength,
                                           static_cast<std::uint32_t>(i));
    }
    return height;
}

float Terrain::noise(float x, float z, std::uint32_t octave) const {
    const float cellX = std::floor(x);
    const float cellZ = std::floor(z);
    const auto i = static_cast<std::int32_t>(cellX);
    const auto k = static_cast<std::int32_t>(cellZ);
    const float u = smoothStep(x - cellX);
    const float v = smoothStep(z - cellZ);
    const float near = std::lerp(latticeValue(i, k, octave), latticeValue(i + 1, k, octave), u);
    const float far =
        std::lerp(latticeValue(i, k + 1, octave), latticeValue(i + 1, k + 1, octave), u);
    return std::lerp(near, far, v);
}

float Terrain::latticeValue(std::int32_t i, std::int32_t k, std::uint32_t octave) const {
    // The finaliser of splitmix64 over the lattice point: any point's value without a table.
    std::uint64_t bits = seed_ + 0x9e3779b97f4a7c15U * (octave + 1U);
    bits ^= static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32 |
            static_cast<std::uint32_t>(k);
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9U;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebU;
    bits ^= bits >> 31;
    return static_cast<float>(bits >> 40) * 0x1p-24F;
}

TriangleGround::TriangleGround(
    std::uint32_t quads,
    const std::function<Vector3<float>(std::uint32_t i, std::uint32_t k)>& vertexAt) {
    for (std::uint32_t k = 0; k <= quads; ++k) {
        for (std::uint32_t i = 0; i <= quads; ++i) {
            vertices.push_back(vertexAt(i, k));
            if (i < quads && k < quads) {
                const std::uint32_t a = k * (quads + 1) + i;
                const std::uint32_t c = a + quads + 1;
                indices.insert(indices.end(), {a, c, a + 1, a + 1, c, c + 1});
            }
        }
    }
    boxes.resize(indices.size() / 3);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        boxes[i / 3].extend(vertices[indices[i]]);
    }
}

Aabb<float> TriangleGround::bounds() const {
    Aabb<float> bounds;
    for (const Vector3<float>& vertex : vertices) {
        bounds.extend(vertex);
    }
    return bounds;
}

}  // namespace hashphase::demos
