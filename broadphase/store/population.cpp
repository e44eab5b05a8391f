// SPDX-License-Identifier: Zlib
#include <broadphase/store/population.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/limits.hpp>

#include <algorithm>
#include <limits>

namespace hashphase::detail {
namespace {

// At least doubled, or a program that asks for a few more each time would move all each time.
std::size_t roomFor(std::size_t count, std::size_t present) {
    const std::size_t twice = std::min(2 * present, kMostProxies);
    return std::max<std::size_t>({count, twice, 8});
}

}  // namespace

template <class Scalar>
void Population<Scalar>::reserveRecords(std::size_t indexCount) {
    checkCount(indexCount, kMostProxies,
               "A grid holds at most 268,435,456 proxies. Remove some, or use another grid.");
    if (indexCount <= records.capacity()) {
        return;
    }
    const std::size_t room = roomFor(indexCount, records.capacity());
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

// As reserve() and add() do.
template <class Scalar>
void Population<Scalar>::makeRoomFor(const Population& from) {
    reserveRecords(from.records.size());
    reserveLists(std::min(from.mobile.capacity(), from.records.size()));
    waiting.reserve(mobile.capacity() + from.waiting.size());  // which may be of none that is left
    if (!from.groups.empty()) {
        groups.reserve(2 * records.capacity());
    }
}

template <class Scalar>
void Population<Scalar>::makeGroups() {
    if (groups.empty()) {
        reserveRecords(1);
        const std::size_t count = std::max<std::size_t>(records.size(), 1);
        groups.reserve(2 * records.capacity());
        groups.resize(2 * count);
    }
}

template <class Scalar>
void Population<Scalar>::setGroups(std::uint32_t proxyIndex, const ProxyGroups& of) noexcept {
    std::uint8_t& kind = records[proxyIndex].kind;
    const bool isKnown = kind != GroupKinds::kOther && groupKinds[kind] == of;
    kind = isKnown ? kind : groupKinds.numberOf(of);
    groups[2 * std::size_t{proxyIndex}] = of;
}

template <class Scalar>
void Population<Scalar>::listMobile(std::uint32_t proxyIndex) noexcept {
    records[proxyIndex].listedAt = static_cast<std::uint32_t>(mobile.size());
    mobile.push_back(proxyIndex);
}

// The last one takes its place: no order holds among those that have joined since the last update.
template <class Scalar>
void Population<Scalar>::unlistMobile(std::uint32_t proxyIndex) noexcept {
    const std::uint32_t last = mobile.back();
    mobile[records[proxyIndex].listedAt] = last;
    if (isAlive(last)) {
        records[last].listedAt = records[proxyIndex].listedAt;
    }
    mobile.pop_back();
}

// What is listed at its place behind those of the last update was at rest then, or was not yet.
template <class Scalar>
bool Population<Scalar>::isUnseen(std::uint32_t proxyIndex) const noexcept {
    const Record<Scalar>& record = records[proxyIndex];
    return record.listedAt >= mobileAtUpdate && record.listedAt < mobile.size() &&
           mobile[record.listedAt] == proxyIndex && hasNan(record.before);
}

template <class Scalar>
void Population<Scalar>::append(std::uint32_t proxyIndex, FreeList& list) noexcept {
    records[proxyIndex].listedAt = list.first;
    list.last = list.first == kNoProxyIndex ? proxyIndex : list.last;
    list.first = proxyIndex;
    ++list.count;
}

template <class Scalar>
void Population<Scalar>::giveBack(FreeList& list) noexcept {
    if (list.first != kNoProxyIndex) {
        records[list.last].listedAt = free.first;
        free.first = list.first;
        free.count += list.count;
        list = {};
    }
}

// Indices in the order in which a new grid makes them.
template <class Scalar>
void Population<Scalar>::clear() noexcept {
    free = removed = removedImmediate = {};
    for (auto proxyIndex = static_cast<std::uint32_t>(records.size()); proxyIndex > 0;) {
        --proxyIndex;
        const std::uint32_t generation = records[proxyIndex].generation;
        records[proxyIndex] = {};
        records[proxyIndex].generation = generation + (generation & 1);
        if (records[proxyIndex].generation != kLastGeneration) {
            append(proxyIndex, free);
        }
    }
    size = nanCount = 0;
    ++number;
    nanReported = areRegrouped = false;
    updateNumber = 1;
    waiting.clear();
    mobile.clear();
    woken.clear();
    mobileAtUpdate = 0;
    listNumber = 1;
    settledChanged = 0;
    freeArrays(sweeping, boxesAtUpdate, groups);
    indicesAtUpdate = {};
    groupKinds = GroupKinds();  // Clang 14 forgets the destructor of {}
}

template <class Scalar>
void Population<Scalar>::dropWaiting() noexcept {
    waiting.clear();
    if (listNumber < std::numeric_limits<decltype(listNumber)>::max()) {
        ++listNumber;
        return;
    }
    // Nothing is left of those who have the numbers that come again.
    listNumber = 1;
    for (Record<Scalar>& record : records) {
        record.listedIn = 0;
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

// Of the indices that are left, the lowest are given away first, so that those at the end may go later. A
// new index begins with a generation that none at its place has had.
template <class Scalar>
void Population<Scalar>::dropLastRecords() {
    std::vector<std::uint32_t> proxyIndices;
    proxyIndices.reserve(free.count);
    for (std::uint32_t proxyIndex = free.first; proxyIndex != kNoProxyIndex;
         proxyIndex = records[proxyIndex].listedAt) {
        proxyIndices.push_back(proxyIndex);
    }
    std::sort(proxyIndices.begin(), proxyIndices.end());
    std::erase_if(sweeping, [this](std::uint32_t proxyIndex) {
        return records[proxyIndex].residency != Residency::sweeping;
    });
    constexpr std::uint32_t kOld = kLastGeneration / 2;
    while (!proxyIndices.empty() && proxyIndices.back() + 1 == records.size() &&
           !isWaiting(records.back()) && records.back().generation < kOld) {
        firstGeneration = std::max(firstGeneration, records.back().generation);
        records.pop_back();
        proxyIndices.pop_back();
    }
    if (!groups.empty()) {  // nor are they afterwards
        groups.resize(2 * std::max<std::size_t>(records.size(), 1));
    }
    free = {};
    // First those that are in the list of changes, in which there is no room for others in their place. What
    // is appended last is given away first.
    for (const bool isInList : {false, true}) {
        std::for_each(proxyIndices.rbegin(), proxyIndices.rend(), [&](std::uint32_t proxyIndex) {
            if (isWaiting(records[proxyIndex]) == isInList) {
                append(proxyIndex, free);
            }
        });
    }
}

template <class Scalar>
auto Population<Scalar>::nowhere() noexcept -> const Box& {
    static const Box box = nanBox<Scalar>();
    return box;
}

template struct HASHPHASE_INSTANCE_EXPORT Population<float>;
template struct HASHPHASE_INSTANCE_EXPORT Population<double>;

}  // namespace hashphase::detail
