// SPDX-License-Identifier: Zlib

// A shift of the origin: boxes, pairs and queries afterwards are those of the shifted boxes, and
// nothing else has changed.

#include <tests/support/handlers.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/population.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
using ShiftedWorld = Population<Scalar, PairWorld>;

template <class Scalar>
class OriginShift : public testing::Test {
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(OriginShift, Scalars);

// Whole ones, which are exact near the origin, and any; along some axes or all.
template <class Scalar>
Vector3<Scalar> anyShift(Random& random) {
    Vector3<double> shift = random.pointIn(-1, 1) * random.logBetween(1e-3, 1e6);
    if (random.chance(0.5)) {
        shift = (shift / 64).array().round() * 64;
    }
    shift[random.axis()] *= random.chance(0.5) ? 1 : 0;
    return shift.cast<Scalar>();
}

// --- Exact shifts --------------------------------------------------------------------------------

// Ends the frame, and then one in which something has changed, however little: what is quiet comes to
// rest in such.
template <class Scalar>
void updateDisturbed(ShiftedWorld<Scalar>& world) {
    world.updateAndCheck();
    const ProxyId id = world.PairWorld<Scalar>::add(world.proxies[0].box);
    world.update();
    world.remove(id);
    world.updateAndCheck();
}

// Boxes of whole numbers, half of them at rest.
template <class Scalar>
void settle(ShiftedWorld<Scalar>& world, std::size_t count = 400) {
    const auto draw = [](Random& random) {
        const Vector3<Scalar> low = random.pointIn(0, 18).array().floor().template cast<Scalar>();
        const Vector3<Scalar> size = random.pointIn(0, 3).array().floor().template cast<Scalar>();
        return Aabb<Scalar>(low, low + size);
    };
    world.addMany(count, draw, 2);
    updateDisturbed(world);
    updateDisturbed(world);
}

// What has happened in the frame leaves pairs and rest as they were.
template <class Scalar>
void expectNothingChanged(ShiftedWorld<Scalar>& world) {
    const std::set<ProxyPair> before = world.set();
    world.updateAndCheck();
    EXPECT_EQ(world.set(), before);
    EXPECT_TRUE(world.asked().empty());
    EXPECT_EQ(world.pairs.lastCost().grid.changed, 0U);
    EXPECT_EQ(world.pairs.lastCost().grid.filed, 0U);
}

TYPED_TEST(OriginShift, ThatIsExactChangesNoPairAndWakesNobody) {
    ShiftedWorld<TypeParam> world;
    settle(world);
    ASSERT_GT(world.set().size(), 100U);
    for (const int meters : {1, -1024, 1023, 1 << 20, -(1 << 20), 0}) {
        const auto by = static_cast<TypeParam>(meters);
        world.shift(Vector3<TypeParam>(by, -by, meters == 0 ? 0 : 3));
        for (const Placed<TypeParam>& proxy : world.proxies) {
            ASSERT_TRUE(isSameBits(world.grid.box(proxy.id), proxy.box));
        }
        expectNothingChanged(world);
        EXPECT_EQ(world.pairs.lastCost().grid.resting, 200U);
    }
}

// Half-spaces as Bullet has them are so large that a shift is lost in them.
TYPED_TEST(OriginShift, LeavesEnormousBoxesAsTheyAre) {
    ShiftedWorld<TypeParam> world;
    settle(world);
    const TypeParam huge = sizeof(TypeParam) == sizeof(float) ? TypeParam(1e18) : TypeParam(1e30);
    const TypeParam infinity = std::numeric_limits<TypeParam>::infinity();
    for (const TypeParam far : {huge, infinity}) {
        const auto low = Vector3<TypeParam>::Constant(-far);
        world.add({low, Vector3<TypeParam>(far, far, TypeParam(4))}, Mobility::resting);
    }
    updateDisturbed(world);
    world.shift(Vector3<TypeParam>(1024, 2048, -4096));
    EXPECT_EQ(world.grid.box(world.proxies.back().id).max()[2], TypeParam(4100));
    expectNothingChanged(world);
    // However far it is.
    ShiftedWorld<TypeParam> all;
    all.add({Vector3<TypeParam>::Constant(-infinity), Vector3<TypeParam>::Constant(infinity)});
    for (int i = 0; i < 2; ++i) {
        all.shift(Vector3<TypeParam>(std::numeric_limits<TypeParam>::max(), 1, 0));
    }
    all.updateAndCheck();
}

TYPED_TEST(OriginShift, InTheMidstOfAFrameIsNoMoveOfItsOwn) {
    ShiftedWorld<TypeParam> world;
    settle(world);
    const auto moveBy = [&](std::size_t i, const Vector3<TypeParam>& by) {
        world.moveTo(i, world.proxies[i].box.translated(by));
    };
    // One that rests, one that does not, and one there and back.
    moveBy(0, {1, 0, 0});
    moveBy(1, {0, 2, 0});
    moveBy(3, {0, 0, 5});
    world.shift(Vector3<TypeParam>(4096, -64, 7));
    moveBy(3, {0, 0, -5});
    world.updateAndCheck();
    EXPECT_EQ(world.pairs.lastCost().grid.changed, 3U);
}

// --- Shifts that round ---------------------------------------------------------------------------

TYPED_TEST(OriginShift, ThatRoundsBoxesTogetherMakesThemAPairInTheNextUpdate) {
    const TypeParam apart = 1 + 4 * std::numeric_limits<TypeParam>::epsilon();
    for (const bool firstRests : {false, true}) {
        for (const bool secondRests : {false, true}) {
            ShiftedWorld<TypeParam> world;
            const auto add = [&](TypeParam x, bool rests) {
                const Vector3<TypeParam> low(x, 0, 0);
                world.add({low, low + Vector3<TypeParam>::Ones()},
                          rests ? Mobility::resting : Mobility::mobile);
            };
            add(0, firstRests);
            add(apart, secondRests);
            world.updateAndCheck();
            world.shift({-64, 0, 0});
            EXPECT_TRUE(world.set().empty());
            world.updateAndCheck();
            EXPECT_EQ(world.set().size(), 1U);
            // And back: what is lost is lost.
            world.shift({64, 0, 0});
            world.updateAndCheck();
            EXPECT_EQ(world.set().size(), 1U);
        }
    }
}

TYPED_TEST(OriginShift, LetsWhatItRoundedRestAgainAtOnce) {
    ShiftedWorld<TypeParam> world;
    for (int i = 0; i < 100; ++i) {
        const Vector3<TypeParam> low(static_cast<TypeParam>(i) * TypeParam(1.1), 0, 0);
        world.add({low, low + Vector3<TypeParam>::Ones()}, Mobility::resting);
    }
    updateDisturbed(world);
    ASSERT_EQ(world.pairs.lastCost().grid.resting, 100U);
    world.shift(Vector3<TypeParam>(TypeParam(-1e5), 0, 0));
    world.updateAndCheck();
    EXPECT_LT(world.pairs.lastCost().grid.resting, 50U);
    updateDisturbed(world);
    EXPECT_EQ(world.pairs.lastCost().grid.resting, 100U);
}

// --- Any shifts ----------------------------------------------------------------------------------

TYPED_TEST(OriginShift, AtAnyMomentLeavesThePairsOfBruteForce) {
    for (BoxScene<TypeParam> scene : allBoxScenes<TypeParam>()) {
        scene.count = scene.count / 2;
        SCOPED_TRACE(scene.name);
        const bool someSweep = scene.name == "evenly spread" || scene.name == "at 1e6";
        Script<TypeParam> script(scene, 0x5eed2002, {.fallAsleep = 0.2, .recolour = 0.004});
        PairWorld<TypeParam> world({.updatesBeforeRest = 1}, [&script](ProxyId a, ProxyId b) {
            return script.accepts(a, b);
        });
        script.begin(world);
        Random& random = script.random();
        const auto shiftSometimes = [&] {
            for (double chance = 0.3; random.chance(chance); chance = 0.5) {
                const Vector3<TypeParam> by = anyShift<TypeParam>(random);
                world.shiftOrigin(by);
                script.shiftOrigin(by);
                const int queries = random.chance(0.3) ? 1 : 0;
                expectQueriesLikeBruteForce(world.grid, script.proxies(), random, queries);
            }
        };
        for (int frame = 0; frame < 30; ++frame) {
            SCOPED_TRACE(testing::Message() << "frame " << frame);
            shiftSometimes();
            script.playFrame(world);
            shiftSometimes();
            for (const Placed<TypeParam>& proxy : script.proxies()) {
                if (random.chance(0.02)) {
                    world.findPairsNow(proxy.id);
                }
                if (someSweep && random.chance(0.05)) {
                    const Vector3<TypeParam> way = random.pointIn(-20, 20).cast<TypeParam>();
                    world.sweep(proxy.id, way, random.chance(0.4) ? Sweep::none : Sweep::automatic);
                }
            }
            shiftSometimes();
            world.update();
            world.checkThoroughly(script.proxies());
            ASSERT_FALSE(this->HasFailure());
        }
    }
}

// --- Shifts that add up --------------------------------------------------------------------------

// Rays through each of the last boxes and along its edges, as far as they are finite, meet what they
// meet of all.
template <class Scalar>
std::size_t expectRaysLikeBruteForce(const ShiftedWorld<Scalar>& world, std::size_t last) {
    const auto finite = [](const Vector3<Scalar>& corner) -> Vector3<Scalar> {
        const Scalar most = std::numeric_limits<Scalar>::max();
        return corner.cwiseMax(-most).cwiseMin(most);
    };
    std::size_t met = 0;
    for (const Placed<Scalar>& proxy : std::span(world.proxies).last(last)) {
        const Vector3<Scalar> from = finite(proxy.box.min());
        const Vector3<Scalar> to = finite(proxy.box.max());
        met += world.expectLikeBruteForce(RayRegion<Scalar>(from, to));
        for (int axis = 0; axis < 3; ++axis) {
            Vector3<Scalar> along = from;
            for (const Scalar end : {to[axis], from[axis] / 2}) {
                along[axis] = end;
                met += world.expectLikeBruteForce(RayRegion<Scalar>(from, along));
            }
        }
    }
    return met;
}

// Boxes of a usual size, and such as end at the ends of numbers.
template <class Scalar>
std::vector<Aabb<Scalar>> boxesUpToInfinity(std::size_t usualCount) {
    using Limits = std::numeric_limits<Scalar>;
    Random random(0x5eed2005);
    std::vector<Aabb<Scalar>> boxes;
    while (boxes.size() < usualCount) {
        const Vector3<Scalar> low = random.pointIn(0, 9).array().floor().template cast<Scalar>();
        boxes.emplace_back(low, low + Vector3<Scalar>::Ones());
    }
    for (const Scalar far : {Scalar(1e18), Limits::max() / 2, Limits::max(), Limits::infinity()}) {
        boxes.emplace_back(Vector3<Scalar>(-far, 0, 0), Vector3<Scalar>(1, 1, 1));
        boxes.emplace_back(Vector3<Scalar>(-1, 2, 2), Vector3<Scalar>(far, 3, 3));
        boxes.emplace_back(Vector3<Scalar>(-far, 4, 0), Vector3<Scalar>(far, 5, 1));
        boxes.emplace_back(Vector3<Scalar>(far, 0, 0), Vector3<Scalar>(far, 9, 9));
    }
    return boxes;
}

// Two finite shifts may take what is finite to infinity, and what cells and trees are measured from
// with it; or each be lost in the next.
TYPED_TEST(OriginShift, ThatAddUpBeyondAllNumbersLoseNoBox) {
    using Limits = std::numeric_limits<TypeParam>;
    constexpr TypeParam most = Limits::max();
    constexpr TypeParam least = Limits::denorm_min();
    const std::vector<std::vector<TypeParam>> courses{
        {most, most},         {most, most, -most, -most}, {-most, -most, most},
        {most, -most},        {most / 2, most, 1, most},  {least, least, -1},
        {-most / 2, -most, 7}};
    for (const std::size_t usualCount : {6U, 150U}) {
        for (const double cellSize : {0.0, 1.5}) {
            for (const std::vector<TypeParam>& course : courses) {
                SCOPED_TRACE(testing::Message() << usualCount << " boxes, cell size " << cellSize
                                                << ", from " << testing::PrintToString(course));
                ShiftedWorld<TypeParam> world(GridConfig{.cellSize = cellSize});
                for (const Aabb<TypeParam>& box : boxesUpToInfinity<TypeParam>(usualCount)) {
                    const bool rests = world.proxies.size() % 3 == 0;
                    world.add(box, rests ? Mobility::resting : Mobility::mobile);
                }
                updateDisturbed(world);
                for (const TypeParam x : course) {
                    world.shift(Vector3<TypeParam>(x, 0, 0));
                    EXPECT_GT(expectRaysLikeBruteForce(world, 22), 0U);
                    EXPECT_EQ(world.grid.validate(), "");
                    world.updateAndCheck();
                    ASSERT_FALSE(this->HasFailure());
                }
            }
        }
    }
}

// --- Cost ----------------------------------------------------------------------------------------

TYPED_TEST(OriginShift, LeavesTheCostOfQueriesAndUpdatesAsItWas) {
    ShiftedWorld<TypeParam> world;
    settle(world, 1000);
    const auto costOfAll = [&](const Vector3<TypeParam>& origin) {
        std::uint64_t tested = 0;
        for (std::size_t i = 0; i < world.proxies.size(); i += 10) {
            const Aabb<TypeParam>& box = world.proxies[i].box;
            CollectCount count;
            tested += world.grid.visit(BoxRegion<TypeParam>{box}, count).boxesTested;
            const RayRegion<TypeParam> ray(-origin, box.max());
            tested += world.grid.visit(ray, count).boxesTested;
        }
        for (std::size_t i = 1; i < world.proxies.size(); i += 2) {
            const Aabb<TypeParam> box = world.proxies[i].box;
            world.moveTo(i, box.translated(Vector3<TypeParam>(1, 0, 0)));
            world.moveTo(i, box);
        }
        world.update();
        return std::pair(tested, world.pairs.lastCost().boxesTested);
    };
    const auto before = costOfAll(Vector3<TypeParam>::Zero());
    // Rays are tested more widely where numbers are coarse.
    const int far = sizeof(TypeParam) == sizeof(float) ? 1 << 11 : 1 << 20;
    const Vector3<TypeParam> by = Vector3<int>(far, -far, far / 2).cast<TypeParam>();
    world.shift(by);
    const auto after = costOfAll(by);
    EXPECT_LE(after.first, before.first + before.first / 10);
    EXPECT_EQ(after.second, before.second);
}

}  // namespace
}  // namespace hashphase::test
