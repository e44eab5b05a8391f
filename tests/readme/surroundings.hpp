// SPDX-License-Identifier: Zlib
#pragma once

// What the pieces of C++ in the pages take for granted: an agent, an enemy and a wall before a camera,
// and a Bullet world. All headers that pieces include are included here, before they are taken into the
// body of a test.

#include <broadphase/collectors.hpp>
#include <broadphase/convex_region.hpp>
#include <broadphase/grid_snapshot.hpp>
#include <broadphase/neighbours.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/radius_search.hpp>
#include <broadphase/regions.hpp>
#include <broadphase/sweeps.hpp>
#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <integration/bullet/bullet_parallel_for.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/debug_draw.hpp>
#include <integration/bullet/group_filter.hpp>
#include <integration/bullet/origin_shift.hpp>
#include <integration/bullet/shape_pick.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/bullet/static_triangles.hpp>
#include <integration/bullet/world_snapshot.hpp>
#include <integration/bullet/worlds_broadphase.hpp>
#include <integration/camera/camera.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/camera/ground_footprint.hpp>
#include <integration/culling/culler.hpp>
#include <integration/effects/bullet_frame.hpp>
#include <integration/effects/observers.hpp>
#include <integration/effects/simulation.hpp>
#include <integration/picking/drag_selection.hpp>
#include <integration/picking/pick.hpp>
#include <integration/terrain/changed_ground.hpp>
#include <integration/terrain/terrain.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace hashphase::test {

using Point = Vector3<float>;

[[nodiscard]] inline Aabb<float> cubeAt(float x, float y, float z) {
    const Point center(x, y, z);
    const Point half(1, 1, 1);
    return {center - half, center + half};
}

/// An orthographic camera at the origin that looks along -z and sees 40 x 40 m, from 0 to 100 m.
[[nodiscard]] inline Eigen::Matrix4f orthographic() {
    Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
    matrix(0, 0) = matrix(1, 1) = 1.0F / 20;
    matrix(2, 2) = -1.0F / 100;
    return matrix;
}

/// An agent that looks along -z, an enemy 20 m ahead, and a wall behind that.
class AgentsBeforeACamera : public testing::Test {
protected:
    Grid<float> grid;
    ProxyId self = grid.add(cubeAt(0, 0, -10));
    ProxyId enemy = grid.add(cubeAt(0, 0, -30));
    ProxyId wall = grid.add(cubeAt(0, 0, -50), Mobility::resting);
    Eigen::Matrix4f viewProjection = orthographic();
    Point eye{0, 0, -10};
    Point ahead{0, 0, -1};

    [[nodiscard]] auto isEnemy() const {
        return [this](ProxyId id) { return id == enemy; };
    }
};

/// A sphere of radius 1 that falls from the origin; for worlds of any broadphase.
struct FallingSphere {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btSequentialImpulseConstraintSolver solver;
    btSphereShape shape{1};
    btRigidBody body{btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &shape)};
    btScalar timeStep = btScalar(1) / 60;
};

}  // namespace hashphase::test
