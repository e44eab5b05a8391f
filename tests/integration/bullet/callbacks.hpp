// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's callbacks, each of which does what a function says and notes what it was called for.

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <algorithm>
#include <concepts>
#include <functional>
#include <utility>
#include <vector>

namespace hashphase::test {

/// Unique ids of a pair.
using Uids = std::pair<int, int>;

/// The lower one first.
[[nodiscard]] inline Uids uidsOf(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
    return std::minmax({a.m_uniqueId, b.m_uniqueId});
}
[[nodiscard]] inline Uids uidsOf(const btBroadphasePair& pair) {
    return uidsOf(*pair.m_pProxy0, *pair.m_pProxy1);
}

/// A filter that counts how often it is asked.
struct FilterBy : btOverlapFilterCallback {
    using Decide = std::function<bool(btBroadphaseProxy&, btBroadphaseProxy&)>;

    explicit FilterBy(Decide decides) : decide(std::move(decides)) {}
    /// Answers this to everything.
    template <std::same_as<bool> Answer>
    explicit FilterBy(Answer toAll) : answer(toAll) {}

    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
        ++asked;
        return decide ? decide(*a, *b) : answer;
    }

    Decide decide;
    bool answer = true;
    mutable std::size_t asked = 0;
};

/// Is shown pairs, of which those are removed for which the function returns true.
struct ProcessBy : btOverlapCallback {
    explicit ProcessBy(std::function<bool(btBroadphasePair&)> of) : function(std::move(of)) {}
    bool processOverlap(btBroadphasePair& pair) override {
        shown.push_back(uidsOf(pair));
        return function(pair);
    }

    std::function<bool(btBroadphasePair&)> function;
    std::vector<Uids> shown;
};

/// A query's callback: btBroadphaseRayCallback or btBroadphaseAabbCallback.
template <class Callback>
struct ReportTo : Callback {
    using Act = std::function<void(btBroadphaseProxy*)>;

    explicit ReportTo(Act acts = [](btBroadphaseProxy*) {}) : act(std::move(acts)) {}
    bool process(const btBroadphaseProxy* proxy) override {
        found.push_back(const_cast<btBroadphaseProxy*>(proxy));
        act(found.back());
        return true;
    }

    Act act;
    std::vector<btBroadphaseProxy*> found;
};

/// A ghost callback that lists the births and deaths of pairs, and may act on them.
struct ToldPairs : btOverlappingPairCallback {
    struct Told {
        bool isBorn;
        int first;
        int second;
        bool operator==(const Told&) const = default;
    };
    using Act = std::function<void(btBroadphaseProxy*, btBroadphaseProxy*)>;

    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
        note(true, a, b, onBirth);
        return nullptr;
    }
    void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                btDispatcher* /*dispatcher*/) override {
        note(false, a, b, onDeath);
        return nullptr;
    }
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy* /*proxy*/,
                                               btDispatcher* /*dispatcher*/) override {}

    std::vector<Told> all;
    Act onBirth;
    Act onDeath;

private:
    void note(bool isBorn, btBroadphaseProxy* a, btBroadphaseProxy* b, const Act& act) {
        all.push_back({isBorn, a->m_uniqueId, b->m_uniqueId});
        if (act) {
            act(a, b);
        }
    }
};

}  // namespace hashphase::test
