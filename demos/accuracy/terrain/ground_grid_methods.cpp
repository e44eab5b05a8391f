// SPDX-License-Identifier: Zlib
#include <demos/accuracy/terrain/ground_methods.hpp>

#include <demos/accuracy/baselines/paper_map.hpp>
#include <integration/terrain/terrain.hpp>

namespace hashphase::demos {
namespace {

std::vector<Aabb<float>> trianglesBoxes(const GroundMesh& mesh) {
    std::vector<Aabb<float>> boxes(mesh.triangles());
    for (std::uint32_t i = 0; i < mesh.triangles(); ++i) {
        for (const Vector3<float>& corner : mesh.corners(i)) {
            boxes[i].extend(corner);
        }
    }
    return boxes;
}

/// How the paper lifts a sphere from the height of the ground below its centre: by its radius. Or by
/// what is right on a slope without end.
enum class Lift : std::uint8_t { radius, radiusOnSlope };

/// The paper's terrain: all triangles in a map of cells, the one that has the point within its three
/// corners on the map, the height between them. A point that rounding puts outside of both triangles
/// at an edge has none.
class PaperGround final : public GroundFinder {
public:
    PaperGround(const GroundMesh& mesh, float cellSize, Lift lift)
        : map_(trianglesBoxes(mesh), cellSize), lift_(lift) {
        for (std::uint32_t i = 0; i < mesh.triangles(); ++i) {
            triangles_.push_back(mesh.corners(i));
        }
    }

    void find(const SphereBatch& spheres, std::span<std::optional<Standing>> found) override {
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            found[i] = findOne(spheres.centers[i], spheres.radii[i]);
        }
    }

private:
    [[nodiscard]] std::optional<Standing> findOne(const Vector3<float>& p, float radius) const {
        const PaperMap::Range cell = map_.range(p.x(), p.z(), p.x(), p.z());
        for (const std::uint32_t triangle : map_.objects(cell.lowX, cell.lowZ)) {
            const auto& [a, b, c] = triangles_[triangle];
            const Vector3<float> ab = b - a;
            const Vector3<float> ac = c - a;
            const Vector3<float> ap = p - a;
            const float area = ab.x() * ac.z() - ab.z() * ac.x();
            const float u = (ap.x() * ac.z() - ap.z() * ac.x()) / area;
            const float v = (ab.x() * ap.z() - ab.z() * ap.x()) / area;
            if (u >= 0 && v >= 0 && u + v <= 1) {
                const float height = a.y() + u * ab.y() + v * ac.y();
                const float up = std::abs(ab.cross(ac).normalized().y());
                return Standing{height + (lift_ == Lift::radius ? radius : radius / up), triangle};
            }
        }
        return std::nullopt;
    }

    PaperMap map_;
    Lift lift_;
    std::vector<TriangleCorners> triangles_;
};

enum class Asking : std::uint8_t { oneByOne, allAtOnce };

/// The library's. Points ask for the surface.
class TerrainGround final : public GroundFinder {
public:
    TerrainGround(const GroundMesh& mesh, double cellSize, Asking asking)
        : grid_({.cellSize = cellSize}), terrain_(grid_), asking_(asking) {
        terrain_.add(mesh.vertices(), mesh.indices());
        grid_.update();
    }

    void find(const SphereBatch& spheres, std::span<std::optional<Standing>> found) override {
        grounds_.resize(spheres.size());
        if (asking_ == Asking::allAtOnce) {
            terrain_.restingHeights(spheres.centers, spheres.radii, grounds_);
        } else {
            for (std::size_t i = 0; i < spheres.size(); ++i) {
                grounds_[i] = spheres.radii[i] > 0
                                  ? terrain_.restingHeight(spheres.centers[i], spheres.radii[i])
                                  : terrain_.surfaceBelow(spheres.centers[i]);
            }
        }
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            found[i].reset();
            if (grounds_[i]) {
                found[i] = Standing{grounds_[i]->height, grounds_[i]->triangle};
            }
        }
    }

private:
    Grid<float> grid_;
    Terrain<float> terrain_;
    Asking asking_;
    std::vector<Terrain<float>::Found> grounds_;
};

}  // namespace

std::vector<GroundMethod> gridGroundMethods() {
    const auto paper = [](Lift lift) {
        GroundMethod method;
        method.takesCells = true;
        method.make = [lift](const GroundMesh& mesh, float cellSize) {
            return std::make_unique<PaperGround>(mesh, cellSize, lift);
        };
        return method;
    };
    const auto terrain = [](Asking asking, bool takesCells) {
        GroundMethod method;
        method.isOurs = true;
        method.mustRest = true;
        method.takesCells = takesCells;
        method.make = [asking, takesCells](const GroundMesh& mesh, float cellSize) {
            const double fixedSize = takesCells ? static_cast<double>(cellSize) : 0;
            return std::make_unique<TerrainGround>(mesh, fixedSize, asking);
        };
        return method;
    };
    std::vector<GroundMethod> methods{
        paper(Lift::radius), paper(Lift::radiusOnSlope), terrain(Asking::oneByOne, false),
        terrain(Asking::allAtOnce, false), terrain(Asking::allAtOnce, true)};
    methods[0].name = "paper: height + r";
    methods[0].sinksByLine = true;
    methods[1].name = "height + r / n_y";
    methods[2].name = "Terrain, one by one";
    methods[3].name = "Terrain, all at once";
    methods[4].name = "Terrain, all at once, fixed cells";
    return methods;
}

std::vector<GroundMethod> groundMethods() {
    std::vector<GroundMethod> all = gridGroundMethods();
    for (GroundMethod& each : bulletGroundMethods()) {
        all.push_back(std::move(each));
    }
    return all;
}

}  // namespace hashphase::demos
