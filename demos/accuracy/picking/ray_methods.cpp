// SPDX-License-Identifier: Zlib
#include <demos/accuracy/picking/picking_experiment.hpp>

#include <broadphase/grid.hpp>
#include <broadphase/regions.hpp>
#include <demos/accuracy/baselines/dbvt_boxes.hpp>
#include <demos/accuracy/picking/cell_walks.hpp>
#include <integration/bullet/conversions.hpp>

#include <LinearMath/btAabbUtil2.h>

#include <memory>

namespace hashphase::demos {
namespace {

using Boxes = std::span<const Aabb<float>>;

// --- Through plain cells -------------------------------------------------------------------------
//
// Whichever cells a method visits, the boxes in them are tested in the same way, so that methods
// differ by nothing else.

/// walk(ray, visit) calls visit(cell).
template <class Walk>
RayCaster cellCaster(Boxes boxes, bool isFlat, const Walk& walk) {
    struct Filed {
        HashedCells cells;
        std::vector<std::uint32_t> testedBy;  // the last ray that tested the box
        std::uint32_t rays = 0;
    };
    const auto filed = std::make_shared<Filed>(
        Filed{HashedCells(boxes.size()), std::vector<std::uint32_t>(boxes.size())});
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        visitBox(boxes[i], isFlat, [&](const Cell& cell) { filed->cells.file(cell, i); });
    }
    return [=](const Ray& ray, std::vector<RayHit>& hits) {
        ++filed->rays;
        RayCost cost;
        const RayRegion<float> region(ray.from, ray.to);
        walk(ray, [&](const Cell& cell) {
            ++cost.cells;
            filed->cells.visitObjects(cell, [&](std::uint32_t box) {
                if (filed->testedBy[box] == filed->rays) {
                    return;
                }
                filed->testedBy[box] = filed->rays;
                ++cost.boxes;
                if (const float key = region.key(boxes[box]); key >= 0) {
                    hits.push_back({box, key});
                }
            });
        });
        return cost;
    };
}

template <class Walk>
auto walker(bool isFlat, const Walk& walk) {
    return [=](Boxes boxes) { return cellCaster(boxes, isFlat, walk); };
}

/// The paper's picking in a grid of two dimensions: the cell in which the ray meets the ground.
/// That is in the middle of all boxes here: what the paper's ground is to a scene that is no
/// ground.
RayCaster planePoint(Boxes boxes) {
    Aabb<float> bounds;
    for (const Aabb<float>& box : boxes) {
        bounds.extend(box);
    }
    const float height = bounds.center().y();
    return cellCaster(boxes, true, [height](const Ray& ray, const auto& visit) {
        const float fraction = (height - ray.from.y()) / (ray.to.y() - ray.from.y());
        if (fraction >= 0 && fraction <= 1) {
            visit(cellOf(ray.from + fraction * (ray.to - ray.from), true));
        }
    });
}

/// The ray's shadow on the map, drawn cell by cell.
constexpr auto kFlatRaster = [](const Ray& ray, const auto& visit) {
    const auto onMap = [](const Vector3<float>& p) { return Vector3<float>(p.x(), 0, p.z()); };
    walkFaces(onMap(ray.from), onMap(ray.to), BorderTimes::multiplied, visit);
};

constexpr auto kLayers = [](const Ray& ray, const auto& visit) {
    walkLayers(ray.from, ray.to, visit);
};

constexpr auto faces(BorderTimes times) {
    return
        [times](const Ray& ray, const auto& visit) { walkFaces(ray.from, ray.to, times, visit); };
}

// --- By the library ------------------------------------------------------------------------------

/// In an empty grid, ids count from 0.
struct CollectHits {
    std::vector<RayHit>& hits;

    void add(ProxyId id, float key) { hits.push_back({id.index, key}); }
    [[nodiscard]] static constexpr float limit() { return std::numeric_limits<float>::infinity(); }
};

RayCaster gridCaster(Boxes boxes, bool nearestOnly) {
    const auto grid = std::make_shared<Grid<float>>();
    for (const Aabb<float>& box : boxes) {
        static_cast<void>(grid->add(box));
    }
    grid->update();
    return [=](const Ray& ray, std::vector<RayHit>& hits) {
        const RayRegion<float> region(ray.from, ray.to);
        QueryCost cost;
        if (nearestOnly) {
            CollectClosest<float> closest;
            cost = grid->visit(region, closest);
            if (!closest.found().isNull()) {
                hits.push_back({closest.found().index, closest.key()});
            }
        } else {
            CollectHits collect{hits};
            cost = grid->visit(region, collect);
        }
        return RayCost{cost.rowsVisited, cost.boxesTested};
    };
}

// --- By Bullet -----------------------------------------------------------------------------------

/// What btCollisionWorld::rayTest() asks of its broadphase: all boxes that the ray meets. How far
/// away each is, Bullet's btRayAabb() says; it may also decide whether it is a hit.
RayCaster dbvtCaster(Boxes boxes, bool mustPassRayAabb) {
    const auto filed = filedInDbvt(boxes);
    return [=](const Ray& ray, std::vector<RayHit>& hits) {
        const btVector3 from = toBullet(ray.from);
        const btVector3 to = toBullet(ray.to);
        castRay(filed->broadphase(), from, to, [&](const btBroadphaseProxy& proxy) {
            btScalar fraction = 1;
            btVector3 normal;
            const bool isHit =
                btRayAabb(from, to, proxy.m_aabbMin, proxy.m_aabbMax, fraction, normal);
            if (isHit || !mustPassRayAabb) {
                hits.push_back({FilledBroadphase::objectOf(proxy), fraction});
            }
        });
        return RayCost{};
    };
}

}  // namespace

std::vector<RayMethod> rayMethods() {
    const auto grid = [](bool nearestOnly) {
        return [=](Boxes boxes) { return gridCaster(boxes, nearestOnly); };
    };
    const auto dbvt = [](bool mustPassRayAabb) {
        return [=](Boxes boxes) { return dbvtCaster(boxes, mustPassRayAabb); };
    };
    return {
        {"paper: point on the plane", "paper", planePoint},
        {"2D raster", "others walks_cells", walker(true, kFlatRaster)},
        {"DDA, accumulated", "others walks_cells", walker(false, faces(BorderTimes::accumulated))},
        {"DDA, multiplied", "others walks_cells", walker(false, faces(BorderTimes::multiplied))},
        {"DDA, conservative", "others walks_cells must_find_all", walker(false, kLayers)},
        {"Grid::visit(RayRegion)", "ours must_find_all", grid(false)},
        {"Grid::visit(RayRegion), closest", "ours must_find_all nearest_only", grid(true)},
        {"btDbvtBroadphase::rayTest", "bullet", dbvt(false)},
        {"btDbvtBroadphase::rayTest, btRayAabb", "bullet", dbvt(true)},
    };
}

}  // namespace hashphase::demos
