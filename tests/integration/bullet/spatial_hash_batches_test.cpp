// SPDX-License-Identifier: Zlib
//
// Many proxies created, set and destroyed at once, against as many single calls.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/broadphases.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <tuple>

namespace hashphase::test {
namespace {

/// A broadphase whose proxies come, move and go in batches, or one by one.
class Crowd {
public:
    Crowd(const CacheKind& kind, bool hasGhosts, const SpatialHashConfig& config, bool inBatches)
        : inBatches_(inBatches), given_(kind.make()), broadphase_(hashOver(given_.get(), config)) {
        if (hasGhosts) {
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
        std::vector<btBroadphaseProxy*> created;
        if (inBatches_) {
            created.resize(boxes.size());
            broadphase_->createProxies(definitions, created, nullptr);
        } else {
            for (const ProxyDefinition& each : definitions) {
                created.push_back(broadphase_->createProxy(
                    each.aabbMin, each.aabbMax, BOX_SHAPE_PROXYTYPE, each.userPtr,
                    each.collisionFilterGroup, each.collisionFilterMask, nullptr));
            }
        }
        proxies_.insert(proxies_.end(), created.begin(), created.end());
    }

    void move(const Scene& scene, BulletRandom random) {
        std::vector<btBroadphaseProxy*> moved;
        std::vector<btVector3> mins;
        std::vector<btVector3> maxs;
        for (btBroadphaseProxy* proxy : proxies_) {
            if (random.chance(0.6)) {
                const Box box = scene.step(random, boxOf(*proxy));
                moved.push_back(proxy);
                mins.push_back(box.min);
                maxs.push_back(box.max);
            }
        }
        if (inBatches_) {
            broadphase_->setAabbs(moved, mins, maxs, nullptr);
        }
        for (std::size_t i = 0; i < moved.size() && !inBatches_; ++i) {
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
        }
        for (std::size_t i = 0; i < gone.size() && !inBatches_; ++i) {
            broadphase_->destroyProxy(gone[i], nullptr);
        }
    }

    void calculate() { broadphase_->calculateOverlappingPairs(nullptr); }

    [[nodiscard]] btOverlappingPairCache& cache() const {
        return *broadphase_->getOverlappingPairCache();
    }
    [[nodiscard]] std::string validate() const { return broadphase_->validate(); }
    [[nodiscard]] std::vector<Uids> list(bool isSorted) const {
        std::vector<Uids> list = uidList(cache());
        if (isSorted) {
            std::sort(list.begin(), list.end());
        }
        return list;
    }

    PairJournal journal;

private:
    bool inBatches_;
    std::unique_ptr<btOverlappingPairCache> given_;
    std::unique_ptr<SpatialHashBroadphase> broadphase_;
    std::vector<std::unique_ptr<Client>> clients_;
    std::vector<btBroadphaseProxy*> proxies_;
};

/// The kind of cache, whether ghosts are told, and eager groups.
using Case = std::tuple<int, bool, int>;

class ProxyBatches : public testing::TestWithParam<Case> {};

TEST_P(ProxyBatches, DoWhatSingleCallsDo) {
    const auto [number, hasGhosts, eagerGroups] = GetParam();
    const CacheKind& kind = cacheKinds()[std::size_t(number)];
    SpatialHashConfig config;
    config.eagerGroups = eagerGroups;
    // Without a callback to be told of each pair, batches leave arrivals in another order.
    const bool isAnyOrder = number < 2 && !hasGhosts;
    for (const char* name : {"uniform", "piles", "staticHeavy"}) {
        const Scene& scene = sceneNamed(name);
        Crowd batches(kind, hasGhosts, config, true);
        Crowd singles(kind, hasGhosts, config, false);
        std::size_t pairCount = 0;
        for (int frame = 0; frame < 44; ++frame) {
            SCOPED_TRACE(testing::Message() << kind.name << ", " << name << ", frame " << frame);
            const auto onBoth = [&](const auto& act) {
                act(batches);
                act(singles);
                ASSERT_EQ(batches.list(isAnyOrder), singles.list(isAnyOrder));
                ASSERT_EQ(batches.journal.takeTouched(), singles.journal.takeTouched());
                ASSERT_EQ(batches.journal.errors(), std::vector<std::string>{});
            };
            BulletRandom random(1000 + static_cast<std::uint64_t>(frame));
            std::vector<Box> boxes;
            for (int i = 0; i < (frame % 8 == 0 ? 125 : 3); ++i) {
                boxes.push_back(scene.place(random, i));
            }
            onBoth([&](Crowd& crowd) {
                crowd.create(boxes, random);
                crowd.move(scene, random);
            });
            onBoth([&](Crowd& crowd) {
                crowd.destroy(frame % 8 == 7 ? 250 : 4, frame % 16 == 7 ? 1 : 3);
            });
            onBoth([](Crowd& crowd) { crowd.calculate(); });
            ASSERT_EQ(batches.validate(), "");
            ASSERT_FALSE(HasFailure());
            pairCount += static_cast<std::size_t>(batches.cache().getNumOverlappingPairs());
        }
        EXPECT_GT(pairCount, 1000U);
    }
}

constexpr int kSensor = btBroadphaseProxy::SensorTrigger;
constexpr int kAll = btBroadphaseProxy::AllFilter;

INSTANTIATE_TEST_SUITE_P(Caches, ProxyBatches,
                         testing::Values(Case{0, false, 0}, Case{0, true, 0}, Case{0, false, kAll},
                                         Case{1, false, kSensor}, Case{1, true, kSensor},
                                         Case{2, false, kSensor}, Case{2, true, kAll},
                                         Case{3, false, kSensor}, Case{3, true, kSensor}));

TEST(ProxyBatch, CreatesWhatTheDefinitionsSay) {
    SpatialHashBroadphase broadphase;
    int client = 0;
    const std::vector<ProxyDefinition> definitions{
        {}, {{1, 2, 3}, {4, 5, 6}, &client, btBroadphaseProxy::StaticFilter, 7}};
    std::vector<btBroadphaseProxy*> proxies(2);
    broadphase.createProxies(definitions, proxies, nullptr);
    EXPECT_EQ(proxies[0]->m_collisionFilterGroup, btBroadphaseProxy::DefaultFilter);
    EXPECT_EQ(proxies[0]->m_collisionFilterMask, kAll);
    EXPECT_TRUE(isSame(boxOf(*proxies[0]), {{0, 0, 0}, {0, 0, 0}}));
    EXPECT_EQ(proxies[1]->m_uniqueId, 2);
    EXPECT_EQ(proxies[1]->m_clientObject, &client);
    EXPECT_EQ(proxies[1]->m_collisionFilterGroup, btBroadphaseProxy::StaticFilter);
    EXPECT_EQ(proxies[1]->m_collisionFilterMask, 7);
    EXPECT_TRUE(isSame(boxOf(*proxies[1]), {{1, 2, 3}, {4, 5, 6}}));
}

}  // namespace
}  // namespace hashphase::test
