// SPDX-License-Identifier: Zlib

// What a broadphase does as one of the worlds of a WorldsBroadphase: all share a pair cache and unique ids.

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

// The cache tells the WorldsBroadphase what is taken out of it.
SpatialHashBroadphase::SpatialHashBroadphase(const SpatialHashConfig& config,
                                             PairCache& sharedCache, int& sharedUniqueId,
                                             std::uint16_t worldNumber)
    : SpatialHashBroadphase(static_cast<btOverlappingPairCache*>(&sharedCache), config) {
    unlist();
    watch_.cache = &sharedCache;
    groupsDecide_ = doGroupsDecide();
    idCounter_ = &sharedUniqueId;
    worldNumber_ = worldNumber;
}

// Whether calculateOverlappingPairs() would find nothing. Groups that were written are looked at where
// something has changed.
bool SpatialHashBroadphase::isUpToDate() const noexcept {
    return changedKinds_ == 0 && !mustNoteGroups_ && !isCacheBehind_ &&
           !watch_.isAnythingTakenOut() && groupsDecide_ == doGroupsDecide() && pairs_.isUpToDate();
}

void SpatialHashBroadphase::listChanges(const PairChanges& changes,
                                        std::vector<BulletProxyPair>& died,
                                        std::vector<BulletProxyPair>& born) const {
    findBulletPairs(changes.died, died, died.size());
    findBulletPairs(changes.born, born, born.size());
}

void SpatialHashBroadphase::listAll(std::vector<BulletProxyPair>& bulletPairs) const {
    std::vector<ProxyPair> all;
    pairs_.collect(all);
    findBulletPairs(all, bulletPairs, bulletPairs.size());
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
