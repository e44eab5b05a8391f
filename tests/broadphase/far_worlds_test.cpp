// SPDX-License-Identifier: Zlib

// Worlds far from the origin: where coordinates are exact everything is as at the origin, and where
// they are rounded nothing that the rounded boxes touch is missed.

#include <broadphase/pairs.hpp>
#include <integration/ai/nearest.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/ray_oracle.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class FarWorlds : public testing::Test {
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(FarWorlds, Scalars);

// --- The same as at the origin -------------------------------------------------------------------

template <class Scalar>
Aabb<Scalar> moved(const Aabb<Scalar>& box, const Vector3<Scalar>& by) {
    return {box.min() + by, box.max() + by};
}

template <class Scalar>
bool isMovedExactly(const Aabb<Scalar>& box, const Vector3<Scalar>& by) {
    const Aabb<Scalar> far = moved(box, by);
    return ((far.min() - by).array() == box.min().array()).all() &&
           ((far.max() - by).array() == box.max().array()).all();
}

/// The scene with its boxes rounded to multiples of `step`.
template <class Scalar>
BoxScene<Scalar> onLattice(BoxScene<Scalar> scene, Scalar step) {
    const auto round = [step](const Aabb<Scalar>& box) {
        return Aabb<Scalar>((box.min() / step).array().round() * step,
                            (box.max() / step).array().round() * step);
    };
    scene.draw = [round, draw = scene.draw](Random& random) { return round(draw(random)); };
    scene.nudge = [round, nudge = scene.nudge](Random& random, const Aabb<Scalar>& box) {
        return round(nudge(random, box));
    };
    return scene;
}

/// A world at the origin and its twin far away, as one World for scripts. What cannot be moved without
/// rounding stays where it is, in both.
template <class Scalar>
class TwinWorlds {
public:
    explicit TwinWorlds(const Vector3<Scalar>& away) : away_(away) {}

    ProxyId add(const Aabb<Scalar>& box, Mobility mobility) {
        const ProxyId id = near.add(placed(box), mobility);
        EXPECT_EQ(far.add(farOf(placed(box)), mobility), id);
        return id;
    }
    void move(ProxyId id, const Aabb<Scalar>& box) {
        near.move(id, placed(box));
        far.move(id, farOf(placed(box)));
    }
    void remove(ProxyId id) {
        near.remove(id);
        far.remove(id);
    }
    static void refilter(ProxyId /*id*/) {}

    void updateAlike() {
        const auto all = [](ProxyId, ProxyId) { return true; };
        const PairChanges here = pairsNear.update(all);
        const PairChanges there = pairsFar.update(all);
        ASSERT_TRUE(std::ranges::equal(here.born, there.born));
        ASSERT_TRUE(std::ranges::equal(here.died, there.died));
        ASSERT_EQ(pairsNear.count(), pairsFar.count());
        births += here.born.size();
        testedNear += pairsNear.lastCost().boxesTested;
        testedFar += pairsFar.lastCost().boxesTested;
    }

    /// Asks both where a box is, in coordinates of their own.
    void askAlike(const Aabb<Scalar>& given) {
        const Aabb<Scalar> box = placed(given);
        const Vector3<Scalar> low = box.min();
        const Vector3<Scalar> to = low.reverse();
        if (!isMovedExactly({to, to}, away_)) {
            return;
        }
        compare(BoxRegion<Scalar>{box}, BoxRegion<Scalar>{farOf(box)});
        compare(SphereRegion<Scalar>{low, 2}, SphereRegion<Scalar>{low + away_, 2});
        compare(RayRegion<Scalar>(low, to), RayRegion<Scalar>(low + away_, to + away_));
        std::vector<KeyedProxy<Scalar>> here;
        std::vector<KeyedProxy<Scalar>> there;
        testedNear += findNearest(near, low, 3, Scalar(1000), here).boxesTested;
        testedFar += findNearest(far, low + away_, 3, Scalar(1000), there).boxesTested;
        const auto ids = [](const std::vector<KeyedProxy<Scalar>>& found) {
            std::vector<ProxyId> all;
            std::ranges::transform(found, std::back_inserter(all), &KeyedProxy<Scalar>::id);
            return all;
        };
        // Positions are middles, which have a digit more than boxes.
        EXPECT_EQ(ids(here), ids(there));
    }

    Grid<Scalar> near;
    Grid<Scalar> far;
    Pairs<Scalar> pairsNear{near};
    Pairs<Scalar> pairsFar{far};
    std::size_t births = 0;
    std::size_t hits = 0;
    std::uint64_t testedNear = 0;
    std::uint64_t testedFar = 0;
    std::size_t strays = 0;

private:
    // The lattice is cut off where the far world has no numbers for it.
    Aabb<Scalar> placed(const Aabb<Scalar>& box) {
        if (isMovedExactly(box, away_)) {
            return box;
        }
        ++strays;
        return {Vector3<Scalar>::Zero(), Vector3<Scalar>::Ones()};
    }
    Aabb<Scalar> farOf(const Aabb<Scalar>& box) const { return moved(box, away_); }

    template <class Region>
    void compare(const Region& here, const Region& there) {
        CollectKeys<Scalar> foundNear;
        CollectKeys<Scalar> foundFar;
        testedNear += near.visit(here, foundNear).boxesTested;
        testedFar += far.visit(there, foundFar).boxesTested;
        hits += foundNear.sorted().size();
        EXPECT_EQ(foundFar.sorted(), foundNear.sorted());
    }

    Vector3<Scalar> away_;
};

/// The scenes that have a middle, in numbers of which a lattice keeps what matters.
template <class Scalar>
std::vector<BoxScene<Scalar>> latticeScenes(Scalar step) {
    std::vector<BoxScene<Scalar>> scenes;
    for (const BoxScene<Scalar>& scene : allBoxScenes<Scalar>()) {
        if (scene.name != "denormal" && scene.name != "enormous") {
            scenes.push_back(onLattice(scene, step));
        }
    }
    return scenes;
}

template <class Scalar>
void expectAlike(const BoxScene<Scalar>& scene, const Vector3<Scalar>& away) {
    SCOPED_TRACE(testing::Message() << scene.name << " at " << away.transpose());
    Script<Scalar> script(scene, 0x5eed2101);
    TwinWorlds<Scalar> worlds(away);
    script.begin(worlds);
    std::size_t boxes = 0;
    for (int frame = 0; frame < 8; ++frame) {
        script.playFrame(worlds);
        for (const Placed<Scalar>& proxy : script.proxies()) {
            ++boxes;
            if (script.random().chance(0.02)) {
                worlds.askAlike(proxy.box);
            }
        }
        ASSERT_NO_FATAL_FAILURE(worlds.updateAlike());
    }
    ASSERT_EQ(worlds.far.validate(), "");
    EXPECT_GT(worlds.births, 10U);
    EXPECT_GT(worlds.hits, 10U);
    EXPECT_LE(worlds.testedFar, worlds.testedNear + worlds.testedNear / 10 + 1000);
    // Most of a scene has far away what it has here, or it would show nothing.
    if (scene.name != "hostile numbers") {
        EXPECT_LT(worlds.strays, boxes / 4);
    }
}

TYPED_TEST(FarWorlds, AreThoseAtTheOriginWhereCoordinatesAreExact) {
    // Steps of which the farthest coordinate still is a multiple.
    const bool isDouble = std::is_same_v<TypeParam, double>;
    const auto step = static_cast<TypeParam>(isDouble ? 0x1p-20 : 0x1p-6);
    for (const BoxScene<TypeParam>& scene : latticeScenes(step)) {
        const bool isFar = scene.name == "at 1e6" || scene.name == "at -1e9";
        if (!isDouble && isFar) {
            continue;  // is one already
        }
        int axis = 0;
        for (int power = 10; power <= (isDouble ? 30 : 16); power += isDouble ? 5 : 2) {
            const auto distance =
                static_cast<TypeParam>(std::ldexp(power % 4 == 0 ? -1 : 1, power));
            Vector3<TypeParam> away = Vector3<TypeParam>::Zero();
            away[axis++ % 3] = distance;
            expectAlike(scene, away);
            if (power == 30 || power == 16) {
                expectAlike<TypeParam>(scene, {distance, -distance, distance});
            }
            if (this->HasFatalFailure()) {
                return;
            }
        }
    }
}

// --- Rounded boxes -------------------------------------------------------------------------------

// In single precision the boxes of a metre have no extent there, or that of a few numbers.
TYPED_TEST(FarWorlds, MissNoPairAndNothingThatIsAskedForWhateverTheRounding) {
    for (const double middle : {0x1p24, 1e7, -1e8, 1e9, -1e9}) {
        SCOPED_TRACE(middle);
        BoxScene<TypeParam> scene = spreadScene<TypeParam>("boxes of a metre", 1, middle);
        scene.draw = [middle, draw = scene.draw](Random& random) {
            const Aabb<TypeParam> there = draw(random);
            if (random.chance(0.8)) {
                return there;
            }
            // Some elsewhere, from the origin on.
            const Vector3<double> center = random.unit() * random.pointIn(-middle, middle);
            return boxAround<TypeParam>(center, random.pointIn(0.3, 3));
        };
        Script<TypeParam> script(scene, 0x5eed2102);
        PairWorld<TypeParam> world;
        script.begin(world);
        for (int frame = 0; frame < 20; ++frame) {
            if (frame > 0) {
                script.playFrame(world);
            }
            RegionMaker<TypeParam> make(script.random(), script.proxies());
            for (int i = 0; i < 4; ++i) {
                expectLikeBruteForce(world.grid, script.proxies(), make.box());
                expectLikeBruteForce(world.grid, script.proxies(), make.sphere());
                expectLikeBruteForce(world.grid, script.proxies(), make.ray());
                expectLikeBruteForce(world.grid, script.proxies(), make.ray(true));
            }
            world.update();
            ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(script.proxies()));
            ASSERT_FALSE(this->HasFailure());
        }
        EXPECT_GT(world.set().size(), 20U);
    }
}

// --- Rays ----------------------------------------------------------------------------------------

// Rays that run out there, and those that come from the origin, aimed at corners and edges.
TYPED_TEST(FarWorlds, RaysMissNothingThatTheyMeetInRationalNumbers) {
    Random random(0x5eed2103);
    for (const double middle : {0x1p20, -0x1p24, 1e7, 0x1p30, -1e9}) {
        SCOPED_TRACE(middle);
        Grid<TypeParam> grid;
        std::vector<Placed<TypeParam>> proxies;
        for (int i = 0; i < 150; ++i) {
            const Aabb<TypeParam> box = boxAround<TypeParam>(
                random.pointIn(middle - 30, middle + 30), random.pointIn(0.2, 2));
            proxies.push_back({grid.add(box), box});
        }
        grid.update();
        std::size_t met = 0;
        for (int i = 0; i < 60; ++i) {
            const Aabb<TypeParam>& aim = proxies[random.below(150)].box;
            Vector3<TypeParam> from =
                random.chance(0.5)
                    ? Vector3<TypeParam>(random.pointIn(middle - 60, middle + 60).cast<TypeParam>())
                    : Vector3<TypeParam>(random.pointIn(-60, 60).cast<TypeParam>());
            const Vector3<TypeParam> edge(aim.min()[0], aim.max()[1], aim.min()[2]);
            const Vector3<TypeParam> to = random.chance(0.5)
                                              ? Vector3<TypeParam>(edge + (edge - from))
                                              : Vector3<TypeParam>(edge);
            if (random.chance(0.3)) {
                from[random.below(3)] = edge[0];
            }
            const auto found = find(grid, RayRegion<TypeParam>(from, to));
            for (const Placed<TypeParam>& proxy : proxies) {
                const bool isFound = std::ranges::any_of(
                    found, [&proxy](const auto& each) { return each.first == proxy.id; });
                const bool isMet = meetsByRationals(from, to, proxy.box);
                met += isMet ? 1 : 0;
                ASSERT_TRUE(isFound || !isMet)
                    << from.transpose() << " to " << to.transpose() << " misses "
                    << proxy.box.min().transpose() << ", " << proxy.box.max().transpose();
            }
        }
        EXPECT_GT(met, 30U);
    }
}

}  // namespace
}  // namespace hashphase::test
