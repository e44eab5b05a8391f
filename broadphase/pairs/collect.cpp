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
    const ProxyGroups* const groups = store_.proxies.groupsOfAll();
    KernelCost cost;
    forOverlaps(store_.tables.mobile, groups, cost, visit);
    forOverlaps(store_.tables.resting, groups, cost, visit);
    const GroupsView view{groups, store_.tables.mobile.entrySlots().data(), {}};
    forOverlaps(store_.tables.mobile.columns(), store_.tables.mobile.size(), store_.tables.resting,
                groups != nullptr ? &view : nullptr, cost,
                [&](std::uint32_t entry, std::uint32_t resting) {
                    visit(store_.tables.mobile.slot(entry), resting);
                });
}

template <class Scalar>
void PairTracker<Scalar>::collect(std::vector<ProxyPair>& pairs) const {
    const auto begin = static_cast<std::ptrdiff_t>(pairs.size());
    const auto add = [&](Couple c) {
        if (!isRefused(c)) {
            pairs.push_back(pairOf(c));
        }
    };
    if (remembersPairs()) {
        const std::span<const Couple> couples = pile_->pairs.keys();
        std::for_each(couples.begin(), couples.end(), add);
    } else {
        forEachOverlap([&](std::uint32_t a, std::uint32_t b) { add(couple(a, b)); });
        std::for_each(kept_.keys().begin(), kept_.keys().end(), add);
        std::for_each(swept_.begin(), swept_.end(), add);
    }
    std::sort(pairs.begin() + begin, pairs.end());
}

template <class Scalar>
std::string PairTracker<Scalar>::validate() const {
    if (remembersPairs()) {
        const std::span<const Couple> couples = pile_->pairs.keys();
        const auto meet = [this](Couple c) { return overlapNow(c) || isSwept(c); };
        return count_ == couples.size() && std::all_of(couples.begin(), couples.end(), meet)
                   ? std::string()
                   : "While the pairs are remembered, count() is their number, and each overlaps "
                     "or is swept: broken.";
    }
    std::vector<Couple> watched;
    for (const auto [a, b] : amongMobile_.pairs()) {
        watched.push_back(couple(store_.proxies.mobile[a], store_.proxies.mobile[b]));
    }
    for (const auto [place, slot] : toResting_.pairs()) {
        watched.push_back(couple(store_.proxies.mobile[place], slot));
    }
    std::sort(watched.begin(), watched.end());
    std::size_t overlapping = 0;
    std::vector<Couple> expected;
    forEachOverlap([&](std::uint32_t a, std::uint32_t b) {
        ++overlapping;
        if (!isAtRest(couple(a, b))) {
            expected.push_back(couple(a, b));
        }
    });
    std::sort(expected.begin(), expected.end());
    if (!store_.isTorn && watched != expected) {
        return "The watched couples are the overlapping ones that may pair and of which one is "
               "mobile, each once: broken.";
    }
    if (count_ + refusedCount() != overlapping + swept_.size() + kept_.size()) {
        return "count() is the number of overlapping and swept couples that may pair, less the "
               "refused ones, and of the pairs that are kept: broken.";
    }
    const auto isKept = [this](Couple c) { return overlapNow(c) && !mayPairNow(c); };
    if (!std::all_of(kept_.keys().begin(), kept_.keys().end(), isKept)) {
        return "The pairs that are kept overlap and may not pair: broken.";
    }
    const auto sweeps = [this](std::uint32_t slot) {
        return store_.proxies.records[slot].place == Place::sweeping;
    };
    const bool oneSweeps = std::all_of(swept_.begin(), swept_.end(), [&](Couple c) {
        return sweeps(first(c)) || sweeps(second(c));
    });
    return oneSweeps ? std::string() : "Of each swept couple one sweeps: broken.";
}

template void PairTracker<float>::forEachOverlap(
    FunctionRef<void(std::uint32_t, std::uint32_t)>) const;
template void PairTracker<double>::forEachOverlap(
    FunctionRef<void(std::uint32_t, std::uint32_t)>) const;
template void PairTracker<float>::collect(std::vector<ProxyPair>&) const;
template void PairTracker<double>::collect(std::vector<ProxyPair>&) const;
template std::string PairTracker<float>::validate() const;
template std::string PairTracker<double>::validate() const;

}  // namespace hashphase::detail
