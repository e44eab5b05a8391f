// SPDX-License-Identifier: Zlib
#include <demos/report/profile_zones.hpp>

#include <demos/report/stopwatch.hpp>

#include <LinearMath/btQuickprof.h>

#include <cstddef>
#include <utility>

namespace hashphase::demos {
namespace {

struct ZoneListener {
    struct Open {
        std::size_t zone;
        Stopwatch watch;
    };

    std::vector<ProfileZone> zones;
    std::vector<Open> open;  // from the outside inwards

    void enter(const char* name) {
        const std::size_t zone = zoneInside(name);
        ++zones[zone].calls;
        open.push_back({zone, {}});
    }

    void leave() {
        zones[open.back().zone].milliseconds += open.back().watch.milliseconds();
        open.pop_back();
    }

    // The zone of that name directly within the innermost open one.
    std::size_t zoneInside(std::string_view name) {
        const int depth = static_cast<int>(open.size());
        std::size_t zone = open.empty() ? 0 : open.back().zone + 1;
        for (; zone < zones.size() && zones[zone].depth >= depth; ++zone) {
            if (zones[zone].depth == depth && zones[zone].name == name) {
                return zone;
            }
        }
        zones.insert(zones.begin() + static_cast<std::ptrdiff_t>(zone), {name, depth});
        return zone;
    }
};

ZoneListener listener;  // the hooks have no argument for it

/// Hears Bullet's zones for as long as it lives.
class HookScope {
public:
    HookScope() {
        btSetCustomEnterProfileZoneFunc([](const char* name) { listener.enter(name); });
        btSetCustomLeaveProfileZoneFunc([] { listener.leave(); });
    }
    HookScope(const HookScope&) = delete;
    HookScope& operator=(const HookScope&) = delete;
    ~HookScope() {
        btSetCustomEnterProfileZoneFunc(enterBefore_);
        btSetCustomLeaveProfileZoneFunc(leaveBefore_);
    }

private:
    btEnterProfileZoneFunc* enterBefore_ = btGetCurrentEnterProfileZoneFunc();
    btLeaveProfileZoneFunc* leaveBefore_ = btGetCurrentLeaveProfileZoneFunc();
};

}  // namespace

std::vector<ProfileZone> profileZonesOf(const std::function<void()>& takeStep) {
    listener = {};
    const HookScope hooks;
    takeStep();
    return std::move(listener.zones);
}

}  // namespace hashphase::demos
