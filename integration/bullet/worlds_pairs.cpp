// SPDX-License-Identifier: Zlib

// How the pairs of many worlds come into their one cache, and what they hold.

#include <integration/bullet/worlds_broadphase.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/on_failure.hpp>

#include <LinearMath/btQuickprof.h>

#include <algorithm>
#include <utility>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

void WorldsBroadphase::calculateOverlappingPairs(btDispatcher* dispatcher) {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(&lastUniqueId_),
                     "calculateOverlappingPairs() was called from one of its own callbacks. Call "
                     "it, or step the world, after it returns.");
    const detail::QueryScope scope(&lastUniqueId_, detail::QueryScope::Changes::allowed);
    listUpdated(dispatcher);
    if (areAnyBehind()) {  // all of the cache is read: what this frees first is freed before pairs are listed
        static_cast<void>(pairCache_->getOverlappingPairArray());
    }
    updateWorlds();
    BT_PROFILE("hashphase: pair cache");
    applyChanges(dispatcher);
    for (const Updated& each : updated_) {
        each.world->endCalculation(dispatcher);
    }
    const auto pairCount = static_cast<std::size_t>(pairCache_->getNumOverlappingPairs());
    if (peaks_.isPast(pairCount, pairCache_->capacity())) {
        detail::freeArrays(updated_, died_, born_);
        pairCache_->releaseUnusedMemory();
    }
}

void WorldsBroadphase::listUpdated(btDispatcher* dispatcher) {
    updated_.clear();
    for (const auto& world : worlds_) {
        if (!world->isUpToDate()) {
            world->askIfMoreWasTakenOut(dispatcher);
            updated_.push_back({world.get()});
        }
    }
}

bool WorldsBroadphase::areAnyBehind() const noexcept {
    return std::any_of(updated_.begin(), updated_.end(),
                       [](const Updated& each) { return each.world->isCacheBehind_; });
}

// What others are to see, as a filter callback, is seen on the caller's thread.
void WorldsBroadphase::updateWorlds() {
    BT_PROFILE("hashphase: update pairs");
    constexpr std::size_t kGrain = 8;
    const detail::OnFailure fallBehind([&] { setBehind(); });
    const auto update = [this](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            updated_[i].changes = updated_[i].world->updatePairs();
        }
    };
    if (config_.each.parallelFor && !pairCache_->hasFilterCallback()) {
        config_.each.parallelFor(updated_.size(), kGrain, update);
    } else {
        serialFor(updated_.size(), kGrain, update);
    }
}

void WorldsBroadphase::setBehind() noexcept {
    for (const Updated& each : updated_) {
        each.world->isCacheBehind_ = true;
    }
}

// Of a world for which the cache is behind, all pairs are listed, and those that the cache has too many.
void WorldsBroadphase::listChanges() {
    died_.clear();
    born_.clear();
    for (const Updated& each : updated_) {
        if (each.world->isCacheBehind_) {
            each.world->listAll(born_);
        } else {
            each.world->listChanges(each.changes, died_, born_);
        }
    }
    if (!areAnyBehind()) {
        return;
    }
    const btBroadphasePairArray& present = pairCache_->getOverlappingPairArray();
    for (int i = 0; i < present.size(); ++i) {
        btBroadphaseProxy& first = *present[i].m_pProxy0;
        btBroadphaseProxy& second = *present[i].m_pProxy1;
        const World& world = worldFor(&first);
        if (world.isCacheBehind_ && !world.pairs_.isPair(World::pairOf(&first, &second))) {
            died_.emplace_back(first, second);
        }
    }
}

/// While changes of these worlds reach the cache: see SpatialHashBroadphase::Applying.
class WorldsBroadphase::Applying {
public:
    explicit Applying(WorldsBroadphase& owner) noexcept : owner_(owner) {
        for (Updated& each : owner_.updated_) {
            each.world->isCacheBehind_ = false;
            ++each.world->cacheChangeCount_;
            each.isWithinApply = std::exchange(each.world->isApplying_, true);
        }
    }
    ~Applying() {
        for (const Updated& each : owner_.updated_) {
            each.world->isApplying_ = each.isWithinApply;
            each.world->isCacheBehind_ = each.world->isCacheBehind_ || each.isWithinApply;
        }
    }
    Applying(const Applying&) = delete;
    Applying& operator=(const Applying&) = delete;

private:
    WorldsBroadphase& owner_;
};

void WorldsBroadphase::applyChanges(btDispatcher* dispatcher) {
    const detail::OnFailure fallBehind([&] { setBehind(); });
    listChanges();
    const Applying applying(*this);
    if (config_.each.parallelFor) {
        pairCache_->update(died_, born_, dispatcher, config_.each.parallelFor);
    } else {
        pairCache_->update(died_, born_, dispatcher);
    }
}

// --- What is taken out ---------------------------------------------------------------------------

void WorldsBroadphase::note(const btBroadphasePair& pair) noexcept {
    worldFor(pair.m_pProxy0).watch_.note(pair);
}

void WorldsBroadphase::forget() noexcept {
    for (const auto& world : worlds_) {
        world->watch_.forget();
    }
}

void WorldsBroadphase::endCache() noexcept {
    for (const auto& world : worlds_) {
        world->watch_.endCache();
    }
    pairCache_ = nullptr;
}

bool WorldsBroadphase::mayRefuse() const noexcept {
    return true;
}

bool WorldsBroadphase::refuses(const btBroadphaseProxy& a,
                               const btBroadphaseProxy& b) const noexcept {
    const World& world = worldFor(&a);
    return &world != &worldFor(&b) || world.isIgnoredPair(&a, &b);
}

// --- What they hold ------------------------------------------------------------------------------

std::size_t WorldsBroadphase::memoryBytes() const noexcept {
    std::size_t bytes = sizeof(*this) + worlds_.capacity() * sizeof(worlds_[0]) +
                        updated_.capacity() * sizeof(Updated) + notedIds_.capacity() * sizeof(int) +
                        (died_.capacity() + born_.capacity()) * sizeof(BulletProxyPair) +
                        (ownCache_ != nullptr ? ownCache_->memoryBytes() : 0);
    for (const auto& world : worlds_) {
        bytes += world->memoryBytes();
    }
    return bytes;
}

void WorldsBroadphase::releaseUnusedMemory() noexcept {
    const bool isWithin =
        detail::QueryScope::isWithin(&lastUniqueId_) || detail::QueryScope::isWithin(pairCache_);
    HASHPHASE_ASSERT(!isWithin,
                     "releaseUnusedMemory() was called from a callback of the broadphase or of its "
                     "pair cache. Call it after that returns.");
    if (isWithin) {
        return;
    }
    for (const auto& world : worlds_) {
        world->releaseUnusedMemory();
    }
    detail::freeArrays(updated_, died_, born_, notedIds_);
    pairCache_->releaseUnusedMemory();
}

std::string WorldsBroadphase::validate() const {
    std::size_t pairCount = 0;
    bool isAnythingTakenOut = false;
    for (const auto& world : worlds_) {
        std::string error = world->validate();
        if (!error.empty()) {
            return error;
        }
        pairCount += world->pairs_.count();
        isAnythingTakenOut = isAnythingTakenOut || world->watch_.isAnythingTakenOut();
    }
    if (ownCache_ == nullptr) {
        return {};
    }
    if (static_cast<std::size_t>(ownCache_->getNumOverlappingPairs()) != pairCount &&
        !isAnythingTakenOut) {
        return "The cache holds as many pairs as all worlds together: broken.";
    }
    return ownCache_->validate();
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
