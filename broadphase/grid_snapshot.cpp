// SPDX-License-Identifier: Zlib
#include <broadphase/grid_snapshot.hpp>

#include <broadphase/core/copy_parts.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/pairs/grid_twin.hpp>
#include <broadphase/pairs/grid_twin_bytes.hpp>
#include <broadphase/pairs/memory.inl>
#include <broadphase/sweeps.hpp>

#include <utility>

namespace hashphase {

namespace detail {

namespace {

constexpr const char* kPairsGoWithTheirGrid =
    "GridSnapshot: Pairs are missing in save() or in restore(). If the grid has Pairs, pass them "
    "instead of the grid, to both.";

/// What a caller has done wrong; null for nothing.
template <class Scalar>
const char* faultOf(const Grid<Scalar>& grid, const Pairs<Scalar>* pairs) {
    if (grid.isWithinQuery()) {
        return "GridSnapshot: save() or restore() was called from within a query of the grid. Call "
               "it after the query returns.";
    }
    return grid.store().hasPairs != (pairs != nullptr) ? kPairsGoWithTheirGrid : nullptr;
}

template <class Scalar>
Motions<Scalar>* motionsOf(const Pairs<Scalar>* pairs) {
    return pairs != nullptr && pairs->sweeps() != nullptr ? &pairs->sweeps()->sweeping().motions
                                                          : nullptr;
}

template <class Visit>
void forEachPart(const auto& to, const auto& from, const Visit& visit) {
    visit(*to.store, *from.store);
    if (to.pairs != nullptr) {
        visit(*to.pairs, *from.pairs);
    }
    if (to.motions != nullptr) {
        visit(*to.motions, *from.motions);
    }
}

template <class Store, class PairsOfStore>
auto sideOf(Store& store, PairsOfStore* pairs) {
    auto* const motions = motionsOf(pairs);
    return Side{&store, pairs != nullptr ? &pairs->state() : nullptr, motions};
}

}  // namespace
}  // namespace detail

template <class Scalar>
GridSnapshot<Scalar>::GridSnapshot() noexcept = default;
template <class Scalar>
GridSnapshot<Scalar>::~GridSnapshot() = default;
template <class Scalar>
GridSnapshot<Scalar>::GridSnapshot(GridSnapshot&& other) noexcept = default;
template <class Scalar>
GridSnapshot<Scalar>& GridSnapshot<Scalar>::operator=(GridSnapshot&& other) noexcept = default;

template <class Scalar>
void GridSnapshot<Scalar>::save(const Grid<Scalar>& grid) {
    save(grid, nullptr);
}

template <class Scalar>
void GridSnapshot<Scalar>::save(const Pairs<Scalar>& pairs) {
    save(pairs.grid(), &pairs);
}

template <class Scalar>
void GridSnapshot<Scalar>::save(const Grid<Scalar>& grid, const Pairs<Scalar>* pairs) {
    const char* const fault = detail::faultOf(grid, pairs);
    HASHPHASE_ASSERT(fault == nullptr, fault);
    if (fault != nullptr) {
        return;
    }
    isSaved_ = false;
    if (twin_ == nullptr || twin_->store.config != grid.store().config) {
        twin_ = std::make_unique<detail::GridTwin<Scalar>>(grid.store().config);
    }
    twin_->hasPairs = pairs != nullptr;
    twin_->hasSweeps = detail::motionsOf(pairs) != nullptr;
    const auto from = detail::sideOf(grid.store(), pairs);
    detail::forEachPart(twin_->side(), from, detail::MakeRoomForParts{});
    detail::forEachPart(twin_->side(), from, detail::CopyParts{});
    isSaved_ = true;
}

template <class Scalar>
void GridSnapshot<Scalar>::restore(Grid<Scalar>& grid) const {
    restore(grid, nullptr);
}

template <class Scalar>
void GridSnapshot<Scalar>::restore(Pairs<Scalar>& pairs) const {
    restore(pairs.grid(), &pairs);
}

template <class Scalar>
const char* GridSnapshot<Scalar>::faultFor(const Grid<Scalar>& grid,
                                           const Pairs<Scalar>* pairs) const {
    if (isEmpty()) {
        return "GridSnapshot::restore(): the snapshot is empty. Call save() or read() first.";
    }
    if (twin_->store.config != grid.store().config) {
        return "GridSnapshot::restore(): the grid has another GridConfig than the saved one. "
               "Restore a grid with an equal GridConfig.";
    }
    if (twin_->hasPairs != (pairs != nullptr)) {
        return detail::kPairsGoWithTheirGrid;
    }
    if (twin_->hasSweeps != (detail::motionsOf(pairs) != nullptr)) {
        return "GridSnapshot::restore(): only the saved Pairs or only these Pairs have Sweeps. "
               "Give Sweeps to both, or to neither.";
    }
    return detail::faultOf(grid, pairs);
}

template <class Scalar>
std::string GridSnapshot<Scalar>::faultFor(const Grid<Scalar>& grid) const {
    const char* const fault = faultFor(grid, nullptr);
    return fault != nullptr ? fault : "";
}

template <class Scalar>
std::string GridSnapshot<Scalar>::faultFor(const Pairs<Scalar>& pairs) const {
    const char* const fault = faultFor(pairs.grid(), &pairs);
    return fault != nullptr ? fault : "";
}

template <class Scalar>
bool GridSnapshot<Scalar>::isMisused(const Grid<Scalar>& grid, const Pairs<Scalar>* pairs) const {
    const char* const fault = faultFor(grid, pairs);
    HASHPHASE_ASSERT(fault == nullptr, fault);
    return fault != nullptr;
}

template <class Scalar>
void GridSnapshot<Scalar>::restore(Grid<Scalar>& grid, Pairs<Scalar>* pairs) const {
    if (!isMisused(grid, pairs)) {
        const auto to = detail::sideOf(grid.store(), pairs);
        detail::forEachPart(to, std::as_const(*twin_).side(), detail::MakeRoomForParts{});
        detail::forEachPart(to, std::as_const(*twin_).side(), detail::CopyParts{});
        ++grid.store().proxies.number;
    }
}

template <class Scalar>
void GridSnapshot<Scalar>::makeRoom(Pairs<Scalar>& pairs) const {
    if (!isMisused(pairs.grid(), &pairs)) {
        detail::forEachPart(detail::sideOf(pairs.grid().store(), &pairs),
                            std::as_const(*twin_).side(), detail::MakeRoomForParts{});
    }
}

template <class Scalar>
void GridSnapshot<Scalar>::write(std::vector<std::byte>& bytes) const {
    HASHPHASE_ASSERT(!isEmpty(),
                     "GridSnapshot::write(): the snapshot is empty. Call save() or read() first.");
    bytes.clear();
    if (!isEmpty()) {
        detail::writeTwin(*twin_, bytes);
    }
}

template <class Scalar>
std::string GridSnapshot<Scalar>::read(std::span<const std::byte> bytes) {
    std::unique_ptr<detail::GridTwin<Scalar>> twin;
    std::string fault = detail::readTwin(bytes, twin);
    if (fault.empty()) {
        twin_ = std::move(twin);
        isSaved_ = true;
    }
    return fault;
}

template <class Scalar>
std::uint32_t GridSnapshot<Scalar>::indexLimit() const noexcept {
    return isEmpty() ? 0 : static_cast<std::uint32_t>(twin_->store.proxies.records.size());
}

template <class Scalar>
ProxyId GridSnapshot<Scalar>::idAt(std::uint32_t index) const noexcept {
    return index < indexLimit() && twin_->store.proxies.isAlive(index)
               ? twin_->store.proxies.idOf(index)
               : ProxyId{};
}

template <class Scalar>
std::size_t GridSnapshot<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) + (twin_ == nullptr ? 0
                                             : sizeof(*twin_) + twin_->store.memoryBytes() +
                                                   twin_->motions.memoryBytes() +
                                                   detail::memoryBytes(twin_->pairs));
}

template class HASHPHASE_INSTANCE_EXPORT GridSnapshot<float>;
template class HASHPHASE_INSTANCE_EXPORT GridSnapshot<double>;

}  // namespace hashphase
