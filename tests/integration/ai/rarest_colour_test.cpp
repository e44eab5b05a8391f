// SPDX-License-Identifier: Zlib

// Agents that take the colour that is rarest around them; in lives of all scenes: ai_scenes_test.cpp.

#include <integration/ai/rarest_colour.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

using Colours = std::vector<std::uint32_t>;

template <class Scalar>
class RarestColourTest : public testing::Test {
protected:
    static Colours drawColours(Random& random, std::size_t count, std::uint32_t colourCount) {
        Colours colours(count);
        for (std::uint32_t& colour : colours) {
            colour = random.below(colourCount);
        }
        return colours;
    }

    RarestColour<Scalar> rarest_;
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RarestColourTest, Scalars);

TYPED_TEST(RarestColourTest, DoesNotCountTheAgentItselfAndPrefersTheLowestColour) {
    Grid<TypeParam> grid;
    const auto add = [&grid](double x) {
        return grid.add(makeBox<TypeParam>(x, 0, 0, x, 0, 0)).index;
    };
    const std::uint32_t left = add(0);
    const std::uint32_t middle = add(1);
    const std::uint32_t right = add(2);
    const std::uint32_t alone = add(50);
    Colours colours(4);
    colours[left] = 0;
    colours[middle] = 1;
    colours[right] = 2;
    colours[alone] = 2;
    this->rarest_.update(grid, 1, 3, colours);
    EXPECT_EQ(colours[left], 0U) << "sees 1: of 0 and 2 the lower";
    EXPECT_EQ(colours[middle], 1U) << "sees 0 and 2, not its own";
    EXPECT_EQ(colours[right], 0U) << "sees 1";
    EXPECT_EQ(colours[alone], 0U) << "sees nobody";
}

TYPED_TEST(RarestColourTest, IsTheSameOnAnyNumberOfThreads) {
    Random random(0x5eed0f02);
    Grid<TypeParam> grid;
    for (int i = 0; i < 9000; ++i) {
        static_cast<void>(grid.add(boxAround<TypeParam>(random.pointIn(0, 40), {1, 1, 1})));
    }
    const Colours first = this->drawColours(random, grid.size(), 8);
    Colours expected = first;
    this->rarest_.update(grid, 4, 8, expected);
    for (const std::size_t threads : {2, 5}) {
        ThreadedFor threadedFor(threads, threads);
        Colours colours = first;
        this->rarest_.update(grid, 4, 8, colours, acceptAll, acceptAll, threadedFor);
        EXPECT_EQ(colours, expected);
    }
    const std::size_t bytes = this->rarest_.memoryBytes();
    this->rarest_.update(grid, 4, 8, expected);
    EXPECT_EQ(this->rarest_.memoryBytes(), bytes);
}

TYPED_TEST(RarestColourTest, ChangesNobodyWhomTheFilterRefusesOrWhoIsNowhere) {
    Grid<TypeParam> grid;
    const auto box = makeBox<TypeParam>(0, 0, 0, 1, 1, 1);
    const ProxyId agent = grid.add(box);
    const ProxyId refused = grid.add(box);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const ProxyId bad = grid.add(makeBox<TypeParam>(nan, 0, 0, 1, 1, 1));
    Colours colours{7, 7, 7};
    this->rarest_.update(grid, 1, 2, colours, [refused](ProxyId id) { return id != refused; });
    EXPECT_EQ(colours[agent.index], 0U);
    EXPECT_EQ(colours[refused.index], 7U);
    EXPECT_EQ(colours[bad.index], 7U);
    EXPECT_EQ(this->rarest_.search().size(), 1U);
}

TYPED_TEST(RarestColourTest, WantsAColourForEachAgentAndANumberOfThemThatCanBeCounted) {
    const ThrowingAsserts throwingAsserts;
    Grid<TypeParam> grid;
    static_cast<void>(grid.add(makeBox<TypeParam>(0, 0, 0, 1, 1, 1)));
    Colours colours(1);
    EXPECT_THROW(this->rarest_.update(grid, 1, 0, colours), BrokenAssert);
    EXPECT_THROW(this->rarest_.update(grid, 1, 33, colours), BrokenAssert);
    EXPECT_THROW(this->rarest_.update(grid, 1, 2, {}), BrokenAssert);
}

}  // namespace
}  // namespace hashphase::test
