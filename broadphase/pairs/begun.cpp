// SPDX-License-Identifier: Zlib

// Which candidates have come to overlap: two proxies that overlap, and may pair by their groups.

#include <broadphase/pairs/pair_tracker.hpp>

#include <broadphase/core/prefetch.hpp>
#include <broadphase/search/join.hpp>

#include <algorithm>

namespace hashphase::detail {
namespace {

// Where only a few share a cell, what may not pair is sooner taken out of what a search has found, where
// it is little, than left out by the search, which has to look at the groups of all.
template <class Scalar>
bool isCrowded(const Table<Scalar>& table) {
    constexpr std::uint32_t kFew = 32;
    return mostTogether(table) > kFew;
}

template <class IsOut>
void takeOut(PairList& pairs, const IsOut& isOut) {
    IndexPair* const begin = pairs.resize(pairs.size());
    IndexPair* const end = std::remove_if(begin, begin + pairs.size(), isOut);
    static_cast<void>(pairs.resize(static_cast<std::size_t>(end - begin)));
}

}  // namespace

// A candidate is born when its boxes overlap now and did not at the last update.
template <class Scalar>
bool PairTracker<Scalar>::findBegun(bool someSettled, PairFilter filter, ParallelFor parallelFor) {
    if (remembersPairs()) {
        findBegunOfPairs(filter, parallelFor);
        return true;
    }
    if (doesRefuseMost(filter)) {
        return false;
    }
    const auto order = tables_.mobile.order();
    entryOf_.resize(proxies_.mobile.size());
    for (std::uint32_t entry = 0; entry < order.size(); ++entry) {
        entryOf_[order[entry]] = entry;
    }
    carryToRest(someSettled);
    joinMobile(parallelFor);
    findAgainstResting(parallelFor);
    if (proxies_.areRegrouped) {
        askAboutRegrouped();
    }
    if (immediate_.size() > 0) {
        std::erase_if(asked_, [this](PairKey c) { return immediate_.contains(c); });
    }
    findSwept(parallelFor);
    askRefusedAgain();
    return true;
}

// Candidates of a mobile one that has not changed and a resting one are not looked for again.
template <class Scalar>
void PairTracker<Scalar>::carryToRest(bool someSettled) {
    carried_.clear();
    if (tables_.resting.size() == 0) {
        return;
    }
    const auto isKept = [this](std::uint32_t mobile, std::uint32_t resting) {
        return proxies_.records[resting].residency == Residency::resting &&
               proxies_.records[mobile].residency == Residency::mobile &&
               !proxies_.changedNow(mobile);
    };
    for (const auto [place, proxyIndex] : toResting_.pairs()) {
        if (isKept(proxies_.mobile[place], proxyIndex)) {
            carried_.push({entryOf_[place], proxyIndex});
        }
    }
    if (!someSettled) {
        return;
    }
    for (const auto [a, b] : amongMobile_.pairs()) {
        const std::uint32_t indexA = proxies_.mobile[a];
        const std::uint32_t indexB = proxies_.mobile[b];
        if (isKept(indexA, indexB)) {
            carried_.push({entryOf_[a], indexB});
        } else if (isKept(indexB, indexA)) {
            carried_.push({entryOf_[b], indexA});
        }
    }
}

template <class Scalar>
void PairTracker<Scalar>::joinMobile(ParallelFor parallelFor) {
    const Table<Scalar>& table = tables_.mobile;
    KernelCost cost;
    amongMobile_.clear();
    const GroupKinds::Set kinds = frame_.mobileKinds;
    const bool someRefuse = proxies_.groupKinds.refuse(kinds, kinds);
    const bool areToldApart = someRefuse && isCrowded(table);
    joinTable(table, parallelFor, parts_, amongMobile_, cost,
              areToldApart ? proxies_.groups.data() : nullptr, proxies_.groupKinds.together(kinds));
    if (someRefuse && !areToldApart) {
        takeOut(amongMobile_, [&](const IndexPair& pair) {
            return proxies_.doRefuse(table.proxyIndex(pair.a), table.proxyIndex(pair.b));
        });
    }
    cost_.boxesTested += cost.boxesTested;
    const auto fresh =
        selectApart(amongMobile_.pairs(), table.order().data(), frame_.before.data(), parallelFor);
    for (const auto [a, b] : fresh) {
        asked_.push_back(pairKey(table.proxyIndex(a), table.proxyIndex(b)));
    }
}

// Those candidates of which the boxes, numbered order[a] and order[b], do not overlap; valid until the
// next call.
template <class Scalar>
std::span<const IndexPair> PairTracker<Scalar>::selectApart(std::span<const IndexPair> candidates,
                                                            const std::uint32_t* order,
                                                            const PaddedBox<Scalar>* boxes,
                                                            ParallelFor parallelFor) {
    constexpr std::size_t kGrain = 8192;
    selected_.clear();
    KernelCost none;
    const auto select = [&](std::size_t first, std::size_t last, PairSink& sink, KernelCost&) {
        detail::makeRoom(sink, last - first);
        sink.next += kernels<Scalar>().selectApart(candidates.data() + first, last - first, order,
                                                   boxes, sink.next);
    };
    parts_.collect(parallelFor, candidates.size(), kGrain, selected_, none, select);
    return selected_.pairs();
}

// What changed against the resting proxies.
template <class Scalar>
void PairTracker<Scalar>::findAgainstResting(ParallelFor parallelFor) {
    toResting_.swap(carried_);
    if (tables_.resting.size() == 0) {
        return;
    }
    queryResting(parallelFor);
    const Table<Scalar>& table = tables_.mobile;
    const bool isShifted = !proxies_.boxesAtUpdate.empty();
    for (const auto [changed, restingEntry] : selected_.pairs()) {
        const std::uint32_t entry = changedEntries_[changed];
        const std::uint32_t proxyIndex = tables_.resting.proxyIndex(restingEntry);
        toResting_.push({entry, proxyIndex});
        // Not by their indices: these boxes are at hand.
        const PaddedBox<Scalar>& before = frame_.before[table.order()[entry]];
        const Box resting =
            isShifted ? proxies_.boxAtUpdate(proxyIndex) : tables_.resting.box(restingEntry);
        if (!overlaps(unpadded(before), resting)) {
            asked_.push_back(pairKey(table.proxyIndex(entry), proxyIndex));
        }
    }
}

// Sets selected_ to all that overlap and may pair: a place in changedEntries_ and an entry at rest.
template <class Scalar>
void PairTracker<Scalar>::queryResting(ParallelFor parallelFor) {
    const Table<Scalar>& resting = tables_.resting;
    const bool someRefuse = proxies_.groupKinds.refuse(frame_.changedKinds, tables_.restingKinds);
    const bool areToldApart = someRefuse && isCrowded(resting);
    listChanged(areToldApart);
    const GroupsView view{proxies_.groups.data(), searchedIndices_.data(),
                          proxies_.groupKinds.together(tables_.restingKinds)};
    KernelCost cost;
    selected_.clear();
    queryTable(resting, bounds_.columns(), bounds_.size(), parallelFor, parts_, selected_, cost,
               areToldApart ? &view : nullptr);
    cost_.boxesTested += cost.boxesTested;
    if (someRefuse && !areToldApart) {
        takeOut(selected_, [&](const IndexPair& pair) {
            return proxies_.doRefuse(tables_.mobile.proxyIndex(changedEntries_[pair.a]),
                                     resting.proxyIndex(pair.b));
        });
    }
}

// Sets changedEntries_ and bounds_ to the entries of the mobile table that have changed; with indices,
// searchedIndices_ as well.
template <class Scalar>
void PairTracker<Scalar>::listChanged(bool withIndices) {
    const Table<Scalar>& table = tables_.mobile;
    changedEntries_.clear();
    searchedIndices_.clear();
    bounds_.clear();
    for (std::uint32_t entry = 0; entry < table.size(); ++entry) {
        const std::uint32_t proxyIndex = table.proxyIndex(entry);
        if (proxies_.changedNow(proxyIndex)) {
            changedEntries_.push_back(entry);
            bounds_.push(table.box(entry));
            if (withIndices) {
                searchedIndices_.push_back(proxyIndex);
            }
        }
    }
}

template bool PairTracker<float>::findBegun(bool, PairFilter, ParallelFor);
template void PairTracker<float>::carryToRest(bool);
template void PairTracker<float>::joinMobile(ParallelFor);
template void PairTracker<float>::findAgainstResting(ParallelFor);
template void PairTracker<float>::queryResting(ParallelFor);
template void PairTracker<float>::listChanged(bool);
template std::span<const IndexPair> PairTracker<float>::selectApart(std::span<const IndexPair>,
                                                                    const std::uint32_t*,
                                                                    const PaddedBox<float>*,
                                                                    ParallelFor);
template bool PairTracker<double>::findBegun(bool, PairFilter, ParallelFor);
template void PairTracker<double>::carryToRest(bool);
template void PairTracker<double>::joinMobile(ParallelFor);
template void PairTracker<double>::findAgainstResting(ParallelFor);
template void PairTracker<double>::queryResting(ParallelFor);
template void PairTracker<double>::listChanged(bool);
template std::span<const IndexPair> PairTracker<double>::selectApart(std::span<const IndexPair>,
                                                                     const std::uint32_t*,
                                                                     const PaddedBox<double>*,
                                                                     ParallelFor);

}  // namespace hashphase::detail
