// SPDX-License-Identifier: Zlib

// What happens where numbers that are counted up come round. Takes minutes: for HASHPHASE_LONG_TESTS=1.

#include <broadphase/pairs.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>

namespace hashphase::test {
namespace {

struct LongLimits : testing::Test {
    void SetUp() override {
        if (std::getenv("HASHPHASE_LONG_TESTS") == nullptr) {
            GTEST_SKIP() << "takes minutes; set HASHPHASE_LONG_TESTS";
        }
    }
    Grid<float> grid;
    const Aabb<float> box = makeBox<float>(0, 0, 0, 1, 1, 1);
};

TEST_F(LongLimits, OfTheNumbersOfUpdatesAreNotNoticed) {
    Pairs<float> pairs(grid);
    static_cast<void>(grid.add(box, Mobility::resting));
    static_cast<void>(grid.add(box));
    const ProxyId mover = grid.add(box);
    EXPECT_EQ(pairs.update().born.size(), 3U);
    for (std::uint64_t update = 0; update < (std::uint64_t{1} << 32) + 1000; ++update) {
        if ((update & 0xffffff) < 20 || update + 1000 > (std::uint64_t{1} << 32)) {
            const auto y = static_cast<double>(update % 2) / 2;
            grid.move(mover, makeBox<float>(0, y, 0, 1, y + 1, 1));
        }
        const PairChanges changes = pairs.update();
        ASSERT_EQ(changes.born.size() + changes.died.size(), 0U) << update;
    }
    EXPECT_EQ(pairs.count(), 3U);
    EXPECT_EQ(grid.validate(), "");
    EXPECT_EQ(pairs.validate(), "");
}

TEST_F(LongLimits, OfIdsAreReachedWithoutOneThatNamesTwoProxies) {
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
