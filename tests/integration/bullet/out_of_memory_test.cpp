// SPDX-License-Identifier: Zlib

// Memory runs out at every allocation of ours; Bullet's own arrays have memory of their own.

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <tests/integration/bullet/broadphases.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/random.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

using RawPair = std::pair<btBroadphaseProxy*, btBroadphaseProxy*>;

/// A broadphase over a cache of any kind, and its proxies.
struct Proxies {
    explicit Proxies(int count, PairOrder order = PairOrder::arrival, int group = 1,
                     bool hasGhosts = false)
        : cache(order), broadphase(&cache, eagerCharactersAndSensors()) {
        cache.setInternalGhostPairCallback(hasGhosts ? &ghosts : nullptr);
        createSome(count, group);
    }
    ~Proxies() {
        for (btBroadphaseProxy* proxy : proxies) {
            broadphase.destroyProxy(proxy, nullptr);
        }
    }
    Proxies(const Proxies&) = delete;
    Proxies& operator=(const Proxies&) = delete;

    ProxyDefinition define(int group) {
        const Vector3<double> at = random.pointIn(-5, 5);
        ProxyDefinition definition;
        definition.aabbMin = {btScalar(at.x()), btScalar(at.y()), btScalar(at.z())};
        definition.aabbMax = definition.aabbMin + btVector3(2, 2, 2);
        definition.collisionFilterGroup = group;
        definition.userPtr = this;
        return definition;
    }
    void create(int group) {
        const ProxyDefinition d = define(group);
        btBroadphaseProxy* proxy = broadphase.createProxy(d.aabbMin, d.aabbMax, 0, this, group,
                                                          d.collisionFilterMask, nullptr);
        const WorkingAllocations working;
        proxies.push_back(proxy);
    }
    void createSome(int count, int group) {
        for (int i = 0; i < count; ++i) {
            create(group);
        }
    }
    void moveSome(std::size_t step) {
        for (std::size_t i = 0; i < proxies.size(); i += step) {
            const ProxyDefinition d = define(1);
            broadphase.setAabb(proxies[i], d.aabbMin, d.aabbMax, nullptr);
        }
    }
    void step() { broadphase.calculateOverlappingPairs(nullptr); }

    /// After a step the cache has the pairs that brute force finds.
    void check() {
        for (int frame = 0; frame < 2; ++frame) {
            step();
            EXPECT_EQ(broadphase.validate(), "");
            EXPECT_EQ(cache.validate(), "");
            EXPECT_EQ(broadphase.grid().size(), proxies.size());
            std::set<RawPair> expected;
            for (btBroadphaseProxy* a : proxies) {
                for (btBroadphaseProxy* b : proxies) {
                    if (a->m_uniqueId < b->m_uniqueId &&
                        overlaps(toAabb(a->m_aabbMin, a->m_aabbMax),
                                 toAabb(b->m_aabbMin, b->m_aabbMax))) {
                        expected.emplace(a, b);
                    }
                }
            }
            std::set<RawPair> present;
            for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
                const btBroadphasePair& pair = cache.getOverlappingPairArray()[i];
                present.emplace(pair.m_pProxy0, pair.m_pProxy1);
            }
            EXPECT_EQ(present, expected);
            moveSome(7);
        }
    }

    Random random{11};
    btGhostPairCallback ghosts;
    PairCache cache;
    SpatialHashBroadphase broadphase;
    std::vector<btBroadphaseProxy*> proxies;
};

class BulletOutOfMemory : public testing::TestWithParam<PairOrder> {
protected:
    void SetUp() override {
        if (!kCountsAllocations) {
            GTEST_SKIP() << "this program has another `new`";
        }
    }
    static auto some(int count, int group = 1) {
        return [=] { return std::make_unique<Proxies>(count, GetParam(), group); };
    }
    /// With all pairs in the cache.
    static auto settled(int count, bool hasGhosts = false) {
        return [=] {
            auto proxies = std::make_unique<Proxies>(count, GetParam(), 1, hasGhosts);
            proxies->step();
            return proxies;
        };
    }
    static void check(Proxies& proxies, std::size_t) { proxies.check(); }
};

TEST_P(BulletOutOfMemory, CalculatingPairsIsRepeated) {
    EXPECT_GE(runOutOfMemory(
                  some(100), [](Proxies& p) { p.step(); }, check),
              40U);
    const auto atRest = [] {
        auto proxies = std::make_unique<Proxies>(60, GetParam());
        for (int i = 0; i < 11; ++i) {
            proxies->step();
        }
        proxies->createSome(60, 1);
        proxies->moveSome(2);
        return proxies;
    };
    EXPECT_GE(runOutOfMemory(
                  atRest, [](Proxies& p) { p.step(); }, check),
              10U);
}

TEST_P(BulletOutOfMemory, AProxyIsCreatedOrNot) {
    for (const int group : {1, int(btBroadphaseProxy::CharacterFilter)}) {
        const auto create = [=](Proxies& p) { p.createSome(70, group); };
        EXPECT_GE(runOutOfMemory(some(0), create, check), 8U);
    }
}

// Told of one pair after the other, the cache has some of a new proxy's when memory runs out.
TEST_P(BulletOutOfMemory, AnEagerProxyIsCreatedOrNotWhereGhostsAreTold) {
    const auto create = [](Proxies& p) {
        btBroadphaseProxy* sensor = p.broadphase.createProxy(
            {-9, -9, -9}, {9, 9, 9}, 0, &p, btBroadphaseProxy::SensorTrigger, -1, nullptr);
        const WorkingAllocations working;
        p.proxies.push_back(sensor);
    };
    const auto checkAtOnce = [](Proxies& p, std::size_t) {
        EXPECT_EQ(p.broadphase.grid().size(), p.proxies.size());
        for (int i = 0; i < p.cache.getNumOverlappingPairs(); ++i) {
            const btBroadphasePair& pair = p.cache.getOverlappingPairArray()[i];
            EXPECT_NE(pair.m_pProxy0->m_clientObject, nullptr);
            EXPECT_NE(pair.m_pProxy1->m_clientObject, nullptr);
        }
        p.check();
    };
    EXPECT_GE(runOutOfMemory(settled(60, true), create, checkAtOnce), 6U);
}

TEST_P(BulletOutOfMemory, OfABatchThoseAreCreatedThatAreWritten) {
    const auto create = [](Proxies& p) {
        std::vector<ProxyDefinition> definitions;
        std::vector<btBroadphaseProxy*> created(40, nullptr);
        for (int i = 0; i < 40; ++i) {
            const WorkingAllocations working;
            definitions.push_back(
                p.define(i % 4 == 0 ? int(btBroadphaseProxy::CharacterFilter) : 1));
        }
        const auto keep = [&] {
            const WorkingAllocations working;
            for (btBroadphaseProxy* proxy : created) {
                if (proxy != nullptr) {
                    p.proxies.push_back(proxy);
                }
            }
        };
        try {
            p.broadphase.createProxies(definitions, created, nullptr);
        } catch (const std::bad_alloc&) {
            keep();
            throw;
        }
        keep();
    };
    EXPECT_GE(runOutOfMemory(some(30), create, check), 8U);
}

TEST_P(BulletOutOfMemory, MovingWhatIsEagerIsRepeatedByTheStep) {
    const auto move = [](Proxies& p) { p.moveSome(1); };
    EXPECT_GE(runOutOfMemory(some(60, btBroadphaseProxy::CharacterFilter), move, check), 1U);
}

TEST_P(BulletOutOfMemory, DestroyingNeedsNone) {
    const auto destroy = [](Proxies& p) {
        for (int i = 0; i < 50; ++i) {
            p.broadphase.destroyProxy(p.proxies.back(), nullptr);
            p.proxies.pop_back();
        }
    };
    EXPECT_EQ(runOutOfMemory(settled(100), destroy, check), 0U);
}

TEST_P(BulletOutOfMemory, DestroyingABatchHasHappenedOrNot) {
    const auto destroy = [](Proxies& p) {
        p.broadphase.destroyProxies(std::span(p.proxies).first(50), nullptr);
        p.proxies.erase(p.proxies.begin(), p.proxies.begin() + 50);
    };
    EXPECT_GE(runOutOfMemory(settled(100), destroy, check), 3U);
}

INSTANTIATE_TEST_SUITE_P(Orders, BulletOutOfMemory,
                         testing::Values(PairOrder::arrival, PairOrder::canonical),
                         [](const auto& parameter) {
                             return parameter.param == PairOrder::arrival ? "Arrival" : "Canonical";
                         });

}  // namespace
}  // namespace hashphase::test
