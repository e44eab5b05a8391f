// SPDX-License-Identifier: Zlib
#pragma once

// Ray and box queries, and the predicates by which Bullet's broadphases answer them.

#include <tests/integration/bullet/broadphases.hpp>
#include <tests/support/oracles.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <LinearMath/btAabbUtil2.h>

#include <algorithm>
#include <limits>
#include <span>
#include <sstream>
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
template <class Callback>
struct CollectObjects : Callback {
    bool process(const btBroadphaseProxy* proxy) override {
        found.push_back(objectOf(proxy));
        return answer;
    }
    [[nodiscard]] std::vector<int> sorted() const {
        std::vector<int> objects = found;
        std::sort(objects.begin(), objects.end());
        return objects;
    }

    std::vector<int> found;
    bool answer = true;
};

using CollectBox = CollectObjects<btBroadphaseAabbCallback>;

/// Sets the fields as btCollisionWorld does.
inline void setFields(btBroadphaseRayCallback& callback, const Ray& ray) {
    const btVector3 way = ray.to - ray.from;
    const bool isCast = ray.castMin != ray.castMax;
    // A ray of no length is normalised to NaN by Bullet, a cast of no length to zero.
    const btVector3 direction = isCast && way.fuzzyZero() ? btVector3(0, 0, 0) : way / way.length();
    for (int axis = 0; axis < 3; ++axis) {
        callback.m_rayDirectionInverse[axis] =
            direction[axis] == 0 ? ray.inverseOfZero : btScalar(1) / direction[axis];
        callback.m_signs[axis] = callback.m_rayDirectionInverse[axis] < 0 ? 1 : 0;
    }
    callback.m_lambda_max = direction.dot(way);
}

struct CollectRay : CollectObjects<btBroadphaseRayCallback> {
    explicit CollectRay(const Ray& ray) { setFields(*this, ray); }
};

/// Whether the box passes btRayAabb2() as btDbvtBroadphase calls it on a leaf.
[[nodiscard]] inline bool doesMeet(const Ray& ray, const Box& box) {
    const CollectRay fields(ray);
    const btVector3 bounds[2] = {box.min - ray.castMax, box.max - ray.castMin};
    btScalar enter = 0;
    return btRayAabb2(ray.from, fields.m_rayDirectionInverse, fields.m_signs, bounds, enter, 0,
                      fields.m_lambda_max);
}
[[nodiscard]] inline bool doesMeet(const Box& asked, const Box& box) {
    return TestAabbAgainstAabb2(asked.min, asked.max, box.min, box.max);
}

/// The numbers, sorted, of the boxes that are met. Bullet's predicates take NaN for a hit, but no query
/// finds it.
template <class Question, class NumberOf>
[[nodiscard]] std::vector<int> metByBruteForce(std::span<const Placed<btScalar>> proxies,
                                               const Question& question, const NumberOf& numberOf) {
    std::vector<int> found;
    for (const Placed<btScalar>& proxy : proxies) {
        if (!hasNan(proxy.box) && doesMeet(question, boxOf(proxy.box))) {
            found.push_back(numberOf(proxy.id));
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

[[nodiscard]] inline std::string describe(const Ray& ray) {
    std::ostringstream text;
    text.precision(std::numeric_limits<btScalar>::max_digits10);
    text << "ray from " << toEigen(ray.from).transpose() << " to " << toEigen(ray.to).transpose()
         << " with the box " << toEigen(ray.castMin).transpose() << ".."
         << toEigen(ray.castMax).transpose();
    return text.str();
}
[[nodiscard]] inline std::string describe(const Box& box) {
    return describe(Ray{box.min, box.max});
}

}  // namespace hashphase::test
