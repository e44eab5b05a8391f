// SPDX-License-Identifier: Zlib
#pragma once

// What a grid holds, and what it gives back after a peak: what only an update, a shift or a ray needs,
// room for more than there are, and indices at the end that have no proxy.

#include <broadphase/store/store.hpp>

#include <broadphase/core/caught.hpp>
#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace hashphase::detail {
namespace {

// Leaves room for `count`, where there is memory to move what is left to.
template <class Array>
void shrink(Array& array, std::size_t count) noexcept {
    if (array.capacity() <= std::max(count, array.size())) {
        return;
    }
    static_cast<void>(hasRoomFor([&] {
        Array fresh;
        fresh.reserve(std::max(count, array.size()));
        std::copy(array.begin(), array.end(), std::back_inserter(fresh));
        std::swap(array, fresh);
    }));
}

}  // namespace

template <class Scalar>
std::size_t Store<Scalar>::memoryBytes() const noexcept {
    std::size_t bytes = sizeof(*this) + proxies.memoryBytes() + frame.memoryBytes() +
                        (settling != nullptr ? settling->memoryBytes() : 0) +
                        (moveScratch != nullptr ? moveScratch->memoryBytes() : 0);
    Tables<Scalar>::forAll(tables, [&](const FiledTable<Scalar>& table) {
        bytes += table.memoryBytes() + table.tree.memoryBytes();
    });
    for (const FiledTable<Scalar>* late : {tables.sweeping.get(), tables.fresh.get()}) {
        bytes += late != nullptr ? sizeof(*late) : 0;
    }
    return bytes;
}

template <class Scalar>
std::size_t Store<Scalar>::rayMemoryBytes() const noexcept {
    std::size_t bytes = 0;
    Tables<Scalar>::forAll(
        tables, [&](const FiledTable<Scalar>& table) { bytes += table.tree.memoryBytes(); });
    return bytes;
}

template <class Scalar>
void Store<Scalar>::releaseRayMemory() noexcept {
    Tables<Scalar>::forAll(tables, [](FiledTable<Scalar>& table) {
        table.tree = {};
        table.makeTreeStale();
    });
}

// Where the last indices have proxies, room for records cannot be given back.
template <class Scalar>
void Store<Scalar>::releaseAfterPeak() noexcept {
    const auto& records = proxies.records;
    const bool isLastFree = !records.empty() && records.back().generation % 2 == 0;
    const std::size_t room = std::max(proxies.mobile.capacity(), isLastFree ? records.size() : 0);
    if (peaks.isPast(std::max(listedCount(), proxies.reservedCount), room)) {
        releaseMemory();
    }
    const std::size_t staged = std::max(frame.now.capacity(), frame.boxes.capacity());
    if (mobilePeaks.isPast(proxies.mobile.size(), staged)) {
        freeArrays(frame.now, frame.before, frame.proxyIndices, frame.boxes);
        tables.mobile.releaseUnusedMemory();
        tables.resting.releaseUnusedMemory();
    }
}

template <class Scalar>
void Store<Scalar>::releaseMemory() noexcept {
    beforeChange();
    tables.fresh.reset();
    if (tables.sweeping != nullptr && tables.sweeping->size() == 0) {
        tables.sweeping.reset();
    }
    wakeSettled();
    const auto fileRestingAgain = [&] {
        listResting();
        fileResting(serialFor);
    };
    // What was erased is still listed in the table.
    if (tables.restingErased > 0 && !hasRoomFor(fileRestingAgain)) {
        wakeAll();
    }
    static_cast<void>(hasRoomFor([&] { proxies.dropLastRecords(); }));  // or they are kept
    shrink(proxies.records, proxies.reservedCount);
    shrink(proxies.groups, proxies.groups.empty() ? 0 : 2 * proxies.records.capacity());
    shrink(proxies.mobile, std::max(listedCount(), proxies.reservedCount));
    shrink(proxies.woken, proxies.mobile.capacity());
    shrink(proxies.waiting, proxies.mobile.capacity() + proxies.waiting.size());
    freeArrays(frame.now, frame.before, frame.proxyIndices, frame.boxes);
    settling.reset();
    moveScratch.reset();
    if (proxies.boxesAtUpdate.empty()) {
        freeArrays(proxies.boxesAtUpdate);
        proxies.indicesAtUpdate = {};
    }
    Tables<Scalar>::forAll(tables, [](FiledTable<Scalar>& table) {
        table.releaseUnusedMemory();
        if (table.isTreeStale.load(std::memory_order_relaxed)) {
            table.tree = {};
        } else {
            table.tree.releaseUnusedMemory();
        }
    });
}

}  // namespace hashphase::detail
