// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/living_broadphase.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <mutex>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

constinit std::mutex mutex;
constinit LivingBroadphase* first = nullptr;

}  // namespace

LivingBroadphase::LivingBroadphase() noexcept {
    const std::lock_guard lock(mutex);
    next_ = first;
    first = this;
}

LivingBroadphase::~LivingBroadphase() {
    const std::lock_guard lock(mutex);
    LivingBroadphase** link = &first;
    while (*link != this) {
        link = &(*link)->next_;
    }
    *link = next_;
}

SpatialHashBroadphase* LivingBroadphase::find(const btBroadphaseInterface* broadphase) noexcept {
    const std::lock_guard lock(mutex);
    for (LivingBroadphase* living = first; living != nullptr; living = living->next_) {
        auto* const found = static_cast<SpatialHashBroadphase*>(living);
        if (found == broadphase) {
            return found;
        }
    }
    return nullptr;
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
