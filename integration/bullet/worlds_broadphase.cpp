// SPDX-License-Identifier: Zlib
#include <integration/bullet/worlds_broadphase.hpp>

#include <broadphase/core/on_failure.hpp>
#include <broadphase/core/raise.hpp>
#include <integration/bullet/conversions.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <LinearMath/btQuickprof.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

const WorldsConfig& checked(const WorldsConfig& config) {
    const std::string error = configError(config);
    if (!error.empty()) {
        detail::raiseInvalidArgument(error);
    }
    return config;
}

}  // namespace

std::string configError(const WorldsConfig& config) {
    if (config.worldCount < 1 || config.worldCount > WorldsBroadphase::kMostWorlds) {
        return "WorldsConfig::worldCount is " + std::to_string(config.worldCount) +
               ", but must be from 1 to " + std::to_string(WorldsBroadphase::kMostWorlds) + ".";
    }
    if (!config.worldOf) {
        return "WorldsConfig::worldOf is empty, but must return the world of an object. Set it.";
    }
    return configError(config.each);
}

WorldsBroadphase::WorldsBroadphase(PairCache* pairCache, const WorldsConfig& config)
    : config_(checked(config)),
      ownCache_(pairCache == nullptr ? std::make_unique<PairCache>() : nullptr),
      pairCache_(pairCache == nullptr ? ownCache_.get() : pairCache) {
    SpatialHashConfig each = config.each;
    each.parallelFor = nullptr;  // they run side by side
    worlds_.reserve(static_cast<std::size_t>(config.worldCount));
    for (int number = 0; number < config.worldCount; ++number) {
        worlds_.emplace_back(
            new World(each, *pairCache_, lastUniqueId_, static_cast<std::uint16_t>(number)));
    }
    if (pairCache_->watcher() != nullptr) {
        pairCache_->watcher()->forget();
    }
    pairCache_->setWatcher(this);
}

WorldsBroadphase::~WorldsBroadphase() {
    if (pairCache_ != nullptr && pairCache_->watcher() == this) {
        pairCache_->setWatcher(nullptr);
    }
}

// --- Which world ---------------------------------------------------------------------------------

SpatialHashBroadphase& WorldsBroadphase::world(int number) {
    HASHPHASE_ASSERT(
        number >= 0 && number < worldCount(),
        "WorldsBroadphase::world(): there is no world of that number. Pass 0 to worldCount() - 1.");
    return *worlds_[static_cast<std::size_t>(number)];
}

const SpatialHashBroadphase& WorldsBroadphase::world(int number) const {
    HASHPHASE_ASSERT(
        number >= 0 && number < worldCount(),
        "WorldsBroadphase::world(): there is no world of that number. Pass 0 to worldCount() - 1.");
    return *worlds_[static_cast<std::size_t>(number)];
}

SpatialHashBroadphase& WorldsBroadphase::worldFor(const btBroadphaseProxy* proxy) const {
    HASHPHASE_ASSERT(
        proxy != nullptr,
        "WorldsBroadphase: a proxy is null. Pass proxies that createProxy() returned.");
    const std::size_t number = static_cast<const World::Proxy*>(proxy)->world;
    HASHPHASE_ASSERT(
        number < worlds_.size(),
        "WorldsBroadphase: a proxy is of another broadphase. Pass a proxy of these worlds.");
    return *worlds_[number];
}

int WorldsBroadphase::worldOf(const btBroadphaseProxy* proxy) const {
    return worldFor(proxy).worldNumber_;
}

SpatialHashBroadphase& WorldsBroadphase::worldForClient(const void* client) {
    if (client == nullptr) {
        detail::raiseInvalidArgument(
            "WorldsBroadphase::createProxy(): without a btCollisionObject the world is unknown. "
            "Call world(number).createProxy() instead.");
    }
    const int number = config_.worldOf(*static_cast<const btCollisionObject*>(client));
    if (number < 0 || number >= worldCount()) {
        detail::raiseInvalidArgument("WorldsConfig::worldOf returned " + std::to_string(number) +
                                     ", but must return a world from 0 to " +
                                     std::to_string(worldCount() - 1) + ".");
    }
    return world(number);
}

// Calls call(world, its proxies), world by world, without those that callbacks of the former have destroyed.
template <class Call>
void WorldsBroadphase::forEachWorldOf(std::span<btBroadphaseProxy* const> proxies,
                                      const Call& call) const {
    std::vector<btBroadphaseProxy*> sorted(proxies.begin(), proxies.end());
    std::stable_sort(sorted.begin(), sorted.end(),
                     [this](const btBroadphaseProxy* a, const btBroadphaseProxy* b) {
                         return worldOf(a) < worldOf(b);
                     });
    std::vector<int> ids;
    World::noteIds(sorted, ids);
    std::vector<btBroadphaseProxy*> present;
    for (std::size_t i = 0; i < sorted.size();) {
        World& world = worldFor(sorted[i]);
        present.clear();
        for (; i < sorted.size() && &worldFor(sorted[i]) == &world; ++i) {
            if (sorted[i]->m_uniqueId == ids[i]) {
                present.push_back(sorted[i]);
            }
        }
        call(world, std::span<btBroadphaseProxy* const>(present));
    }
}

// --- btBroadphaseInterface -----------------------------------------------------------------------

btBroadphaseProxy* WorldsBroadphase::createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                                 int shapeType, void* userPtr,
                                                 int collisionFilterGroup, int collisionFilterMask,
                                                 btDispatcher* dispatcher) {
    return worldForClient(userPtr).createProxy(aabbMin, aabbMax, shapeType, userPtr,
                                               collisionFilterGroup, collisionFilterMask,
                                               dispatcher);
}

void WorldsBroadphase::destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    worldFor(proxy).destroyProxy(proxy, dispatcher);
}

void WorldsBroadphase::setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin,
                               const btVector3& aabbMax, btDispatcher* dispatcher) {
    worldFor(proxy).World::setAabb(proxy, aabbMin, aabbMax, dispatcher);
}

void WorldsBroadphase::getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin,
                               btVector3& aabbMax) const {
    worldFor(proxy).getAabb(proxy, aabbMin, aabbMax);
}

void WorldsBroadphase::rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                               btBroadphaseRayCallback& rayCallback, const btVector3& aabbMin,
                               const btVector3& aabbMax) {
    for (const auto& world : worlds_) {
        if (world->endsRayTest(rayFrom, rayTo, rayCallback, aabbMin, aabbMax)) {
            return;
        }
    }
}

void WorldsBroadphase::aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                                btBroadphaseAabbCallback& callback) {
    for (const auto& world : worlds_) {
        if (world->endsAabbTest(aabbMin, aabbMax, callback)) {
            return;
        }
    }
}

QueryCost WorldsBroadphase::closestRay(const btVector3& from, const btVector3& to,
                                       btCollisionWorld::RayResultCallback& callback) const {
    QueryCost cost;
    for (const auto& world : worlds_) {
        cost += world->closestRay(from, to, callback);
    }
    return cost;
}

void WorldsBroadphase::getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const {
    Aabb<btScalar> all;
    for (const auto& world : worlds_) {
        all.extend(world->bounds());
    }
    aabbMin = all.isEmpty() ? btVector3(0, 0, 0) : toBullet(all.min());
    aabbMax = all.isEmpty() ? btVector3(0, 0, 0) : toBullet(all.max());
}

void WorldsBroadphase::resetPool(btDispatcher* dispatcher) {
    const bool isWithin = detail::QueryScope::isWithin(&lastUniqueId_);
    HASHPHASE_ASSERT(
        !isWithin,
        "resetPool() was called from a callback or a query. Call it after the step or the query.");
    const auto isEmpty = [](const auto& world) { return world->grid().size() == 0; };
    if (isWithin || !std::all_of(worlds_.begin(), worlds_.end(), isEmpty)) {
        return;
    }
    for (const auto& world : worlds_) {
        world->resetPool(dispatcher);
    }
    lastUniqueId_ = 0;
}

// --- Many at once, and beyond Bullet -------------------------------------------------------------

void WorldsBroadphase::setAabbs(std::span<btBroadphaseProxy* const> proxies,
                                std::span<const btVector3> aabbMins,
                                std::span<const btVector3> aabbMaxs, btDispatcher* dispatcher) {
    BT_PROFILE("hashphase: set boxes");
    HASHPHASE_ASSERT(
        proxies.size() == aabbMins.size() && proxies.size() == aabbMaxs.size(),
        "setAabbs(): proxies and boxes have different lengths. Pass one box for each proxy.");
    std::vector<int> ids = std::exchange(notedIds_, {});  // callbacks may set others
    World::noteIds(proxies, ids);
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        if (proxies[i]->m_uniqueId == ids[i]) {  // else a callback has destroyed it
            setAabb(proxies[i], aabbMins[i], aabbMaxs[i], dispatcher);
        }
    }
    notedIds_ = std::move(ids);
}

// All pairs at once: the cache may pass over those of all worlds.
void WorldsBroadphase::destroyProxies(std::span<btBroadphaseProxy* const> proxies,
                                      btDispatcher* dispatcher) {
    BT_PROFILE("hashphase: destroy proxies");
    std::vector<btBroadphaseProxy*> alive;
    std::copy_if(proxies.begin(), proxies.end(), std::back_inserter(alive),
                 [this](btBroadphaseProxy* proxy) {
                     return !worldFor(proxy).checkedProxy(proxy)->id.isNull();
                 });
    std::vector<int> ids;
    World::noteIds(alive, ids);
    World::checkNamedOnce(ids);
    std::vector<std::uint64_t> changeCounts;
    changeCounts.reserve(alive.size());
    for (const btBroadphaseProxy* const proxy : alive) {
        changeCounts.push_back(worldFor(proxy).cacheChangeCount_);
    }
    const detail::OnFailure fallBehind([&] {  // for nobody is destroyed
        for (const btBroadphaseProxy* const proxy : alive) {
            worldFor(proxy).isCacheBehind_ = true;
        }
    });
    pairCache_->removePairsOf(alive, dispatcher, PairCache::Remover::broadphase);
    for (std::size_t i = 0; i < alive.size(); ++i) {
        worldFor(alive[i]).endProxy(static_cast<World::Proxy&>(*alive[i]), ids[i], changeCounts[i],
                                    dispatcher);
    }
}

void WorldsBroadphase::refilter(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    worldFor(proxy).refilter(proxy, dispatcher);
}

void WorldsBroadphase::refilter(std::span<btBroadphaseProxy* const> proxies,
                                btDispatcher* dispatcher) {
    forEachWorldOf(proxies, [&](World& world, std::span<btBroadphaseProxy* const> ofWorld) {
        world.refilter(ofWorld, dispatcher);
    });
}

void WorldsBroadphase::refilterAll(btDispatcher* dispatcher) {
    for (const auto& world : worlds_) {
        world->refilterAll(dispatcher);
    }
}

void WorldsBroadphase::ignorePair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                  btDispatcher* dispatcher) {
    if (&worldFor(a) == &worldFor(b)) {
        worldFor(a).ignorePair(a, b, dispatcher);
    }
}

void WorldsBroadphase::stopIgnoringPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                        btDispatcher* dispatcher) {
    if (&worldFor(a) == &worldFor(b)) {
        worldFor(a).stopIgnoringPair(a, b, dispatcher);
    }
}

bool WorldsBroadphase::isIgnoredPair(const btBroadphaseProxy* a, const btBroadphaseProxy* b) const {
    return &worldFor(a) == &worldFor(b) && worldFor(a).isIgnoredPair(a, b);
}

void WorldsBroadphase::collisionChecksChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    worldFor(proxy).collisionChecksChanged(proxy, dispatcher);
}

void WorldsBroadphase::collisionChecksChanged(std::span<btBroadphaseProxy* const> proxies,
                                              btDispatcher* dispatcher) {
    forEachWorldOf(proxies, [&](World& world, std::span<btBroadphaseProxy* const> ofWorld) {
        world.collisionChecksChanged(ofWorld, dispatcher);
    });
}

void WorldsBroadphase::setMargin(btBroadphaseProxy* proxy, btScalar margin,
                                 btDispatcher* dispatcher) {
    worldFor(proxy).setMargin(proxy, margin, dispatcher);
}

btScalar WorldsBroadphase::margin(const btBroadphaseProxy* proxy) const {
    return worldFor(proxy).margin(proxy);
}

void WorldsBroadphase::shapeChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    worldFor(proxy).shapeChanged(proxy, dispatcher);
}

std::size_t WorldsBroadphase::shiftOrigin(const btVector3& shift) {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(&lastUniqueId_),
                     "shiftOrigin() was called from a callback of calculateOverlappingPairs(). "
                     "Call it after the step.");
    std::size_t roundedCount = 0;
    for (const auto& world : worlds_) {
        roundedCount += world->shiftOrigin(shift);
    }
    return roundedCount;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
