// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/ground.hpp>
#include <demos/viewer/draw/image.hpp>
#include <tests/viewer/draw/sample_pictures.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace hashphase::demos {
namespace {

Ground hills() {
    return Ground(SampleWorld().corners);
}

View viewFrom(const Vector3<float>& eye, const Vector3<float>& target) {
    return {sampleCamera(eye, target), {kSampleWidth, kSampleHeight}};
}

std::vector<std::uint32_t> chosen(Ground& ground, const View& view) {
    std::vector<std::uint32_t> indices;
    ground.choose(view, indices);
    return indices;
}

/// Triangles by their corners, whatever they begin with.
using Corner = std::array<float, 3>;
std::vector<std::array<Corner, 3>> sortedTriangles(const std::vector<Vector3<float>>& corners) {
    std::vector<std::array<Corner, 3>> triangles;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        std::array<Corner, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector3<float>& corner = corners[i + k];
            triangle[k] = {corner.x(), corner.y(), corner.z()};
        }
        std::ranges::sort(triangle);
        triangles.push_back(triangle);
    }
    std::ranges::sort(triangles);
    return triangles;
}

TEST(Ground, SharesCornersAtOnePlaceAndLooksUp) {
    const Ground ground = hills();
    EXPECT_EQ(ground.vertices().size(), 41U * 41);
    for (const Ground::Point& vertex : ground.vertices()) {
        EXPECT_GT(vertex.normal.y(), 0.5F);
        EXPECT_NEAR(vertex.normal.norm(), 1, 1e-5);
    }
}

TEST(Ground, IsTheTrianglesThemselvesWhereTheEyeIsNear) {
    // So steep that no coarser level will do, and with both kinds of diagonals.
    std::mt19937 random(2);
    std::vector<Vector3<float>> heights, corners;
    for (int i = 0; i < 400; ++i) {
        heights.emplace_back(static_cast<float>(i % 20), static_cast<float>(random() % 64),
                             static_cast<float>(i / 20));
    }
    for (int i = 0; i < 19 * 19; ++i) {
        const auto* first = &heights[static_cast<std::size_t>(i / 19 * 20 + i % 19)];
        const Vector3<float>&a = first[0], &b = first[1], &c = first[20], &d = first[21];
        if (random() % 2 == 0) {
            corners.insert(corners.end(), {a, c, b, b, c, d});
        } else {
            corners.insert(corners.end(), {a, c, d, a, d, b});
        }
    }
    Ground ground(corners);
    std::vector<Vector3<float>> drawn;
    for (const std::uint32_t index : chosen(ground, viewFrom({10, 90, 10}, {10, 0, 10}))) {
        drawn.push_back(ground.vertices()[index].position);
    }
    EXPECT_EQ(sortedTriangles(drawn), sortedTriangles(corners));
    // Its height is that of the triangles: of their middles, and beside these.
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        for (const Vector3<float>& share :
             {Vector3<float>(0.3F, 0.3F, 0.4F), Vector3<float>(0.7F, 0.2F, 0.1F)}) {
            const Vector3<float> place =
                share.x() * corners[i] + share.y() * corners[i + 1] + share.z() * corners[i + 2];
            const auto point = ground.at(place.x(), place.z());
            ASSERT_TRUE(point);
            EXPECT_NEAR(point->position.y(), place.y(), 1e-3) << i;
            const Vector3<float> side = corners[i + 1] - corners[i];
            EXPECT_NEAR(point->normal.dot(side.normalized()), 0, 1e-4) << i;
        }
    }
}

TEST(Ground, HasNoCracksWhereLevelsMeet) {
    Ground ground = hills();
    const std::size_t all = 6 * 40 * 40;
    for (const float height : {20.0F, 60.0F, 150.0F}) {
        // Not above the middle, so that patches lie at different distances, and with all on the
        // screen.
        View view = viewFrom({60, height, 60}, {60, 0, 60});
        view.tangents = {100, 100};
        const auto indices = chosen(ground, view);
        EXPECT_LT(indices.size(), all);
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
        for (std::size_t i = 0; i < indices.size(); ++i) {
            const std::uint32_t next = i % 3 == 2 ? indices[i - 2] : indices[i + 1];
            ++edges[std::minmax(indices[i], next)];
        }
        const auto isBorder = [&](std::uint32_t a, std::uint32_t b, int axis, float side) {
            return ground.vertices()[a].position[axis] == side &&
                   ground.vertices()[b].position[axis] == side;
        };
        for (const auto& [edge, count] : edges) {
            const auto [a, b] = edge;
            const bool isOuter = isBorder(a, b, 0, -80) || isBorder(a, b, 0, 80) ||
                                 isBorder(a, b, 2, -80) || isBorder(a, b, 2, 80);
            EXPECT_EQ(count, isOuter ? 1 : 2) << "between " << a << " and " << b;
        }
    }
}

TEST(Ground, LeavesOutWhatIsNotOnTheScreen) {
    Ground ground = hills();
    EXPECT_TRUE(chosen(ground, viewFrom({0, 200, 0}, {0, 400, 1})).empty());
    const auto ahead = chosen(ground, viewFrom({0, 5, 0}, {100, 5, 0}));
    EXPECT_FALSE(ahead.empty());
    EXPECT_LT(ahead.size(), 6U * 40 * 40 * 2 / 3);
}

TEST(Ground, IsRefusedWhereItIsNoLattice) {
    std::vector<Vector3<float>> corners = SampleWorld().corners;
    corners[100].x() += 0.5F;
    EXPECT_THROW(Ground{corners}, DrawError);
    corners = SampleWorld().corners;
    corners[100].y() += 0.5F;  // two corners at one place
    EXPECT_THROW(Ground{corners}, DrawError);
    corners = SampleWorld().corners;
    std::copy_n(corners.begin(), 3,
                corners.begin() + 6);  // a triangle twice, and another not at all
    EXPECT_THROW(Ground{corners}, DrawError);
    corners.resize(corners.size() - 3);
    EXPECT_THROW(Ground{corners}, DrawError);
}

TEST(Ground, IsNowhereBesideIt) {
    const Ground ground = hills();
    for (float x = -79; x < 80; x += 7.3F) {
        for (float z = -79; z < 80; z += 5.9F) {
            const auto point = ground.at(x, z);
            ASSERT_TRUE(point);
            EXPECT_NEAR(point->position.y(), SampleWorld::height(x, z), 0.2F);
        }
    }
    EXPECT_FALSE(ground.at(81, 0));
    EXPECT_FALSE(ground.at(0, -81));
    EXPECT_FALSE(Ground().at(0, 0));
}

}  // namespace
}  // namespace hashphase::demos
