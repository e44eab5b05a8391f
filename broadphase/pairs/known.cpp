// SPDX-License-Identifier: Zlib

// Which candidates overlapped at the last update, or have been found since, and which have come to
// overlap: of one proxy, or of all.

#include <broadphase/pairs/pair_tracker.hpp>

#include <broadphase/search/box_search.hpp>
#include <broadphase/search/join.hpp>

#include <algorithm>

namespace hashphase::detail {

// Afterwards tableOfUpdate_ has all but `mostUnindexed` of the proxies that are mobile now, and that
// were there at the last update. Each time that it is filed for more of them it has a quarter more, so
// that this costs each of them little.
template <class Scalar>
void PairTracker<Scalar>::indexLastUpdate(std::size_t mostUnindexed) {
    const bool isStale =
        shiftOfUpdate_ != store_.shiftCount ||
        (tableOfUpdate_ == &tables_.mobile && filingOfUpdate_ != tables_.filingCount);
    if (isStale) {
        tableOfUpdate_ = nullptr;
    }
    if (tableOfUpdate_ != nullptr && proxies_.woken.size() - indexedWoken_ <= mostUnindexed) {
        return;
    }
    // What has come since the last update had no box then.
    const auto listed = proxies_.mobile.begin();
    std::vector<std::uint32_t>& proxyIndices = searchedIndices_;
    proxyIndices.assign(listed, listed + static_cast<std::ptrdiff_t>(proxies_.mobileAtUpdate));
    proxyIndices.insert(proxyIndices.end(), proxies_.woken.begin(), proxies_.woken.end());
    wokenBoxes_.clear();
    for (const std::uint32_t proxyIndex : proxyIndices) {
        wokenBoxes_.push_back(padded(proxies_.boxAtUpdate(proxyIndex)));
    }
    tableOfUpdate_ = nullptr;
    wokenTable().build(proxyIndices, wokenBoxes_, store_.fixedSizes(), serialFor,
                       proxies_.groupsOfAllAtUpdate());
    tableOfUpdate_ = wokenTable_.get();
    indexedWoken_ = proxies_.woken.size();
    shiftOfUpdate_ = store_.shiftCount;
}

// Calls visit for each of the proxy's candidates that overlapped at the last update, or met on their ways
// then, or were found since.
template <class Scalar>
void PairTracker<Scalar>::forKnownPairs(std::uint32_t proxyIndex, VisitPair visit) {
    forOverlapsAtUpdate(proxyIndex, visit);
    immediate_.forEachOf(proxyIndex, visit);
    forSwept(proxyIndex, visit);
}

template <class Scalar>
void PairTracker<Scalar>::forOverlapsAtUpdate(std::uint32_t proxyIndex, VisitPair visit) {
    constexpr std::size_t kFew = 64;
    indexLastUpdate(kFew + (proxies_.mobileAtUpdate + indexedWoken_) / 4);
    const auto visitIfTheyDid = [&](std::uint32_t other) {
        if (other != proxyIndex && wasKnown(proxyIndex, other)) {
            visit(pairKey(proxyIndex, other));
        }
    };
    const bool isOwn = tableOfUpdate_ == wokenTable_.get();  // in the coordinates of then
    const Box& before = proxies_.before(proxyIndex);
    forTouching(*tableOfUpdate_, isOwn ? proxies_.boxAtUpdate(proxyIndex) : before, visitIfTheyDid);
    forTouching(tables_.resting, before, visitIfTheyDid);
    for (std::size_t i = indexedWoken_; i < proxies_.woken.size(); ++i) {
        visitIfTheyDid(proxies_.woken[i]);
    }
}

template <class Scalar>
void PairTracker<Scalar>::forSwept(std::uint32_t proxyIndex, VisitPair visit) {
    if (swept_.empty()) {
        return;
    }
    if (sweptBySecond_.empty()) {
        std::vector<PairKey> turned(swept_.size());
        std::transform(swept_.begin(), swept_.end(), turned.begin(),
                       [](PairKey c) { return c << 32 | c >> 32; });
        sortPairs(turned);
        sweptBySecond_.swap(turned);
    }
    for (const auto* candidates : {&swept_, &sweptBySecond_}) {
        auto at =
            std::lower_bound(candidates->begin(), candidates->end(), PairKey{proxyIndex} << 32);
        for (; at != candidates->end() && *at >> 32 == proxyIndex; ++at) {
            visit(pairKey(first(*at), second(*at)));
        }
    }
}

// forKnownPairs() of all; some twice, where they are immediate or kept.
template <class Scalar>
void PairTracker<Scalar>::forAllKnown(VisitPair visit) {
    indexLastUpdate(0);
    const ProxyGroups* const groups = proxies_.groupsOfAllAtUpdate();
    const auto visitIfTheyDid = [&](std::uint32_t a, std::uint32_t b) {
        if (wasKnown(a, b)) {
            visit(pairKey(a, b));
        }
    };
    KernelCost cost;
    forOverlaps(*tableOfUpdate_, groups, cost, visitIfTheyDid);
    forOverlaps(tables_.resting, groups, cost, visitIfTheyDid);
    bounds_.clear();
    for (const std::uint32_t proxyIndex : tableOfUpdate_->proxyIndices()) {
        bounds_.push(proxies_.before(proxyIndex));
    }
    const GroupsView view{groups, tableOfUpdate_->proxyIndices().data(), {}};
    forOverlaps(bounds_.columns(), bounds_.size(), tables_.resting,
                groups != nullptr ? &view : nullptr, cost,
                [&](std::uint32_t entry, std::uint32_t resting) {
                    visitIfTheyDid(tableOfUpdate_->proxyIndex(entry), resting);
                });
    for (const std::span<const PairKey> candidates :
         {immediate_.keys(), kept_.keys(), std::span<const PairKey>(swept_)}) {
        std::for_each(candidates.begin(), candidates.end(), visit);
    }
    const std::span<const PairKey> pairs =
        remembersPairs() ? pile_->pairs.keys() : std::span<const PairKey>();
    for (const PairKey c : pairs) {  // that are kept
        if (!couldPair(c) && !immediate_.contains(c) && !isSwept(c)) {
            visit(c);
        }
    }
}

// The proxy's candidates that overlap now, did not at the last update, and were not found since; those
// with others that are wanted.
template <class Scalar>
void PairTracker<Scalar>::findNewCandidates(std::uint32_t proxyIndex,
                                            FunctionRef<bool(std::uint32_t)> isWanted) {
    const Box box = boxAtStart(proxyIndex);
    const auto add = [&](std::uint32_t other) {
        if (other != proxyIndex && isWanted(other)) {
            addIfNew(proxyIndex, other);
        }
    };
    const Reading<Scalar> reading = store_.beginReading();
    for (const Filing<Scalar>& filing : reading.filings()) {
        forTouching(*filing.table, box, [&](std::uint32_t other) {
            if (store_.isFiled(other, reading)) {
                add(other);
            }
        });
    }
    for (std::size_t i = 0; i < proxies_.waiting.size() && !reading.isFresh; ++i) {
        const std::uint32_t other = proxies_.waiting[i];
        if (proxies_.isAlive(other) && overlaps(box, proxies_.records[other].box)) {
            add(other);
        }
    }
}

// Calls visit(index) for each entry of the table whose box overlaps.
template <class Scalar>
void PairTracker<Scalar>::forTouching(const Table<Scalar>& table, const Box& box,
                                      FunctionRef<void(std::uint32_t)> visit) {
    bounds_.clear();
    bounds_.push(box);
    KernelCost cost;
    const auto take = [&](std::span<const IndexPair> found) {
        for (const auto [query, entry] : found) {
            visit(table.proxyIndex(entry));
        }
        return true;
    };
    static_cast<void>(searchBoxes(table, bounds_.columns(), 1, take, cost));
}

template <class Scalar>
void PairTracker<Scalar>::addIfNew(std::uint32_t proxyIndex, std::uint32_t other) {
    const PairKey c = pairKey(proxyIndex, other);
    if (!wasKnown(proxyIndex, other) && proxies_.mayPairNow(proxyIndex, other) &&
        touchAtStart(proxyIndex, other) && !immediate_.contains(c) && !isSwept(c)) {
        newCandidates_.push_back(c);
        asked_.push_back(c);
    }
}

// Where a proxy alive is now, of what sweeps where its way begins.
template <class Scalar>
Aabb<Scalar> PairTracker<Scalar>::boxAtStart(std::uint32_t proxyIndex) const {
    return sweeping_ != nullptr ? sweeping_->motions.boxAtStart(proxyIndex)
                                : proxies_.records[proxyIndex].box;
}

template <class Scalar>
bool PairTracker<Scalar>::touchAtStart(std::uint32_t a, std::uint32_t b) const {
    return overlaps(boxAtStart(a), boxAtStart(b));
}

template <class Scalar>
void PairTracker<Scalar>::findNewCandidates(std::uint32_t proxyIndex) {
    findNewCandidates(proxyIndex, [](std::uint32_t) { return true; });
}

template void PairTracker<float>::indexLastUpdate(std::size_t);
template void PairTracker<float>::forKnownPairs(std::uint32_t, VisitPair);
template void PairTracker<float>::forOverlapsAtUpdate(std::uint32_t, VisitPair);
template void PairTracker<float>::forSwept(std::uint32_t, VisitPair);
template void PairTracker<float>::forAllKnown(VisitPair);
template void PairTracker<float>::findNewCandidates(std::uint32_t,
                                                    FunctionRef<bool(std::uint32_t)>);
template void PairTracker<float>::findNewCandidates(std::uint32_t);
template void PairTracker<float>::forTouching(const Table<float>&, const Box&,
                                              FunctionRef<void(std::uint32_t)>);
template void PairTracker<float>::addIfNew(std::uint32_t, std::uint32_t);
template Aabb<float> PairTracker<float>::boxAtStart(std::uint32_t) const;
template bool PairTracker<float>::touchAtStart(std::uint32_t, std::uint32_t) const;
template void PairTracker<double>::indexLastUpdate(std::size_t);
template void PairTracker<double>::forKnownPairs(std::uint32_t, VisitPair);
template void PairTracker<double>::forOverlapsAtUpdate(std::uint32_t, VisitPair);
template void PairTracker<double>::forSwept(std::uint32_t, VisitPair);
template void PairTracker<double>::forAllKnown(VisitPair);
template void PairTracker<double>::findNewCandidates(std::uint32_t,
                                                     FunctionRef<bool(std::uint32_t)>);
template void PairTracker<double>::findNewCandidates(std::uint32_t);
template void PairTracker<double>::forTouching(const Table<double>&, const Box&,
                                               FunctionRef<void(std::uint32_t)>);
template void PairTracker<double>::addIfNew(std::uint32_t, std::uint32_t);
template Aabb<double> PairTracker<double>::boxAtStart(std::uint32_t) const;
template bool PairTracker<double>::touchAtStart(std::uint32_t, std::uint32_t) const;

}  // namespace hashphase::detail
