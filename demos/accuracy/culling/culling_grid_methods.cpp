// SPDX-License-Identifier: Zlib
//
// Culling by the library, and by Bullet's trees.

#include <demos/accuracy/culling/culling_methods.hpp>

#include <demos/accuracy/baselines/dbvt_boxes.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/camera/ground_footprint.hpp>
#include <integration/culling/culler.hpp>

#include <array>

namespace hashphase::demos {
namespace {

/// The library's grid with the objects in it; of an empty grid, the ids count from 0.
class GridCulling : public Culling {
public:
    explicit GridCulling(const CullingScene& scene, double cellSize = 0)
        : grid_({.cellSize = cellSize}), drawn_(scene.boxes.size()) {
        for (const Aabb<float>& box : scene.boxes) {
            ids_.push_back(grid_.add(box));
        }
        grid_.update();
    }

    [[nodiscard]] bool draws(std::uint32_t object) const override {
        return drawn_.has(ids_[object].index);
    }

protected:
    CullingCost find(const ConvexRegion<float>& region) {
        drawn_.clear();
        CollectBits collector(drawn_.bits());
        const QueryCost cost = grid_.visit(region, collector);
        return {cost.rowsVisited, cost.boxesTested};
    }

    Grid<float> grid_;
    std::vector<ProxyId> ids_;  // by object
    DrawList drawn_;
};

class Region final : public GridCulling {
public:
    Region(const CullingScene& scene, Touch touch) : GridCulling(scene), touch_(touch) {}

    CullingCost look(const CameraView& view) override {
        return find(ConvexRegion<float>(view.planes, Containment::touching, touch_));
    }

private:
    Touch touch_;
};

/// All that stands on what the camera sees of the ground up to a height.
class Footprint final : public GridCulling {
public:
    Footprint(const CullingScene& scene, float height) : GridCulling(scene), height_(height) {}

    CullingCost look(const CameraView& view) override {
        const GroundFootprint<float> footprint(view.viewProjection, kDepthRange, {0, height_});
        return find(footprint.region());
    }

private:
    float height_;
};

class WithCuller final : public GridCulling {
public:
    WithCuller(const CullingScene& scene, float margin, double cellSize)
        : GridCulling(scene, cellSize), culler_(margin) {}

    CullingCost look(const CameraView& view) override {
        const ConvexRegion<float> region(view.planes, Containment::touching, Touch::byPlanes);
        const QueryCost cost = culler_.look(grid_, region, 0);  // nothing has moved
        return {cost.rowsVisited, cost.boxesTested};
    }

    [[nodiscard]] bool draws(std::uint32_t object) const override {
        return culler_.isVisible(ids_[object]);
    }

private:
    Culler<float> culler_;
};

/// btDbvt::collideKDOP, Bullet's walk of its trees for planes.
class Kdop final : public Culling {
public:
    explicit Kdop(const CullingScene& scene) : boxes_(scene.boxes), drawn_(scene.boxes.size()) {}

    CullingCost look(const CameraView& view) override {
        drawn_.clear();
        std::array<btVector3, 6> normals;
        std::array<btScalar, 6> offsets;
        for (std::size_t i = 0; i < view.planes.size(); ++i) {
            normals[i] = toBullet(view.planes[i].normal());
            offsets[i] = view.planes[i].offset();
        }
        Draw draw(drawn_);
        for (const btDbvt& tree : boxes_.broadphase().m_sets) {
            btDbvt::collideKDOP(tree.m_root, normals.data(), offsets.data(), 6, draw);
        }
        return {};  // Bullet does not tell
    }

    [[nodiscard]] bool draws(std::uint32_t object) const override { return drawn_.has(object); }

private:
    struct Draw final : btDbvt::ICollide {
        explicit Draw(DrawList& list) : drawn(list) {}
        void Process(const btDbvtNode* leaf) override {
            drawn.add(DbvtBoxes::objectOf(*static_cast<const btBroadphaseProxy*>(leaf->data)));
        }
        DrawList& drawn;
    };

    DbvtBoxes boxes_;
    DrawList drawn_;
};

constexpr float kMargin = 4;  // [m]

}  // namespace

std::vector<CullingMethod> gridCullingMethods() {
    const auto region = [](Touch touch) {
        return [=](const CullingScene& scene) { return std::make_unique<Region>(scene, touch); };
    };
    const auto culler = [](float margin) {
        return [=](const CullingScene& scene) {
            return std::make_unique<WithCuller>(scene, margin, 0);
        };
    };
    const auto cullerOfCells = [](const CullingScene& scene) {
        return std::make_unique<WithCuller>(scene, 0.0F, static_cast<double>(scene.cellSize));
    };
    const auto footprintAtGround = [](const CullingScene& scene) {
        return std::make_unique<Footprint>(scene, 0.0F);
    };
    const auto footprint = [](const CullingScene& scene) {
        return std::make_unique<Footprint>(scene, scene.tallest);
    };
    const auto kdop = [](const CullingScene& scene) { return std::make_unique<Kdop>(scene); };
    return {
        {"GroundFootprint at the ground", true, false, false, false, footprintAtGround},
        {"GroundFootprint up to the tallest", true, true, false, false, footprint},
        {"ConvexRegion by planes", true, true, false, false, region(Touch::byPlanes)},
        {"ConvexRegion exact", true, true, true, false, region(Touch::exact)},
        {"Culler", true, true, false, false, culler(0)},
        {"Culler, margin 4 m", true, true, false, false, culler(kMargin)},
        {"Culler, fixed cells", true, true, false, true, cullerOfCells},
        {"btDbvt::collideKDOP", false, false, false, false, kdop},
    };
}

std::vector<CullingMethod> cullingMethods() {
    std::vector<CullingMethod> all = mapCullingMethods();
    for (CullingMethod& each : gridCullingMethods()) {
        all.push_back(std::move(each));
    }
    return all;
}

}  // namespace hashphase::demos
