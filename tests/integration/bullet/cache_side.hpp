// SPDX-License-Identifier: Zlib
#pragma once

// A pair cache by itself, with proxies and a dispatcher, and what it has freed and told.

#include <tests/integration/bullet/callbacks.hpp>

#include <integration/bullet/pair_cache.hpp>

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <vector>

namespace hashphase::test {

/// Does nothing but write down when it is freed, and act then where that is asked for.
struct NotedAlgorithm : btCollisionAlgorithm {
    using Act = std::function<void(const Uids&)>;

    NotedAlgorithm(Uids of, std::vector<Uids>& list, const Act& acts)
        : uids(of), freed(list), act(acts) {}
    ~NotedAlgorithm() override {
        freed.push_back(uids);
        if (act) {
            act(uids);
        }
    }
    /// To the pair; `acts` must outlive it.
    static void giveTo(btBroadphasePair& pair, btCollisionDispatcher& dispatcher,
                       std::vector<Uids>& list, const Act& acts) {
        void* const memory = dispatcher.allocateCollisionAlgorithm(sizeof(NotedAlgorithm));
        pair.m_algorithm = new (memory) NotedAlgorithm(uidsOf(pair), list, acts);
    }
    void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                          const btDispatcherInfo&, btManifoldResult*) override {}
    btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                   btManifoldResult*) override {
        return 1;
    }
    void getAllContactManifolds(btManifoldArray&) override {}
    Uids uids;
    std::vector<Uids>& freed;
    const Act& act;
};

/// Frees an algorithm, and throws.
struct ThrowingDispatcher : btCollisionDispatcher {
    using btCollisionDispatcher::btCollisionDispatcher;
    void freeCollisionAlgorithm(void* memory) override {
        btCollisionDispatcher::freeCollisionAlgorithm(memory);
        throw std::runtime_error("freeCollisionAlgorithm");
    }
};

struct CacheSide {
    static constexpr std::size_t kProxies = 120;

    /// The proxies' unique ids are their numbers here.
    explicit CacheSide(PairOrder order = PairOrder::arrival, ProxyKey key = &PairCache::uniqueId)
        : cache(order, key) {
        for (std::size_t i = 0; i < kProxies; ++i) {
            proxies[i].m_uniqueId = static_cast<int>(i);
            proxies[i].m_collisionFilterGroup = btBroadphaseProxy::DefaultFilter;
            proxies[i].m_collisionFilterMask = btBroadphaseProxy::AllFilter;
        }
    }
    ~CacheSide() {
        onFreed = nullptr;
        cache.setInternalGhostPairCallback(nullptr);
        for (btBroadphaseProxy& proxy : proxies) {
            cache.removeOverlappingPairsContainingProxy(&proxy, &dispatcher);
        }
    }
    CacheSide(const CacheSide&) = delete;
    CacheSide& operator=(const CacheSide&) = delete;

    [[nodiscard]] btBroadphaseProxy* proxy(int i) { return &proxies[std::size_t(i)]; }
    btBroadphasePair* add(int a, int b) { return cache.addOverlappingPair(proxy(a), proxy(b)); }
    btBroadphasePair* find(int a, int b) { return cache.findPair(proxy(a), proxy(b)); }
    void remove(int a, int b) { cache.removeOverlappingPair(proxy(a), proxy(b), &dispatcher); }

    /// Every proxy with the next three.
    void addBand() {
        for (int i = 0; i < int(kProxies); ++i) {
            for (int k = i + 1; k < std::min(i + 4, int(kProxies)); ++k) {
                add(i, k);
            }
        }
    }

    void giveAlgorithm(btBroadphasePair& pair) {
        NotedAlgorithm::giveTo(pair, dispatcher, freed, onFreed);
    }
    /// To all pairs that have none, but for those of which `isLeft` is true.
    template <class IsLeft>
    void giveAlgorithms(const IsLeft& isLeft) {
        btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
        for (int i = 0; i < pairs.size(); ++i) {
            if (pairs[i].m_algorithm == nullptr && !isLeft(uidsOf(pairs[i]))) {
                giveAlgorithm(pairs[i]);
            }
        }
    }
    void giveAlgorithms() {
        giveAlgorithms([](const Uids&) { return false; });
    }

    [[nodiscard]] std::vector<BulletProxyPair> pairs(const std::vector<Uids>& of) {
        std::vector<BulletProxyPair> list;
        for (const auto& [a, b] : of) {
            list.emplace_back(*proxy(a), *proxy(b));
        }
        return list;
    }
    void update(const std::vector<Uids>& died, const std::vector<Uids>& born) {
        cache.update(pairs(died), pairs(born), &dispatcher);
    }
    void updateSingly(const std::vector<Uids>& died, const std::vector<Uids>& born) {
        for (const auto& [a, b] : died) {
            remove(b, a);
        }
        for (const auto& [a, b] : born) {
            cache.addAcceptedPair(proxy(b), proxy(a));
        }
    }

    [[nodiscard]] std::vector<Uids> list() { return uidList(cache); }

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    std::vector<Uids> freed;
    NotedAlgorithm::Act onFreed;
    PairJournal ghosts;  // to be set as the callback
    std::array<btBroadphaseProxy, kProxies> proxies;
    PairCache cache;
};

[[nodiscard]] inline std::vector<Uids> inOrder(std::vector<Uids> pairs) {
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace hashphase::test
