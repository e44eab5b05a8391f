// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/living_broadphase.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <array>
#include <cstddef>
#include <mutex>
#include <new>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

constinit LivingBroadphase* newestLiving = nullptr;

// Never destroyed: the last broadphase may be a static object that goes after all of ours.
std::mutex& livingMutex() noexcept {
    alignas(std::mutex) static std::array<std::byte, sizeof(std::mutex)> memory;
    static std::mutex& mutex = *new (memory.data()) std::mutex;
    return mutex;
}

}  // namespace

LivingBroadphase::LivingBroadphase() noexcept {
    const std::lock_guard lock(livingMutex());
    next_ = newestLiving;
    newestLiving = this;
}

LivingBroadphase::~LivingBroadphase() {
    unlist();
}

void LivingBroadphase::unlist() noexcept {
    const std::lock_guard lock(livingMutex());
    LivingBroadphase** link = &newestLiving;
    while (*link != nullptr && *link != this) {
        link = &(*link)->next_;
    }
    if (*link == this) {
        *link = next_;
    }
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
