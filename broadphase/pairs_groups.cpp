// SPDX-License-Identifier: Zlib

// What groups do to pairs, and to what is known of them, when they have been set.

#include <broadphase/pairs.hpp>

namespace hashphase {

// Pairs whose groups have been set, and do not let them pair any more, are kept as long as they overlap.
// Those that may pair again are watched as the others are.
template <class Scalar>
void Pairs<Scalar>::findKept() {
    for (const Couple c : kept_.keys()) {
        loseIfApart(c);
        if (mayPairNow(c)) {
            notKept_.push_back(c);
        }
    }
    if (!grid_.areRegrouped_) {
        return;
    }
    for (const auto [a, b] : amongMobile_.pairs()) {
        keepIfPair(couple(grid_.mobileSlots_[a], grid_.mobileSlots_[b]));
    }
    for (const auto [place, slot] : toResting_.pairs()) {
        keepIfPair(couple(grid_.mobileSlots_[place], slot));
    }
    for (const Couple c : announced_.keys()) {
        keepIfPair(c);
    }
}

template <class Scalar>
void Pairs<Scalar>::keepIfPair(Couple c) {
    if (!mayPairNow(c) && overlapNow(c) && !isRefused(c)) {
        keptNow_.push_back(c);
    }
}

// What overlapped at the last update, but could not pair, and may now.
template <class Scalar>
void Pairs<Scalar>::askAboutRegrouped() {
    const auto askIfNew = [this](std::uint32_t a, std::uint32_t b) {
        if (grid_.overlappedAtUpdate(a, b) && !wasKnown(a, b)) {
            asked_.push_back(couple(a, b));
        }
    };
    const detail::Table<Scalar>& table = grid_.mobile_;
    for (const auto [a, b] : amongMobile_.pairs()) {
        askIfNew(table.slot(a), table.slot(b));
    }
    for (const auto [entry, slot] : toResting_.pairs()) {
        askIfNew(table.slot(entry), slot);
    }
}

template <class Scalar>
bool Pairs<Scalar>::doRefuse(std::uint32_t a, std::uint32_t b) const noexcept {
    return grid_.groupKinds_.refuse(grid_.records_[a].kind, grid_.records_[b].kind) &&
           !grid_.mayPairNow(a, b);  // of the kinds that share a number some may
}

template <class Scalar>
bool Pairs<Scalar>::wasKnown(std::uint32_t a, std::uint32_t b) const noexcept {
    return grid_.overlappedAtUpdate(a, b) &&
           (grid_.couldPair(a, b) || kept_.contains(couple(a, b)) || isRemembered(couple(a, b)));
}

template void Pairs<float>::findKept();
template void Pairs<float>::keepIfPair(Couple);
template void Pairs<float>::askAboutRegrouped();
template bool Pairs<float>::doRefuse(std::uint32_t, std::uint32_t) const noexcept;
template bool Pairs<float>::wasKnown(std::uint32_t, std::uint32_t) const noexcept;
template void Pairs<double>::findKept();
template void Pairs<double>::keepIfPair(Couple);
template void Pairs<double>::askAboutRegrouped();
template bool Pairs<double>::doRefuse(std::uint32_t, std::uint32_t) const noexcept;
template bool Pairs<double>::wasKnown(std::uint32_t, std::uint32_t) const noexcept;

}  // namespace hashphase
