// SPDX-License-Identifier: Zlib
#pragma once

// Knows which pairs there are, and finds in each update which begin and which end: see pairs.hpp. The
// files of this folder are its operations.
//
// Two proxies that overlap, or touch on their ways, and may pair by their groups are a candidate, which the
// filter accepts or refuses. A pair is a candidate that was accepted.

#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/pair_key_set.hpp>
#include <broadphase/core/peak_watch.hpp>
#include <broadphase/export.hpp>
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
class HASHPHASE_BROADPHASE_EXPORT PairTracker {
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
    [[nodiscard]] bool findBegun(bool someSettled, PairFilter filter, ParallelFor parallelFor);
    /// From now on remembers the pairs in place of what is refused; everything is mobile.
    void rememberInstead();
    /// Asks about what findBegun() has found, and makes room for all that may come of the answers.
    void askAndMakeRoom(PairFilter filter);
    /// Takes what was found for known.
    void publish() noexcept;  // NOLINT(bugprone-exception-escape)
    PairChanges endUpdate(const UpdateCost& cost) noexcept;

    // --- The rest of pairs.hpp -------------------------------------------------------------------

    void setSweeps(Sweeping<Scalar>* sweeping);
    PairChanges findPairsNow(std::uint32_t proxyIndex, PairFilter filter);
    PairChanges findPairsNow(std::uint32_t proxyIndex, std::span<const ProxyId> others,
                             PairFilter filter);
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

    struct PairChangeLists {
        std::vector<ProxyPair> born;
        std::vector<ProxyPair> died;
    };

    /// What is known where many share a cell.
    struct Pile {
        // In place of the candidates that are watched, refused or kept, where those would be too many.
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

    /// Two indices, the smaller one on top, so that candidates sort by indices.
    using PairKey = std::uint64_t;

    static constexpr PairKey pairKey(std::uint32_t a, std::uint32_t b) noexcept {
        return a < b ? PairKey{a} << 32 | b : PairKey{b} << 32 | a;
    }
    static constexpr std::uint32_t first(PairKey c) noexcept {
        return static_cast<std::uint32_t>(c >> 32);
    }
    static constexpr std::uint32_t second(PairKey c) noexcept {
        return static_cast<std::uint32_t>(c);
    }

    [[nodiscard]] ProxyPair pairOf(PairKey c) const noexcept {
        return {proxies_.idOf(first(c)), proxies_.idOf(second(c))};
    }
    [[nodiscard]] bool overlapNow(PairKey c) const noexcept {
        return overlaps(proxies_.standingBox(proxies_.records[first(c)]),
                        proxies_.standingBox(proxies_.records[second(c)]));
    }
    [[nodiscard]] bool touchAtStart(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] Box boxAtStart(std::uint32_t proxyIndex) const;
    [[nodiscard]] bool isAtRest(PairKey c) const noexcept {
        return proxies_.rests(first(c)) && proxies_.rests(second(c));
    }
    [[nodiscard]] bool isRefused(PairKey c) const noexcept;
    [[nodiscard]] bool isSwept(PairKey c) const noexcept;
    /// While the pairs are remembered.
    [[nodiscard]] bool isRemembered(PairKey c) const noexcept {
        return remembersPairs() && pile_->pairs.contains(c);
    }

    void beginCall();
    void beginSearch();
    void recover();
    void findEndedOfWoken(ParallelFor parallelFor);
    void joinWoken(GroupKinds::Set kinds, ParallelFor parallelFor, KernelCost& cost);
    void endIfWokenApart(std::uint32_t a, std::uint32_t b);
    GroupKinds::Set listWoken();
    [[nodiscard]] Table<Scalar>& wokenTable();
    void endIfSeparated(PairKey c);
    [[nodiscard]] bool mayPairNow(PairKey c) const noexcept {
        return proxies_.mayPairNow(first(c), second(c));
    }
    [[nodiscard]] bool couldPair(PairKey c) const noexcept {
        return proxies_.couldPair(first(c), second(c));
    }
    [[nodiscard]] bool wasKnown(std::uint32_t a, std::uint32_t b) const noexcept;
    void findKept();
    void keepIfPair(PairKey c);
    void askAboutRegrouped();
    void leaveOutSweptByGroups();
    void findSwept(ParallelFor parallelFor);
    void carryToRest(bool someSettled);
    void joinMobile(ParallelFor parallelFor);
    void findAgainstResting(ParallelFor parallelFor);
    void queryResting(ParallelFor parallelFor);
    void listChanged(bool withIndices);
    [[nodiscard]] std::span<const IndexPair> selectApart(std::span<const IndexPair> candidates,
                                                         const std::uint32_t* order,
                                                         const PaddedBox<Scalar>* boxes,
                                                         ParallelFor parallelFor);
    void askRefusedAgain();
    void sortPairs(std::vector<PairKey>& candidates);
    void findBegunOfPairs(PairFilter filter, ParallelFor parallelFor);
    void ask(PairFilter filter);
    void makeRoom(PairChangeLists& lists);

    // Which side is remembered.
    [[nodiscard]] std::size_t mostRefused() const noexcept;
    Pile& pile();
    [[nodiscard]] bool doesRefuseMost(PairFilter filter);
    [[nodiscard]] double countRefused(PairFilter filter, double weight);
    [[nodiscard]] double sampleOverlaps(const Table<Scalar>& table, KernelCost& cost);
    void chooseSide(bool isUpdated) noexcept;
    void rememberPairs();
    void forgetWatched() noexcept;
    void rememberRefusedIfFew();
    [[nodiscard]] bool areOverlapsFew(std::size_t most);
    void watchAll();
    [[nodiscard]] double sampleMobile();
    [[nodiscard]] double sampleResting();
    void askAboutChanged(PairFilter filter);
    void askInParts(PairFilter filter, std::size_t size);
    void takeTurned();

    // The rest of a call, which takes no more memory, and so cannot throw: makeRoom() has made room.
    [[nodiscard]] bool areManyImmediate() const noexcept;
    void findImmediateOfRemoved();
    void markImmediate(std::span<const PairKey> candidates, bool are) noexcept;
    void endImmediateOfRemoved() noexcept;
    void noteNewCandidates() noexcept;  // NOLINT(bugprone-exception-escape)
    void endPair(PairKey c) noexcept;
    void applyFilter() noexcept;  // NOLINT(bugprone-exception-escape)
    [[nodiscard]] bool isToBeRefused(PairKey c) const noexcept;
    bool forgetRefused(PairKey c) noexcept;
    PairChanges report(PairChangeLists& lists) noexcept;

    // What was known at the last update, or has been found since.
    using VisitPair = FunctionRef<void(PairKey)>;
    void indexLastUpdate(std::size_t mostUnindexed);
    void forKnownPairs(std::uint32_t proxyIndex, VisitPair visit);
    void forOverlapsAtUpdate(std::uint32_t proxyIndex, VisitPair visit);
    void forSwept(std::uint32_t proxyIndex, VisitPair visit);
    void forAllKnown(VisitPair visit);
    void beginRefilter();
    void askAgainAboutFew(std::span<const ProxyId> ids, PairFilter filter);
    template <class IsNamed>
    void askAgainAboutMany(PairFilter filter, const IsNamed& isNamed);
    [[nodiscard]] bool wouldFind(std::uint32_t finder, std::uint32_t found) const;
    void askAgain(PairKey c);
    PairChanges applyFilterNow(PairFilter filter);
    void findNewCandidates(std::uint32_t proxyIndex, FunctionRef<bool(std::uint32_t)> isWanted);
    void findNewCandidates(std::uint32_t proxyIndex);
    void forTouching(const Table<Scalar>& table, const Box& box,
                     FunctionRef<void(std::uint32_t)> visit);
    template <class Find>
    PairChanges findNow(PairFilter filter, const Find& find);
    void addIfNew(std::uint32_t proxyIndex, std::uint32_t other);
    void releaseAfterPeak() noexcept;
    [[nodiscard]] bool areWatchedAll(std::size_t& overlapCount) const;
    void forEachOverlap(FunctionRef<void(std::uint32_t, std::uint32_t)> visit) const;

    static constexpr std::size_t kFewImmediate = 64;
    static constexpr std::size_t kPart =
        8192;  // candidates that are asked about at once, some twice

    Store<Scalar>& store_;
    Population<Scalar>& proxies_ = store_.proxies;
    Tables<Scalar>& tables_ = store_.tables;
    Frame<Scalar>& frame_ = store_.frame;

    // The watched candidates: all that overlapped at the last update and of which one is mobile, the
    // refused ones included. `a`, and among the mobile ones `b`, is a place in
    // Population::mobile, which are in spatial order, so that boxes of a candidate are near in memory.
    PairList amongMobile_;
    PairList toResting_;  // b is a proxyIndex

    FlatSet refused_;             // candidates that the filter refused, unless they are ...
    FlatSet refusedAtRest_;       // ... both at rest
    std::unique_ptr<Pile> pile_;  // made when many share a cell
    PairKeySet immediate_;        // candidates decided since the last update
    // Until there are more, those of removed proxies stay.
    std::size_t fewImmediate_ = kFewImmediate;
    std::vector<PairKey> stillImmediate_;  // scratch

    // Pairs whose groups have been set since, so that they may not pair any more: they overlap. Those
    // that were filtered again count as refused until the next update.
    FlatSet kept_;

    Sweeping<Scalar>* sweeping_;
    // Candidates of which one swept at the last update, and that touched on their ways; sorted. All the
    // others follow from boxes: what sweeps has none there, see Population::standingBox().
    std::vector<PairKey> swept_;
    std::vector<PairKey> sweptNow_;  // the same of the update under way

    // What endUpdate() changes, besides: kept_ by the first two, and what is not refused any more.
    std::vector<PairKey> keptNow_;
    std::vector<PairKey> notKept_;
    std::vector<PairKey> lapsed_;

    std::vector<PairKey> endedPairs_;     // what overlapped and does not any more, refused or not
    std::vector<PairKey> asked_;          // what the filter is to be asked about
    std::vector<PairKey> acceptedPairs_;  // those of them that are pairs
    std::vector<ProxyPair> askedPairs_;
    std::vector<char> accepted_;
    std::vector<PairKey> begunPairs_;
    std::vector<PairKey> diedPairs_;
    PairChangeLists updateChanges_;
    PairChangeLists immediateChanges_;
    std::size_t count_ = 0;
    PairCost cost_;
    PeakWatch peaks_;

    // Scratch.
    std::vector<PairKey> sorted_;
    std::vector<PairKey> restedPairs_;
    std::vector<PairKey>
        sweptBySecond_;  // swept_ with the halves exchanged, sorted, when it is asked for
    std::vector<PairKey> newCandidates_;  // what the call under way has found
    std::vector<PairKey> stillEnded_;
    std::vector<PairKey> stillBegun_;
    PairList selected_;
    PairParts parts_;
    PairList carried_;
    std::vector<std::uint32_t> entryOf_;  // of places in Population::mobile, in the mobile table
    std::vector<std::uint32_t> changedEntries_;   // entries that changed
    std::vector<std::uint32_t> searchedIndices_;  // what is looked for, or filed to be found
    BoxColumns<Scalar> bounds_;                   // of what is looked for in a table
    std::unique_ptr<Table<Scalar>> wokenTable_;   // made when it is first needed
    std::vector<char> isNamed_;                   // by index

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
