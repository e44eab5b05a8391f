// SPDX-License-Identifier: Zlib
//
// Many proxies created, set and destroyed at once, against as many single calls.

#include <tests/integration/bullet/bullet_scenes.hpp>
#include <tests/integration/bullet/pair_journal.hpp>

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

constexpr int kObjects = 250;

enum class CacheKind { own, arrival, canonical, bullets };

struct Case {
    CacheKind cache;
    bool hasGhosts;
    int eagerGroups;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << "cache " << static_cast<int>(c.cache) << (c.hasGhosts ? ", ghosts" : "") << ", eager "
         << c.eagerGroups;
}

/// A broadphase whose proxies come, move and go in batches, or one by one.
class Crowd {
public:
    Crowd(const Case& c, bool inBatches) : inBatches_(inBatches) {
        SpatialHashConfig config;
        config.eagerGroups = c.eagerGroups;
        if (c.cache == CacheKind::own) {
            broadphase_ = std::make_unique<SpatialHashBroadphase>(config);
        } else if (c.cache == CacheKind::bullets) {
            bullets_ = std::make_unique<btHashedOverlappingPairCache>();
            broadphase_ = std::make_unique<SpatialHashBroadphase>(bullets_.get(), config);
        } else {
            ours_ = std::make_unique<PairCache>(
                c.cache == CacheKind::canonical ? PairOrder::canonical : PairOrder::arrival);
            broadphase_ = std::make_unique<SpatialHashBroadphase>(ours_.get(), config);
        }
        if (c.hasGhosts) {
            cache().setInternalGhostPairCallback(&journal);
        }
    }

    ~Crowd() { destroy(proxies_.size(), 1); }

    void create(const std::vector<Box>& boxes, BulletRandom random) {
        std::vector<ProxyDefinition> definitions;
        for (const Box& box : boxes) {
            clients_.push_back(std::make_unique<Client>());
            const int group = 1 << random.below(6);  // SensorTrigger and CharacterFilter among them
            definitions.push_back(
                {box.min, box.max, clients_.back().get(), group, btBroadphaseProxy::AllFilter});
        }
        const std::size_t before = proxies_.size();
        proxies_.resize(before + boxes.size());
        const std::span<btBroadphaseProxy*> created(&proxies_[before], boxes.size());
        if (inBatches_) {
            broadphase_->createProxies(definitions, created, nullptr);
            return;
        }
        std::transform(definitions.begin(), definitions.end(), created.begin(),
                       [this](const ProxyDefinition& each) {
                           return broadphase_->createProxy(
                               each.aabbMin, each.aabbMax, BOX_SHAPE_PROXYTYPE, each.userPtr,
                               each.collisionFilterGroup, each.collisionFilterMask, nullptr);
                       });
    }

    void move(const Scene& scene, BulletRandom random) {
        std::vector<btBroadphaseProxy*> moved;
        std::vector<btVector3> mins;
        std::vector<btVector3> maxs;
        for (btBroadphaseProxy* proxy : proxies_) {
            if (random.chance(0.6)) {
                const Box box = scene.step(random, {proxy->m_aabbMin, proxy->m_aabbMax});
                moved.push_back(proxy);
                mins.push_back(box.min);
                maxs.push_back(box.max);
            }
        }
        if (inBatches_) {
            broadphase_->setAabbs(moved, mins, maxs, nullptr);
            return;
        }
        for (std::size_t i = 0; i < moved.size(); ++i) {
            broadphase_->setAabb(moved[i], mins[i], maxs[i], nullptr);
        }
    }

    /// Of every `stride` proxies one, from the last down.
    void destroy(std::size_t most, std::size_t stride) {
        std::vector<btBroadphaseProxy*> gone;
        for (std::size_t i = proxies_.size(); i-- > 0 && gone.size() < most;) {
            if (i % stride == 0) {
                gone.push_back(proxies_[i]);
                proxies_.erase(proxies_.begin() + static_cast<std::ptrdiff_t>(i));
            }
        }
        if (inBatches_) {
            broadphase_->destroyProxies(gone, nullptr);
            return;
        }
        for (btBroadphaseProxy* proxy : gone) {
            broadphase_->destroyProxy(proxy, nullptr);
        }
    }

    void calculate() { broadphase_->calculateOverlappingPairs(nullptr); }

    [[nodiscard]] btOverlappingPairCache& cache() const {
        return *broadphase_->getOverlappingPairCache();
    }
    [[nodiscard]] std::string validate() const { return broadphase_->validate(); }
    [[nodiscard]] std::size_t size() const { return proxies_.size(); }

    /// Unique ids, in the order of the array.
    [[nodiscard]] std::vector<PairJournal::Uids> list() const {
        std::vector<PairJournal::Uids> list;
        const btBroadphasePairArray& array = cache().getOverlappingPairArray();
        for (int i = 0; i < array.size(); ++i) {
            list.emplace_back(array[i].m_pProxy0->m_uniqueId, array[i].m_pProxy1->m_uniqueId);
        }
        return list;
    }

    PairJournal journal;

private:
    bool inBatches_;
    std::unique_ptr<PairCache> ours_;
    std::unique_ptr<btHashedOverlappingPairCache> bullets_;
    std::unique_ptr<SpatialHashBroadphase> broadphase_;
    std::vector<std::unique_ptr<Client>> clients_;
    std::vector<btBroadphaseProxy*> proxies_;
};

class ProxyBatches : public testing::TestWithParam<Case> {};

TEST_P(ProxyBatches, DoWhatSingleCallsDo) {
    for (const char* name : {"uniform", "piles", "staticHeavy"}) {
        const Scene& scene = sceneNamed(name);
        Crowd batches(GetParam(), true);
        Crowd singles(GetParam(), false);
        // Without a callback to be told of each pair, batches leave arrivals in another order.
        const bool isSameOrder = GetParam().cache >= CacheKind::canonical || GetParam().hasGhosts;
        const auto expectSame = [&](int frame) {
            std::vector<PairJournal::Uids> a = batches.list();
            std::vector<PairJournal::Uids> b = singles.list();
            if (!isSameOrder) {
                std::sort(a.begin(), a.end());
                std::sort(b.begin(), b.end());
            }
            ASSERT_EQ(a, b) << name << ", frame " << frame;
            ASSERT_EQ(batches.journal.takeTouched(), singles.journal.takeTouched());
            ASSERT_EQ(batches.journal.errors(), std::vector<std::string>{});
        };
        std::size_t pairCount = 0;
        for (int frame = 0; frame < 44; ++frame) {
            BulletRandom random(1000 + static_cast<std::uint64_t>(frame));
            std::vector<Box> boxes;
            for (int i = 0; i < (frame % 8 == 0 ? kObjects / 2 : 3); ++i) {
                boxes.push_back(scene.place(random, i));
            }
            for (Crowd* crowd : {&batches, &singles}) {
                crowd->create(boxes, random);
                crowd->move(scene, random);
            }
            expectSame(frame);
            for (Crowd* crowd : {&batches, &singles}) {
                crowd->destroy(frame % 8 == 7 ? kObjects : 4, frame % 16 == 7 ? 1 : 3);
            }
            expectSame(frame);
            batches.calculate();
            singles.calculate();
            expectSame(frame);
            ASSERT_EQ(batches.validate(), "") << name << ", frame " << frame;
            pairCount += static_cast<std::size_t>(batches.cache().getNumOverlappingPairs());
        }
        EXPECT_GT(pairCount, 1000U);
        EXPECT_GT(batches.size(), 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Caches, ProxyBatches,
    testing::Values(Case{CacheKind::own, false, 0}, Case{CacheKind::own, true, 0},
                    Case{CacheKind::own, false, btBroadphaseProxy::AllFilter},
                    Case{CacheKind::arrival, false, btBroadphaseProxy::SensorTrigger},
                    Case{CacheKind::arrival, true, btBroadphaseProxy::SensorTrigger},
                    Case{CacheKind::canonical, false, btBroadphaseProxy::SensorTrigger},
                    Case{CacheKind::canonical, true, btBroadphaseProxy::AllFilter},
                    Case{CacheKind::bullets, false, btBroadphaseProxy::SensorTrigger},
                    Case{CacheKind::bullets, true, btBroadphaseProxy::SensorTrigger}));

TEST(ProxyBatch, MayBeEmpty) {
    SpatialHashBroadphase broadphase;
    broadphase.createProxies({}, {}, nullptr);
    broadphase.setAabbs({}, {}, {}, nullptr);
    broadphase.destroyProxies({}, nullptr);
    EXPECT_EQ(broadphase.grid().size(), 0U);
}

TEST(ProxyBatch, CreatesWhatTheDefinitionsSay) {
    SpatialHashBroadphase broadphase;
    int client = 0;
    const std::vector<ProxyDefinition> definitions{
        {}, {{1, 2, 3}, {4, 5, 6}, &client, btBroadphaseProxy::StaticFilter, 7}};
    std::vector<btBroadphaseProxy*> proxies(2);
    broadphase.createProxies(definitions, proxies, nullptr);
    EXPECT_EQ(proxies[0]->m_collisionFilterGroup, btBroadphaseProxy::DefaultFilter);
    EXPECT_EQ(proxies[0]->m_collisionFilterMask, btBroadphaseProxy::AllFilter);
    EXPECT_TRUE(proxies[0]->m_aabbMin == btVector3(0, 0, 0));
    EXPECT_EQ(proxies[1]->m_uniqueId, 2);
    EXPECT_EQ(proxies[1]->m_clientObject, &client);
    EXPECT_EQ(proxies[1]->m_collisionFilterGroup, btBroadphaseProxy::StaticFilter);
    EXPECT_EQ(proxies[1]->m_collisionFilterMask, 7);
    EXPECT_TRUE(proxies[1]->m_aabbMin == btVector3(1, 2, 3));
    EXPECT_TRUE(proxies[1]->m_aabbMax == btVector3(4, 5, 6));
}

#if HASHPHASE_ENABLE_ASSERTS
TEST(ProxyBatchDeathTest, AssertsThatSpansAreOfTheSameLength) {
    SpatialHashBroadphase broadphase;
    const std::vector<ProxyDefinition> definitions(3);
    std::vector<btBroadphaseProxy*> proxies(2);
    EXPECT_DEATH(broadphase.createProxies(definitions, proxies, nullptr), "one proxy a definition");
    proxies.resize(3);
    broadphase.createProxies(definitions, proxies, nullptr);
    const std::vector<btVector3> three(3, btVector3(0, 0, 0));
    const std::vector<btVector3> two(2, btVector3(0, 0, 0));
    EXPECT_DEATH(broadphase.setAabbs(proxies, two, three, nullptr), "one box a proxy");
    EXPECT_DEATH(broadphase.setAabbs(proxies, three, two, nullptr), "one box a proxy");
}

TEST(ProxyBatchDeathTest, AssertsThatProxiesAreItsOwnAndNamedOnce) {
    SpatialHashBroadphase broadphase;
    SpatialHashBroadphase other;
    std::vector<btBroadphaseProxy*> proxies(5);
    std::vector<btBroadphaseProxy*> foreign(1);
    broadphase.createProxies(std::vector<ProxyDefinition>(5), proxies, nullptr);
    other.createProxies(std::vector<ProxyDefinition>(1), foreign, nullptr);
    const std::vector<btVector3> boxes(1, btVector3(0, 0, 0));
    EXPECT_DEATH(broadphase.destroyProxies(foreign, nullptr), "this broadphase created");
    EXPECT_DEATH(broadphase.setAabbs(foreign, boxes, boxes, nullptr), "this broadphase created");
    proxies[4] = proxies[0];
    EXPECT_DEATH(broadphase.destroyProxies(proxies, nullptr), "did not destroy");
    proxies[4] = nullptr;
    EXPECT_DEATH(broadphase.destroyProxies(proxies, nullptr), "did not destroy");
}
#endif

}  // namespace
}  // namespace hashphase::test
