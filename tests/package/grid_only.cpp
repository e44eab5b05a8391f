// SPDX-License-Identifier: Zlib
//
// The grid without any physics engine. Prints the number of overlapping pairs, which is one, when a
// bullet has made another one on its way.

#include <broadphase/grid.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>

#include <cstdio>

int main() {
    hashphase::Grid<float> grid;
    hashphase::Sweeps<float> sweeps(grid);
    hashphase::Pairs<float> pairs(grid, &sweeps);
    const Eigen::Vector3f origin(0, 0, 0), one(1, 1, 1), two(2, 2, 2);
    const hashphase::ProxyId first = grid.add({origin, one});
    const hashphase::ProxyId second = grid.add({one, two});
    const hashphase::ProxyId bullet =
        grid.add({Eigen::Vector3f(-9, 0.5F, 0.5F), Eigen::Vector3f(-8, 0.6F, 0.6F)});
    sweeps.set(bullet, {8.5F, 0, 0});
    const bool hits =
        hashphase::firstContact(sweeps.motion(bullet), sweeps.motion(first)) == 8 / 8.5;
    const auto acceptAll = [](hashphase::ProxyId, hashphase::ProxyId) { return true; };
    pairs.update(acceptAll);
    const bool isRight = hits && pairs.count() == 2;
    sweeps.set(bullet, {0, 0, 0});
    pairs.update(acceptAll);
    std::printf("pairs: %d\n", isRight ? static_cast<int>(pairs.count()) : -1);
    grid.remove(first);
    grid.remove(second);
}
