// SPDX-License-Identifier: Zlib

// Ground that changes: triangles are removed, replaced and streamed, keep their numbers, and leave nothing
// behind; what changes is all that costs.

#include <tests/integration/terrain/changing_ground.hpp>
#include <tests/support/count_allocations.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/terrain_oracle.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace hashphase::test {
namespace {

template <class Scalar>
class TerrainChanges : public testing::Test {
protected:
    using Point = Vector3<Scalar>;
    using Corners = std::vector<Point>;

    static Corners flat(double y, double x = 0) {
        return {at<Scalar>(x, y, 0), at<Scalar>(x + 4, y, 0), at<Scalar>(x, y, 4)};
    }
    static Corners bad() {
        Corners corners = flat(1);
        corners[1][0] = std::numeric_limits<Scalar>::quiet_NaN();
        return corners;
    }
    static Scalar heightAt(const Terrain<Scalar>& terrain, double x = 1) {
        const auto found = terrain.surfaceBelow(at<Scalar>(x, 90, 1));
        return found ? found->height : Scalar(-1);
    }

    /// Chunks of `quads` x `quads` quads of 1 m, side by side.
    static Corners chunk(Random& random, std::uint32_t quads, double x, double z) {
        return roughGround<Scalar>(random, quads, 1, 2, 0.1, {x, 0, z}).corners();
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TerrainChanges, Scalars);

TYPED_TEST(TerrainChanges, LeaveTheGroundOfANewTerrain) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        ChangingGround<TypeParam> ground(0x5eed2510 + seed, static_cast<UpAxis>(seed % 3));
        constexpr std::array<double, 3> tolerances{0, 1e-4, 0.05};
        ground.terrain.setSeamTolerance(static_cast<TypeParam>(tolerances[seed / 4]));
        for (int step = 0; step < 400; ++step) {
            ground.step();
            ASSERT_FALSE(this->HasFailure()) << "step " << step;
            if (step % 5 == 0) {
                ground.expectNumbers();
                ground.expectAnswersOfANewOne(20);
                ASSERT_FALSE(this->HasFailure()) << "step " << step;
            }
        }
        EXPECT_EQ(ground.grid.validate(), "");
    }
}

TYPED_TEST(TerrainChanges, LeaveWhatAllTrianglesSay) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
        const auto up = static_cast<UpAxis>(seed);
        ChangingGround<TypeParam> ground(0x5eed2520 + seed, up);
        for (int step = 0; step < 300; ++step) {
            ground.step();
            if (step % 30 != 0) {
                continue;
            }
            const TerrainOracle<TypeParam> oracle(ground.terrain, up);
            for (int i = 0; i < 15; ++i) {
                const auto point = ground.drawPoint();
                const auto radius = static_cast<TypeParam>(ground.random.between(0.3, 1));
                ASSERT_EQ(oracle.checkSurface(point, ground.terrain.surfaceBelow(point)), "");
                ASSERT_EQ(
                    oracle.checkRest(point, radius, ground.terrain.restingHeight(point, radius)),
                    "");
            }
        }
    }
}

TYPED_TEST(TerrainChanges, GiveTheLowestFreeNumbersThatSuffice) {
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    for (int i = 0; i < 10; ++i) {
        terrain.add(this->flat(i, 10 * i));
    }
    terrain.remove(2);
    terrain.remove(5, 3);
    EXPECT_EQ(terrain.size(), 10U);
    EXPECT_TRUE(terrain.proxy(6).isNull());
    EXPECT_TRUE(terrain.corners(6)[2].hasNaN());
    EXPECT_EQ(terrain.normal(6), Vector3<TypeParam>::Zero());
    EXPECT_EQ(this->heightAt(terrain, 61), -1);
    EXPECT_EQ(this->heightAt(terrain, 91), 9);
    auto two = this->flat(50, 61);
    const auto second = this->flat(51, 71);
    two.insert(two.end(), second.begin(), second.end());
    EXPECT_EQ(terrain.add(two).first, 5U);
    EXPECT_EQ(terrain.surfaceBelow(at<TypeParam>(72, 90, 1))->triangle, 6U);
    EXPECT_EQ(terrain.add(this->bad()).first, 2U);
    EXPECT_EQ(terrain.add(two).first, 10U);
    // What is free at the end is not too short for anything.
    terrain.remove(11);
    EXPECT_EQ(terrain.add(two).first, 11U);
    EXPECT_EQ(terrain.add(this->flat(3)).first, 7U);
    EXPECT_EQ(terrain.size(), 13U);
}

TYPED_TEST(TerrainChanges, MakeBadTrianglesGoodAndGoodOnesBad) {
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    const ProxyId other = grid.add(boxAround<TypeParam>({0, 0, 0}, 1));
    terrain.add(this->bad());
    terrain.add(this->flat(1));
    const ProxyId kept = terrain.proxy(1);
    EXPECT_TRUE(terrain.replace(0, this->flat(5)).refused.empty());
    EXPECT_EQ(this->heightAt(terrain), 5);
    EXPECT_FALSE(terrain.proxy(0).isNull());
    EXPECT_EQ(terrain.replace(0, this->bad()).refused, std::vector<std::uint32_t>{0});
    EXPECT_EQ(this->heightAt(terrain), 1);
    EXPECT_TRUE(terrain.proxy(0).isNull());
    EXPECT_TRUE(terrain.replace(1, this->flat(7)).refused.empty());
    EXPECT_EQ(this->heightAt(terrain), 7);
    EXPECT_EQ(terrain.proxy(1), kept);
    const std::vector<std::uint32_t> indices{0, 1, 2, 0, 1, 3};
    EXPECT_EQ(terrain.replace(0, this->flat(8), indices).refused, std::vector<std::uint32_t>{1});
    EXPECT_EQ(this->heightAt(terrain), 8);
    terrain.remove(0, 2);
    EXPECT_EQ(grid.size(), 1U);
    EXPECT_TRUE(grid.contains(other));
}

TYPED_TEST(TerrainChanges, NameTheTriangleOfAProxy) {
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    const ProxyId other = grid.add(boxAround<TypeParam>({0, 0, 0}, 1));
    terrain.add(this->flat(1));
    const ProxyId id = terrain.proxy(0);
    EXPECT_EQ(terrain.triangleOf(id), 0U);
    EXPECT_FALSE(terrain.triangleOf(other));
    EXPECT_FALSE(terrain.triangleOf(ProxyId{}));
    EXPECT_FALSE(terrain.triangleOf({id.index, id.generation + 2}));
    terrain.remove(0);
    EXPECT_FALSE(terrain.triangleOf(id));
}

// A player walks through a world of chunks of several sizes, forth and back, for long.
TYPED_TEST(TerrainChanges, TakeNoMoreMemoryAfterHours) {
    Random random(0x5eed2530);
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    std::vector<typename TestFixture::Corners> drawn;
    for (std::uint32_t quads = 1; quads <= 6; ++quads) {
        drawn.push_back(this->chunk(random, quads, 0, 0));
    }
    std::vector<AddedTriangles> loaded;
    std::size_t bytes = 0;
    std::size_t gridBytes = 0;
    std::size_t most = 0;
    std::size_t count = 0;
    const int rounds = 6000;
    for (int round = 0; round < rounds; ++round) {
        auto corners = drawn[random.below(6)];
        for (auto& corner : corners) {
            corner[0] += static_cast<TypeParam>(round);
        }
        loaded.push_back(terrain.add(corners));
        count += loaded.back().count;
        most = std::max(most, count);
        if (loaded.size() > 60) {
            const std::size_t i = random.below(static_cast<std::uint32_t>(loaded.size()));
            terrain.remove(loaded[i].first, loaded[i].count);
            count -= loaded[i].count;
            loaded.erase(loaded.begin() + static_cast<std::ptrdiff_t>(i));
        }
        grid.update();
        if (round == rounds / 2) {
            bytes = terrain.memoryBytes();
            gridBytes = grid.memoryBytes();
        }
    }
    EXPECT_EQ(terrain.memoryBytes(), bytes);
    EXPECT_LE(grid.memoryBytes(), gridBytes + gridBytes / 4);
    EXPECT_LE(terrain.size(), most + most / 2);
    EXPECT_EQ(grid.size(), count);
}

TYPED_TEST(TerrainChanges, AllocateNothingOnceAsMuchComesAsGoes) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    Random random(0x5eed2540);
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    ChangedGround<TypeParam> changed(terrain);
    std::vector<typename TestFixture::Corners> chunks;
    std::vector<std::uint32_t> firsts;
    for (int i = 0; i < 20; ++i) {
        chunks.push_back(this->chunk(random, 8, 8 * i, 0));
        firsts.push_back(terrain.add(chunks.back()).first);
    }
    std::vector<ProxyId> standing;
    standing.reserve(1000);
    std::size_t before = 0;
    for (std::size_t frame = 0; frame < 1200; ++frame) {
        before = frame == 600 ? allocationCount() : before;
        const std::size_t i = frame % 20;
        terrain.remove(firsts[i], 128);
        firsts[i] = terrain.add(chunks[i]).first;
        terrain.replace(firsts[(i + 7) % 20], chunks[(i + frame) % 20]);
        terrain.replace(firsts[(i + 7) % 20] + 5, std::span(chunks[i]).first(3));
        changed.findStanding(grid, 1, standing);
        changed.clear();
        grid.update();
    }
    EXPECT_EQ(allocationCount(), before);
}

TYPED_TEST(TerrainChanges, CostWhatHasChanged) {
    Random random(0x5eed2550);
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    const auto corners = this->chunk(random, 160, 0, 0);
    terrain.add(corners);
    ASSERT_GE(terrain.size(), 50000U);
    for (int i = 0; i < 4; ++i) {  // then all rest
        terrain.replace(0, std::span(corners).subspan(i % 2 == 0 ? 3 : 0, 3));
        grid.update();
    }
    ChangedGround<TypeParam> changed(terrain);
    std::vector<ProxyId> standing;
    const auto expectLittle = [&] {
        const QueryCost query = changed.findStanding(grid, 1, standing);
        EXPECT_LT(query.boxesTested, 500U);
        EXPECT_LE(changed.boxes().size(), 2U);
        changed.clear();
        const UpdateCost update = grid.update();
        EXPECT_EQ(update.changed, 1U);
        EXPECT_LE(update.filed, 20U);
    };
    for (std::uint32_t number = 0; number < 15; ++number) {
        auto risen = terrain.corners(2000 + 3000 * number);
        risen[1][1] += 1;
        terrain.replace(2000 + 3000 * number, risen);
        expectLittle();
    }
    terrain.remove(30000);
    expectLittle();
    EXPECT_EQ(terrain.add(std::span(corners).first(3)).first, 30000U);
    expectLittle();
    // One that is set again as it is has not changed.
    terrain.replace(1000, std::span(corners).subspan(3000, 3));
    EXPECT_TRUE(changed.boxes().empty());
    EXPECT_EQ(grid.update().changed, 0U);
}

// Many points are looked at tile by tile; the tiles follow the ground.
TYPED_TEST(TerrainChanges, KeepManyPointsAsCheapWhereverTheGroundGoes) {
    Random random(0x5eed2560);
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    std::vector<AddedTriangles> loaded;
    const auto rowsAt = [&](int place) {
        std::vector<Vector3<TypeParam>> points;
        Random same(0x5eed2561);
        for (int i = 0; i < 4000; ++i) {
            points.push_back((same.pointIn({0, 5, 0}, {64, 9, 16}) + Vector3<double>(place, 0, 0))
                                 .template cast<TypeParam>());
        }
        std::vector<std::optional<Ground<TypeParam>>> found(points.size());
        grid.update();
        return terrain.surfacesBelow(points, found).rowsVisited;
    };
    std::uint64_t first = 0;
    for (int place = 0; place < 16384; place += 16) {
        loaded.push_back(terrain.add(this->chunk(random, 16, place, 0)));
        if (loaded.size() > 4) {
            terrain.remove(loaded.front().first, loaded.front().count);
            loaded.erase(loaded.begin());
        }
        if (place == 1024) {
            first = rowsAt(place - 48);
        }
    }
    EXPECT_LT(rowsAt(16384 - 64), first + first / 4);
}

TYPED_TEST(TerrainChanges, AreOfTrianglesThatAreThere) {
    const auto expectNothing = [&](const auto& misuse) {
        Grid<TypeParam> grid;
        Terrain<TypeParam> terrain(grid);
        for (int i = 0; i < 4; ++i) {
            terrain.add(this->flat(i));
        }
        terrain.remove(1);
        if (HASHPHASE_ENABLE_ASSERTS) {
            const ThrowingAsserts asserts;
            EXPECT_THROW(misuse(terrain), BrokenAssert);
        }
        const CaughtAsserts caught;
        misuse(terrain);
        EXPECT_EQ(grid.size(), 3U);
        EXPECT_EQ(terrain.size(), 4U);
        EXPECT_EQ(this->heightAt(terrain), 3);
        EXPECT_EQ(terrain.add(this->flat(2)).first, 1U);
    };
    using Ground = Terrain<TypeParam>;
    expectNothing([](Ground& terrain) { terrain.remove(4); });
    expectNothing([](Ground& terrain) { terrain.remove(3, 2); });
    expectNothing([](Ground& terrain) { terrain.remove(2, ~0U); });
    expectNothing([](Ground& terrain) { terrain.remove(~0U); });
    expectNothing([](Ground& terrain) { terrain.remove(1); });
    expectNothing([](Ground& terrain) { terrain.remove(0, 3); });
    expectNothing([&](Ground& terrain) { terrain.replace(1, this->flat(9)); });
    expectNothing([&](Ground& terrain) { terrain.replace(4, this->flat(9)); });
    expectNothing([](Ground& terrain) {
        terrain.replace(0, std::vector<Vector3<TypeParam>>(2, at<TypeParam>(0, 9, 0)));
    });
    expectNothing([&](Ground& terrain) {
        terrain.replace(0, this->flat(9), std::vector<std::uint32_t>{0, 1});
    });
}

TYPED_TEST(TerrainChanges, OfNoTrianglesAreNone) {
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    EXPECT_EQ(terrain.add({}).count, 0U);
    terrain.remove(0, 0);
    EXPECT_EQ(terrain.replace(0, {}).count, 0U);
    terrain.add(this->flat(1));
    terrain.remove(1, 0);
    EXPECT_EQ(this->heightAt(terrain), 1);
}

TEST(TerrainMemory, IsThatOfAProgramThatReserves) {
    const std::vector<Vector3<float>> corners{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    for (const std::size_t reserved : {0U, 20'000U}) {
        Grid<float> grid;
        grid.reserve(reserved);
        Terrain<float> terrain(grid);
        const auto boxAt = [](int x) {
            const Vector3<float> corner(static_cast<float>(x), 5, 0);
            return Aabb<float>(corner, corner + Vector3<float>::Ones());
        };
        const ProxyId moving = grid.add(boxAt(0));
        std::vector<Vector3<float>> many;
        for (int i = 0; i < 10'000; ++i) {
            many.insert(many.end(), corners.begin(), corners.end());
        }
        terrain.add(many);
        terrain.clear();
        const std::size_t before = grid.memoryBytes();
        for (int frame = 0; frame < 600; ++frame) {
            grid.move(moving, boxAt(frame));
            grid.update();
        }
        if (reserved > 0) {
            EXPECT_GT(grid.memoryBytes(), before / 4 * 3);
        } else {
            EXPECT_LT(grid.memoryBytes(), before / 10);
        }
    }
}

}  // namespace
}  // namespace hashphase::test
