// SPDX-License-Identifier: Zlib

// The piece of C++ of integration/guide/README.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace {

TEST(GuidePage, BodyInTheWorldIsPicked) {
    FallingSphere sphere;
    btRigidBody& body = sphere.body;
    auto& [configuration, dispatcher, solver, shape, itsBody, timeStep] = sphere;
#include <guide_1.inl>
    EXPECT_EQ(picked.id, SpatialHashBroadphase::idOf(body.getBroadphaseProxy()));
    world.removeRigidBody(&body);
}

}  // namespace
}  // namespace hashphase::test
