// SPDX-License-Identifier: Zlib
//
// Boxes that reach a broadphase from addCollisionObject, which checks nothing: NaN, infinite, as
// large as the scalar goes, inside out.

#include <tests/integration/bullet/box_commands.hpp>
#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/queries.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

Box withNan(Box box, int field) {
    (field < 3 ? box.min : box.max)[field % 3] = kNan;
    return box;
}

class NanBox : public testing::TestWithParam<int> {
protected:
    CaughtMessages messages;
};

TEST_P(NanBox, PairsWithNothing) {
    Player player = hashPlayer(3);
    const btScalar large = BT_LARGE_FLOAT;
    player.play(createCommand(0, kUnit));
    player.play(createCommand(1, {{-large, -large, -large}, {large, large, large}}));
    player.play(createCommand(2, withNan(kUnit, GetParam())));
    player.calculate();
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
}

TEST_P(NanBox, EndsThePairsThatTheProxyHad) {
    for (const bool isDeferred : {false, true}) {
        std::unique_ptr<btOverlappingPairCache> cache;
        if (isDeferred) {
            cache = std::make_unique<btSortedOverlappingPairCache>();
        }
        Player player = hashPlayer(2, std::move(cache));
        player.play({createCommand(0, kUnit), createCommand(1, kUnit)});
        player.calculate();
        ASSERT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
        player.play({Action::set, 1, withNan(kUnit, GetParam()), 0, 0});
        player.calculate();
        EXPECT_EQ(player.pairs(), ObjectPairs{}) << isDeferred;
        player.play({Action::set, 1, kUnit, 0, 0});
        player.calculate();
        EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}})) << "Healed, " << isDeferred;
    }
}

TEST_P(NanBox, IsFoundByNoQuery) {
    Player player = hashPlayer(1);
    player.play(createCommand(0, withNan(kUnit, GetParam())));
    for (int updates = 0; updates < 2; ++updates) {
        CollectBox byBox;
        player.broadphase().aabbTest({-9, -9, -9}, {9, 9, 9}, byBox);
        EXPECT_TRUE(byBox.found.empty());
        const Ray ray{{-2, btScalar(0.1), btScalar(0.2)}, {2, 0, 0}};
        CollectRay byRay(ray);
        player.broadphase().rayTest(ray.from, ray.to, byRay);
        EXPECT_TRUE(byRay.found.empty());
        player.calculate();
    }
}

TEST_P(NanBox, OfAnEagerProxyIsHarmless) {
    Player player = hashPlayer(2, nullptr, eagerCharactersAndSensors());
    player.play(createCommand(0, kUnit));
    Command sensor = createCommand(1, withNan(kUnit, GetParam()));
    sensor.group = btBroadphaseProxy::SensorTrigger;
    player.play(sensor);
    EXPECT_EQ(player.pairs(), ObjectPairs{});
    player.play({Action::set, 1, kUnit, 0, 0});
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
    player.play({Action::set, 1, withNan(kUnit, GetParam()), 0, 0});
    player.calculate();
    EXPECT_EQ(player.pairs(), ObjectPairs{});
}

INSTANTIATE_TEST_SUITE_P(Fields, NanBox, testing::Range(0, 6));

TEST(NanBoxes, AreReportedOnceAndCounted) {
    const CaughtMessages messages;
    Player player = hashPlayer(4);
    const SpatialHashBroadphase& broadphase = hashOf(player);
    player.play(createCommand(0, kUnit));
    EXPECT_TRUE(messages.all().empty());
    player.play(createCommand(1, withNan(kUnit, 4)));
    ASSERT_EQ(messages.all().size(), 1U);
    EXPECT_NE(messages.all()[0].find("NaN"), std::string::npos) << messages.all()[0];
    for (int frame = 0; frame < 20; ++frame) {
        player.play({Action::set, 0, frame % 2 == 0 ? withNan(kUnit, frame % 6) : kUnit, 0, 0});
        player.play({Action::set, 1, withNan(kUnit, frame % 6), 0, 0});
        player.calculate();
        EXPECT_EQ(broadphase.grid().nanCount(), frame % 2 == 0 ? 2U : 1U);
    }
    EXPECT_EQ(messages.all().size(), 1U);
}

// Bullet's tree loses pairs of others when a NaN is merged into an inner node.
TEST(NanBoxes, ChangeNothingForTheOthers) {
    const CaughtMessages messages;
    constexpr int kObjects = 300;
    for (const Scene& scene : allScenes()) {
        SCOPED_TRACE(scene.name);
        const Script script = makeScript(scene, kObjects, 40, 5);
        Truth truth(kObjects);
        Player player = hashPlayer(kObjects);
        BulletRandom random(11);
        for (Frame frame : script.frames) {
            for (Command& command : frame) {
                const bool hasBox =
                    command.action == Action::set || command.action == Action::create;
                if (hasBox && random.chance(0.05)) {
                    command.box = withNan(command.box, random.below(6));
                }
            }
            truth.play(frame);
            player.play(frame);
            player.calculate();
            ASSERT_EQ(difference(player.pairs(), truth.pairs()), "");
            ASSERT_EQ(hashOf(player).validate(), "");
        }
    }
}

TEST(NanBoxes, DoNotSpoilTheBoxAroundEverything) {
    const CaughtMessages messages;
    Player player = hashPlayer(2);
    player.play({createCommand(0, kUnit), createCommand(1, withNan(kUnit, 1))});
    Box all;
    player.broadphase().getBroadphaseAabb(all.min, all.max);
    EXPECT_TRUE(isSame(all, kUnit));
}

/// A few dozen boxes of every odd kind; `turn` deals them to the objects in another order.
Box oddBox(int object, int turn) {
    const btScalar most = std::numeric_limits<btScalar>::max();
    const btScalar ends[] = {
        -kInfinity, -most, -BT_LARGE_FLOAT, btScalar(-1e9), -1,   btScalar(-0.0),
        0,          1,     btScalar(1e9),   BT_LARGE_FLOAT, most, kInfinity};
    constexpr int kEnds = static_cast<int>(std::size(ends));
    BulletRandom random(static_cast<std::uint64_t>((object * 7 + turn * 13) % 997) + 1);
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        int low = random.below(kEnds);
        int high = random.below(kEnds);
        if (low > high && !random.chance(0.2)) {
            std::swap(low, high);  // the others are inside out
        }
        box.min[axis] = ends[low];
        box.max[axis] = ends[high];
    }
    return object % 3 == 0 ? boxAround(random.vector(-3, 3), {1, 1, 1}) : box;
}

// Inside out, infinite or enormous, a box pairs as comparing its ends says.
TEST(OddBoxes, PairAsBruteForceAndBtSimpleBroadphaseSay) {
    constexpr int kObjects = 150;
    Truth truth(kObjects);
    Player hash = hashPlayer(kObjects);
    Player simple(kObjects, std::make_unique<btSimpleBroadphase>());
    std::size_t pairCount = 0;
    for (int turn = 0; turn < 40; ++turn) {
        Frame frame;
        for (int object = 0; object < kObjects; ++object) {
            if (turn == 0 || (object + turn) % 3 == 0) {
                frame.push_back(createCommand(object, oddBox(object, turn)));
                frame.back().action = turn == 0 ? Action::create : Action::set;
            }
        }
        truth.play(frame);
        for (Player* const player : {&hash, &simple}) {
            player->play(frame);
            player->calculate();
        }
        ASSERT_EQ(difference(hash.pairs(), truth.pairs()), "") << "turn " << turn;
        ASSERT_EQ(difference(hash.pairs(), simple.pairs()), "") << "turn " << turn;
        ASSERT_EQ(hashOf(hash).validate(), "");
        pairCount += truth.pairs().size();
    }
    EXPECT_GT(pairCount, 10'000U);
}

TEST(OddBoxes, AreFoundByQueriesAsBruteForceSays) {
    constexpr int kObjects = 150;
    Truth truth(kObjects);
    Player hash = hashPlayer(kObjects);
    for (int object = 0; object < kObjects; ++object) {
        const Command command = createCommand(object, oddBox(object, 1));
        truth.play({command});
        hash.play(command);
    }
    BulletRandom random(3);
    for (int i = 0; i < 300; ++i) {
        const Box box = oddBox(i, 2);
        CollectBox byBox;
        hash.broadphase().aabbTest(box.min, box.max, byBox);
        ASSERT_EQ(sorted(byBox.found), bruteForceBox(truth, kObjects, box)) << describe(box);
        const Ray ray{random.vector(-9, 9), random.vector(-9, 9)};
        CollectRay byRay(ray);
        hash.broadphase().rayTest(ray.from, ray.to, byRay);
        ASSERT_EQ(sorted(byRay.found), bruteForceRay(truth, kObjects, ray)) << describe(ray);
        if (i % 100 == 50) {
            hash.calculate();
        }
    }
}

}  // namespace
}  // namespace hashphase::test
