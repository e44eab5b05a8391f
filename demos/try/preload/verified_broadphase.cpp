// SPDX-License-Identifier: Zlib

// Our broadphase at work, with Bullet's beside it that is told the same; after each
// calculateOverlappingPairs() the pairs of both are compared with the exact ones, and what is wrong is
// counted in the record.
//
// Exact    The pairs whose boxes overlap (overlaps()), by a sweep along x that shares no code with the
//          library, and that the pair cache accepts: two proxies that are no pair are missing if it is
//          accepted when it is asked about, now, and a pair that the calculation has made is extra if it
//          is not. A pair that was none before, is accepted now, and whose boxes are as they were in
//          the last calculation, was refused then: it is counted apart, as it waits for a move under
//          any broadphase of Bullet's.
// Removed  A pair that the program itself took out of the cache between two calculations is counted apart
//          as well, until its boxes part: with ours it comes back when they meet again, or by refilter().
// Late     What a callback has moved or made while pairs were calculated is judged after the next
//          calculation, which takes notice of it.
// Filter   Asked for both broadphases, and by the comparison; always about the program's own proxies.
// Threads  As the broadphase.

#include <demos/try/preload/recorder.hpp>
#include <demos/try/preload/stock_dbvt.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iterator>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace hashphase::tryout {
namespace {

// --- Pairs ---------------------------------------------------------------------------------------

/// Two proxies of the program's, the one with the lower address first.
using RawPair = std::pair<BulletProxy, BulletProxy>;
using RawPairs = std::vector<RawPair>;  // sorted

RawPair rawPairOf(BulletProxy a, BulletProxy b) {
    return std::less<>()(a, b) ? RawPair(a, b) : RawPair(b, a);
}

template <class Name>
RawPairs rawPairsOf(const btOverlappingPairCache& cache, const Name& name) {
    const btBroadphasePair* cached = cache.getOverlappingPairArrayPtr();
    RawPairs pairs;
    for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
        pairs.push_back(rawPairOf(name(cached[i].m_pProxy0), name(cached[i].m_pProxy1)));
    }
    std::ranges::sort(pairs);
    return pairs;
}

RawPairs difference(const RawPairs& from, const RawPairs& what) {
    RawPairs left;
    std::ranges::set_difference(from, what, std::back_inserter(left));
    return left;
}

bool contains(const RawPairs& pairs, const RawPair& pair) {
    return std::ranges::binary_search(pairs, pair);
}

// --- Bullet's broadphase -------------------------------------------------------------------------

/// In room of its own; its proxies' clients are the program's proxies.
class Stock {
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

    void calculateOverlappingPairs(const btDbvtBroadphase& settings) {
        object()->m_prediction = settings.m_prediction;
        object()->m_fupdates = settings.m_fupdates;
        object()->m_dupdates = settings.m_dupdates;
        object()->m_cupdates = settings.m_cupdates;
        object()->m_deferedcollide = settings.m_deferedcollide;
        stockDbvt().calculateOverlappingPairs(object(), nullptr);
    }
    RawPairs pairs() const { return rawPairsOf(cache_, programs); }

private:
    static BulletProxy programs(const btBroadphaseProxy* stock) {
        return static_cast<BulletProxy>(stock->m_clientObject);
    }

    struct Filter : btOverlapFilterCallback {
        explicit Filter(btOverlappingPairCache& cache) : programsCache(cache) {}
        bool needBroadphaseCollision(BulletProxy a, BulletProxy b) const override {
            return programsCache.needsBroadphaseCollision(programs(a), programs(b));
        }
        btOverlappingPairCache& programsCache;
    };

    Filter filter_;
    btHashedOverlappingPairCache cache_;
    alignas(16) std::byte room_[sizeof(btDbvtBroadphase)];
};

// --- What is found -------------------------------------------------------------------------------

// By its three coordinates; the fourth may be anything.
bool isSame(Point a, Point b) {
    return a.x() == b.x() && a.y() == b.y() && a.z() == b.z();
}

std::string textOf(const btBroadphaseProxy& box) {
    std::array<char, 200> text{};
    const auto number = [](btScalar x) { return static_cast<double>(x); };
    std::snprintf(text.data(), text.size(), "(%.9g, %.9g, %.9g) to (%.9g, %.9g, %.9g)",
                  number(box.m_aabbMin.x()), number(box.m_aabbMin.y()), number(box.m_aabbMin.z()),
                  number(box.m_aabbMax.x()), number(box.m_aabbMax.y()), number(box.m_aabbMax.z()));
    return text.data();
}

// The first fault, as a sentence for the record.
void describe(Verification& verification, const char* fault, const RawPair& pair,
              std::uint64_t calculation) {
    const auto& [a, b] = pair;
    if (verification.firstFault[0] == '\0') {
        std::snprintf(verification.firstFault.data(), verification.firstFault.size(),
                      "calculation %llu: the pair of proxies %d and %d is %s; their boxes are "
                      "%s and %s",
                      static_cast<unsigned long long>(calculation), a->m_uniqueId, b->m_uniqueId,
                      fault, textOf(*a).c_str(), textOf(*b).c_str());
    }
}

// Worlds may be stepped on several threads.
void add(const Verification& calculation, Verification& into) {
    static std::mutex adding;
    const std::lock_guard lock(adding);
    if (into.firstFault[0] == '\0') {
        into.firstFault = calculation.firstFault;
    }
    for (const VerifiedCount& each : kVerifiedCounts) {
        into.*each.count += calculation.*each.count;
    }
}

// --- Both told the same --------------------------------------------------------------------------

class VerifiedBroadphase : public SpatialHashBroadphase {
public:
    VerifiedBroadphase(const btDbvtBroadphase& settings, btOverlappingPairCache* cache)
        : SpatialHashBroadphase(cache),
          settings_(settings),
          cache_(*SpatialHashBroadphase::getOverlappingPairCache()),
          stock_(cache_) {}

    BulletProxy createProxy(Point aabbMin, Point aabbMax, int shapeType, void* userPtr,
                            int collisionFilterGroup, int collisionFilterMask,
                            Dispatcher dispatcher) override {
        BulletProxy proxy = SpatialHashBroadphase::createProxy(aabbMin, aabbMax, shapeType, userPtr,
                                                               collisionFilterGroup,
                                                               collisionFilterMask, dispatcher);
        BulletProxy stock =
            stockDbvt().createProxy(stock_.object(), aabbMin, aabbMax, shapeType, proxy,
                                    collisionFilterGroup, collisionFilterMask, nullptr);
        twins_[proxy] = {stock, calculation_ + 1};
        return proxy;
    }

    void destroyProxy(BulletProxy proxy, Dispatcher dispatcher) override {
        const auto twin = twins_.find(proxy);
        stockDbvt().destroyProxy(stock_.object(), twin->second.stock, nullptr);
        twins_.erase(twin);
        for (RawPairs* pairs : {&last_, &before_, &removed_, &missing_}) {
            std::erase_if(*pairs, [proxy](const RawPair& pair) {
                return pair.first == proxy || pair.second == proxy;
            });
        }
        SpatialHashBroadphase::destroyProxy(proxy, dispatcher);
    }

    void setAabb(BulletProxy proxy, Point aabbMin, Point aabbMax, Dispatcher dispatcher) override {
        Twin& twin = twins_.at(proxy);
        if (!isSame(proxy->m_aabbMin, aabbMin) || !isSame(proxy->m_aabbMax, aabbMax)) {
            twin.changed = calculation_ + 1;
        }
        SpatialHashBroadphase::setAabb(proxy, aabbMin, aabbMax, dispatcher);
        stockDbvt().setAabb(stock_.object(), twin.stock, aabbMin, aabbMax, nullptr);
    }

    void calculateOverlappingPairs(Dispatcher dispatcher) override {
        lookAtCache();
        ++calculation_;
        stock_.calculateOverlappingPairs(settings_);
        SpatialHashBroadphase::calculateOverlappingPairs(dispatcher);
        if (Record* into = record()) {
            add(compare(), into->verification);
        }
    }

    void resetPool(Dispatcher dispatcher) override {
        stockDbvt().resetPool(stock_.object(), nullptr);
        SpatialHashBroadphase::resetPool(dispatcher);
    }

private:
    struct Twin {
        BulletProxy stock;
        std::uint64_t changed;  // the number of the calculation that takes notice of it
    };

    RawPairs ours() const {
        return rawPairsOf(cache_, [](BulletProxy proxy) { return proxy; });
    }
    bool isAccepted(const RawPair& pair) const {
        return cache_.needsBroadphaseCollision(pair.first, pair.second);
    }
    RawPairs findOverlapping() const;
    std::uint64_t changeOf(const RawPair& pair) const;
    void lookAtCache();
    Verification compare();
    void judgeMissing(const RawPairs& exact, const RawPairs& ours, Verification& verification);

    const btDbvtBroadphase& settings_;
    btOverlappingPairCache& cache_;
    Stock stock_;
    std::unordered_map<BulletProxy, Twin> twins_;
    RawPairs last_;                  // pairs of ours after the last calculation
    RawPairs before_;                // and when the next one began
    RawPairs removed_;               // by the program since, or before, and overlapping ever since
    RawPairs missing_;               // after the last calculation
    std::uint64_t calculation_ = 0;  // the last one that has begun
};

// --- The comparison ------------------------------------------------------------------------------

// A sweep along x: from each box on, those that begin before it ends.
RawPairs VerifiedBroadphase::findOverlapping() const {
    std::vector<BulletProxy> proxies;
    for (const auto& [proxy, twin] : twins_) {
        // NaN overlaps nothing, and cannot be sorted.
        if (proxy->m_aabbMin.x() == proxy->m_aabbMin.x()) {
            proxies.push_back(proxy);
        }
    }
    std::ranges::sort(proxies, {}, [](BulletProxy proxy) { return proxy->m_aabbMin.x(); });
    RawPairs pairs;
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        for (std::size_t j = i + 1;
             j < proxies.size() && proxies[j]->m_aabbMin.x() <= proxies[i]->m_aabbMax.x(); ++j) {
            if (overlaps(*proxies[i], *proxies[j])) {
                pairs.push_back(rawPairOf(proxies[i], proxies[j]));
            }
        }
    }
    std::ranges::sort(pairs);
    return pairs;
}

std::uint64_t VerifiedBroadphase::changeOf(const RawPair& pair) const {
    std::uint64_t last = 0;
    for (BulletProxy proxy : {pair.first, pair.second}) {
        if (const auto twin = twins_.find(proxy); twin != twins_.end()) {
            last = std::max(last, twin->second.changed);
        }
    }
    return last;
}

// Pairs that the last calculation left in the cache and that are no longer there were removed; those of
// proxies that were destroyed have gone from last_ with them.
void VerifiedBroadphase::lookAtCache() {
    before_ = ours();
    const RawPairs gone = difference(last_, before_);
    removed_.insert(removed_.end(), gone.begin(), gone.end());
    std::ranges::sort(removed_);
}

void VerifiedBroadphase::judgeMissing(const RawPairs& exact, const RawPairs& ours,
                                      Verification& verification) {
    RawPairs missing;
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
}

Verification VerifiedBroadphase::compare() {
    const auto isLate = [this](const RawPair& pair) { return changeOf(pair) > calculation_; };
    Verification verification;
    verification.calculations = 1;
    RawPairs exact = findOverlapping();
    RawPairs ours = this->ours();
    RawPairs stock = stock_.pairs();
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
    judgeMissing(exact, ours, verification);

    verification.stockPairs = stock.size();
    verification.stockExtra = difference(stock, exact).size();
    for (const RawPair& pair : difference(exact, stock)) {
        if (changeOf(pair) == calculation_ && isAccepted(pair)) {
            ++verification.stockMissing;
        }
    }
    return verification;
}

}  // namespace

std::unique_ptr<btBroadphaseInterface> makeVerifiedBroadphase(const btDbvtBroadphase& settings,
                                                              btOverlappingPairCache* cache) {
    return std::make_unique<VerifiedBroadphase>(settings, cache);
}

}  // namespace hashphase::tryout
