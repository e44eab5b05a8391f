// SPDX-License-Identifier: Zlib

#include <broadphase/tree/hilbert.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

namespace hashphase::detail {
namespace {

TEST(HilbertCurve, VisitsEveryPointOnceAndStepsToANeighbour) {
    for (int bits = 1; bits <= 5; ++bits) {
        const std::uint32_t side = 1U << bits;
        const std::array<int, 3> nowhere{-1, -1, -1};
        std::vector<std::array<int, 3>> points(side * side * side, nowhere);
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            const std::array<std::uint32_t, 3> point{i % side, i / side % side, i / side / side};
            const std::uint64_t place = placeOnHilbertCurve(point, bits);
            ASSERT_LT(place, points.size());
            ASSERT_EQ(points[place], nowhere);
            points[place] = {static_cast<int>(point[0]), static_cast<int>(point[1]),
                             static_cast<int>(point[2])};
        }
        for (std::size_t place = 1; place < points.size(); ++place) {
            int steps = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                steps += std::abs(points[place][axis] - points[place - 1][axis]);
            }
            ASSERT_EQ(steps, 1) << "place " << place << " of " << bits << " bits";
        }
    }
}

TEST(HilbertCurve, FillsACubeBeforeItGoesToTheNext) {
    // At any resolution, the place begins with that of the larger cube around.
    for (std::uint32_t i = 0; i < 4096; ++i) {
        const std::array<std::uint32_t, 3> point{i * 2654435761U >> 11, i * 40503U & 0x1fffffU,
                                                 i * 97U};
        const std::uint64_t place = placeOnHilbertCurve(point, kHilbertBits);
        for (int bits = kHilbertBits - 1; bits > 0; --bits) {
            const int shift = kHilbertBits - bits;
            ASSERT_EQ(placeOnHilbertCurve({point[0] >> shift, point[1] >> shift, point[2] >> shift},
                                          bits),
                      place >> (3 * shift));
        }
    }
}

}  // namespace
}  // namespace hashphase::detail
