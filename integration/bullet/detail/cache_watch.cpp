// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/cache_watch.hpp>

#include <broadphase/core/caught.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

CacheWatch::~CacheWatch() {
    if (cache != nullptr && cache->watcher() == this) {
        cache->setWatcher(nullptr);
    }
}

void CacheWatch::begin(PairCache& watched) noexcept {
    if (watched.watcher() != nullptr) {
        watched.watcher()->forget();
    }
    forget();
    cache = &watched;
    watched.setWatcher(this);
}

void CacheWatch::note(const btBroadphasePair& pair) noexcept {
    isMoreTakenOut |= !hasRoomFor([&] {
        if (takenOut != nullptr && takenOut->size() == takenOut->capacity()) {
            prune();
        }
        if (takenOut == nullptr) {
            takenOut = std::make_unique<std::vector<BulletProxyPair>>();
        }
        if (takenOut->size() == takenOut->capacity()) {
            takenOut->reserve(2 * takenOut->size() + 8);
        }
        takenOut->emplace_back(*pair.m_pProxy0, *pair.m_pProxy1);
    });
}

void CacheWatch::pruneTakenOut() noexcept {
    std::erase_if(*takenOut, [this](const BulletProxyPair& pair) {
        return !pair.isUpToDate() || cache->findPair(pair.lower(), pair.upper()) != nullptr;
    });
    if (takenOut->empty()) {
        takenOut = nullptr;
    }
}

void CacheWatch::forget() noexcept {
    takenOut = nullptr;
    isMoreTakenOut = false;
}

void CacheWatch::endCache() noexcept {
    forget();
    cache = nullptr;
}

bool CacheWatch::mayRefuse() const noexcept {
    return owner.pairs_.mayIgnore();
}

bool CacheWatch::refuses(const btBroadphaseProxy& a, const btBroadphaseProxy& b) const noexcept {
    return owner.isIgnoredPair(&a, &b);
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
