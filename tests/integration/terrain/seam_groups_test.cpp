// SPDX-License-Identifier: Zlib

// By how large numbers corners were computed, beside a plain list of triangles.

#include <integration/terrain/detail/seam_groups.hpp>
#include <tests/support/random.hpp>

#include <Eigen/Core>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hashphase::test {
namespace {

// A few triangles of every shift of the origin stay: more groups than there is room for.
TEST(SeamGroups, NameNothingNearerThanATriangleCame) {
    Random random(0x5eed2502);
    detail::SeamGroups<double> groups;
    struct Triangle {
        std::uint8_t group;
        double extent;
        std::vector<Eigen::Vector2d> origins{{0, 0}};  // since it came, from the present one
    };
    std::vector<Triangle> triangles;
    for (int step = 0; step < 2000; ++step) {
        const double extent = random.logBetween(1e-6, 1e6);
        groups.reserveOne();
        triangles.push_back({groups.add(extent, 1), extent});
        if (random.chance(0.4)) {
            const double x = random.between(-100, 100);
            const double z = random.between(-100, 100);
            groups.shiftOrigin(x, z);
            for (Triangle& triangle : triangles) {
                for (Eigen::Vector2d& origin : triangle.origins) {
                    origin += Eigen::Vector2d(x, z);
                }
                triangle.origins.emplace_back(0, 0);
            }
        }
        while (triangles.size() > (step < 1000 ? 400U : 20U)) {
            const std::size_t i = random.below(static_cast<std::uint32_t>(triangles.size()));
            groups.remove(triangles[i].group);
            triangles[i] = triangles.back();
            triangles.pop_back();
        }
        const double x = random.between(-50, 50);
        const double z = random.between(-50, 50);
        double least = 0;
        for (const Triangle& triangle : triangles) {
            double largest = 0;
            for (const Eigen::Vector2d& origin : triangle.origins) {
                largest = std::max(largest, (origin + Eigen::Vector2d(x, z)).cwiseAbs().maxCoeff());
            }
            const double extentNow = std::clamp(triangle.extent, 1.0 / 1024, 16384.0);
            least = std::max(least, largest + extentNow);
        }
        ASSERT_GE(groups.farthest(x, z) + groups.extent(), least * (1 - 1e-12)) << step;
        ASSERT_LE(groups.size(), 256U);
    }
    for (const Triangle& triangle : triangles) {
        groups.remove(triangle.group);
    }
    EXPECT_EQ(groups.extent(), 0);
    EXPECT_EQ(groups.farthest(1, -2), 2);
}

}  // namespace
}  // namespace hashphase::test
