// SPDX-License-Identifier: Zlib
//
// Many proxies created, set and destroyed at once, against as many single calls.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <tuple>

namespace hashphase::test {
namespace {

/// Boxes that come, move and go in batches, or one by one.
struct Crowd : AnyBoxes {
    Crowd(const CacheKind& kind, bool hasGhosts, const SpatialHashConfig& config, bool inBatches)
        : AnyBoxes(kind.make(), config), isInBatches(inBatches) {
        journal.hasLivingClient = hasLivingClient;
        pairCache().setInternalGhostPairCallback(hasGhosts ? &journal : nullptr);
    }
    ~Crowd() { destroySome(proxies.size(), 1); }

    void createAll(const std::vector<Aabb<btScalar>>& boxes, BulletRandom random) {
        std::vector<ProxyDefinition> definitions;
        for (const Aabb<btScalar>& box : boxes) {
            const int group = 1 << random.below(6);  // SensorTrigger and CharacterFilter among them
            definitions.push_back({toBullet(box.min()), toBullet(box.max()), &client, group,
                                   btBroadphaseProxy::AllFilter});
        }
        if (isInBatches) {
            std::vector<btBroadphaseProxy*> created(boxes.size());
            hash().createProxies(definitions, created, nullptr);
            proxies.insert(proxies.end(), created.begin(), created.end());
            return;
        }
        for (const ProxyDefinition& each : definitions) {
            create({each.aabbMin, each.aabbMax}, each.collisionFilterGroup,
                   each.collisionFilterMask, each.userPtr);
        }
    }

    void moveSome(const BoxScene<btScalar>& scene, BulletRandom random) {
        std::vector<btBroadphaseProxy*> moved;
        std::vector<btVector3> mins;
        std::vector<btVector3> maxs;
        for (btBroadphaseProxy* proxy : proxies) {
            if (random.chance(0.6)) {
                const Box box =
                    boxOf(scene.nudge(random, toAabb(proxy->m_aabbMin, proxy->m_aabbMax)));
                moved.push_back(proxy);
                mins.push_back(box.min);
                maxs.push_back(box.max);
            }
        }
        if (isInBatches) {
            hash().setAabbs(moved, mins, maxs, nullptr);
            return;
        }
        for (std::size_t i = 0; i < moved.size(); ++i) {
            set(moved[i], {mins[i], maxs[i]});
        }
    }

    /// Of every `stride` proxies one, from the last down.
    void destroySome(std::size_t most, std::size_t stride) {
        std::vector<btBroadphaseProxy*> gone;
        for (std::size_t i = proxies.size(); i-- > 0 && gone.size() < most;) {
            if (i % stride == 0) {
                gone.push_back(proxies[i]);
            }
        }
        if (isInBatches) {
            hash().destroyProxies(gone, nullptr);
            std::erase_if(proxies,
                          [&](auto* proxy) { return std::ranges::count(gone, proxy) > 0; });
            return;
        }
        for (btBroadphaseProxy* const proxy : gone) {
            destroy(proxy);
        }
    }

    [[nodiscard]] std::vector<Uids> list(bool isSorted) const {
        std::vector<Uids> list = AnyBoxes::list();
        if (isSorted) {
            std::sort(list.begin(), list.end());
        }
        return list;
    }

    Client client;
    PairJournal journal;
    bool isInBatches;
};

/// The kind of cache, whether ghosts are told, and eager groups.
using Case = std::tuple<int, bool, int>;

class ProxyBatches : public testing::TestWithParam<Case> {};

TEST_P(ProxyBatches, DoWhatSingleCallsDo) {
    const auto [number, hasGhosts, eagerGroups] = GetParam();
    const CacheKind& kind = kCacheKinds[std::size_t(number)];
    SpatialHashConfig config;
    config.eagerGroups = eagerGroups;
    // Without a callback to be told of each pair, batches leave arrivals in another order.
    const bool isAnyOrder = number < 2 && !hasGhosts;
    for (const std::size_t sceneNumber : {0U, 9U, 12U}) {  // spread, piles, half-spaces
        const BoxScene<btScalar> scene = allBoxScenes<btScalar>()[sceneNumber];
        Crowd batches(kind, hasGhosts, config, true);
        Crowd singles(kind, hasGhosts, config, false);
        std::size_t pairCount = 0;
        for (int frame = 0; frame < 44; ++frame) {
            SCOPED_TRACE(testing::Message()
                         << kind.name << ", " << scene.name << ", frame " << frame);
            const auto onBoth = [&](const auto& act) {
                act(batches);
                act(singles);
                ASSERT_EQ(batches.list(isAnyOrder), singles.list(isAnyOrder));
                ASSERT_EQ(batches.journal.takeTouched(), singles.journal.takeTouched());
                ASSERT_EQ(batches.journal.errors, std::vector<std::string>{});
            };
            BulletRandom random(1000 + static_cast<std::uint64_t>(frame));
            const auto boxes = drawBoxes<btScalar>(random, frame % 8 == 0 ? 125 : 3, scene.draw);
            onBoth([&](Crowd& crowd) {
                crowd.createAll(boxes, random);
                crowd.moveSome(scene, random);
            });
            onBoth([&](Crowd& crowd) {
                crowd.destroySome(frame % 8 == 7 ? 250 : 4, frame % 16 == 7 ? 1 : 3);
            });
            onBoth([](Crowd& crowd) { crowd.step(); });
            ASSERT_EQ(batches.hash().validate(), "");
            ASSERT_FALSE(HasFailure());
            pairCount += static_cast<std::size_t>(batches.pairCount());
        }
        EXPECT_GT(pairCount, 1000U);
    }
}

constexpr int kSensor = btBroadphaseProxy::SensorTrigger;
constexpr int kEverybody = btBroadphaseProxy::AllFilter;

INSTANTIATE_TEST_SUITE_P(Caches, ProxyBatches,
                         testing::Values(Case{0, false, 0}, Case{0, true, 0},
                                         Case{0, false, kEverybody}, Case{1, false, kSensor},
                                         Case{1, true, kSensor}, Case{2, false, kSensor},
                                         Case{2, true, kEverybody}, Case{3, false, kSensor},
                                         Case{3, true, kSensor}));

TEST(ProxyBatch, CreatesWhatTheDefinitionsSay) {
    SpatialHashBroadphase broadphase;
    int client = 0;
    const std::vector<ProxyDefinition> definitions{
        {}, {{1, 2, 3}, {4, 5, 6}, &client, btBroadphaseProxy::StaticFilter, 7}};
    std::vector<btBroadphaseProxy*> proxies(2);
    broadphase.createProxies(definitions, proxies, nullptr);
    EXPECT_EQ(proxies[0]->m_collisionFilterGroup, btBroadphaseProxy::DefaultFilter);
    EXPECT_EQ(proxies[0]->m_collisionFilterMask, kEverybody);
    EXPECT_TRUE(isSame(boxOf(*proxies[0]), {{0, 0, 0}, {0, 0, 0}}));
    EXPECT_EQ(proxies[1]->m_uniqueId, 2);
    EXPECT_EQ(proxies[1]->m_clientObject, &client);
    EXPECT_EQ(proxies[1]->m_collisionFilterGroup, btBroadphaseProxy::StaticFilter);
    EXPECT_EQ(proxies[1]->m_collisionFilterMask, 7);
    EXPECT_TRUE(isSame(boxOf(*proxies[1]), {{1, 2, 3}, {4, 5, 6}}));
}

TEST(ProxyBatch, IsNoReservation) {
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* const stays =
        broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, 1, -1, nullptr);
    std::vector<btBroadphaseProxy*> proxies(20'000);
    broadphase.createProxies(std::vector<ProxyDefinition>(proxies.size()), proxies, nullptr);
    const std::size_t peak = broadphase.memoryBytes();
    broadphase.destroyProxies(proxies, nullptr);
    for (int frame = 0; frame < 600; ++frame) {
        const auto x = static_cast<btScalar>(frame);
        broadphase.setAabb(stays, {x, 0, 0}, {x + 1, 1, 1}, nullptr);
        broadphase.calculateOverlappingPairs(nullptr);
    }
    EXPECT_LT(broadphase.memoryBytes(), peak / 4);
    broadphase.destroyProxy(stays, nullptr);
}

}  // namespace
}  // namespace hashphase::test
