// SPDX-License-Identifier: Zlib
#include <broadphase/grid.hpp>

#include <broadphase/core/limits.hpp>
#include <broadphase/core/query_scope.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hashphase {
namespace {

void checkProxyCount(std::size_t count) {
    detail::checkCount(count, detail::kMostProxies, "A grid holds at most 268,435,456 proxies.");
}

// At least doubled, or a program that asks for a few more each time would move all each time.
std::size_t roomFor(std::size_t count, std::size_t present) {
    const std::size_t twice = std::min(2 * present, detail::kMostProxies);
    return std::max<std::size_t>({count, twice, 8});
}

const GridConfig& checked(const GridConfig& config) {
    const std::string error = configError(config);
    if (!error.empty()) {
        throw std::invalid_argument(error);
    }
    return config;
}

// Grids have those above, of 2^32 numbers each.
std::uint64_t firstPopulationNumber() noexcept {
    static std::atomic<std::uint64_t> gridCount{0};
    return ++gridCount << 32;
}

template <class Element>
void release(std::vector<Element>& memory) noexcept {
    std::vector<Element>().swap(memory);
}

}  // namespace

template <class Scalar>
Grid<Scalar>::Grid(const GridConfig& config)
    : config_(checked(config)), populationNumber_(firstPopulationNumber()) {
    if (config_.cellSize > 0) {
        cellSize_ = static_cast<Scalar>(config_.cellSize);
    }
}

template <class Scalar>
Grid<Scalar>::~Grid() {
    HASHPHASE_ASSERT(!hasPairs_, "A grid outlives its Pairs.");
    HASHPHASE_ASSERT(firstSweeps_ == nullptr, "A grid outlives its Sweeps.");
}

// --- Proxies -------------------------------------------------------------------------------------

template <class Scalar>
ProxyId Grid<Scalar>::add(const Box& box, Mobility mobility, const ProxyGroups& groups) {
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(this), detail::kMustNotChange);
    if (groups != ProxyGroups{}) {
        makeGroups();
    }
    beforeChange();  // before anything is listed that it does not have
    // It may be that of another proxy, which moves. NOLINTNEXTLINE(*-unnecessary-copy-initialization)
    const Box own = box;
    std::uint32_t slot = free_.first;
    if (slot == kNoSlot) {
        reserveSlots(records_.size() + 1);
        reserveLists(listedCount() + 1);
        slot = static_cast<std::uint32_t>(records_.size());
        records_.emplace_back().generation = firstGeneration_;
    } else {
        reserveLists(listedCount() + 1);
        free_.first = records_[slot].listedAt;
        --free_.count;
    }
    if (!groups_.empty()) {
        groups_.resize(2 * records_.size());
        noteGroups(slot, groups);
        groups_[2 * std::size_t{slot} + 1] = groups;
    }
    Record& record = records_[slot];
    ++record.generation;
    record.place = Place::mobile;
    listMobile(slot);
    ++size_;
    ++populationNumber_;
    noteChange(slot);
    setBox(record, own);
    record.restsAtOnce = mobility == Mobility::resting;
    return idOf(slot);
}

template <class Scalar>
void Grid<Scalar>::reserve(std::size_t count) {
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(this), detail::kMustNotChange);
    checkProxyCount(count);
    reserveSlots(count + removed_.count + removedAnnounced_.count);
    reserveLists(count + removed_.count + removedAnnounced_.count);
    reservedCount_ = count;
}

template <class Scalar>
void Grid<Scalar>::reserveSlots(std::size_t slotCount) {
    checkProxyCount(slotCount);
    if (slotCount <= records_.capacity()) {
        return;
    }
    const std::size_t room = roomFor(slotCount, records_.capacity());
    if (!groups_.empty()) {
        groups_.reserve(2 * room);
    }
    records_.reserve(room);  // last: the others have room for as many
}

template <class Scalar>
void Grid<Scalar>::reserveLists(std::size_t count) {
    if (count <= mobileSlots_.capacity()) {
        return;
    }
    const std::size_t room = roomFor(count, mobileSlots_.capacity());
    woken_.reserve(room);
    waiting_.reserve(room);
    mobileSlots_.reserve(room);  // last: the others have room for as many
}

template <class Scalar>
void Grid<Scalar>::setBox(Record& record, const Box& box) {
    record.box = box;
    record.restsAtOnce = false;
    const bool isNan = hasNan(box);
    if (isNan || record.isNan) {
        noteNan(record, isNan);
    }
}

template <class Scalar>
void Grid<Scalar>::move(ProxyId id, const Box& box) {
    HASHPHASE_ASSERT(contains(id), "Only a proxy of this grid that was not removed can be moved.");
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(this), detail::kMustNotChange);
    if (!contains(id)) {
        return;
    }
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
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(this), detail::kMustNotChange);
    if (!contains(id)) {
        return;
    }
    const std::uint32_t slot = id.index;
    noteChange(slot);
    const bool cameAndWent = isUnseen(slot);
    if (cameAndWent) {
        unlistMobile(slot);
    }
    Record& record = records_[slot];
    nanCount_ -= record.isNan ? 1 : 0;
    record.isNan = false;
    record.box = nanBox();
    record.place = Place::nowhere;
    ++record.generation;
    --size_;
    ++populationNumber_;
    if (record.generation == detail::kLastGeneration) {
        return;  // nobody gets the slot any more, or an id would name two proxies
    }
    append(slot, !cameAndWent ? removed_ : record.isAnnounced ? removedAnnounced_ : free_);
}

template <class Scalar>
void Grid<Scalar>::clear() {
    HASHPHASE_ASSERT(!hasPairs_, "Where there are Pairs, Pairs::clear() clears the grid.");
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this), "A grid is not cleared within a query.");
    if (hasPairs_ || detail::QueryScope::isWithin(this)) {
        return;
    }
    // Slots in the order in which a new grid makes them. What tells their ids apart stays.
    free_ = removed_ = removedAnnounced_ = {};
    for (auto slot = static_cast<std::uint32_t>(records_.size()); slot-- > 0;) {
        const std::uint32_t generation = records_[slot].generation;
        records_[slot] = {};
        records_[slot].generation = generation + (generation & 1);
        if (records_[slot].generation != detail::kLastGeneration) {
            append(slot, free_);
        }
    }
    size_ = nanCount_ = 0;
    ++populationNumber_;
    nanReported_ = isTorn_ = false;
    updateNumber_ = 1;
    cost_ = {};
    // Room is kept in what changes append to.
    for (std::vector<std::uint32_t>* list : {&waiting_, &mobileSlots_, &woken_}) {
        list->clear();
    }
    listedAtUpdate_ = 0;
    restingErased_ = 0;
    mobile_ = {};
    resting_ = {};
    sweeping_.reset();
    fresh_.reset();
    listNumber_ = 1;
    waitingRead_.store(0, std::memory_order_relaxed);
    isTableTorn_.store(false, std::memory_order_relaxed);
    isFresh_.store(false, std::memory_order_relaxed);
    releaseRayMemory();
    for (auto* boxes : {&staged_, &stagedBefore_, &restBoxes_, &sweepingBoxes_}) {
        release(*boxes);
    }
    release(restSlots_);
    release(nanSlots_);
    release(sweepingSlots_);
    release(boxesAtUpdate_);
    slotsAtUpdate_ = {};
    release(groups_);
    groupKinds_ = {};
    areRegrouped_ = false;
    cellSize_ = config_.cellSize > 0 ? static_cast<Scalar>(config_.cellSize) : Scalar(1);
}

// Lists the slot among the mobile ones, and notes where.
template <class Scalar>
void Grid<Scalar>::listMobile(std::uint32_t slot) noexcept {
    records_[slot].listedAt = static_cast<std::uint32_t>(mobileSlots_.size());
    mobileSlots_.push_back(slot);
}

// The last one takes its place: no order holds among those that have joined since the last update.
template <class Scalar>
void Grid<Scalar>::unlistMobile(std::uint32_t slot) noexcept {
    const std::uint32_t last = mobileSlots_.back();
    mobileSlots_[records_[slot].listedAt] = last;
    if (isAlive(last)) {
        records_[last].listedAt = records_[slot].listedAt;
    }
    mobileSlots_.pop_back();
}

// What is listed at its place behind those of the last update was at rest then, or was not yet.
template <class Scalar>
bool Grid<Scalar>::isUnseen(std::uint32_t slot) const noexcept {
    const Record& record = records_[slot];
    return record.listedAt >= listedAtUpdate_ && record.listedAt < mobileSlots_.size() &&
           mobileSlots_[record.listedAt] == slot && hasNan(record.before);
}

template <class Scalar>
void Grid<Scalar>::append(std::uint32_t slot, SlotList& list) noexcept {
    records_[slot].listedAt = list.first;
    list.last = list.first == kNoSlot ? slot : list.last;
    list.first = slot;
    ++list.count;
}

// Only now may the slots be given away again: nobody has to tell their old proxies from the next ones
// any more.
template <class Scalar>
void Grid<Scalar>::giveBack(SlotList& list) noexcept {
    if (list.first != kNoSlot) {
        records_[list.last].listedAt = free_.first;
        free_.first = list.first;
        free_.count += list.count;
        list = {};
    }
}

template <class Scalar>
void Grid<Scalar>::setGroups(ProxyId id, const ProxyGroups& groups) {
    HASHPHASE_ASSERT(contains(id), "Only a proxy of this grid that was not removed has groups.");
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(this), detail::kMustNotChange);
    if (!contains(id) || groups == groupsNow(id.index)) {
        return;
    }
    makeGroups();
    noteGroups(id.index, groups);
    areRegrouped_ = true;
    Record& record = records_[id.index];
    if (hasPairs_ && record.place == Place::mobile) {
        countChange(record);  // where its box is filed, there it is
    } else if (hasPairs_) {
        noteChange(id.index);
    }
}

template <class Scalar>
ProxyGroups Grid<Scalar>::groups(ProxyId id) const {
    HASHPHASE_ASSERT(contains(id), "Only a proxy of this grid that was not removed has groups.");
    return contains(id) ? groupsNow(id.index) : ProxyGroups{};
}

// For all that are there, with room for as many as records_ has room for.
template <class Scalar>
void Grid<Scalar>::makeGroups() {
    if (groups_.empty()) {
        reserveSlots(1);
        const std::size_t count = std::max<std::size_t>(records_.size(), 1);
        groups_.reserve(2 * records_.capacity());
        groups_.resize(2 * count);
    }
}

template <class Scalar>
void Grid<Scalar>::noteGroups(std::uint32_t slot, const ProxyGroups& groups) noexcept {
    std::uint8_t& kind = records_[slot].kind;
    const bool isKnown = kind != detail::GroupKinds::kOther && groupKinds_[kind] == groups;
    kind = isKnown ? kind : groupKinds_.numberOf(groups);
    groups_[2 * std::size_t{slot}] = groups;
}

template <class Scalar>
bool Grid<Scalar>::contains(ProxyId id) const noexcept {
    return !id.isNull() && id.index < records_.size() &&
           records_[id.index].generation == id.generation;
}

template <class Scalar>
const Aabb<Scalar>& Grid<Scalar>::box(ProxyId id) const {
    HASHPHASE_ASSERT(contains(id), "Only a proxy of this grid that was not removed has a box.");
    return contains(id) ? records_[id.index].box : nowhere_;
}

// To be called before every change of a slot's box.
template <class Scalar>
void Grid<Scalar>::noteChange(std::uint32_t slot) noexcept {
    beforeChange();
    Record& record = records_[slot];
    countChange(record);
    if (record.place == Place::resting) {
        leaveRest(slot);
    }
    if (!isWaiting(record)) {
        record.listedIn = listNumber_;
        waiting_.push_back(slot);
    }
}

template <class Scalar>
void Grid<Scalar>::countChange(Record& record) noexcept {
    if (record.changedAt != updateNumber_) {
        record.before = record.box;
        if (record.place == Place::sweeping) {
            record.before = nowhere_;  // as standingBox(), which copies more slowly
        }
        record.changedAt = updateNumber_;
        ++cost_.changed;
    }
}

template <class Scalar>
void Grid<Scalar>::leaveRest(std::uint32_t slot) noexcept {
    Record& record = records_[slot];
    resting_.erase(record.listedAt);
    ++restingErased_;
    record.place = Place::mobile;
    listMobile(slot);
    woken_.push_back(slot);
}

// It sweeps as of the update that begins here.
template <class Scalar>
void Grid<Scalar>::beginSweep(std::uint32_t slot) noexcept {
    noteChange(slot);
    records_[slot].place = Place::sweeping;
    sweepingSlots_.push_back(slot);
}

template <class Scalar>
void Grid<Scalar>::endSweep(std::uint32_t slot) noexcept {
    noteChange(slot);
    Record& record = records_[slot];
    record.place = record.place == Place::sweeping ? Place::mobile : record.place;
}

// Without Pairs nothing does.
template <class Scalar>
void Grid<Scalar>::endSweeps() noexcept {
    for (const std::uint32_t slot : sweepingSlots_) {
        if (records_[slot].place == Place::sweeping) {
            endSweep(slot);
        }
    }
}

template <class Scalar>
void Grid<Scalar>::noteNan(Record& record, bool isNan) {
    nanCount_ += isNan ? 1 : 0;
    nanCount_ -= record.isNan ? 1 : 0;
    record.isNan = isNan;
    if (isNan && !nanReported_) {
        nanReported_ = true;
        detail::reportMessage(
            "A box with a NaN coordinate was set. It will pair with nothing and be found by "
            "nothing until a box without NaN is set; further ones are counted silently.");
    }
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
    const Box& own = box(id);
    return contains(id) ? CellRange{cellAt(own.min()), cellAt(own.max())} : CellRange{};
}

// --- Accounts ------------------------------------------------------------------------------------

template <class Scalar>
std::string Grid<Scalar>::validate() const {
    mendTables();
    const Reading reading = presentReading();
    // How often each proxy stands where a query would look for it.
    std::vector<std::uint32_t> timesFound(records_.size(), 0);
    for (const auto& [table, tree, isResting] : reading.filings()) {
        if (std::string error = table->validate(); !error.empty()) {
            return error;
        }
        for (std::uint32_t entry = 0; entry < table->size(); ++entry) {
            const std::uint32_t slot = table->slot(entry);
            if (hasNan(table->box(entry)) || !isFiled(slot, reading)) {
                continue;
            }
            ++timesFound[slot];
            if (!isSameBits(table->box(entry), records_[slot].box)) {
                return "A filed proxy's entry has the proxy's box: broken.";
            }
        }
    }
    for (const auto& [table, tree, isResting] : reading.filings()) {
        if (tree->isStale.load(std::memory_order_relaxed)) {
            continue;
        }
        if (std::string error = tree->tree.validate(); !error.empty()) {
            return error;
        }
    }
    for (std::size_t i = 0; i < waiting_.size() && !reading.isFresh; ++i) {
        timesFound[waiting_[i]] += isAlive(waiting_[i]) ? 1 : 0;
    }
    std::size_t alive = 0;
    for (std::uint32_t slot = 0; slot < records_.size(); ++slot) {
        alive += isAlive(slot) ? 1 : 0;
        const bool isNan = records_[slot].isNan && (reading.isFresh || !isWaiting(records_[slot]));
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
