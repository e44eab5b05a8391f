// SPDX-License-Identifier: Zlib

// What the broadphase holds, and gives back; and whether all is as it should be.

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <integration/bullet/pair_cache.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

void SpatialHashBroadphase::releaseUnusedMemory() noexcept {
    checkMayChange();
    const bool isWithin = isCalculating() || detail::QueryScope::isWithin(pairCache_);
    HASHPHASE_ASSERT(!isWithin,
                     "releaseUnusedMemory() was called from a callback of the broadphase or of its "
                     "pair cache. Call it after that returns.");
    if (isWithin) {
        return;
    }
    grid_.releaseUnusedMemory();
    pairs_.releaseUnusedMemory();
    if (sweeps_ != nullptr) {
        sweeps_->releaseUnusedMemory();
    }
    detail::freeArrays(died_, born_);
    dropLastProxies();
    if (watch_.cache != nullptr && !isWorld()) {
        watch_.cache->releaseUnusedMemory();
    }
}

// Those whose indices the grid has given back. A cache that is behind, or from which somebody has taken
// pairs, may still name some.
void SpatialHashBroadphase::dropLastProxies() noexcept {
    watch_.prune();
    const bool mayBeNamed = isCacheBehind_ || watch_.isAnythingTakenOut();
    if (!mayBeNamed && grid_.indexLimit() < uniqueIds_.size()) {
        uniqueIds_.resize(grid_.indexLimit());
        uniqueIds_.shrink_to_fit();
        proxies_.shrink(uniqueIds_.size());
    }
}

// The grid and its pairs look after themselves, and a WorldsBroadphase after the cache of its worlds.
void SpatialHashBroadphase::releaseAfterPeak() noexcept {
    dropLastProxies();
    if (isWorld()) {
        return;
    }
    const std::size_t room = watch_.cache != nullptr ? watch_.cache->capacity() : died_.capacity();
    if (peaks_.isPast(pairs_.count(), room)) {
        detail::freeArrays(died_, born_);
        if (watch_.cache != nullptr) {
            watch_.cache->releaseUnusedMemory();
        }
    }
}

void SpatialHashBroadphase::resetPool(btDispatcher* /*dispatcher*/) {
    if (grid_.size() > 0) {
        return;
    }
    const bool isWithin = isCalculating() || detail::QueryScope::isWithin(&grid_);
    HASHPHASE_ASSERT(
        !isWithin,
        "resetPool() was called from a callback or a query. Call it after the step or the query.");
    if (!isWithin) {
        pairs_.clear();
        lastUniqueId_ = 0;
        watch_.forget();
        groupKinds_ = {};
        changedKinds_ = 0;
        seen_ = std::vector<std::uint64_t>();
        seenCount_ = 0;
        mustNoteGroups_ = false;
        mayGrow_ = sweeps_ != nullptr;
        isCacheBehind_ = isCacheBehind_ && pairCache_->getNumOverlappingPairs() > 0;
    }
}

std::size_t SpatialHashBroadphase::memoryBytes() const noexcept {
    return sizeof(*this) - sizeof(grid_) - sizeof(pairs_) + grid_.memoryBytes() +
           pairs_.memoryBytes() + proxies_.memoryBytes() +
           (sweeps_ != nullptr ? sweeps_->memoryBytes() : 0) + uniqueIds_.capacity() * sizeof(int) +
           (died_.capacity() + born_.capacity()) * sizeof(BulletProxyPair) +
           seen_.capacity() * sizeof(seen_[0]) +
           (ghosts_ != nullptr ? sizeof(*ghosts_) + ghosts_->memoryBytes() : 0) +
           watch_.memoryBytes() + (ownCache_ != nullptr ? ownCache_->memoryBytes() : 0);
}

std::string SpatialHashBroadphase::validate() const {
    const std::string ofSweeps = sweeps_ != nullptr ? sweeps_->validate() : std::string();
    for (const std::string& error : {grid_.validate(), ofSweeps, pairs_.validate()}) {
        if (!error.empty()) {
            return error;
        }
    }
    if (ownCache_ == nullptr) {
        return {};
    }
    if (static_cast<std::size_t>(ownCache_->getNumOverlappingPairs()) != pairs_.count() &&
        !watch_.isAnythingTakenOut()) {
        return "The cache holds as many pairs as the set of pairs: broken.";
    }
    return ownCache_->validate();
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
