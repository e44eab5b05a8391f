// SPDX-License-Identifier: Zlib

// A shift of the origin. Most boxes can be shifted without rounding, and then nothing else changes:
// they stay in their cells, at rest, and pairs. Those that are rounded count as moved.

#include <broadphase/grid.hpp>

#include <broadphase/detail/origin_shift.hpp>

namespace hashphase {

template <class Scalar>
std::size_t Grid<Scalar>::shiftOrigin(const Point& shift) {
    HASHPHASE_ASSERT(shift.allFinite(), "The origin is shifted by what is finite.");
    if (!shift.allFinite() || shift.isZero(0)) {
        return 0;
    }
    roundedBefore_.clear();
    std::size_t roundedCount = 0;
    for (std::uint32_t slot = 0; slot < records_.size(); ++slot) {
        roundedCount += shiftRecord(slot, shift) ? 1 : 0;
    }
    if (hasPairs_ && !roundedBefore_.empty() && boxesAtUpdate_.empty()) {
        keepBoxesAtUpdate(shift);
    }
    shiftTables(shift);
    return roundedCount;
}

// Returns whether the slot's box was rounded.
template <class Scalar>
bool Grid<Scalar>::shiftRecord(std::uint32_t slot, const Point& shift) {
    Record& record = records_[slot];
    const bool isRounded = detail::isRounded(record.box, shift);
    if (isRounded || (changedNow(slot) && detail::isRounded(record.before, shift))) {
        roundedBefore_.push_back({slot, before(slot)});
    }
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

// Boxes that were rounded do not tell any more what overlapped at the last update. What was not
// rounded comes back as it was.
template <class Scalar>
void Grid<Scalar>::keepBoxesAtUpdate(const Point& shift) {
    boxesAtUpdate_.reserve(records_.size());
    for (std::uint32_t slot = 0; slot < records_.size(); ++slot) {
        boxesAtUpdate_.push_back(detail::shiftedBox<Scalar>(before(slot), -shift));
    }
    for (const auto& [slot, box] : roundedBefore_) {
        boxesAtUpdate_[slot] = box;
    }
}

template <class Scalar>
void Grid<Scalar>::shiftTables(const Point& shift) {
    if (!resting_.shiftOrigin(shift)) {
        listResting();
        fileResting(serialFor);
    }
    if (!mobile_.shiftOrigin(shift)) {
        // The update that is due files them, or a query before it.
        manyWait_.store(true, std::memory_order_release);
        if (cost_.changed == 0) {
            fileIfMany();
        }
    }
    mobileTree_.isStale.store(true, std::memory_order_relaxed);
    restingTree_.isStale.store(true, std::memory_order_relaxed);
}

template std::size_t Grid<float>::shiftOrigin(const Point&);
template std::size_t Grid<double>::shiftOrigin(const Point&);
template bool Grid<float>::shiftRecord(std::uint32_t, const Point&);
template bool Grid<double>::shiftRecord(std::uint32_t, const Point&);
template void Grid<float>::keepBoxesAtUpdate(const Point&);
template void Grid<double>::keepBoxesAtUpdate(const Point&);
template void Grid<float>::shiftTables(const Point&);
template void Grid<double>::shiftTables(const Point&);

}  // namespace hashphase
