// SPDX-License-Identifier: Zlib

// Where meshes meet that were placed by different transforms: their edges differ by rounding, and the
// ground has no hole there; but what is a hole stays one, and exact answers stay exact.

#include <tests/integration/terrain/chunks.hpp>
#include <tests/support/terrain_oracle.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::test {
namespace {

template <class Scalar>
class TerrainSeams : public testing::Test {
protected:
    using Found = std::optional<Ground<Scalar>>;

    /// The height that all points have, within `slack`, for the surface and small spheres, one by one
    /// and all at once. Returns how many lie in no triangle.
    static std::size_t expectGround(const Terrain<Scalar>& terrain,
                                    const std::vector<Vector3<Scalar>>& points, double above,
                                    double slack) {
        std::vector<Found> surfaces(points.size());
        std::vector<Found> rests(points.size());
        terrain.surfacesBelow(points, surfaces);
        std::size_t between = 0;
        for (const double radius : {0.0, 0.25, 2.0}) {
            std::vector<Scalar> radii;
            for (const Vector3<Scalar>& point : points) {
                radii.push_back(static_cast<Scalar>(radius) * terrain.seamTolerance(point));
            }
            terrain.restingHeights(points, radii, rests);
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Found& rest = rests[i];
                EXPECT_TRUE(surfaces[i] && rest) << points[i].transpose();
                if (!surfaces[i] || !rest) {
                    return 0;
                }
                EXPECT_EQ(surfaces[i], terrain.surfaceBelow(points[i]));
                EXPECT_EQ(rest, terrain.restingHeight(points[i], radii[i]));
                EXPECT_NEAR(surfaces[i]->height, points[i][1] - above, slack);
                EXPECT_NEAR(rest->height, points[i][1] - above, slack + 40 * radii[i]);
                between += radius == 0 && !hasPoint(terrain, surfaces[i]->triangle, points[i]);
            }
        }
        return between;
    }

    /// Whether the point lies in the triangle exactly, as seen from above.
    static bool hasPoint(const Terrain<Scalar>& terrain, std::uint32_t triangle,
                         const Vector3<Scalar>& point) {
        const auto corners = terrain.corners(triangle);
        const auto real = [](const Vector3<Scalar>& v) { return v.template cast<Real>().eval(); };
        return surfaceOf({real(corners[0]), real(corners[1]), real(corners[2])}, real(point))
                   .claim != Claim::no;
    }

    static constexpr double kEpsilon = std::numeric_limits<Scalar>::epsilon();
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TerrainSeams, Scalars);

TYPED_TEST(TerrainSeams, HaveGroundWhateverTheRotation) {
    Random random(0x5eed2401);
    std::size_t between = 0;
    for (const double away : {0.0, 0.0, 100.0, 5000.0}) {
        for (const double tilt : {0.0, 0.02, 0.7}) {
            for (int turn = 0; turn < 4; ++turn) {
                SCOPED_TRACE(testing::Message() << away << " m away, tilt " << tilt);
                const Chunks<TypeParam> chunks(random, away * random.pointIn(-1, 1), tilt);
                Grid<TypeParam> grid;
                Terrain<TypeParam> terrain(grid);
                chunks.addTo(terrain, 2, 3);
                grid.update();
                const auto points = chunks.onSeams(random, 2, 3, 5, 1500);
                const double slack = 100 * this->kEpsilon * (away + 64);
                between += this->expectGround(terrain, points, 5, slack);
                ASSERT_FALSE(this->HasFailure());
            }
        }
    }
    EXPECT_GT(between, 1000U);  // what is asked here is worth asking
}

TYPED_TEST(TerrainSeams, OfABridgeCarryThoughThereIsGroundBelow) {
    Random random(0x5eed2402);
    std::size_t between = 0;
    for (int turn = 0; turn < 20; ++turn) {
        const Chunks<TypeParam> chunks(random, random.pointIn(-50, 50), 0.3);
        Grid<TypeParam> grid;
        Terrain<TypeParam> terrain(grid);
        const std::vector<Vector3<TypeParam>> below{at<TypeParam>(-900, -99, -900),
                                                    at<TypeParam>(900, -99, -900),
                                                    at<TypeParam>(0, -99, 900)};
        terrain.add(below);
        chunks.addTo(terrain, 1, 3);
        grid.update();
        between += this->expectGround(terrain, chunks.onSeams(random, 1, 3, 1, 1000), 1,
                                      this->kEpsilon * 1e5);
        ASSERT_FALSE(this->HasFailure());
    }
    EXPECT_GT(between, 1000U);
}

TYPED_TEST(TerrainSeams, HaveGroundAfterAShiftOfTheOrigin) {
    Random random(0x5eed2403);
    for (int turn = 0; turn < 20; ++turn) {
        const Vector3<double> away(random.between(-9000, 9000), 0, random.between(-9000, 9000));
        const Chunks<TypeParam> chunks(random, away, 0);
        Grid<TypeParam> grid;
        Terrain<TypeParam> terrain(grid);
        chunks.addTo(terrain, 1, 3);
        grid.update();
        auto points = chunks.onSeams(random, 1, 3, 5, 1000);
        const Vector3<TypeParam> shift = away.cast<TypeParam>();
        grid.shiftOrigin(shift);
        terrain.shiftOrigin(shift);
        for (Vector3<TypeParam>& point : points) {
            point -= shift;
        }
        this->expectGround(terrain, points, 5, this->kEpsilon * 1e6);
        ASSERT_FALSE(this->HasFailure());
    }
}

// A shift rounds as coarsely as its origin is far, and the way back does not undo it.
TYPED_TEST(TerrainSeams, HaveGroundAfterTheOriginWasFarAway) {
    Random random(0x5eed2408);
    std::size_t between = 0;
    for (int turn = 0; turn < 20; ++turn) {
        const Chunks<TypeParam> chunks(random, random.pointIn(-50, 50), 0);
        Grid<TypeParam> grid;
        Terrain<TypeParam> terrain(grid);
        chunks.addTo(terrain, 1, 3);
        const Vector3<TypeParam> away = at<TypeParam>(random.between(-1e5, 1e5), 0, 3e5);
        for (const Vector3<TypeParam>& shift : {away, Vector3<TypeParam>(-away)}) {
            grid.shiftOrigin(shift);
            terrain.shiftOrigin(shift);
        }
        grid.update();
        between += this->expectGround(terrain, chunks.onSeams(random, 1, 3, 5, 1000), 5,
                                      this->kEpsilon * 1e7);
        ASSERT_FALSE(this->HasFailure());
    }
    EXPECT_GT(between, 1000U);
}

TYPED_TEST(TerrainSeams, LeaveGapsOfAMillimetreOpen) {
    Random random(0x5eed2404);
    std::vector<Vector3<TypeParam>> strip;
    for (const double x : {-20.0, 0.001}) {  // as far as -0.0 and from 0.001
        for (const auto& [i, k] :
             {std::pair(0.0, -20.0), std::pair(20.0, -20.0), std::pair(0.0, 20.0),
              std::pair(20.0, -20.0), std::pair(0.0, 20.0), std::pair(20.0, 20.0)}) {
            strip.push_back(at<TypeParam>(x + i, 0, k));
        }
    }
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    terrain.add(strip);
    for (int i = 0; i < 1000; ++i) {
        const double z = random.between(-19, 19);
        const double x = random.between(0.0003, 0.0007);
        EXPECT_FALSE(terrain.surfaceBelow(at<TypeParam>(x, 5, z)));
        EXPECT_FALSE(terrain.restingHeight(at<TypeParam>(x, 5, z), 0));
        EXPECT_FALSE(terrain.restingHeight(at<TypeParam>(x, 5, z), TypeParam(1e-5)));
        EXPECT_FALSE(terrain.surfaceBelow(at<TypeParam>(x + 20.001, 5, z)));
    }
    EXPECT_LT(terrain.seamTolerance(at<TypeParam>(20, 0, 20)), TypeParam(1e-4));
}

// Beside an inner edge of a mesh, where the next triangle is near, too, what is exactly below counts.
TYPED_TEST(TerrainSeams, LeaveExactAnswersAlone) {
    Random random(0x5eed2405);
    const Mesh<TypeParam> mesh = roughGround<TypeParam>(random, 12, 1, 6, 0.15);
    const GroundWorld<TypeParam> world(mesh);
    int nearEdges = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::uint32_t corner =
            3 * random.below(static_cast<std::uint32_t>(mesh.indices.size() / 3));
        const Vector3<double> a = mesh.vertices[mesh.indices[corner]].template cast<double>();
        const Vector3<double> b = mesh.vertices[mesh.indices[corner + 1]].template cast<double>();
        Vector3<TypeParam> point =
            (a + random.between(0.1, 0.9) * (b - a) + 4 * this->kEpsilon * random.pointIn(-12, 12))
                .template cast<TypeParam>();
        point[1] = 9;
        if (std::min(point[0], point[2]) < 1 || std::max(point[0], point[2]) > 11) {
            continue;
        }
        const auto ground = world.terrain.surfaceBelow(point);
        ASSERT_TRUE(ground);
        ASSERT_TRUE(this->hasPoint(world.terrain, ground->triangle, point));
        ++nearEdges;
    }
    EXPECT_GT(nearEdges, 5000);
}

TYPED_TEST(TerrainSeams, DoNotWidenOrCostMoreByAStrayCorner) {
    Random random(0x5eed2406);
    Mesh<TypeParam> mesh = roughGround<TypeParam>(random, 40, 1, 3, 0.15);
    const GroundWorld<TypeParam> clean(mesh);
    mesh.vertices.push_back(at<TypeParam>(1e30, 0, 1e30));
    mesh.indices.insert(mesh.indices.end(),
                        {0, 1, static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
    const GroundWorld<TypeParam> stray(mesh);
    std::vector<Vector3<TypeParam>> points;
    for (int i = 0; i < 2000; ++i) {
        points.push_back(random.pointIn({-1, 5, -1}, {41, 9, 41}).template cast<TypeParam>());
    }
    std::vector<std::optional<Ground<TypeParam>>> found(points.size());
    const QueryCost before = clean.terrain.surfacesBelow(points, found);
    const QueryCost after = stray.terrain.surfacesBelow(points, found);
    EXPECT_LT(after.hits, before.hits + before.hits / 10 + 2 * points.size());
    EXPECT_LT(stray.terrain.seamTolerance(points[0]), TypeParam(0.02));
}

// Chunks come and go in any order, also while the origin is shifted.
TYPED_TEST(TerrainSeams, HoldBetweenChunksThatAreStreamed) {
    Random random(0x5eed2407);
    std::size_t between = 0;
    for (int turn = 0; turn < 8; ++turn) {
        const Chunks<TypeParam> chunks(random, random.pointIn(-50, 50), 0.3);
        Grid<TypeParam> grid;
        Terrain<TypeParam> terrain(grid);
        if (turn % 2 == 1) {
            terrain.setSeamTolerance(static_cast<TypeParam>(8000 * this->kEpsilon));
        }
        std::vector<std::uint32_t> firsts = chunks.addTo(terrain, 2, 3);
        const std::uint32_t size = terrain.size();
        Vector3<TypeParam> shifted = Vector3<TypeParam>::Zero();
        for (int round = 0; round < 8; ++round) {
            std::vector<int> gone;
            for (int k = 0; k < 16; ++k) {
                if (random.chance(0.5)) {
                    const int step = (k % 4 + k / 4) % 2 == 0 ? 1 : 2;
                    const auto side = static_cast<std::uint32_t>(8 / step);
                    terrain.remove(firsts[static_cast<std::size_t>(k)], 2 * side * side);
                    gone.push_back(k);
                }
            }
            grid.update();
            while (!gone.empty()) {
                const std::size_t i = random.below(static_cast<std::uint32_t>(gone.size()));
                const int k = gone[i];
                gone.erase(gone.begin() + static_cast<std::ptrdiff_t>(i));
                auto corners = chunks.chunk(k % 4 - 2, k / 4 - 2, 3);
                for (Vector3<TypeParam>& corner : corners) {
                    corner -= shifted;
                }
                firsts[static_cast<std::size_t>(k)] = terrain.add(corners).first;
            }
            EXPECT_LE(terrain.size(), 2 * size);
            auto points = chunks.onSeams(random, 2, 3, 5, 200);
            for (Vector3<TypeParam>& point : points) {
                point -= shifted;
            }
            between += this->expectGround(terrain, points, 5, this->kEpsilon * 1e5);
            ASSERT_FALSE(this->HasFailure());
            const Vector3<TypeParam> by = at<TypeParam>(32, 0, -64);
            grid.shiftOrigin(by);
            terrain.shiftOrigin(by);
            shifted += by;
        }
    }
    EXPECT_GT(between, 500U);
}

}  // namespace
}  // namespace hashphase::test
