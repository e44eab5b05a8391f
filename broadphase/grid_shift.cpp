// SPDX-License-Identifier: Zlib

// A shift of the origin. Most boxes can be shifted without rounding, and then nothing else changes:
// they stay in their cells, at rest, and pairs. Those that are rounded count as moved.

#include <broadphase/grid.hpp>

#include <broadphase/geometry/origin_shift.hpp>
#include <broadphase/sweeps.hpp>

#include <new>

namespace hashphase {

template <class Scalar>
std::size_t Grid<Scalar>::shiftOrigin(const Point& shift) {
    HASHPHASE_ASSERT(shift.allFinite(), "The origin is shifted by what is finite.");
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this),
                     "The origin is not shifted within a query.");
    if (!shift.allFinite() || shift.isZero(0)) {
        return 0;
    }
    beforeChange();
    if (hasPairs_ && boxesAtUpdate_.empty()) {
        keepBoxesAtUpdate(shift);
    }
    ++shiftCount_;
    ++populationNumber_;
    std::size_t roundedCount = 0;
    forEachListed([&](std::uint32_t slot) { roundedCount += shiftRecord(slot, shift) ? 1 : 0; });
    for (auto* sweeps = firstSweeps_; sweeps != nullptr; sweeps = sweeps->next_) {
        sweeps->shiftOrigin(shift);
    }
    shiftTables(shift);
    return roundedCount;
}

// Boxes that are rounded will not tell any more what overlapped at the last update. Of the others
// nothing is lost, and they compare as they did.
template <class Scalar>
void Grid<Scalar>::keepBoxesAtUpdate(const Point& shift) {
    bool someAreRounded = false;
    forEachListed([&](std::uint32_t slot) {
        const Record& record = records_[slot];
        someAreRounded =
            someAreRounded || detail::isRounded(record.box, shift) ||
            (record.changedAt == updateNumber_ && detail::isRounded(record.before, shift));
    });
    if (!someAreRounded) {
        return;
    }
    const bool areFew = isSparse();
    const std::size_t count = areFew ? listedCount() : records_.size();
    boxesAtUpdate_.reserve(count);
    if (areFew) {
        slotsAtUpdate_.reserve(count);
    }
    forEachListed([&](std::uint32_t slot) {
        if (!areFew || slotsAtUpdate_.findOrInsert(slot) == boxesAtUpdate_.size()) {
            boxesAtUpdate_.push_back(before(slot));
        }
    });
}

// Returns whether the slot's box was rounded.
template <class Scalar>
bool Grid<Scalar>::shiftRecord(std::uint32_t slot, const Point& shift) noexcept {
    Record& record = records_[slot];
    const bool isRounded = detail::isRounded(record.box, shift);
    if (isRounded) {
        record.restsAtOnce = record.restsAtOnce || record.place == Place::resting;
        noteChange(slot);
    }
    record.box = detail::shiftedBox(record.box, shift);
    if (changedNow(slot)) {
        record.before = detail::shiftedBox(record.before, shift);
    }
    return isRounded;
}

// By now all boxes are shifted: where there is no memory to file them anew, who asks first does it, or
// the next update that finds a change.
template <class Scalar>
void Grid<Scalar>::shiftTables(const Point& shift) {
    const bool isRestFiled = resting_.shiftOrigin(shift);
    const bool isSweepingFiled = sweeping_ == nullptr || sweeping_->table.shiftOrigin(shift);
    const bool isMobileFiled = mobile_.shiftOrigin(shift) && isSweepingFiled;
    forTables(*this, [](auto& /*table*/, TableTree& tree) {
        tree.isStale.store(true, std::memory_order_relaxed);
    });
    if (!isMobileFiled) {
        isTableTorn_.store(true, std::memory_order_release);
    }
    try {
        if (!isRestFiled) {
            listResting();
            fileResting(serialFor);
        }
        if (!isMobileFiled && cost_.changed == 0) {
            mendTables();
        }
    } catch (const std::bad_alloc&) {
        wakeAll();
    }
}

template std::size_t Grid<float>::shiftOrigin(const Point&);
template std::size_t Grid<double>::shiftOrigin(const Point&);
template void Grid<float>::keepBoxesAtUpdate(const Point&);
template bool Grid<float>::shiftRecord(std::uint32_t, const Point&) noexcept;
template void Grid<double>::keepBoxesAtUpdate(const Point&);
template bool Grid<double>::shiftRecord(std::uint32_t, const Point&) noexcept;
template void Grid<float>::shiftTables(const Point&);
template void Grid<double>::shiftTables(const Point&);

}  // namespace hashphase
