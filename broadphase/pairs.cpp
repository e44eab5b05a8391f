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
    "Pairs were found, filtered or ignored from within a filter, visitEach() or the query of a "
    "convex volume. Do so after that returns.";

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
    HASHPHASE_ASSERT(
        areOf(grid, sweeps),
        "Pairs: the Sweeps are of another grid. Pass Sweeps of the grid of these Pairs.");
}

template <class Scalar>
void Pairs<Scalar>::setSweeps(Sweeps<Scalar>* sweeps) {
    HASHPHASE_ASSERT(areOf(grid_, sweeps),
                     "Pairs::setSweeps(): the Sweeps are of another grid. Pass Sweeps of the grid "
                     "of these Pairs.");
    HASHPHASE_ASSERT(!grid_.isWithinQuery(),
                     "Pairs::setSweeps() was called from within a query or the filter. Call it "
                     "after that returns.");
    sweeps_ = sweeps;
    state_.setSweeping(sweepingOf(sweeps));
}

template <class Scalar>
PairChanges Pairs<Scalar>::update(PairFilter filter, ParallelFor parallelFor) & {
    HASHPHASE_ASSERT(!grid_.isWithinQuery(),
                     "Pairs::update() was called from within a query or the filter. Call it after "
                     "that returns.");
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
    HASHPHASE_ASSERT(grid_.contains(id),
                     "Pairs::findPairsNow(): the id is null, stale, or of another grid. Pass an id "
                     "that Grid::add() returned and that was not removed.");
    HASHPHASE_ASSERT(grid_.takesChanges(), kMustNotAsk);
    return grid_.contains(id) ? detail::findPairsNow(state_, id.index, filter) : PairChanges{};
}

template <class Scalar>
PairChanges Pairs<Scalar>::findPairsNow(ProxyId id, std::span<const ProxyId> others,
                                        PairFilter filter) & {
    HASHPHASE_ASSERT(grid_.contains(id),
                     "Pairs::findPairsNow(): the id is null, stale, or of another grid. Pass an id "
                     "that Grid::add() returned and that was not removed.");
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
        HASHPHASE_ASSERT(grid_.contains(id),
                         "Pairs::refilter(): the id is null, stale, or of another grid. Pass an id "
                         "that Grid::add() returned and that was not removed.");
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
        "Pairs::ignore(): the pair is not of two different proxies of the grid. Pass two ids that "
        "Grid::add() returned and that were not removed.");
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
    HASHPHASE_ASSERT(
        !grid_.isWithinQuery(),
        "Pairs::clear() was called from within a query or the filter. Call it after that returns.");
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
                     "Pairs::collect() was called after a change of the grid. Call it after "
                     "update(), before the next change.");
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
    HASHPHASE_ASSERT(grid_.takesChanges(),
                     "Pairs::releaseUnusedMemory() was called from within a query or the filter. "
                     "Call it after that returns.");
    detail::releaseUnusedMemory(state_);
}

template <class Scalar>
std::string Pairs<Scalar>::validate() const {
    return detail::validate(state_);
}

template class HASHPHASE_INSTANCE_EXPORT Pairs<float>;
template class HASHPHASE_INSTANCE_EXPORT Pairs<double>;

}  // namespace hashphase
