// SPDX-License-Identifier: Zlib
#include <tests/integration/bullet/pair_journal.hpp>

#include <tests/integration/bullet/player.hpp>

namespace hashphase::test {
namespace {

std::string textOf(const Uids& uids) {
    return "Pair " + std::to_string(uids.first) + ", " + std::to_string(uids.second);
}

}  // namespace

Uids PairJournal::note(const btBroadphaseProxy& a, const btBroadphaseProxy& b, const char* what) {
    for (const btBroadphaseProxy* const proxy : {&a, &b}) {
        const auto* const client = static_cast<const Client*>(proxy->m_clientObject);
        if (client == nullptr || !client->isAlive) {
            errors_.push_back("A pair was " + std::string(what) + " whose client " +
                              std::to_string(proxy->m_uniqueId) + " is not alive.");
        }
    }
    return *touched_.insert(uidsOf(a, b)).first;
}

btBroadphasePair* PairJournal::addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) {
    const Uids uids = note(*a, *b, "added");
    if (!alive_.insert(uids).second) {
        errors_.push_back(textOf(uids) + " was added twice.");
    }
    return nullptr;
}

void* PairJournal::removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                         btDispatcher* /*dispatcher*/) {
    const Uids uids = note(*a, *b, "removed");
    if (alive_.erase(uids) == 0) {
        errors_.push_back(textOf(uids) + " was removed, but had not been added.");
    }
    return nullptr;
}

void PairJournal::removeOverlappingPairsContainingProxy(btBroadphaseProxy* /*proxy*/,
                                                        btDispatcher* /*dispatcher*/) {
    errors_.push_back("Pairs were not removed one by one, which Bullet's ghosts cannot bear.");
}

std::set<Uids> uidPairs(btOverlappingPairCache& cache) {
    std::set<Uids> pairs;
    for (const auto& [a, b] : uidList(cache)) {
        pairs.insert(std::minmax({a, b}));
    }
    return pairs;
}

std::vector<Uids> uidList(btOverlappingPairCache& cache) {
    std::vector<Uids> pairs;
    const btBroadphasePairArray& array = cache.getOverlappingPairArray();
    for (int i = 0; i < array.size(); ++i) {
        pairs.emplace_back(array[i].m_pProxy0->m_uniqueId, array[i].m_pProxy1->m_uniqueId);
    }
    return pairs;
}

}  // namespace hashphase::test
