// SPDX-License-Identifier: Zlib
#include <broadphase/store/population.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/limits.hpp>

#include <algorithm>

namespace hashphase::detail {
namespace {

// At least doubled, or a program that asks for a few more each time would move all each time.
std::size_t roomFor(std::size_t count, std::size_t present) {
    const std::size_t twice = std::min(2 * present, kMostProxies);
    return std::max<std::size_t>({count, twice, 8});
}

}  // namespace

template <class Scalar>
void Population<Scalar>::reserveSlots(std::size_t slotCount) {
    checkCount(slotCount, kMostProxies, "A grid holds at most 268,435,456 proxies.");
    if (slotCount <= records.capacity()) {
        return;
    }
    const std::size_t room = roomFor(slotCount, records.capacity());
    if (!groups.empty()) {
        groups.reserve(2 * room);
    }
    records.reserve(room);  // last: the others have room for as many
}

template <class Scalar>
void Population<Scalar>::reserveLists(std::size_t count) {
    if (count <= mobile.capacity()) {
        return;
    }
    const std::size_t room = roomFor(count, mobile.capacity());
    woken.reserve(room);
    waiting.reserve(room);
    mobile.reserve(room);  // last: the others have room for as many
}

template <class Scalar>
void Population<Scalar>::makeGroups() {
    if (groups.empty()) {
        reserveSlots(1);
        const std::size_t count = std::max<std::size_t>(records.size(), 1);
        groups.reserve(2 * records.capacity());
        groups.resize(2 * count);
    }
}

template <class Scalar>
void Population<Scalar>::setGroups(std::uint32_t slot, const ProxyGroups& of) noexcept {
    std::uint8_t& kind = records[slot].kind;
    const bool isKnown = kind != GroupKinds::kOther && groupKinds[kind] == of;
    kind = isKnown ? kind : groupKinds.numberOf(of);
    groups[2 * std::size_t{slot}] = of;
}

template <class Scalar>
void Population<Scalar>::listMobile(std::uint32_t slot) noexcept {
    records[slot].listedAt = static_cast<std::uint32_t>(mobile.size());
    mobile.push_back(slot);
}

// The last one takes its place: no order holds among those that have joined since the last update.
template <class Scalar>
void Population<Scalar>::unlistMobile(std::uint32_t slot) noexcept {
    const std::uint32_t last = mobile.back();
    mobile[records[slot].listedAt] = last;
    if (isAlive(last)) {
        records[last].listedAt = records[slot].listedAt;
    }
    mobile.pop_back();
}

// What is listed at its place behind those of the last update was at rest then, or was not yet.
template <class Scalar>
bool Population<Scalar>::isUnseen(std::uint32_t slot) const noexcept {
    const Record<Scalar>& record = records[slot];
    return record.listedAt >= mobileAtUpdate && record.listedAt < mobile.size() &&
           mobile[record.listedAt] == slot && hasNan(record.before);
}

template <class Scalar>
void Population<Scalar>::append(std::uint32_t slot, SlotList& list) noexcept {
    records[slot].listedAt = list.first;
    list.last = list.first == kNoSlot ? slot : list.last;
    list.first = slot;
    ++list.count;
}

template <class Scalar>
void Population<Scalar>::giveBack(SlotList& list) noexcept {
    if (list.first != kNoSlot) {
        records[list.last].listedAt = free.first;
        free.first = list.first;
        free.count += list.count;
        list = {};
    }
}

// Slots in the order in which a new grid makes them.
template <class Scalar>
void Population<Scalar>::clear() noexcept {
    free = removed = removedImmediate = {};
    for (auto slot = static_cast<std::uint32_t>(records.size()); slot-- > 0;) {
        const std::uint32_t generation = records[slot].generation;
        records[slot] = {};
        records[slot].generation = generation + (generation & 1);
        if (records[slot].generation != kLastGeneration) {
            append(slot, free);
        }
    }
    size = nanCount = 0;
    ++number;
    nanReported = areRegrouped = false;
    updateNumber = 1;
    for (std::vector<std::uint32_t>* list : {&waiting, &mobile, &woken}) {
        list->clear();
    }
    mobileAtUpdate = 0;
    listNumber = 1;
    freeArrays(sweeping, boxesAtUpdate, groups);
    slotsAtUpdate = {};
    groupKinds = {};
}

template <class Scalar>
void Population<Scalar>::dropWaiting() noexcept {
    waiting.clear();
    if (++listNumber == 0) {  // nothing is left of those who have the numbers that come again
        listNumber = 1;
        for (Record<Scalar>& record : records) {
            record.listedIn = 0;
        }
    }
}

// After 2^32 updates the numbers would come round to those of the first ones, and what has not
// changed since then would seem to have changed just now. All that matters is how long ago a change
// was, up to when a proxy comes to rest.
template <class Scalar>
void Population<Scalar>::countUpdatesAnew(std::uint32_t updatesBeforeRest) noexcept {
    const std::uint32_t longAgo = updatesBeforeRest + 1;
    for (Record<Scalar>& record : records) {
        record.changedAt = longAgo - std::min(updateNumber - record.changedAt, longAgo);
    }
    updateNumber = longAgo;
}

// Of the slots that are left, the lowest are given away first, so that those at the end may go later. A
// new slot begins with a generation that none at its place has had.
template <class Scalar>
void Population<Scalar>::dropLastSlots() {
    std::vector<std::uint32_t> slots;
    slots.reserve(free.count);
    for (std::uint32_t slot = free.first; slot != kNoSlot; slot = records[slot].listedAt) {
        slots.push_back(slot);
    }
    std::sort(slots.begin(), slots.end());
    std::erase_if(sweeping, [this](std::uint32_t slot) {
        return records[slot].residency != Residency::sweeping;
    });
    constexpr std::uint32_t kOld = kLastGeneration / 2;
    while (!slots.empty() && slots.back() + 1 == records.size() && !isWaiting(records.back()) &&
           records.back().generation < kOld) {
        firstGeneration = std::max(firstGeneration, records.back().generation);
        records.pop_back();
        slots.pop_back();
    }
    if (!groups.empty()) {  // nor are they afterwards
        groups.resize(2 * std::max<std::size_t>(records.size(), 1));
    }
    free = {};
    for (; !slots.empty(); slots.pop_back()) {
        append(slots.back(), free);
    }
}

template struct Population<float>;
template struct Population<double>;

}  // namespace hashphase::detail
