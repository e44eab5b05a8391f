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
#include <utility>

namespace hashphase::test {
namespace {

Box withNan(Box box, int field) {
    (field < 3 ? box.min : box.max)[field % 3] = kNan;
    return box;
}

TEST(NanBoxes, AreFoundByNoQueryAndNotAroundEverything) {
    const CaughtMessages messages;
    for (int field = 0; field < 6; ++field) {
        Player player = hashPlayer(2);
        player.create(0, withNan(kUnit, field));
        for (int updates = 0; updates < 2; ++updates) {
            CollectBox byBox;
            player.broadphase().aabbTest({-9, -9, -9}, {9, 9, 9}, byBox);
            const Ray ray{{-2, btScalar(0.1), btScalar(0.2)}, {2, 0, 0}};
            CollectRay byRay(ray);
            player.broadphase().rayTest(ray.from, ray.to, byRay);
            EXPECT_TRUE(byBox.found.empty() && byRay.found.empty()) << field;
            player.calculate();
        }
        player.create(1, kUnit);
        Box all;
        player.broadphase().getBroadphaseAabb(all.min, all.max);
        EXPECT_TRUE(isSame(all, kUnit)) << field;
    }
}

TEST(NanBoxes, AreReportedOnceAndCounted) {
    const CaughtMessages messages;
    Player player = hashPlayer(4);
    player.create(0, kUnit);
    EXPECT_TRUE(messages.all().empty());
    player.create(1, withNan(kUnit, 4));
    ASSERT_EQ(messages.all().size(), 1U);
    EXPECT_NE(messages.all()[0].find("NaN"), std::string::npos) << messages.all()[0];
    for (int frame = 0; frame < 20; ++frame) {
        player.set(0, frame % 2 == 0 ? withNan(kUnit, frame % 6) : kUnit);
        player.set(1, withNan(kUnit, frame % 6));
        player.calculate();
        EXPECT_EQ(hashOf(player).grid().nanCount(), frame % 2 == 0 ? 2U : 1U);
    }
    EXPECT_EQ(messages.all().size(), 1U);
}

// Bullet's tree loses pairs of others when a NaN is merged into an inner node.
TEST(NanBoxes, ChangeNothingForTheOthers) {
    const CaughtMessages messages;
    constexpr int kObjects = 300;
    for (const Scene& scene : allScenes()) {
        SCOPED_TRACE(scene.name);
        Script script = makeScript(scene, kObjects, 40, 5);
        Truth truth(kObjects);
        Player player = hashPlayer(kObjects);
        BulletRandom random(11);
        for (Frame& frame : script.frames) {
            for (Command& command : frame) {
                const bool hasBox =
                    command.action == Action::set || command.action == Action::create;
                if (hasBox && random.chance(0.05)) {
                    command.box = withNan(command.box, random.below(6));
                }
            }
            truth.play(frame);
            player.play(frame);
            ASSERT_EQ(difference(player.pairsAfterStep(), truth.pairs()), "");
            ASSERT_EQ(hashOf(player).validate(), "");
        }
    }
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
TEST(OddBoxes, PairAndAreFoundAsBruteForceAndBtSimpleBroadphaseSay) {
    constexpr int kObjects = 150;
    Truth truth(kObjects);
    Player hash = hashPlayer(kObjects);
    Player simple(kObjects, makeBroadphase<btSimpleBroadphase>());
    BulletRandom random(3);
    std::size_t pairCount = 0;
    for (int turn = 0; turn < 40; ++turn) {
        SCOPED_TRACE(turn);
        Frame frame;
        for (int object = 0; object < kObjects; ++object) {
            if (turn == 0 || (object + turn) % 3 == 0) {
                frame.push_back(createCommand(object, oddBox(object, turn)));
                frame.back().action = turn == 0 ? Action::create : Action::set;
            }
        }
        truth.play(frame);
        hash.play(frame);
        simple.play(frame);
        for (int i = 8 * turn; i < 8 * turn + 8; ++i) {
            const Box box = oddBox(i, 2);
            CollectBox byBox;
            hash.broadphase().aabbTest(box.min, box.max, byBox);
            ASSERT_EQ(sorted(byBox.found), bruteForceBox(truth, kObjects, box)) << describe(box);
            const Ray ray{random.vector(-9, 9), random.vector(-9, 9)};
            CollectRay byRay(ray);
            hash.broadphase().rayTest(ray.from, ray.to, byRay);
            ASSERT_EQ(sorted(byRay.found), bruteForceRay(truth, kObjects, ray)) << describe(ray);
        }
        const ObjectPairs expected = truth.pairs();
        ASSERT_EQ(difference(hash.pairsAfterStep(), expected), "");
        ASSERT_EQ(difference(simple.pairsAfterStep(), expected), "");
        ASSERT_EQ(hashOf(hash).validate(), "");
        pairCount += expected.size();
    }
    EXPECT_GT(pairCount, 10'000U);
}

}  // namespace
}  // namespace hashphase::test
