// SPDX-License-Identifier: Zlib

// Denormal numbers, on processors that take them for zero, on those that do not, and where threads
// differ.

#include <tests/support/box_scenes.hpp>
#include <tests/support/denormal_mode.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class Denormals : public testing::Test {
protected:
    void SetUp() override {
        if (!DenormalMode::kIsKnown) {
            GTEST_SKIP() << "it is not known how to set the mode of this processor";
        }
    }

    /// A number that is not denormal, of any size.
    static Scalar normalNumber(Random& random) {
        if (random.chance(0.1)) {
            return 0;
        }
        const auto least = static_cast<double>(std::numeric_limits<Scalar>::min());
        const auto number = static_cast<Scalar>(
            random.chance(0.2) ? least * random.between(1, 3) : random.logBetween(least, 1e29));
        return random.chance(0.5) ? number : -number;
    }

    /// Many of them end where others begin.
    static std::vector<Aabb<Scalar>> boxesOfNormalNumbers(std::size_t count) {
        Random random(0x5eed1101);
        std::vector<Scalar> numbers;
        for (int i = 0; i < 60; ++i) {
            numbers.push_back(normalNumber(random));
        }
        std::vector<Aabb<Scalar>> boxes;
        while (boxes.size() < count) {
            Aabb<Scalar> box;
            for (std::uint32_t axis = 0; axis < 3; ++axis) {
                const Scalar a = numbers[random.below(60)];
                const Scalar b = random.chance(0.3) ? a : numbers[random.below(60)];
                box.min()[axis] = std::min(a, b);
                box.max()[axis] = std::max(a, b);
            }
            boxes.push_back(box);
        }
        return boxes;
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Denormals, Scalars);

/// A parallel loop whose threads have a mode of their own.
auto threadsIn(bool isFlushed) {
    return [isFlushed, threads = ThreadedFor(2, 0x5eed1102)](std::size_t count, std::size_t grain,
                                                             LoopBody body) mutable {
        threads(count, grain, [&](std::size_t begin, std::size_t end) {
            const DenormalMode mode(isFlushed);
            body(begin, end);
        });
    };
}

TYPED_TEST(Denormals, DoNotMatterToOtherNumbersWhateverTheModesOfTheThreads) {
    const auto boxes = this->boxesOfNormalNumbers(300);
    std::vector<Placed<TypeParam>> proxies;
    std::vector<std::vector<ProxyPair>> pairsOf;
    for (const double cellSize : {0.0, 1e-30, 1.0, 1e10, 1e30}) {
        for (int modes = 0; modes < 4; ++modes) {
            SCOPED_TRACE(testing::Message() << "cells of " << cellSize << ", modes " << modes);
            const DenormalMode mode((modes & 1) != 0);
            auto threads = threadsIn((modes & 2) != 0);
            GridConfig config;
            config.cellSize = cellSize;
            Grid<TypeParam> grid(config);
            Pairs<TypeParam> pairs(grid);
            proxies.clear();
            for (const Aabb<TypeParam>& box : boxes) {
                proxies.push_back({grid.add(box), box});
            }
            const auto born = pairs.update([](ProxyId, ProxyId) { return true; }, threads).born;
            const std::vector<ProxyPair> actual(born.begin(), born.end());
            ASSERT_EQ(differences(actual, pairsByBruteForce<TypeParam>(proxies)), "");
            pairsOf.push_back(actual);
            // What was filed by a thread of one mode is looked for by one of the other.
            const DenormalMode opposite((modes & 2) == 0);
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                const BoxRegion<TypeParam> region{boxes[i]};
                CollectKeys<TypeParam> expected;
                visitByBruteForce<TypeParam>(proxies, region, expected);
                ASSERT_EQ(differences(find(grid, region), expected.sorted()), "");
            }
        }
    }
    for (const std::vector<ProxyPair>& pairs : pairsOf) {
        EXPECT_EQ(differences(pairs, pairsOf[0]), "");
    }
    EXPECT_GT(pairsOf[0].size(), 300U);
}

// They are compared as the processor compares numbers, and by nothing else: taken for zero, more of
// them touch.
TYPED_TEST(Denormals, AreComparedAsTheProcessorComparesThem) {
    using Limits = std::numeric_limits<TypeParam>;
    Random random(0x5eed1103);
    const auto unit = static_cast<double>(Limits::min()) / 4096;  // 1e-40 is some of them
    std::vector<Aabb<TypeParam>> boxes;
    for (int i = 0; i < 200; ++i) {
        const Vector3<double> low = random.pointIn(-4000, 4000).array().round() * unit;
        const Vector3<double> high = (low.array() + 500 * unit).matrix();
        boxes.emplace_back(low.cast<TypeParam>(), high.cast<TypeParam>());
    }
    std::vector<std::size_t> counts;
    for (const bool isFlushed : {false, true}) {
        for (const double cellSize : {0.0, 1e-30, 1.0}) {
            GridConfig config;
            config.cellSize = cellSize;
            const DenormalMode mode(isFlushed);
            counts.push_back(expectPairsOfBruteForce<TypeParam>(boxes, config));
        }
    }
    EXPECT_GT(counts[0], 10U);
    EXPECT_LT(counts[0], counts[3]);
    EXPECT_EQ(counts[3], 200U * 199 / 2) << "all at zero";
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(counts[i], counts[i / 3 * 3]);
    }
    GridConfig tooFine;
    tooFine.cellSize = 1e-38;
    EXPECT_NE(configError(tooFine), "");
}

}  // namespace
}  // namespace hashphase::test
