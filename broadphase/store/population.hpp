// SPDX-License-Identifier: Zlib
#pragma once

// All proxies: their boxes now and at the last update, their groups, and who has changed since. Plain data
// that the parts of the broadphase read and write in place; store.hpp has what changes it.

#include <broadphase/aabb.hpp>
#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/group_kinds.hpp>
#include <broadphase/core/roomy_list.hpp>
#include <broadphase/export.hpp>
#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/proxy_groups.hpp>
#include <broadphase/proxy_id.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

inline constexpr std::uint32_t kNoProxyIndex = ~std::uint32_t{0};

enum class Residency : std::uint8_t {
    nowhere,  // no proxy
    mobile,  // listed in Population::mobile, and filed with the mobile ones unless it waits or is NaN
    resting,   // filed with the resting ones, perhaps by a larger box, within which it moves
    sweeping,  // as mobile, but filed apart: its way, and not its box, makes its pairs
};

/// All about a proxy, by its index, in one cache line for single precision and two for double.
template <class Scalar>
struct alignas(16 * sizeof(Scalar)) Record {
    /// NaN while the index has no proxy.
    Aabb<Scalar> box = nanBox<Scalar>();
    /// standingBox() at the last update, if it has changed since; of what has slack the box by which it is filed.
    Aabb<Scalar> before = nanBox<Scalar>();
    std::uint32_t generation = 0;  // odd while the index has a proxy
    std::uint32_t changedAt = 0;   // number of the update that will see, or saw, the last change
    /// Where in the resting table; where in Population::mobile, if it has joined these since the last
    /// update; or the next index without a proxy.
    std::uint32_t listedAt = 0;
    Residency residency = Residency::nowhere;
    std::uint8_t listedIn = 0;  // number of the list of changes that has it
    std::uint8_t kind = 0;      // of its groups, in Population::groupKinds
    // Mobility::resting, or rested, and has not moved since but by a shift of the origin
    bool restsAtOnce : 1 = false;
    bool isNan : 1 = false;        // has a NaN; of a proxy alive
    bool isImmediate : 1 = false;  // a pair of the proxy's was reported since the last update
    bool hasSlack : 1 = false;     // it rests, and is filed by a larger box
    bool isCalm : 1 = false;       // in the last update that saw it mobile

    static constexpr std::size_t kStride = 16;  // from one to the next, in coordinates
};
static_assert(sizeof(Record<float>) == Record<float>::kStride * sizeof(float));
static_assert(sizeof(Record<double>) == Record<double>::kStride * sizeof(double));

/// Indices without a proxy, one after the other by Record::listedAt.
struct FreeList {
    std::uint32_t first = kNoProxyIndex;
    std::uint32_t last = kNoProxyIndex;
    std::uint32_t count = 0;
};

template <class Scalar>
struct HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Population {
    using Box = Aabb<Scalar>;

    std::vector<Record<Scalar>> records;  // by index
    std::size_t size = 0;                 // proxies alive
    std::size_t nanCount = 0;
    std::size_t reservedCount = 0;   // of proxies, by Grid::reserve()
    std::uint64_t number;            // see Grid::populationNumber()
    std::uint32_t updateNumber = 1;  // of the update that ends the present frame
    std::uint32_t settledChanged =
        0;  // of those with slack, since the last update; perhaps too many
    std::uint32_t firstGeneration = 0;  // of new indices; even
    bool nanReported = false;
    bool areRegrouped = false;    // groups of some, since the last update
    std::uint8_t listNumber = 1;  // of `waiting`, so that marks of earlier lists do not count

    FreeList free;
    // Those whose proxies were removed since the tables were last settled: the next update has to tell
    // these from the next ones. What came and went in between is free at once, unless it was reported.
    FreeList removed;
    FreeList removedImmediate;

    // Of each index now, and at the last update: 2 * index, and one behind. Empty until a proxy has others
    // than ProxyGroups{}; as long as records then. The same as numbers.
    std::vector<ProxyGroups> groups;
    GroupKinds groupKinds;

    // In the table's order as of the last update, then what has joined since. What has left since
    // is still listed, with a NaN box, unless it had joined since. What a change appends to, this, `woken`
    // and `waiting`, has room for all that are listed here or rest.
    std::vector<std::uint32_t> mobile;
    std::size_t mobileAtUpdate = 0;       // how many there were at the last update
    std::vector<std::uint32_t> woken;     // indices that have left rest since the last update
    RoomyList<std::uint32_t> waiting;     // what changed since the mobile table was built
    std::vector<std::uint32_t> sweeping;  // when the last update began; in `mobile`, too

    // When a shift of the origin has rounded boxes since the last update: the boxes of that update in the
    // coordinates of then. By index, or, where few indices have proxies, by place in indicesAtUpdate.
    // Those that are missing had no proxy.
    std::vector<Box> boxesAtUpdate;
    FlatSet indicesAtUpdate;

    // --- An index --------------------------------------------------------------------------------

    /// The proxy that has the index, or the last one that had.
    [[nodiscard]] ProxyId idOf(std::uint32_t proxyIndex) const noexcept {
        return {proxyIndex, (records[proxyIndex].generation - 1) | 1};
    }
    [[nodiscard]] bool isAlive(std::uint32_t proxyIndex) const noexcept {
        return (records[proxyIndex].generation & 1) != 0;
    }
    [[nodiscard]] bool contains(ProxyId id) const noexcept {
        return !id.isNull() && id.index < records.size() &&
               records[id.index].generation == id.generation;
    }
    [[nodiscard]] bool isWaiting(const Record<Scalar>& record) const noexcept {
        return record.listedIn == listNumber;
    }
    [[nodiscard]] bool changedNow(std::uint32_t proxyIndex) const noexcept {
        return records[proxyIndex].changedAt == updateNumber;
    }
    [[nodiscard]] bool rests(std::uint32_t proxyIndex) const noexcept {
        return records[proxyIndex].residency == Residency::resting;
    }

    /// The box by which an index makes pairs: NaN of what sweeps, which makes them on its way.
    [[nodiscard]] const Box& standingBox(const Record<Scalar>& record) const noexcept {
        return record.residency == Residency::sweeping ? nowhere() : record.box;
    }
    /// The same at the last update, of what has no slack.
    [[nodiscard]] const Box& standingBefore(const Record<Scalar>& record) const noexcept {
        return record.changedAt == updateNumber ? record.before : standingBox(record);
    }
    /// Not inline: MinGW's GCC exports no inline function that has a variable of its own.
    [[nodiscard]] static const Box& nowhere() noexcept;

    // --- Groups ----------------------------------------------------------------------------------

    [[nodiscard]] ProxyGroups groupsNow(std::uint32_t proxyIndex) const noexcept {
        return groups.empty() ? ProxyGroups{} : groups[2 * std::size_t{proxyIndex}];
    }
    [[nodiscard]] bool mayPairNow(std::uint32_t a, std::uint32_t b) const noexcept {
        return groups.empty() || mayPair(groupsNow(a), groupsNow(b));
    }
    /// At the last update.
    [[nodiscard]] bool couldPair(std::uint32_t a, std::uint32_t b) const noexcept {
        return groups.empty() ||
               mayPair(groups[1 + 2 * std::size_t{a}], groups[1 + 2 * std::size_t{b}]);
    }
    /// For searches among all proxies: null where all may pair.
    [[nodiscard]] const ProxyGroups* groupsOfAll() const noexcept {
        return groupKinds.someRefuse() ? groups.data() : nullptr;
    }
    /// The same as of the last update.
    [[nodiscard]] const ProxyGroups* groupsOfAllAtUpdate() const noexcept {
        const ProxyGroups* const now = groupsOfAll();
        return now != nullptr ? now + 1 : nullptr;
    }
    [[nodiscard]] GroupKinds::Set kindOf(std::uint32_t proxyIndex) const noexcept {
        return GroupKinds::bit(records[proxyIndex].kind);
    }
    /// Whether the two may not pair, by their kinds first, which mostly tell.
    [[nodiscard]] bool doRefuse(std::uint32_t a, std::uint32_t b) const noexcept {
        return groupKinds.refuse(records[a].kind, records[b].kind) && !mayPairNow(a, b);
    }

    // --- Lists -----------------------------------------------------------------------------------

    /// Makes room for records of so many indices. Throws std::length_error beyond 2^28.
    void reserveRecords(std::size_t indexCount);
    /// Makes room in `mobile`, `woken` and `waiting`.
    void reserveLists(std::size_t count);
    /// Makes groups for all that are there, with room for as many as records has room for.
    void makeGroups();
    void setGroups(std::uint32_t proxyIndex, const ProxyGroups& of) noexcept;

    /// Lists the index among the mobile ones, and notes where.
    void listMobile(std::uint32_t proxyIndex) noexcept;
    void unlistMobile(std::uint32_t proxyIndex) noexcept;
    /// Whether the index's proxy, which is marked as changed, was added since the last update.
    [[nodiscard]] bool isUnseen(std::uint32_t proxyIndex) const noexcept;
    void append(std::uint32_t proxyIndex, FreeList& list) noexcept;
    /// From now on the indices may be given away again.
    void giveBack(FreeList& list) noexcept;
    /// As new, but for what tells ids of before apart, and room in what changes append to.
    void clear() noexcept;
    /// Begins an empty list of changes.
    void dropWaiting() noexcept;
    /// Begins to count updates at a small number: see Record::changedAt.
    void countUpdatesAnew(std::uint32_t updatesBeforeRest) noexcept;
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return records.capacity() * sizeof(records[0]) + groups.capacity() * sizeof(groups[0]) +
               (mobile.capacity() + woken.capacity() + waiting.capacity() + sweeping.capacity()) *
                   sizeof(mobile[0]) +
               boxesAtUpdate.capacity() * sizeof(Box) + indicesAtUpdate.memoryBytes();
    }
    /// See core/copy_parts.hpp. `number` stays, which stands for no other set than one has been told, and so does what
    /// reserve() and reports of bad data go by.
    void makeRoomFor(const Population& from);
    template <class Visit>
    static void forEachPart(Population& to, const Population& from, const Visit& visit) {
        visit(to.records, from.records);
        visit(to.size, from.size);
        visit(to.nanCount, from.nanCount);
        visit(to.updateNumber, from.updateNumber);
        visit(to.settledChanged, from.settledChanged);
        visit(to.firstGeneration, from.firstGeneration);
        visit(to.areRegrouped, from.areRegrouped);
        visit(to.listNumber, from.listNumber);
        visit(to.free, from.free);
        visit(to.removed, from.removed);
        visit(to.removedImmediate, from.removedImmediate);
        visit(to.groups, from.groups);
        visit(to.groupKinds, from.groupKinds);
        visit(to.mobile, from.mobile);
        visit(to.mobileAtUpdate, from.mobileAtUpdate);
        visit(to.woken, from.woken);
        visit(to.waiting, from.waiting);
        visit(to.sweeping, from.sweeping);
        visit(to.boxesAtUpdate, from.boxesAtUpdate);
        visit(to.indicesAtUpdate, from.indicesAtUpdate);
    }
    /// Drops free indices at the end, and sorts the others.
    void dropLastRecords();
};

extern template struct Population<float>;
extern template struct Population<double>;

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
