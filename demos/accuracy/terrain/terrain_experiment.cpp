// SPDX-License-Identifier: Zlib
#include <demos/accuracy/terrain/terrain_experiment.hpp>

#include <demos/scenes/random.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hashphase::demos {
namespace {

constexpr std::string_view kTerrainDeclaration =
#include <demos/accuracy/terrain/terrain.sql>
    ;

constexpr float kRoom = kGroundHalf - 2;  // no sphere reaches the border
constexpr float kAbove = 2;               // where spheres ask from, above where they rest [m]
constexpr float kUsualCell = 2;           // [m]

double radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

/// What spheres stand on.
struct GroundScene {
    std::string_view kind;
    double slope;  // [degrees]; 0 for hills
    TriangleGround mesh;
};

GroundScene slopeOf(double degrees) {
    const auto rise = static_cast<float>(std::tan(radians(degrees)));
    return {"slope", degrees, groundOfHeights([rise](float x, float) { return rise * x; })};
}

/// Flat, up, flat, down, each over 4 m.
GroundScene terracesOf(double degrees) {
    const auto rise = static_cast<float>(std::tan(radians(degrees)));
    return {"terraces", degrees, groundOfHeights([rise](float x, float) {
                const float along = x - 16 * std::floor(x / 16);
                return rise * std::clamp(std::min(along - 4, 16 - along), 0.0F, 4.0F);
            })};
}

GroundScene hillsOf(float jitter, std::uint64_t seed) {
    constexpr float steepness = 4;  // so many times as high as Terrain's
    const auto height = [hills = Terrain(seed)](float x, float z) {
        return steepness * hills.height(x, z);
    };
    return {"hills", 0, groundOfHeights(height, jitter, seed)};
}

SphereBatch randomSpheres(std::size_t count, float height, Random& random) {
    SphereBatch spheres;
    for (std::size_t i = 0; i < count; ++i) {
        spheres.centers.push_back(
            Vector3<float>{random.between(-kRoom, kRoom), height, random.between(-kRoom, kRoom)});
        spheres.radii.push_back(random.between(0.3F, 1));
    }
    return spheres;
}

/// A method at work on a ground.
struct Contestant {
    const GroundMethod* method;
    float cellSize;  // [m]
    GroundFinder find;
};

std::vector<Contestant> contestants(const TriangleGround& mesh,
                                    std::span<const GroundMethod> methods,
                                    std::span<const float> cellSizes) {
    std::vector<Contestant> all;
    for (const GroundMethod& method : methods) {
        for (const float cellSize : cellSizes) {
            if (method.is("takes_cells") || cellSize == kUsualCell) {
                all.push_back({&method, cellSize, method.make(mesh, cellSize)});
            }
        }
    }
    return all;
}

/// Puts spheres on the ground; depths in it and heights above the place where they would touch it
/// are shares of their radii.
void rest(const GroundScene& ground, std::span<const Contestant> contestants, std::size_t count,
          Random& random, Measurements& measured) {
    const ExactGround truth(ground.mesh);
    SphereBatch spheres = randomSpheres(count, 0, random);
    std::vector<double> heights;
    for (std::size_t i = 0; i < count; ++i) {
        Vector3<float>& center = spheres.centers[i];
        heights.push_back(truth.restingHeight(center.x(), center.z(), spheres.radii[i]));
        center.y() = static_cast<float>(heights.back()) + kAbove;
    }
    std::vector<std::optional<Standing>> found(count);
    for (const Contestant& each : contestants) {
        each.find(spheres, found);
        for (std::size_t i = 0; i < count; ++i) {
            std::optional<double> depth;
            std::optional<double> above;
            if (found[i]) {
                const Vector3<float>& center = spheres.centers[i];
                const float radius = spheres.radii[i];
                const auto height = static_cast<double>(found[i]->height);
                depth = truth.penetration(center.x(), height, center.z(), radius) /
                        static_cast<double>(radius);
                above = std::max(height - heights[i], 0.0) / static_cast<double>(radius);
            }
            measured.add("spheres", {{"kind", ground.kind},
                                     {"slope", ground.slope},
                                     {"theory", 1 - std::cos(radians(ground.slope))},
                                     {"method", each.method->name},
                                     {"cell", each.cellSize},
                                     {"depth", depth},
                                     {"above", above}});
        }
    }
}

void time(const GroundScene& ground, std::span<const Contestant> contestants,
          const TerrainPlan& plan, Random& random, Measurements& measured) {
    SphereBatch spheres;
    std::vector<std::optional<Standing>> found(plan.spheresPerFrame);
    std::vector<TimedMethod> methods;
    for (const Contestant& each : contestants) {
        methods.push_back({{{"method", each.method->name}, {"cell", each.cellSize}},
                           [&] { each.find(spheres, found); }});
    }
    const float height = ground.mesh.bounds().max().y() + kAbove;
    measureTimes(
        measured, {plan.frames, 2},
        [&](int) { spheres = randomSpheres(plan.spheresPerFrame, height, random); }, methods);
}

/// A point of the map at that place of a random triangle.
Vector3<float> pointAt(const TriangleGround& mesh, std::string_view place, Random& random) {
    const auto triangle =
        static_cast<std::uint32_t>(random.unit() * static_cast<float>(mesh.boxes.size()));
    Vector3<float> point = mesh.corner(triangle, 0);
    if (place != "on corners") {
        point += random.unit() * (mesh.corner(triangle, 1) - point);
    }
    if (place == "anywhere") {
        point += random.unit() * (mesh.corner(triangle, 2) - point);
    }
    return point;
}

void askPoints(const TerrainPlan& plan, std::uint64_t seed, std::span<const GroundMethod> methods,
               Measurements& measured) {
    const TriangleGround mesh = hillsOf(0.3F, seed).mesh;
    const float height = mesh.bounds().max().y() + kAbove;
    const ExactGround truth(mesh);
    Random random(seed);
    for (const std::string_view place : {"anywhere", "on edges", "on corners"}) {
        SphereBatch points;
        while (points.radii.size() < plan.points) {
            const Vector3<float> point = pointAt(mesh, place, random);
            if (std::max(std::abs(point.x()), std::abs(point.z())) < kRoom) {
                points.centers.emplace_back(point.x(), height, point.z());
                points.radii.push_back(0);
            }
        }
        std::vector<std::optional<Standing>> found(plan.points);
        for (const GroundMethod& method : methods) {
            if (!method.is("finds_points")) {
                continue;
            }
            method.make(mesh, kUsualCell)(points, found);
            int noGround = 0;
            int told = 0;
            int wrong = 0;
            for (std::size_t i = 0; i < plan.points; ++i) {
                const bool tells = found[i] && found[i]->triangle;
                noGround += found[i] ? 0 : 1;
                told += tells ? 1 : 0;
                wrong += tells && !truth.isAt(*found[i]->triangle, points.centers[i].x(),
                                              points.centers[i].z())
                             ? 1
                             : 0;
            }
            measured.add("points", {{"place", place},
                                    {"method", method.name},
                                    {"points", plan.points},
                                    {"no_ground", noGround},
                                    {"told", told},
                                    {"wrong", wrong}});
        }
    }
}

}  // namespace

Findings findTerrain(const TerrainPlan& plan, std::uint64_t seed,
                     std::span<const GroundMethod> methods, const TellProgress& tell) {
    constexpr std::array usual{kUsualCell};
    constexpr std::array cellSizes{0.5F, 1.0F, kUsualCell, 4.0F, 8.0F};
    Measurements measured;
    measured.add("plan", {{"spheres_per_frame", plan.spheresPerFrame}, {"seed", seed}});
    addMethods(methods, {"must_rest", "sinks_by_line", "takes_cells"}, measured);
    Random random(seed + 1);
    for (int slope = 0; slope <= 80; slope += 10) {
        tell(0.3 * slope / 80, "slopes");
        for (const GroundScene& ground : {slopeOf(slope), terracesOf(slope)}) {
            rest(ground, contestants(ground.mesh, methods, usual), plan.spheres, random, measured);
        }
    }
    tell(0.3, "points");
    askPoints(plan, seed, methods, measured);
    tell(0.4, "times");
    const GroundScene hills = hillsOf(0, seed);
    const std::vector<Contestant> all = contestants(hills.mesh, methods, cellSizes);
    rest(hills, all, plan.spheres, random, measured);
    time(hills, all, plan, random, measured);
    return findingsOf(kTerrainDeclaration, measured);
}

Experiment terrainExperiment() {
    return {"P9",
            "Terrain",
            "How deep do spheres sink into slopes and at edges, and which methods find no ground?",
            3,
            22,
            [](const Effort& effort, const TellProgress& tell) {
                const TerrainPlan plan{effort.quickOrFull<std::size_t>(60, 500),
                                       effort.quickOrFull<std::size_t>(5000, 100'000),
                                       effort.quickOrFull(kFewestFrames, 2 * kFewestFrames),
                                       effort.quickOrFull<std::size_t>(1000, 5000)};
                return findTerrain(plan, effort.seed, groundMethods(), tell);
            }};
}

}  // namespace hashphase::demos
