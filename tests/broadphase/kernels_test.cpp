// SPDX-License-Identifier: Zlib

// Every instruction set gives the pairs of the scalar kernels, in the same order.

#include <broadphase/search/join.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace hashphase::detail {
namespace {

using test::BoxScene;
using test::Random;

constexpr std::array kVectorSets{InstructionSet::sse2, InstructionSet::avx2,
                                 InstructionSet::avx512};

template <class Scalar>
class KernelsTest : public testing::Test {
protected:
    void SetUp() override { setBefore_ = instructionSet(); }
    void TearDown() override { useInstructionSet(setBefore_); }

    static std::vector<PaddedBox<Scalar>> draw(const BoxScene<Scalar>& scene, std::size_t count,
                                               Random& random) {
        std::vector<PaddedBox<Scalar>> boxes;
        for (std::size_t i = 0; i < count; ++i) {
            boxes.push_back(padded(scene.draw(random)));
        }
        return boxes;
    }

    static Table<Scalar> tableOf(const std::vector<PaddedBox<Scalar>>& boxes,
                                 const LevelSizes& sizes) {
        std::vector<std::uint32_t> slots(boxes.size());
        std::iota(slots.begin(), slots.end(), 0U);
        Table<Scalar> table;
        table.build(slots, boxes, sizes);
        return table;
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

    static std::vector<IndexPair> copyOf(const PairList& list) {
        return {list.pairs().begin(), list.pairs().end()};
    }

    /// What all kernels make of the boxes, one after the other.
    static std::vector<std::vector<IndexPair>> resultsOf(
        const std::vector<PaddedBox<Scalar>>& boxes, const std::vector<PaddedBox<Scalar>>& moved,
        const LevelSizes& sizes) {
        const Table<Scalar> table = tableOf(boxes, sizes);
        const Table<Scalar> movedTable = tableOf(moved, sizes);
        KernelCost cost;
        PairList joined;
        PairParts parts;
        joinTable(table, serialFor, parts, joined, cost);
        PairList walked;
        queryTable(table, movedTable.columns(), movedTable.size(), serialFor, parts, walked, cost);
        PairList together;
        together.append([&](PairSink& sink) {
            queryBatch(table, movedTable.columns(), movedTable.size(), sink, cost);
        });
        std::vector<IndexPair> apart(joined.size());
        apart.resize(kernels<Scalar>().selectApart(joined.pairs().data(), joined.size(),
                                                   table.order().data(), moved.data(),
                                                   apart.data()));
        std::vector<IndexPair> filed;
        for (std::uint32_t i = 0; i < table.size(); ++i) {
            filed.push_back({table.order()[i], table.proxyIndex(i)});
        }
        const PairList onWays = querySwept(table, movedTable, moved);
        return {copyOf(joined), copyOf(walked), apart, filed, copyOf(together), copyOf(onWays)};
    }

    static std::vector<IndexPair> sorted(std::vector<IndexPair> pairs) {
        std::sort(pairs.begin(), pairs.end(), [](const IndexPair& a, const IndexPair& b) {
            return std::pair(a.a, a.b) < std::pair(b.a, b.b);
        });
        return pairs;
    }

private:
    InstructionSet setBefore_{};
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
            const auto boxes = this->draw(scene, scene.count, random);
            const auto moved = this->draw(scene, scene.count, random);
            useInstructionSet(InstructionSet::scalar);
            const auto expected = this->resultsOf(boxes, moved, sizes);
            // Boxes that are looked for together find what they find one by one.
            ASSERT_EQ(this->sorted(expected[4]), this->sorted(expected[1]));
            for (const InstructionSet set : kVectorSets) {
                if (isAvailable(set)) {
                    useInstructionSet(set);
                    ASSERT_EQ(this->resultsOf(boxes, moved, sizes), expected) << nameOf(set);
                }
            }
            found += expected[0].size() + expected[1].size() + expected[2].size();
            passed += expected[5].size();
            passedBy += expected[1].size() - expected[5].size();
        }
    }
    EXPECT_GT(found, 10000U);
    EXPECT_GT(passed, 1000U);
    EXPECT_GT(passedBy, 1000U);
}

TYPED_TEST(KernelsTest, TellApartThePairsThatBruteForceTellsApart) {
    Random random(0x5eed0502);
    const auto boxes = this->draw(test::hostileScene<TypeParam>(), 200, random);
    std::vector<IndexPair> pairs;
    std::vector<IndexPair> expected;
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
        for (std::uint32_t b = 0; b < boxes.size(); ++b) {
            pairs.push_back({a, b});
            if (!overlaps(unpadded(boxes[a]), unpadded(boxes[b]))) {
                expected.push_back({a, b});
            }
        }
    }
    for (const InstructionSet set : {InstructionSet::scalar, InstructionSet::sse2,
                                     InstructionSet::avx2, InstructionSet::avx512}) {
        if (!isAvailable(set)) {
            continue;
        }
        useInstructionSet(set);
        std::vector<IndexPair> apart(pairs.size());
        apart.resize(kernels<TypeParam>().selectApart(pairs.data(), pairs.size(), nullptr,
                                                      boxes.data(), apart.data()));
        EXPECT_EQ(apart, expected) << nameOf(set);
    }
}

TEST(InstructionSets, ScalarIsAlwaysAvailableAndTheBestOneIsInUse) {
    EXPECT_TRUE(isAvailable(InstructionSet::scalar));
    EXPECT_TRUE(isAvailable(instructionSet()));
    EXPECT_STREQ(nameOf(InstructionSet::avx512), "AVX-512");
}

TEST(PairList, KeepsWhatItHasWhenItGrows) {
    PairList list;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        list.push({i, i + 1});
    }
    ASSERT_EQ(list.size(), 1000U);
    for (std::uint32_t i = 0; i < 1000; ++i) {
        ASSERT_EQ(list.pairs()[i], (IndexPair{i, i + 1}));
    }
    const std::size_t bytes = list.memoryBytes();
    list.clear();
    EXPECT_EQ(list.size(), 0U);
    EXPECT_EQ(list.memoryBytes(), bytes);
}

}  // namespace
}  // namespace hashphase::detail
