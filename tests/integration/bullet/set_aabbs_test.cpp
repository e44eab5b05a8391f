// SPDX-License-Identifier: Zlib
//
// setAabbs() on any number of threads, against as many single calls: the same pairs in the same order, told
// of in the same order.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/threaded_for.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <gtest/gtest.h>

#include <deque>
#include <limits>
#include <new>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

/// What a scene has beside bodies.
struct MovedKind {
    const char* name;
    int ghostCount = 0;
    int eagerGroups = 0;
    Sweep sweep = Sweep::none;
    bool doCallbacksMove = false;  // what pairs are told to moves other proxies
    bool areGroupsWritten = false;
    bool haveMargins = false;
};

constexpr MovedKind kMovedKinds[] = {
    {"bodies"},
    {.name = "ghosts", .ghostCount = 40},
    {.name = "groups", .areGroupsWritten = true},
    {.name = "margins", .ghostCount = 10, .haveMargins = true},
    {.name = "eager", .eagerGroups = btBroadphaseProxy::SensorTrigger},
    {.name = "sweep", .sweep = Sweep::automatic},
    {.name = "busy callbacks", .ghostCount = 5, .doCallbacksMove = true}};

/// MovedObjects whose boxes are set in batches, or one by one with 0 threads.
class MovedObjects {
public:
    static constexpr int kCount = 5000;

    MovedObjects(const MovedKind& kind, std::size_t threadCount)
        : kind_(kind), threads_(threadCount, 0x5eed0b01), boxes_(configFor(threadCount)) {
        if (kind.ghostCount > 0) {
            boxes_.pairCache().setInternalGhostPairCallback(&journal);
        }
        if (kind.doCallbacksMove) {
            journal.onBirth = [this](btBroadphaseProxy* a, btBroadphaseProxy* b) { meddle(a, b); };
        }
        BulletRandom random(0x5eed0b02);
        for (int i = 0; i < kCount; ++i) {
            const bool isGhost = kind.ghostCount > 0 && i % (kCount / kind.ghostCount) == 17;
            btCollisionObject* client = &clients_.emplace_back(i);
            if (isGhost) {
                client = &ghosts_.emplace_back();
            }
            const Box box = draw(random);
            proxies.push_back(boxes_.hash().createProxy(box.min, box.max, 0, client, groupFor(i),
                                                        btBroadphaseProxy::AllFilter,
                                                        &dispatcher_));
            boxes_.proxies.push_back(proxies.back());
            if (kind.haveMargins && i % 4 == 1) {
                boxes_.hash().setMargin(proxies.back(), btScalar(i % 7) / 10, &dispatcher_);
            }
        }
    }

    static Box draw(BulletRandom& random) {
        return boxAround(random.vector(-18, 18), random.vector(0.3, 0.6));
    }

    void set(const std::vector<int>& numbers, const std::vector<btVector3>& mins,
             const std::vector<btVector3>& maxs) {
        std::vector<btBroadphaseProxy*> named;
        for (const int number : numbers) {
            named.push_back(proxies[std::size_t(number)]);
        }
        if (isThreaded_) {
            boxes_.hash().setAabbs(named, mins, maxs, &dispatcher_);
            return;
        }
        for (std::size_t i = 0; i < named.size(); ++i) {
            boxes_.hash().setAabb(named[i], mins[i], maxs[i], &dispatcher_);
        }
    }
    void writeGroups(BulletRandom& random) {
        for (int i = 0; kind_.areGroupsWritten && i < 60; ++i) {
            btBroadphaseProxy& proxy = *proxies[std::size_t(random.below(kCount))];
            proxy.m_collisionFilterGroup = 1 << random.below(4);
        }
    }
    void step() { boxes_.hash().calculateOverlappingPairs(&dispatcher_); }
    [[nodiscard]] std::vector<Uids> list() const { return boxes_.list(); }
    [[nodiscard]] std::string validate() const { return boxes_.hash().validate(); }
    [[nodiscard]] std::size_t mostRanges() const { return threads_.mostRanges(); }

    PairJournal journal;
    std::vector<btBroadphaseProxy*> proxies;

private:
    SpatialHashConfig configFor(std::size_t threadCount) {
        isThreaded_ = threadCount > 0;
        SpatialHashConfig config;
        config.eagerGroups = kind_.eagerGroups;
        config.sweep = kind_.sweep;
        if (isThreaded_) {
            config.parallelFor = [this](std::size_t count, std::size_t grain, LoopBody body) {
                threads_(count, grain, body);
            };
        }
        return config;
    }
    [[nodiscard]] int groupFor(int i) const {
        if (i % 3 == 0) {
            return btBroadphaseProxy::StaticFilter;
        }
        return kind_.eagerGroups != 0 && i % 1000 == 500 ? kind_.eagerGroups
                                                         : btBroadphaseProxy::DefaultFilter;
    }
    // Of two that meet, moves the next one out of the way.
    void meddle(btBroadphaseProxy* a, btBroadphaseProxy* b) {
        const auto next = std::size_t(a->m_uniqueId + b->m_uniqueId) % proxies.size();
        if (isMeddling_ || journal.all.size() % 5 != 0) {
            return;
        }
        isMeddling_ = true;
        const btVector3 by(1, 0, 0);
        boxes_.hash().setAabb(proxies[next], proxies[next]->m_aabbMin + by,
                              proxies[next]->m_aabbMax + by, &dispatcher_);
        isMeddling_ = false;
    }

    const MovedKind& kind_;
    bool isThreaded_ = false;
    bool isMeddling_ = false;
    ThreadedFor threads_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    std::deque<Client> clients_;
    std::deque<btGhostObject> ghosts_;
    Boxes boxes_;
};

class SetAabbs : public testing::TestWithParam<std::size_t> {};

TEST_P(SetAabbs, DoesWhatSingleCallsDoOnAnyNumberOfThreads) {
    const CaughtMessages quiet;
    for (const MovedKind& kind : kMovedKinds) {
        MovedObjects batch(kind, GetParam());
        MovedObjects single(kind, 0);
        BulletRandom random(0x5eed0b03);
        for (int frame = 0; frame < 14; ++frame) {
            SCOPED_TRACE(testing::Message()
                         << kind.name << ", " << GetParam() << " threads, frame " << frame);
            std::vector<int> numbers;
            std::vector<btVector3> mins;
            std::vector<btVector3> maxs;
            for (int i = 0; i < MovedObjects::kCount; ++i) {
                const bool isNamedTwice = frame == 5 && i % 1000 == 0;
                numbers.push_back(isNamedTwice     ? 7
                                  : frame % 4 == 3 ? (i * 1777) % MovedObjects::kCount
                                                   : i);
                const btBroadphaseProxy& proxy = *single.proxies[std::size_t(numbers.back())];
                Box box = boxOf(proxy);
                if (random.chance(0.2)) {
                    box = MovedObjects::draw(random);  // jumps
                } else if (random.chance(i % 3 == 0 ? 0.02 : 0.7)) {
                    const btVector3 by = random.vector(-0.2, 0.2);
                    box = {box.min + by, box.max + by};
                }
                if (random.chance(0.002)) {
                    box.max.setY(std::numeric_limits<btScalar>::quiet_NaN());
                }
                mins.push_back(box.min);
                maxs.push_back(box.max);
            }
            BulletRandom same = random;
            batch.writeGroups(same);
            single.writeGroups(random);
            batch.set(numbers, mins, maxs);
            single.set(numbers, mins, maxs);
            ASSERT_EQ(batch.list(), single.list());
            batch.step();
            single.step();
            ASSERT_EQ(batch.list(), single.list());
            ASSERT_TRUE(batch.journal.all == single.journal.all);
            ASSERT_EQ(batch.journal.errors, std::vector<std::string>{});
            // While pairs are told of, a callback may move what has been found.
            ASSERT_EQ(batch.validate(), kind.doCallbacksMove ? single.validate() : "");
        }
        EXPECT_GT(single.list().size(), 1000U);
        EXPECT_GT(batch.mostRanges(), 1U);
    }
}

INSTANTIATE_TEST_SUITE_P(Threads, SetAabbs, testing::Values(1, 2, 3, 8));

// A mask that was written counts when the box of the other proxy has changed, though setting it failed later.
TEST(SetAabbs, ThatFailsAndIsRepeatedFindsPairsThatAWrittenMaskAllows) {
    constexpr std::size_t kCount = 2000;
    bool isOutOfMemory = false;
    SpatialHashConfig config;
    config.parallelFor = [&](std::size_t count, std::size_t grain, LoopBody body) {
        serialFor(count, grain, body);
        if (isOutOfMemory && grain == 1) {  // a loop that sets boxes
            throw std::bad_alloc();
        }
    };
    Boxes boxes(config);
    std::vector<btVector3> mins;
    std::vector<btVector3> maxs;
    for (std::size_t i = 0; i < kCount; ++i) {
        const Box box = cubeAt(btScalar(2 * i));
        boxes.create(box);
        mins.push_back(box.min + btVector3(0, btScalar(0.25), 0));
        maxs.push_back(box.max + btVector3(0, btScalar(0.25), 0));
    }
    const std::vector<btBroadphaseProxy*> moved = boxes.proxies;
    btBroadphaseProxy* const stays = boxes.create(cubeAt(0), btBroadphaseProxy::SensorTrigger, 0);
    boxes.step(3);
    EXPECT_EQ(boxes.pairCount(), 0);
    stays->m_collisionFilterMask = -1;
    isOutOfMemory = true;
    EXPECT_THROW(boxes.broadphase.setAabbs(moved, mins, maxs, nullptr), std::bad_alloc);
    isOutOfMemory = false;
    boxes.broadphase.setAabbs(moved, mins, maxs, nullptr);
    boxes.step();
    EXPECT_EQ(boxes.list(), (std::vector<Uids>{{1, int(kCount) + 1}}));
}

}  // namespace
}  // namespace hashphase::test
