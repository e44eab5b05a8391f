// SPDX-License-Identifier: Zlib
//
// A proxy that is destroyed twice: libraries with assertions say what is wrong, others do nothing the second time.
// Prints the number of pairs that were there before, which is one.

#include <broadphase/diagnostics.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <cstdio>
#include <cstring>

using namespace hashphase;

namespace {

int sentences = 0;

void takeSentence(const char*, const char* sentence, const char*, int) {
    constexpr const char* kExpected =
        "A proxy is null, destroyed or of another broadphase. Pass a live proxy of this one.";
    sentences += std::strcmp(sentence, kExpected) == 0 ? 1 : 1000;
}

}  // namespace

int main() {
    setAssertHandler(&takeSentence);
    SpatialHashBroadphase broadphase;
    const btVector3 origin(0, 0, 0), one(1, 1, 1);
    btBroadphaseProxy* proxy = broadphase.createProxy(origin, one, 0, nullptr, 1, -1, nullptr);
    static_cast<void>(broadphase.createProxy(origin, one, 0, nullptr, 1, -1, nullptr));
    broadphase.calculateOverlappingPairs(nullptr);
    const int pairs = broadphase.getOverlappingPairCache()->getNumOverlappingPairs();
    broadphase.destroyProxy(proxy, nullptr);
    if (sentences != 0) {
        std::printf("sentences of the first call: %d\n", sentences);
        return 1;
    }
    broadphase.destroyProxy(proxy, nullptr);
    if (sentences != HASHPHASE_ENABLE_ASSERTS) {
        std::printf("sentences of the second call: %d\n", sentences);
        return 1;
    }
    std::printf("pairs: %d\n", pairs);
}
