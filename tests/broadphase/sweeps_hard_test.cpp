// SPDX-License-Identifier: Zlib

// Sweeps where rounding, infinities and strays could mislead the search.

#include <broadphase/position_region.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/bullet_world.hpp>
#include <tests/support/oracles.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class HardSweeps : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(HardSweeps, Scalars);

template <class Scalar>
Aabb<Scalar> cubeAt(Scalar x) {
    return {Vector3<Scalar>(x, 0, 0), Vector3<Scalar>(x + 1, 1, 1)};
}

/// Two boxes by their numbers, lower one first.
using NumberPair = std::pair<std::uint32_t, std::uint32_t>;

/// All pairs by firstContact(), sorted; the first boxes sweep.
template <class Scalar>
std::vector<NumberPair> pairsOf(const Bullets<Scalar>& bullets) {
    const auto moving = [&](std::size_t i) {
        return i < bullets.ways.size() ? MovingBox<Scalar>{bullets.boxes[i], bullets.ways[i]}
                                       : MovingBox<Scalar>{bullets.boxes[i]};
    };
    std::vector<NumberPair> pairs;
    for (std::uint32_t i = 0; i < bullets.boxes.size(); ++i) {
        for (std::uint32_t j = i + 1; j < bullets.boxes.size(); ++j) {
            const bool sweeps = i < bullets.ways.size() || j < bullets.ways.size();
            if (overlaps(bullets.boxes[i], bullets.boxes[j]) ||
                (sweeps && firstContact(moving(i), moving(j)))) {
                pairs.emplace_back(i, j);
            }
        }
    }
    return pairs;
}

/// Proxies of a grid from which none was removed are numbered as they were added.
std::vector<NumberPair> numbersOf(const std::vector<ProxyPair>& pairs) {
    std::vector<NumberPair> numbers;
    for (const ProxyPair& pair : pairs) {
        numbers.emplace_back(pair.first.index, pair.second.index);
    }
    return numbers;
}

/// In each mode, one update makes these pairs. Returns what each takes, in tests.
template <class Scalar>
std::array<std::uint64_t, kSweepModes.size()> expectPairs(const Bullets<Scalar>& bullets,
                                                          const std::vector<NumberPair>& expected,
                                                          const GridConfig& config = {}) {
    std::array<std::uint64_t, kSweepModes.size()> tests{};
    for (std::size_t i = 0; i < kSweepModes.size(); ++i) {
        BulletWorld<Scalar> world(bullets, kSweepModes[i], config);
        EXPECT_EQ(differences(numbersOf(world.update()), expected), "") << "mode " << i;
        const SweepCost& cost = world.sweeps.lastCost();
        EXPECT_LE(cost.segments, 40 * bullets.ways.size());
        tests[i] = cost.boxesTested + cost.contactsTested;
    }
    return tests;
}

/// A box and its way, and another box that it touches for a moment, by an edge: along one axis it
/// leaves it when along another one it arrives, at a time that is rounded.
template <class Scalar>
struct Graze {
    MovingBox<Scalar> mover;
    Aabb<Scalar> other;

    Graze(const Vector3<Scalar>& where, Random& random) {
        const auto draw = [&](std::uint32_t count) {
            return static_cast<Scalar>(1 + random.below(count));
        };
        const Scalar parts = draw(30);
        const Scalar passed = draw(static_cast<std::uint32_t>(parts));
        const Vector3<Scalar> step(draw(9), draw(9), draw(9) - 5);
        const Vector3<Scalar> way = passed * step;
        mover = {{where, where + Vector3<Scalar>(1, 1, 40)}, parts * step};
        other = {where + Vector3<Scalar>(way[0] - 3, 1 + way[1], way[2] + 1),
                 where + Vector3<Scalar>(way[0], 3 + way[1], way[2] + 2)};
    }
};

TYPED_TEST(HardSweeps, MissNothingThatTheyJustGraze) {
    Random random(0x5eed0d0a);
    for (const Sweep mode : kSweepModes) {
        Grid<TypeParam> grid;
        Sweeps<TypeParam> sweeps(grid);
        Pairs<TypeParam> pairs(grid, &sweeps);
        std::vector<NumberPair> expected;
        for (TypeParam x = 0; x < 12; ++x) {
            for (TypeParam y = 0; y < 12; ++y) {
                for (TypeParam z = 0; z < 12; ++z) {
                    const Graze<TypeParam> graze(Vector3<TypeParam>(x, y, z) * 1000, random);
                    sweeps.set(grid.add(graze.mover.box), graze.mover.displacement, mode);
                    const std::uint32_t other = grid.add(graze.other).index;
                    expected.emplace_back(other - 1, other);
                }
            }
        }
        pairs.update([](ProxyId, ProxyId) { return true; });
        std::vector<ProxyPair> all;
        pairs.collect(all);
        EXPECT_EQ(differences(numbersOf(all), expected), "");
    }
}

// Infinite corners, inverted boxes: differences of coordinates need not be numbers.
TYPED_TEST(HardSweeps, MissNothingAtInfinity) {
    using Scalar = TypeParam;
    constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();
    const auto boxOf = [](Vector3<Scalar> low, Vector3<Scalar> high) {
        return Aabb<Scalar>(low, high);
    };
    Bullets<Scalar> high;
    high.boxes = {boxOf({8, kInfinity, 3}, {8.25F, kInfinity, 4.5F}),
                  boxOf({8, -4, 5.5F}, {10, kInfinity, 6})};
    high.ways = {{0, 10, 9.5F}};
    Bullets<Scalar> inverted;
    inverted.boxes = {boxOf({-9, -7, kInfinity}, {-8.5F, -5, 1e6F}),
                      boxOf({0, 1e37F, 0}, {1, 2e38F, kInfinity})};
    inverted.ways = {{10, 1.7e38F, -1e6F}};
    for (const Bullets<Scalar>& bullets : {high, inverted}) {
        const std::vector<NumberPair> one{{0, 1}};
        ASSERT_EQ(pairsOf(bullets), one);
        expectPairs(bullets, one);
    }
}

// A crowd far away decides where cells are counted from: here their numbers have as many digits as a
// coordinate, and what lies at the edge of the world may be filed some cells farther in.
TYPED_TEST(HardSweeps, MissNothingWhereCellsAreRounded) {
    using Scalar = TypeParam;
    GridConfig config;
    config.cellSize = 1;
    for (const double shift : {0.0, 3.0, 6.0, 9.0, 12.0}) {
        Random random(0x5eed0d0b);
        Bullets<Scalar> bullets;
        for (int i = 0; i < 100; ++i) {
            const Vector3<double> from(80, random.between(-10, 10), random.between(-10, 10));
            bullets.boxes.push_back(boxAround<Scalar>(from, {0.45, 0.45, 0.45}));
            bullets.ways.push_back(Vector3<Scalar>(-200, 0.01F, 0));
        }
        for (int i = 0; i < 300; ++i) {
            const Vector3<double> at = random.pointIn({0, -10, -10}, {40, 10, 10});
            bullets.boxes.push_back(
                boxAround<Scalar>(at + Vector3<double>(shift, 0, 0), {0.45, 0.45, 0.45}));
        }
        const std::vector<NumberPair> expected = pairsOf(bullets);
        EXPECT_GT(expected.size(), 200U);
        for (int i = 0; i < 3000; ++i) {
            bullets.boxes.push_back(
                boxAround<Scalar>(Vector3<double>(2e8, 10 * i, 1000), {0.5, 0.5, 0.5}));
        }
        SCOPED_TRACE(shift);
        expectPairs(bullets, expected, config);
    }
}

// A body that has fallen out of the world, and one that is larger than it.
TYPED_TEST(HardSweeps, CostTheSameBesideAStray) {
    Random random(0x5eed0d0c);
    const Bullets<TypeParam> bullets(2000, 2000, 25, random);
    BulletWorld<TypeParam> alone(bullets, Sweep::automatic);
    alone.update();
    const SweepCost usual = alone.sweeps.lastCost();
    Bullets<TypeParam> withStray = bullets;
    withStray.boxes.push_back(boxAround<TypeParam>({0, -1e6, 0}, {0.5, 0.5, 0.5}));
    withStray.ways.push_back(Vector3<TypeParam>(0, -100, 0));
    Bullets<TypeParam> withGiant = bullets;
    withGiant.boxes.push_back(boxAround<TypeParam>({0, -2e4, 0}, {1e4, 1e4, 1e4}));
    withGiant.ways.push_back(Vector3<TypeParam>(0, 0, 1e4));
    for (const Bullets<TypeParam>& some : {withStray, withGiant}) {
        BulletWorld<TypeParam> world(some, Sweep::automatic);
        world.update();
        const SweepCost& cost = world.sweeps.lastCost();
        EXPECT_LE(cost.contactsTested, usual.contactsTested * 5 / 4);
        EXPECT_LE(cost.boxesTested, usual.boxesTested * 5 / 4);
    }
}

// For three that fly far, a tree over everything is not worth while.
TYPED_TEST(HardSweeps, TakeRaysOnlyWhereThereAreManyForTheTree) {
    Random random(0x5eed0d0d);
    for (const std::uint32_t sweeping : {3U, 300U}) {
        Bullets<TypeParam> bullets(20'000, sweeping, 1, random);
        bullets.ways.assign(sweeping, {4000, 4000, 4000});
        bullets.boxes.push_back(boxAround<TypeParam>({1e4, 1e4, 1e4}, {0.5, 0.5, 0.5}));
        BulletWorld<TypeParam> world(bullets, Sweep::line);
        world.update();
        EXPECT_EQ(world.sweeps.lastCost().rays, sweeping == 3 ? 0U : 300U);
    }
}

TYPED_TEST(HardSweeps, AreFoundWhereTheyStandByWhateverAsks) {
    Bullets<TypeParam> bullets;
    bullets.boxes = {cubeAt<TypeParam>(0)};
    bullets.ways = {{100, 0, 0}};
    for (const Sweep mode : kSweepModes) {
        const BulletWorld<TypeParam> world(bullets, mode);
        std::vector<ProxyId> found;
        CollectAll collector(found);
        world.sweeps.visit(PositionRegion<TypeParam>({0.5, 0.5, 0.5}, 2), collector);
        EXPECT_EQ(found.size(), 1U);
    }
}

// Less than a coordinate can be changed by: as standing still, but for what is nearer than that.
TYPED_TEST(HardSweeps, OfLessThanAnUlpTouchWhatIsWithinThem) {
    using Limits = std::numeric_limits<TypeParam>;
    const TypeParam face = 1000;
    const TypeParam ulp = std::nextafter(face, Limits::max()) - face;
    struct Case {
        TypeParam gap;
        TypeParam way;
        std::size_t pairs;
    };
    for (const Case& one :
         {Case{0, 0, 1}, Case{ulp, 0, 0}, Case{0, ulp / 8, 1}, Case{0, -ulp / 8, 1},
          Case{ulp, ulp / 8, 0}, Case{ulp, ulp, 1}, Case{ulp, ulp * 7 / 8, 0},
          Case{0, Limits::denorm_min(), 1}, Case{ulp, Limits::min(), 0}}) {
        Bullets<TypeParam> bullets;
        bullets.boxes = {
            {Vector3<TypeParam>(face - 1, 0, 0), Vector3<TypeParam>(face, 1, 1)},
            {Vector3<TypeParam>(face + one.gap, 0, 0), Vector3<TypeParam>(face + 1, 1, 1)}};
        bullets.ways = {{one.way, 0, 0}};
        SCOPED_TRACE(testing::Message() << one.gap << ", " << one.way);
        const std::vector<NumberPair> expected = pairsOf(bullets);
        ASSERT_EQ(expected.size(), one.pairs);
        expectPairs(bullets, expected);
    }
}

// Two movers that cross, neither where the other one begins or ends; that touch at the first moment or
// at the last one only; and that pass at -1, 0 and 1 ulp.
TYPED_TEST(HardSweeps, FindInEveryModeWhatTouchesForAMoment) {
    using Limits = std::numeric_limits<TypeParam>;
    const auto countOf = [](Vector3<TypeParam> wayA, TypeParam atB, TypeParam heightB,
                            Vector3<TypeParam> wayB) {
        Bullets<TypeParam> bullets;
        bullets.boxes = {
            cubeAt<TypeParam>(0),
            {Vector3<TypeParam>(atB, heightB, 0), Vector3<TypeParam>(atB + 1, heightB + 1, 1)}};
        bullets.ways = {wayA, wayB};
        const std::vector<NumberPair> expected = pairsOf(bullets);
        expectPairs(bullets, expected);
        return expected.size();
    };
    const TypeParam above = std::nextafter(TypeParam(1), TypeParam(2));
    const TypeParam below = std::nextafter(TypeParam(1), TypeParam(0));
    EXPECT_EQ(countOf({40, 0, 0}, 30, 0, {-40, 0, 0}), 1U) << "they cross";
    EXPECT_EQ(countOf({40, 0, 0}, 30, 0, {40, 0, 0}), 0U) << "they keep their distance";
    EXPECT_EQ(countOf({-9, 0, 0}, 1, 0, {9, 0, 0}), 1U) << "at the first moment";
    EXPECT_EQ(countOf({-9, 0, 0}, above, 0, {9, 0, 0}), 0U);
    EXPECT_EQ(countOf({9, 0, 0}, 17, 0, {-7, 0, 0}), 1U) << "at the last moment";
    EXPECT_EQ(countOf({9, 0, 0}, std::nextafter(TypeParam(17), Limits::max()), 0, {-7, 0, 0}), 0U);
    EXPECT_EQ(countOf({40, 0, 0}, 30, below, {-40, 0, 0}), 1U) << "grazing, an ulp inside";
    EXPECT_EQ(countOf({40, 0, 0}, 30, 1, {-40, 0, 0}), 1U);
    EXPECT_EQ(countOf({40, 0, 0}, 30, above, {-40, 0, 0}), 0U);
}

// A million cells in a step, and across the world; what is on the straight way is met, nothing else, at
// a cost that does not follow the way.
TYPED_TEST(HardSweeps, ThatTeleportMeetWhatIsOnTheStraightWay) {
    GridConfig config;
    config.cellSize = 1;
    std::array<std::uint64_t, kSweepModes.size()> testsOfShortWays{};
    for (const double length : {1e6, 2e9}) {
        SCOPED_TRACE(length);
        Random random(0x5eed0d0e);
        Bullets<TypeParam> bullets;
        for (int i = 0; i < 40; ++i) {
            const Vector3<double> at = random.pointIn(-9, 9);
            bullets.boxes.push_back(boxAround<TypeParam>(at, {0.5, 0.5, 0.5}));
            const Vector3<double> way =
                random.pointIn({0.5, -0.02, -0.02}, {1, 0.02, 0.02}) * length;
            bullets.ways.push_back(way.template cast<TypeParam>());
        }
        for (int i = 0; i < 600; ++i) {
            // Half where they start, the others along the ways of some.
            const auto mover = static_cast<std::size_t>(i % 40);
            const double share = i % 2 == 0 ? 0 : random.unit();
            const Vector3<double> at = bullets.boxes[mover].center().template cast<double>() +
                                       share * bullets.ways[mover].template cast<double>() +
                                       random.pointIn(-9, 9);
            bullets.boxes.push_back(boxAround<TypeParam>(at, {2, 2, 2}));
        }
        const std::vector<NumberPair> expected = pairsOf(bullets);
        EXPECT_GT(expected.size(), 100U);
        const auto tests = expectPairs(bullets, expected, config);
        for (std::size_t mode = 0; mode < tests.size(); ++mode) {
            EXPECT_LE(tests[mode], 90'000U) << "mode " << mode;
            if (length > 1e6) {
                EXPECT_LE(4 * tests[mode], 5 * testsOfShortWays[mode]) << "mode " << mode;
            }
        }
        testsOfShortWays = tests;
    }
}

// What a proxy has met on its way and the filter has refused, is asked about again at once.
TYPED_TEST(HardSweeps, AreFilteredAgainAtOnce) {
    Bullets<TypeParam> bullets;
    bullets.boxes = {cubeAt<TypeParam>(0), cubeAt<TypeParam>(5)};
    bullets.ways = {{10, 0, 0}};
    BulletWorld<TypeParam> world(bullets, Sweep::line);
    world.pairs.update([](ProxyId, ProxyId) { return false; });
    EXPECT_EQ(world.pairs.refusedCount(), 1U);
    const auto yes = [](ProxyId, ProxyId) { return true; };
    EXPECT_EQ(world.pairs.refilter(world.ids[1], yes).born.size(), 1U);
    EXPECT_EQ(world.pairs.validate(), "");
    const PairChanges next = world.pairs.update(yes);
    EXPECT_TRUE(next.born.empty());
    EXPECT_TRUE(next.died.empty());
}

}  // namespace
}  // namespace hashphase::test
