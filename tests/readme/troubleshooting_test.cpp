// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/troubleshooting.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace {

TEST(TroubleshootingPage, GhostsListAtOnce) {
    FallingSphere sphere;
    SpatialHashBroadphase broadphase;
    btGhostObject ghost;
    ghost.setCollisionShape(&sphere.shape);
    {
        btCollisionWorld world(&sphere.dispatcher, &broadphase, &sphere.configuration);
        world.addCollisionObject(&sphere.body);
#include <troubleshooting_1.inl>
        EXPECT_EQ(ghost.getNumOverlappingObjects(), 1);
        world.removeCollisionObject(&ghost);
        world.removeCollisionObject(&sphere.body);
    }
}

TEST(TroubleshootingPage, AssertionsThrow) {
#include <troubleshooting_2.inl>
    EXPECT_THROW(detail::reportBrokenAssert("condition", "Sentence.", "file", 1), std::logic_error);
    setAssertHandler(nullptr);
}

TEST(TroubleshootingPage, NanIsFound) {
    SpatialHashBroadphase broadphase;
    int client = 0;
    const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
    setMessageHandler([](const char* /*message*/) {});
    broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, 1, -1, nullptr);
    broadphase.createProxy({0, nan, 0}, {1, 1, 1}, 0, &client, 1, -1, nullptr);
    std::vector<void*> reported;
    const auto report = [&](void* object) { reported.push_back(object); };
#include <troubleshooting_3.inl>
    setMessageHandler(nullptr);
    EXPECT_EQ(reported, std::vector<void*>{&client});
    EXPECT_EQ(broadphase.grid().nanCount(), 1U);
}

TEST(TroubleshootingPage, ThreadsOfYoursAreUsed) {
    SpatialHashConfig config;
#include <troubleshooting_4.inl>
    SpatialHashBroadphase broadphase(config);
    for (int i = 0; i < 5000; ++i) {
        const auto x = static_cast<btScalar>(i);
        broadphase.createProxy({x, 0, 0}, {x + 1, 1, 1}, 0, nullptr, 1, -1, nullptr);
    }
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 4999);
}

}  // namespace
}  // namespace hashphase::test
