// SPDX-License-Identifier: Zlib
#include <tests/integration/bullet/pair_journal.hpp>

#include <algorithm>

namespace hashphase::test {
namespace {

PairJournal::Uids uidsOf(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
    return std::minmax({a.m_uniqueId, b.m_uniqueId});
}

}  // namespace

PairJournal::Uids PairJournal::note(const btBroadphaseProxy& a, const btBroadphaseProxy& b,
                                    const char* what) {
    const Uids uids = uidsOf(a, b);
    for (const btBroadphaseProxy* const proxy : {&a, &b}) {
        const auto* const client = static_cast<const Client*>(proxy->m_clientObject);
        if (client == nullptr || !client->isAlive) {
            errors_.push_back("A pair was " + std::string(what) + " whose client " +
                              std::to_string(proxy->m_uniqueId) + " is not alive.");
        }
    }
    touched_.insert(uids);
    return uids;
}

btBroadphasePair* PairJournal::addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) {
    const Uids uids = note(*a, *b, "added");
    if (!alive_.insert(uids).second) {
        errors_.push_back("Pair " + std::to_string(uids.first) + ", " +
                          std::to_string(uids.second) + " was added twice.");
    }
    return nullptr;
}

void* PairJournal::removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                         btDispatcher* /*dispatcher*/) {
    const Uids uids = note(*a, *b, "removed");
    if (alive_.erase(uids) == 0) {
        errors_.push_back("Pair " + std::to_string(uids.first) + ", " +
                          std::to_string(uids.second) + " was removed, but had not been added.");
    }
    return nullptr;
}

void PairJournal::removeOverlappingPairsContainingProxy(btBroadphaseProxy* /*proxy*/,
                                                        btDispatcher* /*dispatcher*/) {
    errors_.push_back("Pairs were not removed one by one, which Bullet's ghosts cannot bear.");
}

std::set<PairJournal::Uids> uidPairs(btOverlappingPairCache& cache) {
    std::set<PairJournal::Uids> pairs;
    const btBroadphasePairArray& array = cache.getOverlappingPairArray();
    for (int i = 0; i < array.size(); ++i) {
        pairs.insert(uidsOf(*array[i].m_pProxy0, *array[i].m_pProxy1));
    }
    return pairs;
}

}  // namespace hashphase::test
