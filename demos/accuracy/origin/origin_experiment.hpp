// SPDX-License-Identifier: Zlib
#pragma once

// P6: ways to keep a world far from the origin: in what numbers boxes are filed and rays are cast;
// what becomes of pairs, rays and resting bodies there, and what it costs to have them right.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/origin/origin_scene.hpp>
#include <demos/scenes/pair_key.hpp>
#include <demos/scenes/physics_world.hpp>

#include <functional>
#include <memory>
#include <span>
#include <string>

namespace hashphase::demos {

/// A world whose boxes are given in double precision. Boxes are numbered.
class OriginWorld {
public:
    OriginWorld() = default;
    OriginWorld(const OriginWorld&) = delete;
    OriginWorld& operator=(const OriginWorld&) = delete;
    virtual ~OriginWorld() = default;

    /// Sets all boxes, always as many, and brings the pairs up to date.
    virtual void set(std::span<const WorldBox> boxes) = 0;

    /// Appends the pairs as of the last set(), in any order.
    virtual void listPairs(std::vector<PairKey>& pairs) = 0;

    /// Appends the boxes that the ray meets, in any order.
    virtual void listHits(const WorldRay& ray, std::vector<std::uint32_t>& boxes) = 0;
};

struct OriginMethod {
    std::string name;
    bool isOurs = false;
    bool missesNoPair = false;  // at any distance
    bool missesNoHit = false;
    bool isExact = false;  // finds precisely the pairs that there are, at any distance
    std::function<std::unique_ptr<OriginWorld>()> make;
};

/// In single precision as it is, the bounds rounded outward, positions in single precision, cells
/// by whole numbers with single precision within; in double precision; btDbvtBroadphase.
[[nodiscard]] std::vector<OriginMethod> originMethods();

/// A world of Bullet's, in single precision, in which balls come to rest.
struct SettleMethod {
    std::string name;
    PhysicsBroadphase broadphase;
    bool shiftsOrigin = false;  // Bullet sees places relative to a whole-numbered origin nearby
};

/// In world coordinates over btDbvtBroadphase and over ours; over ours with the origin shifted.
[[nodiscard]] std::vector<SettleMethod> settleMethods();

struct OriginPlan {
    std::vector<double> offsets;  // 0 first, then powers of two, ascending, up to 2^30 [m]
    std::size_t boxes = 1000;
    std::size_t rays = 50;
};

/// Measures, and says what it shows (origin.sql).
[[nodiscard]] Findings findOrigin(const OriginPlan& plan, std::uint64_t seed,
                                  std::span<const OriginMethod> methods,
                                  std::span<const SettleMethod> settling, const TellProgress& tell);

}  // namespace hashphase::demos
