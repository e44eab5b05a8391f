// SPDX-License-Identifier: Zlib
#include <tests/integration/bullet/queries.hpp>

#include <LinearMath/btAabbUtil2.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace hashphase::test {
namespace {

void print(std::ostringstream& text, const btVector3& v) {
    text << '(' << v.x() << ", " << v.y() << ", " << v.z() << ')';
}

std::ostringstream exactText() {
    std::ostringstream text;
    text.precision(std::numeric_limits<btScalar>::max_digits10);
    return text;
}

}  // namespace

CollectRay::CollectRay(const Ray& ray) {
    const btVector3 way = ray.to - ray.from;
    const bool isCast = ray.castMin != ray.castMax;
    // A ray of no length is normalised to NaN by Bullet, a cast of no length to zero.
    const btVector3 direction = isCast && way.fuzzyZero() ? btVector3(0, 0, 0) : way / way.length();
    for (int axis = 0; axis < 3; ++axis) {
        m_rayDirectionInverse[axis] =
            direction[axis] == 0 ? ray.inverseOfZero : btScalar(1) / direction[axis];
        m_signs[axis] = m_rayDirectionInverse[axis] < 0 ? 1 : 0;
    }
    m_lambda_max = direction.dot(way);
}

std::vector<int> bruteForceRay(const Truth& truth, int objectCount, const Ray& ray) {
    const CollectRay fields(ray);
    std::vector<int> found;
    for (int object = 0; object < objectCount; ++object) {
        const Box& box = truth.box(object);
        const btVector3 bounds[2] = {box.min - ray.castMax, box.max - ray.castMin};
        btScalar enter = 0;
        if (truth.isAlive(object) &&
            btRayAabb2(ray.from, fields.m_rayDirectionInverse, fields.m_signs, bounds, enter, 0,
                       fields.m_lambda_max)) {
            found.push_back(object);
        }
    }
    return found;
}

std::vector<int> bruteForceBox(const Truth& truth, int objectCount, const Box& box) {
    std::vector<int> found;
    for (int object = 0; object < objectCount; ++object) {
        if (truth.isAlive(object) &&
            TestAabbAgainstAabb2(box.min, box.max, truth.box(object).min, truth.box(object).max)) {
            found.push_back(object);
        }
    }
    return found;
}

std::vector<int> sorted(std::vector<int> objects) {
    std::sort(objects.begin(), objects.end());
    return objects;
}

std::string describe(const Ray& ray) {
    std::ostringstream text = exactText();
    text << "ray from ";
    print(text, ray.from);
    text << " to ";
    print(text, ray.to);
    text << " with the box ";
    print(text, ray.castMin);
    text << ' ';
    print(text, ray.castMax);
    return text.str();
}

std::string describe(const Box& box) {
    std::ostringstream text = exactText();
    text << "box ";
    print(text, box.min);
    text << ' ';
    print(text, box.max);
    return text.str();
}

}  // namespace hashphase::test
