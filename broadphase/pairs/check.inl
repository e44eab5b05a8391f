// SPDX-License-Identifier: Zlib
#pragma once

// The whole set of pairs, found from scratch: for those who ask for it, and to check what is kept.

#include <broadphase/pairs/watched.inl>

#include <algorithm>
#include <string>

namespace hashphase::detail {

template <class Scalar>
void collect(const PairState<Scalar>& pairs, std::vector<ProxyPair>& all) {
    const auto begin = static_cast<std::ptrdiff_t>(all.size());
    const KnownPairs& known = pairs.known;
    const auto add = [&](PairKey key) {
        if (!known.isRefused(key)) {
            all.push_back(pairs.pairOf(key));
        }
    };
    if (known.arePairs()) {
        const std::span<const PairKey> keys = known.pile->pairs.keys();
        std::for_each(keys.begin(), keys.end(), add);
    } else {
        forEachOverlap(pairs, [&](std::uint32_t a, std::uint32_t b) { add(pairKey(a, b)); });
        std::for_each(known.kept.keys().begin(), known.kept.keys().end(), add);
        std::for_each(known.swept.atUpdate.begin(), known.swept.atUpdate.end(), add);
    }
    std::sort(all.begin() + begin, all.end());
}

// Compares what is watched with what overlaps, and counts the latter.
template <class Scalar>
[[nodiscard]] bool areWatchedAll(const PairState<Scalar>& pairs, std::size_t& overlapCount) {
    std::vector<PairKey> watched;
    forEachWatched(pairs, [&](PairKey key) { watched.push_back(key); });
    std::sort(watched.begin(), watched.end());
    std::vector<PairKey> expected;
    forEachOverlap(pairs, [&](std::uint32_t a, std::uint32_t b) {
        ++overlapCount;
        if (!pairs.areAtRest(pairKey(a, b))) {
            expected.push_back(pairKey(a, b));
        }
    });
    std::sort(expected.begin(), expected.end());
    return watched == expected;
}

// Compares what is said of the settled ones with their boxes.
template <class Scalar>
[[nodiscard]] bool areSettledRight(const PairState<Scalar>& pairs) {
    const auto haveSlack = [&](PairKey key) {
        return pairs.areAtRest(key) && !pairs.areStill(key);
    };
    const Table<Scalar>& table = pairs.tables.resting;
    const SettledPairs* const settled = pairs.watched.settled.get();
    std::vector<PairKey> listed;
    for (std::size_t i = 0; settled != nullptr && i < settled->pairs.size(); ++i) {
        const auto [a, b] = settled->pairs.pairs()[i];
        const PairKey key = pairKey(table.proxyIndex(a), table.proxyIndex(b));
        if (settled->overlapped[i] != 0 && haveSlack(key)) {
            listed.push_back(key);
        }
    }
    std::sort(listed.begin(), listed.end());
    std::vector<PairKey> expected;
    forEachOverlap(pairs, [&](std::uint32_t a, std::uint32_t b) {
        if (haveSlack(pairKey(a, b))) {
            expected.push_back(pairKey(a, b));
        }
    });
    std::sort(expected.begin(), expected.end());
    return listed == expected;
}

template <class Scalar>
[[nodiscard]] std::string validateRemembered(const PairState<Scalar>& pairs) {
    const std::span<const PairKey> keys = pairs.known.pile->pairs.keys();
    const auto meet = [&](PairKey key) {
        return pairs.overlapNow(key) || pairs.known.swept.contains(key);
    };
    return pairs.known.count == keys.size() && std::all_of(keys.begin(), keys.end(), meet)
               ? std::string()
               : "While the pairs are remembered, count() is their number, and each overlaps "
                 "or is swept: broken.";
}

template <class Scalar>
[[nodiscard]] bool areIgnoredNoPairs(const PairState<Scalar>& pairs) {
    const KnownPairs& known = pairs.known;
    const auto isNoPair = [&](const ProxyPair& pair) {
        const PairKey key = pairKey(pair.first.index, pair.second.index);
        return !pairs.areAlive(pair) || known.isRefused(key) || !pairs.isKnown(key);
    };
    return known.ignored == nullptr || std::ranges::all_of(known.ignored->pairs(), isNoPair);
}

/// See Pairs::validate().
template <class Scalar>
[[nodiscard]] std::string validate(const PairState<Scalar>& pairs) {
    const KnownPairs& known = pairs.known;
    const std::vector<PairKey>& swept = known.swept.atUpdate;
    if (!areIgnoredNoPairs(pairs)) {
        return "No pair that is ignored is a pair: broken.";
    }
    if (known.arePairs()) {
        return validateRemembered(pairs);
    }
    std::size_t overlapping = 0;
    if (!areWatchedAll(pairs, overlapping) && !pairs.store.mustRebuildPairs) {
        return "The watched candidates are the overlapping ones that may pair and of which one is "
               "mobile, each once: broken.";
    }
    if (!pairs.store.mustRebuildPairs && !areSettledRight(pairs)) {
        return "The candidates of settled proxies that overlap are listed so, each once: broken.";
    }
    if (known.count + known.refusedCount() != overlapping + swept.size() + known.kept.size()) {
        return "count() is the number of overlapping and swept candidates that may pair, less the "
               "refused ones, and of the pairs that are kept: broken.";
    }
    const auto isKept = [&](PairKey key) {
        return pairs.overlapNow(key) && !pairs.mayPairNow(key);
    };
    if (!std::all_of(known.kept.keys().begin(), known.kept.keys().end(), isKept)) {
        return "The pairs that are kept overlap and may not pair: broken.";
    }
    const auto sweeps = [&](std::uint32_t proxyIndex) {
        return pairs.proxies.records[proxyIndex].residency == Residency::sweeping;
    };
    const bool oneSweeps = std::all_of(swept.begin(), swept.end(), [&](PairKey key) {
        return sweeps(firstIndex(key)) || sweeps(secondIndex(key));
    });
    return oneSweeps ? std::string() : "Of each swept candidate one sweeps: broken.";
}

}  // namespace hashphase::detail
