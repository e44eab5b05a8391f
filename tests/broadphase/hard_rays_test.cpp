// SPDX-License-Identifier: Zlib

// Rays at the ends of what numbers can say: zeros of either sign, a billion cells, lengths that cannot
// be squared, coordinates of a million kilometres; against slabs in rational numbers.

#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/ray_oracle.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
struct RayWorld {
    Grid<Scalar> grid;
    std::vector<Placed<Scalar>> proxies;

    explicit RayWorld(double cellSize = 0) : grid(configFor(cellSize)) {}

    void add(const Aabb<Scalar>& box, Mobility mobility = Mobility::mobile) {
        proxies.push_back({grid.add(box, mobility), box});
    }

    /// The grid finds what the region's key() says, misses nothing that rational numbers say is met,
    /// and finds nothing that is farther off than `doubt` of the coordinates. Returns how many are met.
    std::size_t expectAsRationalsSay(const Vector3<Scalar>& from, const Vector3<Scalar>& to,
                                     double doubt) const {
        const RayRegion<Scalar> ray(from, to);
        expectLikeBruteForce<Scalar>(grid, proxies, ray);
        std::size_t met = 0;
        for (const Placed<Scalar>& proxy : proxies) {
            const bool isMet = meetsByRationals(from, to, proxy.box);
            const bool isFound = ray.key(proxy.box) >= 0;
            met += isMet ? 1 : 0;
            const auto describe = [&] {
                return testing::Message()
                       << from.transpose() << " to " << to.transpose() << ", box "
                       << proxy.box.min().transpose() << " to " << proxy.box.max().transpose();
            };
            EXPECT_TRUE(isFound || !isMet) << describe();
            EXPECT_TRUE(!isFound || isMet ||
                        meetsByRationals(from, to, withDoubt(proxy.box, from, to, doubt)))
                << describe();
        }
        return met;
    }

    /// How many boxes the segment passes farther off than that doubt.
    std::size_t countClear(const Vector3<Scalar>& from, const Vector3<Scalar>& to,
                           double doubt) const {
        return static_cast<std::size_t>(
            std::count_if(proxies.begin(), proxies.end(), [&](const Placed<Scalar>& proxy) {
                return !meetsByRationals(from, to, withDoubt(proxy.box, from, to, doubt));
            }));
    }

private:
    static GridConfig configFor(double cellSize) {
        GridConfig config;
        config.cellSize = cellSize;
        return config;
    }
};

template <class Scalar>
class HardRays : public testing::Test {
protected:
    static constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();
    static constexpr Scalar kNan = std::numeric_limits<Scalar>::quiet_NaN();
    static constexpr double kDoubt =
        8 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());

    static Vector3<Scalar> point(const Vector3<double>& at) { return at.cast<Scalar>(); }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(HardRays, Scalars);

// Directions of 0 and -0, beginnings and boxes at 0 and -0, in the boxes' faces and beside them: all
// combinations. Everything is a small number, so nothing is rounded and nothing in doubt.
TYPED_TEST(HardRays, AlongAxesMeetWhatTheSlabsSayWhateverTheSignsOfZeros) {
    RayWorld<TypeParam> world(1);
    for (int i = 0; i < 27; ++i) {
        const Vector3<TypeParam> low =
            this->point(Vector3<double>(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        Aabb<TypeParam> box(low, low + Vector3<TypeParam>::Ones());
        for (int axis = 0; axis < 3; ++axis) {
            // Faces at 0 have either sign.
            box.min()[axis] = box.min()[axis] == 0 && i % 2 == 0 ? -TypeParam(0) : box.min()[axis];
            box.max()[axis] = box.max()[axis] == 0 && i % 4 < 2 ? -TypeParam(0) : box.max()[axis];
        }
        world.add(box, i % 2 == 0 ? Mobility::resting : Mobility::mobile);
    }
    world.add(makeBox<TypeParam>(0, -1, -1, -0.0, 1, 1));  // a plate
    world.add(makeBox<TypeParam>(-0.0, 0, -0.0, 0, -0.0, 0));
    world.grid.update();
    const TypeParam zero = 0;
    const std::array<std::array<TypeParam, 2>, 8> ways{{{zero, zero},
                                                        {zero, -zero},
                                                        {-zero, zero},
                                                        {-zero, -zero},
                                                        {-3, 3},
                                                        {3, -3},
                                                        {1, 1},
                                                        {-1, -1}}};
    std::size_t met = 0;
    bool hasNegativeZero = false;
    for (std::size_t i = 0; i < 512; ++i) {
        const auto& [x, y, z] = std::array{ways[i % 8], ways[i / 8 % 8], ways[i / 64]};
        const Vector3<TypeParam> from(x[0], y[0], z[0]);
        const Vector3<TypeParam> to(x[1], y[1], z[1]);
        met += world.expectAsRationalsSay(from, to, 0);
        const TypeParam way = to[0] - from[0];
        hasNegativeZero |= way == 0 && std::signbit(way);
    }
    EXPECT_TRUE(hasNegativeZero);
    EXPECT_GT(met, 4000U);
}

// 1e5, 3.4e7 and 1e9 cells of a metre, straight and slanted. What adds up steps along such a way
// stops or strays; here the box at its very end is met, what stands well aside is not, and no more
// is read than lies there.
TYPED_TEST(HardRays, OfABillionCellsMeetWhatLiesAlongTheirWayUntilItsEnd) {
    constexpr std::uint32_t kCount = 300;
    Random random(0x5eed1001);
    for (const double length : {1e5, 3.4e7, 1e9}) {
        for (const Vector3<double>& direction :
             {Vector3<double>(1, 0, 0), Vector3<double>(-1, 1, 1),
              Vector3<double>(0.37, -1, 1e-3)}) {
            SCOPED_TRACE(testing::Message() << length << " along " << direction.transpose());
            RayWorld<TypeParam> world(1);
            for (std::uint32_t i = 0; i < kCount; ++i) {
                const Vector3<double> at = direction * length * i / (kCount - 1);
                const double half = 0.5 + length * this->kDoubt;
                Vector3<double> beside = Vector3<double>::Zero();
                if (i % 3 == 2) {
                    beside = direction.cross(Vector3<double>::UnitZ()) * (i % 2 == 0 ? 8 : -8);
                } else if (i % 6 == 1) {
                    beside = random.pointIn(-1.5, 1.5);
                }
                world.add(
                    boxAround<TypeParam>(at + beside * half, Vector3<double>::Constant(half)));
            }
            const Vector3<TypeParam> end = this->point(direction * length);
            world.add({end, end});
            world.grid.update();
            const Vector3<TypeParam> start = Vector3<TypeParam>::Zero();
            const std::size_t met = world.expectAsRationalsSay(start, end, this->kDoubt);
            EXPECT_GT(met, kCount / 2);
            EXPECT_GT(world.countClear(start, end, this->kDoubt), 50U);
            CollectCount found;
            const QueryCost cost = world.grid.visit(RayRegion<TypeParam>(start, end), found);
            EXPECT_LE(cost.boxesTested, kCount + 1);
            EXPECT_LE(cost.rowsVisited, kCount + 1);
        }
    }
}

// Of which the square is infinite in single precision, or in double.
TYPED_TEST(HardRays, TooLongToBeSquaredMeetWhatTheyPass) {
    std::vector<double> lengths{1e19, 1e30};
    if (sizeof(TypeParam) == sizeof(double)) {
        lengths.push_back(1e200);
    }
    Random random(0x5eed1002);
    for (const double length : lengths) {
        for (int i = 0; i < 6; ++i) {
            SCOPED_TRACE(testing::Message() << length << ", " << i);
            Vector3<double> direction =
                i < 3 ? Vector3<double>(Vector3<double>::Unit(i)) : random.pointIn(-1, 1);
            RayWorld<TypeParam> world;
            const Vector3<double> middle = random.pointIn(-5, 5);
            for (int k = 0; k < 100; ++k) {
                // A crowd at the middle; the others as far away as numbers go, and as large.
                const double away = k < 50 ? 0 : length * random.between(-1, 1);
                const double half = k < 50 ? 1 : std::abs(away) * 1e-3;
                world.add(
                    boxAround<TypeParam>(middle + direction * away + random.pointIn(-2, 2) * half,
                                         Vector3<double>::Constant(half)));
            }
            world.grid.update();
            const std::size_t met =
                world.expectAsRationalsSay(this->point(middle - direction * length),
                                           this->point(middle + direction * length), this->kDoubt);
            EXPECT_GT(met, 5U);
        }
    }
}

// In every place that a number has: nothing is met, and less is read than by a good ray.
TYPED_TEST(HardRays, WithABadNumberAnywhereMeetNothingAndReadLittle) {
    using Ray = RayRegion<TypeParam>;
    const CaughtMessages aboutNan;
    RayWorld<TypeParam> world;
    Random random(0x5eed1003);
    for (int i = 0; i < 2000; ++i) {
        world.add(boxAround<TypeParam>(random.pointIn(-10, 10), random.pointIn(0.2, 0.6)),
                  i % 2 == 0 ? Mobility::resting : Mobility::mobile);
    }
    world.add(boxAround<TypeParam>({0, 0, 0}, Vector3<double>::Constant(1e18)));
    world.grid.update();
    for (std::size_t i = 0; i < 20; ++i) {
        world.grid.move(world.proxies[i].id, world.proxies[i + 20].box);  // which wait
    }
    const Vector3<TypeParam> from(-12, 1, 2);
    const Vector3<TypeParam> to(12, -3, 4);
    CollectCount some;
    const QueryCost usual = world.grid.visit(Ray(from, to), some);
    ASSERT_GT(some.count(), 1U);
    const auto expectNothing = [&](const Ray& ray) {
        CollectCount found;
        const QueryCost cost = world.grid.visit(ray, found);
        EXPECT_TRUE(ray.isEmpty());
        EXPECT_EQ(found.count(), 0U);
        EXPECT_LE(2 * cost.boxesTested, 5 * usual.boxesTested);
        EXPECT_LE(cost.boxesTested, 20U) << "what waits";
        EXPECT_EQ(cost.rowsVisited, 0U);
    };
    for (const TypeParam bad : {this->kNan, this->kInfinity, -this->kInfinity}) {
        for (int axis = 0; axis < 3; ++axis) {
            Vector3<TypeParam> there = from;
            there[axis] = bad;
            expectNothing(Ray(there, to));
            expectNothing(Ray(to, there));
            expectNothing(Ray(there, there));
        }
    }
    // Good numbers, but the way between them is none.
    const auto most = Vector3<TypeParam>::Constant(std::numeric_limits<TypeParam>::max());
    expectNothing(Ray(-most, most));
}

TYPED_TEST(HardRays, ThatAreFatByNanMeetNothing) {
    RayWorld<TypeParam> world;
    Random random(0x5eed1006);
    for (int i = 0; i < 500; ++i) {
        world.add(boxAround<TypeParam>(random.pointIn(-5, 5), random.pointIn(0.2, 0.6)),
                  i % 2 == 0 ? Mobility::resting : Mobility::mobile);
    }
    const Vector3<TypeParam> from(-6, 1, 2);
    const Vector3<TypeParam> to(6, -3, 4);
    Aabb<TypeParam> fatness = makeBox<TypeParam>(-1, -1, -1, 1, 1, 1);
    for (const bool isFiled : {false, true}) {
        EXPECT_GT(find(world.grid, RayRegion<TypeParam>(from, to, fatness)).size(), 5U);
        for (int field = 0; field < 6; ++field) {
            TypeParam& number = (field < 3 ? fatness.min() : fatness.max())[field % 3];
            const TypeParam good = std::exchange(number, this->kNan);
            CollectCount found;
            const QueryCost cost = world.grid.visit(RayRegion<TypeParam>(from, to, fatness), found);
            EXPECT_EQ(found.count(), 0U);
            EXPECT_LE(cost.boxesTested, world.proxies.size());
            number = good;
        }
        if (!isFiled) {
            world.grid.update();
        }
    }
}

// Asked before anything is filed, with few and with many changes waiting, and with all at rest; among
// boxes of a metre, of 1e18 m, and without extent, up to a million kilometres from the origin. Rays end
// at corners and in faces, as near to missing as numbers get.
TYPED_TEST(HardRays, FarAwayMissNothingThatRationalNumbersSayIsMet) {
    Random random(0x5eed1004);
    for (const double away : {0.0, 1e3, 1e6, 1e9}) {
        SCOPED_TRACE(away);
        RayWorld<TypeParam> world;
        const double unit = std::max(1.0, away * this->kDoubt);
        const auto draw = [&](int i) {
            const Vector3<double> at =
                Vector3<double>(away, -away, away / 3) + random.pointIn(-12, 12) * unit;
            const double half = i % 40 == 0 ? 1e18 : i % 7 == 0 ? 0 : unit * random.between(0.2, 2);
            return boxAround<TypeParam>(at, Vector3<double>::Constant(half));
        };
        for (int i = 0; i < 120; ++i) {
            world.add(draw(i), i % 3 == 0 ? Mobility::resting : Mobility::mobile);
        }
        std::size_t met = 0;
        for (const int changes : {0, 5, 100, 0}) {
            for (int i = 0; i < changes; ++i) {
                Placed<TypeParam>& proxy = world.proxies[random.below(120)];
                proxy.box = draw(1);
                world.grid.move(proxy.id, proxy.box);
            }
            RegionMaker<TypeParam> make(random, world.proxies);
            for (int i = 0; i < 12; ++i) {
                const Vector3<TypeParam> from =
                    i % 4 == 0 ? Vector3<TypeParam>::Zero() : make.point();
                Vector3<TypeParam> to = make.point();
                to = i % 3 == 0 ? Vector3<TypeParam>(from + 2 * (to - from)) : to;
                met += world.expectAsRationalsSay(from, to, this->kDoubt);
                ASSERT_FALSE(this->HasFailure());
            }
            for (int i = 0; i < 4; ++i) {
                world.grid.update();  // the last time, everything comes to rest
            }
        }
        EXPECT_GT(met, 100U);
    }
}

// --- Moving boxes --------------------------------------------------------------------------------

// A box that touches another one with a face, an edge or a corner, somewhere on its way or at its end.
TYPED_TEST(HardRays, ThatAreFatErrToTheSideOfAHit) {
    Random random(0x5eed1005);
    int met = 0;
    int extra = 0;
    for (int i = 0; i < 15000; ++i) {
        const double scale = std::array{1.0, 1e3, 1e6, 1e9}[static_cast<std::size_t>(i % 4)];
        const Vector3<TypeParam> from = this->point(random.pointIn(-scale, scale));
        Vector3<TypeParam> to = this->point(random.pointIn(-scale, scale));
        for (int axis = 0; axis < 3; ++axis) {
            to[axis] = random.chance(0.15) ? from[axis] : to[axis];
        }
        const Vector3<TypeParam> half =
            this->point(random.pointIn(0, 1) * random.logBetween(1e-3, 1e3));
        const Aabb<TypeParam> fatness(-half, half);
        const TypeParam share = random.chance(0.3) ? 1 : static_cast<TypeParam>(random.unit());
        const Vector3<TypeParam> there = from + share * (to - from);
        const Vector3<TypeParam> size = this->point(random.pointIn(0, scale / 2));
        Aabb<TypeParam> box(there - size, there + size);
        for (int axis = 0; axis < 3; ++axis) {
            const std::uint32_t side = random.below(3);  // that just touches; 2: overlaps
            box.min()[axis] = side == 0 ? there[axis] + half[axis] : box.min()[axis];
            box.max()[axis] = side == 0 ? box.min()[axis] + size[axis] : box.max()[axis];
            box.max()[axis] = side == 1 ? there[axis] - half[axis] : box.max()[axis];
            box.min()[axis] = side == 1 ? box.max()[axis] - size[axis] : box.min()[axis];
        }
        const bool isMet = meetsByRationals(from, to, box, fatness);
        const TypeParam key = RayRegion<TypeParam>(from, to, fatness).key(box);
        met += isMet ? 1 : 0;
        extra += key >= 0 && !isMet ? 1 : 0;
        ASSERT_TRUE(key >= 0 || !isMet) << i;
        ASSERT_LE(key, 1);
    }
    EXPECT_GT(met, 7000);
    EXPECT_LT(extra, 7000) << "rounding decides in some";
}

// Inverses of less than 1e-38 are infinite in single precision: the way is as if there were none, and
// what lies on it is met all the same.
TYPED_TEST(HardRays, OfTheSmallestNumbersMeetWhatIsOnTheirWay) {
    using Limits = std::numeric_limits<TypeParam>;
    for (const TypeParam tiny : {Limits::denorm_min(), 100 * Limits::denorm_min(),
                                 Limits::min() / 4, Limits::min(), 16 * Limits::min()}) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int sign : {-1, 1}) {
                RayWorld<TypeParam> world;
                const Vector3<TypeParam> unit = Vector3<TypeParam>::Unit(axis) * TypeParam(sign);
                Vector3<TypeParam> to = unit * tiny;
                to[(axis + 1) % 3] = 7;
                const Vector3<TypeParam> plate = Vector3<TypeParam>::Ones() - unit.cwiseAbs();
                const Vector3<TypeParam> at = unit * tiny + plate * 7;
                world.add({at, at});                                    // where it ends
                world.add({unit * tiny - plate, unit * tiny + plate});  // just too late
                world.add({-plate, plate});
                world.grid.update();
                Vector3<TypeParam> from = Vector3<TypeParam>::Zero();
                from[(axis + 2) % 3] = 7;
                to[(axis + 2) % 3] = 7;
                world.expectAsRationalsSay(from, to, this->kDoubt);
                EXPECT_GE(RayRegion<TypeParam>(from, to).key(world.proxies[0].box), 0);
            }
        }
    }
}

}  // namespace
}  // namespace hashphase::test
