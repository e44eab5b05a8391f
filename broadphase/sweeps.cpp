// SPDX-License-Identifier: Zlib
#include <broadphase/sweeps.hpp>

#include <broadphase/diagnostics.hpp>

namespace hashphase {

template <class Scalar>
void Sweeps<Scalar>::set(ProxyId id, const Vector3<Scalar>& displacement, Sweep sweep) {
    HASHPHASE_ASSERT(grid_.contains(id), "Only a proxy of the grid can sweep.");
    const bool isUsable = displacement.allFinite();
    if (!isUsable && !reportedBadData_) {
        reportedBadData_ = true;
        detail::reportMessage(
            "A proxy was to sweep by a displacement that is NaN or infinite. It counts as "
            "standing; further ones do so silently.");
    }
    const std::uint32_t known = motionOf(id.index);
    if (!isUsable || sweep == Sweep::none || displacement.isZero(0)) {
        if (known != kNone) {
            end(known);
            grid_.noteChange(id.index);  // what it has met is to be given up
        }
        return;
    }
    if (known != kNone) {
        motions_[known] = {id, displacement, sweep};
        return;
    }
    makeRoom();
    motions_.push_back({id, displacement, sweep});
    motionOfSlot_[id.index] = static_cast<std::uint32_t>(motions_.size() - 1);
    grid_.noteChange(id.index);
}

template <class Scalar>
MovingBox<Scalar> Sweeps<Scalar>::motion(ProxyId id) const {
    if (!sweeps(id)) {
        return {grid_.box(id)};
    }
    return {grid_.box(id), motions_[motionOf(id.index)].displacement};
}

// The last motion takes the place of the one that ends.
template <class Scalar>
void Sweeps<Scalar>::end(std::uint32_t motion) {
    motionOfSlot_[motions_[motion].id.index] = kNone;
    motions_[motion] = motions_.back();
    motions_.pop_back();
    if (motion < motions_.size()) {
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
    if (!motions_.empty()) {
        makeRoom();
    }
    for (std::uint32_t i = 0; i < motions_.size();) {
        if (grid_.contains(motions_[i].id)) {
            grid_.noteChange(motions_[i].id.index);
            ++i;
        } else {
            end(i);
        }
    }
}

template <class Scalar>
std::size_t Sweeps<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) + motions_.capacity() * sizeof(Motion) +
           motionOfSlot_.capacity() * sizeof(std::uint32_t) + search_.memoryBytes();
}

template <class Scalar>
std::string Sweeps<Scalar>::validate() const {
    std::size_t listed = 0;
    for (std::uint32_t slot = 0; slot < motionOfSlot_.size(); ++slot) {
        const std::uint32_t motion = motionOfSlot_[slot];
        listed += motion != kNone ? 1 : 0;
        if (motion != kNone && (motion >= motions_.size() || motions_[motion].id.index != slot)) {
            listed = motions_.size() + 1;
            break;
        }
    }
    return listed == motions_.size()
               ? std::string()
               : "Every motion is listed by its slot, and no other slot is: broken.";
}

template class Sweeps<float>;
template class Sweeps<double>;

}  // namespace hashphase
