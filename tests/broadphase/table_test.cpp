// SPDX-License-Identifier: Zlib

#include <broadphase/search/join.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/fill_table.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace hashphase::detail {
namespace {

using test::boxAround;
using test::BoxScene;
using test::Random;

using IndexPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

template <class Scalar>
class TableTest : public testing::Test {
protected:
    using Box = Aabb<Scalar>;

    void build(std::vector<Box> boxes, const LevelSizes& fixed = {}) {
        boxes_ = std::move(boxes);
        test::fill(table_, boxes_, fixed);
        ASSERT_EQ(table_.validate(), "");
        ASSERT_EQ(table_.size(), boxes_.size());
    }

    /// Every pair in the order of its indices, found by the join.
    [[nodiscard]] IndexPairs joined() {
        IndexPairs pairs;
        PairList found;
        cost_ = {};
        PairParts parts;
        joinTable(table_, serialFor, parts, found, cost_);
        for (const auto [a, b] : found.pairs()) {
            pairs.push_back(std::minmax(table_.proxyIndex(a), table_.proxyIndex(b)));
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

    /// The same, found by looking for every box in the table.
    [[nodiscard]] IndexPairs walked() {
        IndexPairs pairs;
        BoxColumns<Scalar> queries;
        for (const Box& box : boxes_) {
            queries.push(box);
        }
        PairList found;
        PairParts parts;
        cost_ = {};
        queryTable(table_, queries.columns(), queries.size(), serialFor, parts, found, cost_);
        for (const auto [query, entry] : found.pairs()) {
            if (query < table_.proxyIndex(entry)) {
                pairs.emplace_back(query, table_.proxyIndex(entry));
            }
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

    [[nodiscard]] IndexPairs expected() const {
        IndexPairs pairs;
        for (std::uint32_t a = 0; a < boxes_.size(); ++a) {
            for (std::uint32_t b = a + 1; b < boxes_.size(); ++b) {
                if (overlaps(boxes_[a], boxes_[b])) {
                    pairs.emplace_back(a, b);
                }
            }
        }
        return pairs;
    }

    /// How many entries share a bucket with an entry of another row.
    [[nodiscard]] std::size_t sharedBuckets() const {
        std::size_t shared = 0;
        for (const Level<Scalar>& level : table_.levels()) {
            std::map<std::uint32_t, std::pair<std::int32_t, std::int32_t>> rowOfBucket;
            for (std::uint32_t i = level.firstEntry; level.hasCells() && i < level.lastEntry; ++i) {
                const Box box = table_.box(i);
                const std::int32_t x = level.cell(box.min()[0], 0);
                const std::int32_t y = level.cell(box.min()[1], 1);
                const std::int32_t z = level.cell(box.min()[2], 2);
                const std::uint32_t bucket = level.bucket(x, Row{y, z});
                shared += rowOfBucket.try_emplace(bucket, y, z).first->second != std::pair(y, z);
            }
        }
        return shared;
    }

    std::vector<Box> boxes_;
    Table<Scalar> table_;
    KernelCost cost_;  // of the last search
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TableTest, Scalars);

TYPED_TEST(TableTest, JoinFindsEveryPairOnceInEveryScene) {
    Random random(0x5eed0401);
    for (const BoxScene<TypeParam>& scene : test::allBoxScenes<TypeParam>()) {
        for (const double cellSize : {0.0, 0.01, 1.0, 30.0}) {
            SCOPED_TRACE(testing::Message() << scene.name << ", cell size " << cellSize);
            std::vector<Aabb<TypeParam>> boxes;
            while (boxes.size() < scene.count) {
                const Aabb<TypeParam> box = scene.draw(random);
                if (!hasNan(box)) {
                    boxes.push_back(box);
                }
            }
            this->build(std::move(boxes), cellSize > 0 ? fixedLevels(cellSize, 4) : LevelSizes{});
            ASSERT_EQ(this->joined(), this->expected());
        }
    }
}

// Lattices whose strides are powers of two, so that rows fall onto each other wherever their
// numbers were used without mixing; and so sparse that rows have to be hashed.
TYPED_TEST(TableTest, JoinFindsEveryPairOnceThoughRowsShareBuckets) {
    std::size_t shared = 0;
    for (const int stride : {64, 256, 1024, 65536, 1 << 20}) {
        SCOPED_TRACE(testing::Message() << "stride " << stride);
        std::vector<Aabb<TypeParam>> boxes;
        for (int i = 0; i < 343; ++i) {
            const Vector3<double> corner(i % 7, i / 7 % 7, i / 49);
            // Two that touch at each place.
            const Vector3<double> at = corner * stride;
            boxes.push_back(boxAround<TypeParam>(at, {0.5, 0.5, 0.5}));
            boxes.push_back(boxAround<TypeParam>(at + Vector3<double>(1, i % 2, -(i % 3 % 2)),
                                                 {0.5, 0.5, 0.5}));
        }
        this->build(std::move(boxes), fixedLevels(1, 4));
        const Level<TypeParam>& level = this->table_.levels()[1];
        EXPECT_FALSE(level.isDense());
        EXPECT_EQ(level.count(), this->table_.size()) << "all are hashed";
        shared += this->sharedBuckets();
        ASSERT_EQ(this->joined(), this->expected());
        ASSERT_GE(this->joined().size(), 343U);
    }
    EXPECT_GT(shared, 100U) << "the lattices do not do what they are for";
}

TYPED_TEST(TableTest, JoinFindsEveryPairOnceThoughARowIsLongerThanTheTable) {
    std::vector<Aabb<TypeParam>> boxes;
    for (int i = 0; i < 200; ++i) {
        const auto at = [](double x) { return Vector3<double>(x, 0.5, 0.5); };
        // Far apart along x by multiples of every table size that could be chosen.
        boxes.push_back(boxAround<TypeParam>(at(1024.0 * i), {0.6, 0.5, 0.5}));
        boxes.push_back(boxAround<TypeParam>(at(1024.0 * i + 1), {0.6, 0.5, 0.5}));
    }
    // One on a coarser level whose neighbourhood on the finer one spans them all.
    boxes.push_back(boxAround<TypeParam>({1e5, 0, 0}, {1e5, 1, 1}));
    this->build(std::move(boxes), fixedLevels(1, 4));
    ASSERT_EQ(this->joined(), this->expected());
}

TYPED_TEST(TableTest, BoxesOnBordersOfCellsAreFoundFromBothSides) {
    // Corners at k * cell as rounded: half of such numbers fall into another cell than k.
    for (const double cellSize : {0.1, 0.3, 0.7, 1.1, 3.3, 10.1}) {
        SCOPED_TRACE(testing::Message() << "cell size " << cellSize);
        using Limits = std::numeric_limits<TypeParam>;
        std::vector<Aabb<TypeParam>> boxes;
        for (int k = -200; k < 200; ++k) {
            const auto low = static_cast<TypeParam>(k) * static_cast<TypeParam>(cellSize);
            const auto high = static_cast<TypeParam>(k + 1) * static_cast<TypeParam>(cellSize);
            const auto below = std::nextafter(low, -Limits::infinity());
            const Vector3<TypeParam> bottom(low, 0, 0);
            const Vector3<TypeParam> top(high, 1, 1);
            boxes.emplace_back(bottom, top);
            boxes.emplace_back(bottom, Vector3<TypeParam>(low, 1, 1));
            boxes.emplace_back(Vector3<TypeParam>(below, 0, 0), Vector3<TypeParam>(below, 1, 1));
        }
        this->build(std::move(boxes), fixedLevels(cellSize, 4));
        ASSERT_EQ(this->joined(), this->expected());
        ASSERT_EQ(this->walked(), this->expected());
    }
}

// A body that falls for ever, or some that were thrown out of the world.
TYPED_TEST(TableTest, AFewStraysDoNotMakeTheOthersSparse) {
    Random random(0x5eed0406);
    std::vector<Aabb<TypeParam>> boxes;
    for (int i = 0; i < 3000; ++i) {
        boxes.push_back(boxAround<TypeParam>(random.pointIn(0, 30), {0.5, 0.5, 0.5}));
    }
    for (int i = 0; i < 20; ++i) {
        // Half of them in pairs that overlap.
        const Vector3<double> away = random.pointIn(-1e6, 1e6);
        boxes.push_back(boxAround<TypeParam>(away, {0.5, 0.5, 0.5}));
        boxes.push_back(boxAround<TypeParam>(away * (1 + i % 2), {0.5, 0.5, 0.5}));
    }
    this->build(std::move(boxes));
    EXPECT_GE(this->table_.levels()[0].count(), 2900U) << "most are dense";
    EXPECT_GE(this->table_.levels()[1].count(), 40U) << "the strays are hashed";
    ASSERT_EQ(this->joined(), this->expected());
}

// Layers, walls and lines have fewer neighbours than cells in space, dense or hashed.
TYPED_TEST(TableTest, FindsEveryPairOnceInPlanesAndLines) {
    Random random(0x5eed040b);
    const Vector3<double> extents[] = {{1, 1, 0}, {1, 0, 1}, {0, 1, 1},
                                       {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const Vector3<double>& extent : extents) {
        for (const double side : {20.0, 3000.0}) {
            SCOPED_TRACE(testing::Message() << extent.transpose() << " of " << side);
            std::vector<Aabb<TypeParam>> boxes;
            while (boxes.size() < 700) {
                const Vector3<double> at = random.pointIn(0, side).cwiseProduct(extent);
                for (int i = 0; i < 2; ++i) {
                    const Vector3<double> beside = random.pointIn(-1, 1).cwiseProduct(extent);
                    boxes.push_back(boxAround<TypeParam>(at + beside, {0.5, 0.5, 0.5}));
                }
            }
            this->build(std::move(boxes), fixedLevels(1.5, 4));
            const IndexPairs expected = this->expected();
            EXPECT_GT(expected.size(), 50U);
            ASSERT_EQ(this->joined(), expected);
            ASSERT_EQ(this->walked(), expected);
        }
    }
}

TYPED_TEST(TableTest, ErasedEntriesAreFoundByNothing) {
    Random random(0x5eed0402);
    const BoxScene<TypeParam> scene = test::spreadScene<TypeParam>("", 1, 0);
    std::vector<Aabb<TypeParam>> boxes;
    for (int i = 0; i < 300; ++i) {
        boxes.push_back(scene.draw(random));
    }
    this->build(std::move(boxes));
    const TypeParam nan = std::numeric_limits<TypeParam>::quiet_NaN();
    for (std::uint32_t entry = 0; entry < this->table_.size(); entry += 3) {
        this->boxes_[this->table_.proxyIndex(entry)].min().setConstant(nan);
        this->table_.erase(entry);
    }
    EXPECT_EQ(this->table_.validate(), "");
    EXPECT_EQ(this->joined(), this->expected());
}

/// Short boxes that share one cell, or a few, spread along some axes only.
template <class Scalar>
std::vector<Aabb<Scalar>> crowd(Random& random, std::size_t count, const Vector3<double>& middle,
                                const Vector3<double>& spread) {
    std::vector<Aabb<Scalar>> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Vector3<double> at = random.pointIn(-0.5, 0.5).cwiseProduct(spread) + middle;
        const Vector3<double> half =
            random.pointIn(0, 1).cwiseProduct(Vector3<double>(0.3, 0.5, 0.2));
        boxes.push_back(boxAround<Scalar>(at, half));
    }
    return boxes;
}

TYPED_TEST(TableTest, CrowdsInACellAreSortedAndSearchedWhereTheyAreNear) {
    Random random(0x5eed0407);
    std::size_t found = 0;
    const Vector3<double> spreads[] = {
        {40, 40, 40}, {90, 1, 1}, {1, 90, 1}, {1, 1, 90}, {200, 200, 1}};
    for (const Vector3<double>& spread : spreads) {
        for (const double away : {0.0, 50.0, 1e5}) {
            SCOPED_TRACE(testing::Message() << spread.transpose() << ", away " << away);
            this->build(crowd<TypeParam>(random, 1500, Vector3<double>::Constant(away), spread),
                        fixedLevels(100, 4));
            const IndexPairs expected = this->expected();
            found += expected.size();
            ASSERT_EQ(this->joined(), expected);
            EXPECT_LT(this->cost_.boxesTested, 1500U * 1500U / 8);
            ASSERT_EQ(this->walked(), expected);
            EXPECT_LT(this->cost_.boxesTested, 1500U * 1500U / 4);
        }
    }
    EXPECT_GT(found, 10000U);
}

// Strays keep the cells from being dense: buckets are shared by what is hashed there.
TYPED_TEST(TableTest, CrowdsInHashedCellsAreFoundWhole) {
    Random random(0x5eed0408);
    auto boxes = crowd<TypeParam>(random, 1500, {3, 4, 5}, {30, 30, 30});
    for (int i = 0; i < 300; ++i) {
        const auto few = crowd<TypeParam>(random, 2, random.pointIn(-1e6, 1e6), {1, 1, 1});
        boxes.insert(boxes.end(), few.begin(), few.end());
    }
    this->build(std::move(boxes), fixedLevels(100, 4));
    EXPECT_GT(this->table_.levels()[1].count(), 500U) << "hashed";
    const IndexPairs expected = this->expected();
    EXPECT_EQ(this->joined(), expected);
    EXPECT_EQ(this->walked(), expected);
}

TYPED_TEST(TableTest, CrowdsAreFoundWholeAfterSomeOfThemWereErased) {
    Random random(0x5eed0409);
    this->build(crowd<TypeParam>(random, 1200, {0, 0, 0}, {12, 12, 12}), fixedLevels(100, 4));
    const TypeParam nan = std::numeric_limits<TypeParam>::quiet_NaN();
    for (std::uint32_t entry = 0; entry < this->table_.size(); entry += 2) {
        this->boxes_[this->table_.proxyIndex(entry)].min().setConstant(nan);
        this->table_.erase(entry);
    }
    EXPECT_EQ(this->table_.validate(), "");
    const IndexPairs expected = this->expected();
    EXPECT_GT(expected.size(), 10U);
    EXPECT_EQ(this->joined(), expected);
    EXPECT_EQ(this->walked(), expected);
}

// Boxes that end where others begin, to the last bit, and one that is longer than the others.
TYPED_TEST(TableTest, CrowdsTouchToTheLastBit) {
    Random random(0x5eed040a);
    for (const double away : {0.0, 1e3, 1e6}) {
        std::vector<Aabb<TypeParam>> boxes;
        const auto edge = static_cast<TypeParam>(away == 1e6 ? 0.125 : 0.1);
        TypeParam x = static_cast<TypeParam>(away);
        for (int i = 0; i < 900; ++i) {
            const TypeParam next = x + edge;
            const TypeParam y = static_cast<TypeParam>(random.pointIn(0, 1)[0]);
            boxes.push_back({Vector3<TypeParam>(x, y, 0), Vector3<TypeParam>(next, y, 0)});
            x = i % 3 == 0 ? std::nextafter(next, std::numeric_limits<TypeParam>::infinity())
                           : next;
        }
        const auto first = static_cast<TypeParam>(away);
        boxes.push_back({Vector3<TypeParam>(first, -1, 0), Vector3<TypeParam>(first + 5, 2, 0)});
        this->build(std::move(boxes), fixedLevels(1000, 4));
        const IndexPairs expected = this->expected();
        EXPECT_EQ(this->joined(), expected);
        EXPECT_EQ(this->walked(), expected);
    }
}

TYPED_TEST(TableTest, DependsOnlyOnTheBoxesNotOnWhatItHeldBefore) {
    Random random(0x5eed0403);
    const auto fill = [&random](double scale, int count) {
        std::vector<Aabb<TypeParam>> boxes;
        const BoxScene<TypeParam> scene = test::spreadScene<TypeParam>("", scale, 5 * scale);
        for (int i = 0; i < count; ++i) {
            boxes.push_back(scene.draw(random));
        }
        return boxes;
    };
    for (const int count : {500, 0, 1, 400, 31, 2000, 33}) {
        this->build(fill(count > 100 ? 1.0 : 250.0, count));
        ASSERT_EQ(this->joined(), this->expected());
    }
}

TYPED_TEST(TableTest, KeepsToTheCostOfAFewTestsABoxWhereBoxesAreOfOneSize) {
    Random random(0x5eed0404);
    std::vector<Aabb<TypeParam>> boxes;
    constexpr std::uint32_t kCount = 3000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        boxes.push_back(boxAround<TypeParam>(random.pointIn(0, 40), {0.5, 0.5, 0.5}));
    }
    this->build(std::move(boxes));
    PairList found;
    KernelCost cost;
    PairParts parts;
    joinTable(this->table_, serialFor, parts, found, cost);
    EXPECT_LT(cost.boxesTested, 12U * kCount);
    EXPECT_LT(cost.rowsVisited, 10U * kCount);
}

// Far apart, clusters spread as far as if there were nothing but empty space between them.
TYPED_TEST(TableTest, KeepsToTheCostOfAFewTestsABoxInClusters) {
    Random random(0x5eed040c);
    std::vector<Aabb<TypeParam>> boxes;
    constexpr std::uint32_t kCount = 3000;
    for (int cluster = 0; cluster < 10; ++cluster) {
        const Vector3<double> middle = random.pointIn(-3000, 3000);
        for (std::uint32_t i = 0; i < kCount / 10; ++i) {
            boxes.push_back(
                boxAround<TypeParam>(middle + random.pointIn(-10, 10), {0.5, 0.5, 0.5}));
        }
    }
    this->build(std::move(boxes));
    ASSERT_EQ(this->joined(), this->expected());
    EXPECT_LT(this->cost_.boxesTested, 60U * kCount);
}

// Sizes follow a population that shrinks or grows, soon after, and stay while it moves about.
TYPED_TEST(TableTest, ChoosesCellSizesAnewOnlyWhereThePopulationHasChanged) {
    Random random(0x5eed040d);
    const auto draw = [&random](double half) {
        std::vector<Aabb<TypeParam>> boxes;
        for (int i = 0; i < 1000; ++i) {
            boxes.push_back(boxAround<TypeParam>(random.pointIn(0, 24 * half),
                                                 Vector3<double>::Constant(half)));
        }
        return boxes;
    };
    std::vector<double> sizes;
    for (const double half : {0.5, 5.0, 0.5}) {
        for (int frame = 0; frame < 300; ++frame) {
            this->build(draw(half));
            const double size = this->table_.finestCellSize();
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
    Random random(0x5eed040e);
    for (const double half : {0.5, 5.0, 80.0}) {
        std::vector<Aabb<TypeParam>> boxes;
        constexpr std::uint32_t kCount = 3000;
        for (std::uint32_t i = 0; i < kCount; ++i) {
            boxes.push_back(boxAround<TypeParam>(random.pointIn(0, 30 * half),
                                                 Vector3<double>::Constant(half)));
        }
        this->build(std::move(boxes));
        ASSERT_EQ(this->joined(), this->expected());
        EXPECT_LT(this->cost_.boxesTested, 30U * kCount) << half;
    }
}

// A population with sizes over six orders of magnitude, as many small as large.
TYPED_TEST(TableTest, KeepsToTheCostOfAFewTestsABoxWhereSizesDiffer) {
    Random random(0x5eed0405);
    std::vector<Aabb<TypeParam>> boxes;
    constexpr std::uint32_t kCount = 3000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const double half = random.logBetween(0.5e-3, 0.5e3);
        // Spread such that boxes of every size have few neighbours of their own size.
        boxes.push_back(boxAround<TypeParam>(random.pointIn(0, 20000), {half, half, half}));
    }
    this->build(std::move(boxes));
    PairList found;
    KernelCost cost;
    PairParts parts;
    joinTable(this->table_, serialFor, parts, found, cost);
    EXPECT_LT(cost.boxesTested, 60U * kCount);
}

}  // namespace
}  // namespace hashphase::detail
