// SPDX-License-Identifier: Zlib
//
// Rays by the library, and by Bullet.

#include <demos/accuracy/picking/ray_methods.hpp>

#include <broadphase/grid.hpp>
#include <demos/accuracy/baselines/dbvt_boxes.hpp>
#include <integration/bullet/conversions.hpp>

#include <LinearMath/btAabbUtil2.h>

namespace hashphase::demos {
namespace {

/// The library's grid with the boxes in it; of an empty grid, the ids count from 0.
class GridCaster final : public RayCaster {
public:
    GridCaster(std::span<const Aabb<float>> boxes, bool nearestOnly) : nearestOnly_(nearestOnly) {
        for (const Aabb<float>& box : boxes) {
            const ProxyId id = grid_.add(box);
            objects_.resize(id.index + 1);
            objects_[id.index] = static_cast<std::uint32_t>(objects_.size() - 1);
        }
        grid_.update();
    }

    RayCost cast(const Ray& ray, std::vector<RayHit>& hits) override {
        const RayRegion<float> region(ray.from, ray.to);
        QueryCost cost;
        if (nearestOnly_) {
            CollectClosest<float> closest;
            cost = grid_.visit(region, closest);
            if (!closest.found().isNull()) {
                hits.push_back({objects_[closest.found().index], closest.key()});
            }
        } else {
            Collect collect(objects_, hits);
            cost = grid_.visit(region, collect);
        }
        return {cost.rowsVisited, cost.boxesTested};
    }

private:
    struct Collect {
        Collect(const std::vector<std::uint32_t>& all, std::vector<RayHit>& found)
            : objects(all), hits(found) {}
        void add(ProxyId id, float key) { hits.push_back({objects[id.index], key}); }
        [[nodiscard]] static constexpr float limit() {
            return std::numeric_limits<float>::infinity();
        }
        const std::vector<std::uint32_t>& objects;
        std::vector<RayHit>& hits;
    };

    bool nearestOnly_;
    Grid<float> grid_;
    std::vector<std::uint32_t> objects_;  // by ProxyId::index
};

/// What btCollisionWorld::rayTest() asks of its broadphase: all boxes that the ray meets. How far away
/// each is, Bullet's btRayAabb() says; it may also decide whether it is a hit.
class DbvtCaster final : public RayCaster {
public:
    DbvtCaster(std::span<const Aabb<float>> boxes, bool mustPassRayAabb)
        : boxes_(boxes), mustPassRayAabb_(mustPassRayAabb) {}

    RayCost cast(const Ray& ray, std::vector<RayHit>& hits) override {
        const btVector3 from = toBullet(ray.from);
        const btVector3 to = toBullet(ray.to);
        Collect collect(from, to, mustPassRayAabb_, hits);
        boxes_.broadphase().rayTest(from, to, collect);
        return {};
    }

private:
    // As btCollisionWorld's own callback prepares it.
    struct Collect final : btBroadphaseRayCallback {
        Collect(const btVector3& rayFrom, const btVector3& rayTo, bool mustPass,
                std::vector<RayHit>& found)
            : from(rayFrom), to(rayTo), mustPassRayAabb(mustPass), hits(found) {
            const btVector3 direction = (to - from).normalized();
            for (int axis = 0; axis < 3; ++axis) {
                m_rayDirectionInverse[axis] =
                    direction[axis] == 0 ? btScalar(BT_LARGE_FLOAT) : 1 / direction[axis];
                m_signs[axis] = m_rayDirectionInverse[axis] < 0 ? 1U : 0U;
            }
            m_lambda_max = direction.dot(to - from);
        }

        bool process(const btBroadphaseProxy* proxy) override {
            btScalar fraction = 1;
            btVector3 normal;
            const bool isHit =
                btRayAabb(from, to, proxy->m_aabbMin, proxy->m_aabbMax, fraction, normal);
            if (isHit || !mustPassRayAabb) {
                hits.push_back({DbvtBoxes::objectOf(*proxy), fraction});
            }
            return true;
        }

        btVector3 from;
        btVector3 to;
        bool mustPassRayAabb;
        std::vector<RayHit>& hits;
    };

    DbvtBoxes boxes_;
    bool mustPassRayAabb_;
};

}  // namespace

std::vector<RayMethod> treeRayMethods() {
    const auto grid = [](bool nearestOnly) {
        return [=](std::span<const Aabb<float>> boxes) {
            return std::make_unique<GridCaster>(boxes, nearestOnly);
        };
    };
    const auto dbvt = [](bool mustPassRayAabb) {
        return [=](std::span<const Aabb<float>> boxes) {
            return std::make_unique<DbvtCaster>(boxes, mustPassRayAabb);
        };
    };
    return {{"Grid::visit(RayRegion)", true, true, false, false, grid(false)},
            {"Grid::visit(RayRegion), closest", true, true, true, false, grid(true)},
            {"btDbvtBroadphase::rayTest", false, false, false, false, dbvt(false)},
            {"btDbvtBroadphase::rayTest, btRayAabb", false, false, false, false, dbvt(true)}};
}

std::vector<RayMethod> rayMethods() {
    std::vector<RayMethod> all = cellRayMethods();
    for (RayMethod& each : treeRayMethods()) {
        all.push_back(std::move(each));
    }
    return all;
}

}  // namespace hashphase::demos
