// SPDX-License-Identifier: Zlib
#pragma once

// A world of boxes of which some sweep, the same for every mode.

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace hashphase::test {

inline constexpr std::array<Sweep, 3> kSweepModes{Sweep::box, Sweep::line, Sweep::automatic};

/// Boxes of about 1 m in a cube, and the ways of those that sweep: all with a direction of their own.
template <class Scalar>
struct Bullets {
    std::vector<Aabb<Scalar>> boxes;
    std::vector<Vector3<Scalar>> ways;  // of the first boxes

    Bullets() = default;

    Bullets(std::uint32_t count, std::uint32_t sweeping, double length, Random& random) {
        const double side = 2.5 * std::cbrt(static_cast<double>(count));
        for (std::uint32_t i = 0; i < count; ++i) {
            boxes.push_back(boxAround<Scalar>(random.pointIn(0, side), random.pointIn(0.3, 0.6)));
        }
        for (std::uint32_t i = 0; i < sweeping; ++i) {
            const Vector3<double> way = random.pointIn(-1, 1).normalized() * length;
            ways.push_back(way.template cast<Scalar>());
        }
    }
};

template <class Scalar>
struct BulletWorld {
    Grid<Scalar> grid;
    Sweeps<Scalar> sweeps{grid};
    Pairs<Scalar> pairs{grid, &sweeps};
    std::vector<ProxyId> ids;

    BulletWorld(const Bullets<Scalar>& bullets, Sweep mode, const GridConfig& config = {})
        : grid(config) {
        for (const Aabb<Scalar>& box : bullets.boxes) {
            ids.push_back(grid.add(box));
        }
        for (std::size_t i = 0; i < bullets.ways.size(); ++i) {
            sweeps.set(ids[i], bullets.ways[i], mode);
        }
    }
    std::vector<ProxyPair> update(ParallelFor parallelFor = serialFor) {
        pairs.update([](ProxyId, ProxyId) { return true; }, parallelFor);
        std::vector<ProxyPair> all;
        pairs.collect(all);
        return all;
    }
};

}  // namespace hashphase::test
