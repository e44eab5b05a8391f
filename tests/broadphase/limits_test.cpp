// SPDX-License-Identifier: Zlib

// How many of anything there may be, and what happens beyond.

#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/limits.hpp>
#include <broadphase/pairs.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

namespace hashphase::test {
namespace {

TEST(Limits, OfSetsAreKnownBeforeTheyAreReached) {
    detail::FlatSet set;
    set.findOrInsert(7);
    EXPECT_THROW(set.reserve(std::size_t{1} << 32), std::length_error);
    EXPECT_EQ(set.size(), 1U);
    EXPECT_EQ(set.find(7), 0U);
    EXPECT_EQ(set.validate(), "");
}

TEST(Limits, AreReachedByWhatIsMoreAndNotByWhatIsAsMuch) {
    EXPECT_NO_THROW(detail::checkCount(5, 5, ""));
    EXPECT_THROW(detail::checkCount(6, 5, ""), std::length_error);
    EXPECT_THROW(detail::checkCount(~std::size_t{0}, 5, ""), std::length_error);
}

// Minutes of updates that change nothing: for HASHPHASE_LONG_TESTS=1.
TEST(Limits, OfTheNumbersOfUpdatesAreNotNoticed) {
    if (std::getenv("HASHPHASE_LONG_TESTS") == nullptr) {
        GTEST_SKIP() << "takes minutes; set HASHPHASE_LONG_TESTS";
    }
    Grid<float> grid;
    Pairs<float> pairs(grid);
    const auto acceptAll = [](ProxyId, ProxyId) { return true; };
    static_cast<void>(grid.add(makeBox<float>(0, 0, 0, 1, 1, 1), Mobility::resting));
    static_cast<void>(grid.add(makeBox<float>(0, 0, 0, 1, 1, 1)));
    const ProxyId mover = grid.add(makeBox<float>(0, 0, 0, 1, 1, 1));
    EXPECT_EQ(pairs.update(acceptAll).born.size(), 3U);
    for (std::uint64_t update = 0; update < (std::uint64_t{1} << 32) + 1000; ++update) {
        const bool hasCome = (update & 0xffffff) < 20 || update + 1000 > (std::uint64_t{1} << 32);
        if (hasCome) {
            const auto y = static_cast<double>(update % 2) / 2;
            grid.move(mover, makeBox<float>(0, y, 0, 1, y + 1, 1));
        }
        const PairChanges changes = pairs.update(acceptAll);
        ASSERT_EQ(changes.born.size() + changes.died.size(), 0U) << update;
    }
    EXPECT_EQ(pairs.count(), 3U);
    EXPECT_EQ(grid.validate(), "");
    EXPECT_EQ(pairs.validate(), "");
}

TEST(Limits, OfIdsAreReachedWithoutOneThatNamesTwoProxies) {
    if (std::getenv("HASHPHASE_LONG_TESTS") == nullptr) {
        GTEST_SKIP() << "takes minutes; set HASHPHASE_LONG_TESTS";
    }
    Grid<float> grid;
    const auto box = makeBox<float>(0, 0, 0, 1, 1, 1);
    const ProxyId first = grid.add(box);
    ProxyId id = first;
    std::uint64_t count = 0;
    for (; id.index == first.index; ++count) {
        grid.remove(id);
        ASSERT_FALSE(grid.contains(id));
        grid.update();
        id = grid.add(box);
        ASSERT_FALSE(grid.contains(first));
    }
    EXPECT_EQ(count, (std::uint64_t{1} << 31) - 1);
    EXPECT_EQ(grid.size(), 1U);
    EXPECT_EQ(grid.validate(), "");
}

}  // namespace
}  // namespace hashphase::test
