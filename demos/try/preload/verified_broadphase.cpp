// SPDX-License-Identifier: Zlib
#include <demos/try/preload/verified_broadphase.hpp>

#include <demos/try/preload/overlap.hpp>
#include <demos/try/preload/recorder.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <iterator>
#include <mutex>

namespace hashphase::tryout {
namespace {

using RawPair = std::pair<btBroadphaseProxy*, btBroadphaseProxy*>;

RawPair rawPairOf(btBroadphaseProxy* a, btBroadphaseProxy* b) {
    return std::less<>()(a, b) ? RawPair(a, b) : RawPair(b, a);
}

btBroadphaseProxy* programs(const btBroadphaseProxy* stock) {
    return static_cast<btBroadphaseProxy*>(stock->m_clientObject);
}

template <class Name>
std::vector<RawPair> rawPairsOf(const btOverlappingPairCache& cache, const Name& name) {
    const btBroadphasePair* cached = cache.getOverlappingPairArrayPtr();
    std::vector<RawPair> pairs;
    for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
        pairs.push_back(rawPairOf(name(cached[i].m_pProxy0), name(cached[i].m_pProxy1)));
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

// By its three coordinates; the fourth may be anything.
bool isSame(const btVector3& a, const btVector3& b) {
    return a.x() == b.x() && a.y() == b.y() && a.z() == b.z();
}

std::vector<RawPair> difference(const std::vector<RawPair>& from,
                                const std::vector<RawPair>& what) {
    std::vector<RawPair> left;
    std::set_difference(from.begin(), from.end(), what.begin(), what.end(),
                        std::back_inserter(left));
    return left;
}

bool contains(const std::vector<RawPair>& pairs, const RawPair& pair) {
    return std::binary_search(pairs.begin(), pairs.end(), pair);
}

// The first fault, as a sentence for the record.
void describe(Verification& verification, const char* fault, const RawPair& pair,
              std::uint64_t calculation) {
    if (verification.firstFault[0] != '\0') {
        return;
    }
    const auto& [a, b] = pair;
    const auto number = [](btScalar x) { return static_cast<double>(x); };
    std::snprintf(verification.firstFault.data(), verification.firstFault.size(),
                  "calculation %llu: the pair of proxies %d and %d is %s; their boxes are "
                  "(%.9g, %.9g, %.9g) to (%.9g, %.9g, %.9g) and (%.9g, %.9g, %.9g) to "
                  "(%.9g, %.9g, %.9g)",
                  static_cast<unsigned long long>(calculation), a->m_uniqueId, b->m_uniqueId, fault,
                  number(a->m_aabbMin.x()), number(a->m_aabbMin.y()), number(a->m_aabbMin.z()),
                  number(a->m_aabbMax.x()), number(a->m_aabbMax.y()), number(a->m_aabbMax.z()),
                  number(b->m_aabbMin.x()), number(b->m_aabbMin.y()), number(b->m_aabbMin.z()),
                  number(b->m_aabbMax.x()), number(b->m_aabbMax.y()), number(b->m_aabbMax.z()));
}

// Worlds may be stepped on several threads.
void add(const Verification& calculation, Verification& into) {
    static std::mutex adding;
    const std::lock_guard lock(adding);
    if (into.firstFault[0] == '\0') {
        into.firstFault = calculation.firstFault;
    }
    into.calculations += calculation.calculations;
    into.pairs += calculation.pairs;
    into.missing += calculation.missing;
    into.extra += calculation.extra;
    into.unasked += calculation.unasked;
    into.removed += calculation.removed;
    into.late += calculation.late;
    into.stockPairs += calculation.stockPairs;
    into.stockMissing += calculation.stockMissing;
    into.stockExtra += calculation.stockExtra;
}

}  // namespace

// --- Bullet's broadphase -------------------------------------------------------------------------

class VerifiedBroadphase::Stock {
public:
    explicit Stock(btOverlappingPairCache& programsCache) : filter_(programsCache) {
        cache_.setOverlapFilterCallback(&filter_);
        stockDbvt().construct(object(), &cache_);
    }
    ~Stock() { stockDbvt().destruct(object()); }
    Stock(const Stock&) = delete;
    Stock& operator=(const Stock&) = delete;

    // The functions of `stockDbvt()`; the virtual ones of the object itself lead back to us.
    btDbvtBroadphase* object() { return reinterpret_cast<btDbvtBroadphase*>(room_); }
    btHashedOverlappingPairCache& cache() { return cache_; }

    void takeSettings(const btDbvtBroadphase& settings) {
        object()->m_prediction = settings.m_prediction;
        object()->m_fupdates = settings.m_fupdates;
        object()->m_dupdates = settings.m_dupdates;
        object()->m_cupdates = settings.m_cupdates;
        object()->m_deferedcollide = settings.m_deferedcollide;
    }

private:
    struct Filter : btOverlapFilterCallback {
        explicit Filter(btOverlappingPairCache& cache) : programsCache(cache) {}
        bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
            return programsCache.needsBroadphaseCollision(programs(a), programs(b));
        }
        btOverlappingPairCache& programsCache;
    };

    Filter filter_;
    btHashedOverlappingPairCache cache_;
    alignas(16) std::byte room_[sizeof(btDbvtBroadphase)];
};

// --- Both told the same --------------------------------------------------------------------------

VerifiedBroadphase::VerifiedBroadphase(const btDbvtBroadphase& settings,
                                       btOverlappingPairCache* cache)
    : settings_(settings),
      ours_(cache),
      stock_(std::make_unique<Stock>(*ours_.getOverlappingPairCache())) {}

VerifiedBroadphase::~VerifiedBroadphase() = default;

btBroadphaseProxy* VerifiedBroadphase::createProxy(const btVector3& aabbMin,
                                                   const btVector3& aabbMax, int shapeType,
                                                   void* userPtr, int collisionFilterGroup,
                                                   int collisionFilterMask,
                                                   btDispatcher* dispatcher) {
    btBroadphaseProxy* proxy =
        ours_.createProxy(aabbMin, aabbMax, shapeType, userPtr, collisionFilterGroup,
                          collisionFilterMask, dispatcher);
    btBroadphaseProxy* stock =
        stockDbvt().createProxy(stock_->object(), aabbMin, aabbMax, shapeType, proxy,
                                collisionFilterGroup, collisionFilterMask, nullptr);
    twins_[proxy] = {stock, calculation_ + 1};
    return proxy;
}

void VerifiedBroadphase::destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    const auto twin = twins_.find(proxy);
    stockDbvt().destroyProxy(stock_->object(), twin->second.stock, nullptr);
    twins_.erase(twin);
    forget(proxy);
    ours_.destroyProxy(proxy, dispatcher);
}

void VerifiedBroadphase::setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin,
                                 const btVector3& aabbMax, btDispatcher* dispatcher) {
    Twin& twin = twins_.at(proxy);
    if (!isSame(proxy->m_aabbMin, aabbMin) || !isSame(proxy->m_aabbMax, aabbMax)) {
        twin.changed = calculation_ + 1;
    }
    ours_.setAabb(proxy, aabbMin, aabbMax, dispatcher);
    stockDbvt().setAabb(stock_->object(), twin.stock, aabbMin, aabbMax, nullptr);
}

void VerifiedBroadphase::calculateOverlappingPairs(btDispatcher* dispatcher) {
    lookAtCache();
    ++calculation_;
    stock_->takeSettings(settings_);
    stockDbvt().calculateOverlappingPairs(stock_->object(), nullptr);
    ours_.calculateOverlappingPairs(dispatcher);
    compare();
}

void VerifiedBroadphase::resetPool(btDispatcher* dispatcher) {
    stockDbvt().resetPool(stock_->object(), nullptr);
    ours_.resetPool(dispatcher);
}

// --- Ours alone ----------------------------------------------------------------------------------

void VerifiedBroadphase::getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin,
                                 btVector3& aabbMax) const {
    ours_.getAabb(proxy, aabbMin, aabbMax);
}

void VerifiedBroadphase::rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                                 btBroadphaseRayCallback& rayCallback, const btVector3& aabbMin,
                                 const btVector3& aabbMax) {
    ours_.rayTest(rayFrom, rayTo, rayCallback, aabbMin, aabbMax);
}

void VerifiedBroadphase::aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                                  btBroadphaseAabbCallback& callback) {
    ours_.aabbTest(aabbMin, aabbMax, callback);
}

btOverlappingPairCache* VerifiedBroadphase::getOverlappingPairCache() {
    return ours_.getOverlappingPairCache();
}

const btOverlappingPairCache* VerifiedBroadphase::getOverlappingPairCache() const {
    return ours_.getOverlappingPairCache();
}

void VerifiedBroadphase::getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const {
    ours_.getBroadphaseAabb(aabbMin, aabbMax);
}

// --- The comparison ------------------------------------------------------------------------------

// A sweep along x: from each box on, those that begin before it ends.
std::vector<RawPair> VerifiedBroadphase::findOverlapping() const {
    std::vector<btBroadphaseProxy*> proxies;
    for (const auto& [proxy, twin] : twins_) {
        // NaN overlaps nothing, and cannot be sorted.
        if (proxy->m_aabbMin.x() == proxy->m_aabbMin.x()) {
            proxies.push_back(proxy);
        }
    }
    std::sort(proxies.begin(), proxies.end(),
              [](const btBroadphaseProxy* a, const btBroadphaseProxy* b) {
                  return a->m_aabbMin.x() < b->m_aabbMin.x();
              });
    std::vector<RawPair> pairs;
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        for (std::size_t j = i + 1;
             j < proxies.size() && proxies[j]->m_aabbMin.x() <= proxies[i]->m_aabbMax.x(); ++j) {
            if (overlaps(*proxies[i], *proxies[j])) {
                pairs.push_back(rawPairOf(proxies[i], proxies[j]));
            }
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

std::uint64_t VerifiedBroadphase::changeOf(const RawPair& pair) const {
    std::uint64_t last = 0;
    for (btBroadphaseProxy* proxy : {pair.first, pair.second}) {
        if (const auto twin = twins_.find(proxy); twin != twins_.end()) {
            last = std::max(last, twin->second.changed);
        }
    }
    return last;
}

// Pairs that the last calculation left in the cache and that are no longer there were removed; those of
// proxies that were destroyed have gone from last_ with them.
void VerifiedBroadphase::lookAtCache() {
    before_ = rawPairsOf(*ours_.getOverlappingPairCache(),
                         [](btBroadphaseProxy* proxy) { return proxy; });
    const std::vector<RawPair> gone = difference(last_, before_);
    removed_.insert(removed_.end(), gone.begin(), gone.end());
    std::sort(removed_.begin(), removed_.end());
}

void VerifiedBroadphase::forget(const btBroadphaseProxy* proxy) {
    const auto names = [proxy](const RawPair& pair) {
        return pair.first == proxy || pair.second == proxy;
    };
    for (std::vector<RawPair>* pairs : {&last_, &before_, &removed_, &missing_}) {
        std::erase_if(*pairs, names);
    }
}

void VerifiedBroadphase::compare() {
    Record* into = record();
    if (into == nullptr) {
        return;
    }
    btOverlappingPairCache& cache = *ours_.getOverlappingPairCache();
    const auto isLate = [this](const RawPair& pair) { return changeOf(pair) > calculation_; };
    const auto isAccepted = [&cache](const RawPair& pair) {
        return cache.needsBroadphaseCollision(pair.first, pair.second);
    };
    Verification verification;
    verification.calculations = 1;
    std::vector<RawPair> exact = findOverlapping();
    std::vector<RawPair> ours = rawPairsOf(cache, [](btBroadphaseProxy* proxy) { return proxy; });
    std::vector<RawPair> stock = rawPairsOf(stock_->cache(), programs);
    last_ = ours;
    verification.late = std::erase_if(exact, isLate);
    std::erase_if(ours, isLate);
    std::erase_if(stock, isLate);

    verification.pairs = ours.size();
    for (const RawPair& pair : difference(ours, exact)) {
        ++verification.extra;
        describe(verification, "extra", pair, calculation_);
    }
    for (const RawPair& pair : difference(ours, before_)) {
        if (contains(exact, pair) && !isAccepted(pair)) {
            ++verification.extra;
            describe(verification, "made although the filter refuses it", pair, calculation_);
        }
    }
    std::vector<RawPair> missing;
    for (const RawPair& pair : difference(exact, ours)) {
        const bool isLost = contains(before_, pair) || contains(missing_, pair);
        if (!isAccepted(pair)) {
            continue;
        }
        if (!isLost && contains(removed_, pair)) {
            ++verification.removed;
        } else if (!isLost && changeOf(pair) < calculation_) {
            ++verification.unasked;
        } else {
            missing.push_back(pair);
            describe(verification, "missing", pair, calculation_);
        }
    }
    verification.missing = missing.size();
    missing_ = std::move(missing);
    std::erase_if(removed_, [&](const RawPair& pair) {
        return contains(ours, pair) || !contains(exact, pair);
    });

    verification.stockPairs = stock.size();
    verification.stockExtra = difference(stock, exact).size();
    for (const RawPair& pair : difference(exact, stock)) {
        if (changeOf(pair) == calculation_ && isAccepted(pair)) {
            ++verification.stockMissing;
        }
    }
    add(verification, into->verification);
}

}  // namespace hashphase::tryout
