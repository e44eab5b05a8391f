// SPDX-License-Identifier: Zlib
//
// Netcode with rollback: three peers play the same game, a wall of bricks that is shot at. Two of them hear
// of each shot six frames late. You should see that the one that shoots when it hears of it soon has another
// wall; and that the one that goes back and plays these frames again has the first peer's, to the last bit.

#include <integration/bullet/world_snapshot.hpp>

#include <btBulletDynamicsCommon.h>

#include <array>
#include <cstdio>
#include <deque>
#include <string>

namespace {

constexpr int kFrames = 240;  // of 1/60 s
constexpr int kDelay = 6;     // until a shot is known elsewhere [frames]
constexpr int kBack = 8;      // to go back at most [frames]

struct Peer {
    Peer() {
        world.addRigidBody(&bodies.emplace_back(0, nullptr, &plane));
        for (int i = 0; i < 80; ++i) {
            const btVector3 place(0, 0.25F + 0.5F * btScalar(i / 8), 1.01F * btScalar(i % 8));
            bodies.emplace_back(1, nullptr, &brick, btVector3(0.1F, 0.1F, 0.1F));
            bodies.back().setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
            world.addRigidBody(&bodies.back());
        }
    }

    static bool isShot(int frame) { return frame % 40 == 5; }
    void play(int frame, bool isHit) {
        tell(ring[frame % kBack].save(world, broadphase));
        if (isHit) {
            bodies[13 + 8 * (frame / 40)].activate();
            bodies[13 + 8 * (frame / 40)].applyCentralImpulse({10, 0, 0});
        }
        world.stepSimulation(1.0F / 60, 0);
    }
    void goBackTo(int frame) { tell(ring[frame % kBack].restore(world, broadphase)); }
    static void tell(const std::string& fault) { std::fputs(fault.c_str(), stdout); }

    btStaticPlaneShape plane{{0, 1, 0}, 0};
    btBoxShape brick{{0.2F, 0.25F, 0.5F}};
    std::deque<btRigidBody> bodies;  // declared before the world: they outlive it
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    hashphase::SpatialHashBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    std::array<hashphase::WorldSnapshot, kBack> ring;  // of the last frames
};

}  // namespace

int main() {
    Peer first, late, rolled;
    int again = 0, elsewhere[2] = {};
    for (int frame = 0; frame < kFrames; ++frame) {
        const int heard = frame - kDelay;
        first.play(frame, Peer::isShot(frame));
        late.play(frame, Peer::isShot(heard));
        if (Peer::isShot(heard)) {
            rolled.goBackTo(heard);
            for (int past = heard; past < frame; ++past, ++again) {
                rolled.play(past, Peer::isShot(past));
            }
        }
        rolled.play(frame, false);
    }
    for (std::size_t i = 0; i < first.bodies.size(); ++i) {
        const btTransform& place = first.bodies[i].getWorldTransform();
        elsewhere[0] += late.bodies[i].getWorldTransform() == place ? 0 : 1;
        elsewhere[1] += rolled.bodies[i].getWorldTransform() == place ? 0 : 1;
    }
    std::printf("shot late: %d of 80 bricks elsewhere\n", elsewhere[0]);
    std::printf("%d frames played again: %d bricks elsewhere\n", again, elsewhere[1]);
}
