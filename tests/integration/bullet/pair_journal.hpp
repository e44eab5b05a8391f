// SPDX-License-Identifier: Zlib
#pragma once

// A ghost callback that keeps the books: what it is told must balance.

#include <tests/integration/bullet/callbacks.hpp>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {

/// Set through setInternalGhostPairCallback(). Pairs are those of unique ids, lower first.
class PairJournal : public btOverlappingPairCallback {
public:
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override;
    void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                btDispatcher* dispatcher) override;
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy* proxy,
                                               btDispatcher* dispatcher) override;

    /// The pairs told of and not yet taken back.
    [[nodiscard]] const std::set<Uids>& alive() const { return alive_; }

    /// A sentence for everything that was not right: added twice, removed without being there,
    /// removed wholesale, or with a client that is no longer alive.
    [[nodiscard]] const std::vector<std::string>& errors() const { return errors_; }

    /// The pairs that something was told of since the last call.
    std::set<Uids> takeTouched() { return std::exchange(touched_, {}); }

private:
    Uids note(const btBroadphaseProxy& a, const btBroadphaseProxy& b, const char* what);

    std::set<Uids> alive_;
    std::set<Uids> touched_;
    std::vector<std::string> errors_;
};

/// The pairs of a cache, as the journal writes them.
std::set<Uids> uidPairs(btOverlappingPairCache& cache);

/// In the order of the array, and of the two in each pair.
std::vector<Uids> uidList(btOverlappingPairCache& cache);

}  // namespace hashphase::test
