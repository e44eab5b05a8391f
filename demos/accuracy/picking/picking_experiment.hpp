// SPDX-License-Identifier: Zlib
#pragma once

// P5: ways to find the boxes that a ray meets, and how much is measured of them.

#include <broadphase/aabb.hpp>
#include <demos/accuracy/experiment.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

struct Ray {
    Vector3<float> from;
    Vector3<float> to;
};

struct RayHit {
    std::uint32_t object;
    float fraction;  // of the ray's length, where it enters
};

/// What rays took; methods that do not tell leave it at 0.
struct RayCost {
    std::uint64_t cells = 0;  // or blocks of boxes, of the library's tree
    std::uint64_t boxes = 0;
};

/// A method that has filed a scene: appends each box that it finds, once.
using RayCaster = std::function<RayCost(const Ray&, std::vector<RayHit>&)>;

struct RayMethod {
    std::string name;
    bool isOurs = false;
    bool mustFindAll = false;  // a box that is hit and not found breaks a check
    bool findsNearestOnly = false;
    bool walksCells = false;  // takes time for each cell of a long ray
    std::function<RayCaster(std::span<const Aabb<float>>)> make;
};

/// Through plain cells of 1 m, the paper's first; the library's; Bullet's.
[[nodiscard]] std::vector<RayMethod> rayMethods();

/// How much is measured.
struct PickingPlan {
    std::size_t boxes;  // in the slab
    int graze;          // rays for each contact and offset
    int frames;         // that are timed
    std::size_t raysPerFrame;
    std::size_t strungBoxes;  // along all long rays of one length
    int longestPower;         // of ten: the longest ray [m], and so about as many cells
    double metresInAll;       // of the long rays of one length, if there is more than one
    double longestCellWalk;   // of methods that take time for each cell [m]
};

/// Measures, and says what it shows (picking.sql).
[[nodiscard]] Findings findPicking(const PickingPlan& plan, std::uint64_t seed,
                                   std::span<const RayMethod> methods, const TellProgress& tell);

}  // namespace hashphase::demos
