// SPDX-License-Identifier: Zlib
#pragma once

// The broadphases that can be compared, by name.

#include <btBulletCollisionCommon.h>

#include <broadphase/aabb.hpp>
#include <broadphase/grid_config.hpp>

#include <limits>
#include <memory>
#include <span>
#include <string_view>

namespace hashphase::demos {

/// What some broadphases must know beforehand.
struct BroadphaseNeeds {
    Aabb<float> bounds;  // of everything that will ever be set
    std::size_t objects = 0;
    GridConfig grid = {};  // of ours
};

struct BroadphaseKind {
    std::string_view name;
    std::string_view title;  // for sentences
    std::string_view description;

    bool ours;  // a pair of it missing or extra fails the run

    /// Part of the default choice up to this many objects; beyond, it would take too long.
    std::size_t defaultUpTo;

    /// Its destructor frees the proxies that are still alive.
    bool freesProxies;

    std::unique_ptr<btBroadphaseInterface> (*make)(const BroadphaseNeeds& needs);

    /// Runs while somebody looks on up to this many objects; beyond, they would wait for it, the longer by
    /// the square of their number.
    std::size_t liveUpTo = std::numeric_limits<std::size_t>::max();
};

/// Ours first, then Bullet's.
[[nodiscard]] std::span<const BroadphaseKind> broadphaseKinds();

/// The one of that name; throws std::logic_error where there is none.
[[nodiscard]] const BroadphaseKind& broadphaseKind(std::string_view name);

}  // namespace hashphase::demos
