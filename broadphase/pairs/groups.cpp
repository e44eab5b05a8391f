// SPDX-License-Identifier: Zlib

// What groups do to pairs, and to what is known of them, when they have been set.

#include <broadphase/pairs/pair_tracker.hpp>

namespace hashphase::detail {

// Pairs whose groups have been set, and do not let them pair any more, are kept as long as they overlap.
// Those that may pair again are watched as the others are.
template <class Scalar>
void PairTracker<Scalar>::findKept() {
    for (const PairKey c : kept_.keys()) {
        endIfSeparated(c);
        if (mayPairNow(c)) {
            notKept_.push_back(c);
        }
    }
    if (!proxies_.areRegrouped) {
        return;
    }
    for (const auto [a, b] : amongMobile_.pairs()) {
        keepIfPair(pairKey(proxies_.mobile[a], proxies_.mobile[b]));
    }
    for (const auto [place, proxyIndex] : toResting_.pairs()) {
        keepIfPair(pairKey(proxies_.mobile[place], proxyIndex));
    }
    for (const PairKey c : immediate_.keys()) {
        keepIfPair(c);
    }
}

template <class Scalar>
void PairTracker<Scalar>::keepIfPair(PairKey c) {
    if (!mayPairNow(c) && overlapNow(c) && !isRefused(c)) {
        keptNow_.push_back(c);
    }
}

// What overlapped at the last update, but could not pair, and may now.
template <class Scalar>
void PairTracker<Scalar>::askAboutRegrouped() {
    const auto askIfNew = [this](std::uint32_t a, std::uint32_t b) {
        if (proxies_.overlappedAtUpdate(a, b) && !wasKnown(a, b)) {
            asked_.push_back(pairKey(a, b));
        }
    };
    const Table<Scalar>& table = tables_.mobile;
    for (const auto [a, b] : amongMobile_.pairs()) {
        askIfNew(table.proxyIndex(a), table.proxyIndex(b));
    }
    for (const auto [entry, proxyIndex] : toResting_.pairs()) {
        askIfNew(table.proxyIndex(entry), proxyIndex);
    }
}

template <class Scalar>
bool PairTracker<Scalar>::wasKnown(std::uint32_t a, std::uint32_t b) const noexcept {
    return proxies_.overlappedAtUpdate(a, b) &&
           (proxies_.couldPair(a, b) || kept_.contains(pairKey(a, b)) ||
            isRemembered(pairKey(a, b)));
}

template void PairTracker<float>::findKept();
template void PairTracker<float>::keepIfPair(PairKey);
template void PairTracker<float>::askAboutRegrouped();
template bool PairTracker<float>::wasKnown(std::uint32_t, std::uint32_t) const noexcept;
template void PairTracker<double>::findKept();
template void PairTracker<double>::keepIfPair(PairKey);
template void PairTracker<double>::askAboutRegrouped();
template bool PairTracker<double>::wasKnown(std::uint32_t, std::uint32_t) const noexcept;

}  // namespace hashphase::detail
