// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/bullet_zones.hpp>

#include <LinearMath/btQuickprof.h>

#include <chrono>

namespace hashphase::demos {
namespace {

using Clock = std::chrono::steady_clock;

struct Listener {
    struct Open {
        std::size_t zone;
        Clock::time_point since;
    };

    std::vector<Stage::Zone>* zones = nullptr;
    std::vector<Open> open;  // from the outside inwards

    void enter(const char* name) {
        open.push_back({zoneInside(name), Clock::now()});
        ++(*zones)[open.back().zone].calls;
    }

    void leave() {
        const std::chrono::duration<double, std::milli> passed = Clock::now() - open.back().since;
        (*zones)[open.back().zone].milliseconds += passed.count();
        open.pop_back();
    }

    // The zone of that name directly within the innermost open one. Those within a zone follow it.
    std::size_t zoneInside(std::string_view name) {
        const int depth = static_cast<int>(open.size());
        std::size_t zone = open.empty() ? 0 : open.back().zone + 1;
        for (; zone < zones->size() && (*zones)[zone].depth >= depth; ++zone) {
            if ((*zones)[zone].depth == depth && (*zones)[zone].name == name) {
                return zone;
            }
        }
        zones->insert(zones->begin() + static_cast<std::ptrdiff_t>(zone), {name, depth});
        return zone;
    }
};

Listener listener;  // the callbacks have no argument for it

}  // namespace

BulletZones::BulletZones(std::vector<Stage::Zone>& zones) {
    zones.clear();
    listener.zones = &zones;
    listener.open.clear();
    btSetCustomEnterProfileZoneFunc([](const char* name) { listener.enter(name); });
    btSetCustomLeaveProfileZoneFunc([] { listener.leave(); });
}

BulletZones::~BulletZones() {
    const auto hearNothing = [](const char* /*name*/) {};
    btSetCustomEnterProfileZoneFunc(hearNothing);
    btSetCustomLeaveProfileZoneFunc([] {});
    listener.zones = nullptr;
}

double millisecondsIn(std::span<const Stage::Zone> zones, std::string_view name) {
    double sum = 0;
    int depthOfLast = -1;  // within that one nothing counts again
    for (const Stage::Zone& zone : zones) {
        if (depthOfLast >= 0 && zone.depth > depthOfLast) {
            continue;
        }
        depthOfLast = zone.name == name ? zone.depth : -1;
        sum += zone.name == name ? zone.milliseconds : 0;
    }
    return sum;
}

}  // namespace hashphase::demos
