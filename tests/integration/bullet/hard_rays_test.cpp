// SPDX-License-Identifier: Zlib
//
// Rays and casts with hard numbers through Bullet's interface: what is found is what btRayAabb2() says
// with the callback's own fields, whatever these are, as under btDbvtBroadphase.

#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/queries.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

constexpr btScalar kNan = std::numeric_limits<btScalar>::quiet_NaN();
constexpr btScalar kInfinity = std::numeric_limits<btScalar>::infinity();
constexpr int kCubesAlong = 5;

/// Cubes of a metre that touch, plates, points, and boxes far away and of 1e18 m; the same under
/// Bullet's tree.
class RayWorld {
public:
    RayWorld() {
        for (int i = 0; i < kCubesAlong * kCubesAlong * kCubesAlong; ++i) {
            const btVector3 low(btScalar(i % kCubesAlong), btScalar(i / kCubesAlong % kCubesAlong),
                                btScalar(i / kCubesAlong / kCubesAlong));
            create({low, low + btVector3(1, 1, 1)});
        }
        create({{-9, 0, 0}, {9, btScalar(-0.0), 4}});
        create({{2, 2, 2}, {2, 2, 2}});
        create({{-1e18F, -1e18F, -1e18F}, {1e18F, -1, 1e18F}});
        create({{btScalar(1e9), 2, 2}, {btScalar(1.0001e9), 3, 3}});
        create({{btScalar(-1.0001e9), -1, -1}, {btScalar(-1e9), 4, 4}});
        create({{btScalar(1e18), btScalar(1e18), btScalar(1e18)},
                {btScalar(3e18), btScalar(3e18), btScalar(3e18)}});
    }

    /// Nothing is filed yet; everything is; much waits; most is at rest.
    void advance(int stage) {
        if (stage == 2) {
            for (int object = 0; object < count_; ++object) {
                const Box before = truth.box(object);
                if (object % 2 == 0 && (before.max - before.min).length() < 9) {
                    const btVector3 by(btScalar(0.25), 0, btScalar(-0.5));
                    play({Action::set, object, {before.min + by, before.max + by}, 0, 0});
                }
            }
            return;
        }
        for (int i = 0; i < (stage == 1 ? 1 : 20); ++i) {
            hash.calculate();
        }
    }

    /// Returns what both find.
    std::vector<int> expectAsBruteForceSays(const Ray& ray) const {
        CollectRay byHash(ray);
        hash.broadphase().rayTest(ray.from, ray.to, byHash, ray.castMin, ray.castMax);
        const std::vector<int> expected = bruteForceRay(truth, count_, ray);
        EXPECT_EQ(sorted(byHash.found), expected) << describe(ray);
        CollectRay byTree(ray);
        tree.broadphase().rayTest(ray.from, ray.to, byTree, ray.castMin, ray.castMax);
        EXPECT_EQ(sorted(byTree.found), expected) << "btDbvtBroadphase, " << describe(ray);
        return expected;
    }

    Truth truth{200};
    Player hash = hashPlayer(200);
    Player tree{200, std::make_unique<ExactDbvt>()};

private:
    void create(const Box& box) {
        play({Action::create, count_++, box, btBroadphaseProxy::DefaultFilter,
              btBroadphaseProxy::AllFilter});
    }
    void play(const Command& command) {
        truth.play({command});
        hash.play(command);
        tree.play(command);
    }

    int count_ = 0;
};

/// Along axes with zeros of either sign, in faces, along edges, through corners, of every length.
std::vector<Ray> hardRays() {
    std::vector<Ray> rays;
    const btScalar zero = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (const btScalar sign : {btScalar(1), btScalar(-1)}) {
            for (const btScalar at : {zero, -zero, btScalar(2), btScalar(2.5)}) {
                Ray ray{{at, at, at}, {at, at, at}};
                ray.from[axis] = sign * btScalar(-9);
                ray.to[axis] = sign * btScalar(9);
                ray.to[(axis + 1) % 3] = at == 0 ? -zero : at;
                rays.push_back(ray);
                ray.from[(axis + 1) % 3] = ray.to[(axis + 1) % 3] = btScalar(3.25);
                rays.push_back(ray);
            }
            rays.push_back({sign * btVector3(-9, -9, -9), sign * btVector3(9, 9, 9)});
            for (const double length : {1e5, 3.4e7, 1e9}) {
                btVector3 end(2, 2, 2);
                end[axis] = sign * btScalar(length);
                rays.push_back({{2, 2, 2}, end});
                rays.push_back({-end, {btScalar(2.5), btScalar(2.5), btScalar(2.5)}});
            }
        }
    }
    return rays;
}

TEST(HardRays, FindWhatBruteForceAndBulletsTreeFind) {
    RayWorld world;
    std::size_t found = 0;
    for (int stage = 0; stage < 4; ++stage) {
        SCOPED_TRACE(stage);
        world.advance(stage);
        for (Ray ray : hardRays()) {
            found += world.expectAsBruteForceSays(ray).size();
            ray.castMin = {btScalar(-0.5), 0, btScalar(-0.25)};
            ray.castMax = {btScalar(0.5), btScalar(0.1), btScalar(0.25)};
            found += world.expectAsBruteForceSays(ray).size();
        }
    }
    EXPECT_GT(found, 2000U);
}

// Bullet divides by the length, whose square overflows or is 0: what its fields come to then is what
// counts, in either broadphase.
TEST(HardRays, OfLengthsThatCannotBeSquaredFindWhatBulletsFieldsSay) {
    RayWorld world;
    world.advance(1);
    const bool isSingle = sizeof(btScalar) == sizeof(float);
    for (const double length : {1e19, 1e30, isSingle ? 3e38 : 1e200, isSingle ? 1e-30 : 1e-200}) {
        for (int axis = 0; axis < 3; ++axis) {
            Ray ray{{btScalar(2.5), btScalar(2.5), btScalar(2.5)},
                    {btScalar(2.5), btScalar(2.5), btScalar(2.5)}};
            ray.from[axis] = btScalar(-length);
            ray.to[axis] = btScalar(length);
            world.expectAsBruteForceSays(ray);
            ray.from = btVector3(2, 2, 2);
            ray.to = ray.from + btVector3(1, 1, 1) * btScalar(length);
            world.expectAsBruteForceSays(ray);
        }
    }
    // 1e19 can be squared in double precision: the whole row is met.
    const auto far = static_cast<btScalar>(1e19);
    const Ray row{{-far, btScalar(2.5), btScalar(2.5)}, {far, btScalar(2.5), btScalar(2.5)}};
    EXPECT_EQ(world.expectAsBruteForceSays(row).size() >= kCubesAlong, !isSingle);
}

// Of the direction of a ray without length Bullet makes NaN, so that nothing is hit; a cast without
// length asks for the place itself, and so does the grid.
TEST(HardRays, OfNoLengthFindNothingUnlessTheyAreCasts) {
    RayWorld world;
    for (int stage = 0; stage < 4; ++stage) {
        world.advance(stage);
        for (const btVector3& at : {btVector3(2, 2, 2), btVector3(btScalar(1.5), 2, btScalar(0.5)),
                                    btVector3(-20, -20, -20), btVector3(0, 0, 0)}) {
            EXPECT_EQ(world.expectAsBruteForceSays({at, at}).size(), 0U);
            Ray cast{at, at};
            cast.castMin = {btScalar(-0.25), btScalar(-0.25), btScalar(-0.25)};
            cast.castMax = -cast.castMin;
            EXPECT_GT(world.expectAsBruteForceSays(cast).size(), 0U);
        }
    }
}

TEST(HardRays, WithABadNumberAnywhereFindNothing) {
    RayWorld world;
    world.advance(1);
    for (const btScalar bad : {kNan, kInfinity, -kInfinity}) {
        for (int field = 0; field < 6; ++field) {
            Ray ray{{-9, btScalar(2.5), btScalar(2.5)}, {9, btScalar(1.5), 2}};
            (field < 3 ? ray.from : ray.to)[field % 3] = bad;
            CollectRay byRay(ray);
            world.hash.broadphase().rayTest(ray.from, ray.to, byRay);
            EXPECT_TRUE(byRay.found.empty()) << describe(ray);
        }
    }
    for (int field = 0; field < 6; ++field) {
        Box box{{-9, -9, -9}, {9, 9, 9}};
        (field < 3 ? box.min : box.max)[field % 3] = kNan;
        CollectBox byBox;
        world.hash.broadphase().aabbTest(box.min, box.max, byBox);
        EXPECT_TRUE(byBox.found.empty()) << describe(box);
    }
}

// Comparing with NaN is false, by which btRayAabb2() takes some slabs for hit and others for
// missed.
TEST(HardRays, ThatAreFatByNanFindWhatBulletsFieldsSay) {
    RayWorld world;
    std::size_t found = 0;
    for (int stage = 0; stage < 4; ++stage) {
        SCOPED_TRACE(stage);
        world.advance(stage);
        for (int field = 0; field < 6; ++field) {
            Ray cast{{-9, btScalar(2.5), btScalar(2.5)}, {9, btScalar(1.5), 2}};
            cast.castMin = {btScalar(-0.5), btScalar(-0.5), btScalar(-0.5)};
            cast.castMax = -cast.castMin;
            EXPECT_GT(world.expectAsBruteForceSays(cast).size(), 5U);
            (field < 3 ? cast.castMin : cast.castMax)[field % 3] = kNan;
            found += world.expectAsBruteForceSays(cast).size();
        }
    }
    EXPECT_GT(found, 0U);
}

// closestRay() asks about as little for the worst of rays as for others.
TEST(HardRays, CostAtMostATestForEachBox) {
    RayWorld world;
    world.advance(1);
    const SpatialHashBroadphase& broadphase = hashOf(world.hash);
    const auto boxes = static_cast<std::uint64_t>(broadphase.grid().size());
    for (const btScalar far : {btScalar(1e9), btScalar(1e18), btScalar(1e30), kInfinity, kNan}) {
        for (const btVector3& from : {btVector3(-far, 2, 2), btVector3(-far, -far, -far)}) {
            for (const btVector3& to : {btVector3(far, 2, 2), -from, from}) {
                btCollisionWorld::ClosestRayResultCallback closest(from, to);
                closest.m_collisionFilterMask = 0;
                const QueryCost cost = broadphase.closestRay(from, to, closest);
                EXPECT_LE(cost.boxesTested, boxes);
                EXPECT_LE(cost.rowsVisited, boxes);
            }
        }
    }
}

}  // namespace
}  // namespace hashphase::test
