// SPDX-License-Identifier: Zlib
//
// As flag_traps.cpp: a class of the program's that is derived from one of the libraries'. With RTTI it wants
// libraries with RTTI.

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <cstdio>

namespace {

struct CountingBroadphase : hashphase::SpatialHashBroadphase {
    void setAabb(btBroadphaseProxy* proxy, const btVector3& low, const btVector3& high,
                 btDispatcher* dispatcher) override {
        ++count;
        SpatialHashBroadphase::setAabb(proxy, low, high, dispatcher);
    }
    int count = 0;
};

}  // namespace

int main() {
    CountingBroadphase own;
    btBroadphaseInterface& broadphase = own;
    btBroadphaseProxy* const proxy =
        broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, 1, 1, nullptr);
    broadphase.createProxy({3, 0, 0}, {4, 1, 1}, 0, nullptr, 1, 1, nullptr);
    broadphase.setAabb(proxy, {2, 0, 0}, {5, 1, 1}, nullptr);
    broadphase.calculateOverlappingPairs(nullptr);
    std::printf("%d set, %d pairs\n", own.count,
                broadphase.getOverlappingPairCache()->getNumOverlappingPairs());
    broadphase.destroyProxy(proxy, nullptr);
}
