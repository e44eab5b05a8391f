// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's own profile zones: how long it spends in each of its phases, as it says itself.

#include <demos/viewer/stage/stage.hpp>

#include <span>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// Listens while it lives: one at a time, on one thread (Bullet's listener is global).
class BulletZones {
public:
    /// Forgets what the last one has heard, which `zones` holds.
    explicit BulletZones(std::vector<Stage::Zone>& zones);
    ~BulletZones();
    BulletZones(const BulletZones&) = delete;
    BulletZones& operator=(const BulletZones&) = delete;
};

/// The time of all zones of that name that lie in none of the same name [ms].
[[nodiscard]] double millisecondsIn(std::span<const Stage::Zone> zones, std::string_view name);

}  // namespace hashphase::demos
