// SPDX-License-Identifier: Zlib
#include <broadphase/grid.hpp>

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
        HASHPHASE_ASSERT(records_.size() < (1U << 31), "A grid holds at most 2^31 proxies.");
        freeSlots_.push_back(static_cast<std::uint32_t>(records_.size()));
        records_.emplace_back();
        boxes_.emplace_back();
    }
    const std::uint32_t slot = freeSlots_.back();
    freeSlots_.pop_back();
    Record& record = records_[slot];
    ++record.generation;
    record.changedAt = 0;
    record.restsAtOnce = mobility == Mobility::resting;
    boxes_[slot] = box;
    ++size_;
    noteNan(slot, Box(Point::Zero(), Point::Zero()));
    noteChange(slot);
    return idOf(slot);
}

template <class Scalar>
void Grid<Scalar>::move(ProxyId id, const Box& box) {
    HASHPHASE_ASSERT(contains(id), "Only a proxy of this grid that was not removed can be moved.");
    const std::uint32_t slot = id.index;
    if (isSameBits(boxes_[slot], box)) {
        return;
    }
    const Box previous = boxes_[slot];
    boxes_[slot] = box;
    records_[slot].restsAtOnce = false;
    noteNan(slot, previous);
    noteChange(slot);
}

template <class Scalar>
void Grid<Scalar>::remove(ProxyId id) {
    HASHPHASE_ASSERT(contains(id),
                     "Only a proxy of this grid that was not removed can be removed.");
    const std::uint32_t slot = id.index;
    noteChange(slot);
    leaveTable(slot);
    nanCount_ -= hasNan(boxes_[slot]) ? 1 : 0;
    boxes_[slot].min().setConstant(std::numeric_limits<Scalar>::quiet_NaN());
    ++records_[slot].generation;
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
    return boxes_[id.index];
}

template <class Scalar>
void Grid<Scalar>::noteChange(std::uint32_t slot) {
    Record& record = records_[slot];
    if (record.changedAt != updateNumber_) {
        if (hasPairs_) {
            changes_.push_back({slot, record.changedAt});
        }
        record.changedAt = updateNumber_;
        ++cost_.changed;
    }
    if (!record.isWaiting) {
        record.isWaiting = true;
        waiting_.push_back(slot);
        if (waiting_.size() > manyWaiting(mobileSlots_.size())) {
            manyWait_.store(true, std::memory_order_release);
        }
    }
}

template <class Scalar>
void Grid<Scalar>::noteNan(std::uint32_t slot, const Box& previous) {
    nanCount_ -= nanCount_ > 0 && hasNan(previous) ? 1 : 0;
    if (!hasNan(boxes_[slot])) {
        return;
    }
    ++nanCount_;
    if (!nanReported_) {
        nanReported_ = true;
        detail::reportMessage(
            "A box with a NaN coordinate was set. It will pair with nothing and be found by "
            "nothing until a box without NaN is set; further ones are counted silently.");
    }
}

// --- Filing --------------------------------------------------------------------------------------

template <class Scalar>
void Grid<Scalar>::leaveTable(std::uint32_t slot) {
    Record& record = records_[slot];
    if (record.place == Place::mobile) {
        const std::uint32_t last = mobileSlots_.back();
        mobileSlots_[record.position] = last;
        records_[last].position = record.position;
        mobileSlots_.pop_back();
        mobileIsStale_ = true;
    } else if (record.place == Place::resting) {
        resting_.erase(record.position);
        ++restingErased_;
    }
    record.place = Place::nowhere;
}

template <class Scalar>
void Grid<Scalar>::fileOne(std::uint32_t slot) {
    Record& record = records_[slot];
    record.isWaiting = false;
    if (!isAlive(slot)) {
        return;
    }
    mobileIsStale_ = true;
    if (hasNan(boxes_[slot])) {
        leaveTable(slot);
        record.place = Place::nan;
    } else if (record.place != Place::mobile) {
        leaveTable(slot);
        record.place = Place::mobile;
        record.position = static_cast<std::uint32_t>(mobileSlots_.size());
        mobileSlots_.push_back(slot);
    }
}

template <class Scalar>
void Grid<Scalar>::fileWaiting() {
    for (const std::uint32_t slot : waiting_) {
        fileOne(slot);
    }
    waiting_.clear();
    if (!hasPairs_) {
        freeRemovedSlots();
    }
}

// Not before nobody has to tell the old proxy from the next one in its slot.
template <class Scalar>
void Grid<Scalar>::freeRemovedSlots() {
    freeSlots_.insert(freeSlots_.end(), removedSlots_.begin(), removedSlots_.end());
    removedSlots_.clear();
}

template <class Scalar>
void Grid<Scalar>::rebuildMobile() {
    if (mobileIsStale_) {
        mobile_.build(mobileSlots_, boxes_.data(), fixedSizes_);
        cost_.filed += mobile_.size();
        mobileIsStale_ = false;
        mobileTree_.isStale.store(true, std::memory_order_relaxed);
    }
    manyWait_.store(false, std::memory_order_release);
}

template <class Scalar>
void Grid<Scalar>::putQuietToRest() {
    const auto isQuiet = [this](std::uint32_t slot) {
        const Record& record = records_[slot];
        return record.changedAt != updateNumber_ &&
               (record.restsAtOnce || updateNumber_ - record.changedAt > config_.updatesBeforeRest);
    };
    const auto quietCount =
        static_cast<std::size_t>(std::count_if(mobileSlots_.begin(), mobileSlots_.end(), isQuiet));
    const std::size_t filedCount = resting_.size() - restingErased_;
    if (std::max<std::size_t>(quietCount, restingErased_) < worthRefiling(filedCount)) {
        return;
    }

    // Those that stay at rest come first, in the order of the table, then those that join.
    std::vector<std::uint32_t>& rest = scratch_;
    rest.clear();
    for (const std::uint32_t slot : resting_.slots()) {
        if (records_[slot].place == Place::resting) {
            rest.push_back(slot);
        }
    }
    std::copy_if(mobileSlots_.begin(), mobileSlots_.end(), std::back_inserter(rest), isQuiet);
    std::erase_if(mobileSlots_, isQuiet);
    for (std::uint32_t i = 0; i < mobileSlots_.size(); ++i) {
        records_[mobileSlots_[i]].position = i;
    }
    resting_.build(rest, boxes_.data(), fixedSizes_);
    for (std::uint32_t entry = 0; entry < resting_.size(); ++entry) {
        records_[resting_.slot(entry)].place = Place::resting;
        records_[resting_.slot(entry)].position = entry;
    }
    restingErased_ = 0;
    restingTree_.isStale.store(true, std::memory_order_relaxed);
    cost_.filed += resting_.size();
    mobileIsStale_ = true;
}

template <class Scalar>
void Grid<Scalar>::fileForUpdate() {
    fileWaiting();
    if (mobileIsStale_) {
        putQuietToRest();
    }
    rebuildMobile();
    cost_.resting = resting_.size() - restingErased_;
}

template <class Scalar>
void Grid<Scalar>::endUpdate() {
    changes_.clear();
    freeRemovedSlots();
    cost_ = {};
    ++updateNumber_;
    if (config_.cellSize == 0) {
        const double finest = std::min(mobile_.finestCellSize(), resting_.finestCellSize());
        cellSize_ = std::isinf(finest) ? Scalar(1) : static_cast<Scalar>(finest);
    }
}

template <class Scalar>
UpdateCost Grid<Scalar>::update() {
    HASHPHASE_ASSERT(!hasPairs_, "Where there are Pairs, Pairs::update() ends the frame.");
    fileForUpdate();
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
        self.fileWaiting();
        self.rebuildMobile();
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
        cell[axis] = static_cast<std::int64_t>(std::clamp(scaled, -9e18, 9e18));
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
    return sizeof(*this) + boxes_.capacity() * sizeof(Box) + records_.capacity() * sizeof(Record) +
           changes_.capacity() * sizeof(Change) +
           (freeSlots_.capacity() + removedSlots_.capacity() + waiting_.capacity() +
            mobileSlots_.capacity() + scratch_.capacity()) *
               sizeof(std::uint32_t) +
           mobile_.memoryBytes() + resting_.memoryBytes() + mobileTree_.tree.memoryBytes() +
           restingTree_.tree.memoryBytes();
}

template <class Scalar>
std::string Grid<Scalar>::validate() const {
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
            if (!isSameBits(table->box(entry), boxes_[slot])) {
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
        const bool isNan = records_[slot].place == Place::nan && !records_[slot].isWaiting;
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
