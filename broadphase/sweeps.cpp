// SPDX-License-Identifier: Zlib
#include <broadphase/sweeps.hpp>

#include <broadphase/diagnostics.hpp>

namespace hashphase {

template <class Scalar>
Sweeps<Scalar>::Sweeps(Grid<Scalar>& grid) : grid_(grid), sweeping_(grid.store()) {}

template <class Scalar>
void Sweeps<Scalar>::set(ProxyId id, const Vector3<Scalar>& displacement, Sweep sweep) {
    set(Motion{id, {{}, displacement}, sweep, true});
}

template <class Scalar>
void Sweeps<Scalar>::set(ProxyId id, const MovingBox<Scalar>& way, Sweep sweep) {
    set(Motion{id, way, sweep, false});
}

template <class Scalar>
void Sweeps<Scalar>::set(const Motion& motion) {
    HASHPHASE_ASSERT(grid_.contains(motion.id),
                     "Sweeps::set(): the id is null, stale, or of another grid. Pass an id that "
                     "Grid::add() returned and that was not removed.");
    HASHPHASE_ASSERT(grid_.takesChanges(), detail::kMustNotChange);
    if (!grid_.contains(motion.id)) {
        return;
    }
    const Vector3<Scalar>& displacement = motion.way.displacement;
    const bool isUsable = displacement.allFinite();
    if (!isUsable && !reportedBadData_) {
        reportedBadData_ = true;
        detail::reportMessage(
            "Sweeps::set(): a displacement is NaN or infinite, so its proxy does not sweep. Set a "
            "finite one. Later cases are not reported.");
    }
    if (!isUsable || motion.sweep == Sweep::none || displacement.isZero(0)) {
        sweeping_.motions.end(motion.id.index);
    } else {
        sweeping_.motions.set(motion);
    }
}

template <class Scalar>
MovingBox<Scalar> Sweeps<Scalar>::motion(ProxyId id) const {
    const detail::Motions<Scalar>& motions = sweeping_.motions;
    if (!motions.sweeps(id)) {
        return {grid_.box(id)};
    }
    const Motion& motion = motions.all[motions.of(id.index)];
    return motion.isFromGrid ? MovingBox<Scalar>{grid_.box(id), motion.way.displacement}
                             : motion.way;
}

template <class Scalar>
std::size_t Sweeps<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) + sweeping_.motions.memoryBytes() + sweeping_.search.memoryBytes();
}

template <class Scalar>
void Sweeps<Scalar>::releaseUnusedMemory() noexcept {
    HASHPHASE_ASSERT(!grid_.isWithinQuery(),
                     "Sweeps::releaseUnusedMemory() was called from within a query. Call it after "
                     "the query returns.");
    sweeping_.releaseUnusedMemory();
}

template <class Scalar>
std::string Sweeps<Scalar>::validate() const {
    return sweeping_.motions.validate();
}

template class HASHPHASE_INSTANCE_EXPORT Sweeps<float>;
template class HASHPHASE_INSTANCE_EXPORT Sweeps<double>;

}  // namespace hashphase
