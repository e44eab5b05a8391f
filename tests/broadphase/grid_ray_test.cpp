// SPDX-License-Identifier: Zlib

// Rays and moving boxes in the cases that break them: along axes, in cell faces, through corners,
// without length, very long, with the smallest numbers, and boxes that are none.

#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace hashphase::test {
namespace {

/// A block of 8 x 8 x 8 unit cubes that touch, each in a cell of its own.
template <class Scalar>
class RayQuery : public testing::Test {
protected:
    using Point = Vector3<Scalar>;

    static constexpr int kSide = 8;

    RayQuery() {
        for (int i = 0; i < kSide * kSide * kSide; ++i) {
            const double x = i % kSide;
            const double y = i / kSide % kSide;
            const double z = i / kSide / kSide;
            block_.add(makeBox<Scalar>(x, y, z, x + 1, y + 1, z + 1));
        }
        block_.update();
    }

    static Point point(double x, double y, double z) {
        return Vector3<double>(x, y, z).cast<Scalar>();
    }
    /// Number found, the same as by brute force.
    std::size_t count(const RayRegion<Scalar>& ray) const {
        return block_.expectLikeBruteForce(ray);
    }
    std::size_t count(const Point& from, const Point& to) const {
        return count(RayRegion<Scalar>(from, to));
    }

    /// The ray and its mirror images in all six orders of the axes.
    void expectCountInAllOrders(std::size_t expected, const Point& from, const Point& to) const {
        std::array<int, 3> order{0, 1, 2};
        do {
            const Point a(from[order[0]], from[order[1]], from[order[2]]);
            const Point b(to[order[0]], to[order[1]], to[order[2]]);
            EXPECT_EQ(count(a, b), expected) << a.transpose() << " to " << b.transpose();
            EXPECT_EQ(count(b, a), expected) << b.transpose() << " to " << a.transpose();
        } while (std::next_permutation(order.begin(), order.end()));
    }

    Population<Scalar> block_{GridConfig{.cellSize = 1}};
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RayQuery, Scalars);

TYPED_TEST(RayQuery, MeetsAllBoxesThatItTouchesAlongAxesInFacesOnEdgesAndThroughCorners) {
    // On a diagonal those whose three numbers differ by one at most.
    std::size_t diagonal = 0;
    for (const auto& proxy : this->block_.proxies) {
        diagonal += proxy.box.min().maxCoeff() - proxy.box.min().minCoeff() <= 1 ? 1U : 0U;
    }
    struct Case {
        std::size_t expected;
        std::array<double, 3> from;
        std::array<double, 3> to;
    };
    const Case cases[] = {
        {8, {-1, 3.5, 4.5}, {9, 3.5, 4.5}},      // a row
        {3, {2.5, 3.5, 4.5}, {4.5, 3.5, 4.5}},   // within
        {0, {-1, 8.5, 4.5}, {9, 8.5, 4.5}},      // beside
        {16, {-1, 3, 4.5}, {9, 3, 4.5}},         // in a face: both sides of it
        {8, {-1, 0, 4.5}, {9, 0, 4.5}},          //
        {8, {-1, 8, 4.5}, {9, 8, 4.5}},          //
        {32, {-1, 3, 4}, {9, 3, 4}},             // along an edge
        {8, {-1, 0, 8}, {9, 0, 8}},              //
        {diagonal, {-1, -1, -1}, {9, 9, 9}},     // through corners
        {diagonal, {0, 0, 0}, {8, 8, 8}},        //
        {44, {-1, -1, 3}, {9, 9, 3}},            // through corners, in a face
        {1, {-1, 3.5, 4.5}, {0, 3.5, 4.5}},      // ends on a face
        {3, {-1, 3.5, 4.5}, {2, 3.5, 4.5}},      //
        {0, {-1, 3.5, 4.5}, {-1e-3, 3.5, 4.5}},  //
        {8, {-1e9, 3.5, 4.5}, {1e9, 3.5, 4.5}},  // a billion cells
    };
    for (const auto& [expected, from, to] : cases) {
        this->expectCountInAllOrders(expected, this->point(from[0], from[1], from[2]),
                                     this->point(to[0], to[1], to[2]));
    }
}

TYPED_TEST(RayQuery, WithoutLengthIsAPoint) {
    const auto at = [this](double x, double y, double z) {
        return this->count(this->point(x, y, z), this->point(x, y, z));
    };
    EXPECT_EQ(at(3.5, 3.5, 3.5), 1U);
    EXPECT_EQ(at(3, 3.5, 3.5), 2U);
    EXPECT_EQ(at(3, 3, 3.5), 4U);
    EXPECT_EQ(at(3, 3, 3), 8U);
    EXPECT_EQ(at(0, 0, 0), 1U);
    EXPECT_EQ(at(-0.5, 3.5, 3.5), 0U);
    EXPECT_EQ(at(1e9, 3.5, 3.5), 0U);
    // And so is one in which only the sign of a zero differs.
    EXPECT_EQ(this->count({3.5, 3.5, 0}, {3.5, 3.5, -TypeParam(0)}), 1U);
}

TYPED_TEST(RayQuery, AMovingBoxMeetsWhatItSweeps) {
    const Aabb<TypeParam> half = makeBox<TypeParam>(-0.75, -0.25, -0.25, 0.75, 0.25, 0.25);
    const auto countAlong = [&](double y, double z) {
        return this->count({this->point(-5, y, z), this->point(20, y, z), half});
    };
    EXPECT_EQ(countAlong(3.5, 3.5), 8U);
    EXPECT_EQ(countAlong(3.25, 3.5), 16U);  // grazes a face
    EXPECT_EQ(countAlong(3, 3), 32U);
    EXPECT_EQ(countAlong(8.25, 3.5), 8U);
    const RayRegion<TypeParam> ray({-5, 3.5, 3.5}, {-0.75, 3.5, 3.5}, half);
    const auto hits = find(this->block_.grid, ray);
    ASSERT_EQ(hits.size(), 1U);
    EXPECT_EQ(hits[0].second, 1);  // the end of the way
    // One that stands still meets what it overlaps.
    const auto at = this->point(4, 4, 4);
    EXPECT_EQ(this->count({at, at, makeBox<TypeParam>(-1, -1, -1, 1, 1, 1)}), 64U);
    EXPECT_EQ(this->count({at, at, makeBox<TypeParam>(-0.5, -0.5, -0.5, 0.5, 0.5, 0.5)}), 8U);
}

TYPED_TEST(RayQuery, TellsTheFractionOfTheWay) {
    CollectClosest<TypeParam> closest;
    this->block_.grid.visit(RayRegion<TypeParam>({-8, 3.5, 4.5}, {8, 3.5, 4.5}), closest);
    EXPECT_EQ(closest.key(), TypeParam(0.5));
    CollectClosest<TypeParam> fromInside;
    this->block_.grid.visit(RayRegion<TypeParam>({3.5, 3.5, 4.5}, {8, 3.5, 4.5}), fromInside);
    EXPECT_EQ(fromInside.key(), 0);
}

TYPED_TEST(RayQuery, MakesAnewWhatWasFreed) {
    Population<TypeParam> world;
    world.add(makeBox<TypeParam>(0, 0, 0, 1, 1, 1));
    world.update();
    for (int round = 0; round < 3; ++round) {
        EXPECT_EQ(world.expectLikeBruteForce(RayRegion<TypeParam>({-1, 0, 0}, {2, 0, 0})), 1U);
        EXPECT_GT(world.grid.rayMemoryBytes(), 0U);
        world.grid.releaseRayMemory();
        EXPECT_EQ(world.grid.rayMemoryBytes(), 0U);
        EXPECT_EQ(world.grid.validate(), "");
        if (round == 1) {
            world.moveTo(0, makeBox<TypeParam>(0, -1, -1, 1, 1, 1));
            world.update();
        }
    }
}

// --- Long rays, and numbers at the ends of what there is -----------------------------------------

TYPED_TEST(RayQuery, OfAnyLengthCostsNoMoreThanAllBoxes) {
    // Slanted: a billion cells along one axis, eight along another.
    EXPECT_GT(this->count({0, 0, TypeParam(3.5)}, {TypeParam(1e9), TypeParam(1e9), 4}), 7U);
    for (const double length : {1e5, 3.4e7, 1e9, 1e12, 1e18, 1e19}) {
        SCOPED_TRACE(testing::Message() << "length " << length);
        CollectCount found;
        const QueryCost cost = this->block_.grid.visit(
            RayRegion<TypeParam>(this->point(-length, 3.5, 4.5), this->point(length, 3.5, 4.5)),
            found);
        EXPECT_EQ(found.count(), 8U);
        EXPECT_LE(cost.rowsVisited, 512U);
        EXPECT_LE(cost.boxesTested, 512U);
    }
}

TYPED_TEST(RayQuery, MeetsBoxesAllAlongAVeryLongWay) {
    Population<TypeParam> world(GridConfig{.cellSize = 1});
    const Vector3<double> direction(1, 0.37, -0.011);
    for (int i = 0; i < 3000; ++i) {
        const double along = 100'000.0 / 3 * i;
        Vector3<double> center = direction * along;
        const Vector3<double> half(0.5, 0.5 + 4e-8 * along, 0.5 + 4e-8 * along);
        center[2] += i % 3 == 2 ? 8 * half[2] : 0;  // every third stands aside
        world.add(boxAround<TypeParam>(center, half));
    }
    world.update();
    const Vector3<TypeParam> end = Vector3<double>(direction * 1e8).cast<TypeParam>();
    const std::size_t count =
        world.expectLikeBruteForce(RayRegion<TypeParam>(Vector3<TypeParam>::Zero(), end));
    EXPECT_GT(count, 1900U);
    EXPECT_LE(count, 2000U);
}

TYPED_TEST(RayQuery, WithADirectionTooSmallToInvertMeetsWhatItTouches) {
    using Limits = std::numeric_limits<TypeParam>;
    for (const TypeParam tiny : {Limits::denorm_min(), Limits::min(), -Limits::denorm_min()}) {
        // It starts in a face: the two sides of it, all the way up.
        EXPECT_EQ(this->count({0, 3.5, -1}, {tiny, 3.5, 9}), 8U);
        EXPECT_EQ(this->count({0, 0, -1}, {tiny, tiny, 9}), 8U);
    }
}

TYPED_TEST(RayQuery, MissesInvertedBoxesWhateverItsDirection) {
    Population<TypeParam> world;
    world.add(makeBox<TypeParam>(1, 1, 1, 0, 0, 0));
    for (const Vector3<double>& to :
         {Vector3<double>(0.5, 0.5, 9), Vector3<double>(1, 1, 1), Vector3<double>(0.5, 1, 2)}) {
        const RayRegion<TypeParam> ray(this->point(0.5, 0.5, -9), to.cast<TypeParam>());
        EXPECT_EQ(world.expectLikeBruteForce(ray), 0U);
    }
}

// --- Precision of the key ------------------------------------------------------------------------

/// Slabs in extended precision, for boxes that are not inverted. Returns the interval of t.
template <class Scalar>
std::pair<long double, long double> slabs(const Vector3<Scalar>& from, const Vector3<Scalar>& to,
                                          const Aabb<Scalar>& box) {
    long double enter = 0;
    long double leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
        // As RayRegion has it, the direction is a rounded difference.
        const long double direction = static_cast<Scalar>(to[axis] - from[axis]);
        const long double low = static_cast<long double>(box.min()[axis]) - from[axis];
        const long double high = static_cast<long double>(box.max()[axis]) - from[axis];
        if (direction == 0) {
            if (low > 0 || high < 0) {
                return {1, 0};
            }
            continue;
        }
        enter = std::max(enter, std::min(low / direction, high / direction));
        leave = std::min(leave, std::max(low / direction, high / direction));
    }
    return {enter, leave};
}

TYPED_TEST(RayQuery, KeyMissesNothingAndIsTheFractionOfTheWay) {
    Random random(0x5eed0601);
    constexpr long double epsilon = std::numeric_limits<TypeParam>::epsilon();
    int hits = 0;
    int grazes = 0;
    for (int i = 0; i < 200000; ++i) {
        const double offset = i % 2 == 0 ? 0 : 1000;
        const Aabb<TypeParam> box = boxesIn<TypeParam>(offset - 4, offset + 4, 0, 2)(random);
        const Vector3<TypeParam> from = random.pointIn(offset - 9, offset + 9).cast<TypeParam>();
        Vector3<TypeParam> to = random.pointIn(offset - 9, offset + 9).cast<TypeParam>();
        if (i % 3 == 0) {
            // Through an edge: as close a call as there is.
            Vector3<TypeParam> edge = box.min();
            edge[random.below(3)] = box.center()[0];
            to = from + 2 * (edge - from);
        }
        const TypeParam key = RayRegion<TypeParam>(from, to).key(box);
        const auto [enter, leave] = slabs(from, to, box);
        const bool touches = enter <= leave;
        ASSERT_TRUE(key >= 0 || !touches)
            << from.transpose() << " to " << to.transpose() << " misses " << box.min().transpose()
            << ", " << box.max().transpose();
        if (key >= 0) {
            ++hits;
            grazes += touches ? 0 : 1;
            ASSERT_LE(enter, leave + 16 * epsilon);
            ASSERT_LE(std::abs(key - enter), 8 * epsilon);
        }
    }
    EXPECT_GT(hits, 20000);
    EXPECT_LT(grazes, hits / 10);
}

TYPED_TEST(RayQuery, AnswersTheSameFarFromTheOrigin) {
    // Everything but the fatness is a multiple of 1/8, exact at 2^20 in float, too.
    Random random(0x5eed0602);
    const auto eighths = [&random](double low, double high) {
        return Vector3<double>((random.pointIn(low, high) * 8).array().round() / 8);
    };
    const Aabb<TypeParam> fatness = makeBox<TypeParam>(-0.3, -0.7, -0.1, 0.3, 0.7, 0.1);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vector3<double> low = eighths(-4, 4);
        const Vector3<double> high = low + eighths(0, 3);
        const Vector3<double> from = eighths(-9, 9);
        const Vector3<double> to = eighths(-9, 9);
        const auto keyAway = [&](double away) {
            const auto at = [away](const Vector3<double>& x) {
                return Vector3<TypeParam>((x.array() + away).matrix().template cast<TypeParam>());
            };
            return RayRegion<TypeParam>(at(from), at(to), fatness)
                .key(Aabb<TypeParam>(at(low), at(high)));
        };
        const TypeParam here = keyAway(0);
        hits += here >= 0 ? 1 : 0;
        ASSERT_EQ(keyAway(1 << 20), here) << from.transpose() << " to " << to.transpose();
    }
    EXPECT_GT(hits, 500);
}

}  // namespace
}  // namespace hashphase::test
