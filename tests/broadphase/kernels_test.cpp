// SPDX-License-Identifier: Zlib

// Every instruction set gives the pairs of the scalar kernels, in the same order.

#include <broadphase/hash/levels.hpp>
#include <broadphase/search/box_search.hpp>
#include <broadphase/search/join.hpp>
#include <broadphase/simd/kernels.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/count_allocations.hpp>
#include <tests/support/fill_table.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace hashphase::detail {
namespace {

using test::BoxScene;
using test::drawBoxes;
using test::Random;

template <class Scalar>
class KernelsTest : public testing::Test {
protected:
    using Boxes = std::vector<Aabb<Scalar>>;

    static std::vector<PaddedBox<Scalar>> paddedOf(const Boxes& boxes) {
        std::vector<PaddedBox<Scalar>> result;
        for (const Aabb<Scalar>& box : boxes) {
            result.push_back(padded(box));
        }
        return result;
    }

    /// Ways from each box, with whatever is in it, to somewhere else.
    static std::vector<SweptBox<Scalar>> waysOf(const std::vector<PaddedBox<Scalar>>& boxes) {
        Random random(0x5eed0503);
        std::vector<SweptBox<Scalar>> ways;
        for (const PaddedBox<Scalar>& box : boxes) {
            SweptBox<Scalar> way{};
            for (std::uint32_t k = 0; k < 3; ++k) {
                const auto axis = random.below(3);
                const bool rises = random.chance(0.5);
                way.enterColumn[k] = rises ? axis : axis + 3;
                way.leaveColumn[k] = rises ? axis + 3 : axis;
                way.enterFrom[k] = rises ? box.high[axis] : box.low[axis];
                way.leaveFrom[k] = rises ? box.low[axis] : box.high[axis];
                const double inverse = random.chance(0.25) ? 0 : random.between(0.01, 10);
                way.inverse[k] = static_cast<Scalar>(rises ? inverse : -inverse);
            }
            ways.push_back(way);
        }
        return ways;
    }

    static PairList querySwept(const Table<Scalar>& table, const Table<Scalar>& queries,
                               const std::vector<PaddedBox<Scalar>>& boxes) {
        std::vector<SweptBox<Scalar>> ways = waysOf(boxes);
        std::rotate(ways.begin(), ways.begin() + 1, ways.end());  // else all would be passed
        PairList found;
        KernelCost cost;
        for (const Level<Scalar>& level : table.levels()) {
            found.append([&](PairSink& sink) {
                kernels<Scalar>().querySwept(level, queries.columns().data(), ways.data(),
                                             queries.order().data(), 0, queries.size(), sink, cost);
            });
        }
        return found;
    }

    /// Of some pairs of boxes, of every third one of which it is said that they did not overlap.
    static std::vector<std::uint32_t> turnedOf(std::vector<IndexPair> pairs,
                                               const Table<Scalar>& moved) {
        std::erase_if(
            pairs, [&](const IndexPair& pair) { return std::max(pair.a, pair.b) >= moved.size(); });
        std::vector<std::uint8_t> overlapped;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            overlapped.push_back(i % 3 == 0 ? 0 : 1);
        }
        std::vector<std::uint32_t> turned(pairs.size());
        turned.resize(kernels<Scalar>().selectTurned(pairs.data(), overlapped.data(), 0,
                                                     static_cast<std::uint32_t>(pairs.size()),
                                                     moved.columns().data(), turned.data()));
        std::size_t next = 0;
        for (std::uint32_t i = 0; i < pairs.size(); ++i) {  // by the definition
            const bool overlap = overlaps(moved.box(pairs[i].a), moved.box(pairs[i].b));
            if (overlap != (overlapped[i] != 0)) {
                EXPECT_LT(next, turned.size());
                EXPECT_EQ(next < turned.size() ? turned[next] : ~0U, i);
                ++next;
            }
        }
        EXPECT_EQ(next, turned.size());
        return turned;
    }

    /// Of the first boxes, in reverse.
    static std::vector<std::uint32_t> rowsOf(const Boxes& boxes) {
        constexpr std::size_t kMost = 32;
        std::array<PaddedBox<Scalar>, kMost> scratch;
        std::vector<std::uint32_t> indices(std::min(boxes.size(), kMost));
        std::iota(indices.rbegin(), indices.rend(), 0U);
        std::vector<std::uint32_t> rows(indices.size());
        constexpr std::size_t kStride = sizeof(Aabb<Scalar>) / sizeof(Scalar);
        kernels<Scalar>().overlapRows(boxes[0].min().data(), kStride, indices.data(),
                                      indices.size(), scratch.data(), rows.data());
        for (std::size_t i = 0; i < indices.size(); ++i) {  // by the definition
            for (std::size_t k = 0; k < kMost; ++k) {
                const bool overlap = k < i && overlaps(boxes[indices[i]], boxes[indices[k]]);
                EXPECT_EQ(rows[i] >> k & 1, overlap ? 1U : 0U) << i << " and " << k;
            }
        }
        return rows;
    }

    /// What all kernels make of the boxes.
    struct Results {
        std::vector<IndexPair> joined, walked, together, onWays, apart, filed;
        std::vector<std::uint32_t> turned, rows;

        friend bool operator==(const Results&, const Results&) = default;
    };

    static Results resultsOf(const Boxes& boxes, const Boxes& moved, const LevelSizes& sizes) {
        Table<Scalar> table;
        Table<Scalar> movedTable;
        test::fill(table, boxes, sizes);
        test::fill(movedTable, moved, sizes);
        const std::vector<PaddedBox<Scalar>> movedBoxes = paddedOf(moved);
        const auto copyOf = [](const PairList& list) {
            return std::vector<IndexPair>(list.pairs().begin(), list.pairs().end());
        };
        KernelCost cost;
        PairParts parts;
        PairList joined;
        joinTable(table, serialFor, parts, joined, cost);
        PairList walked;
        queryTable(table, movedTable.columns(), movedTable.size(), serialFor, parts, walked, cost);
        PairList together;
        together.append([&](PairSink& sink) {
            queryBatch(table, movedTable.columns(), movedTable.size(), sink, cost);
        });
        Results results{copyOf(joined),
                        copyOf(walked),
                        copyOf(together),
                        copyOf(querySwept(table, movedTable, movedBoxes)),
                        {},
                        {},
                        turnedOf(copyOf(joined), movedTable),
                        rowsOf(boxes)};
        results.apart.resize(joined.size());
        results.apart.resize(kernels<Scalar>().selectApart(joined.pairs().data(), joined.size(),
                                                           table.order().data(), movedBoxes.data(),
                                                           results.apart.data()));
        for (std::uint32_t i = 0; i < table.size(); ++i) {
            results.filed.push_back({table.order()[i], table.proxyIndex(i)});
        }
        return results;
    }

    static std::vector<IndexPair> sorted(std::vector<IndexPair> pairs) {
        std::ranges::sort(pairs, {},
                          [](const IndexPair& pair) { return std::pair(pair.a, pair.b); });
        return pairs;
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(KernelsTest, Scalars);

TYPED_TEST(KernelsTest, OfEveryInstructionSetGiveTheSamePairsInTheSameOrder) {
    Random random(0x5eed0501);
    std::size_t found = 0;
    std::size_t passed = 0;
    std::size_t passedBy = 0;
    for (const BoxScene<TypeParam>& scene : test::allBoxScenes<TypeParam>()) {
        for (const double cellSize : {0.0, 0.3, 2.0, 20.0}) {
            SCOPED_TRACE(testing::Message() << scene.name << ", cell size " << cellSize);
            const LevelSizes sizes = cellSize > 0 ? fixedLevels(cellSize, 4) : LevelSizes{};
            const auto boxes = drawBoxes<TypeParam>(random, scene.count, scene.draw);
            const auto moved = drawBoxes<TypeParam>(random, scene.count, scene.draw);
            typename TestFixture::Results expected;
            test::forEachInstructionSet([&](InstructionSet set) {
                const auto results = this->resultsOf(boxes, moved, sizes);
                expected = set == InstructionSet::scalar ? results : expected;
                ASSERT_TRUE(results == expected);
            });
            // Boxes that are looked for together find what they find one by one.
            ASSERT_EQ(this->sorted(expected.together), this->sorted(expected.walked));
            found += expected.joined.size() + expected.walked.size() + expected.apart.size();
            passed += expected.onWays.size();
            passedBy += expected.walked.size() - expected.onWays.size();
        }
    }
    EXPECT_GT(found, 10000U);
    EXPECT_GT(passed, 1000U);
    EXPECT_GT(passedBy, 1000U);
}

TYPED_TEST(KernelsTest, TellApartThePairsThatBruteForceTellsApart) {
    Random random(0x5eed0502);
    const auto boxes = drawBoxes<TypeParam>(random, 200, test::hostileScene<TypeParam>().draw);
    const auto paddedBoxes = this->paddedOf(boxes);
    std::vector<IndexPair> pairs;
    std::vector<IndexPair> expected;
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
        for (std::uint32_t b = 0; b < boxes.size(); ++b) {
            pairs.push_back({a, b});
            if (!overlaps(boxes[a], boxes[b])) {
                expected.push_back({a, b});
            }
        }
    }
    test::forEachInstructionSet([&](InstructionSet) {
        std::vector<IndexPair> apart(pairs.size());
        apart.resize(kernels<TypeParam>().selectApart(pairs.data(), pairs.size(), nullptr,
                                                      paddedBoxes.data(), apart.data()));
        EXPECT_EQ(apart, expected);
    });
}

TEST(InstructionSets, ScalarIsAlwaysAvailableAndTheBestOneIsInUse) {
    EXPECT_TRUE(isAvailable(InstructionSet::scalar));
    for (const InstructionSet set : detail::kInstructionSets) {
        EXPECT_TRUE(!isAvailable(set) || set <= instructionSet()) << nameOf(set);
    }
    EXPECT_TRUE(isAvailable(instructionSet()));
    EXPECT_STREQ(nameOf(InstructionSet::avx512), "AVX-512");
}

// --- What boxes overlap, handed over as it is found ----------------------------------------------

using test::columnsOf;
using test::cubesIn;
using test::makeBox;

template <class Scalar>
class BoxSearchTest : public testing::Test {
protected:
    using Boxes = std::vector<Aabb<Scalar>>;

    /// What is handed over to somebody who wants no more than the first of it.
    std::size_t takeOnce(const Boxes& queries) {
        std::size_t taken = 0;
        const BoxColumns<Scalar> columns = columnsOf(queries);
        const auto take = [&](std::span<const IndexPair> pairs) {
            EXPECT_EQ(taken, 0U) << "asked again";
            taken += pairs.size();
            return false;
        };
        cost_ = {};
        EXPECT_FALSE(searchBoxes(table_, columns.columns(), columns.size(), take, cost_));
        return taken;
    }

    Table<Scalar> table_;
    KernelCost cost_;
    test::Random random_{0x5eed0b01};
};

TYPED_TEST_SUITE(BoxSearchTest, Scalars);

// Cells that are dense, cells that are hashed, a crowd in one cell, and a list.
TYPED_TEST(BoxSearchTest, ReadsNoMoreThanItNeedsForTheFirstThatIsFound) {
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
        const auto draw = cubesIn<TypeParam>(0., world.side, 0.25);
        test::fill(this->table_, test::drawBoxes<TypeParam>(this->random_, 20000, draw),
                   world.sizes);
        const double most = 2 * world.side;
        EXPECT_LE(this->takeOnce({makeBox<TypeParam>(-1, -1, -1, most, most, most)}), kMostRoom);
        EXPECT_LE(this->cost_.boxesTested, 2 * kMostRoom);
        // Of a part, the first rows that have something.
        const double half = world.side / 2;
        this->takeOnce({makeBox<TypeParam>(0, 0, 0, half, half, half)});
        EXPECT_LE(this->cost_.boxesTested, 20000 / 8 + 2 * kMostRoom);
    }
}

TYPED_TEST(BoxSearchTest, EndsForSeveralBoxesAtOnce) {
    auto boxes = test::drawBoxes<TypeParam>(this->random_, 5000, cubesIn<TypeParam>(0, 10, 0.5));
    test::fill(this->table_, boxes);
    boxes.resize(16);
    EXPECT_GT(this->takeOnce(boxes), 0U);
}

TYPED_TEST(BoxSearchTest, AllocatesNothing) {
    if (!test::kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    std::vector<Aabb<TypeParam>> boxes(3000, makeBox<TypeParam>(0, 0, 0, 1, 1, 1));
    test::fill(this->table_, boxes);
    boxes.resize(2);
    const BoxColumns<TypeParam> columns = columnsOf(boxes);
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
    EXPECT_EQ(taken, 3 * 3000U);
}

}  // namespace
}  // namespace hashphase::detail
