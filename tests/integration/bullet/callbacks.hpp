// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's callbacks, each of which does what a function says and notes what it was called for.

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <algorithm>
#include <concepts>
#include <functional>
#include <set>
#include <string>
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

/// A ghost callback that keeps the books, whose words must balance, and that may act on what it is told.
/// Pairs are those of unique ids.
struct PairJournal : btOverlappingPairCallback {
    struct Told {
        bool isBorn;
        int first;
        int second;
        bool operator==(const Told&) const = default;
    };
    using Act = std::function<void(btBroadphaseProxy*, btBroadphaseProxy*)>;

    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
        note(true, a, b, alive.insert(uidsOf(*a, *b)).second, onBirth);
        return nullptr;
    }
    void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                btDispatcher* /*dispatcher*/) override {
        note(false, a, b, alive.erase(uidsOf(*a, *b)) == 1, onDeath);
        return nullptr;
    }
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy* /*proxy*/,
                                               btDispatcher* /*dispatcher*/) override {
        errors.emplace_back(
            "Pairs were not removed one by one, which Bullet's ghosts cannot bear.");
    }

    /// The pairs that something was told of since the last call.
    std::set<Uids> takeTouched() {
        std::set<Uids> touched;
        for (const Told& told : std::exchange(all, {})) {
            touched.insert(std::minmax({told.first, told.second}));
        }
        return touched;
    }

    std::vector<Told> all;
    std::set<Uids> alive;  // told of, and not yet taken back
    /// A sentence for everything that was not right: added twice, removed without being there, removed
    /// wholesale, or with a client that is no longer alive.
    std::vector<std::string> errors;
    Act onBirth;
    Act onDeath;
    std::function<bool(const btBroadphaseProxy&)> hasLivingClient;  // where that is to be checked

private:
    void note(bool isBorn, btBroadphaseProxy* a, btBroadphaseProxy* b, bool isNews,
              const Act& act) {
        all.push_back({isBorn, a->m_uniqueId, b->m_uniqueId});
        const auto complain = [&](const char* what) {
            errors.push_back("Pair " + std::to_string(a->m_uniqueId) + ", " +
                             std::to_string(b->m_uniqueId) +
                             (isBorn ? " was added " : " was removed ") + what);
        };
        if (!isNews) {
            complain(isBorn ? "twice." : "but had not been added.");
        }
        if (hasLivingClient && (!hasLivingClient(*a) || !hasLivingClient(*b))) {
            complain("with a client that is not alive.");
        }
        if (act) {
            act(a, b);
        }
    }
};

/// The pairs of a cache in the order of its array, and of the two in each pair.
[[nodiscard]] inline std::vector<Uids> uidList(btOverlappingPairCache& cache) {
    std::vector<Uids> pairs;
    const btBroadphasePairArray& array = cache.getOverlappingPairArray();
    for (int i = 0; i < array.size(); ++i) {
        pairs.emplace_back(array[i].m_pProxy0->m_uniqueId, array[i].m_pProxy1->m_uniqueId);
    }
    return pairs;
}

/// The same as a journal has them.
[[nodiscard]] inline std::set<Uids> uidPairs(btOverlappingPairCache& cache) {
    std::set<Uids> pairs;
    for (const auto& [a, b] : uidList(cache)) {
        pairs.insert(std::minmax({a, b}));
    }
    return pairs;
}

}  // namespace hashphase::test
