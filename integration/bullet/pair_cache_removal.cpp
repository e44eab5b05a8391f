// SPDX-License-Identifier: Zlib
//
// Pairs leave the cache, ghosts are told, and algorithms are freed.

#include <integration/bullet/pair_cache.hpp>

#include <broadphase/core/caught.hpp>
#include <broadphase/core/ensure_capacity.hpp>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Pairs that have left the cache, while their algorithms are freed. A callback may remove a proxy, whose object may
/// be gone when the callback returns: the algorithms of its pairs are freed before, by freeLeavingOf().
class PairCache::Leaving {
public:
    Leaving(PairCache& cache, std::span<Retired> pairs) noexcept
        : cache_(cache), pairs_(pairs), outer_(std::exchange(cache.leaving_, this)) {}
    // When freeing one has thrown, frees the others.
    ~Leaving() {
        while (detail::exceptionOf([this] { free(); }) != nullptr) {
        }
        cache_.leaving_ = outer_;
    }
    Leaving(const Leaving&) = delete;
    Leaving& operator=(const Leaving&) = delete;

    void free() {
        for (Retired& each : pairs_) {
            cache_.cleanOverlappingPair(each.pair, each.dispatcher);
        }
        pairs_ = {};
    }
    void freeOf(const btBroadphaseProxy& proxy) {
        for (Retired& each : pairs_) {
            if (each.pair.m_pProxy0 == &proxy || each.pair.m_pProxy1 == &proxy) {
                cache_.cleanOverlappingPair(each.pair, each.dispatcher);
            }
        }
    }
    [[nodiscard]] Leaving* outer() const noexcept { return outer_; }

private:
    PairCache& cache_;
    std::span<Retired> pairs_;
    Leaving* outer_;
};

// Callbacks come when everything is in order again, and get a copy, so that they may change the
// cache. Ghosts are told first: what is told of the end of contacts may destroy a proxy of the pair.
void* PairCache::remove(std::uint64_t ids, btDispatcher* dispatcher, Freeing freeing,
                        Remover remover) {
    checkMayChange();
    if (freeing == Freeing::inTurn) {
        detail::ensureCapacity(retired_, retired_.size() + 1);
    }
    const std::uint32_t index = ids_.vacate(ids);
    if (index == kNone) {
        return nullptr;
    }
    const btBroadphasePair removed = pairs_[static_cast<int>(index)];
    unchainPair(index, ids);
    fill(index);
    if (remover == Remover::other) {
        noteTakenOut(removed);
    }
    Retired retired{{0, ids, kNone}, removed, dispatcher};
    Leaving leaving(*this, {&retired, freeing == Freeing::now ? std::size_t{1} : 0});
    if (freeing == Freeing::inTurn) {
        retire(removed, ids, dispatcher);
    }
    if (ghosts_ != nullptr) {
        const detail::QueryScope scope(this, detail::QueryScope::Changes::allowed);
        ghosts_->removeOverlappingPair(removed.m_pProxy0, removed.m_pProxy1, dispatcher);
    }
    leaving.free();
    return removed.m_internalInfo1;
}

void PairCache::cleanOverlappingPair(btBroadphasePair& pair, btDispatcher* dispatcher) {
    if (pair.m_algorithm == nullptr || dispatcher == nullptr) {
        return;
    }
    const detail::QueryScope scope(this, detail::QueryScope::Changes::allowed);
    btCollisionAlgorithm* algorithm = std::exchange(pair.m_algorithm, nullptr);
    algorithm->~btCollisionAlgorithm();
    dispatcher->freeCollisionAlgorithm(algorithm);
}

// The order in which algorithms are freed decides how the dispatcher's manifolds are numbered, and
// through the order of contacts in the solver every bit of what follows.
void PairCache::freeRetired() {
    std::sort(retired_.begin(), retired_.end(),
              [](const Retired& a, const Retired& b) { return a.note < b.note; });
    freeRetiredAsListed();
}

void PairCache::freeRetiredAsListed() {
    if (retired_.empty()) {
        return;
    }
    std::vector<Retired> retired = std::move(retired_);
    retired_.clear();
    Leaving(*this, retired).free();
    // What freeing an algorithm has removed in its turn waits for the next time.
    if (retired_.empty()) {
        retired.clear();
        retired_ = std::move(retired);
    }
}

void PairCache::freeLeavingOf(const btBroadphaseProxy& proxy) {
    for (Leaving* each = leaving_; each != nullptr; each = each->outer()) {
        each->freeOf(proxy);
    }
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
