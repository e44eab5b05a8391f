// SPDX-License-Identifier: Zlib
//
// A grid that is changed from within a filter: the library calls the filter, and what moves a proxy is compiled
// here. Both know of the same call. Prints the number of overlapping pairs, which is one.

#include <broadphase/diagnostics.hpp>
#include <broadphase/pairs.hpp>

#include <cstdio>

using namespace hashphase;

namespace {

int misuses = 0;

}  // namespace

int main() {
    setAssertHandler([](const char*, const char*, const char*, int) { ++misuses; });
    const Aabb<float> box(Vector3<float>(0, 0, 0), Vector3<float>(1, 1, 1));
    Grid<float> grid;
    Pairs<float> pairs(grid);
    const ProxyId moved = grid.add(box);
    static_cast<void>(grid.add(box));
    pairs.update([&](ProxyId, ProxyId) {
        grid.move(moved, box);  // to where it is, so that no harm is done
        return true;
    });
    if (misuses != HASHPHASE_ENABLE_ASSERTS) {
        std::printf("misuses that were told: %d\n", misuses);
        return 1;
    }
    std::printf("pairs: %d\n", static_cast<int>(pairs.count()));
}
