// SPDX-License-Identifier: Zlib

// The whole set of pairs, found from scratch: for those who ask for it, and to check what is kept.

#include <broadphase/pairs/pair_tracker.hpp>

#include <broadphase/search/join.hpp>

#include <algorithm>

namespace hashphase::detail {

template <class Scalar>
void PairTracker<Scalar>::forEachOverlap(
    FunctionRef<void(std::uint32_t, std::uint32_t)> visit) const {
    store_.mendTables();
    const ProxyGroups* const groups = proxies_.groupsOfAll();
    KernelCost cost;
    forOverlaps(tables_.mobile, groups, cost, visit);
    forOverlaps(tables_.resting, groups, cost, visit);
    const GroupsView view{groups, tables_.mobile.proxyIndices().data(), {}};
    forOverlaps(tables_.mobile.columns(), tables_.mobile.size(), tables_.resting,
                groups != nullptr ? &view : nullptr, cost,
                [&](std::uint32_t entry, std::uint32_t resting) {
                    visit(tables_.mobile.proxyIndex(entry), resting);
                });
}

template <class Scalar>
void PairTracker<Scalar>::collect(std::vector<ProxyPair>& pairs) const {
    const auto begin = static_cast<std::ptrdiff_t>(pairs.size());
    const auto add = [&](PairKey c) {
        if (!isRefused(c)) {
            pairs.push_back(pairOf(c));
        }
    };
    if (remembersPairs()) {
        const std::span<const PairKey> candidates = pile_->pairs.keys();
        std::for_each(candidates.begin(), candidates.end(), add);
    } else {
        forEachOverlap([&](std::uint32_t a, std::uint32_t b) { add(pairKey(a, b)); });
        std::for_each(kept_.keys().begin(), kept_.keys().end(), add);
        std::for_each(swept_.begin(), swept_.end(), add);
    }
    std::sort(pairs.begin() + begin, pairs.end());
}

// Compares what is watched with what overlaps, and counts the latter.
template <class Scalar>
bool PairTracker<Scalar>::areWatchedAll(std::size_t& overlapCount) const {
    std::vector<PairKey> watched;
    for (const auto [a, b] : amongMobile_.pairs()) {
        watched.push_back(pairKey(proxies_.mobile[a], proxies_.mobile[b]));
    }
    for (const auto [place, proxyIndex] : toResting_.pairs()) {
        watched.push_back(pairKey(proxies_.mobile[place], proxyIndex));
    }
    std::sort(watched.begin(), watched.end());
    std::vector<PairKey> expected;
    forEachOverlap([&](std::uint32_t a, std::uint32_t b) {
        ++overlapCount;
        if (!isAtRest(pairKey(a, b))) {
            expected.push_back(pairKey(a, b));
        }
    });
    std::sort(expected.begin(), expected.end());
    return watched == expected;
}

template <class Scalar>
std::string PairTracker<Scalar>::validate() const {
    if (remembersPairs()) {
        const std::span<const PairKey> candidates = pile_->pairs.keys();
        const auto meet = [this](PairKey c) { return overlapNow(c) || isSwept(c); };
        return count_ == candidates.size() &&
                       std::all_of(candidates.begin(), candidates.end(), meet)
                   ? std::string()
                   : "While the pairs are remembered, count() is their number, and each overlaps "
                     "or is swept: broken.";
    }
    std::size_t overlapping = 0;
    if (!areWatchedAll(overlapping) && !store_.mustRebuildPairs) {
        return "The watched candidates are the overlapping ones that may pair and of which one is "
               "mobile, each once: broken.";
    }
    if (count_ + refusedCount() != overlapping + swept_.size() + kept_.size()) {
        return "count() is the number of overlapping and swept candidates that may pair, less the "
               "refused ones, and of the pairs that are kept: broken.";
    }
    const auto isKept = [this](PairKey c) { return overlapNow(c) && !mayPairNow(c); };
    if (!std::all_of(kept_.keys().begin(), kept_.keys().end(), isKept)) {
        return "The pairs that are kept overlap and may not pair: broken.";
    }
    const auto sweeps = [this](std::uint32_t proxyIndex) {
        return proxies_.records[proxyIndex].residency == Residency::sweeping;
    };
    const bool oneSweeps = std::all_of(swept_.begin(), swept_.end(), [&](PairKey c) {
        return sweeps(first(c)) || sweeps(second(c));
    });
    return oneSweeps ? std::string() : "Of each swept candidate one sweeps: broken.";
}

template void PairTracker<float>::forEachOverlap(
    FunctionRef<void(std::uint32_t, std::uint32_t)>) const;
template void PairTracker<double>::forEachOverlap(
    FunctionRef<void(std::uint32_t, std::uint32_t)>) const;
template void PairTracker<float>::collect(std::vector<ProxyPair>&) const;
template void PairTracker<double>::collect(std::vector<ProxyPair>&) const;
template bool PairTracker<float>::areWatchedAll(std::size_t&) const;
template std::string PairTracker<float>::validate() const;
template bool PairTracker<double>::areWatchedAll(std::size_t&) const;
template std::string PairTracker<double>::validate() const;

}  // namespace hashphase::detail
