// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/picking.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace {

std::optional<float> rayMeetsBall(const RayRegion<float>& ray, const Point& center, float limit) {
    // The balls of this page lie on their rays.
    const float fraction = ((center - ray.from()).norm() - 1) / ray.direction().norm();
    return fraction <= limit ? std::optional(fraction) : std::nullopt;
}

using PickingPage = AgentsBeforeACamera;

TEST_F(PickingPage, ClicksAndRectanglesFindWhatIsThere) {
    const int width = 800;
    const int height = 800;
    const float x = 400;
    const float y = 400;
    const float x0 = 300;
    const float y0 = 300;
    const float x1 = 500;
    const float y1 = 500;
    const auto enemies = isEnemy();
    ProxyId marked;
    const auto mark = [&](ProxyId id, const Point& /*point*/) { marked = id; };
#include <picking_1.inl>
    EXPECT_EQ(marked, enemy);
#include <picking_2.inl>
    EXPECT_EQ(under.size(), 3U);
#include <picking_3.inl>
    EXPECT_EQ(exactly.id, self);
    EXPECT_NEAR(exactly.fraction, 0.09F, 1e-6F);
#include <picking_5.inl>
    EXPECT_EQ(selected.size(), 3U);
}

TEST(PickingPageUnderBullet, ClosestShapeIsASphere) {
    FallingSphere sphere;
    SpatialHashBroadphase broadphase;
    btCollisionWorld world(&sphere.dispatcher, &broadphase, &sphere.configuration);
    world.addCollisionObject(&sphere.body);
    const btVector3 from(0, 5, 0);
    const btVector3 to(0, -5, 0);
    const btCollisionObject* marked = nullptr;
    const auto markObject = [&](const btCollisionObject* object) { marked = object; };
#include <picking_4.inl>
    EXPECT_NEAR(shape.key, btScalar(0.4), btScalar(1e-3));
    EXPECT_EQ(marked, &sphere.body);
    world.removeCollisionObject(&sphere.body);
}

}  // namespace
}  // namespace hashphase::test
