// SPDX-License-Identifier: Zlib
#include <broadphase/grid_snapshot.hpp>

#include <broadphase/core/copy_parts.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/pairs/memory.inl>
#include <broadphase/sweeps.hpp>

#include <utility>

namespace hashphase {

namespace detail {

/// What a grid, its pairs and its sweeps are made of; null for those that it lacks.
template <class Store, class PairState, class Motions>
struct Side {
    Store* store;
    PairState* pairs;
    Motions* motions;
};

/// The same once more.
template <class Scalar>
struct GridTwin {
    Store<Scalar> store;
    Motions<Scalar> motions{store};
    PairState<Scalar> pairs{store, nullptr};
    bool hasPairs = false;
    bool hasSweeps = false;

    explicit GridTwin(const GridConfig& config) : store(config) {}
    ~GridTwin() { store.proxies.sweeping.clear(); }  // which is the grid's to end
    GridTwin(const GridTwin&) = delete;
    GridTwin& operator=(const GridTwin&) = delete;

    [[nodiscard]] auto side() { return sideOf(*this); }
    [[nodiscard]] auto side() const { return sideOf(*this); }

private:
    [[nodiscard]] static auto sideOf(auto& twin) {
        return Side{&twin.store, twin.hasPairs ? &twin.pairs : nullptr,
                    twin.hasSweeps ? &twin.motions : nullptr};
    }
};

namespace {

constexpr const char* kPairsGoWithTheirGrid =
    "Where there are Pairs, they are saved and restored with their grid.";

/// What a caller has done wrong; null for nothing.
template <class Scalar>
const char* faultOf(const Grid<Scalar>& grid, const Pairs<Scalar>* pairs) {
    if (grid.isWithinQuery()) {
        return "A grid is neither saved nor restored within a query.";
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
bool GridSnapshot<Scalar>::isMisused(const Grid<Scalar>& grid, const Pairs<Scalar>* pairs) const {
    const char* fault = detail::faultOf(grid, pairs);
    if (isEmpty()) {
        fault = "Nothing was saved that could be restored.";
    } else if (fault == nullptr && twin_->store.config != grid.store().config) {
        fault = "A grid is restored with the settings that it was saved with.";
    } else if (fault == nullptr && twin_->hasPairs != (pairs != nullptr)) {
        fault = detail::kPairsGoWithTheirGrid;
    } else if (fault == nullptr && twin_->hasSweeps != (detail::motionsOf(pairs) != nullptr)) {
        fault = "Where Pairs follow Sweeps, they do so when they are restored.";
    }
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
std::size_t GridSnapshot<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) + (twin_ == nullptr ? 0
                                             : sizeof(*twin_) + twin_->store.memoryBytes() +
                                                   twin_->motions.memoryBytes() +
                                                   detail::memoryBytes(twin_->pairs));
}

template class HASHPHASE_INSTANCE_EXPORT GridSnapshot<float>;
template class HASHPHASE_INSTANCE_EXPORT GridSnapshot<double>;

}  // namespace hashphase
