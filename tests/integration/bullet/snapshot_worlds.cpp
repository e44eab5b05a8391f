// SPDX-License-Identifier: Zlib
#include <tests/integration/bullet/snapshot_worlds.hpp>

#include <demos/scenes/result_hash.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletDynamics/Character/btKinematicCharacterController.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>

namespace hashphase::test {
namespace {

using demos::HardWorld;
using demos::WorldContents;

void addFloor(WorldContents& contents) {
    auto& floor = contents.addShape<btBoxShape>(btVector3(40, 1, 40));
    contents.addBody(floor, 0, btVector3(0, -1, 0));
}

/// Shapes of all kinds fall on each other and on a plane, a mesh and a heightfield.
void fillShapes(WorldContents& contents, const btVector3& /*origin*/, int size) {
    auto& plane = contents.addShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0));
    contents.addBody(plane, 0, btVector3(0, 0, 0));
    constexpr int kSide = 16;
    auto heights = std::make_shared<std::vector<btScalar>>();
    for (int i = 0; i < kSide * kSide; ++i) {
        heights->push_back(static_cast<btScalar>(0.5 + 0.4 * std::sin(0.9 * i)));
    }
    contents.keep(heights);
    auto& field = contents.addShape<btHeightfieldTerrainShape>(
        kSide, kSide, static_cast<const void*>(heights->data()), btScalar(1), btScalar(0),
        btScalar(1), 1, sizeof(btScalar) == 4 ? PHY_FLOAT : PHY_DOUBLE, false);
    contents.addBody(field, 0, btVector3(0, btScalar(0.5), 0));
    auto mesh = std::make_shared<btTriangleMesh>();
    for (int i = 0; i < 6; ++i) {
        const auto x = static_cast<btScalar>(-6 + 2 * i);
        mesh->addTriangle({x, 1, -8}, {x, 1, -3}, {x + 2, 2, -5});
        mesh->addTriangle({x, 1, -8}, {x + 2, 2, -5}, {x + 2, 1, -8});
    }
    contents.keep(mesh);
    auto& ramp = contents.addShape<btBvhTriangleMeshShape>(mesh.get(), true);
    contents.addBody(ramp, 0, btVector3(0, 0, 0));
    auto& hull = contents.addShape<btConvexHullShape>();
    for (const btVector3& corner : {btVector3(-0.4F, -0.3F, -0.3F), btVector3(0.5F, -0.3F, 0),
                                    btVector3(0, 0.4F, 0.1F), btVector3(0, -0.2F, 0.5F)}) {
        hull.addPoint(corner);
    }
    const std::array<btCollisionShape*, 6> shapes{
        &contents.addShape<btSphereShape>(btScalar(0.4)),
        &contents.addShape<btBoxShape>(btVector3(0.3F, 0.4F, 0.5F)),
        &contents.addShape<btCapsuleShape>(btScalar(0.3), btScalar(0.6)),
        &contents.addShape<btCylinderShape>(btVector3(0.4F, 0.3F, 0.4F)),
        &contents.addShape<btConeShape>(btScalar(0.4), btScalar(0.8)),
        &hull,
    };
    for (int i = 0; i < size; ++i) {
        const btVector3 at(static_cast<btScalar>(i % 5 - 2) * btScalar(0.8),
                           2 + static_cast<btScalar>(i) * btScalar(0.35),
                           static_cast<btScalar>(i % 7 - 3) * btScalar(0.7));
        btRigidBody& body = contents.addBody(*shapes[static_cast<std::size_t>(i) % shapes.size()],
                                             1 + static_cast<btScalar>(i % 3), at);
        body.setAngularVelocity(btVector3(1, static_cast<btScalar>(i % 4), 2));
        body.setRollingFriction(btScalar(0.05));
        body.setRestitution(i % 3 == 0 ? btScalar(0.5) : btScalar(0));
    }
}

/// Compounds with and without a tree of their own, nested ones, and simple bodies.
void fillCompounds(WorldContents& contents, const btVector3& /*origin*/, int size) {
    addFloor(contents);
    auto& ball = contents.addShape<btSphereShape>(btScalar(0.3));
    auto& box = contents.addShape<btBoxShape>(btVector3(0.4F, 0.15F, 0.15F));
    const auto make = [&](bool hasTree) -> btCompoundShape& {
        auto& compound = contents.addShape<btCompoundShape>(hasTree);
        btTransform place = btTransform::getIdentity();
        for (int i = -1; i <= 1; ++i) {
            place.setOrigin(btVector3(static_cast<btScalar>(i) * btScalar(0.6), 0, 0));
            compound.addChildShape(place, i == 0 ? static_cast<btCollisionShape*>(&box) : &ball);
        }
        return compound;
    };
    btCompoundShape& withTree = make(true);
    btCompoundShape& withoutTree = make(false);
    auto& nested = contents.addShape<btCompoundShape>(true);
    btTransform place = btTransform::getIdentity();
    nested.addChildShape(place, &withTree);
    place.setOrigin(btVector3(0, btScalar(0.7), 0));
    nested.addChildShape(place, &ball);
    const std::array<btCollisionShape*, 5> shapes{&withTree, &ball, &withoutTree, &nested, &box};
    for (int i = 0; i < size; ++i) {
        btRigidBody& body =
            contents.addBody(*shapes[static_cast<std::size_t>(i) % shapes.size()], 1,
                             btVector3(static_cast<btScalar>(i % 3 - 1) * btScalar(0.7),
                                       1 + static_cast<btScalar>(i) * btScalar(0.5),
                                       static_cast<btScalar>(i % 4 - 2) * btScalar(0.4)));
        body.setAngularVelocity(btVector3(static_cast<btScalar>(i % 5), 1, 2));
    }
}

/// Pairs of bodies linked by a joint of each type, with motors, springs and limits.
void fillJoints(WorldContents& contents, const btVector3& /*origin*/, int /*size*/) {
    addFloor(contents);
    auto& box = contents.addShape<btBoxShape>(btVector3(0.3F, 0.3F, 0.3F));
    btTransform half = btTransform::getIdentity();
    half.setOrigin(btVector3(btScalar(0.5), 0, 0));
    btTransform other = half;
    other.setOrigin(btVector3(btScalar(-0.5), 0, 0));
    for (int type = 0; type < 9; ++type) {
        const btVector3 at(0, 3, static_cast<btScalar>(2 * type - 8));
        btRigidBody& a = contents.addBody(box, 1, at);
        btRigidBody& b = contents.addBody(box, 2, at + btVector3(1, 0, 0));
        std::unique_ptr<btTypedConstraint> joint;
        switch (type) {
            case 0:
                joint = std::make_unique<btPoint2PointConstraint>(a, b, half.getOrigin(),
                                                                  other.getOrigin());
                break;
            case 1: {
                auto hinge =
                    std::make_unique<btHingeAccumulatedAngleConstraint>(a, b, half, other, false);
                hinge->enableAngularMotor(true, 3, btScalar(0.5));
                joint = std::move(hinge);
                break;
            }
            case 2:
                joint = std::make_unique<btConeTwistConstraint>(a, b, half, other);
                break;
            case 3:
                joint = std::make_unique<btGeneric6DofConstraint>(a, b, half, other, true);
                break;
            case 4: {
                auto slider = std::make_unique<btSliderConstraint>(a, b, half, other, true);
                slider->setPoweredLinMotor(true);
                slider->setTargetLinMotorVelocity(1);
                slider->setMaxLinMotorForce(2);
                joint = std::move(slider);
                break;
            }
            case 5: {
                auto spring =
                    std::make_unique<btGeneric6DofSpringConstraint>(a, b, half, other, true);
                spring->enableSpring(0, true);
                spring->setStiffness(0, 20);
                joint = std::move(spring);
                break;
            }
            case 6: {
                auto spring = std::make_unique<btGeneric6DofSpring2Constraint>(a, b, half, other);
                spring->enableSpring(1, true);
                spring->setStiffness(1, 30);
                joint = std::move(spring);
                break;
            }
            case 7:
                joint = std::make_unique<btFixedConstraint>(a, b, half, other);
                break;
            default:
                joint = std::make_unique<btGearConstraint>(a, b, btVector3(1, 0, 0),
                                                           btVector3(1, 0, 0), btScalar(2));
                break;
        }
        joint->setBreakingImpulseThreshold(type == 3 ? btScalar(4) : btScalar(1e9));
        contents.addConstraint(std::move(joint));
    }
}

/// What owns a character and its ghost, and takes both out of the world before it.
struct Character {
    Character(WorldContents& itsContents, const btVector3& at, btScalar turn)
        : contents(itsContents), controller(&ghost, &shape, btScalar(0.3), btVector3(0, 1, 0)) {
        ghost.setWorldTransform(btTransform(btQuaternion(0, 0, 0, 1), at));
        ghost.setCollisionShape(&shape);
        ghost.setCollisionFlags(btCollisionObject::CF_CHARACTER_OBJECT);
        contents.world().addCollisionObject(&ghost, btBroadphaseProxy::CharacterFilter,
                                            btBroadphaseProxy::AllFilter);
        contents.world().addAction(&controller);
        controller.setWalkDirection(btVector3(std::cos(turn), 0, std::sin(turn)) * btScalar(0.04));
        controller.jump(btVector3(0, 5, 0));
    }
    ~Character() {
        contents.world().removeAction(&controller);
        contents.world().removeCollisionObject(&ghost);
    }
    Character(const Character&) = delete;
    Character& operator=(const Character&) = delete;

    WorldContents& contents;
    btCapsuleShape shape{btScalar(0.4), btScalar(1)};
    btPairCachingGhostObject ghost;
    btKinematicCharacterController controller;
};

/// A ghost, which lists what is in it, and leaves the world before it ends.
struct Sensor {
    Sensor(WorldContents& itsContents, const btVector3& at) : contents(itsContents) {
        ghost.setWorldTransform(btTransform(btQuaternion(0, 0, 0, 1), at));
        ghost.setCollisionShape(&shape);
        ghost.setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
        contents.world().addCollisionObject(&ghost, btBroadphaseProxy::SensorTrigger,
                                            btBroadphaseProxy::AllFilter);
    }
    ~Sensor() { contents.world().removeCollisionObject(&ghost); }
    Sensor(const Sensor&) = delete;
    Sensor& operator=(const Sensor&) = delete;

    WorldContents& contents;
    btSphereShape shape{2};
    btGhostObject ghost;
};

/// Characters walk among boxes, and through a sensor.
void fillCharacters(WorldContents& contents, const btVector3& /*origin*/, int size) {
    static btGhostPairCallback tellGhosts;
    contents.world().getPairCache()->setInternalGhostPairCallback(&tellGhosts);
    addFloor(contents);
    auto& box = contents.addShape<btBoxShape>(btVector3(0.4F, 0.4F, 0.4F));
    for (int i = 0; i < size; ++i) {
        contents.addBody(box, 1,
                         btVector3(static_cast<btScalar>(i % 5 - 2) * btScalar(1.1),
                                   btScalar(0.5) + static_cast<btScalar>(i / 5),
                                   static_cast<btScalar>(i % 3 - 1) * btScalar(1.2)));
    }
    contents.keep(std::make_shared<Sensor>(contents, btVector3(0, 1, -1)));
    for (int i = 0; i < 3; ++i) {
        contents.keep(std::make_shared<Character>(
            contents, btVector3(static_cast<btScalar>(3 * i - 3), 3, -3),
            static_cast<btScalar>(i)));
    }
}

struct Hash {
    demos::ResultHash hash;

    void operator()(const void* from, std::size_t count) {
        const auto* const bytes = static_cast<const unsigned char*>(from);
        for (std::size_t i = 0; i < count; i += 4) {
            std::uint32_t word = 0;
            std::memcpy(&word, bytes + i, std::min<std::size_t>(4, count - i));
            hash.add(std::uint64_t{word});
        }
    }
    void operator()(const btVector3& vector) { (*this)(vector.m_floats, 3 * sizeof(btScalar)); }
    void operator()(const btTransform& place) {
        for (int row = 0; row < 3; ++row) {
            (*this)(place.getBasis()[row]);
        }
        (*this)(place.getOrigin());
    }
    void operator()(btScalar number) { (*this)(&number, sizeof(number)); }
    void operator()(int number) { hash.add(static_cast<std::uint64_t>(number)); }
};

}  // namespace

std::uint64_t wholeState(btDiscreteDynamicsWorld& world) {
    Hash add;
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    add(objects.size());
    for (int i = 0; i < objects.size(); ++i) {
        const btCollisionObject& object = *objects[i];
        add(object.getBroadphaseHandle()->m_uniqueId);
        add(object.getWorldTransform());
        add(object.getInterpolationWorldTransform());
        add(object.getInterpolationLinearVelocity());
        add(object.getInterpolationAngularVelocity());
        add(object.getActivationState());
        add(object.getDeactivationTime());
        add(object.getHitFraction());
        add(object.getCollisionFlags());
        add(object.getFriction());
        add(object.getBroadphaseHandle()->m_aabbMin);
        add(object.getBroadphaseHandle()->m_aabbMax);
        if (const btRigidBody* const body = btRigidBody::upcast(&object)) {
            add(body->getLinearVelocity());
            add(body->getAngularVelocity());
            add(body->getTotalForce());
            add(body->getTotalTorque());
            add(body->getGravity());
            add(body->getInvMass());
            add(body->getInvInertiaDiagLocal());
            for (int row = 0; row < 3; ++row) {
                add(body->getInvInertiaTensorWorld()[row]);
            }
        }
        if (const auto* const ghost = btGhostObject::upcast(&object)) {
            add(ghost->getNumOverlappingObjects());
            for (int k = 0; k < ghost->getNumOverlappingObjects(); ++k) {
                add(ghost->getOverlappingObject(k)->getWorldArrayIndex());
            }
        }
    }
    btDispatcher& dispatcher = *world.getDispatcher();
    add(dispatcher.getNumManifolds());
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
        const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
        add(manifold.getBody0()->getWorldArrayIndex());
        add(manifold.getBody1()->getWorldArrayIndex());
        add(manifold.getContactBreakingThreshold());
        add(manifold.getNumContacts());
        for (int k = 0; k < manifold.getNumContacts(); ++k) {
            const btManifoldPoint& point = manifold.getContactPoint(k);
            for (const btVector3& vector :
                 {point.m_localPointA, point.m_localPointB, point.m_positionWorldOnA,
                  point.m_positionWorldOnB, point.m_normalWorldOnB, point.m_lateralFrictionDir1}) {
                add(vector);
            }
            for (const btScalar number :
                 {point.m_distance1, point.m_appliedImpulse, point.m_appliedImpulseLateral1,
                  point.m_appliedImpulseLateral2, point.m_prevRHS, point.m_combinedFriction}) {
                add(number);
            }
            add(point.m_lifeTime);
            add(point.m_index0);
            add(point.m_index1);
        }
    }
    const btBroadphasePairArray& pairs = world.getPairCache()->getOverlappingPairArray();
    add(pairs.size());
    for (int i = 0; i < pairs.size(); ++i) {
        add(pairs[i].m_pProxy0->m_uniqueId);
        add(pairs[i].m_pProxy1->m_uniqueId);
        add(pairs[i].m_algorithm != nullptr ? 1 : 0);
    }
    for (int i = 0; i < world.getNumConstraints(); ++i) {
        add(world.getConstraint(i)->internalGetAppliedImpulse());
        add(world.getConstraint(i)->isEnabled() ? 1 : 0);
    }
    return add.hash.value();
}

void disturb(btDiscreteDynamicsWorld& world, Random& random) {
    const auto vector = [&](double length) {
        const Vector3<double> drawn = random.pointIn(-length, length);
        return btVector3(static_cast<btScalar>(drawn.x()), static_cast<btScalar>(drawn.y()),
                         static_cast<btScalar>(drawn.z()));
    };
    btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        btRigidBody* const body = btRigidBody::upcast(objects[i]);
        if (body == nullptr || body->isStaticObject() || !random.chance(0.6)) {
            continue;
        }
        switch (random.below(6)) {
            case 0:
                body->activate(true);
                body->applyCentralImpulse(vector(5));
                break;
            case 1:
                body->setWorldTransform(btTransform(btQuaternion(vector(1) + btVector3(0, 2, 0), 1),
                                                    vector(6) + btVector3(0, 7, 0)));
                break;
            case 2:
                body->forceActivationState(ISLAND_SLEEPING);
                break;
            case 3:
                body->setFriction(btScalar(0.1));
                body->setDamping(btScalar(0.3), btScalar(0.4));
                break;
            case 4:
                body->setMassProps(7, btVector3(1, 2, 3));
                body->updateInertiaTensor();
                break;
            default:
                body->applyForce(vector(20), vector(1));
                break;
        }
    }
    for (int i = 0; i < world.getNumConstraints(); ++i) {
        if (random.chance(0.3)) {
            world.getConstraint(i)->setEnabled(random.chance(0.5));
        }
    }
    world.setGravity(vector(12));
}

std::vector<HardWorld> snapshotWorlds() {
    std::vector<HardWorld> all;
    for (HardWorld world : demos::hardWorlds()) {
        world.size = world.name == "ragdolls"                           ? 2
                     : world.bullets != demos::Bullets::none            ? 12
                     : world.name == "chain" || world.name == "pyramid" ? 7
                                                                        : world.size;
        all.push_back(world);
    }
    const auto add = [&](const char* name, int size, auto fill) {
        HardWorld world;
        world.name = world.title = name;
        world.size = size;
        world.fill = fill;
        all.push_back(world);
    };
    add("shapes", 42, &fillShapes);
    add("compounds", 25, &fillCompounds);
    add("joints", 9, &fillJoints);
    add("characters", 25, &fillCharacters);
    return all;
}

demos::PhysicsBroadphase snapshotBroadphase(const HardWorld& world) {
    SpatialHashConfig config;
    config.sweep = world.bullets == demos::Bullets::pass ? Sweep::automatic : Sweep::none;
    return {std::string(demos::kHashName), true, true, [config](PairCache* cache) {
                return std::make_unique<SpatialHashBroadphase>(cache, config);
            }};
}

}  // namespace hashphase::test
