// SPDX-License-Identifier: Zlib
//
// What a user of Bullet writes at the least. Prints the number of overlapping pairs, which is one.

#include <btBulletDynamicsCommon.h>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <cstdio>

int main() {
    hashphase::SpatialHashBroadphase broadphase;
    const btVector3 origin(0, 0, 0), one(1, 1, 1), two(2, 2, 2);
    btBroadphaseProxy* first = broadphase.createProxy(origin, one, 0, nullptr, 1, -1, nullptr);
    btBroadphaseProxy* second = broadphase.createProxy(one, two, 0, nullptr, 1, -1, nullptr);
    broadphase.calculateOverlappingPairs(nullptr);
    std::printf("pairs: %d\n", broadphase.getOverlappingPairCache()->getNumOverlappingPairs());
    broadphase.destroyProxy(first, nullptr);
    broadphase.destroyProxy(second, nullptr);
}
