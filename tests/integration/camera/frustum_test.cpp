// SPDX-License-Identifier: Zlib

#include <integration/camera/frustum.hpp>
#include <tests/support/cameras.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace hashphase::test {
namespace {

template <class Scalar>
class Frustum : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Frustum, Scalars);

// The definition of what is seen, on points: whatever has a visible point is found.
TYPED_TEST(Frustum, HasEveryPointThatTheMatrixPutsOnTheScreen) {
    Random random(0x5eed0604);
    int visible = 0;
    for (int i = 0; i < 300; ++i) {
        const CameraLens lens = randomLens(random);
        const auto matrix =
            cameraMatrix<TypeParam>(lens, random.pointIn(-9, 9), random.pointIn(-9, 9));
        const auto region = frustumRegion<TypeParam>(matrix, lens.depthRange);
        for (int k = 0; k < 100; ++k) {
            const Vector3<TypeParam> point = random.pointIn(-30, 30).template cast<TypeParam>();
            const Eigen::Vector4d clip =
                matrix.template cast<double>() * point.homogeneous().template cast<double>();
            const double low = lens.depthRange == DepthRange::zeroToOne ? 0 : -clip.w();
            const double slack = sizeof(TypeParam) == sizeof(float) ? 1e-3 : 1e-9;
            const double margin =
                std::min({clip.w() - std::abs(clip.x()), clip.w() - std::abs(clip.y()),
                          clip.w() - clip.z(), clip.z() - low});
            if (std::abs(margin) > slack) {
                EXPECT_EQ(region.key({point, point}) >= 0, margin > 0) << i;
            }
            visible += margin > 0 ? 1 : 0;
        }
    }
    EXPECT_GT(visible, 1000);
}

TYPED_TEST(Frustum, IsTheSameForAMatrixOfAnyScale) {
    using Point = Vector3<TypeParam>;
    Random random(0x5eed0605);
    int visible = 0;
    for (int i = 0; i < 30; ++i) {
        const CameraLens lens = randomLens(random);
        const auto matrix =
            cameraMatrix<TypeParam>(lens, random.pointIn(-9, 9), random.pointIn(-9, 9));
        const TypeParam most = std::numeric_limits<TypeParam>::max();
        const auto huge = (matrix * (most / matrix.cwiseAbs().maxCoeff() / 2)).eval();
        const auto region = frustumRegion<TypeParam>(matrix, lens.depthRange);
        const auto same = frustumRegion<TypeParam>(huge, lens.depthRange);
        for (int k = 0; k < 100; ++k) {
            const Point point = random.pointIn(-30, 30).template cast<TypeParam>();
            const Aabb<TypeParam> box(point - Point::Constant(1), point + Point::Constant(1));
            EXPECT_EQ(same.key(box) >= 0, region.key(box) >= 0) << i;
            visible += region.key(box) >= 0 ? 1 : 0;
        }
    }
    EXPECT_GT(visible, 100);
}

TYPED_TEST(Frustum, SaysWhyItIsBad) {
    using Matrix = Eigen::Matrix<TypeParam, 4, 4>;
    const Matrix good = Matrix::Identity();
    EXPECT_EQ(frustumError(good), "");
    Matrix bad = good;
    bad(1, 2) = std::numeric_limits<TypeParam>::quiet_NaN();
    EXPECT_NE(frustumError(bad).find("Pass 16 finite numbers"), std::string::npos);
    EXPECT_TRUE(frustumRegion(bad, DepthRange::zeroToOne).isEmpty());
    bad = good;
    bad.row(3).setZero();
    EXPECT_NE(frustumError(bad).find("last row"), std::string::npos);
    auto rectangle = wholeScreen<TypeParam>();
    rectangle.min().x() = 2;
    EXPECT_NE(frustumError(good, rectangle).find("min() not above max()"), std::string::npos);
    EXPECT_TRUE(frustumRegion(good, DepthRange::zeroToOne, rectangle).isEmpty());
}

}  // namespace
}  // namespace hashphase::test
