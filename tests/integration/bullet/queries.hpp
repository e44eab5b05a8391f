// SPDX-License-Identifier: Zlib
#pragma once

// Ray and box queries by brute force, with the predicates that Bullet's broadphases use.

#include <tests/integration/bullet/player.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>

#include <string>
#include <vector>

namespace hashphase::test {

/// What a caller of rayTest says.
struct Ray {
    btVector3 from;
    btVector3 to;
    btVector3 castMin{0, 0, 0};
    btVector3 castMax{0, 0, 0};
    btScalar inverseOfZero = BT_LARGE_FLOAT;  ///< in the callback's m_rayDirectionInverse
};

/// Lists the objects it is shown, and answers as it is told.
struct CollectRay : btBroadphaseRayCallback {
    /// Sets the fields as btCollisionWorld does.
    explicit CollectRay(const Ray& ray);
    bool process(const btBroadphaseProxy* proxy) override {
        found.push_back(objectOf(proxy));
        return answer;
    }
    std::vector<int> found;
    bool answer = true;
};

struct CollectBox : btBroadphaseAabbCallback {
    bool process(const btBroadphaseProxy* proxy) override {
        found.push_back(objectOf(proxy));
        return answer;
    }
    std::vector<int> found;
    bool answer = true;
};

/// The objects whose box passes btRayAabb2() as btDbvtBroadphase calls it on a leaf.
std::vector<int> bruteForceRay(const Truth& truth, int objectCount, const Ray& ray);

/// The objects whose box overlaps `box`.
std::vector<int> bruteForceBox(const Truth& truth, int objectCount, const Box& box);

std::vector<int> sorted(std::vector<int> objects);

std::string describe(const Ray& ray);
std::string describe(const Box& box);

}  // namespace hashphase::test
