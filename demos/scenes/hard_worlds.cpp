// SPDX-License-Identifier: Zlib
#include <demos/scenes/hard_worlds.hpp>

#include <demos/scenes/random.hpp>

#include <cmath>
#include <memory>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr btScalar kHalf = 0.5F;  // half an edge of a box [m]

/// Its top is at the height of the origin.
void addFloor(WorldContents& contents, const btVector3& origin) {
    auto& floor = contents.addShape<btBoxShape>(btVector3(40, 2, 40));
    contents.addBody(floor, 0, origin - btVector3(0, 2, 0)).setFriction(1);
}

void fillTower(WorldContents& contents, const btVector3& origin, int size) {
    addFloor(contents, origin);
    auto& box = contents.addShape<btBoxShape>(btVector3(kHalf, kHalf, kHalf));
    for (int i = 0; i < size; ++i) {
        contents.addBody(box, 1, origin + btVector3(0, kHalf + static_cast<btScalar>(i), 0));
    }
}

// A course of `size` boxes, one of a box fewer on top of it, and so on.
void fillPyramid(WorldContents& contents, const btVector3& origin, int size) {
    constexpr btScalar kPitch = 1.1F;
    addFloor(contents, origin);
    auto& box = contents.addShape<btBoxShape>(btVector3(kHalf, kHalf, kHalf));
    for (int course = 0; course < size; ++course) {
        for (int i = 0; i < size - course; ++i) {
            const btScalar x =
                kPitch * (static_cast<btScalar>(i) - static_cast<btScalar>(size - course) / 2);
            contents.addBody(box, 1,
                             origin + btVector3(x, kHalf + static_cast<btScalar>(course), 0));
        }
    }
}

// --- A house of cards ----------------------------------------------------------------------------

constexpr btScalar kCard = 2;       // length of a card [m]
constexpr btScalar kThick = 0.08F;  // its thickness [m]
constexpr btScalar kLean = 0.35F;   // of a card against the upright [rad]
constexpr btScalar kCardFriction = 0.9F;

/// From the middle of a tent to the middle of a card that leans there.
btScalar halfTent() {
    return kThick / 2 * std::cos(kLean) + kCard / 2 * std::sin(kLean);
}

btScalar storeyHeight() {
    return kCard * std::cos(kLean) + kThick * std::sin(kLean);
}

/// Two cards that lean against each other above x.
void addTent(WorldContents& contents, btCollisionShape& card, const btVector3& foot) {
    for (const btScalar side : {-1.0F, 1.0F}) {
        const btQuaternion lean(btVector3(0, 0, 1), side * kLean);
        const btVector3 place = foot + btVector3(side * halfTent(), storeyHeight() / 2, 0);
        contents.addBody(card, 1, btTransform(lean, place)).setFriction(kCardFriction);
    }
}

// A storey of `size` tents with cards lying across their tops, on it one of a tent fewer, and so
// on.
void fillCards(WorldContents& contents, const btVector3& origin, int size) {
    const btScalar pitch = 4 * halfTent();
    addFloor(contents, origin);
    auto& card = contents.addShape<btBoxShape>(btVector3(kThick / 2, kCard / 2, kHalf));
    auto& ceiling = contents.addShape<btBoxShape>(btVector3(pitch / 2, kThick / 2, kHalf));
    for (int storey = 0; storey < size; ++storey) {
        const int tents = size - storey;
        const btScalar height = static_cast<btScalar>(storey) * (storeyHeight() + kThick);
        for (int i = 0; i < tents; ++i) {
            const btScalar x =
                pitch * (static_cast<btScalar>(i) - static_cast<btScalar>(tents) / 2);
            const btVector3 foot = origin + btVector3(x, height, 0);
            addTent(contents, card, foot);
            if (i + 1 < tents) {
                const btVector3 place(pitch / 2, storeyHeight() + kThick / 2, 0);
                contents.addBody(ceiling, 1, foot + place).setFriction(kCardFriction);
            }
        }
    }
}

// --- What hangs together -------------------------------------------------------------------------

// Links of 1 kg, hung by one end, a ball of 100 kg at the other, let go when stretched out level.
void fillChain(WorldContents& contents, const btVector3& origin, int size) {
    constexpr btScalar kLink = 0.6F;
    constexpr btScalar kRadius = 0.4F;
    const btVector3 half(kLink / 2, 0, 0);
    addFloor(contents, origin);
    auto& shape = contents.addShape<btCapsuleShapeX>(0.1F, 0.3F);
    const btVector3 anchor = origin + btVector3(0, kLink * static_cast<btScalar>(size) / 2, 0);
    btRigidBody* last = &contents.addBody(shape, 1, anchor + half);
    contents.addConstraint(std::make_unique<btPoint2PointConstraint>(*last, -half));
    for (int i = 1; i < size; ++i) {
        const btVector3 place = anchor + btVector3(kLink * static_cast<btScalar>(i), 0, 0) + half;
        btRigidBody& link = contents.addBody(shape, 1, place);
        contents.addConstraint(std::make_unique<btPoint2PointConstraint>(*last, link, half, -half));
        last = &link;
    }
    auto& ball = contents.addShape<btSphereShape>(kRadius);
    const btVector3 end = anchor + btVector3(kLink * static_cast<btScalar>(size), 0, 0);
    btRigidBody& weight = contents.addBody(ball, 100, end + btVector3(kRadius, 0, 0));
    contents.addConstraint(
        std::make_unique<btPoint2PointConstraint>(*last, weight, half, btVector3(-kRadius, 0, 0)));
}

/// A body that lies along x or stands along y, with its middle there.
struct Limb {
    btRigidBody* body = nullptr;
    btVector3 middle;
};

class Doll {
public:
    Doll(WorldContents& contents, const btVector3& hips) : contents_(contents), hips_(hips) {}

    /// A capsule of that radius, `length` from centre to centre; `middle` is seen from the hips.
    Limb limb(btScalar mass, btScalar radius, btScalar length, bool isLevel,
              const btVector3& middle) {
        btCollisionShape& shape = isLevel ? contents_.addShape<btCapsuleShapeX>(radius, length)
                                          : static_cast<btCollisionShape&>(
                                                contents_.addShape<btCapsuleShape>(radius, length));
        btRigidBody& body = contents_.addBody(shape, mass, hips_ + middle);
        body.setDamping(0.05F, 0.6F);
        return {&body, middle};
    }

    /// A joint that swings and twists a little, `point` seen from the hips.
    void ball(const Limb& a, const Limb& b, const btVector3& point, btScalar swing) {
        auto joint = std::make_unique<btConeTwistConstraint>(
            *a.body, *b.body, btTransform(btMatrix3x3::getIdentity(), point - a.middle),
            btTransform(btMatrix3x3::getIdentity(), point - b.middle));
        joint->setLimit(swing, swing, swing);
        contents_.addConstraint(std::move(joint));
    }

    /// One that bends about an axis.
    void hinge(const Limb& a, const Limb& b, const btVector3& point, const btVector3& axis) {
        auto joint = std::make_unique<btHingeConstraint>(*a.body, *b.body, point - a.middle,
                                                         point - b.middle, axis, axis);
        joint->setLimit(0, SIMD_HALF_PI);
        contents_.addConstraint(std::move(joint));
    }

private:
    WorldContents& contents_;
    btVector3 hips_;
};

struct HeadAndFoot {
    btRigidBody* head = nullptr;
    btRigidBody* leftShin = nullptr;
};

constexpr btScalar kDollHeight = 2.05F;
constexpr btScalar kLegAside = 0.14F;

/// Eleven limbs, arms stretched out to the sides.
HeadAndFoot addDoll(WorldContents& contents, const btVector3& hips) {
    Doll doll(contents, hips);
    const Limb pelvis = doll.limb(12, 0.15F, 0.2F, true, {0, 0, 0});
    const Limb chest = doll.limb(25, 0.17F, 0.26F, false, {0, 0.42F, 0});
    const Limb head = doll.limb(5, 0.11F, 0.06F, false, {0, 0.9F, 0});
    doll.ball(pelvis, chest, {0, 0.16F, 0}, 0.5F);
    doll.ball(chest, head, {0, 0.73F, 0}, 0.7F);
    HeadAndFoot ends{head.body, nullptr};
    for (const btScalar side : {-1.0F, 1.0F}) {
        const Limb thigh = doll.limb(9, 0.08F, 0.3F, false, {kLegAside * side, -0.33F, 0});
        const Limb shin = doll.limb(5, 0.06F, 0.34F, false, {kLegAside * side, -0.78F, 0});
        doll.ball(pelvis, thigh, {kLegAside * side, -0.1F, 0}, 0.7F);
        doll.hinge(thigh, shin, {kLegAside * side, -0.56F, 0}, {1, 0, 0});
        const Limb upperArm = doll.limb(3, 0.06F, 0.22F, true, {0.36F * side, 0.56F, 0});
        const Limb foreArm = doll.limb(2, 0.05F, 0.22F, true, {0.7F * side, 0.56F, 0});
        doll.ball(chest, upperArm, {0.2F * side, 0.56F, 0}, 1.2F);
        doll.hinge(upperArm, foreArm, {0.53F * side, 0.56F, 0}, {0, side, 0});
        ends.leftShin = side < 0 ? shin.body : ends.leftShin;
    }
    return ends;
}

// Each stands with one foot on the head of the last, and is tied to it. (Bullet's sort of joints by
// islands is unstable: were the dolls islands of their own, pairs without contacts would change the
// order in which their joints are solved.)
void fillRagdolls(WorldContents& contents, const btVector3& origin, int size) {
    addFloor(contents, origin);
    btRigidBody* head = nullptr;
    for (int i = 0; i < size; ++i) {
        const auto number = static_cast<btScalar>(i);
        const HeadAndFoot doll = addDoll(
            contents, origin + btVector3(kLegAside * number, 1.2F + kDollHeight * number, 0));
        if (head != nullptr) {
            contents.addConstraint(std::make_unique<btPoint2PointConstraint>(
                *head, *doll.leftShin, btVector3(0, 0.13F, 0), btVector3(0, -0.24F, 0)));
        }
        head = doll.head;
    }
}

// --- Heavy on light ------------------------------------------------------------------------------

// Columns of `size` boxes of 1 kg, and on each a box of so many.
template <int kMass>
void fillHeavy(WorldContents& contents, const btVector3& origin, int size) {
    constexpr int kColumns = 3;
    addFloor(contents, origin);
    auto& box = contents.addShape<btBoxShape>(btVector3(kHalf, kHalf, kHalf));
    for (int column = 0; column < kColumns; ++column) {
        for (int i = 0; i <= size; ++i) {
            const btVector3 place(3 * static_cast<btScalar>(column),
                                  kHalf + static_cast<btScalar>(i), 0);
            contents.addBody(box, i < size ? btScalar(1) : btScalar(kMass), origin + place);
        }
    }
}

// --- Bullets -------------------------------------------------------------------------------------

// Walls are the first `size` bodies, from 1 mm to 10 cm thick; bullet i flies along x at wall i, 3
// to 4 m a step, and begins anywhere in the two steps before it. No gravity.
void addBullets(WorldContents& contents, const btVector3& origin, int size, bool areStopped) {
    constexpr btScalar kRadius = 0.05F;
    constexpr btScalar kWallPitch = 2;
    Random random(0x5eedb);
    contents.world().setGravity(btVector3(0, 0, 0));
    const auto rowOf = [&](int i) {
        return origin + btVector3(0, kWallPitch * static_cast<btScalar>(i % 8),
                                  kWallPitch * static_cast<btScalar>(i / 8));
    };
    for (int i = 0; i < size; ++i) {
        const btScalar thick = btScalar(0.001) * std::pow(btScalar(10), random.between(0, 2));
        auto& wall = contents.addShape<btBoxShape>(btVector3(thick / 2, 0.9F, 0.9F));
        contents.addBody(wall, 0, rowOf(i));
    }
    auto& ball = contents.addShape<btSphereShape>(kRadius);
    for (int i = 0; i < size; ++i) {
        const btScalar speed = random.between(180, 240);
        const btScalar start = -random.between(0.2F, 8);
        btRigidBody& bullet = contents.addBody(ball, 0.1F, rowOf(i) + btVector3(start, 0, 0));
        bullet.setLinearVelocity(btVector3(speed, 0, 0));
        if (areStopped) {
            bullet.setCcdMotionThreshold(kRadius);
            bullet.setCcdSweptSphereRadius(kRadius * btScalar(0.8));
        } else {
            bullet.setCollisionFlags(bullet.getCollisionFlags() |
                                     btCollisionObject::CF_NO_CONTACT_RESPONSE);
        }
    }
}

void fillStoppedBullets(WorldContents& contents, const btVector3& origin, int size) {
    addBullets(contents, origin, size, true);
}

void fillPassingBullets(WorldContents& contents, const btVector3& origin, int size) {
    addBullets(contents, origin, size, false);
    contents.world().getDispatchInfo().m_useContinuous = false;
}

}  // namespace

std::vector<HardWorld> hardWorlds() {
    return {
        {"tower", "boxes, one on top of the other", 40, 0, 900, true, Bullets::none, fillTower},
        {"pyramid", "boxes in the lowest course of a pyramid", 10, 0, 600, true, Bullets::none,
         fillPyramid},
        {"cards", "storeys of a house of cards", 4, 0, 900, true, Bullets::none, fillCards},
        {"chain", "links of a chain that swings a ball of a hundred times their mass", 20, 0, 600,
         false, Bullets::none, fillChain},
        {"ragdolls", "ragdolls of eleven limbs, one on top of the other", 3, 0, 900, true,
         Bullets::none, fillRagdolls},
        {"heavy-100", "boxes under one of a hundred times their mass, three times", 5, 0, 600, true,
         Bullets::none, fillHeavy<100>},
        {"heavy-1000", "boxes under one of a thousand times their mass, three times", 5, 0, 600,
         true, Bullets::none, fillHeavy<1000>},
        {"bullets-stop", "bullets at thin walls that are to stop them", 48, 0, 60, false,
         Bullets::stop, fillStoppedBullets},
        {"bullets-pass", "bullets through thin walls that are to notice them", 48, 0, 10, false,
         Bullets::pass, fillPassingBullets},
    };
}

HardWorld movedTo(double offset, HardWorld world) {
    world.offset = offset;
    if (offset > 0) {
        world.name += "@2^" + std::to_string(std::ilogb(offset));
    }
    return world;
}

}  // namespace hashphase::demos
