// SPDX-License-Identifier: Zlib

// How an update files what has changed, in passes.

#include <broadphase/grid.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/prefetch.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace hashphase {
namespace {

// Resting proxies are refiled when this many want to join or have left: often enough to be of use,
// and seldom enough to be cheap for each of them.
std::size_t worthRefiling(std::size_t restingCount) {
    return std::max<std::size_t>(32, restingCount / 8);
}

}  // namespace

// Copies the mobile boxes side by side. Slots that are near each other in space are near each other
// in mobileSlots_, but anywhere in records_.
template <class Scalar>
void Grid<Scalar>::stage(ParallelFor parallelFor, bool isForQueries) {
    constexpr std::size_t kGrain = 4096;
    constexpr std::size_t kAhead = 12;
    const std::size_t count = mobileSlots_.size();
    staged_.resize(count);
    stagedBefore_.resize(hasPairs_ ? count : 0);
    detail::ensureCapacity(nanSlots_, nanCount_);  // for settle()
    quietCount_ = 0;
    const bool someRefuse = groupKinds_.someRefuse();  // else nobody asks for kinds
    mobileKinds_ = 0;
    changedKinds_ = 0;
    parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
        std::uint32_t quietCount = 0;
        detail::GroupKinds::Set mobileKinds = 0;
        detail::GroupKinds::Set changedKinds = 0;
        for (std::size_t i = begin; i < end; ++i) {
            if (i + kAhead < count) {
                detail::prefetch(&records_[mobileSlots_[i + kAhead]]);
            }
            const Record& record = records_[mobileSlots_[i]];
            staged_[i] = detail::padded(isForQueries ? record.box : standingBox(record));
            if (hasPairs_) {
                stagedBefore_[i] = detail::padded(boxAtUpdate(mobileSlots_[i]));
            }
            quietCount += isQuiet(record) ? 1 : 0;
            if (someRefuse) {
                const detail::GroupKinds::Set kind = detail::GroupKinds::bit(record.kind);
                mobileKinds |= kind;
                changedKinds |= record.changedAt == updateNumber_ ? kind : 0;
            }
        }
        quietCount_ += quietCount;
        mobileKinds_ |= mobileKinds;
        changedKinds_ |= changedKinds;
    });
}

// Quiet proxies leave the mobile ones when enough have gathered, or enough others have left rest, to
// be worth filing the resting ones anew. Returns whether any did.
template <class Scalar>
bool Grid<Scalar>::putQuietToRest(ParallelFor parallelFor) {
    const std::size_t filedCount = resting_.size() - restingErased_;
    if (std::max<std::uint32_t>(quietCount_, restingErased_) < worthRefiling(filedCount)) {
        return false;
    }
    // Those that stay at rest come first, then those that join.
    detail::ensureCapacity(restSlots_, filedCount + quietCount_);
    detail::ensureCapacity(restBoxes_, filedCount + quietCount_);
    listResting();
    for (std::size_t i = 0; quietCount_ > 0 && i < mobileSlots_.size(); ++i) {
        Record& record = records_[mobileSlots_[i]];
        if (record.place == Place::mobile && isQuiet(record)) {
            record.place = Place::resting;
            restSlots_.push_back(mobileSlots_[i]);
            restBoxes_.push_back(staged_[i]);
            staged_[i] = detail::padded(nanBox());
        }
    }
    fileResting(parallelFor);
    return quietCount_ > 0;
}

// Those that are at rest, in the order of their table.
template <class Scalar>
void Grid<Scalar>::listResting() {
    restSlots_.clear();
    restBoxes_.clear();
    for (const std::uint32_t slot : resting_.entrySlots()) {
        if (records_[slot].place == Place::resting) {
            restSlots_.push_back(slot);
            restBoxes_.push_back(detail::padded(records_[slot].box));
        }
    }
}

template <class Scalar>
void Grid<Scalar>::fileResting(ParallelFor parallelFor) {
    resting_.build(restSlots_, restBoxes_, fixedSizes(), parallelFor, groupsOfAll());
    restingKinds_ = 0;
    for (std::uint32_t entry = 0; entry < resting_.size(); ++entry) {
        records_[resting_.slot(entry)].listedAt = entry;
        restingKinds_ |= kindOf(resting_.slot(entry));
    }
    restingErased_ = 0;
    restingTree_.isStale.store(true, std::memory_order_relaxed);
    cost_.filed += resting_.size();
}

template <class Scalar>
void Grid<Scalar>::fileMobile(ParallelFor parallelFor) {
    isFresh_.store(false, std::memory_order_relaxed);
    isTableTorn_.store(true, std::memory_order_relaxed);  // should it fail, the next one files anew
    mobile_.build(mobileSlots_, staged_, fixedSizes(), parallelFor, groupsOfAll());
    ++filingCount_;
    mobileTree_.isStale.store(true, std::memory_order_relaxed);
    cost_.filed += mobile_.size();
    fileSweeping(parallelFor);
    dropList();
    isTableTorn_.store(false, std::memory_order_release);
}

template <class Scalar>
void Grid<Scalar>::dropList() noexcept {
    waiting_.clear();
    if (++listNumber_ == 0) {  // nothing is left of those who have the numbers that come again
        listNumber_ = 1;
        for (Record& record : records_) {
            record.listedIn = 0;
        }
    }
    waitingRead_.store(0, std::memory_order_relaxed);
}

// What sweeps is filed apart, for queries: their boxes may be many times as large as those of what
// stands, and no pair is looked for by them.
template <class Scalar>
void Grid<Scalar>::fileSweeping(ParallelFor parallelFor) {
    std::erase_if(sweepingSlots_,
                  [this](std::uint32_t slot) { return records_[slot].place != Place::sweeping; });
    if (sweepingSlots_.empty()) {
        clearSweeping();
        return;
    }
    if (sweeping_ == nullptr) {
        sweeping_ = std::make_unique<LateTable>();
    }
    sweepingBoxes_.clear();
    for (const std::uint32_t slot : sweepingSlots_) {
        sweepingBoxes_.push_back(detail::padded(records_[slot].box));
    }
    sweeping_->table.build(sweepingSlots_, sweepingBoxes_, fixedSizes(), parallelFor);
    sweeping_->tree.isStale.store(true, std::memory_order_relaxed);
    cost_.filed += sweeping_->table.size();
}

template <class Scalar>
void Grid<Scalar>::clearSweeping() noexcept {
    if (sweeping_ != nullptr) {
        sweeping_->table.clear();
        sweeping_->tree.isStale.store(true, std::memory_order_relaxed);
    }
}

// Lists the mobile proxies in the order of their table, for the next time, and forgets those that
// have left, whose slots may be given away again.
template <class Scalar>
void Grid<Scalar>::settle() noexcept {
    nanSlots_.clear();
    if (mobile_.size() != mobileSlots_.size() && nanCount_ > 0) {
        std::copy_if(mobileSlots_.begin(), mobileSlots_.end(), std::back_inserter(nanSlots_),
                     [this](std::uint32_t slot) { return records_[slot].isNan; });
    }
    mobileSlots_.assign(mobile_.entrySlots().begin(), mobile_.entrySlots().end());
    if (sweeping_ != nullptr) {
        const std::span<const std::uint32_t> sweeping = sweeping_->table.entrySlots();
        mobileSlots_.insert(mobileSlots_.end(), sweeping.begin(), sweeping.end());
    }
    mobileSlots_.insert(mobileSlots_.end(), nanSlots_.begin(), nanSlots_.end());
    listedAtUpdate_ = mobileSlots_.size();
    giveBack(removed_);
    giveBack(removedAnnounced_);
}

template <class Scalar>
UpdateCost Grid<Scalar>::endUpdate() noexcept {
    cost_.resting = resting_.size() - restingErased_;
    double finest = std::numeric_limits<double>::infinity();
    const Reading reading = presentReading();
    for (const Filing& filing : reading.filings()) {
        cost_.largestCell = std::max(cost_.largestCell, filing.table->largestCell());
        finest = std::min(finest, filing.table->finestCellSize());
    }
    woken_.clear();
    boxesAtUpdate_.clear();
    slotsAtUpdate_.clear();
    if (std::exchange(areRegrouped_, false)) {
        for (std::size_t i = 0; i < groups_.size(); i += 2) {
            groups_[i + 1] = groups_[i];
        }
    }
    if (++updateNumber_ == std::numeric_limits<std::uint32_t>::max()) {
        countUpdatesAnew();
    }
    if (config_.cellSize == 0 && !isTableTorn_.load(std::memory_order_relaxed)) {
        cellSize_ = std::isinf(finest) ? Scalar(1) : static_cast<Scalar>(finest);
    }
    return std::exchange(cost_, {});
}

// After 2^32 updates the numbers would come round to those of the first ones, and what has not
// changed since then would seem to have changed just now. All that matters is how long ago a change
// was, up to when a proxy comes to rest.
template <class Scalar>
void Grid<Scalar>::countUpdatesAnew() noexcept {
    const std::uint32_t longAgo = config_.updatesBeforeRest + 1;
    for (Record& record : records_) {
        record.changedAt = longAgo - std::min(updateNumber_ - record.changedAt, longAgo);
    }
    updateNumber_ = longAgo;
}

template <class Scalar>
UpdateCost Grid<Scalar>::update(ParallelFor parallelFor) {
    HASHPHASE_ASSERT(!hasPairs_, "Where there are Pairs, Pairs::update() ends the frame.");
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this), "An update is not begun within a query.");
    if (hasPairs_ || detail::QueryScope::isWithin(this)) {
        return {};
    }
    releaseAfterPeak();
    if (cost_.changed > 0) {
        try {
            stage(parallelFor);
            static_cast<void>(putQuietToRest(parallelFor));
            fileMobile(parallelFor);
        } catch (...) {
            wakeAll();
            throw;
        }
        settle();
    }
    return endUpdate();
}

template <class Scalar>
void Grid<Scalar>::forgetLastUpdate() noexcept {
    forEachListed([this](std::uint32_t slot) {
        if (isAlive(slot)) {
            noteChange(slot);
        }
        records_[slot].before = nanBox();
        records_[slot].isAnnounced = false;
    });
    boxesAtUpdate_.clear();
    slotsAtUpdate_.clear();
    isTorn_ = false;
}

// Whoever has been put to rest by now is still listed among the mobile ones; who rested before is not.
template <class Scalar>
void Grid<Scalar>::wakeAll() noexcept {
    for (const std::uint32_t slot : mobileSlots_) {
        Record& record = records_[slot];
        record.place = record.place == Place::resting ? Place::mobile : record.place;
    }
    for (std::uint32_t slot = 0; slot < records_.size(); ++slot) {
        if (records_[slot].place == Place::resting) {
            records_[slot].place = Place::mobile;
            listMobile(slot);
            woken_.push_back(slot);
        }
    }
    isTorn_ = true;
    resting_.clear();
    restingErased_ = 0;
    restingTree_.isStale.store(true, std::memory_order_relaxed);
    isFresh_.store(false, std::memory_order_relaxed);
    isTableTorn_.store(true, std::memory_order_relaxed);
}

template void Grid<float>::stage(ParallelFor, bool);
template bool Grid<float>::putQuietToRest(ParallelFor);
template void Grid<float>::listResting();
template void Grid<float>::fileResting(ParallelFor);
template void Grid<float>::fileMobile(ParallelFor);
template void Grid<float>::fileSweeping(ParallelFor);
template void Grid<float>::clearSweeping() noexcept;
template void Grid<float>::settle() noexcept;
template UpdateCost Grid<float>::endUpdate() noexcept;
template void Grid<float>::countUpdatesAnew() noexcept;
template UpdateCost Grid<float>::update(ParallelFor);
template void Grid<float>::wakeAll() noexcept;
template void Grid<float>::forgetLastUpdate() noexcept;
template void Grid<float>::dropList() noexcept;
template void Grid<double>::stage(ParallelFor, bool);
template bool Grid<double>::putQuietToRest(ParallelFor);
template void Grid<double>::listResting();
template void Grid<double>::fileResting(ParallelFor);
template void Grid<double>::fileMobile(ParallelFor);
template void Grid<double>::fileSweeping(ParallelFor);
template void Grid<double>::clearSweeping() noexcept;
template void Grid<double>::settle() noexcept;
template UpdateCost Grid<double>::endUpdate() noexcept;
template void Grid<double>::countUpdatesAnew() noexcept;
template UpdateCost Grid<double>::update(ParallelFor);
template void Grid<double>::wakeAll() noexcept;
template void Grid<double>::forgetLastUpdate() noexcept;
template void Grid<double>::dropList() noexcept;

}  // namespace hashphase
