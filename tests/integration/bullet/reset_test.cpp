// SPDX-License-Identifier: Zlib
//
// A world whose objects have all been removed, and whose broadphase and solver have been reset, moves
// as a new one does, to the last bit.

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <btBulletDynamicsCommon.h>

#include <functional>
#include <memory>
#include <ostream>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

using Numbers = std::vector<btScalar>;

/// A broadphase, and the cache that it was given, if any.
struct BroadphaseAndCache {
    std::unique_ptr<btOverlappingPairCache> cache;
    std::unique_ptr<btBroadphaseInterface> broadphase;
};

struct AnyBroadphase {
    const char* name;
    BroadphaseAndCache (*make)();
};

void PrintTo(const AnyBroadphase& kind, std::ostream* out) {
    *out << kind.name;
}

template <class Cache, class... Arguments>
BroadphaseAndCache hashOver(const SpatialHashConfig& config, Arguments... arguments) {
    auto cache = std::make_unique<Cache>(arguments...);
    auto broadphase = std::make_unique<SpatialHashBroadphase>(cache.get(), config);
    return {std::move(cache), std::move(broadphase)};
}

SpatialHashConfig sweeping() {
    SpatialHashConfig config;
    config.sweep = Sweep::automatic;
    return config;
}

const AnyBroadphase kAnyBroadphases[] = {
    {"btDbvtBroadphase",
     [] {
         return BroadphaseAndCache{nullptr, std::make_unique<btDbvtBroadphase>()};
     }},
    {"default",
     [] {
         return BroadphaseAndCache{nullptr, std::make_unique<SpatialHashBroadphase>()};
     }},
    {"canonical", [] { return hashOver<PairCache>({}, PairOrder::canonical); }},
    {"sweeping",
     [] {
         return BroadphaseAndCache{nullptr, std::make_unique<SpatialHashBroadphase>(sweeping())};
     }},
    {"btHashedOverlappingPairCache", [] { return hashOver<btHashedOverlappingPairCache>({}); }},
};

class WorldOverAny {
public:
    explicit WorldOverAny(const AnyBroadphase& kind) : made_(kind.make()) {
        world_.getPairCache()->setInternalGhostPairCallback(&ghostCallback_);
    }
    WorldOverAny(const WorldOverAny&) = delete;
    WorldOverAny& operator=(const WorldOverAny&) = delete;
    ~WorldOverAny() { unload(); }

    /// The same stack each time, with a ghost in it, a fast body, and some that are taken out again.
    Numbers play() {
        add(0, ground_, {0, -1, 0});
        for (int i = 0; i < 80; ++i) {
            add(1, box_,
                {btScalar(i % 5) * btScalar(1.02), btScalar(0.5) + btScalar(i / 20) * btScalar(1.2),
                 btScalar(i / 5 % 4) * btScalar(1.02) + btScalar(0.1) * btScalar(i / 20)});
        }
        addGhost({2, 1, 2});
        btRigidBody& fast = add(1, ball_, {-30, 1, 2});
        fast.setLinearVelocity({90, 0, 0});
        Numbers numbers;
        for (int step = 0; step < 100; ++step) {
            world_.stepSimulation(btScalar(1) / 60, 0);
            if (step % 20 == 10) {
                world_.removeRigidBody(bodies_[static_cast<std::size_t>(step / 2 + 5)].get());
                add(1, ball_, {btScalar(2), 9, btScalar(step % 3)});
            }
            numbers.push_back(btScalar(ghosts_.back()->getNumOverlappingObjects()));
        }
        for (const auto& body : bodies_) {
            const btVector3& place = body->getWorldTransform().getOrigin();
            numbers.insert(numbers.end(), {place[0], place[1], place[2]});
        }
        return numbers;
    }

    /// Something else, of other sizes, that ends in the middle: some of it removed in no order.
    void playSomethingElse(std::uint64_t seed) {
        Random random(seed);
        add(0, ground_, {0, -1, 0});
        for (int i = 0; i < 150; ++i) {
            const Vector3<double> at = random.pointIn(0, 8);
            add(1, i % 9 == 0 ? static_cast<btCollisionShape&>(large_) : ball_,
                {btScalar(at[0]), btScalar(at[1]), btScalar(at[2])});
        }
        addGhost({4, 1, 4});
        for (int step = 0; step < 30; ++step) {
            world_.stepSimulation(btScalar(1) / 60, 0);
            const auto gone = random.below(static_cast<std::uint32_t>(bodies_.size()));
            world_.removeRigidBody(bodies_[gone].get());
            add(1, ball_, {btScalar(step), 3, 0});
        }
        for (std::size_t i = bodies_.size(); i > 1; --i) {
            std::swap(bodies_[i - 1], bodies_[random.below(static_cast<std::uint32_t>(i))]);
        }
    }

    void unload() {
        for (const auto& ghost : ghosts_) {
            world_.removeCollisionObject(ghost.get());
        }
        for (const auto& body : bodies_) {
            world_.removeRigidBody(body.get());
        }
        ghosts_.clear();
        bodies_.clear();
    }
    void reset(bool afterAStep) {
        unload();
        if (afterAStep) {
            world_.stepSimulation(btScalar(1) / 60, 0);  // a frame of the menu
        }
        solver_.reset();
        made_.broadphase->resetPool(&dispatcher_);
    }

    [[nodiscard]] btBroadphaseInterface& broadphase() { return *made_.broadphase; }

private:
    btRigidBody& add(btScalar mass, btCollisionShape& shape, const btVector3& at) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) {
            shape.calculateLocalInertia(mass, inertia);
        }
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
        info.m_startWorldTransform.setOrigin(at);
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        world_.addRigidBody(bodies_.back().get());
        return *bodies_.back();
    }
    void addGhost(const btVector3& at) {
        ghosts_.push_back(std::make_unique<btPairCachingGhostObject>());
        ghosts_.back()->setCollisionShape(&large_);
        ghosts_.back()->setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
        ghosts_.back()->setWorldTransform(btTransform(btQuaternion(0, 0, 0, 1), at));
        world_.addCollisionObject(ghosts_.back().get(), btBroadphaseProxy::SensorTrigger,
                                  btBroadphaseProxy::AllFilter);
    }

    btGhostPairCallback ghostCallback_;
    btBoxShape ground_{btVector3(50, 1, 50)};
    btBoxShape box_{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
    btBoxShape large_{btVector3(2, 2, 2)};
    btSphereShape ball_{btScalar(0.3)};
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    BroadphaseAndCache made_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, made_.broadphase.get(), &solver_, &configuration_};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btPairCachingGhostObject>> ghosts_;
};

class ResetWorld : public testing::TestWithParam<AnyBroadphase> {};

TEST_P(ResetWorld, MovesAsANewOneToTheLastBit) {
    const Numbers expected = WorldOverAny(GetParam()).play();
    for (const bool afterAStep : {false, true}) {
        SCOPED_TRACE(afterAStep);
        WorldOverAny world(GetParam());
        ASSERT_EQ(world.play(), expected) << "in two new worlds";
        world.reset(afterAStep);
        ASSERT_EQ(world.play(), expected) << "for the second time";
        world.reset(afterAStep);
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            world.playSomethingElse(seed);
            world.reset(afterAStep);
        }
        ASSERT_EQ(world.play(), expected) << "after other levels";
    }
}

INSTANTIATE_TEST_SUITE_P(Broadphases, ResetWorld, testing::ValuesIn(kAnyBroadphases));

btBroadphaseProxy* createUnitBox(btBroadphaseInterface& broadphase) {
    return broadphase.createProxy({0, 0, 0}, {1, 1, 1}, BOX_SHAPE_PROXYTYPE, nullptr,
                                  btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter,
                                  nullptr);
}

TEST(ResetPool, LeavesNoIdOfBeforeValid) {
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* const proxy = createUnitBox(broadphase);
    const ProxyId before = SpatialHashBroadphase::idOf(proxy);
    broadphase.destroyProxy(proxy, nullptr);
    broadphase.resetPool(nullptr);
    const ProxyId after = SpatialHashBroadphase::idOf(createUnitBox(broadphase));
    EXPECT_EQ(after.index, before.index);
    EXPECT_FALSE(broadphase.grid().contains(before));
    EXPECT_TRUE(broadphase.grid().contains(after));
}

TEST(ResetPool, GivesBackMemory) {
    SpatialHashBroadphase broadphase;
    std::vector<btBroadphaseProxy*> proxies;
    for (int i = 0; i < 5000; ++i) {
        const btVector3 at(btScalar(i % 70), btScalar(i / 70), 0);
        proxies.push_back(broadphase.createProxy(at, at + btVector3(1, 1, 1), BOX_SHAPE_PROXYTYPE,
                                                 nullptr, btBroadphaseProxy::DefaultFilter,
                                                 btBroadphaseProxy::AllFilter, nullptr));
    }
    broadphase.calculateOverlappingPairs(nullptr);
    broadphase.destroyProxies(proxies, nullptr);
    const std::size_t before = broadphase.grid().memoryBytes();
    broadphase.resetPool(nullptr);
    EXPECT_LT(broadphase.grid().memoryBytes(), before / 2 + before / 4);
}

#if HASHPHASE_ENABLE_ASSERTS

TEST(ResetPoolMisuse, ByACallbackIsAsserted) {
    struct Callback : btBroadphaseAabbCallback {
        explicit Callback(std::function<void()> of) : call(std::move(of)) {}
        bool process(const btBroadphaseProxy* /*proxy*/) override {
            call();
            return true;
        }
        std::function<void()> call;
    };
    const ThrowingAsserts throwing;
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* const proxy = createUnitBox(broadphase);
    Callback callback([&] {
        broadphase.resetPool(nullptr);  // a proxy is alive: does nothing
        broadphase.destroyProxy(proxy, nullptr);
        EXPECT_THROW(broadphase.resetPool(nullptr), BrokenAssert);
    });
    broadphase.aabbTest({0, 0, 0}, {1, 1, 1}, callback);
    EXPECT_EQ(broadphase.grid().size(), 0U);
    broadphase.resetPool(nullptr);
    EXPECT_EQ(createUnitBox(broadphase)->getUid(), 1);
}

#endif

}  // namespace
}  // namespace hashphase::test
