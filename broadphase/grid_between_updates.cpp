// SPDX-License-Identifier: Zlib

// What queries read between updates, and when they file what has changed.

#include <broadphase/grid.hpp>

#include <algorithm>
#include <utility>

namespace hashphase {
namespace {

// So few changes are read by each query without further ado.
constexpr std::size_t kFewWait = 64;

}  // namespace

// Changes and queries may come in turn: filing for each query would cost far more than reading the
// list, and reading it for millions of queries far more than filing. So they read it until that has
// cost a third of what filing does, and then file: at most a third more than to file at once, which is
// right for many queries without a change in between, and a sixth more than the least there is for changes
// and queries in turn.
template <class Scalar>
std::uint64_t Grid<Scalar>::worthFiling() const noexcept {
    constexpr std::uint64_t kThirdOfFiling = 3;  // entries of the list, for each proxy
    return 1024 + kThirdOfFiling * mobile_.size();
}

template <class Scalar>
auto Grid<Scalar>::presentReading() const noexcept -> Reading {
    const auto late = [](const LateTable* table) -> Filing {
        return table != nullptr ? Filing{&table->table, &table->tree, false} : Filing{};
    };
    const bool isFresh = isFresh_.load(std::memory_order_acquire);
    return {{{isFresh ? late(fresh_.get()) : Filing{&mobile_, &mobileTree_, false},
              {&resting_, &restingTree_, true},
              late(sweeping_.get())}},
            isFresh};
}

template <class Scalar>
auto Grid<Scalar>::beginReading() const -> Reading {
    mendTables();
    const std::size_t count = waiting_.size();
    if (count > kFewWait && !isFresh_.load(std::memory_order_acquire) &&
        waitingRead_.fetch_add(count, std::memory_order_relaxed) + count > worthFiling()) {
        fileFresh(Lock::tryOnce);
    }
    return presentReading();
}

// What goes from near to far offers all that is filed first, then the list: a short one. How long does not
// depend on how many of them ask, so that each of many finds in the order in which it finds alone.
template <class Scalar>
auto Grid<Scalar>::beginReadingInOrder() const -> Reading {
    mendTables();
    if (waiting_.size() > kFewWait + mobile_.size() / 128 &&
        !isFresh_.load(std::memory_order_acquire)) {
        fileFresh(Lock::waitFor);
    }
    return presentReading();
}

template <class Scalar>
void Grid<Scalar>::expectQueries(std::size_t count) const {
    mendTables();
    if (waiting_.size() > kFewWait && !isFresh_.load(std::memory_order_acquire)) {
        const std::uint64_t read = waitingRead_.load(std::memory_order_relaxed);
        if (count > (worthFiling() - std::min(worthFiling(), read)) / waiting_.size()) {
            fileFresh(Lock::tryOnce);
        }
    }
}

// Two writes on behalf of readers. The grid itself is never a const object: it is created by its owner,
// and only seen as const by readers.

// No reader has passed this point while the table is torn, and the first to come here files for all.
template <class Scalar>
void Grid<Scalar>::mendTables() const {
    if (!isTableTorn_.load(std::memory_order_acquire)) {
        return;
    }
    auto& self = const_cast<Grid&>(*this);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    const std::lock_guard lock(self.filing_);
    if (isTableTorn_.load(std::memory_order_relaxed)) {
        self.stage(serialFor);
        self.fileMobile(serialFor);
        if (!hasPairs_) {
            self.settle();
        }
    }
}

// Others may be reading mobile_ and the list, and go on with them. None reads fresh_: since it was last
// in use, something has changed. From within a query that is not so, and nothing is filed.
template <class Scalar>
void Grid<Scalar>::fileFresh(Lock how) const {
    if (detail::QueryScope::isWithin(this)) {
        return;
    }
    auto& self = const_cast<Grid&>(*this);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    std::unique_lock lock(self.filing_, std::defer_lock);
    if (how == Lock::waitFor) {
        lock.lock();
    } else if (!lock.try_lock()) {
        return;
    }
    if (isFresh_.load(std::memory_order_relaxed)) {
        return;
    }
    if (fresh_ == nullptr) {
        self.fresh_ = std::make_unique<LateTable>();
    }
    LateTable& fresh = *self.fresh_;
    self.stage(serialFor, true);
    fresh.table.build(mobileSlots_, staged_, fixedSizes(), serialFor, groupsOfAll());
    fresh.tree.isStale.store(true, std::memory_order_relaxed);
    ++self.filingCount_;
    self.cost_.filed += fresh.table.size();
    self.isFresh_.store(true, std::memory_order_release);
}

// Before a change: what is fresh will not be so any more.
template <class Scalar>
void Grid<Scalar>::takeFresh() noexcept {
    isFresh_.store(false, std::memory_order_relaxed);
    if (detail::QueryScope::isWithin(this)) {
        return;
    }
    std::swap(mobile_, fresh_->table);
    std::swap(mobileTree_.tree, fresh_->tree.tree);
    mobileTree_.isStale.store(fresh_->tree.isStale.load(std::memory_order_relaxed),
                              std::memory_order_relaxed);
    if (fresh_->table.memoryBytes() == 0) {  // the first filing of all
        fresh_.reset();
    }
    clearSweeping();
    dropList();
    if (!hasPairs_) {
        settle();
    }
    forgetErased();
}

// What was at rest and has left it is listed until the next update, which may never come. Where all
// have left, as with a level, no query need look at them any more.
template <class Scalar>
void Grid<Scalar>::forgetErased() noexcept {
    if (restingErased_ > 0 && restingErased_ == resting_.size()) {
        resting_.clear();
        restingErased_ = 0;
        restingTree_.isStale.store(true, std::memory_order_relaxed);
    }
}

// As mendTables(): no ray passes before it is done.
template <class Scalar>
void Grid<Scalar>::growTrees(const Reading& reading) const {
    auto& self = const_cast<Grid&>(*this);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    const std::lock_guard lock(self.filing_);
    const auto grow = [](TableTree& tree, const detail::Table<Scalar>& table) {
        if (tree.isStale.load(std::memory_order_relaxed)) {
            tree.tree.build(table);
            tree.isStale.store(false, std::memory_order_release);
        }
    };
    reading.isFresh ? grow(fresh_->tree, fresh_->table) : grow(self.mobileTree_, mobile_);
    grow(self.restingTree_, resting_);
    if (sweeping_ != nullptr) {
        grow(sweeping_->tree, sweeping_->table);
    }
}

template auto Grid<float>::presentReading() const noexcept -> Reading;
template auto Grid<float>::beginReading() const -> Reading;
template auto Grid<float>::beginReadingInOrder() const -> Reading;
template std::uint64_t Grid<float>::worthFiling() const noexcept;
template void Grid<float>::expectQueries(std::size_t) const;
template void Grid<float>::mendTables() const;
template void Grid<float>::fileFresh(Lock) const;
template void Grid<float>::takeFresh() noexcept;
template void Grid<float>::forgetErased() noexcept;
template void Grid<float>::growTrees(const Reading&) const;
template auto Grid<double>::presentReading() const noexcept -> Reading;
template auto Grid<double>::beginReading() const -> Reading;
template auto Grid<double>::beginReadingInOrder() const -> Reading;
template std::uint64_t Grid<double>::worthFiling() const noexcept;
template void Grid<double>::expectQueries(std::size_t) const;
template void Grid<double>::mendTables() const;
template void Grid<double>::fileFresh(Lock) const;
template void Grid<double>::takeFresh() noexcept;
template void Grid<double>::forgetErased() noexcept;
template void Grid<double>::growTrees(const Reading&) const;

}  // namespace hashphase
