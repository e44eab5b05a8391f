// SPDX-License-Identifier: Zlib

// What a grid holds, and what it gives back after a peak: what only an update, a shift or a ray needs,
// room for more than there are, and slots at the end that have no proxy.

#include <broadphase/grid.hpp>

#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>
#include <new>

namespace hashphase {
namespace {

// Leaves room for `count`, where there is memory to move what is left to.
template <class Array>
void shrink(Array& array, std::size_t count) noexcept {
    if (array.capacity() <= std::max(count, array.size())) {
        return;
    }
    try {
        Array fresh;
        fresh.reserve(std::max(count, array.size()));
        fresh.insert(fresh.end(), array.begin(), array.end());
        array.swap(fresh);
    } catch (const std::bad_alloc&) {
    }
}

}  // namespace

template <class Scalar>
std::size_t Grid<Scalar>::memoryBytes() const noexcept {
    std::size_t tableBytes = 0;
    forTables(*this,
              [&](const auto& table, const auto& /*tree*/) { tableBytes += table.memoryBytes(); });
    for (const LateTable* late : {sweeping_.get(), fresh_.get()}) {
        tableBytes += late != nullptr ? sizeof(*late) : 0;
    }
    return sizeof(*this) + records_.capacity() * sizeof(Record) +
           (waiting_.capacity() + mobileSlots_.capacity() + woken_.capacity() +
            restSlots_.capacity() + nanSlots_.capacity() + sweepingSlots_.capacity()) *
               sizeof(std::uint32_t) +
           boxesAtUpdate_.capacity() * sizeof(Box) + slotsAtUpdate_.memoryBytes() +
           groups_.capacity() * sizeof(ProxyGroups) +
           (staged_.capacity() + stagedBefore_.capacity() + restBoxes_.capacity() +
            sweepingBoxes_.capacity()) *
               sizeof(detail::PaddedBox<Scalar>) +
           tableBytes + rayMemoryBytes();
}

template <class Scalar>
std::size_t Grid<Scalar>::rayMemoryBytes() const noexcept {
    std::size_t bytes = 0;
    forTables(*this, [&](const auto& /*table*/, const TableTree& tree) {
        bytes += tree.tree.memoryBytes();
    });
    return bytes;
}

template <class Scalar>
void Grid<Scalar>::releaseRayMemory() noexcept {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this),
                     "What rays read is not freed within a query.");
    forTables(*this, [](auto& /*table*/, TableTree& tree) {
        tree.tree = {};
        tree.isStale.store(true, std::memory_order_relaxed);
    });
}

template <class Scalar>
void Grid<Scalar>::releaseUnusedMemory() noexcept {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this),
                     "Memory is not given back within a query.");
    reservedCount_ = 0;
    releaseMemory();
}

// Where the last slots have proxies, room for records cannot be given back.
template <class Scalar>
void Grid<Scalar>::releaseAfterPeak() noexcept {
    const bool isLastFree = !records_.empty() && records_.back().generation % 2 == 0;
    const std::size_t room = std::max(mobileSlots_.capacity(), isLastFree ? records_.size() : 0);
    if (peaks_.isPast(std::max(listedCount(), reservedCount_), room)) {
        releaseMemory();
    }
}

template <class Scalar>
void Grid<Scalar>::releaseMemory() noexcept {
    beforeChange();
    fresh_.reset();
    if (sweeping_ != nullptr && sweeping_->table.size() == 0) {
        sweeping_.reset();
    }
    if (restingErased_ > 0) {  // and is still listed in the table
        try {
            listResting();
            fileResting(serialFor);
        } catch (const std::bad_alloc&) {
            wakeAll();
        }
    }
    try {
        dropLastSlots();
    } catch (const std::bad_alloc&) {  // they are kept
    }
    shrink(records_, reservedCount_);
    shrink(groups_, groups_.empty() ? 0 : 2 * records_.capacity());
    shrink(mobileSlots_, std::max(listedCount(), reservedCount_));
    shrink(woken_, mobileSlots_.capacity());
    shrink(waiting_, mobileSlots_.capacity());
    detail::freeArrays(staged_, stagedBefore_, restSlots_, restBoxes_, nanSlots_, sweepingBoxes_);
    if (boxesAtUpdate_.empty()) {
        detail::freeArrays(boxesAtUpdate_);
        slotsAtUpdate_ = {};
    }
    forTables(*this, [](detail::Table<Scalar>& table, TableTree& tree) {
        table.releaseUnusedMemory();
        if (tree.isStale.load(std::memory_order_relaxed)) {
            tree.tree = {};
        } else {
            tree.tree.releaseUnusedMemory();
        }
    });
}

// Slots at the end of which nothing tells any more go. Of the others, the lowest are given away first, so
// that those at the end may go later. A new slot begins with a generation that none at its place has had.
template <class Scalar>
void Grid<Scalar>::dropLastSlots() {
    std::vector<std::uint32_t> slots;
    slots.reserve(free_.count);
    for (std::uint32_t slot = free_.first; slot != kNoSlot; slot = records_[slot].listedAt) {
        slots.push_back(slot);
    }
    std::sort(slots.begin(), slots.end());
    std::erase_if(sweepingSlots_,
                  [this](std::uint32_t slot) { return records_[slot].place != Place::sweeping; });
    constexpr std::uint32_t kOld = detail::kLastGeneration / 2;
    while (!slots.empty() && slots.back() + 1 == records_.size() && !isWaiting(records_.back()) &&
           records_.back().generation < kOld) {
        firstGeneration_ = std::max(firstGeneration_, records_.back().generation);
        records_.pop_back();
        slots.pop_back();
    }
    if (!groups_.empty()) {  // nor are they afterwards
        groups_.resize(2 * std::max<std::size_t>(records_.size(), 1));
    }
    free_ = {};
    for (; !slots.empty(); slots.pop_back()) {
        append(slots.back(), free_);
    }
}

template <class Scalar>
std::size_t Grid<Scalar>::listFew(std::vector<std::uint32_t>& few) const {
    few.clear();
    if (!isSparse()) {
        return records_.size();
    }
    forEachListed([&](std::uint32_t slot) {
        if (isAlive(slot)) {
            few.push_back(slot);
        }
    });
    std::sort(few.begin(), few.end());
    return few.size();
}

template std::size_t Grid<float>::memoryBytes() const noexcept;
template std::size_t Grid<float>::rayMemoryBytes() const noexcept;
template void Grid<float>::releaseRayMemory() noexcept;
template void Grid<float>::releaseUnusedMemory() noexcept;
template void Grid<float>::releaseAfterPeak() noexcept;
template void Grid<float>::releaseMemory() noexcept;
template void Grid<float>::dropLastSlots();
template std::size_t Grid<float>::listFew(std::vector<std::uint32_t>&) const;
template std::size_t Grid<double>::memoryBytes() const noexcept;
template std::size_t Grid<double>::rayMemoryBytes() const noexcept;
template void Grid<double>::releaseRayMemory() noexcept;
template void Grid<double>::releaseUnusedMemory() noexcept;
template void Grid<double>::releaseAfterPeak() noexcept;
template void Grid<double>::releaseMemory() noexcept;
template void Grid<double>::dropLastSlots();
template std::size_t Grid<double>::listFew(std::vector<std::uint32_t>&) const;

}  // namespace hashphase
