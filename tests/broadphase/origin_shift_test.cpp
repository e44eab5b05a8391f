// SPDX-License-Identifier: Zlib

// A shift of the origin: boxes, pairs and queries afterwards are those of the shifted boxes, and
// nothing else has changed.

#include <tests/support/handlers.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class OriginShift : public testing::Test {
protected:
    CaughtMessages messages_;
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
    shift[random.below(3)] *= random.chance(0.5) ? 1 : 0;
    return shift.cast<Scalar>();
}

template <class Scalar>
void expectQueriesLikeBruteForce(const Grid<Scalar>& grid, Script<Scalar>& script, int count) {
    RegionMaker<Scalar> make(script.random(), script.proxies());
    for (int i = 0; i < count; ++i) {
        expectLikeBruteForce(grid, script.proxies(), make.box());
        expectLikeBruteForce(grid, script.proxies(), make.sphere());
        expectLikeBruteForce(grid, script.proxies(), make.ray());
        expectLikeBruteForce(grid, script.proxies(), make.ray(true));
        expectLikeBruteForce(grid, script.proxies(), make.convex());
    }
}

// --- Exact shifts --------------------------------------------------------------------------------

// Ends the frame, and then one in which something has changed, however little: what is quiet comes to
// rest in such.
template <class Scalar>
void updateDisturbed(PairWorld<Scalar>& world, std::span<const Placed<Scalar>> proxies) {
    world.update();
    ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
    const ProxyId id = world.add(proxies[0].box);
    world.update();
    world.remove(id);
    world.update();
    ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
}

// Boxes of whole numbers, half of them at rest.
template <class Scalar>
std::vector<Placed<Scalar>> settle(PairWorld<Scalar>& world, int count = 400) {
    Random random(0x5eed2001);
    std::vector<Placed<Scalar>> proxies;
    for (int i = 0; i < count; ++i) {
        const Vector3<Scalar> low = random.pointIn(0, 18).array().floor().template cast<Scalar>();
        const Vector3<Scalar> size = random.pointIn(0, 3).array().floor().template cast<Scalar>();
        const Aabb<Scalar> box(low, low + size);
        proxies.push_back({world.add(box, i % 2 == 0 ? Mobility::resting : Mobility::mobile), box});
    }
    updateDisturbed<Scalar>(world, proxies);
    updateDisturbed<Scalar>(world, proxies);
    return proxies;
}

template <class Scalar>
void shift(PairWorld<Scalar>& world, std::vector<Placed<Scalar>>& proxies,
           const Vector3<Scalar>& by) {
    world.shiftOrigin(by);
    for (Placed<Scalar>& proxy : proxies) {
        proxy.box = {proxy.box.min() - by, proxy.box.max() - by};
    }
}

TYPED_TEST(OriginShift, ThatIsExactChangesNoPairAndWakesNobody) {
    PairWorld<TypeParam> world;
    auto proxies = settle(world);
    ASSERT_GT(world.set().size(), 100U);
    for (const int meters : {1, -1024, 1023, 1 << 20, -(1 << 20)}) {
        const auto by = static_cast<TypeParam>(meters);
        shift(world, proxies, Vector3<TypeParam>(by, -by, 3));
        for (const auto& [id, box, colour] : proxies) {
            ASSERT_TRUE(isSameBits(world.grid.box(id), box));
        }
        const PairChanges changes = world.update();
        EXPECT_TRUE(changes.born.empty() && changes.died.empty() && world.asked().empty());
        EXPECT_EQ(world.pairs.lastCost().grid.changed, 0U);
        EXPECT_EQ(world.pairs.lastCost().grid.filed, 0U);
        EXPECT_EQ(world.pairs.lastCost().grid.resting, 200U);
        ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
    }
}

// Half-spaces as Bullet has them are so large that a shift is lost in them.
TYPED_TEST(OriginShift, LeavesEnormousBoxesAsTheyAre) {
    PairWorld<TypeParam> world;
    auto proxies = settle(world);
    const TypeParam huge = sizeof(TypeParam) == sizeof(float) ? TypeParam(1e18) : TypeParam(1e30);
    const TypeParam infinite = std::numeric_limits<TypeParam>::infinity();
    for (const TypeParam far : {huge, infinite}) {
        const Aabb<TypeParam> box(Vector3<TypeParam>::Constant(-far),
                                  Vector3<TypeParam>(far, far, TypeParam(4)));
        proxies.push_back({world.add(box, Mobility::resting), box});
    }
    updateDisturbed<TypeParam>(world, proxies);
    shift(world, proxies, Vector3<TypeParam>(1024, 2048, -4096));
    EXPECT_EQ(world.grid.box(proxies.back().id).max()[2], TypeParam(4100));
    const PairChanges changes = world.update();
    EXPECT_TRUE(changes.born.empty() && changes.died.empty());
    EXPECT_EQ(world.pairs.lastCost().grid.changed, 0U);
    ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
}

TYPED_TEST(OriginShift, InTheMidstOfAFrameIsNoMoveOfItsOwn) {
    PairWorld<TypeParam> world;
    auto proxies = settle(world);
    const auto set = [&](std::size_t i, const Vector3<TypeParam>& by) {
        proxies[i].box.translate(by);
        world.move(proxies[i].id, proxies[i].box);
    };
    // One that rests, one that does not, and one there and back.
    set(0, {1, 0, 0});
    set(1, {0, 2, 0});
    set(3, {0, 0, 5});
    shift(world, proxies, Vector3<TypeParam>(4096, -64, 7));
    set(3, {0, 0, -5});
    world.update();
    EXPECT_EQ(world.pairs.lastCost().grid.changed, 3U);
    ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
}

// --- Shifts that round ---------------------------------------------------------------------------

TYPED_TEST(OriginShift, ThatRoundsBoxesTogetherMakesThemAPairInTheNextUpdate) {
    constexpr auto kEpsilon = std::numeric_limits<TypeParam>::epsilon();
    for (const Mobility first : {Mobility::mobile, Mobility::resting}) {
        for (const Mobility second : {Mobility::mobile, Mobility::resting}) {
            PairWorld<TypeParam> world;
            const Vector3<TypeParam> one = Vector3<TypeParam>::Ones();
            const Aabb<TypeParam> left(Vector3<TypeParam>::Zero(), one);
            const Vector3<TypeParam> low(1 + 4 * kEpsilon, 0, 0);
            const Aabb<TypeParam> right(low, low + one);
            std::vector<Placed<TypeParam>> proxies{{world.add(left, first), left},
                                                   {world.add(right, second), right}};
            world.update();
            ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
            ASSERT_TRUE(world.set().empty());
            shift(world, proxies, Vector3<TypeParam>(-64, 0, 0));
            EXPECT_TRUE(world.set().empty());
            EXPECT_EQ(world.update().born.size(), 1U);
            ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
            // And back: what is lost is lost.
            shift(world, proxies, Vector3<TypeParam>(64, 0, 0));
            EXPECT_TRUE(world.update().died.empty());
            ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
        }
    }
}

TYPED_TEST(OriginShift, LetsWhatItRoundedRestAgainAtOnce) {
    PairWorld<TypeParam> world;
    std::vector<Placed<TypeParam>> proxies;
    for (int i = 0; i < 100; ++i) {
        const auto at = static_cast<TypeParam>(i) * TypeParam(1.1);
        const Vector3<TypeParam> low(at, 0, 0);
        const Aabb<TypeParam> box(low, low + Vector3<TypeParam>::Ones());
        proxies.push_back({world.add(box, Mobility::resting), box});
    }
    updateDisturbed<TypeParam>(world, proxies);
    ASSERT_EQ(world.pairs.lastCost().grid.resting, 100U);
    shift(world, proxies, Vector3<TypeParam>(TypeParam(-1e5), 0, 0));
    world.update();
    EXPECT_LT(world.pairs.lastCost().grid.resting, 50U);
    ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
    updateDisturbed<TypeParam>(world, proxies);
    EXPECT_EQ(world.pairs.lastCost().grid.resting, 100U);
    ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
}

// --- Any shifts ----------------------------------------------------------------------------------

TYPED_TEST(OriginShift, AtAnyMomentLeavesThePairsOfBruteForce) {
    GridConfig config;
    config.updatesBeforeRest = 1;
    ScriptRates rates;
    rates.fallAsleep = 0.2;
    rates.recolour = 0.004;
    for (BoxScene<TypeParam> scene : allBoxScenes<TypeParam>()) {
        scene.count = scene.count / 2;
        SCOPED_TRACE(scene.name);
        Script<TypeParam> script(scene, 0x5eed2002, rates);
        PairWorld<TypeParam> world(
            config, [&script](ProxyId a, ProxyId b) { return script.accepts(a, b); });
        script.begin(world);
        Random& random = script.random();
        const auto shiftSometimes = [&] {
            for (double chance = 0.3; random.chance(chance); chance = 0.5) {
                const Vector3<TypeParam> by = anyShift<TypeParam>(random);
                world.shiftOrigin(by);
                script.shiftOrigin(by);
                if (random.chance(0.3)) {
                    expectQueriesLikeBruteForce(world.grid, script, 1);
                }
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
            }
            shiftSometimes();
            world.update();
            ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(script.proxies()));
            ASSERT_FALSE(this->HasFailure());
        }
    }
}

TYPED_TEST(OriginShift, LeavesWhatFliesOnItsWay) {
    ScriptRates rates;
    rates.recolour = 0.01;
    for (BoxScene<TypeParam> scene : {spreadScene<TypeParam>("evenly spread", 1, 0),
                                      spreadScene<TypeParam>("at 1e6", 1, 1e6)}) {
        SCOPED_TRACE(scene.name);
        scene.count = 40;
        Script<TypeParam> script(scene, 0x5eed2003, rates);
        PairWorld<TypeParam> world(
            {}, [&script](ProxyId a, ProxyId b) { return script.accepts(a, b); });
        script.begin(world);
        Random& random = script.random();
        for (int frame = 0; frame < 16; ++frame) {
            SCOPED_TRACE(testing::Message() << "frame " << frame);
            script.playFrame(world);
            for (const Placed<TypeParam>& proxy : script.proxies()) {
                if (random.chance(0.1)) {
                    const Vector3<TypeParam> way = random.pointIn(-20, 20).cast<TypeParam>();
                    world.sweep(proxy.id, way, random.chance(0.4) ? Sweep::none : Sweep::automatic);
                }
            }
            if (random.chance(0.5)) {
                const Vector3<TypeParam> by = anyShift<TypeParam>(random);
                world.shiftOrigin(by);
                script.shiftOrigin(by);
            }
            world.update();
            ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(script.proxies()));
        }
    }
}

TYPED_TEST(OriginShift, IsSeenByEveryQueryAtOnce) {
    for (const double cellSize : {0.0, 1.5}) {
        for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
            SCOPED_TRACE(testing::Message() << scene.name << ", cell size " << cellSize);
            GridConfig config;
            config.cellSize = cellSize;
            config.updatesBeforeRest = 1;
            GridWorld<TypeParam> world(config);
            Script<TypeParam> script(scene, 0x5eed2004);
            script.begin(world);
            for (int frame = 0; frame < 8; ++frame) {
                SCOPED_TRACE(testing::Message() << "frame " << frame);
                script.playFrame(world);
                if (frame % 3 != 1) {
                    world.grid.update();
                }
                if (frame % 2 == 1) {
                    script.playFrame(world);
                }
                const Vector3<TypeParam> by = anyShift<TypeParam>(script.random());
                world.grid.shiftOrigin(by);
                script.shiftOrigin(by);
                expectQueriesLikeBruteForce(world.grid, script, 2);
                ASSERT_EQ(world.grid.validate(), "");
                ASSERT_FALSE(this->HasFailure());
            }
        }
    }
}

// --- Shifts that add up --------------------------------------------------------------------------

// Rays through each of the last boxes and along its edges, as far as they are finite, meet what they
// meet of all.
template <class Scalar>
std::size_t expectRaysLikeBruteForce(const Grid<Scalar>& grid,
                                     std::span<const Placed<Scalar>> proxies, std::size_t last) {
    const auto finite = [](const Vector3<Scalar>& corner) -> Vector3<Scalar> {
        const Scalar most = std::numeric_limits<Scalar>::max();
        return corner.cwiseMax(-most).cwiseMin(most);
    };
    std::size_t met = 0;
    for (const Placed<Scalar>& proxy : proxies.last(last)) {
        const Vector3<Scalar> from = finite(proxy.box.min());
        const Vector3<Scalar> to = finite(proxy.box.max());
        met += expectLikeBruteForce(grid, proxies, RayRegion<Scalar>(from, to));
        for (int axis = 0; axis < 3; ++axis) {
            Vector3<Scalar> along = from;
            along[axis] = to[axis];
            met += expectLikeBruteForce(grid, proxies, RayRegion<Scalar>(from, along));
            along[axis] = from[axis] / 2;
            met += expectLikeBruteForce(grid, proxies, RayRegion<Scalar>(from, along));
        }
    }
    return met;
}

// Boxes of a usual size, and such as end at the ends of numbers.
template <class Scalar>
std::vector<Aabb<Scalar>> boxesUpToInfinity(int usualCount) {
    Random random(0x5eed2005);
    using Limits = std::numeric_limits<Scalar>;
    std::vector<Aabb<Scalar>> boxes;
    for (int i = 0; i < usualCount; ++i) {
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
    for (const int usualCount : {6, 150}) {
        for (const double cellSize : {0.0, 1.5}) {
            for (const std::vector<TypeParam>& course : courses) {
                SCOPED_TRACE(testing::Message() << usualCount << " boxes, cell size " << cellSize
                                                << ", from " << testing::PrintToString(course));
                GridConfig config;
                config.cellSize = cellSize;
                PairWorld<TypeParam> world(config);
                std::vector<Placed<TypeParam>> proxies;
                for (const Aabb<TypeParam>& box : boxesUpToInfinity<TypeParam>(usualCount)) {
                    const bool isResting = proxies.size() % 3 == 0;
                    const auto mobility = isResting ? Mobility::resting : Mobility::mobile;
                    proxies.push_back({world.add(box, mobility), box});
                }
                updateDisturbed<TypeParam>(world, proxies);
                for (const TypeParam x : course) {
                    shift(world, proxies, Vector3<TypeParam>(x, 0, 0));
                    EXPECT_GT(expectRaysLikeBruteForce<TypeParam>(world.grid, proxies, 22), 0U);
                    EXPECT_EQ(world.grid.validate(), "");
                    world.update();
                    ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
                    ASSERT_FALSE(this->HasFailure());
                }
            }
        }
    }
}

TYPED_TEST(OriginShift, LeavesWhatIsInfiniteAtRestHoweverFarItIs) {
    constexpr TypeParam infinity = std::numeric_limits<TypeParam>::infinity();
    PairWorld<TypeParam> world;
    const Aabb<TypeParam> box(Vector3<TypeParam>::Constant(-infinity),
                              Vector3<TypeParam>::Constant(infinity));
    std::vector<Placed<TypeParam>> proxies{{world.add(box, Mobility::resting), box}};
    const Vector3<TypeParam> far(std::numeric_limits<TypeParam>::max(), 1, 0);
    EXPECT_EQ(world.grid.shiftOrigin(far), 0U);
    EXPECT_EQ(world.grid.shiftOrigin(far), 0U);
    world.update();
    ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
}

// --- Cost and misuse -----------------------------------------------------------------------------

TYPED_TEST(OriginShift, LeavesTheCostOfQueriesAndUpdatesAsItWas) {
    PairWorld<TypeParam> world;
    auto proxies = settle(world, 1000);
    const auto costOfAll = [&](const Vector3<TypeParam>& origin) {
        std::uint64_t tested = 0;
        for (std::size_t i = 0; i < proxies.size(); i += 10) {
            CollectCount count;
            tested += world.grid.visit(BoxRegion<TypeParam>{proxies[i].box}, count).boxesTested;
            const Vector3<TypeParam> from(0, 0, 0);
            const RayRegion<TypeParam> ray(from - origin, proxies[i].box.max());
            tested += world.grid.visit(ray, count).boxesTested;
        }
        for (std::size_t i = 1; i < proxies.size(); i += 2) {
            world.move(proxies[i].id, proxies[i].box.translated(Vector3<TypeParam>(1, 0, 0)));
            world.move(proxies[i].id, proxies[i].box);
        }
        world.update();
        return std::pair(tested, world.pairs.lastCost().boxesTested);
    };
    const auto before = costOfAll(Vector3<TypeParam>::Zero());
    // Rays are tested more widely where numbers are coarse.
    const int far = sizeof(TypeParam) == sizeof(float) ? 1 << 11 : 1 << 20;
    const Vector3<TypeParam> by = Vector3<int>(far, -far, far / 2).cast<TypeParam>();
    shift(world, proxies, by);
    const auto after = costOfAll(by);
    EXPECT_LE(after.first, before.first + before.first / 10);
    EXPECT_EQ(after.second, before.second);
}

TYPED_TEST(OriginShift, ByNothingDoesNothing) {
    PairWorld<TypeParam> world;
    auto proxies = settle(world);
    EXPECT_EQ(world.grid.shiftOrigin(Vector3<TypeParam>::Zero()), 0U);
    ASSERT_NO_FATAL_FAILURE(world.check(proxies));
}

}  // namespace
}  // namespace hashphase::test
