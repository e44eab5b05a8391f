// SPDX-License-Identifier: Zlib

// Which side Pairs remember of what overlaps: what the filter refused, which mostly is little, or the pairs.
//
// Where the pairs are, an update is what it would be without all that is kept to make it fast: a pair dies
// when the two are apart; and of all that what has changed overlaps, the filter is asked about what is no
// pair, in parts.

#include <broadphase/pairs/pair_tracker.hpp>

#include <broadphase/search/join.hpp>

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

namespace hashphase::detail {

namespace {

// Of `count` searches, how many tell what all find: so few that they cost little, and find little more than
// may be watched.
template <class Scalar>
std::size_t sampleSize(const Table<Scalar>& table, std::size_t count) {
    constexpr std::size_t kMost = 1024;
    return std::min({kMost, 1 + count / 32, 1 + 16 * count / mostTogether(table), count});
}

}  // namespace

// That are remembered of the refused ones.
template <class Scalar>
std::size_t PairTracker<Scalar>::mostRefused() const noexcept {
    return 32 * store_.listedCount() + 4 * count_;
}

template <class Scalar>
auto PairTracker<Scalar>::pile() -> Pile& {
    if (pile_ == nullptr) {
        pile_ = std::make_unique<Pile>();
    }
    return *pile_;
}

// Where many share a cell, a sample of what overlaps tells what the filter says to all of it. What is asked
// for that is not asked again.
template <class Scalar>
bool PairTracker<Scalar>::doesRefuseMost(PairFilter filter) {
    constexpr std::uint32_t kMany = 128;
    const bool isMobileCrowded = mostTogether(tables_.mobile) > kMany;
    const bool isRestingCrowded = mostTogether(tables_.resting) > kMany;
    if (isMobileCrowded || isRestingCrowded) {
        static_cast<void>(pile());
    }
    double refused = isMobileCrowded ? countRefused(filter, sampleMobile()) : 0;
    refused += isRestingCrowded ? countRefused(filter, sampleResting()) : 0;
    return refused > static_cast<double>(mostRefused());
}

// Sets asked_ to some of what overlaps among the mobile ones. Returns, as the next one, for how many
// candidates each of them stands.
template <class Scalar>
double PairTracker<Scalar>::sampleMobile() {
    const Table<Scalar>& mobile = tables_.mobile;
    KernelCost cost;
    const double weight = sampleOverlaps(mobile, cost);
    cost_.boxesTested += cost.boxesTested;
    for (const auto [a, b] : selected_.pairs()) {
        asked_.push_back(pairKey(mobile.proxyIndex(a), mobile.proxyIndex(b)));
    }
    return weight;
}

// The same of what has changed against the resting ones.
template <class Scalar>
double PairTracker<Scalar>::sampleResting() {
    const Table<Scalar>& mobile = tables_.mobile;
    listChanged(false);
    const std::size_t count = changedEntries_.size();
    const std::size_t size = sampleSize(tables_.resting, count);
    bounds_.clear();
    for (std::size_t i = 0; i < size; ++i) {
        const std::uint32_t entry = changedEntries_[count * i / size];
        searchedIndices_.push_back(mobile.proxyIndex(entry));
        bounds_.push(mobile.box(entry));
    }
    const ProxyGroups* const groups = proxies_.groupsOfAll();
    const GroupsView view{groups, searchedIndices_.data(), {}};
    KernelCost cost;
    forOverlaps(bounds_.columns(), bounds_.size(), tables_.resting,
                groups != nullptr ? &view : nullptr, cost,
                [this](std::uint32_t searched, std::uint32_t proxyIndex) {
                    asked_.push_back(pairKey(searchedIndices_[searched], proxyIndex));
                });
    cost_.boxesTested += cost.boxesTested;
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(size, 1));
}

// Finds some of what overlaps in a table that is not empty, see selected_. Returns for how many candidates each
// of them stands.
template <class Scalar>
double PairTracker<Scalar>::sampleOverlaps(const Table<Scalar>& table, KernelCost& cost) {
    const std::size_t size = sampleSize(table, table.size());
    std::size_t searches = 0;
    selected_.clear();
    selected_.append([&](PairSink& sink) {
        searches = joinSample(table, size, sink, cost, proxies_.groupsOfAll());
    });
    return static_cast<double>(searches) / static_cast<double>(size);
}

// About how many of those are refused of which asked_ is a sample, each for `weight` of them. It is asked
// about only where so many are new that it may be asked in parts.
template <class Scalar>
double PairTracker<Scalar>::countRefused(PairFilter filter, double weight) {
    std::size_t refused = 0;
    std::erase_if(asked_, [&](PairKey c) {
        const bool isKnown = wasKnown(first(c), second(c)) || immediate_.contains(c) || isSwept(c);
        refused += isKnown && isRefused(c) ? 1 : 0;
        return isKnown || !mayPairNow(c);
    });
    if (weight * static_cast<double>(asked_.size()) > kPart) {
        ask(filter);
        for (std::size_t i = 0; i < asked_.size(); ++i) {
            pile_->sampled.findOrInsert(asked_[i]);
            pile_->sampledAccepted.push_back(accepted_[i]);
            refused += accepted_[i] == 0 ? 1 : 0;
        }
    }
    asked_.clear();
    return weight * static_cast<double>(refused);
}

// Whether the refused ones have become few again is looked at after 1, 2, 4, 8 ... updates: it may cost as much
// as finding all that overlap.
template <class Scalar>
void PairTracker<Scalar>::chooseSide(bool isUpdated) noexcept {
    constexpr std::uint32_t kSeldom = 256;
    try {
        if (!remembersPairs()) {
            if (refusedCount() + immediate_.size() > mostRefused() && !store_.mustRebuildPairs) {
                rememberPairs();
            }
        } else if (isUpdated && cost_.grid.changed > 0 && --pile_->updatesUntilLook == 0) {
            pile_->lookInterval = std::min(2 * pile_->lookInterval, kSeldom);
            pile_->updatesUntilLook = pile_->lookInterval;
            rememberRefusedIfFew();
        }
    } catch (const std::bad_alloc&) {  // what is remembered so far will do
        if (remembersPairs()) {
            forgetWatched();
        }
    }
}

template <class Scalar>
void PairTracker<Scalar>::forgetWatched() noexcept {
    amongMobile_ = {};
    toResting_ = {};
    refused_ = {};
    refusedAtRest_ = {};
    kept_ = {};
}

// As of the last update, and what has been found since.
template <class Scalar>
void PairTracker<Scalar>::rememberPairs() {
    FlatSet pairs;
    forAllKnown([&](PairKey c) {
        if (!isRefused(c)) {
            pairs.findOrInsert(c);
        }
    });
    pile().pairs = std::move(pairs);
    pile_->hasPairs = true;
    // Seldomer each time, should it go to and fro.
    pile_->lookInterval = std::max(pile_->lookInterval, 1U);
    pile_->updatesUntilLook = pile_->lookInterval;
    forgetWatched();
}

// Directly after an update.
template <class Scalar>
void PairTracker<Scalar>::rememberRefusedIfFew() {
    if (!areOverlapsFew(mostRefused() / 2)) {  // not to come back with the next few
        return;
    }
    watchAll();
    const auto refuse = [this](PairKey c) {
        if (!isRemembered(c)) {
            refused_.findOrInsert(c);
        }
    };
    forEachOverlap([&](std::uint32_t a, std::uint32_t b) { refuse(pairKey(a, b)); });
    std::for_each(swept_.begin(), swept_.end(), refuse);
    for (const PairKey c : pile_->pairs.keys()) {
        if (!mayPairNow(c) && overlapNow(c)) {
            kept_.findOrInsert(c);
        }
    }
    pile_->hasPairs = false;
    pile_->pairs = {};
}

// By a sample first.
template <class Scalar>
bool PairTracker<Scalar>::areOverlapsFew(std::size_t most) {
    KernelCost cost;
    for (const Table<Scalar>* table : {&tables_.mobile, &tables_.resting}) {
        const double weight = table->size() > 0 ? sampleOverlaps(*table, cost) : 0;
        cost_.boxesTested += std::exchange(cost, {}).boxesTested;
        if (weight * static_cast<double>(selected_.size()) > static_cast<double>(most)) {
            return false;
        }
    }
    std::size_t count = 0;
    forEachOverlap([&](std::uint32_t, std::uint32_t) { ++count; });
    return count <= most;
}

// Finds all candidates that are to be watched.
template <class Scalar>
void PairTracker<Scalar>::watchAll() {
    const ProxyGroups* const groups = proxies_.groupsOfAll();
    const GroupsView view{groups, tables_.mobile.proxyIndices().data(), {}};
    KernelCost cost;
    amongMobile_.clear();
    carried_.clear();
    toResting_.clear();
    joinTable(tables_.mobile, serialFor, parts_, amongMobile_, cost, groups);
    queryTable(tables_.resting, tables_.mobile.columns(), tables_.mobile.size(), serialFor, parts_,
               carried_, cost, groups != nullptr ? &view : nullptr);
    for (const auto [entry, resting] : carried_.pairs()) {
        toResting_.push({entry, tables_.resting.proxyIndex(resting)});
    }
    cost_.boxesTested += cost.boxesTested;
}

template <class Scalar>
void PairTracker<Scalar>::findBegunOfPairs(PairFilter filter, ParallelFor parallelFor) {
    sweptNow_.clear();
    if (sweeping_ != nullptr) {
        sweeping_->search.find(sweeping_->motions.all, parallelFor);
        for (const PairKey c : sweeping_->search.contacts()) {
            const bool isPair = isRemembered(c);
            if (isPair || mayPairNow(c)) {
                sweptNow_.push_back(c);
                if (!isPair) {
                    asked_.push_back(c);
                }
            }
        }
    }
    cost_.pairsWatched = pile_->pairs.size();
    for (const PairKey c : pile_->pairs.keys()) {
        if (!overlapNow(c) && !std::binary_search(sweptNow_.begin(), sweptNow_.end(), c)) {
            endedPairs_.push_back(c);
        }
    }
    askAboutChanged(filter);
    askInParts(filter, 1);
    takeTurned();
}

template <class Scalar>
void PairTracker<Scalar>::askAboutChanged(PairFilter filter) {
    listChanged(true);
    const auto askUnlessPair = [&](std::uint32_t searched, std::uint32_t other) {
        const std::uint32_t proxyIndex = searchedIndices_[searched];
        const bool isFoundByOther = proxies_.changedNow(other) && other <= proxyIndex;
        if (!isFoundByOther && !isRemembered(pairKey(proxyIndex, other))) {
            asked_.push_back(pairKey(proxyIndex, other));
            askInParts(filter, kPart);
        }
    };
    const ProxyGroups* const groups = proxies_.groupsOfAll();
    const GroupsView view{groups, searchedIndices_.data(), {}};
    KernelCost cost;
    for (const Table<Scalar>* table : {&tables_.mobile, &tables_.resting}) {
        forOverlaps(bounds_.columns(), bounds_.size(), *table, groups != nullptr ? &view : nullptr,
                    cost, askUnlessPair);
    }
    cost_.boxesTested += cost.boxesTested;
}

// Where the pairs are remembered, asks about what there is to be asked, when that is `size` or more, and
// notes down what the answers change.
template <class Scalar>
void PairTracker<Scalar>::askInParts(PairFilter filter, std::size_t size) {
    if (!remembersPairs() || asked_.size() < size) {
        return;
    }
    sortPairs(asked_);
    asked_.erase(std::unique(asked_.begin(), asked_.end()), asked_.end());
    ask(filter);
    for (std::size_t i = 0; i < asked_.size(); ++i) {
        if ((accepted_[i] != 0) != isRemembered(asked_[i])) {
            pile_->turned.push_back(asked_[i]);
        }
    }
    asked_.clear();
    acceptedPairs_.clear();
    newCandidates_.clear();
}

// As if only what the answers change had been asked.
template <class Scalar>
void PairTracker<Scalar>::takeTurned() {
    asked_.swap(pile_->turned);
    sortPairs(asked_);
    asked_.erase(std::unique(asked_.begin(), asked_.end()), asked_.end());
    accepted_.clear();
    for (const PairKey c : asked_) {
        const bool isPair = isRemembered(c);
        accepted_.push_back(isPair ? 0 : 1);
        if (isPair) {
            acceptedPairs_.push_back(c);
        }
    }
}

template bool PairTracker<float>::doesRefuseMost(PairFilter);
template double PairTracker<float>::sampleMobile();
template double PairTracker<float>::sampleResting();
template bool PairTracker<float>::areOverlapsFew(std::size_t);
template void PairTracker<float>::watchAll();
template double PairTracker<float>::countRefused(PairFilter, double);
template double PairTracker<float>::sampleOverlaps(const Table<float>&, KernelCost&);
template void PairTracker<float>::rememberRefusedIfFew();
template auto PairTracker<float>::pile() -> Pile&;
template void PairTracker<float>::askAboutChanged(PairFilter);
template void PairTracker<float>::chooseSide(bool) noexcept;
template void PairTracker<float>::forgetWatched() noexcept;
template std::size_t PairTracker<float>::mostRefused() const noexcept;
template void PairTracker<float>::rememberPairs();
template void PairTracker<float>::findBegunOfPairs(PairFilter, ParallelFor);
template void PairTracker<float>::askInParts(PairFilter, std::size_t);
template void PairTracker<float>::takeTurned();
template bool PairTracker<double>::doesRefuseMost(PairFilter);
template double PairTracker<double>::sampleMobile();
template double PairTracker<double>::sampleResting();
template bool PairTracker<double>::areOverlapsFew(std::size_t);
template void PairTracker<double>::watchAll();
template double PairTracker<double>::countRefused(PairFilter, double);
template double PairTracker<double>::sampleOverlaps(const Table<double>&, KernelCost&);
template void PairTracker<double>::rememberRefusedIfFew();
template auto PairTracker<double>::pile() -> Pile&;
template void PairTracker<double>::askAboutChanged(PairFilter);
template void PairTracker<double>::chooseSide(bool) noexcept;
template void PairTracker<double>::forgetWatched() noexcept;
template std::size_t PairTracker<double>::mostRefused() const noexcept;
template void PairTracker<double>::rememberPairs();
template void PairTracker<double>::findBegunOfPairs(PairFilter, ParallelFor);
template void PairTracker<double>::askInParts(PairFilter, std::size_t);
template void PairTracker<double>::takeTurned();

}  // namespace hashphase::detail
