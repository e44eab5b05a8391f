// SPDX-License-Identifier: Zlib
//
// Picking and drag selection in a world that moves: what Bullet's own rays find there, and what
// looking at every body finds.

#include <tests/integration/bullet/dynamics.hpp>
#include <tests/support/camera_matrices.hpp>
#include <tests/support/picking_oracle.hpp>

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/group_filter.hpp>
#include <integration/bullet/shape_pick.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/picking/drag_selection.hpp>
#include <integration/picking/pick.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

static_assert(!std::is_constructible_v<ShapeTest, SpatialHashBroadphase>);

/// A pile that falls on the ground, seen from around.
class WorldPicking : public testing::Test {
protected:
    WorldPicking() {
        dynamicsScenes().front().build(scene);
        step(90);
    }

    void step(int count) {
        for (int i = 0; i < count; ++i) {
            scene.step();
        }
    }

    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }

    Camera<btScalar> someView() {
        const Vector3<double> eye(between(-15, 15), between(1, 15), between(-15, 15));
        const Vector3<double> target(between(-4, 4), between(0, 4), between(-4, 4));
        CameraLens lens;
        return {cameraMatrix<btScalar>(lens, eye, target), lens.depthRange, kViewport};
    }

    Pixel somePixel() {
        return {kViewport.x + between(0, kViewport.width),
                kViewport.y + between(0, kViewport.height)};
    }

    const btCollisionObject* objectOf(ProxyId id) const {
        return static_cast<const btCollisionObject*>(hash().proxyOf(id)->m_clientObject);
    }

    btScalar entryOf(const RayRegion<btScalar>& ray, ProxyId id) const {
        return ray.key(grid().box(id));
    }

    const SpatialHashBroadphase& hash() const { return *broadphase_; }
    const Grid<btScalar>& grid() const { return hash().grid(); }

    // The ground's box is all of space.
    GroupFilter isMobile() const {
        return GroupFilter(hash(), {.mask = ~btBroadphaseProxy::StaticFilter});
    }

    std::vector<Placed<btScalar>> bodies() {
        std::vector<Placed<btScalar>> all;
        for (int i = 0; i < scene.bodyCount(); ++i) {
            const btBroadphaseProxy* proxy = scene.body(i).getBroadphaseHandle();
            all.push_back(
                {SpatialHashBroadphase::idOf(proxy), toAabb(proxy->m_aabbMin, proxy->m_aabbMax)});
        }
        return all;
    }

private:
    SpatialHashBroadphase* broadphase_ = new SpatialHashBroadphase;

protected:
    DynamicsWorld scene{std::unique_ptr<btBroadphaseInterface>(broadphase_)};

private:
    std::mt19937_64 engine_{5};
};

TEST_F(WorldPicking, ByBoxFindsTheBodiesWhoseBoxesAreMet) {
    std::size_t found = 0;
    std::vector<Picked<btScalar>> picked;
    for (int i = 0; i < 600; ++i) {
        SCOPED_TRACE(i);
        step(i % 10 == 0 ? 1 : 0);
        const RayRegion<btScalar> ray = someView().rayThrough(somePixel());
        const std::vector<Placed<btScalar>> all = bodies();
        const auto byBox = [&](ProxyId id, const RayRegion<btScalar>& along, btScalar) {
            return std::optional(along.key(grid().box(id)));
        };
        const auto expected = pickAllByBruteForce<btScalar>(all, ray, byBox, acceptAll);
        pickAll(grid(), ray, picked);
        ASSERT_EQ(picked.size(), expected.size());
        for (std::size_t k = 0; k < picked.size(); ++k) {
            EXPECT_EQ(picked[k].id, expected[k].id);
            EXPECT_EQ(picked[k].fraction, expected[k].fraction);
        }
        EXPECT_EQ(pickNearest(grid(), ray).id, expected.empty() ? ProxyId{} : expected[0].id);
        found += picked.size();
    }
    EXPECT_GT(found, 1000U);
}

TEST_F(WorldPicking, ByShapeFindsTheClosestHitOfTheWorldsRay) {
    std::size_t found = 0;
    for (int i = 0; i < 600; ++i) {
        SCOPED_TRACE(i);
        step(i % 10 == 0 ? 1 : 0);
        const RayRegion<btScalar> ray = someView().rayThrough(somePixel());
        const btVector3 from = toBullet(ray.from());
        const btVector3 to = toBullet(ray.from() + ray.direction());
        btCollisionWorld::ClosestRayResultCallback closest(from, to);
        scene.world().rayTest(from, to, closest);
        const KeyedProxy<btScalar> picked = closestShape(hash(), ray);
        ASSERT_EQ(picked.id.isNull(), !closest.hasHit());
        if (closest.hasHit()) {
            EXPECT_EQ(picked.key, closest.m_closestHitFraction);
            EXPECT_EQ(objectOf(picked.id), closest.m_collisionObject);
            ++found;
        }
    }
    EXPECT_GT(found, 300U);
}

TEST_F(WorldPicking, ByShapeFindsAllHitsOfTheWorldsRayNearToFar) {
    std::size_t found = 0;
    std::vector<Picked<btScalar>> picked;
    for (int i = 0; i < 600; ++i) {
        SCOPED_TRACE(i);
        step(i % 10 == 0 ? 1 : 0);
        const RayRegion<btScalar> ray = someView().rayThrough(somePixel());
        const btVector3 from = toBullet(ray.from());
        const btVector3 to = toBullet(ray.from() + ray.direction());
        btCollisionWorld::AllHitsRayResultCallback all(from, to);
        scene.world().rayTest(from, to, all);
        std::map<const btCollisionObject*, btScalar> expected;  // the nearest hit of each
        for (int k = 0; k < all.m_collisionObjects.size(); ++k) {
            const auto [hit, isFirst] =
                expected.emplace(all.m_collisionObjects[k], all.m_hitFractions[k]);
            hit->second = std::min(hit->second, all.m_hitFractions[k]);
        }
        pickAll(grid(), ray, picked, ShapeTest(hash()));
        ASSERT_EQ(picked.size(), expected.size());
        for (std::size_t k = 0; k < picked.size(); ++k) {
            EXPECT_EQ(std::max(expected.at(objectOf(picked[k].id)), entryOf(ray, picked[k].id)),
                      picked[k].fraction);
            EXPECT_LE(picked[k == 0 ? 0 : k - 1].fraction, picked[k].fraction);
        }
        EXPECT_EQ(pickNearest(grid(), ray, ShapeTest(hash())).id,
                  picked.empty() ? ProxyId{} : picked[0].id);
        found += picked.size();
    }
    EXPECT_GT(found, 600U);
}

TEST(ShapePicking, MeetsNoShapeInFrontOfItsBoxThoughBulletsCastsEndThere) {
    SpatialHashBroadphase broadphase;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btCollisionWorld world(&dispatcher, &broadphase, &configuration);
    btBoxShape block({1, 1, 1});
    btCollisionObject object;
    object.setCollisionShape(&block);
    object.getWorldTransform().setOrigin({10, 0, 0});
    world.addCollisionObject(&object);  // with the box of the shape, no wider
    const ProxyId id = SpatialHashBroadphase::idOf(object.getBroadphaseHandle());
    int endedInFront = 0;
    for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE(i);
        const btScalar height = btScalar(i) / 100 - 1;
        const btVector3 from(0, height, btScalar(0.3));
        const btVector3 to(12, height / 2, btScalar(0.2));
        const RayRegion<btScalar> ray(toEigen(from), toEigen(to));
        const btScalar entry = ray.key(broadphase.grid().box(id));
        btCollisionWorld::ClosestRayResultCallback cast(from, to);
        castAtShape(broadphase, id, from, to, cast);
        ASSERT_TRUE(cast.hasHit());
        endedInFront += cast.m_closestHitFraction < entry ? 1 : 0;
        const Picked<btScalar> picked = pickNearest(broadphase.grid(), ray, ShapeTest(broadphase));
        EXPECT_EQ(picked.id, id);
        EXPECT_EQ(picked.fraction, std::max(entry, cast.m_closestHitFraction));
    }
    EXPECT_GT(endedInFront, 10);
    world.removeCollisionObject(&object);
}

TEST_F(WorldPicking, AsksTheFilterForGroupsAndMasks) {
    std::size_t ground = 0;
    std::size_t mobile = 0;
    std::vector<Picked<btScalar>> picked;
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE(i);
        const RayRegion<btScalar> ray = someView().rayThrough(somePixel());
        pickAll(grid(), ray, picked, ShapeTest(hash()), isMobile());
        const KeyedProxy<btScalar> closest = closestShape(hash(), ray, isMobile());
        ASSERT_EQ(closest.id.isNull(), picked.empty());
        for (const Picked<btScalar>& each : picked) {
            EXPECT_FALSE(objectOf(each.id)->isStaticObject());
        }
        if (!picked.empty()) {
            EXPECT_EQ(closest.key, picked[0].fraction);
            ++mobile;
        }
        const KeyedProxy<btScalar> any = closestShape(hash(), ray);
        ground += !any.id.isNull() && objectOf(any.id)->isStaticObject() ? 1U : 0U;
    }
    EXPECT_GT(ground, 30U);
    EXPECT_GT(mobile, 30U);
}

TEST_F(WorldPicking, SeesABodyAtOnceWhereItWasMoved) {
    btRigidBody& body = scene.body(scene.bodyCount() - 1);
    for (int i = 0; i < 100; ++i) {
        SCOPED_TRACE(i);
        const btVector3 place(btScalar(between(-9, 9)), 30 + btScalar(i), btScalar(between(-9, 9)));
        body.getWorldTransform().setOrigin(place);
        scene.world().updateSingleAabb(&body);
        const CameraLens lens;
        const Vector3<double> target = toEigen(place).cast<double>();
        const Camera<btScalar> view(
            cameraMatrix<btScalar>(lens, target + Vector3<double>(9, 5, 3), target),
            lens.depthRange, kViewport);
        const Pixel middle = middleOf(kViewport);
        EXPECT_EQ(objectOf(pickNearest(grid(), view.rayThrough(middle), isMobile()).id), &body);
        EXPECT_EQ(objectOf(closestShape(hash(), view.rayThrough(middle)).id), &body);
        std::vector<ProxyId> selected;
        const Pixel reach(10, 10);
        select(grid(), view, middle - reach, middle + reach, selected, Containment::touching,
               isMobile());
        EXPECT_EQ(selected, std::vector{SpatialHashBroadphase::idOf(body.getBroadphaseHandle())});
    }
}

TEST_F(WorldPicking, ByADragFindsWhatLiesBetweenTheCorners) {
    constexpr double nearly = sizeof(btScalar) == sizeof(float) ? 2e-4 : 1e-9;
    std::size_t found = 0;
    std::vector<ProxyId> selected;
    for (int i = 0; i < 100; ++i) {
        SCOPED_TRACE(i);
        step(i % 10 == 0 ? 1 : 0);
        const Camera<btScalar> view = someView();
        const Pixel a = somePixel();
        const Pixel b = somePixel();
        select(grid(), view, a, b, selected, Containment::touching, isMobile());
        const auto planes =
            planesBetween(view.viewProjection(), view.depthRange(), kViewport, a, b);
        for (const Placed<btScalar>& body : bodies()) {
            const bool isSelected = std::binary_search(selected.begin(), selected.end(), body.id);
            if (objectOf(body.id)->isStaticObject()) {
                EXPECT_FALSE(isSelected);
                continue;
            }
            const double depth = depthInVolume(planes, body.box.template cast<double>());
            if (std::abs(depth) > nearly) {
                EXPECT_EQ(isSelected, depth > 0) << depth;
            }
        }
        found += selected.size();
    }
    EXPECT_GT(found, 300U);
}

TEST_F(WorldPicking, FindsNoShapesAlongEmptyRays) {
    const Vector3<btScalar> nan =
        Vector3<btScalar>::Constant(std::numeric_limits<btScalar>::quiet_NaN());
    const Vector3<btScalar> zero = Vector3<btScalar>::Zero();
    EXPECT_TRUE(closestShape(hash(), RayRegion<btScalar>(nan, zero)).id.isNull());
    EXPECT_TRUE(closestShape(hash(), RayRegion<btScalar>(zero, zero)).id.isNull());
    std::vector<Picked<btScalar>> picked;
    pickAll(grid(), RayRegion<btScalar>(nan, zero), picked, ShapeTest(hash()));
    EXPECT_TRUE(picked.empty());
}

}  // namespace
}  // namespace hashphase::test
