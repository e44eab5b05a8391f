// SPDX-License-Identifier: Zlib
#include <broadphase/grid.hpp>

#include <broadphase/detail/limits.hpp>
#include <broadphase/detail/prefetch.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hashphase {
namespace {

// Reading the waiting list costs each query about a nanosecond a proxy, filing costs about ten for
// every mobile proxy: this many waiting proxies balance the two for a write and a query in turn.
std::size_t manyWaiting(std::size_t mobileCount) {
    return 64 + mobileCount / 128;
}

// Resting proxies are refiled when this many want to join or have left: often enough to be of use,
// and seldom enough to be cheap for each of them.
std::size_t worthRefiling(std::size_t restingCount) {
    return std::max<std::size_t>(32, restingCount / 8);
}

void checkProxyCount(std::size_t count) {
    detail::checkCount(count, detail::kMostProxies, "A grid holds at most 268,435,456 proxies.");
}

const GridConfig& checked(const GridConfig& config) {
    const std::string error = configError(config);
    if (!error.empty()) {
        throw std::invalid_argument(error);
    }
    return config;
}

}  // namespace

template <class Scalar>
Grid<Scalar>::Grid(const GridConfig& config) : config_(checked(config)) {
    if (config_.cellSize > 0) {
        fixedSizes_ = detail::fixedLevels(config_.cellSize, config_.levelRatio);
        cellSize_ = static_cast<Scalar>(config_.cellSize);
    }
}

// --- Proxies -------------------------------------------------------------------------------------

template <class Scalar>
ProxyId Grid<Scalar>::add(const Box& box, Mobility mobility) {
    if (freeSlots_.empty()) {
        checkProxyCount(records_.size() + 1);
        records_.emplace_back();
        freeSlots_.push_back(static_cast<std::uint32_t>(records_.size()) - 1);
    }
    const std::uint32_t slot = freeSlots_.back();
    freeSlots_.pop_back();
    Record& record = records_[slot];
    ++record.generation;
    record.place = Place::mobile;
    record.changedAt = 0;
    mobileSlots_.push_back(slot);
    ++size_;
    noteChange(slot);
    setBox(record, box);
    record.restsAtOnce = mobility == Mobility::resting;
    return idOf(slot);
}

template <class Scalar>
void Grid<Scalar>::reserve(std::size_t count) {
    checkProxyCount(count);
    // At least doubled, or a program that asks for a few more each time would move all each time.
    const auto makeRoom = [count](auto& array) {
        if (array.capacity() < count) {
            array.reserve(std::max(count, 2 * array.capacity()));
        }
    };
    makeRoom(records_);
    makeRoom(mobileSlots_);
}

template <class Scalar>
void Grid<Scalar>::move(ProxyId id, const Box& box) {
    HASHPHASE_ASSERT(contains(id), "Only a proxy of this grid that was not removed can be moved.");
    Record& record = records_[id.index];
    if (!isSameBits(record.box, box)) {
        noteChange(id.index);
        setBox(record, box);
    }
}

template <class Scalar>
void Grid<Scalar>::remove(ProxyId id) {
    HASHPHASE_ASSERT(contains(id),
                     "Only a proxy of this grid that was not removed can be removed.");
    const std::uint32_t slot = id.index;
    noteChange(slot);
    Record& record = records_[slot];
    nanCount_ -= record.isNan ? 1 : 0;
    record.isNan = false;
    record.box = nanBox();
    record.place = Place::nowhere;
    ++record.generation;
    removedSlots_.push_back(slot);
    --size_;
}

template <class Scalar>
bool Grid<Scalar>::contains(ProxyId id) const noexcept {
    return !id.isNull() && id.index < records_.size() &&
           records_[id.index].generation == id.generation;
}

template <class Scalar>
const Aabb<Scalar>& Grid<Scalar>::box(ProxyId id) const {
    HASHPHASE_ASSERT(contains(id), "Only a proxy of this grid that was not removed has a box.");
    return records_[id.index].box;
}

// To be called before every change of a slot's box.
template <class Scalar>
void Grid<Scalar>::noteChange(std::uint32_t slot) {
    Record& record = records_[slot];
    if (record.changedAt != updateNumber_) {
        record.before = record.box;
        record.changedAt = updateNumber_;
        ++cost_.changed;
    }
    if (record.place == Place::resting) {
        leaveRest(slot);
    }
    if (!record.isWaiting && !manyWait_.load(std::memory_order_relaxed)) {
        record.isWaiting = true;
        waiting_.push_back(slot);
        if (waiting_.size() > manyWaiting(mobileSlots_.size())) {
            manyWait_.store(true, std::memory_order_release);
        }
    }
}

template <class Scalar>
void Grid<Scalar>::leaveRest(std::uint32_t slot) {
    Record& record = records_[slot];
    resting_.erase(record.restingEntry);
    ++restingErased_;
    record.place = Place::mobile;
    mobileSlots_.push_back(slot);
    woken_.push_back(slot);
}

template <class Scalar>
void Grid<Scalar>::setBox(Record& record, const Box& box) {
    record.box = box;
    record.restsAtOnce = false;
    const bool isNan = hasNan(box);
    nanCount_ += isNan && !record.isNan ? 1 : 0;
    nanCount_ -= record.isNan && !isNan ? 1 : 0;
    record.isNan = isNan;
    if (isNan && !nanReported_) {
        nanReported_ = true;
        detail::reportMessage(
            "A box with a NaN coordinate was set. It will pair with nothing and be found by "
            "nothing until a box without NaN is set; further ones are counted silently.");
    }
}

// --- Filing --------------------------------------------------------------------------------------

// Copies the mobile boxes side by side. Slots that are near each other in space are near each other
// in mobileSlots_, but anywhere in records_.
template <class Scalar>
void Grid<Scalar>::stage(ParallelFor parallelFor) {
    constexpr std::size_t kGrain = 4096;
    constexpr std::size_t kAhead = 12;
    const std::size_t count = mobileSlots_.size();
    staged_.resize(count);
    stagedBefore_.resize(hasPairs_ ? count : 0);
    quietCount_ = 0;
    parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
        std::uint32_t quietCount = 0;
        for (std::size_t i = begin; i < end; ++i) {
            if (i + kAhead < count) {
                detail::prefetch(&records_[mobileSlots_[i + kAhead]]);
            }
            const Record& record = records_[mobileSlots_[i]];
            staged_[i] = detail::padded(record.box);
            if (hasPairs_) {
                stagedBefore_[i] = detail::padded(boxAtUpdate(mobileSlots_[i]));
            }
            quietCount += isQuiet(record) ? 1 : 0;
        }
        quietCount_ += quietCount;
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
    for (const std::uint32_t slot : resting_.slots()) {
        if (records_[slot].place == Place::resting) {
            restSlots_.push_back(slot);
            restBoxes_.push_back(detail::padded(records_[slot].box));
        }
    }
}

template <class Scalar>
void Grid<Scalar>::fileResting(ParallelFor parallelFor) {
    resting_.build(restSlots_, restBoxes_, fixedSizes_, parallelFor);
    for (std::uint32_t entry = 0; entry < resting_.size(); ++entry) {
        records_[resting_.slot(entry)].restingEntry = entry;
    }
    restingErased_ = 0;
    restingTree_.isStale.store(true, std::memory_order_relaxed);
    cost_.filed += resting_.size();
}

template <class Scalar>
void Grid<Scalar>::fileMobile(ParallelFor parallelFor) {
    mobile_.build(mobileSlots_, staged_, fixedSizes_, parallelFor);
    ++filingCount_;
    mobileTree_.isStale.store(true, std::memory_order_relaxed);
    cost_.filed += mobile_.size();
    for (const std::uint32_t slot : waiting_) {
        records_[slot].isWaiting = false;
    }
    waiting_.clear();
    manyWait_.store(false, std::memory_order_release);
}

// Lists the mobile proxies in the order of their table, for the next time, and forgets those that
// have left. Only now may a slot be given away again: nobody has to tell its old proxy from the
// next one any more.
template <class Scalar>
void Grid<Scalar>::settle() {
    nanSlots_.clear();
    if (mobile_.size() != mobileSlots_.size() && nanCount_ > 0) {
        std::copy_if(mobileSlots_.begin(), mobileSlots_.end(), std::back_inserter(nanSlots_),
                     [this](std::uint32_t slot) { return records_[slot].isNan; });
    }
    mobileSlots_.assign(mobile_.slots().begin(), mobile_.slots().end());
    mobileSlots_.insert(mobileSlots_.end(), nanSlots_.begin(), nanSlots_.end());
    freeSlots_.insert(freeSlots_.end(), removedSlots_.begin(), removedSlots_.end());
    removedSlots_.clear();
}

template <class Scalar>
void Grid<Scalar>::endUpdate() {
    woken_.clear();
    boxesAtUpdate_.clear();
    cost_ = {};
    if (++updateNumber_ == std::numeric_limits<std::uint32_t>::max()) {
        countUpdatesAnew();
    }
    if (config_.cellSize == 0) {
        const double finest = std::min(mobile_.finestCellSize(), resting_.finestCellSize());
        cellSize_ = std::isinf(finest) ? Scalar(1) : static_cast<Scalar>(finest);
    }
}

// After 2^32 updates the numbers would come round to those of the first ones, and what has not
// changed since then would seem to have changed just now. All that matters is how long ago a change
// was, up to when a proxy comes to rest.
template <class Scalar>
void Grid<Scalar>::countUpdatesAnew() {
    const std::uint32_t longAgo = config_.updatesBeforeRest + 1;
    for (Record& record : records_) {
        record.changedAt = longAgo - std::min(updateNumber_ - record.changedAt, longAgo);
    }
    updateNumber_ = longAgo;
}

template <class Scalar>
UpdateCost Grid<Scalar>::update(ParallelFor parallelFor) {
    HASHPHASE_ASSERT(!hasPairs_, "Where there are Pairs, Pairs::update() ends the frame.");
    if (cost_.changed > 0) {
        stage(parallelFor);
        static_cast<void>(putQuietToRest(parallelFor));
        fileMobile(parallelFor);
        settle();
    }
    cost_.resting = resting_.size() - restingErased_;
    const UpdateCost cost = cost_;
    endUpdate();
    return cost;
}

template <class Scalar>
void Grid<Scalar>::fileIfMany() const {
    if (!manyWait_.load(std::memory_order_acquire)) {
        return;
    }
    // The one write on behalf of readers: no reader has passed this point while many wait, and the
    // first to come here files for all. The grid itself is never a const object: it is created by
    // its owner, and only seen as const by readers.
    auto& self = const_cast<Grid&>(*this);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    const std::lock_guard lock(self.filing_);
    if (manyWait_.load(std::memory_order_relaxed)) {
        self.stage(serialFor);
        self.fileMobile(serialFor);
        if (!hasPairs_) {
            self.settle();
        }
    }
}

// As fileIfMany(): a write on behalf of readers, none of whom passes before it is done.
template <class Scalar>
void Grid<Scalar>::growTrees() const {
    auto& self = const_cast<Grid&>(*this);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    const std::lock_guard lock(self.filing_);
    const auto grow = [](TableTree& tree, const detail::Table<Scalar>& table) {
        if (tree.isStale.load(std::memory_order_relaxed)) {
            tree.tree.build(table);
            tree.isStale.store(false, std::memory_order_release);
        }
    };
    grow(self.mobileTree_, mobile_);
    grow(self.restingTree_, resting_);
}

// --- Cells ---------------------------------------------------------------------------------------

template <class Scalar>
std::array<std::int64_t, 3> Grid<Scalar>::cellAt(const Point& point) const {
    HASHPHASE_ASSERT(point.allFinite(), "Only a finite point lies in a cell.");
    std::array<std::int64_t, 3> cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double scaled = std::floor(static_cast<double>(point[static_cast<int>(axis)]) /
                                         static_cast<double>(cellSize()));
        constexpr auto last = static_cast<double>(detail::kLastCell);
        cell[axis] = static_cast<std::int64_t>(std::clamp(scaled, -last, last));
    }
    return cell;
}

template <class Scalar>
CellRange Grid<Scalar>::cellsOf(ProxyId id) const {
    return {cellAt(box(id).min()), cellAt(box(id).max())};
}

// --- Accounts ------------------------------------------------------------------------------------

template <class Scalar>
std::size_t Grid<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) + records_.capacity() * sizeof(Record) +
           (freeSlots_.capacity() + removedSlots_.capacity() + waiting_.capacity() +
            mobileSlots_.capacity() + woken_.capacity() + restSlots_.capacity() +
            nanSlots_.capacity()) *
               sizeof(std::uint32_t) +
           boxesAtUpdate_.capacity() * sizeof(Box) + roundedBefore_.capacity() * sizeof(SlotBox) +
           (staged_.capacity() + stagedBefore_.capacity() + restBoxes_.capacity()) *
               sizeof(detail::PaddedBox<Scalar>) +
           mobile_.memoryBytes() + resting_.memoryBytes() + mobileTree_.tree.memoryBytes() +
           restingTree_.tree.memoryBytes();
}

template <class Scalar>
std::string Grid<Scalar>::validate() const {
    fileIfMany();
    // How often each proxy stands where a query would look for it.
    std::vector<std::uint32_t> timesFound(records_.size(), 0);
    for (const detail::Table<Scalar>* table : {&mobile_, &resting_}) {
        if (std::string error = table->validate(); !error.empty()) {
            return error;
        }
        for (std::uint32_t entry = 0; entry < table->size(); ++entry) {
            const std::uint32_t slot = table->slot(entry);
            if (hasNan(table->box(entry)) || !isFiled(slot)) {
                continue;
            }
            ++timesFound[slot];
            if (!isSameBits(table->box(entry), records_[slot].box)) {
                return "A filed proxy's entry has the proxy's box: broken.";
            }
        }
    }
    for (const TableTree* table : {&mobileTree_, &restingTree_}) {
        if (std::string error = table->tree.validate(); !error.empty()) {
            return error;
        }
    }
    for (const std::uint32_t slot : waiting_) {
        timesFound[slot] += isAlive(slot) ? 1 : 0;
    }
    std::size_t alive = 0;
    for (std::uint32_t slot = 0; slot < records_.size(); ++slot) {
        alive += isAlive(slot) ? 1 : 0;
        const bool isNan = records_[slot].isNan && !records_[slot].isWaiting;
        if (timesFound[slot] != (isAlive(slot) && !isNan ? 1U : 0U)) {
            return "Every proxy alive is filed in exactly one table, or waits in the list of "
                   "changes, or is NaN: broken.";
        }
    }
    return alive == size_ ? std::string() : "size() is the number of proxies alive: broken.";
}

template class Grid<float>;
template class Grid<double>;

}  // namespace hashphase
