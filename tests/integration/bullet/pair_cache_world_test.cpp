// SPDX-License-Identifier: Zlib
//
// The pair cache where it works: under btDbvtBroadphase, in a world, with a ghost among the bodies.

#include <integration/bullet/pair_cache.hpp>
#include <tests/integration/bullet/broadphases.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <btBulletDynamicsCommon.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace hashphase {
namespace {

int userIndex(const btBroadphaseProxy& proxy) {
    return static_cast<const btCollisionObject*>(proxy.m_clientObject)->getUserIndex();
}

/// Hands on to Bullet's ghost callback, and books every pair.
struct Bookkeeper : btGhostPairCallback {
    using Pair = std::pair<int, int>;
    static Pair pairOf(const btBroadphaseProxy* a, const btBroadphaseProxy* b) {
        return std::minmax({userIndex(*a), userIndex(*b)});
    }
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
        EXPECT_EQ(++balance[pairOf(a, b)], 1);
        return btGhostPairCallback::addOverlappingPair(a, b);
    }
    void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                btDispatcher* dispatcher) override {
        EXPECT_EQ(--balance[pairOf(a, b)], 0);
        ++removals;
        return btGhostPairCallback::removeOverlappingPair(a, b, dispatcher);
    }
    std::map<Pair, int> balance;
    int removals = 0;
};

/// Boxes that fall on the ground and through a ghost; some are taken away, others added.
class FallingBoxes {
public:
    FallingBoxes(std::unique_ptr<btBroadphaseInterface> broadphase, btOverlappingPairCache& cache)
        : broadphase_(std::move(broadphase)),
          cache_(cache),
          world_(&dispatcher_, broadphase_.get(), &solver_, &configuration_) {
        cache.setInternalGhostPairCallback(&bookkeeper);
        add(ground_, 0, btVector3(0, -10, 0));
        ghost_.setCollisionShape(&ground_);
        ghost_.setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
        ghost_.setUserIndex(nextIndex_++);
        world_.addCollisionObject(&ghost_, btBroadphaseProxy::SensorTrigger);
        for (int i = 0; i < 200; ++i) {
            add(box_, 1, btVector3(btScalar(i % 5), btScalar(1 + i / 25), btScalar(i / 5 % 5)));
        }
    }

    ~FallingBoxes() {
        world_.removeCollisionObject(&ghost_);
        while (!bodies_.empty()) {
            remove(bodies_.size() - 1);
        }
    }

    void step(int frame) {
        if (frame % 20 == 19) {
            for (std::size_t i = 0; i < 5; ++i) {
                remove(1 + (static_cast<std::size_t>(frame) * 7 + 13 * i) % 190);
            }
            for (int i = 0; i < 5; ++i) {
                add(box_, 1, btVector3(btScalar(i), 9, btScalar(frame % 5)));
            }
        }
        world_.stepSimulation(btScalar(1) / 60, 0);
    }

    [[nodiscard]] std::vector<btTransform> state() const {
        std::vector<btTransform> transforms;
        for (const auto& body : bodies_) {
            transforms.push_back(body->getWorldTransform());
        }
        return transforms;
    }

    [[nodiscard]] std::vector<Bookkeeper::Pair> pairs() {
        std::vector<Bookkeeper::Pair> pairs;
        for (int i = 0; i < cache_.getNumOverlappingPairs(); ++i) {
            const btBroadphasePair& pair = cache_.getOverlappingPairArrayPtr()[i];
            pairs.push_back(Bookkeeper::pairOf(pair.m_pProxy0, pair.m_pProxy1));
        }
        return pairs;
    }

    [[nodiscard]] int ghostOverlapCount() const { return ghost_.getNumOverlappingObjects(); }

    Bookkeeper bookkeeper;

private:
    void add(btCollisionShape& shape, btScalar mass, const btVector3& position) {
        btVector3 inertia(0, 0, 0);
        shape.calculateLocalInertia(mass, inertia);
        bodies_.push_back(std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia));
        bodies_.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), position));
        bodies_.back()->setUserIndex(nextIndex_++);
        world_.addRigidBody(bodies_.back().get());
    }

    void remove(std::size_t i) {
        world_.removeRigidBody(bodies_[i].get());
        bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(i));
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btSequentialImpulseConstraintSolver solver_;
    btBoxShape ground_{btVector3(20, 10, 20)};
    btBoxShape box_{btVector3(btScalar(0.4), btScalar(0.4), btScalar(0.4))};
    std::unique_ptr<btBroadphaseInterface> broadphase_;
    btOverlappingPairCache& cache_;
    btGhostObject ghost_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    int nextIndex_ = 0;
    btDiscreteDynamicsWorld world_;
};

std::vector<btScalar> numbersOf(const std::vector<btTransform>& transforms) {
    std::vector<btScalar> numbers;
    for (const btTransform& transform : transforms) {
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                numbers.push_back(transform.getBasis()[row][column]);
            }
            numbers.push_back(transform.getOrigin()[row]);
        }
    }
    return numbers;
}

TEST(PairCacheInAWorld, ChangesNothingInAWorldOfFallingBoxes) {
    btHashedOverlappingPairCache bulletsCache;
    PairCache cache;
    FallingBoxes expected(std::make_unique<btDbvtBroadphase>(&bulletsCache), bulletsCache);
    FallingBoxes boxes(std::make_unique<btDbvtBroadphase>(&cache), cache);
    for (int frame = 0; frame < 200; ++frame) {
        expected.step(frame);
        boxes.step(frame);
        ASSERT_EQ(boxes.pairs(), expected.pairs()) << frame;
        ASSERT_EQ(boxes.ghostOverlapCount(), expected.ghostOverlapCount()) << frame;
        ASSERT_EQ(numbersOf(boxes.state()), numbersOf(expected.state())) << frame;
        ASSERT_EQ(cache.validate(), "") << frame;
    }
    EXPECT_GT(boxes.pairs().size(), 300U);
    EXPECT_GT(boxes.ghostOverlapCount(), 10);
    EXPECT_GT(boxes.bookkeeper.removals, 500);
}

TEST(PairCacheInAWorld, TellsTheGhostCallbackOfEveryPairThatIsThere) {
    PairCache cache(PairOrder::canonical, &userIndex);
    {
        FallingBoxes boxes(std::make_unique<btDbvtBroadphase>(&cache), cache);
        for (int frame = 0; frame < 100; ++frame) {
            boxes.step(frame);
            std::vector<Bookkeeper::Pair> told;
            for (const auto& [pair, balance] : boxes.bookkeeper.balance) {
                if (balance == 1) {
                    told.push_back(pair);
                }
            }
            ASSERT_EQ(boxes.pairs(), told) << "the map is sorted, as the array is, " << frame;
        }
        cache.setInternalGhostPairCallback(nullptr);
    }
    EXPECT_EQ(cache.getNumOverlappingPairs(), 0);
}

TEST(PairCacheInAWorld, GivesTheSameTrajectoriesUnderAllExactBroadphasesInCanonicalOrder) {
    PairCache cacheOfSimple(PairOrder::canonical, &userIndex);
    PairCache cacheOfDbvt(PairOrder::canonical, &userIndex);
    FallingBoxes simple(std::make_unique<btSimpleBroadphase>(16384, &cacheOfSimple), cacheOfSimple);
    FallingBoxes dbvt(std::make_unique<test::ExactDbvt>(&cacheOfDbvt), cacheOfDbvt);
    for (int frame = 0; frame < 300; ++frame) {
        simple.step(frame);
        dbvt.step(frame);
        ASSERT_EQ(simple.pairs(), dbvt.pairs()) << frame;
        ASSERT_EQ(numbersOf(simple.state()), numbersOf(dbvt.state())) << frame;
    }
}

TEST(PairCacheInAWorld, AllocatesNothingForPairsItHasHadRoomForBefore) {
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        PairCache cache(order);
        std::vector<std::size_t> bytes;
        for (int life = 0; life < 3; ++life) {
            {
                FallingBoxes boxes(std::make_unique<btDbvtBroadphase>(&cache), cache);
                for (int frame = 0; frame < 60; ++frame) {
                    boxes.step(frame);
                }
            }
            bytes.push_back(cache.memoryBytes());
        }
        EXPECT_EQ(bytes[1], bytes[0]);
        EXPECT_EQ(bytes[2], bytes[0]);
    }
}

TEST(PairCacheInAWorld, ForgetsAProxyInCanonicalOrder) {
    struct Listener : btOverlappingPairCallback {
        btBroadphasePair* addOverlappingPair(btBroadphaseProxy*, btBroadphaseProxy*) override {
            return nullptr;
        }
        void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                    btDispatcher*) override {
            removed.emplace_back(a->m_uniqueId, b->m_uniqueId);
            return nullptr;
        }
        void removeOverlappingPairsContainingProxy(btBroadphaseProxy*, btDispatcher*) override {}
        std::vector<std::pair<int, int>> removed;
    } listener;
    std::vector<btBroadphaseProxy> proxies(10);
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        proxies[i].m_uniqueId = static_cast<int>(i);
    }
    PairCache cache(PairOrder::canonical);
    cache.setInternalGhostPairCallback(&listener);
    for (const std::size_t i : {7, 2, 9, 1, 8, 4}) {
        cache.addAcceptedPair(&proxies[5], &proxies[i]);
    }
    cache.removeOverlappingPairsContainingProxy(&proxies[5], nullptr);
    EXPECT_EQ(listener.removed,
              (std::vector<std::pair<int, int>>{{1, 5}, {2, 5}, {4, 5}, {5, 7}, {5, 8}, {5, 9}}));
}

}  // namespace
}  // namespace hashphase
