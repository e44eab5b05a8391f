// SPDX-License-Identifier: Zlib
#include <tests/integration/bullet/dynamics.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <ostream>
#include <set>

namespace hashphase::test {

DynamicsWorld::DynamicsWorld(std::unique_ptr<btBroadphaseInterface> broadphase,
                             std::unique_ptr<btOverlappingPairCache> cache)
    : cache_(std::move(cache)), broadphase_(std::move(broadphase)) {}

DynamicsWorld::~DynamicsWorld() {
    for (const auto& link : links_) {
        world_.removeConstraint(link.get());
    }
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

void DynamicsWorld::link(int a, int b, const btVector3& pointInA, const btVector3& pointInB) {
    links_.push_back(
        std::make_unique<btPoint2PointConstraint>(body(a), body(b), pointInA, pointInB));
    world_.addConstraint(links_.back().get(), true);
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
            if (overlap({a->m_aabbMin, a->m_aabbMax}, {b->m_aabbMin, b->m_aabbMax}) &&
                cache().needsBroadphaseCollision(a, b)) {
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

void addPlane(DynamicsWorld& world) {
    world.add(world.keep(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0))), 0,
              placeAt({0, 0, 0}));
}

void addFloor(DynamicsWorld& world) {
    world.addBox({40, 1, 40}, 0, {0, -1, 0});
}

constexpr int kPileBodies = 180;

void buildPile(DynamicsWorld& world) {
    addPlane(world);
    BulletRandom random(1);
    const auto half = btScalar(0.4);
    const std::array<btCollisionShape*, 4> shapes{
        world.keep(std::make_unique<btSphereShape>(half)),
        world.keep(std::make_unique<btBoxShape>(btVector3(half, half, half))),
        world.keep(std::make_unique<btCapsuleShape>(btScalar(0.3), half)),
        world.keep(std::make_unique<btCylinderShape>(btVector3(half, half, half))),
    };
    for (int i = 0; i < kPileBodies; ++i) {
        const btScalar height = 1 + btScalar(i) * btScalar(0.08);
        world.add(shapes[static_cast<std::size_t>(i) % shapes.size()], 1,
                  somewhereAbove(random, height, height + 1));
    }
}

void buildStack(DynamicsWorld& world) {
    addFloor(world);
    btCollisionShape* const brick = world.keep(
        std::make_unique<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.25), btScalar(0.25))));
    constexpr int kRows = 14;
    for (int row = 0; row < kRows; ++row) {
        for (int i = 0; i < kRows - row; ++i) {
            const btScalar x = btScalar(i) + btScalar(row) / 2;
            world.add(brick, 1, placeAt({x, btScalar(0.25) + btScalar(row) / 2, 0}));
        }
    }
}

constexpr int kCompounds = 90;

void buildCompounds(DynamicsWorld& world) {
    addFloor(world);
    BulletRandom random(2);
    btCollisionShape* const bar = world.keep(
        std::make_unique<btBoxShape>(btVector3(btScalar(0.7), btScalar(0.15), btScalar(0.15))));
    btCollisionShape* const ball = world.keep(std::make_unique<btSphereShape>(btScalar(0.3)));
    btCompoundShape* const dumbbell = world.keep(std::make_unique<btCompoundShape>());
    dumbbell->addChildShape(placeAt({0, 0, 0}), bar);
    dumbbell->addChildShape(placeAt({btScalar(0.7), 0, 0}), ball);
    dumbbell->addChildShape(placeAt({btScalar(-0.7), 0, 0}), ball);
    btCompoundShape* const cross = world.keep(std::make_unique<btCompoundShape>());
    cross->addChildShape(placeAt({0, 0, 0}), bar);
    cross->addChildShape(placeAt({0, 0, 0}, btQuaternion({0, 1, 0}, SIMD_HALF_PI)), bar);
    for (int i = 0; i < kCompounds; ++i) {
        const btScalar height = 1 + btScalar(i) * btScalar(0.12);
        world.add(i % 2 == 0 ? dumbbell : cross, 1, somewhereAbove(random, height, height + 1));
    }
}

/// Chains of ten links; the first of each is fixed in the air, or as free as the others.
void buildChains(DynamicsWorld& world, bool hang) {
    btCollisionShape* const shape =
        world.keep(std::make_unique<btCapsuleShapeX>(btScalar(0.12), btScalar(0.3)));
    const btVector3 end(btScalar(0.3), 0, 0);
    for (int chain = 0; chain < 16; ++chain) {
        const btVector3 start(btScalar(chain % 4) * btScalar(0.7),
                              4 + btScalar(chain / 4) * btScalar(0.5),
                              btScalar(chain % 4) * btScalar(0.35));
        int previous = -1;
        for (int i = 0; i < 10; ++i) {
            const btScalar mass = hang && i == 0 ? 0 : 1;
            const int link = world.add(
                shape, mass, placeAt(start + btVector3(btScalar(i) * btScalar(0.6), 0, 0)));
            if (previous >= 0) {
                world.link(previous, link, end, -end);
            }
            previous = link;
        }
    }
}

void buildHangingChains(DynamicsWorld& world) {
    addFloor(world);
    buildChains(world, true);
}

void buildChainsOnAPlane(DynamicsWorld& world) {
    addPlane(world);
    buildChains(world, false);
}

void leaveAlone(DynamicsWorld& /*world*/, int /*step*/) {}

/// Takes bodies out of the pile and drops them on top of it.
void churn(DynamicsWorld& world, int step) {
    if (step % 11 != 0 || step > 700) {
        return;
    }
    BulletRandom random(static_cast<std::uint64_t>(step) + 1000);
    for (int i = 0; i < 3; ++i) {
        const int number = 1 + random.below(world.bodyCount() - 1);
        world.readd(number, somewhereAbove(random, 6, 9));
    }
}

}  // namespace

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

void PrintTo(const DynamicsScene& scene, std::ostream* out) {
    *out << scene.name;
}

const std::vector<DynamicsScene>& dynamicsScenes() {
    static const std::vector<DynamicsScene> scenes{
        {"pile", buildPile, leaveAlone, true},
        {"stack", buildStack, leaveAlone, true},
        {"compounds", buildCompounds, leaveAlone, true},
        {"chains", buildHangingChains, leaveAlone, false},
        {"pileWithChurn", buildPile, churn, true},
        {"compoundsWithChurn", buildCompounds, churn, true},
        {"chainsOnAPlane", buildChainsOnAPlane, leaveAlone, true},
    };
    return scenes;
}

}  // namespace hashphase::test
