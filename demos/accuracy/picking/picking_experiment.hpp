// SPDX-License-Identifier: Zlib
#pragma once

// P5, its parts.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/picking/ray_methods.hpp>
#include <demos/accuracy/picking/ray_scenes.hpp>
#include <demos/report/statistics.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

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

/// What a method found, against the truth.
struct RayTally {
    std::uint64_t rays = 0;
    std::uint64_t hits = 0;     // boxes that the rays meet
    std::uint64_t missed = 0;   // of these; of no meaning for methods that find the nearest only
    std::uint64_t falsely = 0;  // found, but not met
    std::uint64_t raysThatHit = 0;
    std::uint64_t noneFound = 0;     // of these: no box is found
    std::uint64_t wrongNearest = 0;  // of these: another box, or none, is found first
    std::uint64_t farFromNearest =
        0;  // of these: none, or one that is met much later than the nearest
    RayCost cost;

    RayTally& operator+=(const RayTally& other);
};

/// Rays that graze a box at one offset.
struct GrazeRow {
    const RayMethod* method;
    Contact contact;
    int ulps;
    RayTally all;     // boxes on the rays
    RayTally grazed;  // the same, of the grazed box alone
};

/// Rays of one length.
struct LengthRow {
    const RayMethod* method;
    double length;  // [m]
    RayTally all;
};

struct PickingMeasurement {
    std::vector<GrazeRow> grazes;
    std::vector<LengthRow> lengths;
    std::vector<Spread> milliseconds;  // a frame; by method
};

[[nodiscard]] PickingMeasurement measurePicking(const PickingPlan& plan, std::uint64_t seed,
                                                std::span<const RayMethod> methods,
                                                const TellProgress& tell);

/// Measures, and says what it shows.
[[nodiscard]] Findings findPicking(const PickingPlan& plan, std::uint64_t seed,
                                   std::span<const RayMethod> methods, const TellProgress& tell);

}  // namespace hashphase::demos
