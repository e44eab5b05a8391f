// SPDX-License-Identifier: Zlib

#include <integration/ai/rarest_colour.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/radius_oracle.hpp>
#include <tests/support/script.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

using Colours = std::vector<std::uint32_t>;

template <class Scalar>
class RarestColourTest : public testing::Test {
protected:
    /// RarestColour::update() by looking at every two agents.
    static void updateByBruteForce(std::span<const Placed<Scalar>> proxies, Scalar radius,
                                   std::uint32_t colourCount, Colours& colours) {
        const Colours before = colours;
        for (const auto& [id, neighbours] : neighboursByBruteForce(proxies, radius)) {
            const auto counts = groupCounts(neighbours, colourCount,
                                            [&before](ProxyId i) { return before[i.index]; });
            const auto rarest = std::min_element(counts.begin(), counts.end());
            colours[id.index] = static_cast<std::uint32_t>(rarest - counts.begin());
        }
    }

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

TYPED_TEST(RarestColourTest, IsThatOfBruteForceFrameByFrameInEveryScene) {
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        GridWorld<TypeParam> world;
        Script<TypeParam> script(scene, 0x5eed0f01);
        script.begin(world);
        constexpr std::size_t kPlaces = 4096;
        Colours colours = this->drawColours(script.random(), kPlaces, 9);  // one too many
        Colours expected = colours;
        std::size_t changes = 0;
        for (int frame = 0; frame < 12; ++frame) {
            SCOPED_TRACE(testing::Message() << scene.name << ", frame " << frame);
            const auto proxies = script.proxies();
            const Vector3<TypeParam> way =
                agentPosition(proxies[0].box) - agentPosition(proxies[1].box);
            const TypeParam radius = way.cwiseAbs().maxCoeff() / 2;
            const std::uint32_t colourCount = 1 + script.random().below(8);
            this->updateByBruteForce(proxies, radius, colourCount, expected);
            const Colours before = colours;
            this->rarest_.update(world.grid, radius, colourCount, colours);
            ASSERT_EQ(colours, expected);
            changes += colours != before ? 1 : 0;
            world.grid.update();
            script.playFrame(world);
        }
        EXPECT_GT(changes, 6U) << scene.name;
    }
}

TYPED_TEST(RarestColourTest, ChangesSomeAsIfAllHadLookedAndTheyAloneHadChanged) {
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        GridWorld<TypeParam> world;
        Script<TypeParam> script(scene, 0x5eed0f07);
        script.begin(world);
        Colours colours = this->drawColours(script.random(), 4096, 9);  // one too many
        std::size_t changes = 0;
        for (int frame = 0; frame < 6; ++frame) {
            SCOPED_TRACE(testing::Message() << scene.name << ", frame " << frame);
            const auto proxies = script.proxies();
            const Vector3<TypeParam> way =
                agentPosition(proxies[0].box) - agentPosition(proxies[1].box);
            const TypeParam radius = way.cwiseAbs().maxCoeff() / 2;
            const auto counts = [](ProxyId id) { return id.index % 7 != 0; };
            std::vector<ProxyId> some;
            for (const Placed<TypeParam>& proxy : proxies) {
                if (counts(proxy.id) && script.random().chance(0.3)) {
                    some.push_back(proxy.id);
                }
            }
            Colours all = colours;
            this->rarest_.update(world.grid, radius, 8, all, counts);
            Colours expected = colours;
            for (const ProxyId id : some) {
                expected[id.index] = all[id.index];
            }
            changes += expected != colours ? 1 : 0;
            Colours onThreads = colours;
            ThreadedFor threadedFor(3, 3);
            this->rarest_.updateSome(world.grid, radius, 8, onThreads, some, counts, threadedFor);
            ASSERT_EQ(onThreads, expected);
            this->rarest_.updateSome(world.grid, radius, 8, colours, some, counts);
            ASSERT_EQ(colours, expected);
            world.grid.update();
            script.playFrame(world);
        }
        EXPECT_GT(changes, 3U) << scene.name;
    }
}

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
