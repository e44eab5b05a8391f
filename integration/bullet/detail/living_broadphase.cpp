// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/living_broadphase.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <mutex>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

constinit LivingBroadphase* newestLiving = nullptr;

// Made with the first broadphase, and so there until the last one has gone.
std::mutex& livingMutex() noexcept {
    static std::mutex mutex;
    return mutex;
}

}  // namespace

LivingBroadphase::LivingBroadphase() noexcept {
    const std::lock_guard lock(livingMutex());
    next_ = newestLiving;
    newestLiving = this;
}

LivingBroadphase::~LivingBroadphase() {
    const std::lock_guard lock(livingMutex());
    LivingBroadphase** link = &newestLiving;
    while (*link != this) {
        link = &(*link)->next_;
    }
    *link = next_;
}

SpatialHashBroadphase* LivingBroadphase::find(const btBroadphaseInterface* broadphase) noexcept {
    const std::lock_guard lock(livingMutex());
    for (LivingBroadphase* living = newestLiving; living != nullptr; living = living->next_) {
        auto* const found = static_cast<SpatialHashBroadphase*>(living);
        if (found == broadphase) {
            return found;
        }
    }
    return nullptr;
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
