// SPDX-License-Identifier: Zlib
#pragma once

// What ranks tell each other: pack(), and the reading of parcels in finish().
//
// A parcel has the head of detail/parcels.hpp, the frame, the number of entries, and these. An entry:
//   kind      1 byte, of the bits below
//   id        8 bytes
//   box       now; not where the object was removed
//   home      4 bytes, where that has changed
//   groups    8 bytes, for a new ghost
//   box       before, for a new ghost of what is not new itself
//   payload   for a new ghost, and where it has changed

#include <integration/distributed/detail/parcels.hpp>
#include <integration/distributed/rank_grid.hpp>

#include <broadphase/core/raise.inl>
#include <broadphase/diagnostics.hpp>
#include <broadphase/geometry/padded_box.hpp>

#include <algorithm>

namespace hashphase {
namespace {

constexpr std::uint32_t kMagic = 0x68706d31;  // "hpm1"
constexpr std::size_t kCountAt = 20;          // behind the head and the frame

// How many objects ahead memory is fetched.
constexpr std::size_t kAhead = 8;

constexpr unsigned kEntryNew = 1;      // the receiver has no ghost of it yet
constexpr unsigned kEntryLeaves = 2;   // the object does not touch the receiver's region any more
constexpr unsigned kEntryRemoved = 4;  // the object is nowhere any more
constexpr unsigned kEntryBorn = 8;     // kEntryNew, and the object was nowhere before
constexpr unsigned kEntryHome = 16;    // the object lives on another rank from now on
constexpr unsigned kEntryPayload = 32;
constexpr unsigned kEntryAll = 63;

constexpr bool isKind(unsigned kind) {
    const bool isNew = (kind & kEntryNew) != 0;
    const bool isKnown = (kind & (kEntryLeaves | kEntryRemoved)) != 0;
    return kind <= kEntryAll && !(isNew && isKnown) && (isNew || (kind & kEntryBorn) == 0);
}

template <class Scalar>
void writeBox(detail::ByteWriter& writer, const Aabb<Scalar>& box) {
    writer.write(box.min().data(), 3 * sizeof(Scalar));
    writer.write(box.max().data(), 3 * sizeof(Scalar));
}

template <class Scalar>
Aabb<Scalar> readBox(detail::ByteReader& reader) {
    Aabb<Scalar> box;
    reader.read(box.min().data(), 3 * sizeof(Scalar));
    reader.read(box.max().data(), 3 * sizeof(Scalar));
    return box;
}

}  // namespace

// --- Telling -------------------------------------------------------------------------------------

template <class Scalar>
std::span<const Parcel> RankGrid<Scalar>::pack() {
    HASHPHASE_ASSERT(
        !isPacked_,
        "RankGrid::pack() was called twice without finish(). Call each of them once a frame.");
    if (isPacked_) {
        return parcels_;
    }
    for (const std::uint32_t rank : destinations_) {
        writers_[rank].clear();
        entryCounts_[rank] = 0;
    }
    destinations_.clear();
    parcels_.clear();
    if (isPartitionNew_) {
        touchForPartition();
    }
    for (std::size_t i = 0; i < touched_.size(); ++i) {
        if (i + kAhead < touched_.size()) {
            prefetch(touched_[i + kAhead]);
        }
        packObject(touched_[i]);
    }
    // The heads, when the numbers are known.
    std::sort(destinations_.begin(), destinations_.end());
    cost_ = {};
    for (const std::uint32_t rank : destinations_) {
        detail::ByteWriter& writer = writers_[rank];
        detail::sealParcel(writer);
        writer.rewrite(kCountAt, entryCounts_[rank]);
        parcels_.push_back({rank, writer.bytes()});
        cost_.entriesSent += entryCounts_[rank];
        cost_.bytesSent += writer.bytes().size();
    }
    cost_.parcelsSent = parcels_.size();
    isPacked_ = true;
    return parcels_;
}

template <class Scalar>
void RankGrid<Scalar>::packObject(std::uint32_t index) {
    const unsigned marks = marks_[index];
    const bool isRemoved = (marks & kRemovedEverywhere) != 0;
    if ((marks & (kOwned | kRemovedEverywhere)) == 0) {
        return;  // added and removed again
    }
    const ProxyId id = grid_.idAt(index);
    keepBefore(index);
    ranksBefore_.clear();
    ranksNow_.clear();
    if ((marks & kBorn) == 0) {
        lastPartition_.forEachRank(befores_[index],
                                   [&](std::uint32_t rank) { ranksBefore_.push_back(rank); });
    }
    bool hasMoved = false;
    if (!isRemoved) {
        const Box& now = grid_.box(id);
        partition_.forEachRank(now, [&](std::uint32_t rank) { ranksNow_.push_back(rank); });
        homes_[index] = ranksNow_.empty() ? rank_ : partition_.rankOf(now.min());
        hasMoved = homes_[index] != rank_;
    }
    const unsigned forAll = (isRemoved ? kEntryRemoved : 0U) | (hasMoved ? kEntryHome : 0U);
    const bool isSame =
        !isRemoved && isSameBits(befores_[index], grid_.box(id)) && (marks & kPayload) == 0;
    auto before = ranksBefore_.begin();
    for (const std::uint32_t rank : ranksNow_) {
        for (; before != ranksBefore_.end() && *before < rank; ++before) {
            addEntry(*before, index, forAll | kEntryLeaves);
        }
        const bool isKnown = before != ranksBefore_.end() && *before == rank;
        before += isKnown ? 1 : 0;
        if (rank == rank_) {
            marks_[index] |= kStaysHere;
        } else if (!isKnown) {
            addEntry(rank, index, forAll | kEntryNew | ((marks & kBorn) != 0 ? kEntryBorn : 0U));
        } else if (hasMoved || !isSame) {
            addEntry(rank, index, forAll);
        }
    }
    for (; before != ranksBefore_.end(); ++before) {
        addEntry(*before, index, forAll | (isRemoved ? 0U : kEntryLeaves));
    }
}

template <class Scalar>
void RankGrid<Scalar>::addEntry(std::uint32_t rank, std::uint32_t index, unsigned kind) {
    if (rank == rank_) {
        return;
    }
    detail::ByteWriter& writer = writers_[rank];
    if (entryCounts_[rank]++ == 0) {
        destinations_.push_back(rank);
        detail::beginParcel(writer, kMagic);
        writer.write(frame_);
        writer.write(std::uint32_t{0});  // at kCountAt
    }
    const ProxyId id = grid_.idAt(index);
    const bool isNew = (kind & kEntryNew) != 0;
    const bool hasPayload = config_.payloadBytes > 0 &&
                            (isNew || (marks_[index] & kPayload) != 0) &&
                            (kind & (kEntryRemoved | kEntryLeaves)) == 0;
    kind |= hasPayload ? kEntryPayload : 0U;
    writer.write(static_cast<std::uint8_t>(kind));
    writer.write(globalIds_[index].value);
    if ((kind & kEntryRemoved) == 0) {
        writeBox(writer, grid_.box(id));
    }
    if ((kind & kEntryHome) != 0) {
        writer.write(homes_[index]);
    }
    if (isNew) {
        const ProxyGroups groups = grid_.groups(id);
        writer.write(groups.group);
        writer.write(groups.mask);
        if ((kind & kEntryBorn) == 0) {
            writeBox(writer, befores_[index]);
        }
    }
    if (hasPayload) {
        writer.write(payloads_.data() + std::size_t{index} * config_.payloadBytes,
                     config_.payloadBytes);
    }
}

// --- Being told ----------------------------------------------------------------------------------

template <class Scalar>
void RankGrid<Scalar>::readParcels(std::span<const Parcel> received) {
    std::vector<Parcel> sorted(received.begin(), received.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const Parcel& a, const Parcel& b) { return a.rank < b.rank; });
    entries_.clear();
    for (const Parcel& parcel : sorted) {
        readParcel(parcel);
    }
    takeEntries();
}

template <class Scalar>
auto RankGrid<Scalar>::readEntry(detail::ByteReader& reader) const -> Entry {
    Entry entry;
    entry.kind = reader.read<std::uint8_t>();
    entry.object.value = reader.read<std::uint64_t>();
    if ((entry.kind & kEntryRemoved) == 0) {
        entry.now = readBox<Scalar>(reader);
    }
    if ((entry.kind & kEntryHome) != 0) {
        entry.home = reader.read<std::uint32_t>();
    }
    if ((entry.kind & kEntryNew) != 0) {
        entry.groups.group = reader.read<std::uint32_t>();
        entry.groups.mask = reader.read<std::uint32_t>();
        entry.before =
            (entry.kind & kEntryBorn) != 0 ? detail::nanBox<Scalar>() : readBox<Scalar>(reader);
    }
    if ((entry.kind & kEntryPayload) != 0) {
        entry.payload =
            reader.rest().first(std::min<std::size_t>(config_.payloadBytes, reader.left()));
        reader.skip(entry.payload.size());
    }
    return entry;
}

template <class Scalar>
void RankGrid<Scalar>::readParcel(const Parcel& parcel) {
    detail::ByteReader reader = detail::openParcel(
        parcel, kMagic,
        "is not from RankGrid::pack() of this version. Use the same hashphase on all ranks.");
    const auto frame = reader.read<std::uint64_t>();
    const auto count = reader.read<std::uint32_t>();
    if (reader.isTorn() || parcel.rank >= partition_.rankCount()) {
        detail::raiseBadParcel(parcel,
                               "has no frame, or is from a rank outside the partition. Pass all "
                               "its bytes, and the rank that sent it.");
    }
    if (frame != frame_) {
        detail::raiseBadParcel(parcel,
                               "is of frame " + std::to_string(frame) + ", but this is frame " +
                                   std::to_string(frame_) +
                                   ". Call pack() and finish() equally often on all ranks.");
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const Entry entry = readEntry(reader);
        const bool hasPayload = (entry.kind & kEntryPayload) != 0;
        if (reader.isTorn() || (hasPayload && entry.payload.size() != config_.payloadBytes)) {
            detail::raiseBadParcel(
                parcel, "ends within its entry " + std::to_string(i + 1) + " of " +
                            std::to_string(count) +
                            ". Pass all its bytes, and set the same payloadBytes on all ranks.");
        }
        if (!isKind(entry.kind) || (hasPayload && config_.payloadBytes == 0)) {
            detail::raiseBadParcel(
                parcel, "has an entry of the unknown kind " + std::to_string(entry.kind) +
                            ". Use the same hashphase and payloadBytes on all ranks.");
        }
        const bool leavesForHere = entry.home == rank_ && (entry.kind & kEntryHome) != 0 &&
                                   (entry.kind & (kEntryLeaves | kEntryRemoved)) != 0;
        if (entry.home >= partition_.rankCount() || leavesForHere) {
            detail::raiseBadParcel(
                parcel, "moves an object to rank " + std::to_string(entry.home) + " of " +
                            std::to_string(partition_.rankCount()) +
                            ", which is impossible. Set the same partition on all ranks.");
        }
        entries_.emplace_back(parcel, entry);
    }
    if (reader.left() > 0) {
        detail::raiseBadParcel(
            parcel, "has " + std::to_string(reader.left()) +
                        " bytes after its last entry. Set the same payloadBytes on all ranks.");
    }
}

template <class Scalar>
void RankGrid<Scalar>::takeEntries() {
    const auto idAt = [&](std::size_t i) { return entries_[i].second.object.value; };
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        // Where the id is looked for, its number, what is known by that, and the proxy.
        if (i + 4 * kAhead < entries_.size()) {
            knownIds_.prefetch(idAt(i + 4 * kAhead));
        }
        if (i + 3 * kAhead < entries_.size()) {
            detail::prefetch(knownProxies_.data() + knownIds_.prefetchKey(idAt(i + 3 * kAhead)));
        }
        if (i + kAhead < entries_.size()) {
            const ProxyId next = find(GlobalId{idAt(i + kAhead)});
            if (!next.isNull()) {
                prefetch(next.index);
            }
        }
        const auto& [parcel, entry] = entries_[i];
        if ((entry.kind & kEntryNew) == 0) {
            takeEntry(parcel, entry);
        }
    }
    // Last: an id that one rank removes another one may give again.
    for (const auto& [parcel, entry] : entries_) {
        if ((entry.kind & kEntryNew) != 0) {
            takeNew(parcel, entry);
        }
    }
    for (const auto& [parcel, entry] : entries_) {
        if ((entry.kind & kEntryHome) != 0 && entry.home == rank_) {
            arrived_.push_back({entry.object, find(entry.object), parcel.rank});
        }
    }
}

// Of a ghost that is here.
template <class Scalar>
void RankGrid<Scalar>::takeEntry(const Parcel& parcel, const Entry& entry) {
    const ProxyId id = find(entry.object);
    if (id.isNull() || (marks_[id.index] & (kOwned | kTouched)) != 0 ||
        homes_[id.index] != parcel.rank) {
        detail::raiseBadParcel(parcel, "changes object " + std::to_string(entry.object.value) +
                                           ", which is not a ghost of that rank here. Pass each "
                                           "parcel to finish() once, in its frame.");
    }
    const bool isRemoved = (entry.kind & kEntryRemoved) != 0;
    keepBefore(id.index);
    touch(id.index);
    if (!isRemoved) {
        grid_.move(id, entry.now);
    }
    if ((entry.kind & (kEntryRemoved | kEntryLeaves)) != 0) {
        marks_[id.index] |= isRemoved ? kRemovedEverywhere : 0;
        markRemovedHere(id);
        return;
    }
    takeHomeAndPayload(entry, id);
}

template <class Scalar>
void RankGrid<Scalar>::takeNew(const Parcel& parcel, const Entry& entry) {
    if (const ProxyId known = find(entry.object); !known.isNull()) {
        detail::raise(RankError("The global id " + std::to_string(entry.object.value) +
                        " names two objects, one on rank " + std::to_string(homeOf(known)) +
                        " and one on rank " + std::to_string(parcel.rank) +
                        ". Give each object an id of its own."));
    }
    const ProxyId id = addProxy(entry.object, entry.now, entry.groups);
    marks_[id.index] = static_cast<std::uint16_t>(kNew | kHasBefore |
                                                  ((entry.kind & kEntryBorn) != 0 ? kBorn : 0));
    globalIds_[id.index] = entry.object;
    befores_[id.index] = entry.before;
    homes_[id.index] = parcel.rank;
    touch(id.index);
    takeHomeAndPayload(entry, id);
}

template <class Scalar>
void RankGrid<Scalar>::takeHomeAndPayload(const Entry& entry, ProxyId id) {
    std::copy(entry.payload.begin(), entry.payload.end(),
              payloads_.begin() +
                  static_cast<std::ptrdiff_t>(std::size_t{id.index} * config_.payloadBytes));
    if ((entry.kind & kEntryHome) == 0) {
        return;
    }
    homes_[id.index] = entry.home;
    if (entry.home == rank_) {
        marks_[id.index] |= kOwned;
        ++ownedCount_;
    }
}

}  // namespace hashphase
