// SPDX-License-Identifier: Zlib
#pragma once

// Knows which pairs there are, and finds in each update which begin and which end: see pairs.hpp. The
// files of this folder are its operations.

#include <broadphase/core/couple_set.hpp>
#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/peak_watch.hpp>
#include <broadphase/geometry/box_columns.hpp>
#include <broadphase/pair_filter.hpp>
#include <broadphase/search/contact_search.hpp>
#include <broadphase/search/pair_parts.hpp>
#include <broadphase/simd/kernels.hpp>
#include <broadphase/store/store.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hashphase::detail {

template <class Scalar>
class PairTracker {
public:
    /// Of a store that has no other one. All that rests wakes.
    PairTracker(Store<Scalar>& store, Sweeping<Scalar>* sweeping);
    ~PairTracker();
    PairTracker(const PairTracker&) = delete;
    PairTracker& operator=(const PairTracker&) = delete;

    // --- The passes of an update, see step.hpp ---------------------------------------------------

    void beginUpdate();
    /// Finds what overlapped at the last update and does not now, before it is filed anew.
    void findEnded(ParallelFor parallelFor);
    /// Finds what overlaps now and did not at the last update. Returns false where the pairs had better be
    /// remembered: then it has changed nothing that is of use.
    [[nodiscard]] bool findBegun(bool someCameToRest, PairFilter filter, ParallelFor parallelFor);
    /// From now on remembers the pairs in place of what is refused; everything is mobile.
    void rememberInstead();
    /// Asks about what findBegun() has found, and makes room for all that may come of the answers.
    void askAndMakeRoom(PairFilter filter);
    /// Takes what was found for known.
    void publish() noexcept;  // NOLINT(bugprone-exception-escape)
    PairChanges endUpdate(const UpdateCost& cost) noexcept;

    // --- The rest of pairs.hpp -------------------------------------------------------------------

    void setSweeps(Sweeping<Scalar>* sweeping);
    PairChanges announce(std::uint32_t slot, PairFilter filter);
    PairChanges announce(std::uint32_t slot, std::span<const ProxyId> others, PairFilter filter);
    PairChanges refilter(std::span<const ProxyId> ids, PairFilter filter);
    PairChanges refilter(std::span<const ProxyPair> pairs, PairFilter filter);
    PairChanges refilterAll(PairFilter filter);
    void collect(std::vector<ProxyPair>& pairs) const;
    [[nodiscard]] bool isPair(const ProxyPair& pair) const noexcept;
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] std::size_t refusedCount() const noexcept {
        return refused_.size() + refusedAtRest_.size();
    }
    [[nodiscard]] bool remembersPairs() const noexcept {
        return pile_ != nullptr && pile_->hasPairs;
    }
    [[nodiscard]] const PairCost& lastCost() const noexcept { return cost_; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;
    void releaseUnusedMemory() noexcept;
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
        FlatSet pairs;
        bool hasPairs = false;
        std::uint32_t updatesUntilLook = 0;  // whether they still would
        std::uint32_t lookInterval = 0;

        // Of what this call has asked in parts, whose answer makes or ends a pair.
        std::vector<std::uint64_t> turned;
        // What this call has asked as a sample, and the answers by their numbers.
        FlatSet sampled;
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
        return {store_.proxies.idOf(first(c)), store_.proxies.idOf(second(c))};
    }
    [[nodiscard]] bool overlapNow(Couple c) const noexcept {
        const Population<Scalar>& proxies = store_.proxies;
        return overlaps(proxies.standingBox(proxies.records[first(c)]),
                        proxies.standingBox(proxies.records[second(c)]));
    }
    [[nodiscard]] bool touchAtStart(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] Box boxAtStart(std::uint32_t slot) const;
    [[nodiscard]] bool isAtRest(Couple c) const noexcept {
        return store_.proxies.rests(first(c)) && store_.proxies.rests(second(c));
    }
    [[nodiscard]] bool isRefused(Couple c) const noexcept;
    [[nodiscard]] bool isSwept(Couple c) const noexcept;
    /// While the pairs are remembered.
    [[nodiscard]] bool isRemembered(Couple c) const noexcept {
        return remembersPairs() && pile_->pairs.contains(c);
    }

    void beginCall();
    void beginSearch();
    void recover();
    void findDeathsOfWoken(ParallelFor parallelFor);
    [[nodiscard]] Table<Scalar>& wokenTable();
    void loseIfApart(Couple c);
    [[nodiscard]] bool mayPairNow(Couple c) const noexcept {
        return store_.proxies.mayPairNow(first(c), second(c));
    }
    [[nodiscard]] bool couldPair(Couple c) const noexcept {
        return store_.proxies.couldPair(first(c), second(c));
    }
    [[nodiscard]] bool wasKnown(std::uint32_t a, std::uint32_t b) const noexcept;
    void findKept();
    void keepIfPair(Couple c);
    void askAboutRegrouped();
    void leaveOutSweptByGroups();
    void findSwept(ParallelFor parallelFor);
    void carryToRest(bool someCameToRest);
    void joinMobile(ParallelFor parallelFor);
    void walkResting(ParallelFor parallelFor);
    [[nodiscard]] std::span<const IndexPair> selectApart(std::span<const IndexPair> couples,
                                                         const std::uint32_t* order,
                                                         const PaddedBox<Scalar>* boxes,
                                                         ParallelFor parallelFor);
    void askRefusedAgain();
    void sortCouples(std::vector<Couple>& couples);
    void findBegunOfPairs(PairFilter filter, ParallelFor parallelFor);
    void ask(PairFilter filter);
    void makeRoom(Told& told);

    // Which side is remembered.
    [[nodiscard]] std::size_t mostCouples() const noexcept;
    Pile& pile();
    [[nodiscard]] bool doesRefuseMost(PairFilter filter);
    [[nodiscard]] double countRefused(PairFilter filter, double weight);
    [[nodiscard]] double sampleOverlaps(const Table<Scalar>& table, KernelCost& cost);
    void chooseSide(bool isUpdated) noexcept;
    void rememberPairs();
    void forgetWatched() noexcept;
    void rememberRefusedIfFew();
    void askAboutChanged(PairFilter filter);
    void askInParts(PairFilter filter, std::size_t size);
    void takeTurned();

    // The rest of a call, which takes no more memory, and so cannot throw: makeRoom() has made room.
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
    void forTouching(const Table<Scalar>& table, const Box& box,
                     FunctionRef<void(std::uint32_t)> visit);
    template <class Find>
    PairChanges announceFound(PairFilter filter, const Find& find);
    void addIfUnknown(std::uint32_t slot, std::uint32_t other);
    void releaseAfterPeak() noexcept;
    void forEachOverlap(FunctionRef<void(std::uint32_t, std::uint32_t)> visit) const;

    static constexpr std::size_t kFewAnnounced = 64;
    static constexpr std::size_t kPart = 8192;  // couples that are asked about at once, some twice

    Store<Scalar>& store_;

    // The watched couples: all that overlapped at the last update and of which one is mobile, the
    // refused ones included. `a`, and among the mobile ones `b`, is a place in
    // Population::mobile, which are in spatial order, so that boxes of a couple are near in memory.
    PairList amongMobile_;
    PairList toResting_;  // b is a slot

    FlatSet refused_;             // couples that the filter refused, unless they are ...
    FlatSet refusedAtRest_;       // ... both at rest
    std::unique_ptr<Pile> pile_;  // made when many share a cell
    CoupleSet announced_;         // couples decided since the last update
    // Until there are more, those of removed proxies stay.
    std::size_t fewAnnounced_ = kFewAnnounced;
    std::vector<Couple> stillAnnounced_;  // scratch

    // Pairs whose groups have been set since, so that they may not pair any more: they overlap. Those
    // that were filtered again count as refused until the next update.
    FlatSet kept_;

    Sweeping<Scalar>* sweeping_;
    // Couples of which one swept at the last update, and that touched on their ways; sorted. All the
    // others follow from boxes: what sweeps has none there, see Population::standingBox().
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
    PeakWatch peaks_;

    // Scratch.
    std::vector<Couple> sorted_;
    std::vector<Couple> restedCouples_;
    std::vector<Couple>
        sweptBySecond_;            // swept_ with the halves exchanged, sorted, when it is asked for
    std::vector<Couple> unknown_;  // what is announced by the call under way
    std::vector<Couple> gone_;
    std::vector<Couple> fresh_;
    PairList selected_;
    PairParts parts_;
    PairList carried_;
    std::vector<std::uint32_t> entryOf_;  // of places in Population::mobile, in the mobile table
    std::vector<std::uint32_t> walkers_;  // entries that changed
    std::vector<std::uint32_t> searchedSlots_;   // what is looked for, or filed to be found
    BoxColumns<Scalar> bounds_;                  // of what is looked for in a table
    std::unique_ptr<Table<Scalar>> wokenTable_;  // made when it is first needed
    std::vector<char> isNamed_;                  // by slot

    // A table of boxes as of the last update: of what was mobile then, and of the first indexedWoken_ of
    // what has left rest since. Either the grid's own, until it is filed again, or wokenTable_; null when
    // neither is.
    const Table<Scalar>* tableOfUpdate_ = nullptr;
    std::size_t indexedWoken_ = 0;
    std::uint64_t filingOfUpdate_ = 0;  // Tables::filingCount and ...
    std::uint64_t shiftOfUpdate_ = 0;   // ... Store::shiftCount at that time
    std::vector<PaddedBox<Scalar>> wokenBoxes_;
};

extern template class PairTracker<float>;
extern template class PairTracker<double>;

}  // namespace hashphase::detail
