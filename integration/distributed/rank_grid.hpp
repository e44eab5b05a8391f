// SPDX-License-Identifier: Zlib
#pragma once

// One rank's part of a grid over many ranks (processes): objects, pairs, and ghosts. Ghosts are copies of other
// ranks' objects.
//
//     for (const Parcel& parcel : grid.pack()) { send(parcel.rank, parcel.bytes); }
//     const RankChanges changes = grid.finish(received);
//
// Transport  Your program sends the parcels between ranks. hashphase::mpi does this with MPI.
// Objects    An object has one GlobalId on all ranks, and a ProxyId on this rank. Its home is the rank whose region
//            contains its min corner. finish() moves each object to its home, which then owns the object. The payload
//            (bytes that your program stores) moves with the object.
// Ghosts     If an object's box touches another rank's region, that rank has a ghost: box, groups and payload.
//            Parcels contain only changes.
// Pairs      All ranks together report the same births and deaths as one large grid. Exactly one rank reports each of
//            them. If a pair moves to another rank, no rank reports a birth or death.
// Frame      Changes are visible on this rank immediately, and on other ranks after finish(). To query other ranks,
//            use questions.hpp before the next change.
// Result     Deterministic: equal calls give equal results. finish() sorts parcels by sender.
// Failure    If memory runs out in add(), move(), remove() or payload(), nothing changes. If a parcel is invalid,
//            finish() throws RankError, which names the sender. After a RankError, or if memory runs out in pack() or
//            finish(), this grid is unusable.
// Threads    Several threads may query grid(). During any other call, no other thread may use this object.
// Misuse     These fail an assertion and have no effect: pack() and finish() in the wrong order, changes between
//            pack() and finish(), and changes of stale ids or ghosts.

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

/// A parcel is invalid, or does not match this rank's state.
class HASHPHASE_DISTRIBUTED_EXPORT RankError : public std::runtime_error {
public:
    explicit RankError(const std::string& sentence);
    RankError(const RankError&) = default;
    RankError& operator=(const RankError&) = default;
    ~RankError() override;
};

/// Settings, which must be equal on all ranks.
struct RankGridConfig {
    GridConfig grid;
    /// Bytes of payload in each object and ghost. Valid: 0 to 65,536.
    std::uint32_t payloadBytes = 0;

    friend bool operator==(const RankGridConfig&, const RankGridConfig&) = default;
};

/// Bytes from one rank to another.
struct Parcel {
    std::uint32_t rank = 0;  ///< the receiver of a parcel to send; the sender of a received parcel
    std::span<const std::byte> bytes;
};

/// An object that has moved from one rank to another.
struct Migration {
    GlobalId object;
    ProxyId proxy;           ///< id on this rank; if departed: id of the ghost, or a stale id
    std::uint32_t rank = 0;  ///< if arrived: its old home; if departed: its new home
};

/// The changes of a frame. Valid until the next finish().
struct RankChanges {
    /// Births and deaths that this rank reports, as local ProxyIds, sorted. globalPair() also accepts removed
    /// proxies.
    PairChanges pairs;
    /// Objects that arrived, sorted by old home. Objects from one home are in the order of `departed` there.
    std::span<const Migration> arrived;
    std::span<const Migration> departed;
};

/// Cost of the last frame on this rank.
struct RankCost {
    PairCost pairs;                 ///< of this rank's grid, ghosts included
    std::uint64_t ghosts = 0;       ///< on this rank
    std::uint64_t entriesSent = 0;  ///< changed objects, counted once for each receiver
    std::uint64_t bytesSent = 0;
    std::uint64_t parcelsSent = 0;
    /// Estimated work: boxes sorted into cells, boxes tested, and pairs. Unit: one box test.
    double load = 0;
};

/// One rank's objects, ghosts and pairs.
template <class Scalar>
class HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT RankGrid {
public:
    using Box = Aabb<Scalar>;

    /// Makes the part of `rank`. Throws std::invalid_argument if the configuration is invalid. Asserted: `rank` is
    /// less than partition.rankCount().
    RankGrid(std::uint32_t rank, const Partition<Scalar>& partition,
             const RankGridConfig& config = {});

    // --- Objects ---------------------------------------------------------------------------------

    /// Adds an object on this rank, wherever its box is. The next finish() moves the object to its home. All bytes
    /// of the new payload are 0. `groups` are as in Grid::setGroups(), and cannot change later. Throws
    /// std::invalid_argument if this rank has an object or ghost with this id. If two objects with equal ids meet on
    /// a rank later, finish() throws RankError. Throws std::length_error beyond 2^28 proxies. Cost: O(1) amortised.
    ProxyId add(GlobalId object, const Box& box, const ProxyGroups& groups = {});

    /// Sets the box of an object that this rank owns. Cost: O(1).
    void move(ProxyId id, const Box& box) {
        if (!canChange(id) || isSameBits(grid_.box(id), box)) {
            return;
        }
        if ((marks_[id.index] & (kShared | kTouched)) != 0 || !liesWithin(box)) {
            touch(id.index);
        }
        grid_.move(id, box);
    }

    /// Removes an object that this rank owns. Cost: O(1).
    void remove(ProxyId id);

    /// Returns the payload of an object that this rank owns, for writing. The span is valid until the next add() or
    /// finish(). pack() packs the bytes for ghosts and for a new home. Call payload() again in each frame in which
    /// you write. Otherwise, pack() might leave out the bytes. Cost: O(1).
    [[nodiscard]] std::span<std::byte> payload(ProxyId id);

    /// Returns the payload of an object or ghost, for reading. finish() updates the payloads of ghosts. Returns an
    /// empty span for a stale id.
    [[nodiscard]] std::span<const std::byte> readPayload(ProxyId id) const noexcept;

    /// Returns whether this rank owns the object; false for ghosts and stale ids.
    [[nodiscard]] bool isOwned(ProxyId id) const noexcept {
        return grid_.contains(id) && (marks_[id.index] & kOwned) != 0;
    }

    /// Returns the rank that owns the object; for a ghost, the rank that owns the ghost's object. Asserted: the id is
    /// valid in this grid.
    [[nodiscard]] std::uint32_t homeOf(ProxyId id) const;

    /// Returns the GlobalId of an object or ghost. Until the next finish(), also accepts proxies that were removed in
    /// the frame that the last finish() ended. Asserted: the proxy is an object, a ghost or such a removed proxy.
    /// Without assertions, returns id 0 for other proxies.
    [[nodiscard]] GlobalId globalId(ProxyId id) const;

    /// Returns the GlobalIds of a pair.
    [[nodiscard]] GlobalPair globalPair(const ProxyPair& pair) const {
        return hashphase::globalPair(globalId(pair.first), globalId(pair.second));
    }

    /// Returns the object or ghost with this id. Returns a null id if this rank has neither. Cost: O(1).
    [[nodiscard]] ProxyId find(GlobalId object) const noexcept;

    /// Calls visit(ProxyId, const Box&) for each object that this rank owns, in ascending order of indices. visit()
    /// may move and remove objects. Cost: O(objects and ghosts).
    template <class Visit>
    void forEachOwned(const Visit& visit) const {
        grid_.forEach([&](ProxyId id, const Box& box) {
            if (isOwned(id)) {
                visit(id, box);
            }
        });
    }

    /// Number of objects that this rank owns.
    [[nodiscard]] std::size_t size() const noexcept { return ownedCount_; }
    [[nodiscard]] std::size_t ghostCount() const noexcept { return grid_.size() - ownedCount_; }

    /// The grid of objects and ghosts, for queries. After finish(), the grid has all objects that touch this rank's
    /// region.
    [[nodiscard]] const Grid<Scalar>& grid() const noexcept { return grid_; }

    // --- Frame -----------------------------------------------------------------------------------

    /// Uses another partition from the next pack() on. Call it on all ranks in the same frame. Asserted: the number
    /// of ranks is unchanged, and the call is not between pack() and finish(). Cost: O(objects and ghosts), in the
    /// next pack().
    void setPartition(const Partition<Scalar>& partition);

    /// Ends the changes of this frame. Returns the parcels for other ranks, sorted by receiver, valid until the next
    /// pack(). Cost: O(n) for n objects that were added or removed, or that changed at the region's border.
    std::span<const Parcel> pack();

    /// Ends the frame. Pass all parcels from other ranks for this frame, in any order. Throws RankError. Cost: as
    /// Pairs::update(), plus O(received bytes).
    RankChanges finish(std::span<const Parcel> received, ParallelFor parallelFor = serialFor);

    // --- The whole -------------------------------------------------------------------------------

    /// Number of frames that finish() has ended.
    [[nodiscard]] std::uint64_t frame() const noexcept { return frame_; }

    /// Returns whether objects, boxes and partition are unchanged since the last finish(). False between pack() and
    /// finish(). Cost: O(1).
    [[nodiscard]] bool isUpToDate() const noexcept {
        return !isPacked_ && !isPartitionNew_ && pairs_.isUpToDate();
    }

    /// Calls visit(const ProxyPair&) for each pair that this rank owns, in ascending order. One or both proxies may
    /// be ghosts. Asserted: isUpToDate(). Cost: as Pairs::collect().
    template <class Visit>
    void forEachPair(const Visit& visit) const {
        std::vector<ProxyPair> pairs;
        collectHere(pairs);
        for (const ProxyPair& pair : pairs) {
            visit(pair);
        }
    }

    /// Appends the pairs that this rank owns, as GlobalIds, sorted. Cost and assertion: as forEachPair().
    void collect(std::vector<GlobalPair>& pairs) const;

    /// Returns the checksum of the pairs that this rank owns. Cost and assertion: as forEachPair().
    [[nodiscard]] PairSum pairSum() const;

    [[nodiscard]] const RankCost& lastCost() const noexcept { return cost_; }

    /// Returns min corners of up to `count` objects that this rank owns, for Partition::balanced(). Weights estimate
    /// the work. Their sum is max(load, 1). Without the parameter `load`, uses lastCost().load. Cost: O(objects and
    /// ghosts), and two box queries for each point.
    [[nodiscard]] std::vector<WeightedPoint<Scalar>> sampleLoad(std::size_t count) const;
    [[nodiscard]] std::vector<WeightedPoint<Scalar>> sampleLoad(std::size_t count,
                                                                double load) const;

    [[nodiscard]] std::uint32_t rank() const noexcept { return rank_; }
    [[nodiscard]] const Partition<Scalar>& partition() const noexcept { return partition_; }
    [[nodiscard]] const RankGridConfig& config() const noexcept { return config_; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Returns a broken invariant in a sentence, or an empty string if all invariants hold. Call it after finish().
    [[nodiscard]] std::string validate() const;

private:
    // Flags of a proxy, stored in marks_.
    enum Mark : std::uint16_t {
        kOwned = 1,                // owned by this rank
        kShared = 2,               // was not wholly in this rank's region at the last finish()
        kTouched = 4,              // is in touched_
        kHasBefore = 8,            // befores_ has its box at the last finish()
        kNew = 16,                 // was not on this rank at the last finish()
        kBorn = 32,                // was on no rank at the last finish()
        kRemovedHere = 64,         // was removed from this rank
        kRemovedEverywhere = 128,  // was removed from all ranks
        kPayload = 256,            // its payload has changed
        kStaysHere = 512,          // its new box touches this rank's region
    };

    // A change of an object, as sent to a rank.
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

    /// Returns whether the region contains the box. Has no branches: at the border, they are unpredictable.
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
        HASHPHASE_ASSERT(isOwned(id),
                         "RankGrid: the object does not live on this rank, or was removed. Change "
                         "it on its own rank.");
        HASHPHASE_ASSERT(!isPacked_,
                         "A RankGrid was changed between pack() and finish(). Change it before "
                         "pack() or after finish().");
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

    // Steps of finish().
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
    Box region_;                       // this rank's region of partition_
    Grid<Scalar> grid_;
    Pairs<Scalar> pairs_;

    // Arrays indexed by ProxyId::index.
    std::vector<std::uint16_t> marks_;
    std::vector<GlobalId> globalIds_;
    std::vector<Box> befores_;
    // The home. For a proxy removed from this rank: its index in removedHere_.
    std::vector<std::uint32_t> homes_;
    std::vector<std::byte> payloads_;
    // Invariant: the index of a GlobalId in knownIds_ is the index of its proxy in knownProxies_.
    detail::FlatSet knownIds_;
    std::vector<ProxyId> knownProxies_;
    std::size_t ownedCount_ = 0;

    // Data of the current frame.
    std::vector<std::uint32_t> touched_;  // changed objects (indices); in finish() also ghosts
    struct RemovedProxy {
        ProxyId id;
        Box now;
    };
    std::vector<RemovedProxy> removedHere_;
    std::vector<detail::ByteWriter> writers_;  // index: rank
    std::vector<std::uint32_t> entryCounts_;   // index: rank
    std::vector<std::uint32_t> destinations_;  // ranks whose writer is not empty
    std::vector<std::uint32_t> ranksBefore_;   // ranks that an object touched at the last finish()
    std::vector<std::uint32_t> ranksNow_;
    std::vector<Parcel> parcels_;
    std::vector<std::pair<Parcel, Entry>> entries_;  // received
    // Ids of removed proxies: formerNames_ in the last frame (sorted), nextFormerNames_ in this frame.
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
