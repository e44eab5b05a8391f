// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/rollback.md; and that a peer that gets inputs late ends as one that gets
// them in time.

#include <tests/readme/surroundings.hpp>

#include <BulletDynamics/Vehicle/btRaycastVehicle.h>

#include <bit>
#include <deque>

namespace hashphase::test {
namespace netcode {
#include <rollback_2.inl>
}  // namespace netcode

namespace {

using netcode::Input;

/// A world with a floor, a pile of boxes, and two players, who are balls.
class Arena {
public:
    Arena() {
        add(0, floorShape_, {0, -1, 0});
        players = {add(2, ballShape_, {-4, 0.5F, 0}), add(2, ballShape_, {4, 0.5F, 0.2F})};
        for (int i = 0; i < 20; ++i) {
            const auto row = static_cast<btScalar>(i % 4);
            const auto course = static_cast<btScalar>(i / 4);
            add(1, boxShape_, {row - 1.5F, 0.5F + course, 0.1F * row});
        }
    }
    ~Arena() {
        while (world.getNumCollisionObjects() > 0) {
            world.removeCollisionObject(world.getCollisionObjectArray()[0]);
        }
    }
    Arena(const Arena&) = delete;
    Arena& operator=(const Arena&) = delete;

    btRigidBody* add(btScalar mass, btCollisionShape& shape, const btVector3& place) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) {
            shape.calculateLocalInertia(mass, inertia);
        }
        btRigidBody& body = bodies.emplace_back(mass, nullptr, &shape, inertia);
        body.setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
        body.setInterpolationWorldTransform(body.getWorldTransform());
        body.setUserIndex(static_cast<int>(bodies.size()) - 1);
        world.addRigidBody(&body);
        return &body;
    }

    /// Places, velocities and sleep of all bodies in the world.
    [[nodiscard]] std::vector<std::uint32_t> bits() const {
        std::vector<std::uint32_t> all;
        for (const btRigidBody& body : bodies) {
            if (!body.isInWorld()) {
                continue;
            }
            const btMatrix3x3& turn = body.getWorldTransform().getBasis();
            for (const btVector3& vector :
                 {turn[0], turn[1], turn[2], body.getWorldTransform().getOrigin(),
                  body.getLinearVelocity(), body.getAngularVelocity()}) {
                for (int axis = 0; axis < 3; ++axis) {
                    all.push_back(std::bit_cast<std::uint32_t>(vector[axis]));
                }
            }
            all.push_back(static_cast<std::uint32_t>(body.getActivationState()));
        }
        return all;
    }

private:
    btBoxShape floorShape_{{20, 1, 20}};
    btBoxShape boxShape_{{0.5F, 0.5F, 0.5F}};
    btSphereShape ballShape_{0.5F};
    btDefaultCollisionConfiguration configuration_;
    btSequentialImpulseConstraintSolver solver_;

public:
    btCollisionDispatcher dispatcher{&configuration_};
    SpatialHashBroadphase broadphase;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver_, &configuration_};
    std::deque<btRigidBody> bodies;
    std::array<btRigidBody*, netcode::kPlayers> players{};
};

struct Peer : Arena {
    netcode::Session session{world, broadphase, players};
};

constexpr std::uint32_t kFrames = 300;

std::uint32_t mixed(std::size_t player, std::uint32_t frame) {
    return (frame * 2 + static_cast<std::uint32_t>(player)) * 2654435761U >> 8;
}

// Each player runs at the pile, and back, and jumps at times.
Input inputOf(std::size_t player, std::uint32_t frame) {
    const bool runsLeft = (mixed(player, frame / 20) & 1) != 0;
    return {runsLeft ? -0.6F : 0.6F, mixed(player, frame) % 17 == 0};
}

std::uint32_t delayOf(std::uint32_t frame) {
    return mixed(9, frame) % (netcode::kBack + 1);
}

// Both players' inputs of each frame; those of player 1 late, if they are to be.
void play(Peer& peer, bool areLate) {
    for (std::uint32_t frame = 0; frame < kFrames + netcode::kBack; ++frame) {
        ASSERT_TRUE(peer.session.receive(0, frame, inputOf(0, frame)));
        for (std::uint32_t sent = frame - std::min(frame, netcode::kBack); sent <= frame; ++sent) {
            const bool arrives = sent + (areLate && sent < kFrames ? delayOf(sent) : 0) == frame;
            if (arrives) {
                ASSERT_TRUE(peer.session.receive(1, sent, inputOf(1, sent)));
            }
        }
        ASSERT_EQ(peer.session.advance(), "");
    }
}

TEST(RollbackPage, PeerWithLateInputsEndsAsOneThatGetsThemInTime) {
    Peer inTime;
    Peer late;
    Peer guessing;  // never gets those of player 1
    play(inTime, false);
    play(late, true);
    for (std::uint32_t frame = 0; frame < kFrames + netcode::kBack; ++frame) {
        ASSERT_TRUE(guessing.session.receive(0, frame, inputOf(0, frame)));
        ASSERT_EQ(guessing.session.advance(), "");
    }
    EXPECT_EQ(late.bits(), inTime.bits());
    EXPECT_NE(guessing.bits(), inTime.bits());
    EXPECT_EQ(late.session.game().jumpCounts, inTime.session.game().jumpCounts);
    EXPECT_GT(inTime.session.game().jumpCounts[1], 5);
}

TEST(RollbackPage, SessionRefusesInputsThatItCannotTake) {
    Peer peer;
    for (std::uint32_t frame = 0; frame < 20; ++frame) {
        ASSERT_EQ(peer.session.advance(), "");
    }
    EXPECT_FALSE(peer.session.receive(0, 11, {}));
    EXPECT_TRUE(peer.session.receive(0, 12, {}));
    EXPECT_TRUE(peer.session.receive(0, 27, {}));
    EXPECT_FALSE(peer.session.receive(0, 28, {}));
}

TEST(RollbackPage, WorldIsSavedAndGoesBack) {
    Arena arena;
    btDiscreteDynamicsWorld& world = arena.world;
    SpatialHashBroadphase& broadphase = arena.broadphase;
    const btScalar timeStep = btScalar(1) / 60;
    const auto before = arena.bits();
#include <rollback_1.inl>
    EXPECT_EQ(fault, "");
    EXPECT_EQ(arena.bits(), before);
}

TEST(RollbackPage, ParkedBodiesAreHandedOver) {
    Arena arena;
    btDiscreteDynamicsWorld& world = arena.world;
    SpatialHashBroadphase& broadphase = arena.broadphase;
    std::vector<btRigidBody*> pool;
    for (btRigidBody& body : arena.bodies) {
        pool.push_back(&body);
    }
    world.removeRigidBody(pool[5]);  // parked then, too
    WorldSnapshot snapshot;
    ASSERT_EQ(snapshot.save(world, broadphase), "");
    world.removeRigidBody(pool[7]);
    world.addRigidBody(pool[5]);
    EXPECT_NE(snapshot.restore(world, broadphase), "");
    world.removeRigidBody(pool[8]);
    {
#include <rollback_3.inl>
        EXPECT_EQ(fault, "");
    }
    EXPECT_FALSE(pool[5]->isInWorld());
    EXPECT_TRUE(pool[7]->isInWorld());
    EXPECT_TRUE(pool[8]->isInWorld());
}

TEST(RollbackPage, AnotherWorldGoesOnFromBytes) {
    Arena sender;
    Arena receiver;
    const auto play = [](Arena& arena, int frame) {
        btRigidBody& body = arena.bodies[5 + static_cast<std::size_t>(frame) % 7];
        if (frame % 20 == 3) {
            arena.world.removeRigidBody(&body);
            arena.world.addRigidBody(&body);
        }
        body.activate();
        body.applyCentralImpulse({0.3F, 0.5F, -0.2F});
        arena.world.stepSimulation(btScalar(1) / 60, 0);
    };
    for (int frame = 0; frame < 100; ++frame) {
        play(sender, frame);
    }
    sender.world.removeRigidBody(&sender.bodies[4]);
    while (receiver.world.getNumCollisionObjects() > 0) {
        receiver.world.removeCollisionObject(receiver.world.getCollisionObjectArray()[0]);
    }
    std::vector<std::byte> sentBytes;
    std::vector<int> sentNumbers;
    {
        btDiscreteDynamicsWorld& world = sender.world;
        SpatialHashBroadphase& broadphase = sender.broadphase;
        WorldSnapshot snapshot;
#include <rollback_4.inl>
        ASSERT_EQ(fault, "");
        sentBytes = bytes;
        sentNumbers = numbers;
    }
    {
        btDiscreteDynamicsWorld& world = receiver.world;
        SpatialHashBroadphase& broadphase = receiver.broadphase;
        const std::vector<std::byte>& bytes = sentBytes;
        const std::vector<int>& numbers = sentNumbers;
        const auto objectOf = [&](int number) {
            return &receiver.bodies[static_cast<std::size_t>(number)];
        };
#include <rollback_5.inl>
        ASSERT_EQ(fault, "");
    }
    EXPECT_FALSE(receiver.bodies[4].isInWorld());
    for (int frame = 100; frame < 200; ++frame) {
        play(sender, frame);
        play(receiver, frame);
        ASSERT_EQ(receiver.bits(), sender.bits()) << "frame " << frame;
    }
}

// The page says how a vehicle goes back that the world does not know.
TEST(RollbackPage, VehicleOutsideOfTheWorldGoesBackWithItsWheels) {
    Arena arena;
    btBoxShape chassisShape({1, 0.3F, 2});
    btRigidBody& chassis = *arena.add(800, chassisShape, {0, 1, 12});
    chassis.setActivationState(DISABLE_DEACTIVATION);
    btDefaultVehicleRaycaster raycaster(&arena.world);
    btRaycastVehicle::btVehicleTuning tuning;
    btRaycastVehicle vehicle(tuning, &chassis, &raycaster);
    vehicle.setCoordinateSystem(0, 1, 2);
    for (const btScalar x : {-0.9F, 0.9F}) {
        for (const btScalar z : {-1.5F, 1.5F}) {
            vehicle.addWheel({x, 0, z}, {0, -1, 0}, {-1, 0, 0}, 0.5F, 0.4F, tuning, z > 0);
        }
    }
    const auto drive = [&](int frame) {
        vehicle.setSteeringValue(0.2F * std::sin(0.1F * static_cast<float>(frame)), 1);
        vehicle.applyEngineForce(900, 0);
        vehicle.updateVehicle(btScalar(1) / 60);
        arena.world.stepSimulation(btScalar(1) / 60, 0);
        std::vector<std::uint32_t> bits = arena.bits();
        for (int i = 0; i < vehicle.getNumWheels(); ++i) {
            bits.push_back(std::bit_cast<std::uint32_t>(vehicle.getWheelInfo(i).m_rotation));
        }
        return bits;
    };
    for (int frame = 0; frame < 90; ++frame) {
        drive(frame);
    }
    WorldSnapshot snapshot;
    ASSERT_EQ(snapshot.save(arena.world, arena.broadphase), "");
    const btAlignedObjectArray<btWheelInfo> wheels(vehicle.m_wheelInfo);
    std::vector<std::vector<std::uint32_t>> first;
    for (int frame = 90; frame < 150; ++frame) {
        first.push_back(drive(frame));
    }
    ASSERT_EQ(snapshot.restore(arena.world, arena.broadphase), "");
    vehicle.m_wheelInfo.copyFromArray(wheels);
    for (int frame = 90; frame < 150; ++frame) {
        ASSERT_EQ(drive(frame), first[static_cast<std::size_t>(frame - 90)]) << frame;
    }
    EXPECT_NE(chassis.getWorldTransform().getOrigin().z(), 12);
}

using RollbackPageGrid = AgentsBeforeACamera;

TEST_F(RollbackPageGrid, ZonesAreCopied) {
    Zones<float> zones;
    const ZoneId zone = zones.add({SphereRegion<float>({0, 0, -10}, 5)});
    zones.update(grid);
#include <rollback_6.inl>
    EXPECT_EQ(zones.occupants(zone).size(), 1U);
    EXPECT_TRUE(zones.update(grid).entered.empty());
}

TEST_F(RollbackPageGrid, GridGoesBack) {
    Pairs<float> pairs(grid);
    const auto filter = [](ProxyId, ProxyId) { return true; };
    const Aabb<float> elsewhere = cubeAt(0, 0, -30);
    const Aabb<float> box = cubeAt(0, 0, -51);
    pairs.update(filter);
#include <rollback_7.inl>
    EXPECT_FALSE(grid.contains(friendly));
    EXPECT_TRUE(grid.contains(enemy));
    EXPECT_EQ(pairs.count(), 0U);
    grid.move(self, elsewhere);
    grid.remove(enemy);
    EXPECT_EQ(grid.add(box), friendly) << "the same again";
}

}  // namespace
}  // namespace hashphase::test
