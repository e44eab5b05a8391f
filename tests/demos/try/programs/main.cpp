// SPDX-License-Identifier: Zlib

//     stock-programs NAME     runs that program
//     stock-programs          lists all but the last three kinds

#include "program.hpp"

#include <cmath>
#include <cstdio>

namespace programs {

void say(const char* name, double value) {
    // Not -0.0, which depends on the order of contacts.
    std::printf("%s = %.2f\n", name, std::round(value * 100) / 100 + 0.0);
}

btRigidBody* Things::body(btCollisionShape* shape, btScalar mass, const btVector3& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) {
        shape->calculateLocalInertia(mass, inertia);
    }
    states_.push_back(
        std::make_unique<btDefaultMotionState>(btTransform(btQuaternion::getIdentity(), place)));
    bodies.push_back(std::make_unique<btRigidBody>(mass, states_.back().get(), shape, inertia));
    return bodies.back().get();
}

void addPile(Scene<>& scene) {
    scene.addGround();
    auto* box = scene.things.shape<btBoxShape>(btVector3(0.5, 0.5, 0.5));
    for (int i = 0; i < 20; ++i) {
        scene.add(box, 1, {btScalar(i % 5 * 2), btScalar(1 + i / 5), 0});
    }
}

int countNear(const Things& things, const btVector3& place, btScalar distance) {
    int count = 0;
    for (const auto& body : things.bodies) {
        count += body->getWorldTransform().getOrigin().distance(place) < distance ? 1 : 0;
    }
    return count;
}

int run(const std::string& name) {
    for (const auto* list :
         {&rigidBodyPrograms(), &broadphasePrograms(), &queryPrograms(), &softBodyPrograms(),
          &lifetimePrograms(), &measuredPrograms(), &processPrograms(), &misfitPrograms()}) {
        for (const Program& program : *list) {
            if (program.name == name) {
                return program.run();
            }
        }
    }
    return 2;
}

}  // namespace programs

int main(int argc, char** argv) {
    using namespace programs;
    if (argc == 2) {
        return run(argv[1]);
    }
    for (const auto* list : {&rigidBodyPrograms(), &broadphasePrograms(), &queryPrograms(),
                             &softBodyPrograms(), &lifetimePrograms()}) {
        for (const Program& program : *list) {
            std::puts(program.name.c_str());
        }
    }
    return 0;
}
