// SPDX-License-Identifier: Zlib
#include <demos/accuracy/culling/culling_experiment.hpp>

#include <demos/accuracy/baselines/dbvt_boxes.hpp>
#include <demos/accuracy/baselines/paper_map.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/camera/ground_footprint.hpp>
#include <integration/culling/culler.hpp>

#include <Eigen/LU>

#include <algorithm>

namespace hashphase::demos {
namespace {

/// The objects that are to be drawn, a bit each.
class DrawList {
public:
    explicit DrawList(std::size_t objects) : bits_((objects + 63) / 64) {}

    void clear() { std::fill(bits_.begin(), bits_.end(), 0); }
    void add(std::uint32_t object) { bits_[object / 64] |= std::uint64_t{1} << (object % 64); }
    [[nodiscard]] bool has(std::uint32_t object) const {
        return (bits_[object / 64] >> (object % 64) & 1) != 0;
    }
    [[nodiscard]] std::vector<std::uint64_t>& bits() { return bits_; }

private:
    std::vector<std::uint64_t> bits_;
};

/// A culling that lists what it sees: find(view, drawn) returns what it cost.
template <class Find>
Culling listing(const CullingScene& scene, Find find) {
    const auto drawn = std::make_shared<DrawList>(scene.boxes.size());
    return {[=](const CameraView& view) {
                drawn->clear();
                return find(view, *drawn);
            },
            [=](std::uint32_t object) { return drawn->has(object); }};
}

// --- By a map of cells on the ground, from what the paper describes to what is right -----------------

/// The point of the ground that is seen in the corner (at, at) of the screen.
Vector3<float> onGround(const Eigen::Matrix4f& toWorld, float at) {
    const Vector3<float> near = (toWorld * Eigen::Vector4f(at, at, 0, 1)).eval().hnormalized();
    const Vector3<float> far = (toWorld * Eigen::Vector4f(at, at, 1, 1)).eval().hnormalized();
    const float fraction = near.y() / (near.y() - far.y());
    return fraction > 0 && fraction < 1 ? near + fraction * (far - near) : far;
}

/// The paper's camera from above: the bottom left and the top right corner of the screen on the
/// ground, and the cells between. A line of sight that does not come down ends at the far plane.
Culling twoCorners(const CullingScene& scene) {
    const auto map = std::make_shared<PaperMap>(scene.boxes, scene.cellSize);
    return listing(scene, [map](const CameraView& view, DrawList& drawn) {
        const Eigen::Matrix4f toWorld = view.viewProjection.inverse();
        const Vector3<float> a = onGround(toWorld, -1);
        const Vector3<float> b = onGround(toWorld, 1);
        const PaperMap::Range cells = map->range(std::min(a.x(), b.x()), std::min(a.z(), b.z()),
                                                 std::max(a.x(), b.x()), std::max(a.z(), b.z()));
        CullingCost cost;
        forEachCell(cells, [&](int x, int z) {
            ++cost.cells;
            for (const std::uint32_t object : map->objects(x, z)) {
                drawn.add(object);
            }
        });
        return cost;
    });
}

// No plane has all of the box outside: the corner farthest along its normal decides.
bool mayTouch(const CameraView& view, const Aabb<float>& box) {
    return std::all_of(view.planes.begin(), view.planes.end(), [&](const auto& plane) {
        const Vector3<float> corner = (plane.normal().array() > 0).select(box.max(), box.min());
        return plane.signedDistance(corner) >= 0;
    });
}

/// The paper's free camera: every cell of the map that is not empty against the six planes. Flat, as
/// the paper has them; or as high as what stands in them. Draws all in a cell, or tests each of them
/// as well.
Culling cellsInFrustum(const CullingScene& scene, bool haveHeights, bool testsObjects) {
    struct Cell {
        Aabb<float> box;
        int x;
        int z;
    };
    struct Filed {
        PaperMap map;
        std::vector<Cell> cells;
    };
    const auto filed = std::make_shared<Filed>(Filed{PaperMap(scene.boxes, scene.cellSize), {}});
    forEachCell(filed->map.all(), [&](int x, int z) {
        const std::span<const std::uint32_t> objects = filed->map.objects(x, z);
        Aabb<float> box = filed->map.square(x, z);
        for (const std::uint32_t object : objects) {
            if (haveHeights) {
                box.extend(scene.boxes[object]);
            }
        }
        if (!objects.empty()) {
            filed->cells.push_back({box, x, z});
        }
    });
    return listing(scene, [=, boxes = scene.boxes](const CameraView& view, DrawList& drawn) {
        CullingCost cost{filed->cells.size(), 0};
        for (const Cell& cell : filed->cells) {
            if (!mayTouch(view, cell.box)) {
                continue;
            }
            for (const std::uint32_t object : filed->map.objects(cell.x, cell.z)) {
                cost.boxes += testsObjects ? 1 : 0;
                if (!testsObjects || mayTouch(view, boxes[object])) {
                    drawn.add(object);
                }
            }
        }
        return cost;
    });
}

// --- By the library ----------------------------------------------------------------------------------

/// In an empty grid, ids count from 0, as the objects do.
std::shared_ptr<Grid<float>> filedInGrid(const CullingScene& scene, double cellSize = 0) {
    const auto grid = std::make_shared<Grid<float>>(GridConfig{.cellSize = cellSize});
    for (const Aabb<float>& box : scene.boxes) {
        static_cast<void>(grid->add(box));
    }
    grid->update();
    return grid;
}

/// What touches the region that regionOf(view) returns.
template <class RegionOf>
Culling inRegion(const CullingScene& scene, const RegionOf& regionOf) {
    return listing(scene, [=, grid = filedInGrid(scene)](const CameraView& view, DrawList& drawn) {
        CollectBits collector(drawn.bits());
        const QueryCost cost = grid->visit(regionOf(view), collector);
        return CullingCost{cost.rowsVisited, cost.boxesTested};
    });
}

Culling inFrustum(const CullingScene& scene, Touch touch) {
    return inRegion(scene, [touch](const CameraView& view) {
        return ConvexRegion<float>(view.planes, Containment::touching, touch);
    });
}

/// All that stands on what the camera sees of the ground up to a height.
Culling inFootprint(const CullingScene& scene, float height) {
    return inRegion(scene, [height](const CameraView& view) -> ConvexRegion<float> {
        return GroundFootprint<float>(view.viewProjection, kDepthRange, {0, height}).region();
    });
}

Culling withCuller(const CullingScene& scene, float margin, double cellSize) {
    const auto culler = std::make_shared<Culler<float>>(margin);
    const auto grid = filedInGrid(scene, cellSize);
    return {[=](const CameraView& view) {
                const ConvexRegion<float> region(view.planes, Containment::touching,
                                                 Touch::byPlanes);
                const QueryCost cost = culler->look(*grid, region, 0);  // nothing has moved
                return CullingCost{cost.rowsVisited, cost.boxesTested};
            },
            [=](std::uint32_t object) { return culler->isVisible(grid->idAt(object)); }};
}

// --- By Bullet ---------------------------------------------------------------------------------------

/// btDbvt::collideKDOP, Bullet's walk of its trees for planes.
Culling kdop(const CullingScene& scene) {
    struct Draw final : btDbvt::ICollide {
        explicit Draw(DrawList& list) : drawn(list) {}
        void Process(const btDbvtNode* leaf) override {
            drawn.add(
                FilledBroadphase::objectOf(*static_cast<const btBroadphaseProxy*>(leaf->data)));
        }
        DrawList& drawn;
    };
    return listing(
        scene, [filed = filedInDbvt(scene.boxes)](const CameraView& view, DrawList& drawn) {
            std::array<btVector3, 6> normals;
            std::array<btScalar, 6> offsets;
            for (std::size_t i = 0; i < view.planes.size(); ++i) {
                normals[i] = toBullet(view.planes[i].normal());
                offsets[i] = view.planes[i].offset();
            }
            Draw draw(drawn);
            for (const btDbvt& tree : dbvtOf(*filed).m_sets) {
                btDbvt::collideKDOP(tree.m_root, normals.data(), offsets.data(), 6, draw);
            }
            return CullingCost{};  // Bullet does not tell
        });
}

}  // namespace

std::vector<CullingMethod> cullingMethods() {
    const auto cells = [](bool haveHeights, bool testsObjects) {
        return [=](const CullingScene& scene) {
            return cellsInFrustum(scene, haveHeights, testsObjects);
        };
    };
    const auto frustum = [](Touch touch) {
        return [=](const CullingScene& scene) { return inFrustum(scene, touch); };
    };
    const auto culler = [](float margin) {
        return [=](const CullingScene& scene) { return withCuller(scene, margin, 0); };
    };
    const auto cullerOfCells = [](const CullingScene& scene) {
        return withCuller(scene, 0, static_cast<double>(scene.cellSize));
    };
    const auto atGround = [](const CullingScene& scene) { return inFootprint(scene, 0); };
    const auto upToTallest = [](const CullingScene& scene) {
        return inFootprint(scene, scene.tallest);
    };
    return {
        {"paper: two corners", "paper takes_cells", twoCorners},
        {"paper: flat cells, six planes", "paper takes_cells", cells(false, false)},
        {"cells with heights, six planes", "others takes_cells", cells(true, false)},
        {"cells, then objects, six planes", "others takes_cells", cells(true, true)},
        {"GroundFootprint at the ground", "ours", atGround},
        {"GroundFootprint up to the tallest", "ours must_see_all", upToTallest},
        {"ConvexRegion by planes", "ours must_see_all", frustum(Touch::byPlanes)},
        {"ConvexRegion exact", "ours must_see_all must_be_exact", frustum(Touch::exact)},
        {"Culler", "ours must_see_all", culler(0)},
        {"Culler, margin 4 m", "ours must_see_all", culler(4)},
        {"Culler, fixed cells", "ours must_see_all takes_cells", cullerOfCells},
        {"btDbvt::collideKDOP", "bullet", kdop},
    };
}

}  // namespace hashphase::demos
