// SPDX-License-Identifier: Zlib
#pragma once

// How proxies that stay near where they are settle, move within their slack, and leave it.

#include <broadphase/store/store.hpp>

#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace hashphase::detail {
namespace {

// Who stays within its slack for so many updates has paid for being settled; for so many more slack would not pay.
constexpr std::uint32_t kWorthSettling = 16;
constexpr std::uint32_t kWorthMoreSlack = 64;
constexpr std::uint8_t kMostSlackFactor = 128;
constexpr std::uint8_t kMostPatience = 16;

// Of all coordinates.
template <class Scalar>
Scalar longestMove(const Aabb<Scalar>& now, const Aabb<Scalar>& before) {
    return std::max((now.min() - before.min()).cwiseAbs().maxCoeff(),
                    (now.max() - before.max()).cwiseAbs().maxCoeff());
}

template <class Scalar>
Aabb<Scalar> grownBy(const Aabb<Scalar>& box, Scalar slack) {
    const auto all = Vector3<Scalar>::Constant(slack);
    return {box.min() - all, box.max() + all};
}

}  // namespace

template <class Scalar>
bool Store<Scalar>::observesNow() const noexcept {
    return maySettleWithSlack && config.slack != 0 && !areFew() &&
           proxies.updateNumber % updatesObserved() == 0;
}

template <class Scalar>
void Store<Scalar>::makeTremors() {
    if (settling == nullptr) {
        settling = std::make_unique<Settling<Scalar>>();
    }
    ensureCapacity(settling->tremors, proxies.records.size());
    settling->tremors.resize(proxies.records.size());
}

template <class Scalar>
bool Store<Scalar>::hasTremor(std::uint32_t proxyIndex) const noexcept {
    return settling != nullptr && proxyIndex < settling->tremors.size();
}

// A proxy is calm while each coordinate moves by less than an eighth of the most slack that it may have, or than
// half of a fixed one. Without a branch, which could not be foreseen.
template <class Scalar>
bool Store<Scalar>::isCalm(const Record& record) const noexcept {
    const Scalar most = mostSlack(record.box) / (config.slack ? 2 : 8);
    const Scalar* const now = record.box.min().data();
    const Scalar* const before = record.before.min().data();
    const Scalar* const nowHigh = record.box.max().data();
    const Scalar* const beforeHigh = record.before.max().data();
    bool isNear = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        isNear &= std::abs(now[axis] - before[axis]) < most;
        isNear &= std::abs(nowHigh[axis] - beforeHigh[axis]) < most;
    }
    const bool wouldBe = record.changedAt == proxies.updateNumber ? isNear : bool{record.isCalm};
    return wouldBe && record.residency == Residency::mobile && !record.isNan;
}

template <class Scalar>
bool Store<Scalar>::observeCalm(std::uint32_t proxyIndex, Record& record) noexcept {
    const bool wasCalm = record.isCalm;
    record.isCalm = true;
    if (!hasTremor(proxyIndex)) {
        return false;  // until most are calm
    }
    constexpr auto kFades = Scalar(0.875);
    const bool isChanged = record.changedAt == proxies.updateNumber;
    const Scalar moved = isChanged ? longestMove(record.box, record.before) : Scalar(0);
    Tremor<Scalar>& tremor = settling->tremors[proxyIndex];
    tremor.reach = std::max(moved, wasCalm ? tremor.reach * kFades : Scalar(0));
    tremor.calmCount =
        wasCalm
            ? static_cast<std::uint16_t>(std::min(tremor.calmCount + updatesObserved(), 0xffffU))
            : std::uint16_t{0};
    return maySettle(proxyIndex, record);
}

// What travels is looked for among what is settled, which takes longer than to file and join all together: it
// pays where few travel.
template <class Scalar>
bool Store<Scalar>::isWorthSlack() const noexcept {
    if (settling == nullptr || settling->calmCount == 0) {
        return false;
    }
    const std::size_t travelCount = proxies.mobile.size() - settling->calmCount;
    return config.slack || settling->calmCount + settling->slackCount >= 7 * travelCount;
}

template <class Scalar>
bool Store<Scalar>::maySettle(std::uint32_t proxyIndex, const Record& record) const noexcept {
    if (!record.isCalm || record.isNan || !hasTremor(proxyIndex)) {
        return false;
    }
    const Tremor<Scalar>& tremor = settling->tremors[proxyIndex];
    return tremor.calmCount >= std::uint64_t{config.updatesBeforeRest} * tremor.patience &&
           slackOf(proxyIndex) > 0 && !record.box.isEmpty();
}

template <class Scalar>
Scalar Store<Scalar>::mostSlack(const Box& box) const noexcept {
    if (!maySettleWithSlack) {
        return 0;
    }
    constexpr Scalar kShareOfMeanEdge = 4;
    return config.slack ? static_cast<Scalar>(*config.slack)
                        : box.sizes().sum() * (1 / (3 * kShareOfMeanEdge));
}

template <class Scalar>
Scalar Store<Scalar>::slackOf(std::uint32_t proxyIndex) const noexcept {
    const Scalar most = mostSlack(proxies.records[proxyIndex].box);
    const Tremor<Scalar>& tremor = settling->tremors[proxyIndex];
    return config.slack ? most : std::min(most, tremor.reach * tremor.slackFactor);
}

// By as much larger as it may move.
template <class Scalar>
auto Store<Scalar>::boxToFile(std::uint32_t proxyIndex) const noexcept -> Box {
    const Record& record = proxies.records[proxyIndex];
    return record.hasSlack ? grownBy(record.box, slackOf(proxyIndex)) : record.box;
}

template <class Scalar>
auto Store<Scalar>::filedBox(std::uint32_t entry) const noexcept -> Box {
    const std::uint32_t proxyIndex = tables.resting.proxyIndex(entry);
    const Record& record = proxies.records[proxyIndex];
    if (record.residency != Residency::resting || !record.hasSlack) {
        return tables.resting.box(entry);
    }
    return isRestFiledNow() ? boxToFile(proxyIndex) : record.before;
}

template <class Scalar>
void Store<Scalar>::listMovedSettled() {
    constexpr std::size_t kMany = 4;
    if (settling == nullptr) {
        return;
    }
    if (proxies.settledChanged > 0 && areFew()) {
        wakeSettled();
    }
    settling->areManyChanged = proxies.settledChanged > tables.resting.size() / kMany;
    settling->changedEntries.clear();
    if (settling->areManyChanged || proxies.settledChanged == 0) {
        return;
    }
    for (const std::uint32_t proxyIndex : proxies.waiting) {
        const Record& record = proxies.records[proxyIndex];
        if (record.hasSlack) {
            settling->changedEntries.push_back(record.listedAt);
        }
    }
}

// In the order of the table, or where they are few in that of the changes, which is any.
template <class Scalar>
void Store<Scalar>::refreshSettled(ParallelFor parallelFor) {
    Table<Scalar>& table = tables.resting;
    if (!table.isSettled()) {
        return;
    }
    const Scalar* const corners = proxies.records.data()->box.min().data();
    if (settling->areManyChanged) {
        table.refreshAll(corners, Record::kStride, parallelFor);
        return;
    }
    for (const std::uint32_t entry : settling->changedEntries) {
        table.refresh(entry, corners, Record::kStride);
    }
}

template <class Scalar>
void Store<Scalar>::refreshFiled(ParallelFor parallelFor) {
    if (tables.resting.isSettled() && isRestFiledNow()) {
        tables.resting.refreshAll(proxies.records.data()->box.min().data(), Record::kStride,
                                  parallelFor);
    }
}

// At the end of an update that has filed them: from then on moves look whether they stay within.
template <class Scalar>
void Store<Scalar>::keepFiledBoxes() noexcept {
    for (const std::uint32_t proxyIndex : tables.resting.proxyIndices()) {
        Record& record = proxies.records[proxyIndex];
        if (record.hasSlack) {
            record.before = boxToFile(proxyIndex);
        }
    }
}

// Who leaves soon gets more slack the next time, or if there is no more, waits longer.
template <class Scalar>
void Store<Scalar>::noteLeft(std::uint32_t proxyIndex) noexcept {
    if (!proxies.records[proxyIndex].hasSlack) {
        return;
    }
    const std::uint32_t stayed = proxies.updateNumber - tables.settledAt;
    Tremor<Scalar>& tremor = settling->tremors[proxyIndex];
    const Scalar slack = tremor.reach * tremor.slackFactor;
    const bool isThereMore =
        tremor.slackFactor < kMostSlackFactor && slack < mostSlack(proxies.records[proxyIndex].box);
    if (isThereMore && stayed < kWorthMoreSlack) {
        tremor.slackFactor = static_cast<std::uint8_t>(2 * tremor.slackFactor);
    } else if (stayed < kWorthSettling) {
        tremor.patience = std::min<std::uint8_t>(2 * tremor.patience, kMostPatience);
        tremor.calmCount = 0;
    }
}

template <class Scalar>
void Store<Scalar>::wakeSettled() noexcept {
    if (!tables.resting.isSettled()) {
        return;
    }
    for (const std::uint32_t proxyIndex : tables.resting.proxyIndices()) {
        if (proxies.rests(proxyIndex) && proxies.records[proxyIndex].hasSlack) {
            wake(proxyIndex);
            listChange(proxyIndex);
            ++proxies.settledChanged;
        }
    }
    tables.resting.unsettle();
    observedEach = kOftenObserved;  // they tremble, and are to settle again
    // Who reads the tables alone is to find them as well.
    tables.mustRefileMobile.store(true, std::memory_order_release);
}

}  // namespace hashphase::detail
