// SPDX-License-Identifier: Zlib
//
// Boxes that have broken broadphases, as Bullet hands them in: a plane's, those of bodies that
// Bullet takes out of the simulation, thousands at one place, none at all.

#include <tests/integration/bullet/box_commands.hpp>
#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/dynamics.hpp>
#include <tests/support/denormal_mode.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

SpatialHashConfig cellsOf(double size) {
    SpatialHashConfig config;
    config.grid.cellSize = size;
    return config;
}

/// In cells of each size, of which 0 is the automatic one, the pairs are those of brute force.
/// Returns how many there are.
std::size_t expectPairsOfBruteForce(const std::vector<Box>& boxes,
                                    const std::vector<btScalar>& cellSizes = {1, 0}) {
    const int count = static_cast<int>(boxes.size());
    Truth truth(count);
    for (int object = 0; object < count; ++object) {
        truth.play({createCommand(object, boxes[static_cast<std::size_t>(object)])});
    }
    const ObjectPairs expected = truth.pairs();
    EXPECT_GT(expected.size(), 30U);
    for (const btScalar cellSize : cellSizes) {
        Player player = hashPlayer(count, nullptr, cellsOf(static_cast<double>(cellSize)));
        for (int object = 0; object < count; ++object) {
            player.play(createCommand(object, boxes[static_cast<std::size_t>(object)]));
        }
        player.calculate();
        EXPECT_EQ(difference(player.pairs(), expected), "") << "cells of " << cellSize;
        EXPECT_EQ(hashOf(player).validate(), "");
    }
    return expected.size();
}

TEST(HardBoxes, BeyondAllCellsPairAsBruteForceSays) {
    std::vector<Box> boxes(40, kUnit);
    for (int axis = 0; axis < 3; ++axis) {
        for (const btScalar far : {btScalar(3e9), BT_LARGE_FLOAT, kInfinity}) {
            for (const btScalar x : {far, -far}) {
                Box box = kUnit;
                box.min[axis] = box.max[axis] = x;
                boxes.push_back(box);
                box.min[axis] = std::min<btScalar>(x, 0);
                box.max[axis] = std::max<btScalar>(x, 0);
                boxes.push_back(box);
            }
        }
    }
    expectPairsOfBruteForce(boxes);
}

TEST(HardBoxes, WithoutExtentOfBothZeroesAndInsideOutPairAsBruteForceSays) {
    std::vector<Box> boxes(20, Box{{0, 0, 0}, {0, 0, 0}});
    for (int i = 0; i < 40; ++i) {
        const btScalar zero = i % 2 == 0 ? btScalar(0) : btScalar(-0.0);
        boxes.push_back({{zero, zero, zero}, {1, 1, 1}});
        boxes.push_back({{-1, -1, -1}, {zero, zero, zero}});
        boxes.push_back({{1, 1, 1}, {-1, -1, btScalar(i)}});
    }
    expectPairsOfBruteForce(boxes);
}

TEST(HardBoxes, OfDenormalNumbersPairAsTheProcessorComparesThem) {
    if (!DenormalMode::kIsKnown) {
        GTEST_SKIP() << "it is not known how to set the mode of this processor";
    }
    BulletRandom random(78);
    const btScalar unit = std::numeric_limits<btScalar>::min() / 4096;
    std::vector<Box> boxes;
    for (int i = 0; i < 120; ++i) {
        btVector3 low;
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = btScalar(random.below(4000) - 2000) * unit;
        }
        boxes.push_back({low, low + btVector3(900 * unit, 900 * unit, 900 * unit)});
    }
    std::vector<std::size_t> counts;
    for (const bool isFlushed : {false, true}) {
        SCOPED_TRACE(isFlushed);
        const DenormalMode mode(isFlushed);
        counts.push_back(expectPairsOfBruteForce(boxes));
    }
    EXPECT_EQ(counts[1], 120U * 119 / 2) << "all at zero";
    EXPECT_LT(counts[0], counts[1] / 2);
}

// k * cell as rounded, and an ulp below and above, along each axis.
TEST(HardBoxes, OnTheBordersOfCellsPairAsBruteForceSays) {
    constexpr int kBorders = 80;
    for (int size = 1; size <= 50; ++size) {
        const auto cell = static_cast<btScalar>(0.1 * size * size);
        SCOPED_TRACE(cell);
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<Box> boxes;
            const auto add = [&](btScalar low, btScalar high) {
                Box box{{0, 0, 0}, {0, 0, 0}};
                box.min[axis] = low;
                box.max[axis] = high;
                boxes.push_back(box);
            };
            for (int k = size - kBorders / 2; k < size + kBorders / 2; ++k) {
                const btScalar border = btScalar(k) * cell;
                const btScalar below = std::nextafter(border, -kInfinity);
                const btScalar above = std::nextafter(border, kInfinity);
                add(border, btScalar(k + 1) * cell);
                add(below, below);
                add(above, above);
            }
            expectPairsOfBruteForce(boxes, {cell});
        }
    }
}

TEST(HardBoxes, OfAPlanePairWithEverybodyAtTheCostOfOneTestEach) {
    constexpr int kBoxes = 1000;
    BulletRandom random(77);
    Frame frame;
    for (int object = 0; object < kBoxes; ++object) {
        frame.push_back(createCommand(object, boxAround(random.vector(-20, 20), {1, 1, 1})));
    }
    Player without = hashPlayer(kBoxes + 1);
    without.play(frame);
    without.calculate();

    const btStaticPlaneShape plane({0, 1, 0}, 0);
    Box box;
    plane.getAabb(btTransform::getIdentity(), box.min, box.max);
    frame.push_back(createCommand(kBoxes, box));
    Player with = hashPlayer(kBoxes + 1);
    with.play(frame);
    with.calculate();
    EXPECT_EQ(with.pairs().size(), without.pairs().size() + kBoxes);
    EXPECT_LE(hashOf(with).lastCost().boxesTested,
              hashOf(without).lastCost().boxesTested + kBoxes + kBoxes / 20);
}

TEST(HardBoxes, AtOnePlaceAreAllPairsAndNoneOnceApart) {
    constexpr int kCopies = 2000;
    constexpr int kPairs = 1'999'000;
    SpatialHashBroadphase broadphase;
    std::vector<ProxyDefinition> definitions(
        kCopies, {kUnit.min, kUnit.max, nullptr, btBroadphaseProxy::DefaultFilter,
                  btBroadphaseProxy::AllFilter});
    std::vector<btBroadphaseProxy*> proxies(kCopies);
    broadphase.createProxies(definitions, proxies, nullptr);
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), kPairs);
    EXPECT_LT(broadphase.memoryBytes(), std::size_t{200} * kPairs);
    for (int i = 0; i < kCopies; ++i) {
        const btVector3 away(btScalar(9 * i), 0, 0);
        broadphase.setAabb(proxies[static_cast<std::size_t>(i)], kUnit.min + away, kUnit.max + away,
                           nullptr);
    }
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 0);
    EXPECT_EQ(broadphase.validate(), "");
}

TEST(HardBoxes, OfNobodyOrOneOrOnlyStraysAreNoPairs) {
    for (const int count : {0, 1, 40}) {
        Player player = hashPlayer(count + 2);
        for (int object = 0; object < count; ++object) {
            const btScalar far = BT_LARGE_FLOAT * btScalar(object + 1);
            player.play(createCommand(object, {{far, -far, far}, {far, -far, far}}));
        }
        for (int frame = 0; frame < 12; ++frame) {
            player.calculate();
            EXPECT_EQ(player.pairs(), ObjectPairs{});
        }
        // Two that touch are a pair all the same.
        player.play({createCommand(count, kUnit), createCommand(count + 1, kUnit)});
        for (int frame = 0; frame < 12; ++frame) {
            player.calculate();
            EXPECT_EQ(player.pairs(), (ObjectPairs{{count, count + 1}}));
        }
        EXPECT_EQ(hashOf(player).validate(), "");
    }
}

static_assert(PairCache::kMostPairs - 1 <= std::size_t{std::numeric_limits<int>::max()} / 2,
              "an array of so many pairs doubles its room");

// --- What Bullet takes out of the simulation -----------------------------------------------------

/// Falling spheres on ground, and a body of its own making among them.
struct WorldWithABody {
    DynamicsWorld world;
    int body;

    WorldWithABody(std::unique_ptr<btBroadphaseInterface> broadphase, btScalar halfExtent,
                   btScalar mass, btScalar x)
        : world(std::move(broadphase)) {
        const auto at = [](btScalar px, btScalar y) {
            return btTransform(btQuaternion(0, 0, 0, 1), {px, y, 0});
        };
        btCollisionShape* const ground =
            world.keep(std::make_unique<btBoxShape>(btVector3(50, 1, 50)));
        btCollisionShape* const sphere = world.keep(std::make_unique<btSphereShape>(btScalar(1)));
        world.add(ground, 0, at(0, -1));
        for (int i = 0; i < 10; ++i) {
            world.add(sphere, 1, at(btScalar(4 * i - 20), 2));
        }
        btCollisionShape* const box =
            world.keep(std::make_unique<btBoxShape>(btVector3(halfExtent, halfExtent, halfExtent)));
        body = world.add(box, mass, at(x, btScalar(1e6)));
    }

    [[nodiscard]] std::vector<std::pair<int, int>> pairs() {
        std::vector<std::pair<int, int>> pairs;
        const btBroadphasePairArray& array =
            world.broadphase().getOverlappingPairCache()->getOverlappingPairArray();
        for (int i = 0; i < array.size(); ++i) {
            const auto numberOf = [](const btBroadphaseProxy* proxy) {
                return static_cast<btCollisionObject*>(proxy->m_clientObject)->getUserIndex();
            };
            pairs.push_back(
                std::minmax(numberOf(array[i].m_pProxy0), numberOf(array[i].m_pProxy1)));
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }
};

/// The body is in the same state after some steps, and so are the others, over both broadphases.
void expectSameOutcome(btScalar halfExtent, btScalar mass, btScalar x, bool isDisabled) {
    WorldWithABody hash(std::make_unique<SpatialHashBroadphase>(), halfExtent, mass, x);
    WorldWithABody dbvt(std::make_unique<btDbvtBroadphase>(), halfExtent, mass, x);
    for (int step = 0; step < 90; ++step) {
        hash.world.step();
        dbvt.world.step();
        for (WorldWithABody* each : {&hash, &dbvt}) {
            const btRigidBody& body = each->world.body(each->body);
            EXPECT_EQ(body.getActivationState() == DISABLE_SIMULATION, isDisabled);
        }
    }
    EXPECT_EQ(firstDifferentBody(hash.world, dbvt.world), -1);
    const auto tree = dbvt.pairs();
    for (const auto& pair : hash.pairs()) {
        EXPECT_TRUE(std::binary_search(tree.begin(), tree.end(), pair));
    }
    EXPECT_EQ(hash.pairs().size(), 10U) << "each sphere with the ground";
    EXPECT_LT(hash.world.body(5).getWorldTransform().getOrigin().y(), btScalar(1.1)) << "landed";
}

// Bullet's bound is a diagonal of 1e6.
TEST(HardBodies, WhoseBoxesAreTooLargeAreDisabledAsOverBtDbvtBroadphase) {
    expectSameOutcome(btScalar(4e5), 1, 0, true);
    expectSameOutcome(btScalar(2.8e5), 1, 0, false);
    expectSameOutcome(btScalar(4e5), 0, 0, false);  // static ones are let in
}

TEST(HardBodies, WhoseBoxesAreNoNumbersAreDisabledUnlessTheyAreStatic) {
    for (const btScalar mass : {btScalar(1), btScalar(0)}) {
        const CaughtMessages messages;
        WorldWithABody hash(std::make_unique<SpatialHashBroadphase>(), 1, mass, kNan);
        const auto& broadphase = static_cast<SpatialHashBroadphase&>(hash.world.broadphase());
        for (int step = 0; step < 90; ++step) {
            hash.world.step();
        }
        EXPECT_EQ(hash.world.body(hash.body).getActivationState() == DISABLE_SIMULATION, mass > 0);
        EXPECT_EQ(broadphase.grid().nanCount(), 1U);
        EXPECT_EQ(messages.all().size(), 1U) << "reported";
        EXPECT_EQ(hash.pairs().size(), 10U);

        WorldWithABody without(std::make_unique<SpatialHashBroadphase>(), 1, mass, btScalar(1e9));
        for (int step = 0; step < 90; ++step) {
            without.world.step();
        }
        EXPECT_EQ(firstDifferentBody(hash.world, without.world), hash.body) << "and no other";
    }
}

}  // namespace
}  // namespace hashphase::test
