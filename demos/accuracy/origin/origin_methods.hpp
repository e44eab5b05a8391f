// SPDX-License-Identifier: Zlib
#pragma once

// Ways to keep a world far from the origin: in what numbers boxes are filed and rays are cast.

#include <demos/accuracy/origin/origin_scene.hpp>
#include <demos/scenes/pair_key.hpp>

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

}  // namespace hashphase::demos
