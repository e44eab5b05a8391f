// SPDX-License-Identifier: Zlib

// What groups do to pairs, and to what is known of them, when they have been set.

#include <broadphase/pairs/pair_tracker.hpp>

namespace hashphase::detail {

// Pairs whose groups have been set, and do not let them pair any more, are kept as long as they overlap.
// Those that may pair again are watched as the others are.
template <class Scalar>
void PairTracker<Scalar>::findKept() {
    for (const Couple c : kept_.keys()) {
        loseIfApart(c);
        if (mayPairNow(c)) {
            notKept_.push_back(c);
        }
    }
    if (!store_.proxies.areRegrouped) {
        return;
    }
    for (const auto [a, b] : amongMobile_.pairs()) {
        keepIfPair(couple(store_.proxies.mobile[a], store_.proxies.mobile[b]));
    }
    for (const auto [place, slot] : toResting_.pairs()) {
        keepIfPair(couple(store_.proxies.mobile[place], slot));
    }
    for (const Couple c : announced_.keys()) {
        keepIfPair(c);
    }
}

template <class Scalar>
void PairTracker<Scalar>::keepIfPair(Couple c) {
    if (!mayPairNow(c) && overlapNow(c) && !isRefused(c)) {
        keptNow_.push_back(c);
    }
}

// What overlapped at the last update, but could not pair, and may now.
template <class Scalar>
void PairTracker<Scalar>::askAboutRegrouped() {
    const auto askIfNew = [this](std::uint32_t a, std::uint32_t b) {
        if (store_.proxies.overlappedAtUpdate(a, b) && !wasKnown(a, b)) {
            asked_.push_back(couple(a, b));
        }
    };
    const Table<Scalar>& table = store_.tables.mobile;
    for (const auto [a, b] : amongMobile_.pairs()) {
        askIfNew(table.slot(a), table.slot(b));
    }
    for (const auto [entry, slot] : toResting_.pairs()) {
        askIfNew(table.slot(entry), slot);
    }
}

template <class Scalar>
bool PairTracker<Scalar>::wasKnown(std::uint32_t a, std::uint32_t b) const noexcept {
    return store_.proxies.overlappedAtUpdate(a, b) &&
           (store_.proxies.couldPair(a, b) || kept_.contains(couple(a, b)) ||
            isRemembered(couple(a, b)));
}

template void PairTracker<float>::findKept();
template void PairTracker<float>::keepIfPair(Couple);
template void PairTracker<float>::askAboutRegrouped();
template bool PairTracker<float>::wasKnown(std::uint32_t, std::uint32_t) const noexcept;
template void PairTracker<double>::findKept();
template void PairTracker<double>::keepIfPair(Couple);
template void PairTracker<double>::askAboutRegrouped();
template bool PairTracker<double>::wasKnown(std::uint32_t, std::uint32_t) const noexcept;

}  // namespace hashphase::detail
