// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's own ghosts, and bodies that come and go or are moved by hand.

#include <tests/integration/bullet/dynamics.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace hashphase::test {

/// A world over our broadphase that tells ghosts of pairs, for objects of all kinds.
struct ObjectWorld {
    explicit ObjectWorld(const SpatialHashConfig& config = {}, PairOrder order = PairOrder::arrival)
        : cache(order), broadphase(&cache, config) {
        watchBy(&ghostCallback);
    }
    ~ObjectWorld() { removeAll(); }
    ObjectWorld(const ObjectWorld&) = delete;
    ObjectWorld& operator=(const ObjectWorld&) = delete;

    void add(btCollisionObject& object, btCollisionShape& shape, const btVector3& at,
             int group = btBroadphaseProxy::DefaultFilter) {
        object.setCollisionShape(&shape);
        object.setWorldTransform(placeAt(at));
        world.addCollisionObject(&object, group, btBroadphaseProxy::AllFilter);
    }
    void move(btCollisionObject& object, const btVector3& to) {
        object.setWorldTransform(placeAt(to));
        world.updateSingleAabb(&object);
    }
    void removeAll() {
        while (world.getNumCollisionObjects() > 0) {
            world.removeCollisionObject(
                world.getCollisionObjectArray()[world.getNumCollisionObjects() - 1]);
        }
    }
    void watchBy(btOverlappingPairCallback* watcher) {
        cache.setInternalGhostPairCallback(watcher);
    }
    void detect() { world.performDiscreteCollisionDetection(); }
    [[nodiscard]] int pairCount() { return cache.getNumOverlappingPairs(); }

    btBoxShape box{btVector3(1, 1, 1)};
    btGhostPairCallback ghostCallback;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    PairCache cache;
    SpatialHashBroadphase broadphase;
    btCollisionWorld world{&dispatcher, &broadphase, &configuration};
};

/// A world without gravity, with a btGhostObject and a btPairCachingGhostObject at the origin and
/// boxes in a row elsewhere, of which some come and go. The others touch, so that btDbvtBroadphase,
/// which checks a part of its pairs in a step, would not check the ghosts' for long.
struct GhostWorld : DynamicsWorld {
    explicit GhostWorld(
        std::unique_ptr<btBroadphaseInterface> over = std::make_unique<SpatialHashBroadphase>())
        : DynamicsWorld(std::move(over)) {
        world().setGravity({0, 0, 0});
        tellGhosts();
        for (btGhostObject* const object : ghosts()) {
            object->setCollisionShape(&large);
            object->setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
            world().addCollisionObject(object, btBroadphaseProxy::SensorTrigger,
                                       btBroadphaseProxy::AllFilter);
        }
        for (int i = 0; i < 30; ++i) {
            const int number = add(&small, 1, placeAt({100 + btScalar(i) * btScalar(1.01), 0, 0}));
            body(number).setActivationState(DISABLE_DEACTIVATION);
        }
    }
    ~GhostWorld() {
        for (btGhostObject* const object : ghosts()) {
            world().removeCollisionObject(object);
        }
        for (int i = 0; i < bodyCount(); ++i) {
            takeOut(i);
        }
    }

    std::vector<btGhostObject*> ghosts() { return {&ghost, &cachingGhost}; }
    void detect() { world().performDiscreteCollisionDetection(); }

    /// Whether both are in the world, and their boxes overlap.
    static bool touches(const btCollisionObject& a, const btCollisionObject& b) {
        const btBroadphaseProxy* const p = a.getBroadphaseHandle();
        const btBroadphaseProxy* const q = b.getBroadphaseHandle();
        return p != nullptr && q != nullptr && overlap(boxOf(*p), boxOf(*q));
    }

    static bool doesList(btGhostObject& object, btCollisionObject& other) {
        btAlignedObjectArray<btCollisionObject*>& all = object.getOverlappingPairs();
        return all.findLinearSearch(&other) < all.size();
    }

    /// Numbers of the bodies for which isSo(object, body); the other ghost is not counted.
    template <class Object, class IsSo>
    std::vector<int> bodiesWhere(Object& object, const IsSo& isSo) const {
        std::vector<int> numbers;
        for (int i = 0; i < bodyCount(); ++i) {
            if (isSo(object, body(i))) {
                numbers.push_back(i);
            }
        }
        return numbers;
    }
    std::vector<int> listedBy(btGhostObject& object) const { return bodiesWhere(object, doesList); }
    std::vector<int> touching(const btCollisionObject& object) const {
        return bodiesWhere(object, touches);
    }

    btBoxShape large{btVector3(2, 2, 2)};
    btBoxShape small{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
    btGhostObject ghost;
    btPairCachingGhostObject cachingGhost;
};

}  // namespace hashphase::test
