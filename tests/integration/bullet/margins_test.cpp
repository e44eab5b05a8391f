// SPDX-License-Identifier: Zlib
//
// Objects with a margin: pairs and queries are those of boxes that were grown by hand, and contact tests report
// what they do under Bullet's own broadphases with such boxes.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/ghost_world.hpp>
#include <tests/integration/bullet/queries.hpp>
#include <tests/integration/bullet/shooting_range.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

// --- Boxes ---------------------------------------------------------------------------------------

/// Boxes with margins, by brute force. All numbers are multiples of a power of two, so that shifts are exact.
struct MarginBoxes : AnyBoxes {
    explicit MarginBoxes(std::unique_ptr<btOverlappingPairCache> cache)
        : AnyBoxes(std::move(cache), eagerCharactersAndSensors()) {}

    btScalar number(double low, double high) {
        return std::floor(random.uniform(low, high) * 64) / 64;
    }
    Box anywhere() {
        const btVector3 low(number(-9, 9), number(-9, 9), number(-9, 9));
        return {low + origin, low + origin + btVector3(number(0, 2), number(0, 2), number(0, 2))};
    }
    btBroadphaseProxy* any() { return proxies[std::size_t(random.below(int(proxies.size())))]; }
    void change() {
        while (proxies.size() < 60) {
            create(anywhere(), random.chance(0.1) ? btBroadphaseProxy::CharacterFilter : 1, -1,
                   &clients.emplace_back(int(clients.size())));
            EXPECT_EQ(hash().margin(proxies.back()), 0);
        }
        for (int i = 0; i < 15; ++i) {
            btBroadphaseProxy* const proxy = any();
            const bool stays = random.chance(0.2);
            const btVector3 by(number(-1, 1), 0, number(-1, 1));
            set(proxy, stays ? boxOf(*proxy) : anywhere());
            move(proxy, by);
        }
        for (int i = 0; i < 6; ++i) {
            hash().setMargin(any(), random.chance(0.4) ? 0 : number(0, 2), nullptr);
        }
        if (random.chance(0.3)) {
            destroy(any());
        }
        if (random.chance(0.1)) {
            const btVector3 shift(number(-2, 2), number(-2, 2), 0);
            EXPECT_EQ(hash().shiftOrigin(shift), 0U);
            origin -= shift;
        }
    }
    [[nodiscard]] Box grown(const btBroadphaseProxy& proxy) const {
        return grownBy(boxOf(proxy), hash().margin(&proxy));
    }
    void expectPairsOfGrownBoxes() {
        std::vector<Uids> expected;
        for (const btBroadphaseProxy* const a : proxies) {
            for (const btBroadphaseProxy* const b : proxies) {
                if (a->m_uniqueId < b->m_uniqueId && overlap(grown(*a), grown(*b))) {
                    expected.push_back(uidsOf(*a, *b));
                }
            }
        }
        std::sort(expected.begin(), expected.end());
        std::vector<Uids> pairs = list();
        std::sort(pairs.begin(), pairs.end());
        ASSERT_EQ(pairs, expected);
        ASSERT_EQ(hash().validate(), "");
    }
    template <class Question>
    [[nodiscard]] std::vector<int> met(const Question& question) const {
        std::vector<int> found;
        for (const btBroadphaseProxy* const proxy : proxies) {
            if (doesMeet(question, grown(*proxy))) {
                found.push_back(objectOf(proxy));
            }
        }
        std::sort(found.begin(), found.end());
        return found;
    }
    void expectQueriesOfGrownBoxes() {
        const Box asked = anywhere();
        CollectBox inBox;
        over->aabbTest(asked.min, asked.max, inBox);
        EXPECT_EQ(inBox.sorted(), met(asked));
        const Ray ray{anywhere().min, anywhere().max + btVector3(btScalar(0.3), 0, 0)};
        CollectRay onRay(ray);
        over->rayTest(ray.from, ray.to, onRay);
        EXPECT_EQ(onRay.sorted(), met(ray));
    }

    BulletRandom random{0x5eed0a11};
    btVector3 origin{0, 0, 0};
    std::deque<Client> clients;
};

class BoxesWithMargins : public testing::TestWithParam<CacheKind> {};
INSTANTIATE_TEST_SUITE_P(Caches, BoxesWithMargins, testing::ValuesIn(kCacheKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST_P(BoxesWithMargins, PairAndAreFoundAsBoxesGrownByHand) {
    MarginBoxes boxes(GetParam().make());
    for (int frame = 0; frame < 200; ++frame) {
        SCOPED_TRACE(frame);
        boxes.change();
        boxes.expectQueriesOfGrownBoxes();
        boxes.step(frame % 50 == 49 ? 12 : 1);
        boxes.expectPairsOfGrownBoxes();
        if (HasFatalFailure()) {
            return;
        }
    }
    EXPECT_GT(boxes.pairCount(), 20);
    // Without margins all is as it was.
    for (btBroadphaseProxy* const proxy : boxes.proxies) {
        boxes.hash().setMargin(proxy, 0, nullptr);
    }
    boxes.step();
    std::vector<Uids> pairs = boxes.list();
    std::sort(pairs.begin(), pairs.end());
    EXPECT_EQ(pairs, boxes.overlaps());
}

TEST(Margins, LeaveTheBoxThatWasSetAsItIs) {
    Boxes boxes;
    const Box box = cubeAt(0);
    btBroadphaseProxy* const proxy = boxes.create(box);
    boxes.create(cubeAt(btScalar(1.5)));
    boxes.broadphase.setMargin(proxy, 1, nullptr);
    Box got;
    boxes.broadphase.getAabb(proxy, got.min, got.max);
    EXPECT_TRUE(isSame(got, box) && isSame(boxOf(*proxy), box));
    boxes.broadphase.getBroadphaseAabb(got.min, got.max);
    EXPECT_EQ(got.min, btVector3(-1, -1, -1));
    const Aabb<btScalar>& inGrid = boxes.broadphase.grid().box(SpatialHashBroadphase::idOf(proxy));
    EXPECT_TRUE(isSame(boxOf(inGrid), grownBy(box, 1)));
    boxes.step();
    EXPECT_EQ(boxes.pairCount(), 1);
    // What has not changed costs a comparison.
    boxes.set(proxy, box);
    boxes.step();
    EXPECT_EQ(boxes.cost().grid.changed, 0U);
    // A proxy that takes the place of another one has no margin.
    boxes.destroy(proxy);
    boxes.step();
    EXPECT_EQ(boxes.broadphase.margin(boxes.create(box)), 0);
    boxes.step();
    EXPECT_EQ(boxes.pairCount(), 0);
}

TEST(Margins, AreSeenByGhostsAtOnce) {
    GhostWorld scene;
    btBoxShape shape({1, 1, 1});
    btRigidBody& body = scene.body(scene.add(&shape, 1, placeAt({4, 0, 0})));
    scene.detect();
    btGhostObject* const ghost = scene.ghosts()[0];
    EXPECT_FALSE(scene.doesList(*ghost, body));
    scene.hash().setMargin(ghost->getBroadphaseHandle(), 2, &scene.dispatcher());
    EXPECT_TRUE(scene.doesList(*ghost, body));
    EXPECT_FALSE(scene.doesList(*scene.ghosts()[1], body));
    scene.detect();
    EXPECT_TRUE(scene.doesList(*ghost, body));
    scene.hash().setMargin(ghost->getBroadphaseHandle(), 0, &scene.dispatcher());
    scene.detect();
    EXPECT_FALSE(scene.doesList(*ghost, body));
    scene.hash().setMargin(body.getBroadphaseHandle(), 2, &scene.dispatcher());
    scene.detect();
    EXPECT_TRUE(scene.doesList(*ghost, body));
}

// Before each step, with the same prediction.
TEST(Margins, GrowTheWaysOfFlyingBodies) {
    for (const Sweep sweep : {Sweep::box, Sweep::line, Sweep::automatic}) {
        ShootingRange range(sweep);
        range.fill(0x5eed0a12, 4);
        for (int i = 0; i < range.bodyCount(); i += 3) {
            range.hash().setMargin(range.body(i).getBroadphaseProxy(), btScalar(i % 5) / 4,
                                   &range.dispatcher());
        }
        range.world().setInternalTickCallback(
            [](btDynamicsWorld* world, btScalar) {
                auto& own = *static_cast<ShootingRange*>(world->getWorldUserInfo());
                for (int i = 0; i < own.bodyCount(); ++i) {
                    btTransform predicted;
                    own.body(i).predictIntegratedTransform(kStep, predicted);
                    own.body(i).setInterpolationWorldTransform(predicted);
                }
                own.world().updateAabbs();
                own.hash().calculateOverlappingPairs(&own.dispatcher());
                EXPECT_EQ(own.pairs(), own.expectedPairs(1));
            },
            &range, true);
        range.step(2);
        EXPECT_GT(range.pairs().size(), 50U);
        range.step(4);
        EXPECT_EQ(range.hash().validate(), "");
    }
}

TEST(Margins, AreSetOrMadeUpForByTheNextStepWhereMemoryRunsOut) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    const std::size_t failures = runOutOfMemory(
        [] {
            auto boxes = std::make_unique<Boxes>(eagerCharactersAndSensors());
            for (int i = 0; i < 60; ++i) {
                boxes->create(cubeAt(btScalar(2 * i)), btBroadphaseProxy::CharacterFilter);
            }
            boxes->step();
            return boxes;
        },
        [](Boxes& boxes) {
            for (btBroadphaseProxy* const proxy : boxes.proxies) {
                boxes.broadphase.setMargin(proxy, 1, nullptr);
            }
        },
        [](Boxes& boxes, std::size_t) {
            boxes.step();
            for (std::size_t i = 0; i < boxes.proxies.size(); ++i) {
                for (std::size_t k = 0; k < i; ++k) {
                    const auto grown = [&](std::size_t n) {
                        return grownBy(boxOf(*boxes.proxies[n]),
                                       boxes.broadphase.margin(boxes.proxies[n]));
                    };
                    EXPECT_EQ(boxes.isPair(i, k), overlap(grown(i), grown(k)));
                }
            }
            EXPECT_EQ(boxes.broadphase.validate(), "");
        });
    EXPECT_GE(failures, 3U);
}

// --- Contact tests -------------------------------------------------------------------------------

/// A point that a contact test reports: of which two bodies, how far apart, and where.
struct ReportedPoint {
    int first;
    int second;
    std::array<btScalar, 7> numbers;

    auto operator<=>(const ReportedPoint&) const = default;
};

struct ReportPoints : btCollisionWorld::ContactResultCallback {
    explicit ReportPoints(btScalar threshold) { m_closestDistanceThreshold = threshold; }

    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                             const btCollisionObjectWrapper* b, int, int) override {
        const btVector3& onA = point.m_positionWorldOnA;
        const btVector3& onB = point.m_positionWorldOnB;
        points.push_back(
            {a->getCollisionObject()->getUserIndex(),
             b->getCollisionObject()->getUserIndex(),
             {point.getDistance(), onA.x(), onA.y(), onA.z(), onB.x(), onB.y(), onB.z()}});
        return 0;
    }
    std::vector<ReportedPoint> sorted() {
        std::sort(points.begin(), points.end());
        return points;
    }
    [[nodiscard]] bool isAnyWithin(btScalar distance) const {
        return std::any_of(points.begin(), points.end(), [=](const ReportedPoint& point) {
            return point.numbers[0] <= distance;
        });
    }

    std::vector<ReportedPoint> points;
};

/// Bodies of many shapes here and there, with margins, or under Bullet's broadphases with grown boxes.
struct BodiesWithMargins : DynamicsWorld {
    static constexpr int kCount = 50;

    BodiesWithMargins(std::unique_ptr<btBroadphaseInterface> broadphase, std::uint64_t seed,
                      btScalar leastMargin)
        : DynamicsWorld(std::move(broadphase)) {
        compound.addChildShape(placeAt({0, 0, 0}), &box);
        compound.addChildShape(placeAt({1, 0, 0}), &ball);
        btCollisionShape* const shapes[] = {&box, &ball, &rod, &cone, &compound};
        BulletRandom random(seed);
        for (int i = 0; i < kCount; ++i) {
            const btQuaternion turn(random.direction(), random.uniform(0, 3));
            add(shapes[i % 5], 1, placeAt(random.vector(-5, 5), turn));
            const btScalar drawn = random.uniform(0, 1);
            margins.push_back(leastMargin + (i % 3 == 0 ? 0 : drawn));
        }
        place();
    }
    ~BodiesWithMargins() {
        for (int i = 0; i < kCount; ++i) {
            takeOut(i);
        }
    }

    void place() {
        auto* const ours = dynamic_cast<SpatialHashBroadphase*>(&broadphase());
        for (int i = 0; i < kCount && ours != nullptr; ++i) {
            ours->setMargin(proxy(i), margins[std::size_t(i)], &dispatcher());
        }
        world().updateAabbs();
        for (int i = 0; i < kCount && ours == nullptr; ++i) {
            const Box grown = grownBy(boxOf(*proxy(i)), margins[std::size_t(i)]);
            broadphase().setAabb(proxy(i), grown.min, grown.max, &dispatcher());
        }
        broadphase().calculateOverlappingPairs(&dispatcher());
    }
    void moveAll(std::uint64_t seed) {
        BulletRandom random(seed);
        for (int i = 0; i < kCount; ++i) {
            const btQuaternion turn(random.direction(), random.uniform(0, 3));
            body(i).setWorldTransform(placeAt(random.vector(-5, 5), turn));
            body(i).setInterpolationWorldTransform(body(i).getWorldTransform());
        }
        place();
    }
    [[nodiscard]] btBroadphaseProxy* proxy(int i) { return body(i).getBroadphaseHandle(); }
    [[nodiscard]] bool isPair(int a, int b) {
        return cache().findPair(proxy(a), proxy(b)) != nullptr;
    }
    std::vector<ReportedPoint> test(int number) {
        ReportPoints report(0);
        world().contactTest(&body(number), report);
        return report.sorted();
    }
    ReportPoints test(int a, int b, btScalar threshold) {
        ReportPoints report(threshold);
        world().contactPairTest(&body(a), &body(b), report);
        return report;
    }

    btBoxShape box{btVector3(btScalar(0.4), btScalar(0.5), btScalar(0.6))};
    btSphereShape ball{btScalar(0.5)};
    btCapsuleShape rod{btScalar(0.2), 1};
    btConeShape cone{btScalar(0.5), 1};
    btCompoundShape compound;
    std::vector<btScalar> margins;
};

TEST(ContactTests, ReportUnderMarginsWhatTheyDoUnderBulletsBroadphasesWithGrownBoxes) {
    std::size_t reported = 0;
    std::size_t fromAfar = 0;
    for (const auto make : {makeBroadphase<ExactDbvt>, makeBroadphase<btSimpleBroadphase>}) {
        BodiesWithMargins ours(makeBroadphase<SpatialHashBroadphase>(), 0x5eed0a13, 0);
        BodiesWithMargins theirs(make(), 0x5eed0a13, 0);
        for (std::uint64_t round = 0; round < 9; ++round) {
            ASSERT_EQ(uidPairs(ours.cache()).size(), uidPairs(theirs.cache()).size());
            for (int a = 0; a < ours.kCount; ++a) {
                const std::vector<ReportedPoint> points = ours.test(a);
                ASSERT_TRUE(points == theirs.test(a)) << a;
                reported += points.size();
                for (int b = 0; b < a; ++b) {
                    ASSERT_EQ(ours.isPair(a, b), theirs.isPair(a, b)) << a << " and " << b;
                    for (const btScalar threshold : {btScalar(0), btScalar(0.2), btScalar(1)}) {
                        if (ours.isPair(a, b)) {
                            ReportPoints ofPair = ours.test(a, b, threshold);
                            ASSERT_TRUE(ofPair.sorted() == theirs.test(a, b, threshold).sorted());
                            fromAfar += ofPair.points.size();
                        }
                    }
                }
            }
            ours.moveAll(round);
            theirs.moveAll(round);
        }
        EXPECT_EQ(ours.hash().validate(), "");
    }
    EXPECT_GT(reported, 300U);
    EXPECT_GT(fromAfar, 2 * reported);
}

TEST(ContactTests, OfPairsFindAllThatIsWithinTheSumOfTheMargins) {
    BodiesWithMargins bodies(makeBroadphase<SpatialHashBroadphase>(), 0x5eed0a14, btScalar(0.3));
    constexpr auto kReach = btScalar(0.6);
    std::size_t within = 0;
    std::size_t near = 0;
    for (int a = 0; a < bodies.kCount; ++a) {
        for (int b = 0; b < a; ++b) {
            if (bodies.test(a, b, kReach).isAnyWithin(kReach)) {
                ++within;
                near += bodies.test(a, b, 0).isAnyWithin(btScalar(0.02)) ? 1 : 0;
                EXPECT_TRUE(bodies.isPair(a, b)) << a << " and " << b;
            }
        }
    }
    EXPECT_GT(within, 2 * near);
    EXPECT_GT(near, 0U);
}

}  // namespace
}  // namespace hashphase::test
