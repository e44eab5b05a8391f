// SPDX-License-Identifier: Zlib
#pragma once

// The exact set of overlapping pairs of a grid, as the changes from one update to the next.
//
// A pair is two proxies whose closed boxes overlap, whose groups let them (Grid::setGroups()), and which
// the filter accepts; where one of them sweeps, which touch on their ways. update() tells which pairs
// were born and which died since the last one, each once, sorted; what persists is not touched. Mostly
// nothing is remembered of a pair but what boxes and ways tell: a pair is new when they touch now and did
// not at the last update.
//
// A frame   move proxies in the grid, then update() here (it updates the grid).
// Threads   every member needs the grid and this object for itself.
// Failure   An exception, of the filter or for want of memory, is passed on. After one from announce()
//           or refilter() nothing has happened; one from update() has ended nothing: the frame goes
//           on, and the next update() tells all that has changed since the last one that returned.
// Memory    follows proxies and pairs. Of what overlaps, that which the filter refused is remembered,
//           up to 32 couples for each proxy and four for each pair; where it refuses more, the pairs
//           are, and the update follows all that what has changed overlaps.
// Late      created over a grid that has proxies already, they begin as if these were all new; they may
//           go, and others come, between two updates.
// Misuse    one Pairs per grid at a time; and no call from within the filter; asserted.

#include <broadphase/core/couple_set.hpp>
#include <broadphase/core/flat_set.hpp>
#include <broadphase/export.hpp>
#include <broadphase/function_ref.hpp>
#include <broadphase/geometry/box_columns.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/search/pair_parts.hpp>
#include <broadphase/simd/kernels.hpp>

#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace hashphase {

/// Says which overlapping proxies make a pair: a function that is asked about two of them, or one
/// that is asked about many at once and sets accepted[i], given as 0, to 1 where asked[i] make a
/// pair. Asked once when two proxies begin to overlap, in ascending order of ids; again, for couples
/// that it refused, whenever one of them has changed or refilter() is called; not about two that may not
/// pair by their groups. Thousands at once may be asked about in parts, each in that order. May ask the
/// grid, and must not change it (asserted). For parameters only, as FunctionRef.
class PairFilter {
public:
    using OfOne = FunctionRef<bool(ProxyId, ProxyId)>;
    using OfMany = FunctionRef<void(std::span<const ProxyPair> asked, std::span<char> accepted)>;

    template <std::convertible_to<OfOne> Ask>
    PairFilter(Ask&& ask HASHPHASE_LIFETIME_BOUND) noexcept  // NOLINT: conversion is its purpose
        : ask_(OfOne(ask)) {}

    template <class Ask>
        requires(!std::is_same_v<std::remove_cvref_t<Ask>, PairFilter> &&
                 !std::convertible_to<Ask, OfOne> && std::convertible_to<Ask, OfMany>)
    PairFilter(Ask&& ask HASHPHASE_LIFETIME_BOUND)  // NOLINT: conversion is its purpose
        : ask_(OfMany(ask)) {}

    void operator()(std::span<const ProxyPair> asked, std::span<char> accepted) const {
        if (const auto* ofMany = std::get_if<OfMany>(&ask_)) {
            (*ofMany)(asked, accepted);
            return;
        }
        const auto& ofOne = std::get<OfOne>(ask_);
        for (std::size_t i = 0; i < asked.size(); ++i) {
            accepted[i] = ofOne(asked[i].first, asked[i].second) ? 1 : 0;
        }
    }

private:
    std::variant<OfOne, OfMany> ask_;
};

/// The filter that refuses nothing.
[[nodiscard]] inline bool acceptAllPairs(ProxyId /*first*/, ProxyId /*second*/) noexcept {
    return true;
}

/// Sorted; what update() returns is valid until the next update(), the rest until the next call of
/// another kind. A pair that died may name a proxy that was removed.
struct PairChanges {
    std::span<const ProxyPair> born;
    std::span<const ProxyPair> died;
};

/// What an update cost.
struct PairCost {
    std::uint64_t boxesTested = 0;
    /// Tested whether they still overlap: one of the two is mobile.
    std::uint64_t couplesWatched = 0;
    UpdateCost grid;
};

/// Tells which pairs were born and which died from one update to the next.
template <class Scalar>
class HASHPHASE_BROADPHASE_EXPORT Pairs {
public:
    /// Keeps a reference to the grid, which must outlive this object, and to the sweeps over it if there
    /// are any, until others are given. They are of the same grid, which has no other Pairs (asserted).
    /// The first update() tells all pairs as born. Cost: O(proxies), and all that rested wakes.
    explicit Pairs(Grid<Scalar>& grid, Sweeps<Scalar>* sweeps = nullptr);
    ~Pairs();

    Pairs(const Pairs&) = delete;
    Pairs& operator=(const Pairs&) = delete;

    /// From now on follows these sweeps in place of those given before, or with nullptr none: pairs stay,
    /// and the next update() tells what that changes. They are of the same grid, and this is not called
    /// within a query (both asserted). Sweeps that are to end are taken out first. Cost: O(proxies that
    /// swept, and that do now).
    void setSweeps(Sweeps<Scalar>* sweeps);

    /// Ends the frame: updates the grid and returns all pairs born and died since the last call.
    /// The result does not depend on `parallelFor`; the filter is asked on the caller's thread.
    /// Cost: follows what changed, and the pairs of what changed lately. Where more than 256 share a
    /// cell, or by accident or malice a bucket of the hash, it is that of sweeping them along one
    /// axis, the best one of each; at worst, for proxies that lie side by side along every axis and do
    /// not touch, or that are inverted, a few tests of every two. Ways of Sweeps are searched in up to
    /// 40 parts each, and against each other in up to 64.
    PairChanges update(PairFilter filter = acceptAllPairs, ParallelFor parallelFor = serialFor) &;

    /// Pairs of one proxy, which is alive (asserted), that have come to overlap since the last update,
    /// at once; update() will not report them again. Returns these births; of what sweeps, itself or
    /// another one, not what it meets on its way, but what it touches where that begins. Deaths, now and
    /// then, of pairs announced since the last update of which a proxy was removed since: they do not
    /// gather where nobody updates. update() reports the rest of them.
    /// Cost: that of a box query.
    PairChanges announce(ProxyId id, PairFilter filter) &;

    /// The same of its pairs with others alone, each named once; those that are not alive are passed
    /// over. Cost: O(others).
    PairChanges announce(ProxyId id, std::span<const ProxyId> others, PairFilter filter) &;

    /// Asks the filter again about everything that the proxy, which is alive (asserted), overlaps, or
    /// met on its way at the last update, refused or not, at once; and deaths as announce() does. Cost:
    /// that of a few box queries. Where many proxies have changed since the last update, the first call
    /// after it files their boxes of that update once for all calls up to the next one.
    PairChanges refilter(ProxyId id, PairFilter filter) &;

    /// The same for many proxies, in one pass: the filter is asked once about each couple, in ascending
    /// order. A proxy may be named more than once. Cost: as refilter() for each proxy; at most that of
    /// finding all pairs from scratch, and a box query for each proxy that has changed.
    PairChanges refilter(std::span<const ProxyId> ids, PairFilter filter) &;

    /// The same about these pairs alone; what is none is passed over. Cost: O(pairs).
    PairChanges refilter(std::span<const ProxyPair> pairs, PairFilter filter) &;

    /// The same for all proxies: the filter has changed. Cost: that of finding all pairs from scratch,
    /// and a box query for each proxy that has changed since the last update.
    PairChanges refilterAll(PairFilter filter) &;

    /// Grid::clear(), and all that is known of pairs and of sweeps with it: as new ones, over a new grid.
    /// No deaths are reported. Cost: O(Grid::indexLimit()).
    void clear();

    /// The whole set as of the last update, sorted, appended to `pairs`. The grid must not have
    /// changed since (asserted). Cost: that of finding all pairs from scratch.
    void collect(std::vector<ProxyPair>& pairs) const;

    /// Whether the two are a pair, as of the last update, or as was told since. Not of one that is not
    /// alive. Cost: O(1).
    [[nodiscard]] bool isPair(const ProxyPair& pair) const noexcept;

    /// Number of pairs in the set.
    [[nodiscard]] std::size_t count() const noexcept { return count_; }

    /// Number of overlapping couples that the filter refused, as they are remembered: none while the pairs
    /// are, instead. Those that may not pair by their groups are not counted.
    [[nodiscard]] std::size_t refusedCount() const noexcept {
        return refused_.size() + refusedAtRest_.size();
    }

    /// Whether so many overlap, of which the filter refuses most, that the pairs are remembered in their
    /// place; up to 256 updates longer.
    [[nodiscard]] bool remembersPairs() const noexcept {
        return pile_ != nullptr && pile_->hasPairs;
    }

    [[nodiscard]] const PairCost& lastCost() const noexcept { return cost_; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back what is not used, but nothing of the grid's, which has a call of its own: room for more
    /// couples than there are, and what only the next call would use, which takes it again. What calls
    /// have returned is not valid any more. update() does it by itself when there has been room for more
    /// than eight times as many in 256 updates in a row. Not within the filter (asserted). Cost: moving
    /// what is left.
    void releaseUnusedMemory() noexcept;

    /// Says which invariant is broken, in a sentence; empty when all hold (ask after update()):
    /// - The watched couples are the overlapping ones that may pair and of which one is mobile, each once.
    /// - count() is the number of overlapping and swept couples that may pair, less the refused ones, and
    ///   of the pairs that are kept.
    /// - Of each swept couple one sweeps.
    /// - The pairs that are kept overlap and may not pair.
    /// While the pairs are remembered, that count() is their number, and each overlaps or is swept; not that
    /// none is missing.
    [[nodiscard]] std::string validate() const;

private:
    using Box = Aabb<Scalar>;

    struct Told {
        std::vector<ProxyPair> born;
        std::vector<ProxyPair> died;
    };

    /// What is known where many share a cell.
    struct Pile {
        // In place of the couples that are watched, refused or kept, where those would be too many.
        detail::FlatSet pairs;
        bool hasPairs = false;
        std::uint32_t updatesUntilLook = 0;  // whether they still would
        std::uint32_t lookInterval = 0;

        // Of what this call has asked in parts, whose answer makes or ends a pair.
        std::vector<std::uint64_t> turned;
        // What this call has asked as a sample, and the answers by their numbers.
        detail::FlatSet sampled;
        std::vector<char> sampledAccepted;

        [[nodiscard]] std::size_t memoryBytes() const noexcept {
            return sizeof(*this) + pairs.memoryBytes() + sampled.memoryBytes() +
                   turned.capacity() * sizeof(std::uint64_t) + sampledAccepted.capacity();
        }
    };

    /// Two slots, the smaller one on top, so that couples sort by slots.
    using Couple = std::uint64_t;

    static constexpr Couple couple(std::uint32_t a, std::uint32_t b) noexcept {
        return a < b ? Couple{a} << 32 | b : Couple{b} << 32 | a;
    }
    static constexpr std::uint32_t first(Couple c) noexcept {
        return static_cast<std::uint32_t>(c >> 32);
    }
    static constexpr std::uint32_t second(Couple c) noexcept {
        return static_cast<std::uint32_t>(c);
    }

    [[nodiscard]] ProxyPair pairOf(Couple c) const noexcept {
        return {grid_.idOf(first(c)), grid_.idOf(second(c))};
    }
    [[nodiscard]] bool overlapNow(Couple c) const noexcept;
    [[nodiscard]] bool touchAtStart(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] Box boxAtStart(std::uint32_t slot) const;
    [[nodiscard]] bool isAtRest(Couple c) const noexcept;
    [[nodiscard]] bool isRefused(Couple c) const noexcept;
    [[nodiscard]] bool isSwept(Couple c) const noexcept;
    /// While the pairs are remembered.
    [[nodiscard]] bool isRemembered(Couple c) const noexcept {
        return remembersPairs() && pile_->pairs.contains(c);
    }

    void beginCall();
    void beginSearch();
    void recover();
    [[nodiscard]] bool findChanges(PairFilter filter, ParallelFor parallelFor);
    void findDeaths(ParallelFor parallelFor);
    void findDeathsOfWoken(ParallelFor parallelFor);
    [[nodiscard]] detail::Table<Scalar>& wokenTable();
    void loseIfApart(Couple c);
    [[nodiscard]] bool mayPairNow(Couple c) const noexcept {
        return grid_.mayPairNow(first(c), second(c));
    }
    [[nodiscard]] bool couldPair(Couple c) const noexcept {
        return grid_.couldPair(first(c), second(c));
    }
    [[nodiscard]] bool doRefuse(std::uint32_t a, std::uint32_t b) const noexcept;
    [[nodiscard]] bool wasKnown(std::uint32_t a, std::uint32_t b) const noexcept;
    void findKept();
    void keepIfPair(Couple c);
    void askAboutRegrouped();
    void leaveOutSweptByGroups();
    void findSwept(ParallelFor parallelFor);
    void findBirths(bool someCameToRest, ParallelFor parallelFor);
    void carryToRest(bool someCameToRest);
    void joinMobile(ParallelFor parallelFor);
    void walkResting(ParallelFor parallelFor);
    [[nodiscard]] std::span<const detail::IndexPair> selectApart(
        std::span<const detail::IndexPair> couples, const std::uint32_t* order,
        const detail::PaddedBox<Scalar>* boxes, ParallelFor parallelFor);
    void askRefusedAgain();
    void sortCouples(std::vector<Couple>& couples);
    void ask(PairFilter filter);
    void makeRoom(Told& told);

    // Which side is remembered.
    [[nodiscard]] std::size_t mostCouples() const noexcept;
    Pile& pile();
    [[nodiscard]] bool doesRefuseMost(PairFilter filter);
    [[nodiscard]] double countRefused(PairFilter filter, double weight);
    [[nodiscard]] double sampleOverlaps(const detail::Table<Scalar>& table,
                                        detail::KernelCost& cost);
    void chooseSide(bool isUpdated) noexcept;
    void rememberPairs();
    void forgetWatched() noexcept;
    void rememberRefusedIfFew();
    void findChangesOfPairs(PairFilter filter, ParallelFor parallelFor);
    void askAboutChanged(PairFilter filter);
    void askInParts(PairFilter filter, std::size_t size);
    void takeTurned();

    // The rest of a call, which takes no more memory, and so cannot throw: makeRoom() has made room.
    void endUpdate() noexcept;  // NOLINT(bugprone-exception-escape)
    [[nodiscard]] bool areManyAnnounced() const noexcept;
    void findAnnouncedOfRemoved();
    void markAnnounced(std::span<const Couple> couples, bool are) noexcept;
    void endAnnouncedOfRemoved() noexcept;
    void announceUnknown() noexcept;  // NOLINT(bugprone-exception-escape)
    void lose(Couple c) noexcept;
    void decide() noexcept;  // NOLINT(bugprone-exception-escape)
    [[nodiscard]] bool isToBeRefused(Couple c) const noexcept;
    bool forgetRefused(Couple c) noexcept;
    PairChanges tell(Told& told) noexcept;

    // What was known at the last update, or has been announced since.
    using VisitCouple = FunctionRef<void(Couple)>;
    void indexLastUpdate(std::size_t mostUnindexed);
    void forKnownCouples(std::uint32_t slot, VisitCouple visit);
    void forOverlapsAtUpdate(std::uint32_t slot, VisitCouple visit);
    void forSwept(std::uint32_t slot, VisitCouple visit);
    void forAllKnown(VisitCouple visit);
    template <class IsNamed>
    void askAgainAboutMany(PairFilter filter, const IsNamed& isNamed);
    [[nodiscard]] bool wouldFind(std::uint32_t finder, std::uint32_t found) const;
    void askAgain(Couple c);
    PairChanges decideBetween(PairFilter filter);
    void findUnknown(std::uint32_t slot, FunctionRef<bool(std::uint32_t)> isWanted);
    void findUnknown(std::uint32_t slot);
    template <class Find>
    PairChanges announceFound(ProxyId id, PairFilter filter, const Find& find);
    void addIfUnknown(std::uint32_t slot, std::uint32_t other);
    void releaseAfterPeak() noexcept;
    void forEachOverlap(FunctionRef<void(std::uint32_t, std::uint32_t)> visit) const;

    static constexpr std::size_t kFewAnnounced = 64;
    static constexpr std::size_t kPart = 8192;  // couples that are asked about at once, some twice

    Grid<Scalar>& grid_;

    // The watched couples: all that overlapped at the last update and of which one is mobile, the
    // refused ones included. `a`, and among the mobile ones `b`, is a place in the grid's
    // mobileSlots_, which are in spatial order, so that boxes of a couple are near in memory.
    detail::PairList amongMobile_;
    detail::PairList toResting_;  // b is a slot

    detail::FlatSet refused_;        // couples that the filter refused, unless they are ...
    detail::FlatSet refusedAtRest_;  // ... both at rest
    std::unique_ptr<Pile> pile_;     // made when many share a cell
    detail::CoupleSet announced_;    // couples decided since the last update
    // Until there are more, those of removed proxies stay.
    std::size_t fewAnnounced_ = kFewAnnounced;
    std::vector<Couple> stillAnnounced_;  // scratch

    // Pairs whose groups have been set since, so that they may not pair any more: they overlap. Those
    // that were filtered again count as refused until the next update.
    detail::FlatSet kept_;

    Sweeps<Scalar>* sweeps_;
    // Couples of which one swept at the last update, and that touched on their ways; sorted. All the
    // others follow from boxes: what sweeps has none there, see Grid::standingBox().
    std::vector<Couple> swept_;
    std::vector<Couple> sweptNow_;  // the same of the update under way

    // What endUpdate() changes, besides: kept_ by the first two, and what is not refused any more.
    std::vector<Couple> keptNow_;
    std::vector<Couple> notKept_;
    std::vector<Couple> lapsed_;

    std::vector<Couple> lost_;      // what overlapped and does not any more, refused or not
    std::vector<Couple> asked_;     // what the filter is to be asked about
    std::vector<Couple> standing_;  // those of them that are pairs
    std::vector<ProxyPair> askedPairs_;
    std::vector<char> accepted_;
    std::vector<Couple> bornCouples_;
    std::vector<Couple> diedCouples_;
    Told toldByUpdate_;
    Told toldBetween_;
    std::size_t count_ = 0;
    PairCost cost_;
    detail::PeakWatch peaks_;

    // Scratch.
    std::vector<Couple> sorted_;
    std::vector<Couple> restedCouples_;
    std::vector<Couple>
        sweptBySecond_;            // swept_ with the halves exchanged, sorted, when it is asked for
    std::vector<Couple> unknown_;  // what is announced by the call under way
    std::vector<Couple> gone_;
    std::vector<Couple> fresh_;
    detail::PairList selected_;
    detail::PairParts parts_;
    detail::PairList carried_;
    std::vector<std::uint32_t> entryOf_;        // of places in mobileSlots_, in the mobile table
    std::vector<std::uint32_t> walkers_;        // entries that changed
    std::vector<std::uint32_t> searchedSlots_;  // what is looked for, or filed to be found
    detail::BoxColumns<Scalar> bounds_;         // of what is looked for in a table
    std::unique_ptr<detail::Table<Scalar>> wokenTable_;  // made when it is first needed
    std::vector<char> isNamed_;                          // by slot

    // A table of boxes as of the last update: of what was mobile then, and of the first indexedWoken_ of
    // what has left rest since. Either the grid's own, until it is filed again, or wokenTable_; null when
    // neither is.
    const detail::Table<Scalar>* tableOfUpdate_ = nullptr;
    std::size_t indexedWoken_ = 0;
    std::uint64_t filingOfUpdate_ = 0;  // Grid::filingCount_ and ...
    std::uint64_t shiftOfUpdate_ = 0;   // ... Grid::shiftCount_ at that time
    std::vector<detail::PaddedBox<Scalar>> wokenBoxes_;
};

extern template class Pairs<float>;
extern template class Pairs<double>;

}  // namespace hashphase
