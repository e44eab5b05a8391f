// SPDX-License-Identifier: Zlib

// A shift of the origin by what is no number, or at a time when it may not be, is asserted.

#include <broadphase/grid.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace hashphase::test {
namespace {

#if HASHPHASE_ENABLE_ASSERTS
TEST(OriginShiftOfAGrid, ByWhatIsNotFiniteIsAsserted) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    EXPECT_THROW(grid.shiftOrigin({0, std::numeric_limits<float>::infinity(), 0}), BrokenAssert);
    EXPECT_THROW(grid.shiftOrigin({std::numeric_limits<float>::quiet_NaN(), 0, 0}), BrokenAssert);
}

TEST(OriginShiftOfAGrid, WithinAQueryIsAsserted) {
    struct Shift {
        Grid<float>& grid;
        int count = 0;
        void add(ProxyId /*id*/, float /*key*/) {
            ++count;
            EXPECT_THROW(grid.shiftOrigin({1, 0, 0}), BrokenAssert);
        }
        static float limit() { return 1; }
    };
    const ThrowingAsserts throwing;
    Grid<float> grid;
    const auto box = makeBox<float>(0, 0, 0, 1, 1, 1);
    const ProxyId id = grid.add(box);
    Shift shift{grid};
    grid.visit(BoxRegion<float>{box}, shift);
    EXPECT_EQ(shift.count, 1);
    EXPECT_TRUE(isSameBits(grid.box(id), box));
}
#endif

}  // namespace
}  // namespace hashphase::test
