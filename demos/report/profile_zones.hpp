// SPDX-License-Identifier: Zlib
#pragma once

// Where the time of a Bullet step goes, as Bullet itself tells it (BT_PROFILE).

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// A profile zone of Bullet's at its place among the others: those within it follow it, one deeper.
struct ProfileZone {
    std::string_view name;
    int depth = 0;
    double milliseconds = 0;  // what is within it included
    std::uint32_t calls = 0;
};

/// Takes a step, and returns the profile zones that Bullet enters in it, in their order; none of a Bullet
/// built without them. One step at a time, on one thread: Bullet's hooks are global. Those that were set
/// are set again afterwards. Cost: about 0.1 us for each time that a zone is entered.
[[nodiscard]] std::vector<ProfileZone> profileZonesOf(const std::function<void()>& takeStep);

}  // namespace hashphase::demos
