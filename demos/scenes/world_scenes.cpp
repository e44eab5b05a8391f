// SPDX-License-Identifier: Zlib
#include <demos/scenes/world_scenes.hpp>

#include <demos/scenes/random.hpp>

#include <LinearMath/btAabbUtil2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

void addFloor(WorldContents& contents, btScalar halfSide) {
    auto& shape = contents.addShape<btBoxShape>(btVector3(halfSide, 1, halfSide));
    contents.addBody(shape, 0, btVector3(0, -1, 0));
}

std::size_t gridSide(std::size_t objects) {
    return static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(objects))));
}

// Layers of 10 x 10 bodies, a little out of line, so that they tumble into a heap.
void fillPile(WorldContents& contents, std::size_t objects, std::uint64_t seed) {
    constexpr std::size_t kRow = 10;
    Random random(seed);
    addFloor(contents, 60);
    const std::array<btCollisionShape*, 3> shapes{
        &contents.addShape<btBoxShape>(btVector3(0.5F, 0.5F, 0.5F)),
        &contents.addShape<btSphereShape>(0.5F), &contents.addShape<btCapsuleShape>(0.35F, 0.6F)};
    for (std::size_t i = 0; i < objects; ++i) {
        const auto layer = static_cast<btScalar>(i / (kRow * kRow));
        const auto row = static_cast<btScalar>(i / kRow % kRow);
        const auto column = static_cast<btScalar>(i % kRow);
        const btVector3 place(1.1F * column + random.between(-0.2F, 0.2F), 0.8F + 1.3F * layer,
                              1.1F * row + random.between(-0.2F, 0.2F));
        contents.addBody(*shapes[i % shapes.size()], 1, place);
    }
}

// Walls of bricks in bond, ten courses of ten.
void fillStack(WorldContents& contents, std::size_t objects, std::uint64_t /*seed*/) {
    constexpr std::size_t kCourse = 10;
    constexpr std::size_t kWall = kCourse * 10;
    constexpr btScalar kLength = 1;
    constexpr btScalar kHeight = 0.5F;
    const auto walls = static_cast<btScalar>((objects + kWall - 1) / kWall);
    addFloor(contents, std::max<btScalar>(20, 4 * walls));
    auto& brick = contents.addShape<btBoxShape>(btVector3(kLength / 2, kHeight / 2, kHeight / 2));
    for (std::size_t i = 0; i < objects; ++i) {
        const auto course = static_cast<btScalar>(i % kWall / kCourse);
        const btScalar shift = i / kCourse % 2 == 0 ? 0 : kLength / 2;
        const btVector3 place(kLength * static_cast<btScalar>(i % kCourse) + shift,
                              kHeight * (course + 0.5F),
                              3 * (static_cast<btScalar>(i / kWall) - walls / 2));
        contents.addBody(brick, 1, place);
    }
}

// Chains of 20 links, hung by one end and let go when stretched out level.
void fillChains(WorldContents& contents, std::size_t objects, std::uint64_t /*seed*/) {
    constexpr std::size_t kLinks = 20;
    constexpr btScalar kLink = 0.6F;
    const std::size_t chains = (objects + kLinks - 1) / kLinks;
    const std::size_t side = gridSide(chains);
    addFloor(contents, static_cast<btScalar>(side + 1) * kLink * kLinks);
    auto& shape = contents.addShape<btCapsuleShapeX>(0.1F, 0.3F);
    btRigidBody* previous = nullptr;
    for (std::size_t i = 0; i < objects; ++i) {
        const std::size_t chain = i / kLinks;
        const btVector3 anchor(kLink * kLinks * 0.7F * static_cast<btScalar>(chain % side), 10,
                               1.5F * static_cast<btScalar>(chain / side));
        const bool first = i % kLinks == 0;
        const auto link = static_cast<btScalar>(i % kLinks);
        btRigidBody& body =
            contents.addBody(shape, 1, anchor + btVector3(kLink * (link + 0.5F), 0, 0));
        const btVector3 nearEnd(-kLink / 2, 0, 0);
        if (first) {
            contents.addConstraint(std::make_unique<btPoint2PointConstraint>(body, nearEnd));
        } else {
            contents.addConstraint(std::make_unique<btPoint2PointConstraint>(
                *previous, body, btVector3(kLink / 2, 0, 0), nearEnd));
        }
        previous = &body;
    }
}

// Static houses on a street grid over a plane without end; one body in 40 slides along the streets.
void fillStaticCity(WorldContents& contents, std::size_t objects, std::uint64_t seed) {
    constexpr btScalar kBlock = 12;  // from house to house [m]
    constexpr btScalar kSpeed = 20;  // [m/s]
    constexpr std::size_t kHousesPerMover = 40;
    Random random(seed);
    auto& ground = contents.addShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0));
    contents.addBody(ground, 0, btVector3(0, 0, 0));
    const std::size_t side = gridSide(objects);
    std::array<btBoxShape*, 8> houses{};
    for (std::size_t i = 0; i < houses.size(); ++i) {
        const btScalar halfHeight = 3 + 2 * static_cast<btScalar>(i);
        houses[i] = &contents.addShape<btBoxShape>(btVector3(4, halfHeight, 4));
    }
    for (std::size_t i = 0; i < objects; ++i) {
        btBoxShape& house =
            *houses[static_cast<std::size_t>(random.unit() * static_cast<float>(houses.size()))];
        const btVector3 place(kBlock * static_cast<btScalar>(i % side),
                              house.getHalfExtentsWithMargin().y(),
                              kBlock * static_cast<btScalar>(i / side));
        contents.addBody(house, 0, place);
    }
    auto& ball = contents.addShape<btSphereShape>(btScalar(1));
    const btScalar extent = kBlock * static_cast<btScalar>(side);
    for (std::size_t i = 0; i < objects / kHousesPerMover; ++i) {
        const btScalar street =
            kBlock * (std::floor(random.unit() * static_cast<float>(side)) + 0.5F);
        btRigidBody& body = contents.addBody(ball, 1, btVector3(street, 1, random.unit() * extent));
        body.setFriction(0);
        body.setRestitution(0.9F);
        body.setActivationState(DISABLE_DEACTIVATION);
        body.setLinearVelocity(
            btVector3(random.between(-kSpeed, kSpeed) / 4, 0, random.between(-kSpeed, kSpeed)));
    }
}

/// Fires bullets again, from where they began, once they have left a room.
class FiresAgain : public btActionInterface {
public:
    FiresAgain(const btVector3& low, const btVector3& high) : low_(low), high_(high) {}

    /// As it is now.
    void add(btRigidBody& bullet) {
        bullets_.push_back({&bullet, bullet.getWorldTransform(), bullet.getLinearVelocity()});
    }

    void updateAction(btCollisionWorld* /*world*/, btScalar /*seconds*/) override {
        for (const Bullet& bullet : bullets_) {
            const btVector3& place = bullet.body->getWorldTransform().getOrigin();
            if (!TestPointAgainstAabb2(low_, high_, place)) {
                bullet.body->setLinearVelocity(bullet.velocity);
                bullet.body->setAngularVelocity(btVector3(0, 0, 0));
                bullet.body->setCenterOfMassTransform(bullet.start);
            }
        }
    }
    void debugDraw(btIDebugDraw* /*drawer*/) override {}

private:
    struct Bullet {
        btRigidBody* body;
        btTransform start;
        btVector3 velocity;
    };

    btVector3 low_;
    btVector3 high_;
    std::vector<Bullet> bullets_;
};

// Bullets without weight that fly between thin walls, in lanes: each step takes them by thirty walls'
// thickness. Those that have passed through the last wall, or fly aside after they have met, are fired again.
void fillBulletStorm(WorldContents& contents, std::size_t objects, std::uint64_t seed) {
    constexpr btScalar kSpeed = 180;  // [m/s]
    constexpr btScalar kApart = 12;   // from wall to wall [m]
    constexpr btScalar kHalfThickness = 0.05F;
    constexpr std::size_t kWalls = 6;
    Random random(seed);
    const btScalar halfWidth = 1 + std::sqrt(static_cast<btScalar>(objects));
    addFloor(contents, kApart * kWalls + halfWidth);
    auto& wall = contents.addShape<btBoxShape>(btVector3(kHalfThickness, 4, halfWidth));
    for (std::size_t i = 0; i < kWalls; ++i) {
        btRigidBody& body =
            contents.addBody(wall, 0, btVector3(kApart * static_cast<btScalar>(i), 4, 0));
        body.setRestitution(1);
    }
    auto& bullet = contents.addShape<btSphereShape>(btScalar(0.15));
    auto gun =
        std::make_unique<FiresAgain>(btVector3(-kApart, -kApart, -halfWidth - kApart),
                                     btVector3(kApart * kWalls, 8 + kApart, halfWidth + kApart));
    for (std::size_t i = 0; i < objects; ++i) {
        const auto lane = static_cast<btScalar>(i % (kWalls - 1));
        const btScalar x = kApart * (lane + 0.5F) + random.between(-3, 3);
        const btScalar y = random.between(0.5F, 7.5F);
        const btScalar z = random.between(0.5F - halfWidth, halfWidth - 0.5F);
        btRigidBody& body = contents.addBody(bullet, 1, btVector3(x, y, z));
        body.setGravity(btVector3(0, 0, 0));
        body.setRestitution(1);
        body.setFriction(0);
        body.setActivationState(DISABLE_DEACTIVATION);
        body.setLinearVelocity(btVector3(random.unit() < 0.5F ? kSpeed : -kSpeed, 0, 0));
        gun->add(body);
    }
    contents.addAction(std::move(gun));
}

constexpr std::array kWorldScenes{
    WorldSceneKind{"pile", "Bullet dynamics: boxes, spheres and capsules dropped in a heap", 1'000,
                   fillPile},
    WorldSceneKind{"stack", "Bullet dynamics: walls of bricks", 1'000, fillStack},
    WorldSceneKind{"chains", "Bullet dynamics: swinging chains of 20 jointed links", 1'000,
                   fillChains},
    WorldSceneKind{"static-city",
                   "Bullet dynamics: static houses on a plane, and a ball for every 40 of them",
                   20'000, fillStaticCity},
    WorldSceneKind{
        "bullet-storm",
        "Bullet dynamics: a stream of bullets at thin walls, without continuous collision", 500,
        fillBulletStorm},
};

}  // namespace

std::span<const WorldSceneKind> worldSceneKinds() {
    return kWorldScenes;
}

}  // namespace hashphase::demos
