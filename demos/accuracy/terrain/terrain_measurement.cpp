// SPDX-License-Identifier: Zlib
#include <demos/accuracy/terrain/terrain_experiment.hpp>

#include <demos/accuracy/terrain/exact_ground.hpp>
#include <demos/accuracy/timing.hpp>
#include <demos/scenes/random.hpp>
#include <demos/scenes/terrain.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hashphase::demos {
namespace {

constexpr float kRoom = GroundMesh::kHalf - 2;  // no sphere reaches the border
constexpr float kAbove = 2;                     // where spheres ask from, above where they rest [m]
constexpr float kSteepness = 4;                 // hills are so many times as high as Terrain's

GroundMesh meshOf(GroundKind kind, double slope, float jitter, std::uint64_t seed) {
    const auto rise = static_cast<float>(std::tan(slope * std::numbers::pi / 180));
    switch (kind) {
        case GroundKind::slope:
            return {[rise](float x, float) { return rise * x; }, jitter, seed};
        case GroundKind::terraces:
            return {[rise](float x, float) {
                        const float along = x - 16 * std::floor(x / 16);
                        return rise * std::clamp(std::min(along - 4, 16 - along), 0.0F, 4.0F);
                    },
                    jitter, seed};
        case GroundKind::hills:
            break;
    }
    const Terrain hills(seed);
    return {[&hills](float x, float z) { return kSteepness * hills.height(x, z); }, jitter, seed};
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

/// Spheres, each a little above where it rests, and that height.
struct RestingSpheres {
    SphereBatch batch;
    std::vector<double> heights;
};

RestingSpheres restingSpheres(const ExactGround& truth, std::size_t count, Random& random) {
    RestingSpheres spheres{randomSpheres(count, 0, random), {}};
    for (std::size_t i = 0; i < count; ++i) {
        Vector3<float>& center = spheres.batch.centers[i];
        spheres.heights.push_back(
            truth.restingHeight(center.x(), center.z(), spheres.batch.radii[i]));
        center.y() = static_cast<float>(spheres.heights.back()) + kAbove;
    }
    return spheres;
}

void judge(const RestingSpheres& spheres, std::span<const std::optional<Standing>> found,
           const ExactGround& truth, RestRow& row) {
    row.spheres = found.size();
    std::size_t standing = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!found[i]) {
            ++row.noGround;
            continue;
        }
        ++standing;
        const Vector3<float>& center = spheres.batch.centers[i];
        const float radius = spheres.batch.radii[i];
        const auto height = static_cast<double>(found[i]->height);
        const double share = 1 / static_cast<double>(radius);
        const double depth = share * truth.penetration(center.x(), height, center.z(), radius);
        const double above = share * std::max(height - spheres.heights[i], 0.0);
        row.meanDepth += depth;
        row.meanHeight += above;
        row.worstDepth = std::max(row.worstDepth, depth);
        row.worstHeight = std::max(row.worstHeight, above);
    }
    const auto number = static_cast<double>(std::max<std::size_t>(standing, 1));
    row.meanDepth /= number;
    row.meanHeight /= number;
}

struct Entry {
    RestRow row;
    std::unique_ptr<GroundFinder> finder;
};

std::vector<Entry> entriesFor(GroundKind kind, double slope, const GroundMesh& mesh,
                              std::span<const GroundMethod> methods,
                              std::span<const float> cellSizes) {
    std::vector<Entry> entries;
    for (const GroundMethod& method : methods) {
        for (const float cellSize : cellSizes) {
            if (method.takesCells || cellSize == kUsualCell) {
                RestRow row{&method, kind, slope, cellSize};
                entries.push_back({row, method.make(mesh, cellSize)});
            }
        }
    }
    return entries;
}

void rest(std::span<Entry> entries, const GroundMesh& mesh, std::size_t count, Random& random) {
    const ExactGround truth(mesh);
    const RestingSpheres spheres = restingSpheres(truth, count, random);
    std::vector<std::optional<Standing>> found(count);
    for (Entry& entry : entries) {
        entry.finder->find(spheres.batch, found);
        judge(spheres, found, truth, entry.row);
    }
}

void time(std::span<Entry> entries, const GroundMesh& mesh, const TerrainPlan& plan,
          Random& random) {
    constexpr int warmUp = 2;
    SphereBatch spheres;
    std::vector<std::optional<Standing>> found(plan.spheresPerFrame);
    std::vector<std::function<void()>> runs;
    for (Entry& entry : entries) {
        runs.emplace_back(
            [&spheres, &found, &finder = *entry.finder] { finder.find(spheres, found); });
    }
    const float height = mesh.bounds().max().y() + kAbove;
    const std::vector<Spread> times = timeInTurn(
        plan.frames, warmUp,
        [&](int) { spheres = randomSpheres(plan.spheresPerFrame, height, random); }, runs);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        entries[i].row.isTimed = true;
        entries[i].row.milliseconds = times[i];
    }
}

// A point of the map at that place of a random triangle.
Vector3<float> pointAt(const GroundMesh& mesh, PointPlace place, Random& random) {
    const auto triangle =
        static_cast<std::uint32_t>(random.unit() * static_cast<float>(mesh.triangles()));
    const auto& [a, b, c] = mesh.corners(triangle);
    if (place == PointPlace::onCorners) {
        return a;
    }
    const float u = random.unit();
    const Vector3<float> onEdge = a + u * (b - a);
    return place == PointPlace::onEdges ? onEdge
                                        : Vector3<float>(onEdge + random.unit() * (c - onEdge));
}

SphereBatch pointsAt(const GroundMesh& mesh, PointPlace place, std::size_t count, Random& random) {
    const float height = mesh.bounds().max().y() + kAbove;
    SphereBatch points;
    while (points.size() < count) {
        Vector3<float> point = pointAt(mesh, place, random);
        if (std::max(std::abs(point.x()), std::abs(point.z())) < kRoom) {
            point.y() = height;
            points.centers.push_back(point);
            points.radii.push_back(0);
        }
    }
    return points;
}

std::vector<PointRow> askPoints(const TerrainPlan& plan, std::uint64_t seed,
                                std::span<const GroundMethod> methods) {
    constexpr float jitter = 0.3F;
    const GroundMesh mesh = meshOf(GroundKind::hills, 0, jitter, seed);
    const ExactGround truth(mesh);
    Random random(seed);
    std::vector<PointRow> rows;
    for (const PointPlace place : kPointPlaces) {
        const SphereBatch points = pointsAt(mesh, place, plan.points, random);
        std::vector<std::optional<Standing>> found(points.size());
        for (const GroundMethod& method : methods) {
            if (method.needsRegular || !method.findsPoints) {
                continue;
            }
            PointRow row{&method, place, points.size()};
            method.make(mesh, kUsualCell)->find(points, found);
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Vector3<float>& point = points.centers[i];
                row.noGround += found[i] ? 0U : 1U;
                const bool tells = found[i] && found[i]->triangle != Standing::kUntold;
                row.tellsTriangle = row.tellsTriangle || tells;
                row.wrongTriangle +=
                    tells && !truth.isAt(found[i]->triangle, point.x(), point.z()) ? 1U : 0U;
            }
            rows.push_back(row);
        }
    }
    return rows;
}

}  // namespace

std::string_view nameOf(PointPlace place) {
    constexpr std::array<std::string_view, 3> names{"anywhere", "on edges", "on corners"};
    return names[static_cast<std::size_t>(place)];
}

TerrainMeasurement measureTerrain(const TerrainPlan& plan, std::uint64_t seed,
                                  std::span<const GroundMethod> methods, const TellProgress& tell) {
    constexpr std::array usual{kUsualCell};
    constexpr std::array cellSizes{0.5F, 1.0F, kUsualCell, 4.0F, 8.0F};
    TerrainMeasurement measured;
    Random random(seed + 1);
    for (int slope = 0; slope <= 80; slope += 10) {
        tell(0.3 * slope / 80, "slopes");
        for (const GroundKind kind : {GroundKind::slope, GroundKind::terraces}) {
            const GroundMesh mesh = meshOf(kind, slope, 0, seed);
            std::vector<Entry> entries = entriesFor(kind, slope, mesh, methods, usual);
            rest(entries, mesh, plan.spheres, random);
            for (const Entry& entry : entries) {
                measured.rests.push_back(entry.row);
            }
        }
    }
    tell(0.3, "points");
    measured.points = askPoints(plan, seed, methods);
    tell(0.4, "times");
    const GroundMesh hills = meshOf(GroundKind::hills, 0, 0, seed);
    std::vector<Entry> entries = entriesFor(GroundKind::hills, 0, hills, methods, cellSizes);
    rest(entries, hills, plan.spheres, random);
    time(entries, hills, plan, random);
    for (const Entry& entry : entries) {
        measured.rests.push_back(entry.row);
    }
    return measured;
}

}  // namespace hashphase::demos
