// SPDX-License-Identifier: Zlib
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <broadphase/core/caught.hpp>
#include <broadphase/core/compiler.hpp>
#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/limits.hpp>
#include <broadphase/core/on_failure.hpp>
#include <broadphase/core/raise.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/detail/body_motion.hpp>
#include <integration/bullet/detail/lone_moves.inl>
#include <integration/bullet/pair_cache.hpp>

#include <LinearMath/btGeometryUtil.h>
#include <LinearMath/btQuickprof.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <sstream>
#include <utility>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

// Bullet's own interfaces have the same symbols in both precisions. This one has not: a program that
// links a Bullet of the other precision fails to link, with this name in the message.
extern bool (*const kBulletOfTheSamePrecision)(const btAlignedObjectArray<btVector3>&,
                                               const btVector3&, btScalar);
bool (*const kBulletOfTheSamePrecision)(const btAlignedObjectArray<btVector3>&, const btVector3&,
                                        btScalar) = &btGeometryUtil::isPointInsidePlanes;

namespace {

const SpatialHashConfig& checked(const SpatialHashConfig& config) {
    const std::string error = configError(config);
    if (!error.empty()) {
        detail::raiseInvalidArgument(error);
    }
    return config;
}

}  // namespace

std::string configError(const SpatialHashConfig& config) {
    if (!(config.fastFrom >= 0)) {  // or NaN
        std::ostringstream sentence;
        sentence << "SpatialHashConfig::fastFrom is " << config.fastFrom
                 << ", but must be 0 or more.";
        return sentence.str();
    }
    return configError(config.grid);
}

// --- Proxies -------------------------------------------------------------------------------------

SpatialHashBroadphase::SpatialHashBroadphase(const SpatialHashConfig& config)
    : SpatialHashBroadphase(static_cast<btOverlappingPairCache*>(nullptr), config) {}

SpatialHashBroadphase::SpatialHashBroadphase(std::nullptr_t, const SpatialHashConfig& config)
    : SpatialHashBroadphase(config) {}

SpatialHashBroadphase::SpatialHashBroadphase(PairCache* pairCache, const SpatialHashConfig& config)
    : SpatialHashBroadphase(static_cast<btOverlappingPairCache*>(pairCache), config) {
    if (pairCache != nullptr) {
        watch_.begin(*pairCache);
    }
    groupsDecide_ = doGroupsDecide();
}

SpatialHashBroadphase::SpatialHashBroadphase(btOverlappingPairCache* pairCache,
                                             const SpatialHashConfig& config)
    : config_(checked(config)),
      grid_(config.grid),
      sweeps_(config.sweep != Sweep::none ? std::make_unique<Sweeps<btScalar>>(grid_) : nullptr),
      pairs_(grid_, sweeps_.get()),
      pairCache_(pairCache) {
    if (pairCache_ == nullptr) {
        ownCache_ = std::make_unique<PairCache>();
        watch_.begin(*ownCache_);
        pairCache_ = ownCache_.get();
    }
    groupsDecide_ = doGroupsDecide();
    HASHPHASE_ASSERT(pairCache_->getNumOverlappingPairs() == 0,
                     "SpatialHashBroadphase: the pair cache already has pairs. Pass an empty "
                     "cache, which no other broadphase uses.");
}

SpatialHashBroadphase::~SpatialHashBroadphase() = default;

btBroadphaseProxy* SpatialHashBroadphase::createProxy(const btVector3& aabbMin,
                                                      const btVector3& aabbMax, int /*shapeType*/,
                                                      void* userPtr, int collisionFilterGroup,
                                                      int collisionFilterMask,
                                                      btDispatcher* dispatcher) {
    detail::checkCount(static_cast<std::size_t>(*idCounter_) + 1, std::numeric_limits<int>::max(),
                       "createProxy(): all 2,147,483,647 unique ids are used up. Destroy all "
                       "proxies, then call resetPool().");
    Proxy& proxy = place({aabbMin, aabbMax, userPtr, collisionFilterGroup, collisionFilterMask});
    const detail::OnFailure destroy([&] {
        // What a pair cache of the user's throws as well gives way to what has failed first. A class that
        // derives from this one has not got the proxy yet.
        static_cast<void>(
            detail::exceptionOf([&] { SpatialHashBroadphase::destroyProxy(&proxy, dispatcher); }));
    });
    if (isEager(proxy, dispatcher)) {
        findPairsNow(proxy, dispatcher);
    } else {
        findGhostPairsNow(proxy, dispatcher);
    }
    return &proxy;
}

// All that the proxy needs is there before it is in the grid.
SpatialHashBroadphase::Proxy& SpatialHashBroadphase::place(const btBroadphaseProxy& made) {
    detail::ensureCapacity(uniqueIds_, uniqueIds_.size() + 1);
    proxies_.reserve(uniqueIds_.size() + 1);
    const bool isStatic = (made.m_collisionFilterGroup & btBroadphaseProxy::StaticFilter) != 0;
    const ProxyGroups groups = groupsOf(made);
    const ProxyId id = grid_.add(toAabb(made.m_aabbMin, made.m_aabbMax),
                                 isStatic ? Mobility::resting : Mobility::mobile, groups);
    if (id.index >= uniqueIds_.size()) {
        uniqueIds_.resize(id.index + 1, 0);
    }
    Proxy& proxy = *proxyAt(id.index);
    static_cast<btBroadphaseProxy&>(proxy) = made;
    proxy.kind = groupKinds_.numberOf(groups);
    changedKinds_ |= detail::GroupKinds::bit(proxy.kind);
    proxy.m_uniqueId = ++*idCounter_;
    proxy.id = id;
    proxy.world = worldNumber_;
    proxy.client = Client::unknown;
    proxy.margin = 0;
    noteSeen(proxy, true);
    uniqueIds_[id.index] = proxy.m_uniqueId;
    return proxy;
}

void SpatialHashBroadphase::setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin,
                                    const btVector3& aabbMax, btDispatcher* dispatcher) {
    checkMayChange();
    Proxy* const own = checkedProxy(proxy);
    if (own->id.isNull()) {  // destroyed before
        return;
    }
    if ((mayGrow_ && (sweeps_ != nullptr || own->margin != 0)) || !areGroupsKnown(*own) ||
        !movesAlone(*own, aabbMin, aabbMax, dispatcher)) {
        setAnyAabb(*own, aabbMin, aabbMax, own->margin, dispatcher);
        return;
    }
    if (!isSameBits(own->m_aabbMin, aabbMin) || !isSameBits(own->m_aabbMax, aabbMax)) {
        if (!grid_.store().moveIfInPlace(own->id.index, toAabb(aabbMin, aabbMax))) {
            setAnyAabb(*own, aabbMin, aabbMax, own->margin, dispatcher);
            return;
        }
        own->m_aabbMin = aabbMin;
        own->m_aabbMax = aabbMax;
        changedKinds_ |= detail::GroupKinds::bit(own->kind);
    }
    if (!seen_.empty()) {
        noteSeen(*own, true);
    }
}

void SpatialHashBroadphase::move(const Proxy& proxy, const Aabb<btScalar>& box) {
    if (sweeps_ == nullptr) {
        grid_.move(proxy.id, box);
    } else {
        moveOnItsWay(proxy, box);
    }
}

// The grid has the box that Bullet has handed in, which holds the body at start and end of the step, and
// wherever it stops on its way: queries see it there. It is Bullet's choice whether it does.
void SpatialHashBroadphase::moveOnItsWay(const Proxy& proxy, const Aabb<btScalar>& box) {
    std::optional<detail::BodyMotion> motion =
        hasNan(box) ? std::nullopt : detail::fastMotion(proxy, config_.fastFrom);
    if (motion) {
        motion->way.box = grown(motion->way.box, proxy.margin);
        motion->bounds = grown(motion->bounds, proxy.margin);
    }
    grid_.move(proxy.id, motion ? box.merged(motion->bounds) : box);
    sweeps_->set(proxy.id, motion ? motion->way : MovingBox<btScalar>{box}, config_.sweep);
}

void SpatialHashBroadphase::getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin,
                                    btVector3& aabbMax) const {
    const Proxy* own = checkedProxy(proxy);
    aabbMin = own->m_aabbMin;
    aabbMax = own->m_aabbMax;
}

void SpatialHashBroadphase::noteSeen(const Proxy& proxy, bool isSeen) noexcept {
    const std::size_t word = proxy.id.index / 64;
    const std::uint64_t bit = std::uint64_t{1} << proxy.id.index % 64;
    if (word < seen_.size() && ((seen_[word] & bit) != 0) != isSeen) {
        seen_[word] ^= bit;
        if (isSeen) {
            ++seenCount_;
        } else {
            --seenCount_;
        }
    }
}

// --- Pairs ---------------------------------------------------------------------------------------

// Pairs name proxies all over the memory. Those of a later one are fetched while earlier ones are
// asked about.
void SpatialHashBroadphase::askFilter(std::span<const ProxyPair> asked,
                                      std::span<char> accepted) const {
    constexpr std::size_t kAhead = 16;
    const auto ask = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (i + kAhead < end) {
                detail::prefetch(proxyAt(asked[i + kAhead].first.index));
                detail::prefetch(proxyAt(asked[i + kAhead].second.index));
            }
            Proxy* const first = proxyAt(asked[i].first.index);
            Proxy* const second = proxyAt(asked[i].second.index);
            const bool isPair = watch_.cache != nullptr
                                    ? watch_.cache->doFiltersAccept(first, second)
                                    : pairCache_->needsBroadphaseCollision(first, second);
            accepted[i] = isPair ? 1 : 0;
        }
    };
    // A callback of the program, or a cache of its own, is asked on the caller's thread.
    const bool doGroupsAnswer = watch_.cache != nullptr && !watch_.cache->hasFilterCallback();
    forPairs(doGroupsAnswer, asked.size(), ask);
}

void SpatialHashBroadphase::calculateOverlappingPairs(btDispatcher* dispatcher) {
    HASHPHASE_ASSERT(!isCalculating(),
                     "calculateOverlappingPairs() was called from one of its own callbacks. Call "
                     "it, or step the world, after it returns.");
    const detail::QueryScope scope(idCounter_, detail::QueryScope::Changes::allowed);
    askIfMoreWasTakenOut(dispatcher);
    if (isCacheBehind_) {  // all of it is read: what this frees first is freed before pairs are listed
        static_cast<void>(pairCache_->getOverlappingPairArray());
    }
    PairChanges changes;
    {
        BT_PROFILE("hashphase: update pairs");
        changes = updatePairs();
    }
    BT_PROFILE("hashphase: pair cache");
    if (isCacheBehind_) {
        catchUp(dispatcher);
    } else {
        constexpr std::size_t kBirthsAtOnce = 4096;  // the processor's cache holds them
        apply(changes, config_.parallelFor ? changes.born.size() : kBirthsAtOnce, dispatcher);
    }
    endCalculation(dispatcher);
}

PairChanges SpatialHashBroadphase::updatePairs() {
    followFilter();
    noteGroupsIfTheyMatter();
    return config_.parallelFor ? pairs_.update(cacheFilter(), config_.parallelFor)
                               : pairs_.update(cacheFilter());
}

void SpatialHashBroadphase::endCalculation(btDispatcher* dispatcher) {
    putBackWhatWasTakenOut(dispatcher);
    const auto meets = [this](const btBroadphasePair& pair) {
        return doMeet(*pair.m_pProxy0, *pair.m_pProxy1);
    };
    removeDeferred(meets, dispatcher);
    releaseAfterPeak();
}

// A destroyed proxy has taken its pairs with it.
void SpatialHashBroadphase::findBulletPairs(std::span<const ProxyPair> pairs,
                                            std::vector<BulletProxyPair>& bulletPairs,
                                            std::size_t first) const {
    bulletPairs.resize(first + pairs.size());
    const std::span<BulletProxyPair> found = std::span(bulletPairs).subspan(first);
    std::atomic<bool> areAllThere{true};
    forPairs(true, pairs.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t a = pairs[i].first.index;
            const std::uint32_t b = pairs[i].second.index;
            if (uniqueIds_[a] != 0 && uniqueIds_[b] != 0) {
                found[i] = {*proxyAt(a), uniqueIds_[a], *proxyAt(b), uniqueIds_[b]};
            } else {
                found[i] = {};
                areAllThere.store(false, std::memory_order_relaxed);
            }
        }
    });
    if (!areAllThere.load(std::memory_order_relaxed)) {
        std::erase_if(bulletPairs, [](const BulletProxyPair& pair) { return pair.ids() == 0; });
    }
}

/// The lists of pairs that are applied, lent to a call: its callbacks may bring another one about.
struct SpatialHashBroadphase::PairLists {
    explicit PairLists(SpatialHashBroadphase& lender)
        : died(std::move(lender.died_)), born(std::move(lender.born_)), lender_(lender) {}
    ~PairLists() {
        lender_.died_ = std::move(died);
        lender_.born_ = std::move(born);
    }
    PairLists(const PairLists&) = delete;
    PairLists& operator=(const PairLists&) = delete;

    std::vector<BulletProxyPair> died;
    std::vector<BulletProxyPair> born;

private:
    SpatialHashBroadphase& lender_;
};

void SpatialHashBroadphase::apply(const PairChanges& changes, std::size_t birthsAtOnce,
                                  btDispatcher* dispatcher) {
    const detail::OnFailure follow([&] { isCacheBehind_ = true; });
    if (changes.died.empty() && changes.born.empty()) {
        applyToCache({}, {}, dispatcher);  // which frees what is to be freed
        return;
    }
    PairLists lists(*this);
    // The first births, as many as there are deaths at least, go with these, to take their places.
    findBulletPairs(changes.died, lists.died);
    std::span<const ProxyPair> born = changes.born;
    std::size_t count = std::min(born.size(), std::max(lists.died.size(), birthsAtOnce));
    do {
        findBulletPairs(born.first(count), lists.born);
        applyToCache(lists.died, lists.born, dispatcher);
        lists.died.clear();
        born = born.subspan(count);
        count = std::min(born.size(), birthsAtOnce);
    } while (count > 0);
}

/// While changes reach the cache. What a callback changes meanwhile may come too early: of a pair that it
/// begins anew, or ends, the former end or beginning may follow.
class SpatialHashBroadphase::Applying {
public:
    Applying(SpatialHashBroadphase& owner, bool isAny) noexcept
        : owner_(owner), isWithin_(std::exchange(owner.isApplying_, true)), isAny_(isAny) {}
    ~Applying() {
        owner_.isApplying_ = isWithin_;
        owner_.isCacheBehind_ = owner_.isCacheBehind_ || (isWithin_ && isAny_);
    }
    Applying(const Applying&) = delete;
    Applying& operator=(const Applying&) = delete;

private:
    SpatialHashBroadphase& owner_;
    bool isWithin_;
    bool isAny_;
};

void SpatialHashBroadphase::applyToCache(std::span<const BulletProxyPair> died,
                                         std::span<const BulletProxyPair> born,
                                         btDispatcher* dispatcher) {
    const Applying applying(*this, !died.empty() || !born.empty());
    cacheChangeCount_ += !died.empty() || !born.empty() ? 1 : 0;
    if (watch_.cache != nullptr) {
        if (config_.parallelFor) {
            watch_.cache->update(died, born, dispatcher, config_.parallelFor);
        } else {
            watch_.cache->update(died, born, dispatcher);
        }
        return;
    }
    const detail::QueryScope scope(pairCache_, detail::QueryScope::Changes::allowed);
    for (const BulletProxyPair& pair : died) {
        pairCache_->removeOverlappingPair(pair.lower(), pair.upper(), dispatcher);
    }
    for (const BulletProxyPair& pair : born) {
        if (pair.isUpToDate()) {  // a callback may have destroyed one of the two
            pairCache_->addOverlappingPair(pair.lower(), pair.upper());
        }
    }
}

// After changes that did not all reach the cache: what it holds and is no pair goes, what is one and is
// missing comes.
void SpatialHashBroadphase::catchUp(btDispatcher* dispatcher) {
    std::vector<ProxyPair> all;
    pairs_.collect(all);
    PairLists lists(*this);
    findBulletPairs(all, lists.born);
    lists.died.clear();
    btBroadphasePairArray& present = pairCache_->getOverlappingPairArray();
    for (int i = 0; i < present.size(); ++i) {
        if (isOfThisWorld(*present[i].m_pProxy0) &&
            !std::binary_search(all.begin(), all.end(),
                                pairOf(present[i].m_pProxy0, present[i].m_pProxy1))) {
            lists.died.emplace_back(*present[i].m_pProxy0, *present[i].m_pProxy1);
        }
    }
    isCacheBehind_ = false;
    const detail::OnFailure follow([&] { isCacheBehind_ = true; });
    applyToCache(lists.died, lists.born, dispatcher);
}

bool SpatialHashBroadphase::doMeet(const btBroadphaseProxy& a, const btBroadphaseProxy& b) const {
    if (sweeps_ == nullptr) {
        return overlaps(grid_.box(idOf(&a)), grid_.box(idOf(&b)));
    }
    return firstContact(sweeps_->motion(idOf(&a)), sweeps_->motion(idOf(&b))).has_value();
}

btBroadphaseProxy* SpatialHashBroadphase::proxyOf(ProxyId id) const {
    HASHPHASE_ASSERT(
        grid_.contains(id),
        "proxyOf(): the id is null, stale, or of another broadphase. Pass the id of a live proxy.");
    return grid_.contains(id) ? proxyAt(id.index) : nullptr;
}

ProxyId SpatialHashBroadphase::idOf(const btBroadphaseProxy* proxy) {
    HASHPHASE_ASSERT(proxy != nullptr,
                     "idOf(): the proxy is null. Pass a proxy that createProxy() returned.");
    return static_cast<const Proxy*>(proxy)->id;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
