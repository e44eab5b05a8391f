// SPDX-License-Identifier: Zlib
#pragma once

// What becomes of the candidates that have come to touch, or touch no more: who is a pair, by the filter.

#include <broadphase/pairs/pair_state.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/parallel_for_noexcept.hpp>

#include <algorithm>
#include <atomic>

namespace hashphase::detail {

// What the filter refused, and has not ended, is asked about again when one of the two has changed, and
// put aside when both have come to rest.
template <class Scalar>
void listRefusedAgain(PairState<Scalar>& pairs) {
    KnownPairs& known = pairs.known;
    std::vector<PairKey>& rested = pairs.call.setAside;
    rested.clear();
    for (const PairKey key : known.refused.keys()) {
        if (!pairs.mayPairNow(key)) {
            pairs.call.lapsed.push_back(key);
        } else if (pairs.areStill(key)) {
            rested.push_back(key);
        } else if ((pairs.proxies.changedNow(firstIndex(key)) ||
                    pairs.proxies.changedNow(secondIndex(key))) &&
                   (pairs.overlapNow(key) || known.swept.touchNow(key))) {
            pairs.listToAsk(key);
        }
    }
    for (const PairKey key : rested) {
        known.refusedAtRest.findOrInsert(key);
        known.refused.erase(key);
    }
}

// Candidates that one thread looks up at a time: their proxies are anywhere in the memory.
constexpr std::size_t kPairGrain = 2048;

// Lists those of `asked` that the filter is to be asked about.
template <class Scalar, class IsToBeAsked>
void listAskedPairs(PairState<Scalar>& pairs, ParallelFor parallelFor,
                    const IsToBeAsked& isToBeAsked) {
    const std::vector<PairKey>& asked = pairs.call.asked;
    std::vector<ProxyPair>& askedPairs = pairs.call.askedPairs;
    std::atomic<bool> areAllAsked{true};
    askedPairs.resize(asked.size());
    parallelFor(asked.size(), kPairGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const bool isAsked = isToBeAsked(asked[i]);
            askedPairs[i] = isAsked ? pairs.pairOf(asked[i]) : ProxyPair{};
            if (!isAsked) {
                areAllAsked.store(false, std::memory_order_relaxed);
            }
        }
    });
    if (!areAllAsked.load(std::memory_order_relaxed)) {
        std::erase_if(askedPairs, [](const ProxyPair& pair) { return pair.first.isNull(); });
    }
}

// Asks the filter about what is to be asked and has not been asked by this call.
template <class Scalar>
void askFilter(PairState<Scalar>& pairs, PairFilter filter, ParallelFor parallelFor = serialFor) {
    const std::vector<PairKey>& asked = pairs.call.asked;
    std::vector<char>& accepted = pairs.call.accepted;
    const std::vector<ProxyPair>& askedPairs = pairs.call.askedPairs;
    const Pile* const pile = pairs.known.pile.get();
    accepted.assign(asked.size(), 0);
    if (asked.empty()) {
        return;
    }
    pairs.sort(pairs.call.asked, parallelFor);
    pairs.sort(pairs.call.standing);
    const auto numberIfSampled = [pile](PairKey key) {
        return pile != nullptr ? pile->sampled.find(key) : FlatSet::kNone;
    };
    listAskedPairs(pairs, parallelFor, [&](PairKey key) {
        return pairs.mayAsk(key) && numberIfSampled(key) == FlatSet::kNone;
    });
    std::size_t answers = askedPairs.size();
    {
        const QueryScope scope(&pairs.store, QueryScope::Changes::forbidden);
        filter(askedPairs, std::span(accepted).first(answers));
    }
    for (std::size_t i = asked.size(); i > 0 && answers < asked.size();) {
        --i;
        const std::uint32_t number = numberIfSampled(asked[i]);
        if (number != FlatSet::kNone) {
            accepted[i] = pile->sampledAccepted[number];
        } else {
            accepted[i] = pairs.mayAsk(asked[i]) ? accepted[--answers] : char{0};
        }
    }
}

// For all that may come of the answers.
template <class Scalar>
void makeRoomForAnswers(PairState<Scalar>& pairs, PairChangeLists& lists) {
    KnownPairs& known = pairs.known;
    PairCall& call = pairs.call;
    call.refusedCount =
        static_cast<std::size_t>(std::count(call.accepted.begin(), call.accepted.end(), 0));
    if (known.arePairs()) {
        known.pile->pairs.reserve(known.pile->pairs.size() + call.asked.size());
    } else if (call.refusedCount > 0) {
        known.refused.reserve(known.refused.size() + call.refusedCount);
    }
    if (!call.immediate.empty()) {
        known.immediate.reserve(known.immediate.size() + call.immediate.size(),
                                pairs.proxies.records.size());
    }
    if (!call.keptNow.empty()) {
        known.kept.reserve(known.kept.size() + call.keptNow.size());
    }
    const std::size_t mayDie = call.ended.size() + call.standing.size();
    ensureCapacity(call.begun, call.asked.size());
    ensureCapacity(lists.born, call.asked.size());
    ensureCapacity(call.died, mayDie);
    ensureCapacity(lists.died, mayDie);
    ensureCapacity(call.sorted, mayDie);
}

// What may not pair is not noted down, unless it is known, so that it counts as refused until the next
// update, which forgets it.
template <class Scalar>
[[nodiscard]] bool isToBeRefused(const PairState<Scalar>& pairs, PairKey key) noexcept {
    const KnownPairs& known = pairs.known;
    return pairs.mayPairNow(key) || pairs.couldPair(key) || known.kept.contains(key) ||
           known.immediate.contains(key) || known.swept.contains(key);
}

// Of what was asked, the standing ones are pairs already. Candidates at rest that are refused are put
// aside by the next update. There is room for all of it.
template <class Scalar>
void applyAnswers(PairState<Scalar>& pairs) noexcept {  // NOLINT(bugprone-exception-escape)
    KnownPairs& known = pairs.known;
    const std::vector<PairKey>& standing = pairs.call.standing;
    if (known.areAllPairs() && standing.empty() && pairs.call.refusedCount == 0) {
        pairs.call.begun.insert(pairs.call.begun.end(), pairs.call.asked.begin(),
                                pairs.call.asked.end());
        known.count += pairs.call.asked.size();
        return;
    }
    std::size_t nextStanding = 0;
    for (std::size_t i = 0; i < pairs.call.asked.size(); ++i) {
        const PairKey key = pairs.call.asked[i];
        const bool wasPair = nextStanding < standing.size() && standing[nextStanding] == key;
        nextStanding += wasPair ? 1 : 0;
        if (pairs.call.accepted[i] == 0) {
            if (wasPair) {
                pairs.endPair(key);
            }
            if (!known.arePairs() && isToBeRefused(pairs, key) &&
                !known.refusedAtRest.contains(key)) {
                known.refused.findOrInsert(key);
            }
        } else if (!wasPair) {
            known.accept(key);
            pairs.call.begun.push_back(key);
        }
    }
}

template <class Scalar>
[[nodiscard]] PairChanges report(PairState<Scalar>& pairs, PairChangeLists& lists,
                                 ParallelFor parallelFor = serialFor) noexcept {
    if (pairs.call.begun.empty() && pairs.call.died.empty()) {
        lists.born.clear();
        lists.died.clear();
        return {};
    }
    const auto list = [&](const std::vector<PairKey>& keys, std::vector<ProxyPair>& reported) {
        reported.resize(keys.size());  // there is room
        parallelForNoexcept(parallelFor, keys.size(), kPairGrain,
                            [&](std::size_t begin, std::size_t end) {
                                for (std::size_t i = begin; i < end; ++i) {
                                    reported[i] = pairs.pairOf(keys[i]);
                                }
                            });
    };
    if (!std::ranges::is_sorted(pairs.call.died)) {
        pairs.sort(pairs.call.died);
    }
    list(pairs.call.begun, lists.born);  // as sorted as what was asked
    list(pairs.call.died, lists.died);
    return {lists.born, lists.died};
}

}  // namespace hashphase::detail
