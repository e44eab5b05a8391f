// SPDX-License-Identifier: Zlib

// Writes a world as an editor saves it, by Bullet's own serializer: write-level KIND FILE. It knows
// nothing of hashphase, and is built in each precision of Bullet.

#include "try/programs/program.hpp"

#include <BulletCollision/CollisionDispatch/btInternalEdgeUtility.h>
#include <BulletCollision/CollisionShapes/btTriangleInfoMap.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <cstdio>
#include <cstring>
#include <memory>

namespace {

// A floor, two crates and a hinge between them, of which each has a name, and so have the shapes.
template <class World = btDiscreteDynamicsWorld,
          class Configuration = btDefaultCollisionConfiguration,
          class Solver = btSequentialImpulseConstraintSolver>
struct Level : programs::Scene<btDbvtBroadphase, World, Configuration, Solver> {
    btBoxShape* floorShape = this->things.box(50, 1, 50);
    btBoxShape* crateShape = this->things.box(1, 1, 1);
    btRigidBody* floor = this->add(floorShape, 0, {0, -1, 0});
    btRigidBody* first = this->add(crateShape, 1, {0, 1, 0});
    btRigidBody* second = this->add(crateShape, 1, {0, 4, 0});
    btHingeConstraint hinge{*first, *second, {0, 1.5, 0}, {0, -1.5, 0}, {1, 0, 0}, {1, 0, 0}};
    btDefaultSerializer serializer;

    Level() {
        this->world.addConstraint(&hinge);
        static const char* const kCrate = "crate";  // of two bodies: it is written once
        serializer.registerNameForPointer(floor, "the floor of the hall");
        serializer.registerNameForPointer(first, kCrate);
        serializer.registerNameForPointer(second, kCrate);
        serializer.registerNameForPointer(floorShape, "f");
        serializer.registerNameForPointer(crateShape, "Kiste (gro\xc3\x9f)");
        serializer.registerNameForPointer(&hinge, "door hinge");
    }
    ~Level() { this->world.removeConstraint(&hinge); }

    bool save(const char* path) {
        this->world.serialize(&serializer);
        std::FILE* const file = std::fopen(path, "wb");
        const auto size = static_cast<std::size_t>(serializer.getCurrentBufferSize());
        const bool isWritten =
            file != nullptr && std::fwrite(serializer.getBufferPointer(), 1, size, file) == size;
        return file != nullptr && std::fclose(file) == 0 && isWritten;
    }
};

bool writeNames(const char* path) {
    return Level<>().save(path);
}

// A ground of triangles, whose edges Bullet keeps as arrays of plain numbers.
bool writeMesh(const char* path) {
    btTriangleMesh mesh;
    for (int i = 0; i < 20; ++i) {
        const btScalar x(i);
        mesh.addTriangle({x, 0, 0}, {x + 1, 0, 0}, {x, 0, 1});
        mesh.addTriangle({x + 1, 0, 0}, {x + 1, 0, 1}, {x, 0, 1});
    }
    btBvhTriangleMeshShape shape(&mesh, true);
    btTriangleInfoMap edges;
    btGenerateInternalEdgeInfo(&shape, &edges);
    Level<> level;
    level.serializer.registerNameForPointer(level.add(&shape, 0, {0, 0, 0}), "ground");
    return level.save(path);
}

bool writeMultiBody(const char* path) {
    constexpr int kLinks = 3;
    btMultiBody arm(kLinks, 0, btVector3(0, 0, 0), true, false);
    arm.setBaseName("base");
    for (int i = 0; i < kLinks; ++i) {
        arm.setupRevolute(i, 1, btVector3(1, 1, 1), i - 1, btQuaternion(0, 0, 0, 1),
                          btVector3(1, 0, 0), btVector3(0, 1, 0), btVector3(0, 1, 0));
        arm.getLink(i).m_linkName = "link";
        arm.getLink(i).m_jointName = "joint";
    }
    arm.finalizeMultiDof();
    btBoxShape shape(btVector3(1, 1, 1));
    btMultiBodyLinkCollider collider(&arm, 0);
    collider.setCollisionShape(&shape);
    arm.getLink(0).m_collider = &collider;
    Level<btMultiBodyDynamicsWorld, btDefaultCollisionConfiguration, btMultiBodyConstraintSolver>
        level;
    level.world.addMultiBody(&arm);
    level.world.addCollisionObject(&collider);
    for (const char* name :
         {arm.getBaseName(), arm.getLink(0).m_linkName, arm.getLink(0).m_jointName}) {
        level.serializer.registerNameForPointer(name, name);
    }
    const bool isSaved = level.save(path);
    level.world.removeMultiBody(&arm);
    return isSaved;
}

bool writeSoftBody(const char* path) {
    Level<btSoftRigidDynamicsWorld, btSoftBodyRigidBodyCollisionConfiguration> level;
    const std::unique_ptr<btSoftBody> sheet(btSoftBodyHelpers::CreatePatch(
        level.world.getWorldInfo(), {-4, 6, -4}, {4, 6, -4}, {-4, 6, 4}, {4, 6, 4}, 5, 5, 0, true));
    sheet->setPose(true, true);
    level.world.addSoftBody(sheet.get());
    const bool isSaved = level.save(path);
    level.world.removeSoftBody(sheet.get());
    return isSaved;
}

}  // namespace

int main(int argc, char** argv) {
    const struct {
        const char* name;
        bool (*write)(const char* path);
    } kinds[] = {{"names", writeNames},
                 {"mesh", writeMesh},
                 {"multibody", writeMultiBody},
                 {"softbody", writeSoftBody}};
    for (const auto& kind : kinds) {
        if (argc == 3 && std::strcmp(argv[1], kind.name) == 0) {
            return kind.write(argv[2]) ? 0 : 1;
        }
    }
    return 2;
}
