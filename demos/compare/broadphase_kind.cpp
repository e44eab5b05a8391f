// SPDX-License-Identifier: Zlib
#include <demos/compare/broadphase_kind.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace hashphase::demos {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

std::unique_ptr<btBroadphaseInterface> makeHash(const BroadphaseNeeds& needs) {
    SpatialHashConfig config;
    config.grid = needs.grid;
    return std::make_unique<SpatialHashBroadphase>(config);
}

std::unique_ptr<btBroadphaseInterface> makeDbvt(const BroadphaseNeeds& /*needs*/) {
    return std::make_unique<btDbvtBroadphase>();
}

std::unique_ptr<btBroadphaseInterface> makeDeferredDbvt(const BroadphaseNeeds& /*needs*/) {
    auto broadphase = std::make_unique<btDbvtBroadphase>();
    broadphase->m_deferedcollide = true;
    return broadphase;
}

std::unique_ptr<btBroadphaseInterface> makeAxisSweep(const BroadphaseNeeds& needs) {
    const Vector3<float>& low = needs.bounds.min();
    const Vector3<float>& high = needs.bounds.max();
    // A margin keeps the outermost boxes off the world's faces, to which it clamps. Its second
    // structure, for rays, is switched off: no rays are cast here.
    const btVector3 margin(1, 1, 1);
    return std::make_unique<bt32BitAxisSweep3>(btVector3(low.x(), low.y(), low.z()) - margin,
                                               btVector3(high.x(), high.y(), high.z()) + margin,
                                               static_cast<unsigned int>(needs.objects) + 16,
                                               nullptr, true);
}

std::unique_ptr<btBroadphaseInterface> makeSimple(const BroadphaseNeeds& needs) {
    return std::make_unique<btSimpleBroadphase>(static_cast<int>(needs.objects) + 16);
}

constexpr std::array kKinds{
    BroadphaseKind{"hash", "hashphase", "hashphase::SpatialHashBroadphase, the spatial hash", true,
                   kNoLimit, false, makeHash},
    BroadphaseKind{"dbvt", "btDbvtBroadphase",
                   "Bullet's usual broadphase, a pair of bounding volume trees", false, kNoLimit,
                   false, makeDbvt},
    BroadphaseKind{"dbvt-deferred", "btDbvtBroadphase, deferred",
                   "the same with m_deferedcollide, which finds pairs once a frame", false,
                   kNoLimit, false, makeDeferredDbvt},
    BroadphaseKind{"axis-sweep", "bt32BitAxisSweep3",
                   "Bullet's sweep and prune (slow to fill: by default up to 35,000 objects)",
                   false, 35'000, true, makeAxisSweep, 5'000},
    BroadphaseKind{"simple", "btSimpleBroadphase",
                   "Bullet's brute force (by default up to 3,000 objects)", false, 3'000, true,
                   makeSimple, 3'000},
};

}  // namespace

std::span<const BroadphaseKind> broadphaseKinds() {
    return kKinds;
}

const BroadphaseKind& broadphaseKind(std::string_view name) {
    const auto* const found = std::ranges::find(kKinds, name, &BroadphaseKind::name);
    if (found == kKinds.end()) {
        throw std::logic_error("There is no broadphase '" + std::string(name) + "'.");
    }
    return *found;
}

}  // namespace hashphase::demos
