// SPDX-License-Identifier: Zlib

// Populations of every kind in a table: every pair is found once, by the join and by looking for every box, at a
// cost that is bounded.

#include <broadphase/hash/levels.hpp>
#include <broadphase/hash/table.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/fill_table.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace hashphase::detail {
namespace {

using test::boxAround;
using test::BoxScene;
using test::cubesIn;
using test::drawBoxes;
using test::Random;

template <class Scalar>
class TableTest : public testing::Test {
protected:
    using Boxes = std::vector<Aabb<Scalar>>;

    Boxes draw(std::size_t count, double low, double high, double half) {
        return drawBoxes<Scalar>(random_, count, cubesIn<Scalar>(low, high, half));
    }

    /// How many are filed in the cells that are dense (0), or hashed (1).
    [[nodiscard]] std::uint32_t countIn(std::size_t level) const {
        return filled_.table.levels()[level].count();
    }

    test::FilledTable<Scalar> filled_;
    Random random_{0x5eed0401};
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TableTest, Scalars);

TYPED_TEST(TableTest, FindsEveryPairOnceInEveryScene) {
    for (const BoxScene<TypeParam>& scene : test::allBoxScenes<TypeParam>()) {
        for (const double cellSize : {0.0, 0.01, 1.0, 30.0}) {
            SCOPED_TRACE(testing::Message() << scene.name << ", cell size " << cellSize);
            auto boxes = drawBoxes<TypeParam>(this->random_, scene.count, scene.draw);
            std::erase_if(boxes, [](const Aabb<TypeParam>& box) { return hasNan(box); });
            this->filled_.build(std::move(boxes),
                                cellSize > 0 ? fixedLevels(cellSize, 4) : LevelSizes{});
            this->filled_.expectEveryPairOnce();
            ASSERT_FALSE(this->HasFailure());
        }
    }
}

// A body that falls for ever, or some that were thrown out of the world.
TYPED_TEST(TableTest, AFewStraysDoNotMakeTheOthersSparse) {
    auto boxes = this->draw(3000, 0, 30, 0.5);
    for (int i = 0; i < 20; ++i) {
        // Half of them in pairs that overlap.
        const Vector3<double> away = this->random_.pointIn(-1e6, 1e6);
        boxes.push_back(boxAround<TypeParam>(away, {0.5, 0.5, 0.5}));
        boxes.push_back(boxAround<TypeParam>(away * (1 + i % 2), {0.5, 0.5, 0.5}));
    }
    this->filled_.build(std::move(boxes));
    EXPECT_GE(this->countIn(0), 2900U) << "most are dense";
    EXPECT_GE(this->countIn(1), 40U) << "the strays are hashed";
    this->filled_.expectEveryPairOnce();
}

// Layers, walls and lines have fewer neighbours than cells in space, dense or hashed.
TYPED_TEST(TableTest, FindsEveryPairOnceInPlanesAndLines) {
    const Vector3<double> extents[] = {{1, 1, 0}, {1, 0, 1}, {0, 1, 1},
                                       {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const Vector3<double>& extent : extents) {
        for (const double side : {20.0, 3000.0}) {
            SCOPED_TRACE(testing::Message() << extent.transpose() << " of " << side);
            std::vector<Aabb<TypeParam>> boxes;
            while (boxes.size() < 700) {
                const Vector3<double> at = this->random_.pointIn(0, side).cwiseProduct(extent);
                for (int i = 0; i < 2; ++i) {
                    const Vector3<double> beside =
                        this->random_.pointIn(-1, 1).cwiseProduct(extent);
                    boxes.push_back(boxAround<TypeParam>(at + beside, {0.5, 0.5, 0.5}));
                }
            }
            this->filled_.build(std::move(boxes), fixedLevels(1.5, 4));
            EXPECT_GT(this->filled_.expectEveryPairOnce(), 50U);
        }
    }
}

// By which every pair is found once.
TYPED_TEST(TableTest, AHashedCellAndThoseAroundItHaveABucketEach) {
    const Vector3<double> extents[] = {{1e5, 1e5, 1e5}, {1e5, 1, 1e5},   {1e5, 1e5, 1},
                                       {1, 1e5, 1e5},   {1, 1, 1e5},     {1e5, 1, 1},
                                       {1, 1e5, 1},     {4, 4e4, 5e5},   {5e5, 2, 3e4},
                                       {9e4, 7, 1e5},   {3e5, 300, 3e5}, {2e5, 3e5, 20}};
    for (const Vector3<double>& extent : extents) {
        for (const std::size_t count : {40U, 65U, 130U, 1000U, 3000U}) {
            SCOPED_TRACE(testing::Message() << count << " in " << extent.transpose());
            std::vector<Aabb<TypeParam>> boxes;
            while (boxes.size() < count) {
                const Vector3<double> at = this->random_.pointIn(0, 1).cwiseProduct(extent);
                boxes.push_back(boxAround<TypeParam>(at, {0.4, 0.4, 0.4}));
            }
            this->filled_.build(std::move(boxes), fixedLevels(1, 4));
            const Level<TypeParam>& level = this->filled_.table.levels()[1];
            std::set<std::uint32_t> buckets;
            std::size_t cells = 0;
            const std::int32_t y = level.inverseCellSize[1] == 0 ? 0 : 1;
            const std::int32_t z = level.inverseCellSize[2] == 0 ? 0 : 1;
            for (std::int32_t i = -1; i <= 1; ++i) {
                for (std::int32_t j = -y; j <= y; ++j) {
                    for (std::int32_t k = -z; k <= z; ++k) {
                        buckets.insert(
                            level.bucket(level.low[0] + i, {level.low[1] + j, level.low[2] + k}));
                        ++cells;
                    }
                }
            }
            EXPECT_EQ(level.kind, LevelKind::hashed);
            EXPECT_EQ(buckets.size(), cells);
            EXPECT_LT(*buckets.rbegin(), level.bucketCount);
        }
    }
}

// As far from each other as to share buckets, if they were numbered carelessly.
TYPED_TEST(TableTest, PilesAtEqualDistancesAreReadNoMoreThanPilesAnywhere) {
    for (const double distance : {33.0, 64.0, 66.0, 99.0, 100.0, 128.0, 400.0, 1000.0, 4096.0}) {
        SCOPED_TRACE(distance);
        std::vector<Aabb<TypeParam>> boxes;
        for (int i = 0; i < 6400; ++i) {
            const Vector3<double> pile(i / 400 % 16, 0, i / 40 % 10);
            boxes.push_back(boxAround<TypeParam>(distance * pile + this->random_.pointIn(0, 4),
                                                 {0.4, 0.4, 0.4}));
        }
        this->filled_.build(std::move(boxes), fixedLevels(1, 4));
        static_cast<void>(this->filled_.joined());
        EXPECT_LT(this->filled_.cost.boxesTested, 12U * 6400);
    }
}

// --- Crowds --------------------------------------------------------------------------------------

/// Short boxes that share one cell, or a few, spread along some axes only.
template <class Scalar>
std::vector<Aabb<Scalar>> crowd(Random& random, std::size_t count, const Vector3<double>& middle,
                                const Vector3<double>& spread) {
    return drawBoxes<Scalar>(random, count, [&](Random& from) {
        const Vector3<double> at = from.pointIn(-0.5, 0.5).cwiseProduct(spread) + middle;
        return boxAround<Scalar>(at, from.pointIn({0, 0, 0}, {0.3, 0.5, 0.2}));
    });
}

TYPED_TEST(TableTest, CrowdsInACellAreSortedAndSearchedWhereTheyAreNear) {
    std::size_t found = 0;
    const Vector3<double> spreads[] = {
        {40, 40, 40}, {90, 1, 1}, {1, 90, 1}, {1, 1, 90}, {200, 200, 1}};
    for (const Vector3<double>& spread : spreads) {
        for (const double away : {0.0, 50.0, 1e5}) {
            SCOPED_TRACE(testing::Message() << spread.transpose() << ", away " << away);
            const auto middle = Vector3<double>::Constant(away);
            this->filled_.build(crowd<TypeParam>(this->random_, 1500, middle, spread),
                                fixedLevels(100, 4));
            found += this->filled_.expectEveryPairOnce(1500. / 8, 1500. / 4);
        }
    }
    EXPECT_GT(found, 10000U);
    // And after some of them were erased.
    this->filled_.build(crowd<TypeParam>(this->random_, 1200, {0, 0, 0}, {12, 12, 12}),
                        fixedLevels(100, 4));
    this->filled_.eraseEach(2);
    EXPECT_GT(this->filled_.expectEveryPairOnce(), 10U);
}

// Strays keep the cells from being dense: buckets are shared by what is hashed there.
TYPED_TEST(TableTest, CrowdsInHashedCellsAreFoundWhole) {
    auto boxes = crowd<TypeParam>(this->random_, 1500, {3, 4, 5}, {30, 30, 30});
    for (int i = 0; i < 300; ++i) {
        const Vector3<double> away = this->random_.pointIn(-1e6, 1e6);
        const auto few = crowd<TypeParam>(this->random_, 2, away, {1, 1, 1});
        boxes.insert(boxes.end(), few.begin(), few.end());
    }
    this->filled_.build(std::move(boxes), fixedLevels(100, 4));
    EXPECT_GT(this->countIn(1), 500U) << "hashed";
    this->filled_.expectEveryPairOnce(1500. / 8, 1500. / 4);
}

// --- Cost and cell sizes -------------------------------------------------------------------------

TYPED_TEST(TableTest, KeepsToTheCostOfAFewTestsABox) {
    constexpr std::size_t kCount = 3000;
    this->filled_.build(this->draw(kCount, 0, 40, 0.5));
    this->filled_.expectEveryPairOnce(12);
    static_cast<void>(this->filled_.joined());
    EXPECT_LT(this->filled_.cost.rowsVisited, 10U * kCount);
    // In clusters, spread as far as if there were nothing but empty space between them.
    std::vector<Aabb<TypeParam>> clusters;
    while (clusters.size() < kCount) {
        const Vector3<double> middle = this->random_.pointIn(-3000, 3000);
        for (std::size_t i = 0; i < kCount / 10; ++i) {
            const Vector3<double> at = middle + this->random_.pointIn(-10, 10);
            clusters.push_back(boxAround<TypeParam>(at, {0.5, 0.5, 0.5}));
        }
    }
    this->filled_.build(std::move(clusters));
    this->filled_.expectEveryPairOnce(60);
    // Of sizes over six orders of magnitude, each with few neighbours of its own size.
    this->filled_.build(drawBoxes<TypeParam>(this->random_, kCount, [](Random& random) {
        return cubesIn<TypeParam>(0, 20000, random.logBetween(0.5e-3, 0.5e3))(random);
    }));
    this->filled_.expectEveryPairOnce(60);
}

// A larger one would be looked for in more cells than a join walks.
TYPED_TEST(TableTest, FilesNoBoxThatIsLargerThanItsCells) {
    this->filled_.build(drawBoxes<TypeParam>(this->random_, 3000,
                                             [](Random& random) {
                                                 const double edge = random.logBetween(0.5, 6);
                                                 return cubesIn<TypeParam>(0, 60, edge / 2)(random);
                                             }),
                        fixedLevels(1, 4));
    std::size_t filed = 0;
    for (const Level<TypeParam>& level : this->filled_.table.levels()) {
        for (std::uint32_t i = level.firstEntry; level.hasCells() && i < level.lastEntry; ++i) {
            const auto edge = this->filled_.table.box(i).sizes().maxCoeff();
            EXPECT_LE(edge * level.inverseCellSize[0], 1) << "of a cell";
            ++filed;
        }
    }
    EXPECT_GT(filed, 2000U);
}

// Sizes follow a population that shrinks or grows, soon after, and stay while it moves about.
TYPED_TEST(TableTest, ChoosesCellSizesAnewOnlyWhereThePopulationHasChanged) {
    std::vector<double> sizes;
    for (const double half : {0.5, 5.0, 0.5}) {
        for (int frame = 0; frame < 300; ++frame) {
            this->filled_.build(this->draw(1000, 0, 24 * half, half));
            const double size = this->filled_.table.finestCellSize();
            if (sizes.empty() || sizes.back() != size) {
                sizes.push_back(size);
            }
        }
        EXPECT_GE(sizes.back(), 2 * half);
        EXPECT_LE(sizes.back(), 6 * half);
    }
    EXPECT_EQ(sizes.size(), 3U) << "one for each population";
}

// All of them are strays from one build to the next.
TYPED_TEST(TableTest, ChoosesCellSizesAnewAtOnceWhereBoxesHaveOutgrownThem) {
    for (const double half : {0.5, 5.0, 80.0}) {
        this->filled_.build(this->draw(3000, 0, 30 * half, half));
        this->filled_.expectEveryPairOnce(30);
    }
}

// They are too few to be strays, and yet every search would read all of them.
TYPED_TEST(TableTest, ChoosesCellSizesAnewWhereAFewBoxesHaveOutgrownThem) {
    const typename TestFixture::Boxes small = this->draw(3000, 0, 16, 0.5);
    this->filled_.build(typename TestFixture::Boxes(small));
    typename TestFixture::Boxes some = small;
    for (std::size_t i = 0; i < 90; ++i) {
        some[33 * i].min().array() -= TypeParam(0.1);
        some[33 * i].max().array() += TypeParam(0.1);
    }
    this->filled_.build(std::move(some));
    EXPECT_EQ(this->filled_.table.levels().back().count(), 0U) << "are listed";
    this->filled_.expectEveryPairOnce(30);
}

}  // namespace
}  // namespace hashphase::detail
