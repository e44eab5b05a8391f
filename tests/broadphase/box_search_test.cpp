// SPDX-License-Identifier: Zlib

// What boxes overlap in a table, handed over as it is found.

#include <broadphase/geometry/box_columns.hpp>
#include <broadphase/search/box_search.hpp>
#include <broadphase/simd/kernels.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/count_allocations.hpp>
#include <tests/support/fill_table.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace hashphase::detail {
namespace {

using test::boxAround;
using test::BoxScene;
using test::makeBox;
using test::Random;

using IndexPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

template <class Scalar>
class BoxSearchTest : public testing::Test {
protected:
    using Box = Aabb<Scalar>;

    void TearDown() override { useInstructionSet(setBefore_); }

    static BoxColumns<Scalar> columnsOf(const std::vector<Box>& boxes) {
        BoxColumns<Scalar> columns;
        for (const Box& box : boxes) {
            columns.push(box);
        }
        return columns;
    }

    /// (query, proxy index) in the order in which they are handed over.
    IndexPairs found(const std::vector<Box>& queries) {
        IndexPairs pairs;
        const BoxColumns<Scalar> columns = columnsOf(queries);
        const auto take = [&](std::span<const IndexPair> batch) {
            EXPECT_FALSE(batch.empty());
            for (const auto [query, entry] : batch) {
                pairs.emplace_back(query, table_.proxyIndex(entry));
            }
            return true;
        };
        EXPECT_TRUE(searchBoxes(table_, columns.columns(), columns.size(), take, cost_));
        return pairs;
    }

    /// The same, one query after the other.
    IndexPairs foundOneByOne(const std::vector<Box>& queries) {
        IndexPairs pairs;
        for (std::uint32_t i = 0; i < queries.size(); ++i) {
            for (const auto& [none, proxyIndex] : found({queries[i]})) {
                pairs.emplace_back(i, proxyIndex);
            }
        }
        return pairs;
    }

    static IndexPairs sorted(IndexPairs pairs) {
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

    /// What is handed over to somebody who wants no more than the first of it.
    std::size_t takeOnce(const Box& query) {
        std::size_t taken = 0;
        const BoxColumns<Scalar> columns = columnsOf({query});
        const auto take = [&](std::span<const IndexPair> pairs) {
            EXPECT_EQ(taken, 0U) << "asked again";
            taken += pairs.size();
            return false;
        };
        cost_ = {};
        EXPECT_FALSE(searchBoxes(table_, columns.columns(), 1, take, cost_));
        return taken;
    }

    Table<Scalar> table_;
    KernelCost cost_;

private:
    InstructionSet setBefore_ = instructionSet();
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BoxSearchTest, Scalars);

TYPED_TEST(BoxSearchTest, FindsWhatOverlapsOneByOneAndTogether) {
    Random random(0x5eed0b01);
    for (const BoxScene<TypeParam>& scene : test::allBoxScenes<TypeParam>()) {
        for (const double cellSize : {0.0, 0.3, 20.0}) {
            SCOPED_TRACE(testing::Message() << scene.name << ", cell size " << cellSize);
            std::vector<Aabb<TypeParam>> boxes;
            std::vector<Aabb<TypeParam>> queries;
            for (std::uint32_t i = 0; i < scene.count; ++i) {
                boxes.push_back(scene.draw(random));
                queries.push_back(scene.draw(random));
            }
            test::fill(this->table_, boxes, cellSize > 0 ? fixedLevels(cellSize, 4) : LevelSizes{});
            IndexPairs expected;
            for (std::uint32_t i = 0; i < queries.size(); ++i) {
                for (std::uint32_t proxyIndex = 0; proxyIndex < boxes.size(); ++proxyIndex) {
                    if (overlaps(queries[i], boxes[proxyIndex])) {
                        expected.emplace_back(i, proxyIndex);
                    }
                }
            }
            ASSERT_EQ(this->sorted(this->foundOneByOne(queries)), expected);
            ASSERT_EQ(this->sorted(this->found(queries)), expected);
        }
    }
}

TYPED_TEST(BoxSearchTest, FindsTheSameInTheSameOrderWithEveryInstructionSet) {
    Random random(0x5eed0b02);
    std::vector<Aabb<TypeParam>> boxes;
    std::vector<Aabb<TypeParam>> queries;
    for (int i = 0; i < 3000; ++i) {
        boxes.push_back(boxAround<TypeParam>(random.pointIn(0, 30), random.pointIn(0, 1)));
        queries.push_back(boxAround<TypeParam>(random.pointIn(0, 30), random.pointIn(0, 3)));
    }
    test::fill(this->table_, boxes);
    useInstructionSet(InstructionSet::scalar);
    const IndexPairs expected = this->foundOneByOne(queries);
    for (const InstructionSet set :
         {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512}) {
        if (isAvailable(set)) {
            useInstructionSet(set);
            EXPECT_EQ(this->foundOneByOne(queries), expected) << nameOf(set);
        }
    }
}

// Cells that are dense, cells that are hashed, a crowd in one cell, and a list.
TYPED_TEST(BoxSearchTest, ReadsNoMoreThanItNeedsForTheFirstThatIsFound) {
    Random random(0x5eed0b03);
    struct World {
        const char* name;
        double side;
        LevelSizes sizes;
    };
    LevelSizes tiny = fixedLevels(0.01, 4);
    tiny.count = 1;
    for (const World& world : {World{"dense", 30, {}},
                               {"hashed", 1e5, fixedLevels(1, 4)},
                               {"crowd", 90, fixedLevels(1000, 4)},
                               {"list", 90, tiny}}) {
        SCOPED_TRACE(world.name);
        std::vector<Aabb<TypeParam>> boxes;
        for (int i = 0; i < 20000; ++i) {
            boxes.push_back(
                boxAround<TypeParam>(random.pointIn(0, world.side), {0.25, 0.25, 0.25}));
        }
        test::fill(this->table_, boxes, world.sizes);
        const auto most = static_cast<TypeParam>(2 * world.side);
        const auto everything = makeBox<TypeParam>(-1, -1, -1, most, most, most);
        EXPECT_LE(this->takeOnce(everything), kMostRoom);
        EXPECT_LE(this->cost_.boxesTested, 2 * kMostRoom);
        // Of a part, the first rows that have something.
        const auto half = static_cast<TypeParam>(world.side / 2);
        this->takeOnce(makeBox<TypeParam>(0, 0, 0, half, half, half));
        EXPECT_LE(this->cost_.boxesTested, 20000 / 8 + 2 * kMostRoom);
    }
}

TYPED_TEST(BoxSearchTest, EndsForSeveralBoxesAtOnce) {
    Random random(0x5eed0b04);
    std::vector<Aabb<TypeParam>> boxes;
    for (int i = 0; i < 5000; ++i) {
        boxes.push_back(boxAround<TypeParam>(random.pointIn(0, 10), {0.5, 0.5, 0.5}));
    }
    test::fill(this->table_, boxes);
    boxes.resize(16);
    const BoxColumns<TypeParam> columns = this->columnsOf(boxes);
    std::size_t taken = 0;
    const auto take = [&](std::span<const IndexPair> pairs) {
        EXPECT_EQ(taken, 0U) << "asked again";
        taken += pairs.size();
        return false;
    };
    EXPECT_FALSE(searchBoxes(this->table_, columns.columns(), 16, take, this->cost_));
    EXPECT_GT(taken, 0U);
}

TYPED_TEST(BoxSearchTest, AllocatesNothing) {
    if (!test::kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    std::vector<Aabb<TypeParam>> boxes(3000, makeBox<TypeParam>(0, 0, 0, 1, 1, 1));
    test::fill(this->table_, boxes);
    const BoxColumns<TypeParam> columns = this->columnsOf({boxes[0], boxes[1]});
    std::size_t taken = 0;
    const auto take = [&](std::span<const IndexPair> pairs) {
        taken += pairs.size();
        return true;
    };
    const std::size_t before = test::allocationCount();
    for (const std::uint32_t count : {1U, 2U}) {
        EXPECT_TRUE(searchBoxes(this->table_, columns.columns(), count, take, this->cost_));
    }
    EXPECT_EQ(test::allocationCount(), before);
    EXPECT_EQ(taken, 3 * boxes.size());
}

}  // namespace
}  // namespace hashphase::detail
