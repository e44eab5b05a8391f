// SPDX-License-Identifier: Zlib

// How the grid comes to know of groups and masks, which may be written at any time.

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <integration/bullet/pair_cache.hpp>

#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

// Not where a callback decides, nor in a cache that may decide as it likes, unless these accept nothing
// that group and mask refuse.
bool SpatialHashBroadphase::doGroupsDecide() const {
    return config_.filterRefusesMore ||
           (watch_.cache != nullptr && !watch_.cache->hasFilterCallback());
}

// A callback may come and go at any time. It may answer otherwise than group and mask.
void SpatialHashBroadphase::followFilter() {
    const bool decide = doGroupsDecide();
    if (decide != groupsDecide_) {
        groupsDecide_ = decide;
        noteGroupsOfAll();
    }
}

// Group and mask are Bullet's fields, and may be written at any time. Returns whether they were.
bool SpatialHashBroadphase::noteGroups(Proxy& proxy) {
    const ProxyGroups groups = groupsOf(proxy);
    const bool isOther = proxy.kind == detail::GroupKinds::kOther;
    if (groups == (isOther ? grid_.groups(proxy.id) : groupKinds_[proxy.kind])) {
        return false;
    }
    grid_.setGroups(proxy.id, groups);
    proxy.kind = groupKinds_.numberOf(groups);
    changedKinds_ |= detail::GroupKinds::bit(proxy.kind);
    return true;
}

// A proxy that nobody has set may have got other groups, and what moves may touch it. That matters only
// where what has moved may not pair with some kind of proxies; mostly all may, or all have been set.
void SpatialHashBroadphase::noteGroupsIfTheyMatter() {
    using Kinds = detail::GroupKinds::Set;
    const bool someSweep = sweeps_ != nullptr && sweeps_->size() > 0;
    const bool doMatter =
        groupsDecide_ && groupKinds_.refuse(someSweep ? ~Kinds{0} : changedKinds_, ~Kinds{0});
    if (mustNoteGroups_ || (doMatter && (seen_.empty() || seenCount_ < grid_.size()))) {
        noteGroupsOfAll();
    }
    seen_.assign(doMatter ? uniqueIds_.size() / 64 + 1 : 0, 0);
    seenCount_ = 0;
    mustNoteGroups_ = false;
    changedKinds_ = 0;
}

void SpatialHashBroadphase::noteGroupsOfAll() {
    for (std::uint32_t slot = 0; slot < uniqueIds_.size(); ++slot) {
        if (uniqueIds_[slot] != 0) {
            noteGroups(*proxyAt(slot));
        }
    }
}

// Of what the proxy touches, and of the proxy.
void SpatialHashBroadphase::noteGroupsAround(const Proxy& proxy) {
    std::vector<ProxyId> found{proxy.id};
    CollectAll collector(found);
    if (sweeps_ != nullptr) {
        const Aabb<btScalar> bounds = sweptBounds(sweeps_->motion(proxy.id));
        sweeps_->visit(BoxRegion<btScalar>{bounds}, collector);
    } else {
        grid_.visit(BoxRegion<btScalar>{grid_.box(proxy.id)}, collector);
    }
    for (const ProxyId id : found) {
        noteGroups(*proxyAt(id.index));
    }
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
