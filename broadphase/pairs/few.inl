// SPDX-License-Identifier: Zlib
#pragma once

// Few proxies are sooner compared with each other than filed. They stay in the list of changes, and the tables
// as they are.

#include <broadphase/pairs/filter.inl>
#include <broadphase/pairs/watched.inl>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace hashphase::detail {

/// The proxies, the mobile ones first, each by its place there, and which of them overlap: bit k of row i tells
/// about i and k < i.
template <class Scalar>
struct FewProxies {
    static constexpr std::size_t kMost = Store<Scalar>::kFewProxies;

    std::array<std::uint32_t, kMost> indices;
    std::array<std::uint32_t, kMost> rows;         // of all
    std::array<std::uint32_t, kMost> watchedRows;  // of the candidates that are watched
    std::uint32_t count = 0;
    std::uint32_t mobileCount = 0;

    void list(std::uint32_t proxyIndex) noexcept {
        indices[count] = proxyIndex;
        watchedRows[count++] = 0;
    }
    void watch(std::uint32_t i, std::uint32_t k) noexcept {
        watchedRows[std::max(i, k)] |= 1U << std::min(i, k);
    }
    [[nodiscard]] bool overlap(std::uint32_t i, std::uint32_t k) const noexcept {
        return (rows[std::max(i, k)] >> std::min(i, k) & 1) != 0;
    }
    [[nodiscard]] std::uint32_t placeOf(std::uint32_t proxyIndex) const noexcept {
        return static_cast<std::uint32_t>(
            std::find(indices.begin(), indices.begin() + count, proxyIndex) - indices.begin());
    }
    /// What has turned of row i: not of two that rest.
    [[nodiscard]] std::uint32_t turned(std::uint32_t i) const noexcept {
        const auto mobile = static_cast<std::uint32_t>((std::uint64_t{1} << mobileCount) - 1);
        return (rows[i] & mobile) ^ watchedRows[i];
    }
};

// Whether nothing is known but what is watched and what was refused.
template <class Scalar>
[[nodiscard]] bool areOnlyWatched(const PairState<Scalar>& pairs) noexcept {
    const KnownPairs& known = pairs.known;
    return known.swept.atUpdate.empty() && !known.arePairs() && known.kept.size() == 0 &&
           known.immediate.size() == 0;
}

template <class Scalar>
void listFewProxies(const PairState<Scalar>& pairs, FewProxies<Scalar>& few) {
    const Population<Scalar>& proxies = pairs.proxies;
    const Table<Scalar>& resting = pairs.tables.resting;
    for (const std::uint32_t proxyIndex : proxies.mobile) {
        few.list(proxyIndex);
    }
    few.mobileCount = few.count;
    for (std::uint32_t entry = 0; entry < resting.size(); ++entry) {
        const std::uint32_t proxyIndex = resting.proxyIndex(entry);
        if (proxies.rests(proxyIndex) && proxies.records[proxyIndex].listedAt == entry) {
            few.list(proxyIndex);
        }
    }
    for (const auto [a, b] : pairs.watched.amongMobile.pairs()) {
        few.watch(a, b);
    }
    for (const auto [place, proxyIndex] : pairs.watched.toResting.pairs()) {
        few.watch(few.placeOf(proxyIndex), place);
    }
    std::array<PaddedBox<Scalar>, FewProxies<Scalar>::kMost> boxes;
    kernels<Scalar>().overlapRows(proxies.records.data()->box.min().data(), Record<Scalar>::kStride,
                                  few.indices.data(), few.count, boxes.data(), few.rows.data());
}

// What overlaps and is watched did so at the last update, what is not watched did not, or may not pair.
template <class Scalar>
void turnFew(PairState<Scalar>& pairs, const FewProxies<Scalar>& few, std::uint32_t i,
             std::uint32_t k) {
    const PairKey key = pairKey(few.indices[i], few.indices[k]);
    if (!few.overlap(i, k)) {
        pairs.call.ended.push_back(key);
        return;
    }
    if (pairs.proxies.doRefuse(few.indices[i], few.indices[k])) {
        return;
    }
    pairs.listToAsk(key);
    if (i < few.mobileCount) {
        pairs.watched.amongMobile.push({k, i});
    } else {
        pairs.watched.toResting.push({k, few.indices[i]});
    }
}

// Finds which candidates have begun and ended. Returns whether there is anything to ask or to tell. No proxy has
// come, gone, woken or come to rest.
template <class Scalar>
[[nodiscard]] bool compareFew(PairState<Scalar>& pairs) {
    WatchedPairs& watched = pairs.watched;
    pairs.lastUpdate.forget();
    pairs.cost.pairsWatched = watched.amongMobile.size() + watched.toResting.size();
    FewProxies<Scalar> few;
    listFewProxies(pairs, few);
    pairs.cost.boxesTested = (few.count * few.count - few.count) / 2;
    for (std::uint32_t i = 0; i < few.count; ++i) {
        for (std::uint32_t turned = few.turned(i); turned != 0; turned &= turned - 1) {
            turnFew(pairs, few, i, static_cast<std::uint32_t>(std::countr_zero(turned)));
        }
    }
    if (!pairs.call.ended.empty()) {
        takeOut(watched.amongMobile,
                [&](const IndexPair& pair) { return !few.overlap(pair.a, pair.b); });
        takeOut(watched.toResting,
                [&](const IndexPair& pair) { return !few.overlap(few.placeOf(pair.b), pair.a); });
    }
    if (pairs.known.refused.size() > 0) {
        pairs.known.swept.now.clear();
        listRefusedAgain(pairs);
    }
    return !pairs.call.ended.empty() || !pairs.call.asked.empty();
}

}  // namespace hashphase::detail
