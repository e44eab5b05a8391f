// SPDX-License-Identifier: Zlib

// Snapshots of worlds as bytes: what they need of the world that reads them, and bytes of a stranger's.

#include <integration/bullet/world_snapshot.hpp>

#include <tests/integration/bullet/pool_world.hpp>
#include <tests/support/forged_bytes.hpp>
#include <tests/support/handlers.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <btBulletDynamicsCommon.h>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

TEST(WorldSnapshot, IsReadWhereObjectsHaveToBeHandedOver) {
    FewBodies few;
    btHingeConstraint joint(*few.pool[0], *few.pool[1], btVector3(0, 1, 0), btVector3(0, -1, 0),
                            btVector3(0, 0, 1), btVector3(0, 0, 1));
    few.world.addConstraint(&joint, true);
    few.pool[2]->setIgnoreCollisionCheck(few.pool[3].get(), true);
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    std::vector<std::byte> bytes;
    ASSERT_EQ(snapshot.write(bytes), "");
    const std::uint64_t state = wholeState(few.world);
    few.world.removeConstraint(&joint);
    few.world.removeRigidBody(few.pool[4].get());
    few.world.removeRigidBody(few.pool[2].get());
    WorldSnapshot received;
    const std::array<btCollisionObject*, 2> objects{few.pool[2].get(), few.pool[4].get()};
    btGhostObject ghost;  // of another type, where it stands for a body
    ghost.setCollisionShape(&few.ball);
    btCollisionObject* const wrong = &ghost;
    for (const std::span<btCollisionObject* const> tooFew :
         {std::span<btCollisionObject* const>(), std::span(objects).first(1),
          std::span(objects).last(1), std::span(&wrong, 1)}) {
        EXPECT_EQ(received.read(bytes, few.world, few.broadphase, {.objects = tooFew}),
                  "Objects are not in the world. Hand them over as Returned::objects, in the order "
                  "of these unique ids: 4, 6.");
    }
    EXPECT_NE(received.read(bytes, few.world, few.broadphase, {.objects = objects})
                  .find("Hand it over as Returned::joints."),
              std::string::npos);
    btTypedConstraint* const joints = &joint;
    const Returned returned{.objects = objects, .joints = {&joints, 1}};
    ASSERT_EQ(received.read(bytes, few.world, few.broadphase, returned), "");
    ASSERT_EQ(received.restore(few.world, few.broadphase, returned), "");
    EXPECT_EQ(wholeState(few.world), state);
    EXPECT_FALSE(few.pool[2]->checkCollideWith(few.pool[3].get()));
}

TEST(WorldSnapshot, IsNotReadIntoAnotherWorld) {
    FewBodies few;
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    std::vector<std::byte> bytes;
    ASSERT_EQ(snapshot.write(bytes), "");
    WorldSnapshot received;
    EXPECT_EQ(received.read({}, few.world, few.broadphase),
              "The bytes are not a snapshot of a world. Pass bytes that write() made.");
    bytes[100] ^= std::byte{4};
    EXPECT_EQ(received.read(bytes, few.world, few.broadphase),
              "The bytes of a snapshot of a world are damaged: their checksum is wrong. Read or "
              "receive them again.");
    bytes[100] ^= std::byte{4};
    PoolWorld empty;
    EXPECT_NE(received.read(bytes, empty.world, empty.broadphase).find("2, 3, 4, 5, 6, 7"),
              std::string::npos);
    EXPECT_TRUE(received.isEmpty());
    btGhostObject ghost;
    ghost.setCollisionShape(&empty.ball);
    empty.world.addCollisionObject(&ghost);
    const std::array<btCollisionObject*, 5> five{empty.pool[0].get(), empty.pool[1].get(),
                                                 empty.pool[2].get(), empty.pool[3].get(),
                                                 empty.pool[4].get()};
    EXPECT_EQ(received.read(bytes, empty.world, empty.broadphase, {.objects = five}),
              "The object with the unique id 2 has another type or compound shape than the saved "
              "one. Build both worlds by the same calls.");
    empty.world.removeCollisionObject(&ghost);
}

// Whatever they say: there is nothing that a stranger's bytes can break, but for where things are.
TEST(WorldSnapshot, IsSoundOrRefusedWhateverItsBytesAre) {
    FewBodies few;
    btHingeConstraint joint(*few.pool[0], *few.pool[1], btVector3(0, 1, 0), btVector3(0, -1, 0),
                            btVector3(0, 0, 1), btVector3(0, 0, 1));
    few.world.addConstraint(&joint, true);
    btCompoundShape compound;
    compound.addChildShape(btTransform::getIdentity(), &few.ball);
    btTransform beside = btTransform::getIdentity();
    beside.setOrigin(btVector3(1, 0, 0));
    compound.addChildShape(beside, &few.box);
    few.pool[5]->setCollisionShape(&compound);
    few.broadphase.shapeChanged(few.pool[5]->getBroadphaseHandle(), &few.dispatcher);
    btGhostPairCallback ghostCallback;
    few.cache.setInternalGhostPairCallback(&ghostCallback);
    btPairCachingGhostObject ghost;
    btBoxShape sensed(btVector3(9, 9, 9));
    ghost.setCollisionShape(&sensed);
    ghost.setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
    few.world.addCollisionObject(&ghost);
    few.world.stepSimulation(btScalar(1) / 60, 0);
    ASSERT_GT(ghost.getNumOverlappingObjects(), 2);
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    std::vector<std::byte> bytes;
    ASSERT_EQ(snapshot.write(bytes), "");
    const std::uint64_t state = wholeState(few.world);
    const CaughtMessages messages;
    Random random(7);
    int read = 0;
    for (int i = 0; i < 1500; ++i) {
        std::vector<std::byte> forged = bytes;
        forgeBytes(forged, random);
        WorldSnapshot received;
        if (received.read(forged, few.world, few.broadphase).empty()) {
            ++read;
            ASSERT_EQ(received.restore(few.world, few.broadphase), "");
            few.world.stepSimulation(btScalar(1) / 60, 0);
            few.world.removeRigidBody(few.pool[1].get());
            few.world.stepSimulation(btScalar(1) / 60, 0);
            ASSERT_EQ(few.restore(snapshot), "");
            ASSERT_EQ(wholeState(few.world), state);
        }
    }
    EXPECT_GT(read, 100);
    few.world.removeConstraint(&joint);
    few.world.removeCollisionObject(&ghost);
    few.world.removeRigidBody(few.pool[5].get());
}

}  // namespace
}  // namespace hashphase::test
