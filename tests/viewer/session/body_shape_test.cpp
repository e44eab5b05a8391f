// SPDX-License-Identifier: Zlib

#include <demos/viewer/stage/body_shape.hpp>

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace hashphase::demos {
namespace {

TEST(BodyShape, IsMetWhereItsSurfaceIs) {
    StageBody body;
    body.shape = StageBody::Shape::sphere;
    body.centre = {10, 0, 0};
    body.size.setConstant(2);
    EXPECT_FLOAT_EQ(*meets(body, {0, 0, 0}, {16, 0, 0}), 0.5F);
    EXPECT_FLOAT_EQ(*meets(body, {10, 1, 0}, {1, 0, 0}), 0);
    EXPECT_FALSE(meets(body, {0, 3, 0}, {20, 0, 0}));
    EXPECT_FALSE(meets(body, {0, 0, 0}, {7, 0, 0}));
    EXPECT_FALSE(meets(body, {0, 0, 0}, {-20, 0, 0}));
    body.shape = StageBody::Shape::box;
    body.size = {1, 2, 3};
    body.orientation = Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Vector3<float>::UnitZ());
    EXPECT_FLOAT_EQ(*meets(body, {0, 0, 0}, {16, 0, 0}), 0.5F);
    EXPECT_FALSE(meets(body, {0, 1.5F, 0}, {16, 0, 0}));
    EXPECT_LT((boxAround(body).min() - Vector3<float>(8, -1, -3)).norm(), 1e-5F);
}

TEST(BodyShape, OfACapsuleIsRoundAtItsEnds) {
    StageBody body;
    body.shape = StageBody::Shape::capsule;
    body.size = {1, 2, 0};
    const auto from = [&](const Vector3<float>& start, const Vector3<float>& way) {
        return meets(body, start, way);
    };
    EXPECT_FLOAT_EQ(*from({-5, 0, 0}, {10, 0, 0}), 0.4F);
    EXPECT_FLOAT_EQ(*from({0, 7, 0}, {0, -8, 0}), 0.5F);
    EXPECT_FLOAT_EQ(*from({0, 1, 0}, {0, 10, 0}), 0);
    EXPECT_FLOAT_EQ(*from({-5, 2.6F, 0}, {10, 0, 0}), 0.42F);
    EXPECT_FALSE(from({-5, 3.1F, 0}, {10, 0, 0}));
    EXPECT_FALSE(from({-5, 2.9F, 0.9F}, {10, 0, 0})) << "the corner of its box";
    EXPECT_FALSE(from({0.9F, 5, 0.9F}, {0, -10, 0})) << "the edge of its box";
    body.orientation = Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Vector3<float>::UnitZ());
    EXPECT_FLOAT_EQ(*from({-8, 0, 0}, {10, 0, 0}), 0.5F);
}

TEST(Ground, IsMetFromEitherSideWhereItsNearestTriangleIs) {
    const std::vector<Vector3<float>> roofs{{0, 1, 0}, {4, 1, 0}, {0, 1, 4},
                                            {0, 2, 0}, {4, 2, 0}, {0, 2, 4}};
    EXPECT_FLOAT_EQ(*meets(roofs, {1, 4, 1}, {0, -4, 0}), 0.5F);
    EXPECT_FLOAT_EQ(*meets(roofs, {1, 0, 1}, {0, 4, 0}), 0.25F);
    EXPECT_FALSE(meets(roofs, {1, 4, 1}, {0, -1, 0})) << "ends before";
    EXPECT_FALSE(meets(roofs, {1, 4, 1}, {0, 4, 0})) << "looks away";
    EXPECT_FALSE(meets(roofs, {3, 4, 3}, {0, -4, 0})) << "beside it";
    EXPECT_FALSE(meets(roofs, {1, 4, 1}, {1, 0, 0})) << "along it";
}

}  // namespace
}  // namespace hashphase::demos
