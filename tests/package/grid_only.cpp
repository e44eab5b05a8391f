// SPDX-License-Identifier: Zlib
//
// The grid without any physics engine. Prints the number of overlapping pairs, which is one.

#include <broadphase/grid.hpp>
#include <broadphase/pairs.hpp>

#include <cstdio>

int main() {
    hashphase::Grid<float> grid;
    hashphase::Pairs<float> pairs(grid);
    const Eigen::Vector3f origin(0, 0, 0), one(1, 1, 1), two(2, 2, 2);
    const hashphase::ProxyId first = grid.add({origin, one});
    const hashphase::ProxyId second = grid.add({one, two});
    const auto acceptAll = [](hashphase::ProxyId, hashphase::ProxyId) { return true; };
    pairs.update(acceptAll);
    std::printf("pairs: %d\n", static_cast<int>(pairs.count()));
    grid.remove(first);
    grid.remove(second);
}
