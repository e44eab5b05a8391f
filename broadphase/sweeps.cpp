// SPDX-License-Identifier: Zlib
#include <broadphase/sweeps.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/geometry/origin_shift.hpp>

#include <algorithm>
#include <utility>

namespace hashphase {

template <class Scalar>
Sweeps<Scalar>::Sweeps(Grid<Scalar>& grid) : grid_(grid), next_(grid.firstSweeps_), search_(grid) {
    grid.firstSweeps_ = this;
}

template <class Scalar>
Sweeps<Scalar>::~Sweeps() {
    Sweeps** place = &grid_.firstSweeps_;
    while (*place != this) {
        place = &(*place)->next_;
    }
    *place = next_;
}

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
    HASHPHASE_ASSERT(grid_.contains(motion.id), "Only a proxy of the grid can sweep.");
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(&grid_), detail::kMustNotChange);
    if (!grid_.contains(motion.id)) {
        return;
    }
    const Vector3<Scalar>& displacement = motion.way.displacement;
    const bool isUsable = displacement.allFinite();
    if (!isUsable && !reportedBadData_) {
        reportedBadData_ = true;
        detail::reportMessage(
            "A proxy was to sweep by a displacement that is NaN or infinite. It counts as "
            "standing; further ones do so silently.");
    }
    const std::uint32_t slot = motion.id.index;
    const std::uint32_t known = motionOf(slot);
    if (!isUsable || motion.sweep == Sweep::none || displacement.isZero(0)) {
        if (known != kNone) {
            end(known);
            grid_.endSweep(slot);  // what it has met is to be given up
        }
        return;
    }
    if (known != kNone) {
        motions_[known] = motion;
        return;
    }
    makeRoom();
    auto place = static_cast<std::uint32_t>(motions_.size());
    if (firstVacant_ == kNone) {
        motions_.push_back(motion);
    } else {
        place = std::exchange(firstVacant_, motions_[firstVacant_].id.index);
        --vacantCount_;
        motions_[place] = motion;
    }
    motionOfSlot_[slot] = place;
    grid_.noteChange(slot);
}

template <class Scalar>
MovingBox<Scalar> Sweeps<Scalar>::motion(ProxyId id) const {
    if (!sweeps(id)) {
        return {grid_.box(id)};
    }
    return wayOf(motions_[motionOf(id.index)]);
}

// For pairs that have not heard of them.
template <class Scalar>
void Sweeps<Scalar>::noteAllChanged() noexcept {
    for (const Motion& motion : motions_) {
        if (grid_.contains(motion.id)) {
            grid_.noteChange(motion.id.index);
        }
    }
}

template <class Scalar>
void Sweeps<Scalar>::shiftOrigin(const Vector3<Scalar>& shift) noexcept {
    for (Motion& motion : motions_) {
        motion.way.box = detail::shiftedBox(motion.way.box, shift);
    }
}

// Its place stays, for the next one that begins: a query whose collector ends motions goes on where
// it was.
template <class Scalar>
void Sweeps<Scalar>::end(std::uint32_t motion) noexcept {
    motionOfSlot_[motions_[motion].id.index] = kNone;
    motions_[motion].id = {firstVacant_, 0};
    firstVacant_ = motion;
    ++vacantCount_;
}

// The last motion takes the place of the one that goes.
template <class Scalar>
void Sweeps<Scalar>::drop(std::uint32_t motion) noexcept {
    if (!motions_[motion].id.isNull()) {
        motionOfSlot_[motions_[motion].id.index] = kNone;
    }
    motions_[motion] = motions_.back();
    motions_.pop_back();
    if (motion < motions_.size() && !motions_[motion].id.isNull()) {
        motionOfSlot_[motions_[motion].id.index] = motion;
    }
}

template <class Scalar>
void Sweeps<Scalar>::makeRoom() {
    if (motionOfSlot_.size() < grid_.records_.size()) {
        motionOfSlot_.resize(grid_.records_.size(), kNone);
    }
}

// What sweeps counts as changed in each update, whether its box has changed or not: it never comes to
// rest, and what it meets is looked for anew.
template <class Scalar>
void Sweeps<Scalar>::beginUpdate() {
    const std::size_t slotCount = grid_.records_.size();
    const std::size_t dropped = std::max(motionOfSlot_.size(), slotCount) - slotCount;
    if (peaks_.isPast(motions_.size(), std::max(motions_.capacity(), dropped))) {
        releaseUnusedMemory();
    }
    if (!motions_.empty()) {
        makeRoom();
    }
    detail::ensureCapacity(grid_.sweepingSlots_, motions_.size());
    grid_.sweepingSlots_.clear();
    for (std::uint32_t i = 0; i < motions_.size();) {
        if (grid_.contains(motions_[i].id)) {
            grid_.beginSweep(motions_[i].id.index);
            motions_[i].way = wayOf(motions_[i]);
            ++i;
        } else {
            drop(i);
        }
    }
    firstVacant_ = kNone;
    vacantCount_ = 0;
}

template <class Scalar>
std::size_t Sweeps<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) + motions_.capacity() * sizeof(Motion) +
           motionOfSlot_.capacity() * sizeof(std::uint32_t) + search_.memoryBytes();
}

template <class Scalar>
void Sweeps<Scalar>::releaseUnusedMemory() noexcept {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(&grid_),
                     "Memory is not given back within a query.");
    while (motionOfSlot_.size() > grid_.records_.size() && motionOfSlot_.back() == kNone) {
        motionOfSlot_.pop_back();
    }
    if (motions_.empty()) {
        motionOfSlot_.clear();
    }
    motionOfSlot_.shrink_to_fit();
    motions_.shrink_to_fit();
    search_.releaseUnusedMemory();
}

template <class Scalar>
std::string Sweeps<Scalar>::validate() const {
    std::size_t listed = 0;
    for (std::uint32_t slot = 0; slot < motionOfSlot_.size(); ++slot) {
        const std::uint32_t motion = motionOfSlot_[slot];
        listed += motion != kNone ? 1 : 0;
        if (motion != kNone && (motion >= motions_.size() || motions_[motion].id.index != slot)) {
            listed = size() + 1;
            break;
        }
    }
    return listed == size() ? std::string()
                            : "Every motion is listed by its slot, and no other slot is: broken.";
}

template class Sweeps<float>;
template class Sweeps<double>;

}  // namespace hashphase
