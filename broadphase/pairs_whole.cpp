// SPDX-License-Identifier: Zlib

// The whole set of pairs, found from scratch: for those who ask for it, and to check what is kept.

#include <broadphase/pairs.hpp>

#include <broadphase/search/join.hpp>

#include <algorithm>

namespace hashphase {

template <class Scalar>
void Pairs<Scalar>::forEachOverlap(FunctionRef<void(std::uint32_t, std::uint32_t)> visit) const {
    grid_.mendTables();
    const ProxyGroups* const groups = grid_.groupsOfAll();
    detail::KernelCost cost;
    detail::forOverlaps(grid_.mobile_, groups, cost, visit);
    detail::forOverlaps(grid_.resting_, groups, cost, visit);
    const detail::GroupsView view{groups, grid_.mobile_.entrySlots().data(), {}};
    detail::forOverlaps(grid_.mobile_.columns(), grid_.mobile_.size(), grid_.resting_,
                        groups != nullptr ? &view : nullptr, cost,
                        [&](std::uint32_t entry, std::uint32_t resting) {
                            visit(grid_.mobile_.slot(entry), resting);
                        });
}

template <class Scalar>
void Pairs<Scalar>::collect(std::vector<ProxyPair>& pairs) const {
    HASHPHASE_ASSERT(grid_.cost_.changed == 0,
                     "The set of pairs is asked for directly after an update.");
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
std::string Pairs<Scalar>::validate() const {
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
        watched.push_back(couple(grid_.mobileSlots_[a], grid_.mobileSlots_[b]));
    }
    for (const auto [place, slot] : toResting_.pairs()) {
        watched.push_back(couple(grid_.mobileSlots_[place], slot));
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
    if (!grid_.isTorn_ && watched != expected) {
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
        return grid_.records_[slot].place == Grid<Scalar>::Place::sweeping;
    };
    const bool oneSweeps = std::all_of(swept_.begin(), swept_.end(), [&](Couple c) {
        return sweeps(first(c)) || sweeps(second(c));
    });
    return oneSweeps ? std::string() : "Of each swept couple one sweeps: broken.";
}

template void Pairs<float>::forEachOverlap(FunctionRef<void(std::uint32_t, std::uint32_t)>) const;
template void Pairs<double>::forEachOverlap(FunctionRef<void(std::uint32_t, std::uint32_t)>) const;
template void Pairs<float>::collect(std::vector<ProxyPair>&) const;
template void Pairs<double>::collect(std::vector<ProxyPair>&) const;
template std::string Pairs<float>::validate() const;
template std::string Pairs<double>::validate() const;

}  // namespace hashphase
