// SPDX-License-Identifier: Zlib
//
// Picking by shape in a world that moves, which finds what Bullet's own rays find there.

#include <tests/integration/bullet/dynamics.hpp>
#include <tests/support/camera_matrices.hpp>
#include <tests/support/picking_oracle.hpp>
#include <tests/support/random.hpp>

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/group_filter.hpp>
#include <integration/bullet/shape_pick.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/picking/pick.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

static_assert(!std::is_constructible_v<ShapeTest, SpatialHashBroadphase>);

/// A pile that falls on the ground, seen from around.
class WorldPicking : public testing::Test, protected DynamicsWorld {
protected:
    WorldPicking() {
        buildPile(*this);
        step(90);
    }

    /// A step now and then.
    void stepAt(int i) { step(i % 10 == 0 ? 1 : 0); }

    Camera<btScalar> someView() {
        const Vector3<double> eye = random.pointIn({-15, 1, -15}, {15, 15, 15});
        const Vector3<double> target = random.pointIn({-4, 0, -4}, {4, 4, 4});
        const CameraLens lens;
        return {cameraMatrix<btScalar>(lens, eye, target), lens.depthRange, kViewport};
    }
    Pixel somePixel() {
        const double x = random.between(0, kViewport.width);
        return {kViewport.x + x, kViewport.y + random.between(0, kViewport.height)};
    }
    RayRegion<btScalar> someRay() {
        const Camera<btScalar> view = someView();
        return view.rayThrough(somePixel());
    }

    const btCollisionObject* objectOf(ProxyId id) const {
        return static_cast<const btCollisionObject*>(hash().proxyOf(id)->m_clientObject);
    }
    // The ground's box is all of space.
    GroupFilter isMobile() const {
        return GroupFilter(hash(), {.mask = ~btBroadphaseProxy::StaticFilter});
    }

    Random random{5};
};

TEST_F(WorldPicking, ByShapeFindsTheHitsOfTheWorldsRayNearToFar) {
    std::size_t found = 0;
    std::vector<Picked<btScalar>> picked;
    for (int i = 0; i < 600; ++i) {
        SCOPED_TRACE(i);
        stepAt(i);
        const RayRegion<btScalar> ray = someRay();
        const btVector3 from = toBullet(ray.from());
        const btVector3 to = toBullet(ray.from() + ray.direction());
        btCollisionWorld::ClosestRayResultCallback closest(from, to);
        world().rayTest(from, to, closest);
        const KeyedProxy<btScalar> nearest = closestShape(hash(), ray);
        ASSERT_EQ(nearest.id.isNull(), !closest.hasHit());
        if (closest.hasHit()) {
            EXPECT_EQ(nearest.key, closest.m_closestHitFraction);
            EXPECT_EQ(objectOf(nearest.id), closest.m_collisionObject);
        }
        btCollisionWorld::AllHitsRayResultCallback all(from, to);
        world().rayTest(from, to, all);
        std::map<const btCollisionObject*, btScalar> expected;  // the nearest hit of each
        for (int k = 0; k < all.m_collisionObjects.size(); ++k) {
            const auto [hit, isFirst] =
                expected.emplace(all.m_collisionObjects[k], all.m_hitFractions[k]);
            hit->second = std::min(hit->second, all.m_hitFractions[k]);
        }
        pickAll(grid(), ray, picked, ShapeTest(hash()));
        ASSERT_EQ(picked.size(), expected.size());
        for (std::size_t k = 0; k < picked.size(); ++k) {
            EXPECT_EQ(
                std::max(expected.at(objectOf(picked[k].id)), ray.key(grid().box(picked[k].id))),
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
    btBoxShape block({1, 1, 1});
    btCollisionObject object;
    object.setCollisionShape(&block);
    object.getWorldTransform().setOrigin({10, 0, 0});
    DynamicsWorld world;
    world.world().addCollisionObject(&object);  // with the box of the shape, no wider
    const SpatialHashBroadphase& broadphase = world.hash();
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
}

TEST_F(WorldPicking, AsksTheFilterForGroupsAndMasks) {
    std::size_t ground = 0;
    std::size_t mobile = 0;
    std::vector<Picked<btScalar>> picked;
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE(i);
        const RayRegion<btScalar> ray = someRay();
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

// Proxies that are made by hand, and whose objects are in another broadphase, or in none.
TEST(ShapePicking, FindsObjectsOfProxiesThatTheyDoNotKnow) {
    btBoxShape block({1, 1, 1});
    btCollisionObject near;
    btCollisionObject far;
    DynamicsWorld world;
    SpatialHashBroadphase second;
    std::vector<btBroadphaseProxy*> proxies;
    for (btCollisionObject* const object : {&far, &near}) {
        object->setCollisionShape(&block);
        object->getWorldTransform().setOrigin(
            {object == &near ? btScalar(10) : btScalar(20), 0, 0});
        btVector3 low;
        btVector3 high;
        block.getAabb(object->getWorldTransform(), low, high);
        proxies.push_back(second.createProxy(low, high, 0, object, 1, -1, nullptr));
    }
    world.world().addCollisionObject(
        &near);  // has the lowest id there, which is that of `far` here
    const RayRegion<btScalar> ray({0, 0, 0}, {30, 0, 0});
    for (btBroadphaseProxy* const nearest : {proxies[1], proxies[0]}) {
        EXPECT_EQ(closestShape(second, ray).id, SpatialHashBroadphase::idOf(nearest));
        second.destroyProxy(nearest, nullptr);
    }
    EXPECT_TRUE(closestShape(second, ray).id.isNull());
    world.world().removeCollisionObject(&near);
}

}  // namespace
}  // namespace hashphase::test
