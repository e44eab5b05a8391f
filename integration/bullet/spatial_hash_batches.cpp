// SPDX-License-Identifier: Zlib
//
// Many proxies at once, with the result of as many single calls.

#include <broadphase/core/compiler.hpp>
#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/on_failure.hpp>
#include <broadphase/move_batch.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/detail/lone_moves.inl>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <LinearMath/btQuickprof.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <tuple>
#include <utility>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

// How many proxies are dealt with by one thread at least.
constexpr std::size_t kWorthThreads = 1024;

void prefetchAhead(std::span<btBroadphaseProxy* const> proxies, std::size_t i) noexcept {
    constexpr std::size_t kAhead = 8;
    if (i + kAhead < proxies.size()) {
        detail::prefetch(proxies[i + kAhead]);
    }
}

// For assertions.
[[maybe_unused]] bool areDifferent(std::vector<int> ids) {
    std::sort(ids.begin(), ids.end());
    return std::adjacent_find(ids.begin(), ids.end()) == ids.end();
}

}  // namespace

void SpatialHashBroadphase::createProxies(std::span<const ProxyDefinition> definitions,
                                          std::span<btBroadphaseProxy*> proxies,
                                          btDispatcher* dispatcher) {
    BT_PROFILE("hashphase: create proxies");
    HASHPHASE_ASSERT(definitions.size() == proxies.size(),
                     "createProxies(): definitions and proxies have different lengths. Pass room "
                     "for one proxy for each definition.");
    grid_.store().makeRoom(grid_.size() + definitions.size());
    proxies_.reserve(grid_.size() + definitions.size());
    detail::ensureCapacity(uniqueIds_, grid_.size() + definitions.size());
    for (std::size_t i = 0; i < definitions.size(); ++i) {
        const ProxyDefinition& each = definitions[i];
        proxies[i] = createProxy(each.aabbMin, each.aabbMax, INVALID_SHAPE_PROXYTYPE, each.userPtr,
                                 each.collisionFilterGroup, each.collisionFilterMask, dispatcher);
    }
}

// --- Boxes on several threads ----------------------------------------------------------------------

/// Boxes that are set on several threads, as long as that comes to what single calls in their order do.
class SpatialHashBroadphase::AabbBatch {
public:
    AabbBatch(SpatialHashBroadphase& owner, std::span<btBroadphaseProxy* const> proxies,
              std::span<const btVector3> mins, std::span<const btVector3> maxs,
              btDispatcher* dispatcher)
        : owner_(owner), proxies_(proxies), mins_(mins), maxs_(maxs), dispatcher_(dispatcher) {}

    /// Returns how many it has set; the rest is for single calls.
    std::size_t set() {
        if (!owner_.config_.parallelFor || owner_.sweeps_ != nullptr ||
            proxies_.size() < kWorthThreads) {
            return 0;
        }
        owner_.checkMayChange();
        lookAtAll();
        const auto indexOf = [&indices = scratch().indices](std::size_t i) { return indices[i]; };
        if (!areDistinct(scratch(), proxies_.size(), owner_.grid_.indexLimit(),
                         owner_.config_.parallelFor, indexOf)) {
            return 0;
        }
        for (std::size_t first = 0;;) {
            const std::size_t alone = firstAlone(first);
            setPlain(first, alone);
            if (alone == proxies_.size()) {
                return alone;
            }
            first = alone + 1;
            if (!setAlone(alone)) {
                return first;
            }
        }
    }

private:
    [[nodiscard]] detail::MoveScratch& scratch() const {
        return owner_.grid_.store().scratchOfMoves();
    }

    void lookAtAll() {
        const std::size_t count = proxies_.size();
        for ([[maybe_unused]] btBroadphaseProxy* const proxy : proxies_) {
            static_cast<void>(owner_.checkedProxy(proxy));
        }
        scratch().indices.resize(std::max(scratch().indices.size(), count));
        scratch().isAlone.resize(std::max(scratch().isAlone.size(), count));
        const auto look = [&, &indices = scratch().indices, &isAlone = scratch().isAlone](
                              std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                prefetchAhead(proxies_, i);
                const bool isGone = at(i).id.isNull();  // destroyed before
                indices[i] = isGone ? detail::kNoProxyIndex : at(i).id.index;
                isAlone[i] = isGone || !isPlain(i) ? 1 : 0;
            }
        };
        owner_.config_.parallelFor(count, kWorthThreads, look);
    }

    [[nodiscard]] Proxy& at(std::size_t i) const { return static_cast<Proxy&>(*proxies_[i]); }
    [[nodiscard]] bool isSame(std::size_t i) const {
        return isSameBits(at(i).m_aabbMin, mins_[i]) && isSameBits(at(i).m_aabbMax, maxs_[i]);
    }

    // Whether setAabb() would set the box, and do nothing else that others could see.
    [[nodiscard]] bool isPlain(std::size_t i) const {
        const Proxy& proxy = at(i);
        if (!owner_.areGroupsKnown(proxy)) {
            return false;
        }
        return isSame(i) || owner_.movesAlone(proxy, mins_[i], maxs_[i], dispatcher_);
    }
    [[nodiscard]] std::size_t firstAlone(std::size_t from) const {
        const std::span<const char> alone(scratch().isAlone.data(), proxies_.size());
        const auto rest = alone.subspan(from);
        return from +
               static_cast<std::size_t>(std::find(rest.begin(), rest.end(), 1) - rest.begin());
    }

    // Returns whether all that was seen of the others still holds: callbacks may change anything.
    [[nodiscard]] bool setAlone(std::size_t i) {
        const auto state = [this] {
            return std::tuple(owner_.cacheChangeCount_, owner_.ghostCount(), owner_.groupsDecide_);
        };
        const auto before = state();
        owner_.setAabb(proxies_[i], mins_[i], maxs_[i], dispatcher_);
        return state() == before;
    }

    void setPlain(std::size_t first, std::size_t last) {
        std::atomic<detail::GroupKinds::Set> kinds{0};
        const auto noteKinds = [&] {
            owner_.changedKinds_ |= kinds.load(std::memory_order_relaxed);
        };
        const detail::OnFailure noteIfSome(noteKinds);  // some boxes may be set
        const auto setBox = [&](std::size_t offset) {
            const std::size_t i = first + offset;
            prefetchAhead(proxies_, i);
            if (isSame(i)) {
                return false;
            }
            at(i).m_aabbMin = mins_[i];
            at(i).m_aabbMax = maxs_[i];
            const detail::GroupKinds::Set kind = detail::GroupKinds::bit(at(i).kind);
            if ((kinds.load(std::memory_order_relaxed) & kind) == 0) {
                kinds.fetch_or(kind, std::memory_order_relaxed);
            }
            return true;
        };
        const auto moveOf = [&](std::size_t offset) {
            const Proxy& proxy = at(first + offset);
            return proxy.margin == 0
                       ? detail::Move<btScalar>{proxy.id.index,
                                                toAabb(proxy.m_aabbMin, proxy.m_aabbMax)}
                       : grownMove(proxy);
        };
        const bool areMany = last - first >= kWorthThreads;
        detail::MoveBatch<btScalar>(owner_.grid_.store())
            .run(last - first, areMany ? ParallelFor(owner_.config_.parallelFor) : serialFor,
                 setBox, moveOf);
        noteKinds();
        for (std::size_t i = first; i < last && !owner_.seen_.empty(); ++i) {
            owner_.noteSeen(at(i), true);
        }
    }

    // With this inline, moveOf() would not be, which costs each box that is set.
    [[HASHPHASE_NO_INLINE]] static detail::Move<btScalar> grownMove(const Proxy& proxy) {
        return {proxy.id.index, grown(toAabb(proxy.m_aabbMin, proxy.m_aabbMax), proxy.margin)};
    }

    SpatialHashBroadphase& owner_;
    std::span<btBroadphaseProxy* const> proxies_;
    std::span<const btVector3> mins_;
    std::span<const btVector3> maxs_;
    btDispatcher* dispatcher_;
};

void SpatialHashBroadphase::setAabbs(std::span<btBroadphaseProxy* const> proxies,
                                     std::span<const btVector3> aabbMins,
                                     std::span<const btVector3> aabbMaxs,
                                     btDispatcher* dispatcher) {
    BT_PROFILE("hashphase: set boxes");
    HASHPHASE_ASSERT(
        proxies.size() == aabbMins.size() && proxies.size() == aabbMaxs.size(),
        "setAabbs(): proxies and boxes have different lengths. Pass one box for each proxy.");
    const bool mayCallBack = mayHaveGhosts() || config_.eagerGroups != 0;
    std::vector<int> ids;
    if (mayCallBack) {
        ids.swap(grid_.store().scratchOfMoves().ids);  // callbacks may set others
        noteIds(proxies, ids);
    }
    std::size_t i = AabbBatch(*this, proxies, aabbMins, aabbMaxs, dispatcher).set();
    for (; i < proxies.size(); ++i) {
        prefetchAhead(proxies, i);
        if (!mayCallBack || proxies[i]->m_uniqueId == ids[i]) {
            setAabb(proxies[i], aabbMins[i], aabbMaxs[i], dispatcher);
        }
    }
    if (mayCallBack) {
        ids.swap(grid_.store().scratchOfMoves().ids);
    }
}

void SpatialHashBroadphase::forPairs(bool isOnThreads, std::size_t count, LoopBody body) const {
    constexpr std::size_t kGrain = 2048;
    if (isOnThreads && config_.parallelFor && count > kGrain) {
        config_.parallelFor(count, kGrain, body);
    } else {
        serialFor(count, kGrain, body);
    }
}

void SpatialHashBroadphase::noteIds(std::span<btBroadphaseProxy* const> proxies,
                                    std::vector<int>& ids) {
    ids.clear();
    for (const btBroadphaseProxy* const proxy : proxies) {
        HASHPHASE_ASSERT(proxy != nullptr,
                         "A proxy is null. Pass proxies that createProxy() returned.");
        ids.push_back(proxy->m_uniqueId);
    }
}

void SpatialHashBroadphase::checkNamedOnce([[maybe_unused]] std::span<const int> ids) {
    HASHPHASE_ASSERT(areDifferent({ids.begin(), ids.end()}),
                     "destroyProxies(): a proxy is named twice. Name each proxy once.");
}

void SpatialHashBroadphase::destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    checkMayChange();
    Proxy& own = *checkedProxy(proxy);
    if (!own.id.isNull()) {  // else destroyed before
        const int uniqueId = own.m_uniqueId;
        const std::uint64_t changeCount = cacheChangeCount_;
        removePairsOf({&proxy, 1}, dispatcher);
        endProxy(own, uniqueId, changeCount, dispatcher);
    }
}

void SpatialHashBroadphase::destroyProxies(std::span<btBroadphaseProxy* const> proxies,
                                           btDispatcher* dispatcher) {
    checkMayChange();
    const auto isDestroyed = [this](btBroadphaseProxy* proxy) {
        return checkedProxy(proxy)->id.isNull();
    };
    if (std::any_of(proxies.begin(), proxies.end(), isDestroyed)) {
        std::vector<btBroadphaseProxy*> others;
        std::remove_copy_if(proxies.begin(), proxies.end(), std::back_inserter(others),
                            isDestroyed);
        destroyProxies(others, dispatcher);
        return;
    }
    BT_PROFILE("hashphase: destroy proxies");
    std::vector<int> ids;
    noteIds(proxies, ids);
    checkNamedOnce(ids);
    const std::uint64_t changeCount = cacheChangeCount_;
    removePairsOf(proxies, dispatcher);
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        prefetchAhead(proxies, i);
        endProxy(static_cast<Proxy&>(*proxies[i]), ids[i], changeCount, dispatcher);
    }
}

// Once its pairs have gone. Callbacks of these may have destroyed the proxy, or brought about other pairs with
// it, which they cannot any more when it has left the grid.
void SpatialHashBroadphase::endProxy(Proxy& proxy, int uniqueId, std::uint64_t changeCount,
                                     btDispatcher* dispatcher) {
    if (proxy.m_uniqueId != uniqueId) {
        return;
    }
    grid_.remove(proxy.id);
    noteSeen(proxy, false);
    if (ghosts_ != nullptr) {
        ghosts_->erase(proxy.id.index);
    }
    uniqueIds_[proxy.id.index] = 0;
    proxy.id = {};
    if (cacheChangeCount_ != changeCount) {
        btBroadphaseProxy* const one = &proxy;
        removePairsOf({&one, 1}, dispatcher);
    }
    if (proxy.m_uniqueId == uniqueId) {
        proxy.m_uniqueId = 0;
        proxy.m_clientObject = nullptr;
    }
}

void SpatialHashBroadphase::removePairsOf(std::span<btBroadphaseProxy* const> proxies,
                                          btDispatcher* dispatcher) {
    if (watch_.cache == nullptr) {
        const detail::QueryScope scope(pairCache_, detail::QueryScope::Changes::allowed);
        for (btBroadphaseProxy* proxy : proxies) {
            if (dispatcher != nullptr) {
                freeCut(proxy, dispatcher);
            }
            pairCache_->removeOverlappingPairsContainingProxy(proxy, dispatcher);
        }
        return;
    }
    const detail::OnFailure follow([&] { isCacheBehind_ = true; });  // for nobody is destroyed
    watch_.cache->removePairsOf(proxies, dispatcher, PairCache::Remover::broadphase);
}

std::size_t SpatialHashBroadphase::shiftOrigin(const btVector3& shift) {
    HASHPHASE_ASSERT(!isCalculating(),
                     "shiftOrigin() was called from a callback of calculateOverlappingPairs(). "
                     "Call it after the step.");
    const Vector3<btScalar> by = toEigen(shift);
    std::vector<std::uint32_t> few;  // of the proxies, where many more have gone
    if (8 * grid_.size() < uniqueIds_.size()) {
        few.reserve(grid_.size());
        grid_.forEach([&](ProxyId id, const Aabb<btScalar>&) { few.push_back(id.index); });
    }
    const std::size_t roundedCount = grid_.shiftOrigin(by);
    mustNoteGroups_ = mustNoteGroups_ || roundedCount > 0;
    const std::size_t count = few.empty() ? uniqueIds_.size() : few.size();
    for (std::size_t i = 0; i < count && by.allFinite(); ++i) {
        const std::uint32_t slot = few.empty() ? static_cast<std::uint32_t>(i) : few[i];
        if (uniqueIds_[slot] != 0) {
            Proxy& proxy = *proxyAt(slot);
            proxy.m_aabbMin -= shift;
            proxy.m_aabbMax -= shift;
        }
    }
    return roundedCount;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
