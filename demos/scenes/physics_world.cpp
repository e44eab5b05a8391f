// SPDX-License-Identifier: Zlib
#include <demos/scenes/physics_world.hpp>

#include <demos/scenes/ordered_dispatcher.hpp>
#include <demos/scenes/result_hash.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace hashphase::demos {
namespace {

constexpr int kMostBodies = 16'384;
constexpr btScalar kWorldHalfSide = 1000;  // of bt32BitAxisSweep3, which needs to know [m]

/// btDbvtBroadphase, driven so that its pairs are exact: no fat boxes, and every pair is looked at
/// whenever a box has changed.
class ExactDbvt : public btDbvtBroadphase {
public:
    explicit ExactDbvt(btOverlappingPairCache* cache) : btDbvtBroadphase(cache) {
        m_cupdates = 100;
    }
    void setAabb(btBroadphaseProxy* proxy, const btVector3& low, const btVector3& high,
                 btDispatcher* dispatcher) override {
        setAabbForceUpdate(proxy, low, high, dispatcher);
    }
};

std::unique_ptr<btBroadphaseInterface> makeAxisSweep(PairCache* cache) {
    const btVector3 corner(kWorldHalfSide, kWorldHalfSide, kWorldHalfSide);
    return std::make_unique<bt32BitAxisSweep3>(-corner, corner, kMostBodies, cache, true);
}

bool isCanonical(ListOrder order) {
    return order == ListOrder::canonical || order == ListOrder::canonicalByUniqueId;
}

std::unique_ptr<btCollisionDispatcher> makeDispatcher(ListOrder order,
                                                      btCollisionConfiguration& configuration) {
    return isCanonical(order) ? std::make_unique<OrderedDispatcher>(&configuration)
                              : std::make_unique<btCollisionDispatcher>(&configuration);
}

std::unique_ptr<PairCache> makeCache(ListOrder order) {
    const ProxyKey numberOf = [](const btBroadphaseProxy& proxy) {
        return static_cast<const btCollisionObject*>(proxy.m_clientObject)->getUserIndex();
    };
    return isCanonical(order) ? std::make_unique<PairCache>(PairOrder::canonical, numberOf)
                              : nullptr;
}

void add(btScalar number, ResultHash& hash) {
    std::array<unsigned char, sizeof(number)> bytes{};
    std::memcpy(bytes.data(), &number, sizeof(number));
    for (const unsigned char byte : bytes) {
        hash.add(std::uint64_t{byte});
    }
}

void add(const btVector3& vector, ResultHash& hash) {
    for (int axis = 0; axis < 3; ++axis) {
        add(vector[axis], hash);
    }
}

}  // namespace

std::string_view titleOf(ListOrder order) {
    switch (order) {
        case ListOrder::asShipped:
            return "as shipped";
        case ListOrder::byUniqueId:
            return "m_deterministicOverlappingPairs";
        case ListOrder::canonical:
            return "canonical";
        case ListOrder::canonicalByUniqueId:
            return "canonical, by unique id";
    }
    return {};
}

std::vector<PhysicsBroadphase> physicsBroadphases() {
    return {
        {std::string(kHashName), true, true,
         [](PairCache* cache) { return std::make_unique<SpatialHashBroadphase>(cache); }},
        {std::string(kSimpleName), false, true,
         [](PairCache* cache) { return std::make_unique<btSimpleBroadphase>(kMostBodies, cache); }},
        {std::string(kDbvtName), false, false,
         [](PairCache* cache) { return std::make_unique<btDbvtBroadphase>(cache); }},
        {std::string(kExactDbvtName), false, true,
         [](PairCache* cache) { return std::make_unique<ExactDbvt>(cache); }},
        {"bt32BitAxisSweep3", false, false, makeAxisSweep},
    };
}

PhysicsBroadphase physicsBroadphase(std::string_view name) {
    const std::vector<PhysicsBroadphase> all = physicsBroadphases();
    return *std::find_if(all.begin(), all.end(),
                         [name](const PhysicsBroadphase& each) { return each.name == name; });
}

PhysicsWorld::PhysicsWorld(const PhysicsBroadphase& broadphase, ListOrder order)
    : dispatcher_(makeDispatcher(order, configuration_)),
      cache_(makeCache(order)),
      broadphase_(broadphase.make(cache_.get())),
      world_(dispatcher_.get(), broadphase_.get(), &solver_, &configuration_),
      contents_(world_) {
    world_.getDispatchInfo().m_deterministicOverlappingPairs =
        order == ListOrder::byUniqueId || order == ListOrder::canonicalByUniqueId;
}

void PhysicsWorld::step(btScalar seconds, int steps) {
    for (int i = 0; i < steps; ++i) {
        // No sub-steps: one step of the given length.
        world_.stepSimulation(seconds, 0);
    }
}

int PhysicsWorld::sleepingCount() const {
    int count = 0;
    for (const auto& body : contents_.bodies()) {
        count += !body->isStaticObject() && !body->isActive() ? 1 : 0;
    }
    return count;
}

std::uint64_t stateHash(const WorldContents& contents) {
    ResultHash hash;
    for (const auto& body : contents.bodies()) {
        const btTransform& place = body->getWorldTransform();
        for (int row = 0; row < 3; ++row) {
            add(place.getBasis()[row], hash);
        }
        add(place.getOrigin(), hash);
        add(body->getLinearVelocity(), hash);
        add(body->getAngularVelocity(), hash);
        add(static_cast<btScalar>(body->getActivationState()), hash);
    }
    return hash.value();
}

}  // namespace hashphase::demos
