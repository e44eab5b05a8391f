// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/living_broadphase.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <algorithm>
#include <mutex>
#include <vector>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

struct Living {
    std::mutex mutex;
    std::vector<SpatialHashBroadphase*> broadphases;
};

// Made with the first broadphase, and so there until the last one has gone.
Living& living() {
    static Living all;
    return all;
}

}  // namespace

LivingBroadphase::LivingBroadphase(SpatialHashBroadphase& broadphase) : broadphase_(&broadphase) {
    const std::lock_guard lock(living().mutex);
    living().broadphases.push_back(broadphase_);
}

LivingBroadphase::~LivingBroadphase() {
    const std::lock_guard lock(living().mutex);
    std::erase(living().broadphases, broadphase_);
}

SpatialHashBroadphase* LivingBroadphase::find(const btBroadphaseInterface* broadphase) noexcept {
    const std::lock_guard lock(living().mutex);
    const auto& all = living().broadphases;
    const auto found = std::find(all.begin(), all.end(), broadphase);
    return found != all.end() ? *found : nullptr;
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
