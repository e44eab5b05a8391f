// SPDX-License-Identifier: Zlib
//
// What two boxes that touch are to a broadphase, and to a client of its grid.

#include <btBulletDynamicsCommon.h>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/picking/pick.hpp>

#include <cstdio>

int main() {
    hashphase::SpatialHashBroadphase broadphase;
    const btVector3 origin(0, 0, 0), one(1, 1, 1), two(2, 2, 2);
    btBroadphaseProxy* first = broadphase.createProxy(origin, one, 0, nullptr, 1, -1, nullptr);
    btBroadphaseProxy* second = broadphase.createProxy(one, two, 0, nullptr, 1, -1, nullptr);
    broadphase.calculateOverlappingPairs(nullptr);
    const int pairs = broadphase.getOverlappingPairCache()->getNumOverlappingPairs();

    using Point = hashphase::Vector3<btScalar>;
    const auto picked = hashphase::pickNearest(
        broadphase.grid(), hashphase::RayRegion<btScalar>(Point(-1, btScalar(0.5), btScalar(0.5)),
                                                          Point(3, btScalar(0.5), btScalar(0.5))));
    const bool isFirst = broadphase.proxyOf(picked.id) == first;
    std::printf("pairs: %d, picked the first: %d\n", pairs, isFirst);
    broadphase.destroyProxy(first, nullptr);
    broadphase.destroyProxy(second, nullptr);
    return pairs == 1 && isFirst ? 0 : 1;
}
