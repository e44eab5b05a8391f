// SPDX-License-Identifier: Zlib
//
// Zones of interest: a train passes a station, which stands, and a guard, who walks towards it. You
// should see each carriage enter and leave each of the two zones, once, in the order of the train.

#include <integration/ai/zones.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>

using namespace hashphase;

namespace {

constexpr std::array kNames{"the station", "the guard's sight"};  // by ZoneId::index

Aabb<float> carriage(int number, int second) {
    const float middle = 10 * static_cast<float>(second) - 12 * static_cast<float>(number);
    return boxAround<float>({middle, 2, 0}, {5, 2, 1});
}

void print(int second, const char* what, std::span<const ZoneEvent> events) {
    for (const auto& [zone, proxy] : events) {
        std::printf("%2d s: carriage %u %s %s\n", second, proxy.index, what, kNames[zone.index]);
    }
}

}  // namespace

int main() {
    Grid<float> grid;
    std::array<ProxyId, 3> train;
    for (int i = 0; i < 3; ++i) {
        train[i] = grid.add(carriage(i, 0));
    }

    Zones<float> zones;
    const auto platform = boxBetween<float>({50, 0, -5}, {80, 5, 5});
    const ZoneId station = zones.add({BoxRegion<float>{platform}, Presence::box});
    const ZoneId guard =
        zones.add({SphereRegion<float>({150, 2, 3}, 10)});  // by carriages' middles

    std::size_t entered = 0;
    std::size_t left = 0;
    std::size_t most = 0;
    for (int second = 0; second <= 20; ++second) {
        for (int i = 0; i < 3; ++i) {
            grid.move(train[i], carriage(i, second));
        }
        zones.set(guard, {SphereRegion<float>({150 - static_cast<float>(second), 2, 3}, 10)});

        const ZoneEvents events = zones.update(grid);
        print(second, "enters", events.entered);
        print(second, "leaves", events.left);
        entered += events.entered.size();
        left += events.left.size();
        most = std::max(most, zones.occupants(station).size());
    }
    std::printf("entered: %zu, left: %zu, at most %zu at once in %s\n", entered, left, most,
                kNames[station.index]);
}
