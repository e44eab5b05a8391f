// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/ground_heights.hpp>
#include <demos/viewer/draw/ground_levels.hpp>
#include <tests/viewer/draw/sample_pictures.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace hashphase::demos {
namespace {

GroundMesh hills() {
    return makeGroundMesh(SampleWorld().corners);
}

View viewFrom(const Vector3<float>& eye, const Vector3<float>& target) {
    return {sampleCamera(eye, target), {kSampleWidth, kSampleHeight}};
}

std::vector<std::uint32_t> chosen(const GroundMesh& mesh, const View& view) {
    GroundLevels levels(mesh);
    EXPECT_TRUE(levels.hasLevels());
    std::vector<std::uint32_t> indices;
    levels.choose(view, indices);
    return indices;
}

/// A triangle by its corners, whatever it begins with.
std::vector<std::array<std::uint32_t, 3>> sortedTriangles(const std::vector<std::uint32_t>& all) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t i = 0; i < all.size(); i += 3) {
        std::array triangle{all[i], all[i + 1], all[i + 2]};
        std::ranges::sort(triangle);
        triangles.push_back(triangle);
    }
    std::ranges::sort(triangles);
    return triangles;
}

TEST(GroundMesh, SharesCornersAtOnePlaceAndLooksUp) {
    const GroundMesh mesh = hills();
    EXPECT_EQ(mesh.vertices.size(), 41U * 41);
    EXPECT_EQ(mesh.indices.size(), 6U * 40 * 40);
    for (const GroundVertex& vertex : mesh.vertices) {
        EXPECT_GT(vertex.normal.y(), 0.5F);
        EXPECT_NEAR(vertex.normal.norm(), 1, 1e-5);
    }
}

TEST(GroundLevels, AreTheTrianglesThemselvesWhereTheEyeIsNear) {
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
    const GroundMesh mesh = makeGroundMesh(corners);
    const auto indices = chosen(mesh, viewFrom({10, 90, 10}, {10, 0, 10}));
    EXPECT_EQ(sortedTriangles(indices), sortedTriangles(mesh.indices));
}

TEST(GroundLevels, HaveNoCracksWhereTheyMeet) {
    const GroundMesh mesh = hills();
    for (const float height : {20.0F, 60.0F, 150.0F}) {
        // Not above the middle, so that patches lie at different distances, and with all on the
        // screen.
        View view = viewFrom({60, height, 60}, {60, 0, 60});
        view.tangents = {100, 100};
        const auto indices = chosen(mesh, view);
        EXPECT_LT(indices.size(), mesh.indices.size());
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
        for (std::size_t i = 0; i < indices.size(); ++i) {
            const std::uint32_t next = i % 3 == 2 ? indices[i - 2] : indices[i + 1];
            ++edges[std::minmax(indices[i], next)];
        }
        const auto isBorder = [&](std::uint32_t a, std::uint32_t b, int axis, float side) {
            return mesh.vertices[a].position[axis] == side &&
                   mesh.vertices[b].position[axis] == side;
        };
        for (const auto& [edge, count] : edges) {
            const auto [a, b] = edge;
            const bool isOuter = isBorder(a, b, 0, -80) || isBorder(a, b, 0, 80) ||
                                 isBorder(a, b, 2, -80) || isBorder(a, b, 2, 80);
            EXPECT_EQ(count, isOuter ? 1 : 2) << "between " << a << " and " << b;
        }
    }
}

TEST(GroundLevels, LeaveOutWhatIsNotOnTheScreen) {
    const GroundMesh mesh = hills();
    EXPECT_TRUE(chosen(mesh, viewFrom({0, 200, 0}, {0, 400, 1})).empty());
    const auto ahead = chosen(mesh, viewFrom({0, 5, 0}, {100, 5, 0}));
    EXPECT_FALSE(ahead.empty());
    EXPECT_LT(ahead.size(), mesh.indices.size() * 2 / 3);
}

TEST(GroundLevels, AreNotForGroundThatIsNoLattice) {
    std::vector<Vector3<float>> corners = SampleWorld().corners;
    corners[100].x() += 0.5F;
    EXPECT_FALSE(GroundLevels(makeGroundMesh(corners)).hasLevels());
    corners = SampleWorld().corners;
    corners.resize(corners.size() - 3);
    EXPECT_FALSE(GroundLevels(makeGroundMesh(corners)).hasLevels());
}

TEST(GroundHeights, AreThoseOfTheTriangles) {
    const GroundHeights heights(hills());
    for (float x = -79; x < 80; x += 7.3F) {
        for (float z = -79; z < 80; z += 5.9F) {
            const auto place = heights.at(x, z);
            ASSERT_TRUE(place);
            EXPECT_NEAR(place->height, SampleWorld::height(x, z), 0.2F);
        }
    }
    EXPECT_FALSE(heights.at(81, 0));
    EXPECT_FALSE(heights.at(0, -81));
    EXPECT_FALSE(GroundHeights().at(0, 0));
}

}  // namespace
}  // namespace hashphase::demos
