// SPDX-License-Identifier: Zlib
#pragma once

// Grounds to stand on.

#include <integration/terrain/terrain.hpp>
#include <tests/support/random.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace hashphase::test {

template <class Scalar>
struct Mesh {
    std::vector<Vector3<Scalar>> vertices;
    std::vector<std::uint32_t> indices;

    [[nodiscard]] std::vector<Vector3<Scalar>> corners() const {
        std::vector<Vector3<Scalar>> all;
        for (const std::uint32_t i : indices) {
            all.push_back(vertices[i]);
        }
        return all;
    }
};

template <class Scalar>
[[nodiscard]] Vector3<Scalar> at(double x, double y, double z) {
    return {static_cast<Scalar>(x), static_cast<Scalar>(y), static_cast<Scalar>(z)};
}

/// side x side quads between vertices that place(i, k) gives, each cut along a random diagonal.
template <class Scalar, class Place>
[[nodiscard]] Mesh<Scalar> quads(Random& random, std::uint32_t side, const Place& place) {
    Mesh<Scalar> mesh;
    for (std::uint32_t k = 0; k <= side; ++k) {
        for (std::uint32_t i = 0; i <= side; ++i) {
            mesh.vertices.push_back(place(i, k));
        }
    }
    for (std::uint32_t k = 0; k < side; ++k) {
        for (std::uint32_t i = 0; i < side; ++i) {
            const std::uint32_t a = k * (side + 1) + i;
            const std::uint32_t b = a + 1;
            const std::uint32_t c = a + side + 1;
            const std::uint32_t d = c + 1;
            const bool isTurned = random.chance(0.5);
            for (const std::uint32_t corner :
                 isTurned ? std::array{a, d, b, a, c, d} : std::array{a, b, c, b, c, d}) {
                mesh.indices.push_back(corner);
            }
        }
    }
    return mesh;
}

/// Rough ground with vertices off the lattice, but never so far that two triangles overlap: at most
/// `jitter` < 0.2 of `edge`.
template <class Scalar>
[[nodiscard]] Mesh<Scalar> roughGround(Random& random, std::uint32_t side, double edge,
                                       double roughness, double jitter,
                                       const Vector3<double>& origin = Vector3<double>::Zero()) {
    return quads<Scalar>(random, side, [&](std::uint32_t i, std::uint32_t k) {
        const double x = origin[0] + edge * (i + random.between(-jitter, jitter));
        const double z = origin[2] + edge * (k + random.between(-jitter, jitter));
        return at<Scalar>(x, origin[1] + random.between(0, roughness), z);
    });
}

/// A ramp that winds up around the y axis, `turns` times, rising 4 m each time.
template <class Scalar>
[[nodiscard]] Mesh<Scalar> spiral(double turns) {
    Mesh<Scalar> mesh;
    constexpr std::uint32_t stepsPerTurn = 24;
    const auto steps = static_cast<std::uint32_t>(turns * stepsPerTurn);
    for (std::uint32_t i = 0; i <= steps; ++i) {
        const double turn = static_cast<double>(i) / stepsPerTurn;
        const double angle = 2 * std::numbers::pi * turn;
        for (const double radius : {2.0, 5.0}) {
            mesh.vertices.push_back(
                at<Scalar>(radius * std::cos(angle), 4 * turn, radius * std::sin(angle)));
        }
        if (i > 0) {
            const std::uint32_t a = 2 * (i - 1);
            for (const std::uint32_t corner : {a, a + 1, a + 2, a + 1, a + 2, a + 3}) {
                mesh.indices.push_back(corner);
            }
        }
    }
    return mesh;
}

/// Triangles like splinters: any size and attitude, some vertical, flat, without an area, or twice.
template <class Scalar>
[[nodiscard]] Mesh<Scalar> splinters(Random& random, std::uint32_t count) {
    Mesh<Scalar> mesh;
    const auto push = [&](const Vector3<double>& p) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
        mesh.vertices.push_back(p.cast<Scalar>());
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vector3<double> middle = random.pointIn(-4, 4);
        const double size = random.logBetween(0.05, 6);
        std::array<Vector3<double>, 3> corners;
        for (auto& corner : corners) {
            corner = middle + size * random.pointIn(-1, 1);
        }
        switch (random.below(8)) {
            case 0:  // vertical
                corners[2][0] = corners[1][0] = corners[0][0];
                break;
            case 1:  // flat
                corners[2][1] = corners[1][1] = corners[0][1];
                break;
            case 2:  // a needle
                corners[2] = corners[1];
                break;
            case 3:  // a point
                corners[2] = corners[1] = corners[0];
                break;
            case 4:  // a wall with an upright edge
                corners[1][0] = corners[0][0];
                corners[1][2] = corners[0][2];
                corners[2][2] = corners[0][2];
                break;
            default:
                break;
        }
        const int copies = random.chance(0.1) ? 2 : 1;
        for (int copy = 0; copy < copies; ++copy) {
            for (const auto& corner : corners) {
                push(corner);
            }
        }
    }
    return mesh;
}

template <class Scalar>
void addTo(Terrain<Scalar>& terrain, const Mesh<Scalar>& mesh) {
    terrain.add(mesh.vertices, mesh.indices);
}

/// The point in a world in which another axis than y is up.
template <class Scalar>
[[nodiscard]] Vector3<Scalar> turned(const Vector3<Scalar>& point, UpAxis up) {
    const int y = static_cast<int>(up);
    Vector3<Scalar> result;
    result[y] = point[1];
    result[(y + 1) % 3] = point[2];
    result[(y + 2) % 3] = point[0];
    return result;
}

/// A grid and the ground in it, which is turned so that `up` is up.
template <class Scalar>
struct GroundWorld {
    explicit GroundWorld(Mesh<Scalar> mesh, UpAxis up = UpAxis::y) : terrain(grid, up) {
        for (Vector3<Scalar>& vertex : mesh.vertices) {
            vertex = turned(vertex, up);
        }
        addTo(terrain, mesh);
        grid.update();
    }

    Grid<Scalar> grid;
    Terrain<Scalar> terrain;
};

}  // namespace hashphase::test
