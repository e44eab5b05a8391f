// SPDX-License-Identifier: Zlib

// Rays and moving boxes in the cases that break them: along axes, in cell faces, through corners,
// without length, very long, with the smallest numbers, and boxes that are none.

#include <tests/support/box_scenes.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class RayQuery : public testing::Test {
protected:
    using Point = Vector3<Scalar>;

    static constexpr int kSide = 8;

    static Point point(double x, double y, double z) {
        return Vector3<double>(x, y, z).cast<Scalar>();
    }

    RayQuery() : grid_(unitCells()) {
        // A block of unit cubes that touch, each in a cell of its own.
        for (int i = 0; i < kSide * kSide * kSide; ++i) {
            const double x = i % kSide;
            const double y = i / kSide % kSide;
            const double z = i / kSide / kSide;
            const Aabb<Scalar> box = makeBox<Scalar>(x, y, z, x + 1, y + 1, z + 1);
            proxies_.push_back({grid_.add(box), box});
        }
        grid_.update();
    }

    /// Number found, the same as by brute force.
    std::size_t count(const RayRegion<Scalar>& ray) const {
        return expectLikeBruteForce<Scalar>(grid_, proxies_, ray);
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

    Grid<Scalar> grid_;
    std::vector<Placed<Scalar>> proxies_;

private:
    static GridConfig unitCells() {
        GridConfig config;
        config.cellSize = 1;
        return config;
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RayQuery, Scalars);

TYPED_TEST(RayQuery, AlongAnAxisMeetsTheBoxesOfItsRow) {
    this->expectCountInAllOrders(8, this->point(-1, 3.5, 4.5), this->point(9, 3.5, 4.5));
    this->expectCountInAllOrders(3, this->point(2.5, 3.5, 4.5), this->point(4.5, 3.5, 4.5));
    this->expectCountInAllOrders(0, this->point(-1, 8.5, 4.5), this->point(9, 8.5, 4.5));
}

TYPED_TEST(RayQuery, InAFaceMeetsTheBoxesOnBothSides) {
    this->expectCountInAllOrders(16, this->point(-1, 3, 4.5), this->point(9, 3, 4.5));
    this->expectCountInAllOrders(8, this->point(-1, 0, 4.5), this->point(9, 0, 4.5));
    this->expectCountInAllOrders(8, this->point(-1, 8, 4.5), this->point(9, 8, 4.5));
}

TYPED_TEST(RayQuery, AlongAnEdgeMeetsTheBoxesAroundIt) {
    this->expectCountInAllOrders(32, this->point(-1, 3, 4), this->point(9, 3, 4));
    this->expectCountInAllOrders(8, this->point(-1, 0, 8), this->point(9, 0, 8));
}

TYPED_TEST(RayQuery, ThroughCornersMeetsAllBoxesThatTouchThem) {
    // Those whose three numbers differ by one at most.
    std::size_t expected = 0;
    for (const auto& proxy : this->proxies_) {
        expected += proxy.box.min().maxCoeff() - proxy.box.min().minCoeff() <= 1 ? 1U : 0U;
    }
    this->expectCountInAllOrders(expected, this->point(-1, -1, -1), this->point(9, 9, 9));
    this->expectCountInAllOrders(expected, this->point(0, 0, 0), this->point(8, 8, 8));
    // In a face and through corners in it.
    this->expectCountInAllOrders(2 * (8 + 7 * 2), this->point(-1, -1, 3), this->point(9, 9, 3));
}

TYPED_TEST(RayQuery, ThatEndsOnAFaceMeetsTheBoxBehindIt) {
    this->expectCountInAllOrders(1, this->point(-1, 3.5, 4.5), this->point(0, 3.5, 4.5));
    this->expectCountInAllOrders(3, this->point(-1, 3.5, 4.5), this->point(2, 3.5, 4.5));
    this->expectCountInAllOrders(0, this->point(-1, 3.5, 4.5), this->point(-1e-3, 3.5, 4.5));
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

TYPED_TEST(RayQuery, ABoxThatStandsStillMeetsWhatItOverlaps) {
    const auto at = this->point(4, 4, 4);
    const Aabb<TypeParam> half = makeBox<TypeParam>(-1, -1, -1, 1, 1, 1);
    EXPECT_EQ(this->count(RayRegion<TypeParam>(at, at, half)), 64U);
    const Aabb<TypeParam> less = makeBox<TypeParam>(-0.5, -0.5, -0.5, 0.5, 0.5, 0.5);
    EXPECT_EQ(this->count(RayRegion<TypeParam>(at, at, less)), 8U);
}

TYPED_TEST(RayQuery, AMovingBoxMeetsWhatItSweeps) {
    const Aabb<TypeParam> half = makeBox<TypeParam>(-0.75, -0.25, -0.25, 0.75, 0.25, 0.25);
    using Ray = RayRegion<TypeParam>;
    EXPECT_EQ(this->count(Ray({-5, 3.5, 3.5}, {20, 3.5, 3.5}, half)), 8U);
    EXPECT_EQ(this->count(Ray({-5, 3.25, 3.5}, {20, 3.25, 3.5}, half)), 16U);  // grazes a face
    EXPECT_EQ(this->count(Ray({-5, 3, 3}, {20, 3, 3}, half)), 32U);
    EXPECT_EQ(this->count(Ray({-5, 8.25, 3.5}, {20, 8.25, 3.5}, half)), 8U);
    const auto hits = find(this->grid_, Ray({-5, 3.5, 3.5}, {-0.75, 3.5, 3.5}, half));
    ASSERT_EQ(hits.size(), 1U);
    EXPECT_EQ(hits[0].second, 1);  // the end of the way
}

TYPED_TEST(RayQuery, TellsTheFractionOfTheWay) {
    CollectClosest<TypeParam> closest;
    this->grid_.visit(RayRegion<TypeParam>({-8, 3.5, 4.5}, {8, 3.5, 4.5}), closest);
    EXPECT_EQ(closest.key(), TypeParam(0.5));
    CollectClosest<TypeParam> fromInside;
    this->grid_.visit(RayRegion<TypeParam>({3.5, 3.5, 4.5}, {8, 3.5, 4.5}), fromInside);
    EXPECT_EQ(fromInside.key(), 0);
}

// --- Long rays -----------------------------------------------------------------------------------

TYPED_TEST(RayQuery, OfABillionCellsEndsAndMissesNothing) {
    this->expectCountInAllOrders(8, this->point(-1e9, 3.5, 4.5), this->point(1e9, 3.5, 4.5));
    // Slanted: a billion cells along one axis, eight along another.
    EXPECT_GT(this->count({0, 0, TypeParam(3.5)}, {TypeParam(1e9), TypeParam(1e9), 4}), 7U);
    for (const double length : {1e5, 3.4e7, 1e9, 1e12, 1e18, 1e19}) {
        SCOPED_TRACE(testing::Message() << "length " << length);
        const double y = 3.5;
        CollectCount found;
        const RayRegion<TypeParam> ray(this->point(-length, y, 4.5), this->point(length, y, 4.5));
        const QueryCost cost = this->grid_.visit(ray, found);
        EXPECT_EQ(found.count(), 8U);
        EXPECT_LE(cost.rowsVisited, 512U);
        EXPECT_LE(cost.boxesTested, 512U);
    }
}

TYPED_TEST(RayQuery, MeetsBoxesAllAlongAVeryLongWay) {
    GridConfig config;
    config.cellSize = 1;
    Grid<TypeParam> grid(config);
    std::vector<Placed<TypeParam>> proxies;
    const Vector3<double> direction(1, 0.37, -0.011);
    for (int i = 0; i < 3000; ++i) {
        const double along = 100'000.0 / 3 * i;
        Vector3<double> center = direction * along;
        const Vector3<double> half(0.5, 0.5 + 4e-8 * along, 0.5 + 4e-8 * along);
        center[2] += i % 3 == 2 ? 8 * half[2] : 0;  // every third stands aside
        const Aabb<TypeParam> box = boxAround<TypeParam>(center, half);
        proxies.push_back({grid.add(box), box});
    }
    grid.update();
    const Vector3<double> end = direction * 1e8;
    const RayRegion<TypeParam> ray(Vector3<TypeParam>::Zero(), end.cast<TypeParam>());
    const std::size_t count = expectLikeBruteForce<TypeParam>(grid, proxies, ray);
    EXPECT_GT(count, 1900U);
    EXPECT_LE(count, 2000U);
}

// --- Numbers at the ends of what there is --------------------------------------------------------

TYPED_TEST(RayQuery, MakesAnewWhatWasFreed) {
    Grid<TypeParam> grid;
    const ProxyId id = grid.add({this->point(0, 0, 0), this->point(1, 1, 1)});
    grid.update();
    for (int round = 0; round < 3; ++round) {
        CollectCount hits;
        grid.visit(RayRegion<TypeParam>(this->point(-1, 0, 0), this->point(2, 0, 0)), hits);
        EXPECT_EQ(hits.count(), 1U);
        EXPECT_GT(grid.rayMemoryBytes(), 0U);
        grid.releaseRayMemory();
        EXPECT_EQ(grid.rayMemoryBytes(), 0U);
        EXPECT_EQ(grid.validate(), "");
        if (round == 1) {
            grid.move(id, {this->point(0, -1, -1), this->point(1, 1, 1)});
            grid.update();
        }
    }
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
    Grid<TypeParam> grid;
    std::vector<Placed<TypeParam>> proxies;
    const Aabb<TypeParam> inverted(Vector3<TypeParam>(1, 1, 1), Vector3<TypeParam>(0, 0, 0));
    proxies.push_back({grid.add(inverted), inverted});
    for (const Vector3<TypeParam>& to :
         {Vector3<TypeParam>(0.5, 0.5, 9), Vector3<TypeParam>(1, 1, 1),
          Vector3<TypeParam>(0.5, 1, 2)}) {
        const RayRegion<TypeParam> ray(Vector3<TypeParam>(0.5, 0.5, -9), to);
        EXPECT_EQ(expectLikeBruteForce<TypeParam>(grid, proxies, ray), 0U);
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
        const Vector3<double> center = random.pointIn(offset - 4, offset + 4);
        const Aabb<TypeParam> box = boxAround<TypeParam>(center, random.pointIn(0, 2));
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
    const Vector3<double> away = Vector3<double>::Constant(1 << 20);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vector3<double> low = eighths(-4, 4);
        const Vector3<double> high = low + eighths(0, 3);
        const Vector3<double> from = eighths(-9, 9);
        const Vector3<double> to = eighths(-9, 9);
        const auto key = [&](const Vector3<double>& offset) {
            const auto at = [&offset](const Vector3<double>& x) {
                return Vector3<TypeParam>((x + offset).template cast<TypeParam>());
            };
            return RayRegion<TypeParam>(at(from), at(to), fatness)
                .key(Aabb<TypeParam>(at(low), at(high)));
        };
        const TypeParam here = key(Vector3<double>::Zero());
        hits += here >= 0 ? 1 : 0;
        ASSERT_EQ(key(away), here) << from.transpose() << " to " << to.transpose();
    }
    EXPECT_GT(hits, 500);
}

}  // namespace
}  // namespace hashphase::test
