// SPDX-License-Identifier: Zlib
#pragma once

// P9, its parts.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/terrain/ground_methods.hpp>
#include <demos/report/statistics.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// How much is measured.
struct TerrainPlan {
    std::size_t spheres;  // on each ground
    std::size_t points;   // of each place
    int frames;           // that are timed
    std::size_t spheresPerFrame;
};

/// What spheres stand on.
enum class GroundKind : std::uint8_t {
    slope,     // one plane
    terraces,  // flat, up, flat, down, each over 4 m
    hills,
};

/// How a method puts spheres on one ground; depths and heights as shares of the spheres' radii.
struct RestRow {
    const GroundMethod* method;
    GroundKind kind;
    double slope;    // [degrees]; 0 for hills
    float cellSize;  // of methods that take one [m]
    std::size_t spheres = 0;
    std::size_t noGround = 0;
    double meanDepth = 0;  // in the ground
    double worstDepth = 0;
    double meanHeight = 0;  // above the place where they would touch it
    double worstHeight = 0;
    bool isTimed = false;
    Spread milliseconds = {};  // a frame

    /// The method, and the cell size where it takes one.
    [[nodiscard]] std::string name() const;
};

/// Where points lie that ask for their triangle.
enum class PointPlace : std::uint8_t { anywhere, onEdges, onCorners };
inline constexpr std::array kPointPlaces{PointPlace::anywhere, PointPlace::onEdges,
                                         PointPlace::onCorners};
[[nodiscard]] std::string_view nameOf(PointPlace place);

struct PointRow {
    const GroundMethod* method;
    PointPlace place;
    std::size_t points = 0;
    std::size_t noGround = 0;       // though there is
    std::size_t wrongTriangle = 0;  // found, but elsewhere; of methods that tell the triangle
    bool tellsTriangle = false;
};

struct TerrainMeasurement {
    std::vector<RestRow> rests;
    std::vector<PointRow> points;
};

inline constexpr float kUsualCell = 2;  // [m]

[[nodiscard]] TerrainMeasurement measureTerrain(const TerrainPlan& plan, std::uint64_t seed,
                                                std::span<const GroundMethod> methods,
                                                const TellProgress& tell);

/// Measures, and says what it shows.
[[nodiscard]] Findings findTerrain(const TerrainPlan& plan, std::uint64_t seed,
                                   std::span<const GroundMethod> methods, const TellProgress& tell);

}  // namespace hashphase::demos
