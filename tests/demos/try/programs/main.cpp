// SPDX-License-Identifier: Zlib

//     stock-programs NAME     runs that program
//     stock-programs          lists those whose outcome is compared

#include "program.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>

namespace programs {

int exitStatus = 0;

std::vector<Program>& allPrograms() {
    static std::vector<Program> programs;
    return programs;
}

void say(const char* name, double value) {
    // Not -0.0, which depends on the order of contacts.
    std::printf("%s = %.2f\n", name, std::round(value * 100) / 100 + 0.0);
}

void addPile(Scene<>& scene, int height) {
    scene.addGround();
    auto* box = scene.things.unitBox();
    for (int i = 0; i < 20; ++i) {
        scene.add(box, 1, {btScalar(i % 5 * 2), btScalar(height + i / 5), 0});
    }
}

bool isHit(const btCollisionWorld& world, const btVector3& from, const btVector3& to) {
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    world.rayTest(from, to, hit);
    return hit.hasHit();
}

int countHits(const btCollisionWorld& world, const btVector3& from, const btVector3& to) {
    btCollisionWorld::AllHitsRayResultCallback hits(from, to);
    world.rayTest(from, to, hits);
    return hits.m_collisionObjects.size();
}

}  // namespace programs

using namespace programs;

// For a host that links no Bullet and loads the programs as it runs, too.
extern "C" int runProgram(const char* name);

int runProgram(const char* name) {
    for (const Program& program : allPrograms()) {
        if (std::strcmp(program.name, name) == 0) {
            program.run();
            return exitStatus;
        }
    }
    return 2;
}

int main(int argc, char** argv) {
    if (argc == 2) {
        return runProgram(argv[1]);
    }
    for (const Program& program : allPrograms()) {
        if (program.isCompared) {
            std::puts(program.name);
        }
    }
    return 0;
}
