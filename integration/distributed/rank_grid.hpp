// SPDX-License-Identifier: Zlib
#pragma once

// One rank's part of a grid over many ranks: the objects that live here, ghosts of others that reach in, and the
// pairs that this rank owns. Knows no transport: what ranks have to tell each other are bytes, which
// hashphase::mpi carries by MPI, and a program of its own by what it likes.
//
//     grid.move(proxy, box);  // for what has moved
//     for (const Parcel& parcel : grid.pack()) { send(parcel.rank, parcel.bytes); }
//     const RankChanges changes = grid.finish(received);
//
// Objects    have a GlobalId on all ranks, and a ProxyId here, by which the program keeps its data. An object
//            lives on the rank in whose region its box has its min corner, with its payload: bytes of the program
//            that travel with it, such as a velocity. Objects are added on any rank; finish() says which have
//            gone, and which have come.
// Ghosts     Every other rank whose region the box touches has a ghost of it: the box, the groups, the payload.
//            Only what has changed is told.
// Pairs      born and died are, over all ranks together, those of one grid with all objects, each once: a pair
//            that comes to be owned by another rank is neither born nor dead.
// Frame      Changes are visible here at once, and on other ranks after finish(). Queries over all ranks and sums
//            are asked after finish(), before the next change.
// Result     the same for the same calls: parcels are taken in the order of their ranks
// Memory     Where it runs out in add(), move(), remove() or payload(), nothing has happened.
// Failure    finish() throws RankError where a parcel is not what a rank can have sent, which it names.
//            Where it throws, or memory runs out in pack() or finish(), this grid is of no more use.
// Threads    Queries of grid() may run on several threads. Everything else needs this object for itself.
// Misuse     pack() and finish() in another order, changes between them, and ids that are stale or, where only
//            objects may be, ghosts: asserted, and do nothing.

#include <broadphase/aabb.hpp>
#include <broadphase/core/byte_stream.hpp>
#include <broadphase/core/flat_set.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/pairs.hpp>
#include <integration/distributed/export.hpp>
#include <integration/distributed/global_id.hpp>
#include <integration/distributed/partition.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// What another rank has sent is not what it can have sent, or does not fit this rank.
class HASHPHASE_DISTRIBUTED_EXPORT RankError : public std::runtime_error {
public:
    explicit RankError(const std::string& sentence);
    RankError(const RankError&) = default;
    RankError& operator=(const RankError&) = default;
    ~RankError() override;
};

/// Settings, the same on all ranks.
struct RankGridConfig {
    GridConfig grid;
    /// Bytes of the program that travel with each object, and with its ghosts. Valid: 0 to 65,536.
    std::uint32_t payloadBytes = 0;

    friend bool operator==(const RankGridConfig&, const RankGridConfig&) = default;
};

/// Bytes from one rank for another. Valid until the next pack().
struct Parcel {
    std::uint32_t rank = 0;  ///< for whom, or from whom
    std::span<const std::byte> bytes;
};

/// An object that has moved from one rank to another.
struct Migration {
    GlobalId object;
    ProxyId proxy;           ///< on this rank; once the object has gone that of its ghost, or stale
    std::uint32_t rank = 0;  ///< from where it has come, or where it has gone
};

/// What a frame has changed. Valid until the next finish().
struct RankChanges {
    /// The pairs that this rank reports, by ProxyIds of this rank, sorted by these. globalPair() leads to the
    /// objects' ids, of objects that have gone as well.
    PairChanges pairs;
    /// Sorted by rank; of each rank in the order in which it has them in its `departed`.
    std::span<const Migration> arrived;
    std::span<const Migration> departed;
};

/// What the last frame cost this rank.
struct RankCost {
    PairCost pairs;                 ///< of the grid here, ghosts included
    std::uint64_t ghosts = 0;       ///< here
    std::uint64_t entriesSent = 0;  ///< in parcels: changes of an object told to a rank
    std::uint64_t bytesSent = 0;
    std::uint64_t parcelsSent = 0;
    /// How much work there was, by what was counted: boxes filed, boxes tested and pairs, in units of a test.
    double load = 0;
};

/// One rank's objects, ghosts and pairs.
template <class Scalar>
class HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT RankGrid {
public:
    using Box = Aabb<Scalar>;

    /// The part of `rank` (less than partition.rankCount(), asserted).
    /// Throws std::invalid_argument where the configuration is bad.
    RankGrid(std::uint32_t rank, const Partition<Scalar>& partition,
             const RankGridConfig& config = {});

    // --- Objects ---------------------------------------------------------------------------------

    /// Adds an object, here, wherever its box is: the next finish() moves it to its rank. Its payload is zeros.
    /// `groups` are as in Grid::setGroups(), and stay. Throws std::invalid_argument where this rank has an object
    /// or a ghost of this id; finish() tells of ids that other ranks have given as well, where such two objects
    /// meet. Throws std::length_error beyond 2^28 proxies. Cost: O(1) amortised.
    ProxyId add(GlobalId object, const Box& box, const ProxyGroups& groups = {});

    /// Sets the box of an object that lives here. Cost: O(1).
    void move(ProxyId id, const Box& box) {
        if (!canChange(id) || isSameBits(grid_.box(id), box)) {
            return;
        }
        if ((marks_[id.index] & (kShared | kTouched)) != 0 || !liesWithin(box)) {
            touch(id.index);
        }
        grid_.move(id, box);
    }

    /// Removes an object that lives here. Cost: O(1).
    void remove(ProxyId id);

    /// The object's payload, to be written, of an object that lives here. What is written travels with the
    /// object when it moves to another rank, and to its ghosts in the next frame; call it again to write again then.
    /// Valid until the next add() or finish(). Cost: O(1).
    [[nodiscard]] std::span<std::byte> payload(ProxyId id);

    /// The same to be read, of a ghost as its owner last told it. Empty where the id is stale.
    [[nodiscard]] std::span<const std::byte> readPayload(ProxyId id) const noexcept;

    /// Whether the id names an object that lives here; false for ghosts, and for stale ids.
    [[nodiscard]] bool isOwned(ProxyId id) const noexcept {
        return grid_.contains(id) && (marks_[id.index] & kOwned) != 0;
    }

    /// The rank on which the object lives, of a ghost or an object of this grid (asserted).
    [[nodiscard]] std::uint32_t homeOf(ProxyId id) const;

    /// The object's id on all ranks. Also valid for proxies that the last frame has removed, until the next finish().
    /// Others are asserted, and have the id 0.
    [[nodiscard]] GlobalId globalId(ProxyId id) const;

    /// The pair of objects that two proxies stand for.
    [[nodiscard]] GlobalPair globalPair(const ProxyPair& pair) const {
        return hashphase::globalPair(globalId(pair.first), globalId(pair.second));
    }

    /// The object or ghost with this id, null where there is none here. Cost: O(1).
    [[nodiscard]] ProxyId find(GlobalId object) const noexcept;

    /// Calls visit(ProxyId, const Box&) for each object that lives here, in the order of their indices; it may move
    /// and remove objects. Cost: O(objects and ghosts).
    template <class Visit>
    void forEachOwned(const Visit& visit) const {
        grid_.forEach([&](ProxyId id, const Box& box) {
            if (isOwned(id)) {
                visit(id, box);
            }
        });
    }

    /// Number of objects that live here.
    [[nodiscard]] std::size_t size() const noexcept { return ownedCount_; }
    [[nodiscard]] std::size_t ghostCount() const noexcept { return grid_.size() - ownedCount_; }

    /// Objects and ghosts, for queries: after finish(), all that touch this rank's region.
    [[nodiscard]] const Grid<Scalar>& grid() const noexcept { return grid_; }

    // --- Frame -----------------------------------------------------------------------------------

    /// Takes another partition, of as many ranks, from the next pack() on. All ranks take the same one in the
    /// same frame. Cost: O(objects), in the next pack().
    void setPartition(const Partition<Scalar>& partition);

    /// Ends the changes of this frame, and returns what other ranks have to be told, sorted by rank.
    /// Cost: follows what has changed at the region's border.
    std::span<const Parcel> pack();

    /// Ends the frame with all parcels of this frame from the other ranks, in any order. Throws RankError.
    /// Cost: Pairs::update(), and the parcels.
    RankChanges finish(std::span<const Parcel> received, ParallelFor parallelFor = serialFor);

    // --- The whole -------------------------------------------------------------------------------

    /// Number of the frame, from 0 on: how often finish() has ended.
    [[nodiscard]] std::uint64_t frame() const noexcept { return frame_; }

    /// Whether nothing has changed here since the last finish(), the partition included. Cost: O(1).
    [[nodiscard]] bool isUpToDate() const noexcept {
        return !isPacked_ && !isPartitionNew_ && pairs_.isUpToDate();
    }

    /// Calls visit(const ProxyPair&) for each pair that this rank owns now, sorted by ProxyIds of this rank. One of
    /// the two, or both, may be ghosts. Nothing has changed since finish() (asserted). Cost: Pairs::collect().
    template <class Visit>
    void forEachPair(const Visit& visit) const {
        std::vector<ProxyPair> pairs;
        collectHere(pairs);
        for (const ProxyPair& pair : pairs) {
            visit(pair);
        }
    }

    /// Appends the same pairs by the ids of their objects, sorted by these.
    void collect(std::vector<GlobalPair>& pairs) const;

    /// The same pairs as a sum. Cost: Pairs::collect().
    [[nodiscard]] PairSum pairSum() const;

    /// What the last frame cost.
    [[nodiscard]] const RankCost& lastCost() const noexcept { return cost_; }

    /// Returns the min corners of up to `count` objects that live here, for Partition::balanced(). The weights
    /// estimate the work of each; together they are `load`, by default lastCost().load.
    /// Cost: `count` box queries.
    [[nodiscard]] std::vector<WeightedPoint<Scalar>> sampleLoad(std::size_t count) const;
    [[nodiscard]] std::vector<WeightedPoint<Scalar>> sampleLoad(std::size_t count,
                                                                double load) const;

    [[nodiscard]] std::uint32_t rank() const noexcept { return rank_; }
    [[nodiscard]] const Partition<Scalar>& partition() const noexcept { return partition_; }
    [[nodiscard]] const RankGridConfig& config() const noexcept { return config_; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Says which invariant is broken, in a sentence; empty when all hold (ask after finish()):
    /// - Objects that live here have their min corner in this rank's region, unless they have a NaN.
    /// - Ghosts touch this rank's region, and have their min corner in that of homeOf().
    /// - What does not lie wholly in the region is marked as shared.
    [[nodiscard]] std::string validate() const;

private:
    // What is known of a proxy, by ProxyId::index.
    enum Mark : std::uint16_t {
        kOwned = 1,      // lives here
        kShared = 2,     // did not lie wholly in this rank's region at the last finish()
        kTouched = 4,    // is in touched_: other ranks may have to be told, or have told
        kHasBefore = 8,  // befores_ has its box at the last finish(); without, that is the box now
        kNew = 16,       // was not here at the last finish()
        kBorn = 32,      // was nowhere then
        kRemovedHere = 64,         // is not here any more
        kRemovedEverywhere = 128,  // is on no rank any more
        kPayload = 256,            // its payload has changed
        kStaysHere = 512,          // its new box touches this rank's region, whoever owns it
    };

    // What a rank is told of an object.
    struct Entry {
        unsigned kind = 0;  // bits: see rank_grid_messages.inl
        GlobalId object;
        Box now;
        Box before;
        std::uint32_t home = 0;
        ProxyGroups groups;
        std::span<const std::byte> payload;
    };
    [[nodiscard]] Entry readEntry(detail::ByteReader& reader) const;

    /// Without branches: of boxes at the border none can be predicted.
    [[nodiscard]] bool liesWithin(const Box& box) const noexcept {
        unsigned isOutside = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const Scalar low = region_.min()[axis];
            const Scalar high = region_.max()[axis];
            isOutside |= static_cast<unsigned>(!(box.min()[axis] >= low)) |
                         static_cast<unsigned>(!(box.max()[axis] >= low)) |
                         static_cast<unsigned>(!(box.min()[axis] < high)) |
                         static_cast<unsigned>(!(box.max()[axis] < high));
        }
        return isOutside == 0;
    }
    [[nodiscard]] bool canChange(ProxyId id) const {
        HASHPHASE_ASSERT(
            isOwned(id),
            "Only an object that lives on this rank, and was not removed, can be changed.");
        HASHPHASE_ASSERT(!isPacked_, "Objects are changed before pack() or after finish().");
        return !isPacked_ && isOwned(id);
    }
    void touch(std::uint32_t index) {
        if ((marks_[index] & kTouched) == 0) {
            touched_.push_back(index);
            marks_[index] |= kTouched;
        }
    }
    void keepBefore(std::uint32_t index) {
        if ((marks_[index] & kHasBefore) == 0) {
            befores_[index] = grid_.store().boxAtUpdate(index);
            marks_[index] |= kHasBefore;
        }
    }
    void clear(std::uint32_t index, unsigned marks) noexcept;
    ProxyId addProxy(GlobalId object, const Box& box, const ProxyGroups& groups);
    void forgetId(GlobalId object) noexcept;
    void prefetch(std::uint32_t index) const noexcept;
    void touchForPartition();
    void packObject(std::uint32_t index);
    void addEntry(std::uint32_t rank, std::uint32_t index, unsigned kind);
    void makeRoom(std::uint32_t index);

    // finish(), in order.
    void readParcels(std::span<const Parcel> received);
    void readParcel(const Parcel& parcel);
    void takeEntries();
    void takeEntry(const Parcel& parcel, const Entry& entry);
    void takeNew(const Parcel& parcel, const Entry& entry);
    void takeHomeAndPayload(const Entry& entry, ProxyId id);
    void settleObjects();
    void markRemovedHere(ProxyId id);
    void reportPairs(const PairChanges& changes);
    [[nodiscard]] bool isSharedNow(ProxyId id) const noexcept;
    [[nodiscard]] bool ownsPair(const ProxyPair& pair) const noexcept;
    [[nodiscard]] bool isBornHere(const ProxyPair& pair) const noexcept;
    [[nodiscard]] bool isDeadHere(const ProxyPair& pair) const noexcept;
    [[nodiscard]] const Box& boxBefore(ProxyId id) const noexcept;
    [[nodiscard]] const Box& boxNow(ProxyId id) const noexcept;
    void endFrame();
    void collectHere(std::vector<ProxyPair>& pairs) const;

    std::uint32_t rank_;
    RankGridConfig config_;
    Partition<Scalar> partition_;
    Partition<Scalar> lastPartition_;  // at the last finish()
    Box region_;                       // of partition_
    Grid<Scalar> grid_;
    Pairs<Scalar> pairs_;

    // By ProxyId::index.
    std::vector<std::uint16_t> marks_;
    std::vector<GlobalId> globalIds_;
    std::vector<Box> befores_;
    // Of a ghost the rank where it lives; of what has left this rank its place in removedHere_.
    std::vector<std::uint32_t> homes_;
    std::vector<std::byte> payloads_;
    // The ids of all objects and ghosts here, numbered; and their proxies, by that number.
    detail::FlatSet knownIds_;
    std::vector<ProxyId> knownProxies_;
    std::size_t ownedCount_ = 0;

    // Of this frame.
    std::vector<std::uint32_t> touched_;  // objects here; in finish() ghosts that have changed, too
    struct RemovedProxy {
        ProxyId id;
        Box now;
    };
    std::vector<RemovedProxy> removedHere_;
    std::vector<detail::ByteWriter> writers_;  // by rank
    std::vector<std::uint32_t> entryCounts_;   // by rank
    std::vector<std::uint32_t> destinations_;  // the ranks whose writer is not empty
    std::vector<std::uint32_t> ranksBefore_;   // that an object touched, and that it touches now
    std::vector<std::uint32_t> ranksNow_;
    std::vector<Parcel> parcels_;
    std::vector<std::pair<Parcel, Entry>> entries_;  // received
    // The names of proxies that were removed here in the last frame, sorted, and in this one.
    struct FormerName {
        ProxyId id;
        GlobalId object;

        friend auto operator<=>(const FormerName&, const FormerName&) = default;
    };
    std::vector<FormerName> formerNames_;
    std::vector<FormerName> nextFormerNames_;
    std::vector<Migration> arrived_;
    std::vector<Migration> departed_;
    std::vector<ProxyPair> born_;
    std::vector<ProxyPair> died_;
    bool isPartitionNew_ = false;
    bool isPacked_ = false;
    std::uint64_t frame_ = 0;
    RankCost cost_;
};

extern template class RankGrid<float>;
extern template class RankGrid<double>;

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
