// SPDX-License-Identifier: Zlib
#include <broadphase/store/motions.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/geometry/origin_shift.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::detail {

template <class Scalar>
Motions<Scalar>::Motions(Store<Scalar>& itsStore) : store(itsStore), next(itsStore.firstMotions) {
    store.firstMotions = this;
}

template <class Scalar>
Motions<Scalar>::~Motions() {
    Motions** place = &store.firstMotions;
    while (*place != this) {
        place = &(*place)->next;
    }
    *place = next;
}

template <class Scalar>
void Motions<Scalar>::set(const Motion<Scalar>& motion) {
    const std::uint32_t proxyIndex = motion.id.index;
    const std::uint32_t known = of(proxyIndex);
    if (known != kNone) {
        all[known] = motion;
        return;
    }
    makeRoom();
    auto place = static_cast<std::uint32_t>(all.size());
    if (firstVacant == kNone) {
        all.push_back(motion);
    } else {
        place = std::exchange(firstVacant, all[firstVacant].id.index);
        --vacantCount;
        all[place] = motion;
    }
    ofProxy[proxyIndex] = place;
    store.markChanged(proxyIndex);
}

// Its place stays, for the next one that begins: a query whose collector ends motions goes on where
// it was.
template <class Scalar>
void Motions<Scalar>::end(std::uint32_t proxyIndex) noexcept {
    const std::uint32_t known = of(proxyIndex);
    if (known == kNone) {
        return;
    }
    ofProxy[all[known].id.index] = kNone;
    all[known].id = {firstVacant, 0};
    firstVacant = known;
    ++vacantCount;
    store.endSweep(proxyIndex);
}

template <class Scalar>
void Motions<Scalar>::markAllChanged() noexcept {
    for (const Motion<Scalar>& motion : all) {
        if (store.proxies.contains(motion.id)) {
            store.markChanged(motion.id.index);
        }
    }
}

template <class Scalar>
void Motions<Scalar>::shiftOrigin(const Vector3<Scalar>& shift) noexcept {
    for (Motion<Scalar>& motion : all) {
        motion.way.box = shiftedBox(motion.way.box, shift);
    }
}

// The last motion takes the place of the one that goes.
template <class Scalar>
void Motions<Scalar>::drop(std::uint32_t motion) noexcept {
    if (!all[motion].id.isNull()) {
        ofProxy[all[motion].id.index] = kNone;
    }
    all[motion] = all.back();
    all.pop_back();
    if (motion < all.size() && !all[motion].id.isNull()) {
        ofProxy[all[motion].id.index] = motion;
    }
}

template <class Scalar>
void Motions<Scalar>::makeRoom() {
    if (ofProxy.size() < store.proxies.records.size()) {
        ofProxy.resize(store.proxies.records.size(), kNone);
    }
}

template <class Scalar>
void Motions<Scalar>::beginUpdate() {
    if (!all.empty()) {
        makeRoom();
    }
    ensureCapacity(store.proxies.sweeping, all.size());
    store.proxies.sweeping.clear();
    for (std::uint32_t i = 0; i < all.size();) {
        if (store.proxies.contains(all[i].id)) {
            store.beginSweep(all[i].id.index);
            all[i].way = wayOf(all[i]);
            ++i;
        } else {
            drop(i);
        }
    }
    firstVacant = kNone;
    vacantCount = 0;
}

template <class Scalar>
void Motions<Scalar>::releaseUnusedMemory() noexcept {
    while (ofProxy.size() > store.proxies.records.size() && ofProxy.back() == kNone) {
        ofProxy.pop_back();
    }
    if (all.empty()) {
        ofProxy.clear();
    }
    ofProxy.shrink_to_fit();
    all.shrink_to_fit();
}

template <class Scalar>
std::string Motions<Scalar>::validate() const {
    std::size_t listed = 0;
    for (std::uint32_t proxyIndex = 0; proxyIndex < ofProxy.size(); ++proxyIndex) {
        const std::uint32_t motion = ofProxy[proxyIndex];
        listed += motion != kNone ? 1 : 0;
        if (motion != kNone && (motion >= all.size() || all[motion].id.index != proxyIndex)) {
            listed = size() + 1;
            break;
        }
    }
    return listed == size()
               ? std::string()
               : "Every motion is listed by its proxyIndex, and no other proxyIndex is: broken.";
}

template struct HASHPHASE_INSTANCE_EXPORT Motions<float>;
template struct HASHPHASE_INSTANCE_EXPORT Motions<double>;

}  // namespace hashphase::detail
