// SPDX-License-Identifier: Zlib
//
// Culling by a map of cells on the ground, in the steps from what the paper describes to what is right.

#include <demos/accuracy/culling/culling_methods.hpp>

#include <demos/accuracy/baselines/paper_map.hpp>

#include <Eigen/LU>

#include <algorithm>

namespace hashphase::demos {
namespace {

class MapCulling : public Culling {
public:
    explicit MapCulling(const CullingScene& scene)
        : boxes_(scene.boxes), map_(scene.boxes, scene.cellSize), drawn_(scene.boxes.size()) {}

    [[nodiscard]] bool draws(std::uint32_t object) const override { return drawn_.has(object); }

protected:
    std::span<const Aabb<float>> boxes_;
    PaperMap map_;
    DrawList drawn_;
};

/// The paper's camera from above: the bottom left and the top right corner of the screen on the
/// ground, and the cells between. A line of sight that does not come down ends at the far plane.
class TwoCorners final : public MapCulling {
public:
    using MapCulling::MapCulling;

    CullingCost look(const CameraView& view) override {
        drawn_.clear();
        const Eigen::Matrix4f toWorld = view.viewProjection.inverse();
        const Vector3<float> a = onGround(toWorld, -1);
        const Vector3<float> b = onGround(toWorld, 1);
        const PaperMap::Range cells = map_.range(std::min(a.x(), b.x()), std::min(a.z(), b.z()),
                                                 std::max(a.x(), b.x()), std::max(a.z(), b.z()));
        CullingCost cost;
        for (int z = cells.lowZ; z <= cells.highZ; ++z) {
            for (int x = cells.lowX; x <= cells.highX; ++x) {
                ++cost.cells;
                for (const std::uint32_t object : map_.objects(x, z)) {
                    drawn_.add(object);
                }
            }
        }
        return cost;
    }

private:
    /// The point of the ground that is seen in the corner (at, at) of the screen.
    static Vector3<float> onGround(const Eigen::Matrix4f& toWorld, float at) {
        const Vector3<float> near = (toWorld * Eigen::Vector4f(at, at, 0, 1)).eval().hnormalized();
        const Vector3<float> far = (toWorld * Eigen::Vector4f(at, at, 1, 1)).eval().hnormalized();
        const float fraction = near.y() / (near.y() - far.y());
        return fraction > 0 && fraction < 1 ? near + fraction * (far - near) : far;
    }
};

// No plane has all of the box outside: the corner farthest along its normal decides.
bool mayTouch(const CameraView& view, const Aabb<float>& box) {
    return std::all_of(view.planes.begin(), view.planes.end(), [&](const auto& plane) {
        const Vector3<float> corner = (plane.normal().array() > 0).select(box.max(), box.min());
        return plane.signedDistance(corner) >= 0;
    });
}

/// What a cell is tested as.
enum class CellHeight : std::uint8_t { flat, ofItsObjects };

/// The paper's free camera: every cell of the map against the six planes. Flat, as the paper has
/// them; or as high as what stands in them. Draws all in a cell, or tests each of them as well.
class CellsInFrustum final : public MapCulling {
public:
    CellsInFrustum(const CullingScene& scene, CellHeight height, bool testsObjects)
        : MapCulling(scene), testsObjects_(testsObjects) {
        const PaperMap::Range all = map_.all();
        for (int z = 0; z <= all.highZ; ++z) {
            for (int x = 0; x <= all.highX; ++x) {
                Aabb<float> cell = map_.square(x, z);
                for (const std::uint32_t object : map_.objects(x, z)) {
                    if (height == CellHeight::ofItsObjects) {
                        cell.extend(boxes_[object]);
                    }
                }
                if (!map_.objects(x, z).empty()) {
                    cells_.push_back({cell, x, z});
                }
            }
        }
    }

    CullingCost look(const CameraView& view) override {
        drawn_.clear();
        CullingCost cost;
        cost.cells = cells_.size();
        for (const Cell& cell : cells_) {
            if (mayTouch(view, cell.box)) {
                drawObjectsIn(cell, view, cost);
            }
        }
        return cost;
    }

private:
    struct Cell {
        Aabb<float> box;
        int x;
        int z;
    };

    void drawObjectsIn(const Cell& cell, const CameraView& view, CullingCost& cost) {
        for (const std::uint32_t object : map_.objects(cell.x, cell.z)) {
            if (testsObjects_) {
                ++cost.boxes;
                if (!mayTouch(view, boxes_[object])) {
                    continue;
                }
            }
            drawn_.add(object);
        }
    }

    bool testsObjects_;
    std::vector<Cell> cells_;  // those that are not empty
};

}  // namespace

std::vector<CullingMethod> mapCullingMethods() {
    const auto cells = [](CellHeight height, bool testsObjects) {
        return [=](const CullingScene& scene) {
            return std::make_unique<CellsInFrustum>(scene, height, testsObjects);
        };
    };
    const auto twoCorners = [](const CullingScene& scene) {
        return std::make_unique<TwoCorners>(scene);
    };
    return {
        {"paper: two corners", false, false, false, true, twoCorners},
        {"paper: flat cells, six planes", false, false, false, true,
         cells(CellHeight::flat, false)},
        {"cells with heights, six planes", false, false, false, true,
         cells(CellHeight::ofItsObjects, false)},
        {"cells, then objects, six planes", false, false, false, true,
         cells(CellHeight::ofItsObjects, true)},
    };
}

}  // namespace hashphase::demos
