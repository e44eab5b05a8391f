// SPDX-License-Identifier: Zlib
#include <broadphase/pairs.hpp>

#include <broadphase/pairs/check.inl>
#include <broadphase/pairs/ignored.inl>
#include <broadphase/pairs/immediate.inl>
#include <broadphase/pairs/step.hpp>
#include <broadphase/pairs/update.inl>
#include <broadphase/sweeps.hpp>

#include <memory>

namespace hashphase {
namespace {

[[maybe_unused]] constexpr const char* kMustNotAsk =
    "Pairs are neither found nor filtered again from within the filter.";

template <class Scalar>
detail::Sweeping<Scalar>* sweepingOf(Sweeps<Scalar>* sweeps) {
    return sweeps != nullptr ? &sweeps->sweeping() : nullptr;
}

template <class Scalar>
[[maybe_unused]] bool areOf(const Grid<Scalar>& grid, Sweeps<Scalar>* sweeps) {
    return sweeps == nullptr || &sweeps->sweeping().motions.store == &grid.store();
}

}  // namespace

template <class Scalar>
Pairs<Scalar>::Pairs(Grid<Scalar>& grid, Sweeps<Scalar>* sweeps)
    : grid_(grid), sweeps_(sweeps), state_(grid.store(), sweepingOf(sweeps)) {
    HASHPHASE_ASSERT(areOf(grid, sweeps), "Sweeps and Pairs are of the same grid.");
}

template <class Scalar>
void Pairs<Scalar>::setSweeps(Sweeps<Scalar>* sweeps) {
    HASHPHASE_ASSERT(areOf(grid_, sweeps), "Sweeps and Pairs are of the same grid.");
    HASHPHASE_ASSERT(!grid_.isWithinQuery(),
                     "Sweeps are not given within a query, or within the filter.");
    sweeps_ = sweeps;
    state_.setSweeping(sweepingOf(sweeps));
}

template <class Scalar>
PairChanges Pairs<Scalar>::update(PairFilter filter, ParallelFor parallelFor) & {
    HASHPHASE_ASSERT(!grid_.isWithinQuery(),
                     "An update is not begun within a query, or within the filter.");
    detail::step(grid_.store(), &state_, filter, parallelFor, state_.cost.grid);
    return detail::endUpdate(state_, parallelFor);
}

template <class Scalar>
bool Pairs<Scalar>::isUpToDate() const noexcept {
    const detail::Store<Scalar>& store = grid_.store();
    return !store.mustFile() && !store.mustRebuildPairs && store.proxies.sweeping.empty() &&
           (sweeps_ == nullptr || sweeps_->size() == 0) && state_.known.kept.size() == 0 &&
           state_.known.immediate.size() == 0;
}

template <class Scalar>
PairChanges Pairs<Scalar>::findPairsNow(ProxyId id, PairFilter filter) & {
    HASHPHASE_ASSERT(grid_.contains(id), "Only a proxy of the grid has pairs to find.");
    HASHPHASE_ASSERT(grid_.takesChanges(), kMustNotAsk);
    return grid_.contains(id) ? detail::findPairsNow(state_, id.index, filter) : PairChanges{};
}

template <class Scalar>
PairChanges Pairs<Scalar>::findPairsNow(ProxyId id, std::span<const ProxyId> others,
                                        PairFilter filter) & {
    HASHPHASE_ASSERT(grid_.contains(id), "Only a proxy of the grid has pairs to find.");
    HASHPHASE_ASSERT(grid_.takesChanges(), kMustNotAsk);
    return grid_.contains(id) ? detail::findPairsNow(state_, id.index, others, filter)
                              : PairChanges{};
}

template <class Scalar>
PairChanges Pairs<Scalar>::refilter(ProxyId id, PairFilter filter) & {
    return refilter(std::span(&id, 1), filter);
}

template <class Scalar>
PairChanges Pairs<Scalar>::refilter(std::span<const ProxyId> ids, PairFilter filter) & {
    for ([[maybe_unused]] const ProxyId id : ids) {
        HASHPHASE_ASSERT(grid_.contains(id), "Only a proxy of the grid can be filtered again.");
    }
    HASHPHASE_ASSERT(grid_.takesChanges(), kMustNotAsk);
    return detail::refilter(state_, ids, filter);
}

template <class Scalar>
PairChanges Pairs<Scalar>::refilter(std::span<const ProxyPair> pairs, PairFilter filter) & {
    HASHPHASE_ASSERT(grid_.takesChanges(), kMustNotAsk);
    return detail::refilter(state_, pairs, filter);
}

template <class Scalar>
PairChanges Pairs<Scalar>::refilterAll(PairFilter filter) & {
    HASHPHASE_ASSERT(grid_.takesChanges(), kMustNotAsk);
    return detail::refilterAll(state_, filter);
}

template <class Scalar>
PairChanges Pairs<Scalar>::ignore(const ProxyPair& pair) & {
    HASHPHASE_ASSERT(
        grid_.contains(pair.first) && grid_.contains(pair.second) && pair.first != pair.second,
        "Only two proxies of the grid are ignored as a pair.");
    return ignore(std::span(&pair, 1));
}

template <class Scalar>
PairChanges Pairs<Scalar>::ignore(std::span<const ProxyPair> pairs) & {
    HASHPHASE_ASSERT(grid_.takesChanges(), kMustNotAsk);
    return detail::ignore(state_, pairs);
}

template <class Scalar>
PairChanges Pairs<Scalar>::stopIgnoring(const ProxyPair& pair, PairFilter filter) & {
    return stopIgnoring(std::span(&pair, 1), filter);
}

template <class Scalar>
PairChanges Pairs<Scalar>::stopIgnoring(std::span<const ProxyPair> pairs, PairFilter filter) & {
    HASHPHASE_ASSERT(grid_.takesChanges(), kMustNotAsk);
    return detail::stopIgnoring(state_, pairs, filter);
}

// Made again in place, so that nothing is left of what was, and nothing takes memory.
template <class Scalar>
void Pairs<Scalar>::clear() {
    HASHPHASE_ASSERT(!grid_.isWithinQuery(),
                     "Pairs and their grid are not cleared within a query, or within the filter.");
    std::destroy_at(&state_);
    grid_.clear();
    if (sweeps_ != nullptr) {
        std::destroy_at(sweeps_);
        std::construct_at(sweeps_, grid_);
    }
    std::construct_at(&state_, grid_.store(), sweepingOf(sweeps_));
}

template <class Scalar>
bool Pairs<Scalar>::isPair(const ProxyPair& pair) const noexcept {
    return detail::isPair(state_, pair);
}

template <class Scalar>
void Pairs<Scalar>::collect(std::vector<ProxyPair>& pairs) const {
    HASHPHASE_ASSERT(grid_.store().cost.changed == 0,
                     "The set of pairs is asked for directly after an update.");
    detail::collect(state_, pairs);
}

template <class Scalar>
bool Pairs<Scalar>::isIgnored(const ProxyPair& pair) const noexcept {
    return detail::isIgnored(state_, pair);
}

template <class Scalar>
bool Pairs<Scalar>::mayIgnore() const noexcept {
    return state_.known.ignored != nullptr && state_.known.ignored->size() > 0;
}

template <class Scalar>
void Pairs<Scalar>::collectIgnored(std::vector<ProxyPair>& pairs) const {
    detail::collectIgnored(state_, pairs);
}

template <class Scalar>
std::size_t Pairs<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) - sizeof(state_) + detail::memoryBytes(state_);
}

template <class Scalar>
void Pairs<Scalar>::releaseUnusedMemory() noexcept {
    HASHPHASE_ASSERT(grid_.takesChanges(), "Memory is not given back within the filter.");
    detail::releaseUnusedMemory(state_);
}

template <class Scalar>
std::string Pairs<Scalar>::validate() const {
    return detail::validate(state_);
}

template class HASHPHASE_INSTANCE_EXPORT Pairs<float>;
template class HASHPHASE_INSTANCE_EXPORT Pairs<double>;

}  // namespace hashphase
