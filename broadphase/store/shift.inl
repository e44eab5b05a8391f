// SPDX-License-Identifier: Zlib
#pragma once

// A shift of the origin. Most boxes can be shifted without rounding, and then nothing else changes:
// they stay in their cells, at rest, and pairs. Those that are rounded count as moved.

#include <broadphase/store/store.hpp>

#include <broadphase/core/caught.hpp>
#include <broadphase/geometry/origin_shift.hpp>
#include <broadphase/store/motions.hpp>

namespace hashphase::detail {

template <class Scalar>
std::size_t Store<Scalar>::shiftOrigin(const Point& shift) {
    beforeChange();
    wakeSettled();  // the boxes by which they are filed would be rounded
    if (hasPairs && proxies.boxesAtUpdate.empty()) {
        keepBoxesAtUpdate(shift);
    }
    ++shiftCount;
    ++proxies.number;
    std::size_t roundedCount = 0;
    forEachListed(
        [&](std::uint32_t proxyIndex) { roundedCount += shiftRecord(proxyIndex, shift) ? 1 : 0; });
    for (auto* motions = firstMotions; motions != nullptr; motions = motions->next) {
        motions->shiftOrigin(shift);
    }
    shiftTables(shift);
    return roundedCount;
}

// Boxes that are rounded will not tell any more what overlapped at the last update. Of the others
// nothing is lost, and they compare as they did.
template <class Scalar>
void Store<Scalar>::keepBoxesAtUpdate(const Point& shift) {
    bool someAreRounded = false;
    forEachListed([&](std::uint32_t proxyIndex) {
        const Record& record = proxies.records[proxyIndex];
        someAreRounded =
            someAreRounded || isRounded(record.box, shift) ||
            (record.changedAt == proxies.updateNumber && isRounded(record.before, shift));
    });
    if (!someAreRounded) {
        return;
    }
    const bool areFew = isSparse();
    const std::size_t count = areFew ? listedCount() : proxies.records.size();
    proxies.boxesAtUpdate.reserve(count);
    if (areFew) {
        proxies.indicesAtUpdate.reserve(count);
    }
    forEachListed([&](std::uint32_t proxyIndex) {
        if (!areFew ||
            proxies.indicesAtUpdate.findOrInsert(proxyIndex) == proxies.boxesAtUpdate.size()) {
            proxies.boxesAtUpdate.push_back(before(proxyIndex));
        }
    });
}

// Returns whether the proxy's box was rounded.
template <class Scalar>
bool Store<Scalar>::shiftRecord(std::uint32_t proxyIndex, const Point& shift) noexcept {
    Record& record = proxies.records[proxyIndex];
    const bool isRounded = detail::isRounded(record.box, shift);
    if (isRounded) {
        record.restsAtOnce = record.restsAtOnce || record.residency == Residency::resting;
        markChanged(proxyIndex);
    }
    record.box = shiftedBox(record.box, shift);
    if (proxies.changedNow(proxyIndex)) {
        record.before = shiftedBox(record.before, shift);
    }
    return isRounded;
}

// By now all boxes are shifted: where there is no memory to file them anew, who asks first does it, or
// the next update that finds a change.
template <class Scalar>
void Store<Scalar>::shiftTables(const Point& shift) {
    const bool isRestFiled = tables.resting.shiftOrigin(shift);
    const bool isSweepingFiled = tables.sweeping == nullptr || tables.sweeping->shiftOrigin(shift);
    const bool isMobileFiled = tables.mobile.shiftOrigin(shift) && isSweepingFiled;
    Tables<Scalar>::forAll(tables, [](FiledTable<Scalar>& table) { table.makeTreeStale(); });
    if (!isMobileFiled) {
        tables.mustRefileMobile.store(true, std::memory_order_release);
    }
    const auto fileAgain = [&] {
        if (!isRestFiled) {
            listResting();
            fileResting(serialFor);
        }
        if (!isMobileFiled && cost.changed == 0) {
            mendTables();
        }
    };
    if (!hasRoomFor(fileAgain)) {
        wakeAll();
    }
}

}  // namespace hashphase::detail
