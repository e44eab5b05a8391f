// SPDX-License-Identifier: Zlib
#include <tests/integration/bullet/dynamics.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <set>

namespace hashphase::test {

DynamicsWorld::DynamicsWorld(std::unique_ptr<btBroadphaseInterface> broadphase,
                             std::unique_ptr<btOverlappingPairCache> cache)
    : cache_(std::move(cache)), broadphase_(std::move(broadphase)) {}

DynamicsWorld::~DynamicsWorld() {
    for (int i = world_.getNumCollisionObjects(); i-- > 0;) {
        world_.removeCollisionObject(world_.getCollisionObjectArray()[i]);
    }
}

int DynamicsWorld::add(btCollisionShape* shape, btScalar mass, const btTransform& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) {
        shape->calculateLocalInertia(mass, inertia);
    }
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
    info.m_startWorldTransform = place;
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setUserIndex(bodyCount() - 1);
    world_.addRigidBody(bodies_.back().get());
    return bodyCount() - 1;
}

btRigidBody& DynamicsWorld::addBox(const btVector3& halfExtents, btScalar mass,
                                   const btVector3& place) {
    return body(add(keep(std::make_unique<btBoxShape>(halfExtents)), mass, placeAt(place)));
}

btPairCachingGhostObject& DynamicsWorld::addGhost(btCollisionShape* shape, const btVector3& place) {
    tellGhosts();
    ghosts_.push_back(std::make_unique<btPairCachingGhostObject>());
    btPairCachingGhostObject& ghost = *ghosts_.back();
    ghost.setCollisionShape(shape);
    ghost.setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
    ghost.setWorldTransform(placeAt(place));
    world_.addCollisionObject(&ghost, btBroadphaseProxy::SensorTrigger,
                              btBroadphaseProxy::AllFilter);
    return ghost;
}

void DynamicsWorld::readd(int number, const btTransform& place) {
    takeOut(number);
    btRigidBody& moved = body(number);
    moved.setWorldTransform(place);
    moved.setInterpolationWorldTransform(place);
    moved.setLinearVelocity({0, 0, 0});
    moved.setAngularVelocity({0, 0, 0});
    moved.forceActivationState(ACTIVE_TAG);
    moved.setDeactivationTime(0);
    world_.addRigidBody(&moved);
}

void DynamicsWorld::takeOut(int number) {
    world_.removeRigidBody(&body(number));
}

int DynamicsWorld::sleepingCount() const {
    int count = 0;
    for (const auto& body : bodies_) {
        count += !body->isStaticObject() && !body->isActive();
    }
    return count;
}

void DynamicsWorld::expectExactPairs() {
    std::set<Uids> expected;
    const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        for (int k = 0; k < i; ++k) {
            btBroadphaseProxy* const a = objects[i]->getBroadphaseHandle();
            btBroadphaseProxy* const b = objects[k]->getBroadphaseHandle();
            if (overlap(boxOf(*a), boxOf(*b)) && cache().needsBroadphaseCollision(a, b)) {
                expected.insert(uidsOf(*a, *b));
            }
        }
    }
    EXPECT_EQ(uidPairs(cache()), expected);
    EXPECT_EQ(hash().validate(), "");
}

void putAt(btCollisionObject& object, const btVector3& place) {
    object.setWorldTransform(placeAt(place));
    object.setInterpolationWorldTransform(placeAt(place));
    object.setInterpolationLinearVelocity({0, 0, 0});
    if (auto* const body = btRigidBody::upcast(&object)) {
        body->setLinearVelocity({0, 0, 0});
    }
}

namespace {

using State = std::array<btScalar, 19>;

State stateOf(const btRigidBody& body) {
    State state{};
    std::size_t next = 0;
    const btTransform& place = body.getWorldTransform();
    for (const btVector3& v :
         {place.getBasis()[0], place.getBasis()[1], place.getBasis()[2], place.getOrigin(),
          body.getLinearVelocity(), body.getAngularVelocity()}) {
        for (int axis = 0; axis < 3; ++axis) {
            state[next++] = v[axis];
        }
    }
    state[next] = static_cast<btScalar>(body.getActivationState());
    return state;
}

btTransform somewhereAbove(BulletRandom& random, btScalar low, btScalar high) {
    const btVector3 axis = random.direction();
    const btQuaternion turn(axis, random.uniform(0, 3));
    const btScalar x = random.uniform(-3, 3);
    const btScalar z = random.uniform(-3, 3);
    return placeAt({x, random.uniform(low, high), z}, turn);
}

}  // namespace

void buildPile(DynamicsWorld& world) {
    world.add(world.keep(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0))), 0,
              placeAt({0, 0, 0}));
    BulletRandom random(1);
    const auto half = btScalar(0.4);
    const std::array<btCollisionShape*, 4> shapes{
        world.keep(std::make_unique<btSphereShape>(half)),
        world.keep(std::make_unique<btBoxShape>(btVector3(half, half, half))),
        world.keep(std::make_unique<btCapsuleShape>(btScalar(0.3), half)),
        world.keep(std::make_unique<btCylinderShape>(btVector3(half, half, half))),
    };
    for (int i = 0; i < 180; ++i) {
        const btScalar height = 1 + btScalar(i) * btScalar(0.08);
        world.add(shapes[static_cast<std::size_t>(i) % shapes.size()], 1,
                  somewhereAbove(random, height, height + 1));
    }
}

void churn(DynamicsWorld& world, int step) {
    BulletRandom random(static_cast<std::uint64_t>(step) + 1000);
    for (int i = 0; i < 3 && step % 11 == 0 && step <= 700; ++i) {
        const int number = 1 + random.below(world.bodyCount() - 1);
        world.readd(number, somewhereAbove(random, 6, 9));
    }
}

std::unique_ptr<btBroadphaseInterface> hashOverPairCache(PairCache* cache) {
    return std::make_unique<SpatialHashBroadphase>(cache);
}

std::unique_ptr<DynamicsWorld> canonicalWorld(
    std::unique_ptr<btBroadphaseInterface> (*make)(PairCache*)) {
    auto cache =
        std::make_unique<PairCache>(PairOrder::canonical, [](const btBroadphaseProxy& proxy) {
            return static_cast<const btCollisionObject*>(proxy.m_clientObject)->getUserIndex();
        });
    auto broadphase = make(cache.get());
    return std::make_unique<DynamicsWorld>(std::move(broadphase), std::move(cache));
}

int firstDifferentBody(const DynamicsWorld& a, const DynamicsWorld& b) {
    for (int i = 0; i < a.bodyCount(); ++i) {
        const State stateA = stateOf(a.body(i));
        const State stateB = stateOf(b.body(i));
        if (std::memcmp(stateA.data(), stateB.data(), sizeof(State)) != 0) {
            return i;
        }
    }
    return -1;
}

}  // namespace hashphase::test
