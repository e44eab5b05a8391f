// SPDX-License-Identifier: Zlib
#include <broadphase/grid.hpp>

#include <broadphase/move_batch.hpp>
#include <broadphase/pairs/step.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase {

template <class Scalar>
Grid<Scalar>::Grid(const GridConfig& config) : store_(config) {}

template <class Scalar>
Grid<Scalar>::~Grid() {
    HASHPHASE_ASSERT(!store_.hasPairs,
                     "Grid: the grid was destroyed before its Pairs. Destroy the Pairs first: "
                     "declare them after the grid.");
    HASHPHASE_ASSERT(store_.firstMotions == nullptr,
                     "Grid: the grid was destroyed before its Sweeps. Destroy the Sweeps first: "
                     "declare them after the grid.");
}

// --- Proxies -------------------------------------------------------------------------------------

template <class Scalar>
ProxyId Grid<Scalar>::add(const Box& box, Mobility mobility, const ProxyGroups& groups) {
    HASHPHASE_ASSERT(takesChanges(), detail::kMustNotChange);
    return store_.proxies.idOf(store_.add(box, mobility == Mobility::resting, groups));
}

template <class Scalar>
void Grid<Scalar>::reserve(std::size_t count) {
    HASHPHASE_ASSERT(takesChanges(), detail::kMustNotChange);
    store_.reserve(count);
}

template <class Scalar>
void Grid<Scalar>::move(std::span<const ProxyId> ids, std::span<const Box> boxes) {
    HASHPHASE_ASSERT(
        ids.size() == boxes.size(),
        "Grid::move(): ids and boxes have different lengths. Pass one box for each id.");
    for (std::size_t i = 0; i < ids.size(); ++i) {
        move(ids[i], boxes[i]);
    }
}

template <class Scalar>
void Grid<Scalar>::move(std::span<const ProxyId> ids, std::span<const Box> boxes,
                        ParallelFor parallelFor) {
    HASHPHASE_ASSERT(
        ids.size() == boxes.size(),
        "Grid::move(): ids and boxes have different lengths. Pass one box for each id.");
    HASHPHASE_ASSERT(takesChanges(), detail::kMustNotChange);
    for ([[maybe_unused]] const ProxyId id : ids) {
        HASHPHASE_ASSERT(contains(id),
                         "Grid::move(): the id is null, stale, or of another grid. Pass an id that "
                         "add() returned and that was not removed.");
    }
    const auto isThere = [&](std::size_t i) { return contains(ids[i]); };
    const auto indexOf = [&](std::size_t i) {
        return isThere(i) ? ids[i].index : detail::kNoProxyIndex;
    };
    if (!areDistinct(store_.scratchOfMoves(), ids.size(), indexLimit(), parallelFor, indexOf)) {
        move(ids, boxes);
        return;
    }
    detail::MoveBatch<Scalar>(store_).run(ids.size(), parallelFor, isThere, [&](std::size_t i) {
        return detail::Move<Scalar>{ids[i].index, boxes[i]};
    });
}

template <class Scalar>
void Grid<Scalar>::remove(ProxyId id) {
    HASHPHASE_ASSERT(contains(id),
                     "Grid::remove(): the id is null, stale, or of another grid. Pass an id that "
                     "add() returned and that was not removed.");
    HASHPHASE_ASSERT(takesChanges(), detail::kMustNotChange);
    if (contains(id)) {
        store_.remove(id.index);
    }
}

template <class Scalar>
void Grid<Scalar>::clear() {
    HASHPHASE_ASSERT(!store_.hasPairs,
                     "Grid::clear() was called for a grid that has Pairs. Call Pairs::clear() "
                     "instead: it clears the grid too.");
    HASHPHASE_ASSERT(
        !isWithinQuery(),
        "Grid::clear() was called from within a query. Call it after the query returns.");
    if (!store_.hasPairs && !isWithinQuery()) {
        store_.clear();
    }
}

template <class Scalar>
void Grid<Scalar>::setGroups(ProxyId id, const ProxyGroups& groups) {
    HASHPHASE_ASSERT(contains(id),
                     "Grid::setGroups(): the id is null, stale, or of another grid. Pass an id "
                     "that add() returned and that was not removed.");
    HASHPHASE_ASSERT(takesChanges(), detail::kMustNotChange);
    if (contains(id) && groups != store_.proxies.groupsNow(id.index)) {
        store_.setGroups(id.index, groups);
    }
}

template <class Scalar>
ProxyGroups Grid<Scalar>::groups(ProxyId id) const {
    HASHPHASE_ASSERT(contains(id),
                     "Grid::groups(): the id is null, stale, or of another grid. Pass an id that "
                     "add() returned and that was not removed.");
    return contains(id) ? store_.proxies.groupsNow(id.index) : ProxyGroups{};
}

template <class Scalar>
std::size_t Grid<Scalar>::shiftOrigin(const Point& shift) {
    HASHPHASE_ASSERT(
        shift.allFinite(),
        "Grid::shiftOrigin(): the shift is NaN or infinite. Pass finite coordinates [m].");
    HASHPHASE_ASSERT(
        !isWithinQuery(),
        "Grid::shiftOrigin() was called from within a query. Call it after the query returns.");
    return shift.allFinite() && !shift.isZero(0) ? store_.shiftOrigin(shift) : 0;
}

template <class Scalar>
const Aabb<Scalar>& Grid<Scalar>::box(ProxyId id) const {
    HASHPHASE_ASSERT(contains(id),
                     "Grid::box(): the id is null, stale, or of another grid. Pass an id that "
                     "add() returned and that was not removed.");
    return contains(id) ? store_.proxies.records[id.index].box : store_.proxies.nowhere();
}

// --- Cells ---------------------------------------------------------------------------------------

template <class Scalar>
std::array<std::int64_t, 3> Grid<Scalar>::cellAt(const Point& point) const {
    HASHPHASE_ASSERT(point.allFinite(),
                     "Grid::cellAt(): the point is NaN or infinite. Pass finite coordinates [m].");
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

// --- Frame ---------------------------------------------------------------------------------------

template <class Scalar>
UpdateCost Grid<Scalar>::update(ParallelFor parallelFor) {
    HASHPHASE_ASSERT(!store_.hasPairs,
                     "Grid::update() was called for a grid that has Pairs. Call Pairs::update() "
                     "instead: it updates the grid too.");
    HASHPHASE_ASSERT(
        !isWithinQuery(),
        "Grid::update() was called from within a query. Call it after the query returns.");
    if (store_.hasPairs || isWithinQuery()) {
        return {};
    }
    UpdateCost cost;
    detail::step<Scalar>(store_, nullptr, acceptAllPairs, parallelFor, cost);
    return cost;
}

// --- Accounts ------------------------------------------------------------------------------------

template <class Scalar>
std::size_t Grid<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) - sizeof(store_) + store_.memoryBytes();
}

template <class Scalar>
std::size_t Grid<Scalar>::rayMemoryBytes() const noexcept {
    return store_.rayMemoryBytes();
}

template <class Scalar>
void Grid<Scalar>::releaseRayMemory() noexcept {
    HASHPHASE_ASSERT(!isWithinQuery(),
                     "Grid::releaseRayMemory() was called from within a query. Call it after the "
                     "query returns.");
    store_.releaseRayMemory();
}

template <class Scalar>
void Grid<Scalar>::releaseUnusedMemory() noexcept {
    HASHPHASE_ASSERT(!isWithinQuery(),
                     "Grid::releaseUnusedMemory() was called from within a query. Call it after "
                     "the query returns.");
    store_.proxies.reservedCount = 0;
    store_.releaseMemory();
}

template <class Scalar>
std::string Grid<Scalar>::validate() const {
    return store_.validate();
}

template class HASHPHASE_INSTANCE_EXPORT Grid<float>;
template class HASHPHASE_INSTANCE_EXPORT Grid<double>;

}  // namespace hashphase
