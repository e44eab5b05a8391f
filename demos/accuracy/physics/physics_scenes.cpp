// SPDX-License-Identifier: Zlib
#include <demos/accuracy/physics/physics_experiments.hpp>

#include <demos/scenes/random.hpp>
#include <demos/scenes/world_scenes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace hashphase::demos {
namespace {

using Fill = void (*)(WorldContents&, std::size_t, std::uint64_t);

/// How `compare` fills its world of that name.
Fill fillOfCompare(std::string_view name) {
    const auto kinds = worldSceneKinds();
    return std::find_if(kinds.begin(), kinds.end(),
                        [name](const WorldSceneKind& kind) { return kind.name == name; })
        ->fill;
}

void fillLattice(WorldContents& contents, std::size_t objects, std::uint64_t seed) {
    const auto side = static_cast<btScalar>(std::cbrt(static_cast<double>(objects)));
    addOpenBox(contents, side * 0.75F);
    addLattice(contents, objects, 1.1F, 1, 0.05F, seed);
}

void fillBouncing(WorldContents& contents, std::size_t objects, std::uint64_t /*seed*/) {
    addBouncingBalls(contents, objects);
}

// Dumbbells and crosses, spinning, that come down one after another.
void fillCompounds(WorldContents& contents, std::size_t objects, std::uint64_t seed) {
    Random random(seed);
    addOpenBox(contents, 6);
    auto& bar = contents.addShape<btBoxShape>(btVector3(0.7F, 0.15F, 0.15F));
    auto& ball = contents.addShape<btSphereShape>(btScalar(0.3));
    auto& dumbbell = contents.addShape<btCompoundShape>();
    dumbbell.addChildShape(btTransform::getIdentity(), &bar);
    for (const btScalar end : {0.7F, -0.7F}) {
        dumbbell.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(end, 0, 0)),
                               &ball);
    }
    auto& cross = contents.addShape<btCompoundShape>();
    cross.addChildShape(btTransform::getIdentity(), &bar);
    cross.addChildShape(btTransform(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI)), &bar);
    for (std::size_t i = 0; i < objects; ++i) {
        const btScalar x = random.between(-3, 3);
        const btScalar z = random.between(-3, 3);
        btCompoundShape& shape = i % 2 == 0 ? dumbbell : cross;
        btRigidBody& body =
            contents.addBody(shape, 1, btVector3(x, 1 + 0.12F * static_cast<btScalar>(i), z));
        const btScalar spin = random.between(-8, 8);
        body.setAngularVelocity(btVector3(spin, random.between(-8, 8), 2));
    }
}

// Every eleventh step, three bodies leave the world and come back above it: they are new to the
// broadphase, and their pairs are gone.
void takeAndDrop(WorldContents& contents, int step) {
    constexpr int kEvery = 11;
    constexpr int kAtOnce = 3;
    if (step % kEvery != 0) {
        return;
    }
    Random random(static_cast<std::uint64_t>(step));
    const auto count = static_cast<float>(contents.bodies().size() - 1);
    for (int i = 0; i < kAtOnce; ++i) {
        // Body 0 is the floor.
        const auto number = 1 + static_cast<std::size_t>(random.unit() * count);
        btRigidBody& body = *contents.bodies()[number];
        contents.world().removeRigidBody(&body);
        btTransform place = btTransform::getIdentity();
        const btScalar x = random.between(2, 8);
        place.setOrigin(btVector3(x, 8 + 2 * static_cast<btScalar>(i), random.between(2, 8)));
        body.setWorldTransform(place);
        body.setInterpolationWorldTransform(place);
        body.setLinearVelocity(btVector3(0, 0, 0));
        body.setAngularVelocity(btVector3(0, 0, 0));
        body.forceActivationState(ACTIVE_TAG);
        body.setDeactivationTime(0);
        contents.world().addRigidBody(&body);
    }
}

}  // namespace

std::vector<PhysicsScene> physicsScenes() {
    return {
        {"pile", fillOfCompare("pile"), 100, 200},
        {"stack", fillOfCompare("stack"), 100, 200},
        {"chains", fillOfCompare("chains"), 100, 200},
        {"static-city", fillOfCompare("static-city"), 300, 600},
        {"lattice", fillLattice, 125, 216},
        {"bouncing", fillBouncing, 100, 300},
        {"compounds", fillCompounds, 60, 100},
        {"churn", fillOfCompare("pile"), 100, 200, takeAndDrop},
    };
}

void addOpenBox(WorldContents& contents, btScalar halfWidth) {
    constexpr btScalar kHalfThick = 1;
    constexpr btScalar kHalfHeight = 10;
    auto& floor = contents.addShape<btBoxShape>(
        btVector3(halfWidth + 2 * kHalfThick, kHalfThick, halfWidth + 2 * kHalfThick));
    contents.addBody(floor, 0, btVector3(0, -kHalfThick, 0));
    auto& acrossX = contents.addShape<btBoxShape>(
        btVector3(kHalfThick, kHalfHeight, halfWidth + 2 * kHalfThick));
    auto& acrossZ = contents.addShape<btBoxShape>(
        btVector3(halfWidth + 2 * kHalfThick, kHalfHeight, kHalfThick));
    for (const btScalar side : {-1.0F, 1.0F}) {
        const btScalar place = side * (halfWidth + kHalfThick);
        contents.addBody(acrossX, 0, btVector3(place, kHalfHeight, 0));
        contents.addBody(acrossZ, 0, btVector3(0, kHalfHeight, place));
    }
}

void addLattice(WorldContents& contents, std::size_t spheres, btScalar spacing, btScalar height,
                btScalar jitter, std::uint64_t seed) {
    Random random(seed);
    auto& sphere = contents.addShape<btSphereShape>(btScalar(0.5));
    const auto side =
        static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(spheres))));
    const btScalar half = spacing * static_cast<btScalar>(side - 1) / 2;
    for (std::size_t i = 0; i < side * side * side; ++i) {
        std::array<btScalar, 3> place{};
        std::size_t rest = i;
        for (btScalar& coordinate : place) {
            coordinate =
                spacing * static_cast<btScalar>(rest % side) + random.between(-jitter, jitter);
            rest /= side;
        }
        contents.addBody(sphere, 1, btVector3(place[0] - half, height + place[2], place[1] - half));
    }
}

void addBouncingBalls(WorldContents& contents, std::size_t balls) {
    auto& plane = contents.addShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0));
    contents.addBody(plane, 0, btVector3(0, 0, 0)).setRestitution(1);
    auto& sphere = contents.addShape<btSphereShape>(btScalar(0.5));
    for (std::size_t i = 0; i < balls; ++i) {
        const auto height = static_cast<btScalar>(bouncingHeight(i));
        const btVector3 place(2 * static_cast<btScalar>(i), height, 0);
        contents.addBody(sphere, 1, place).setRestitution(1);
    }
}

double bouncingHeight(std::size_t ball) {
    return 1.5 + 0.0625 * static_cast<double>(ball % 32);
}

}  // namespace hashphase::demos
