// SPDX-License-Identifier: Zlib

#include <integration/camera/camera.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/picking_oracle.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace hashphase::test {
namespace {

template <class Scalar>
class Views : public testing::Test {
protected:
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    using Matrix = Eigen::Matrix<Scalar, 4, 4>;

    static Camera<Scalar> viewOf(const CameraLens& lens, const Vector3<double>& eye,
                                 const Vector3<double>& target) {
        return {cameraMatrix<Scalar>(lens, eye, target), lens.depthRange, kViewport,
                lens.isReversed ? DepthOrder::reversed : DepthOrder::nearFirst};
    }

    /// How far off a device coordinate may be, for the row of the matrix that makes it: as far as rounding the
    /// two numbers that are added to Scalar may move it, four times, and the inverse in double. Where the ray
    /// passes the origin, these are larger than their sum.
    static double doubtOf(const Matrix& matrix, int row, const RayRegion<Scalar>& ray, Scalar share,
                          const Eigen::Vector4d& clip) {
        const Eigen::Matrix4d exact = matrix.template cast<double>();
        const double step = static_cast<double>(std::numeric_limits<Scalar>::epsilon()) *
                                static_cast<double>(largestOf(ray, share)) * 4 +
                            1e-13 * exact.cwiseAbs().maxCoeff();
        const double ratio = std::abs(clip[row] / clip.w());
        return step * (exact.row(row).head<3>().norm() + ratio * exact.row(3).head<3>().norm()) /
                   std::abs(clip.w()) +
               1e-9;
    }

    static void expectSeenAt(const Camera<Scalar>& view, const RayRegion<Scalar>& ray, Scalar share,
                             const Pixel& pixel) {
        const Vector3<Scalar> point = ray.from() + share * ray.direction();
        const Eigen::Vector4d clip =
            clipCoordinates(view.viewProjection(), point.template cast<double>());
        EXPECT_GT(clip.w(), 0);
        const Pixel found = pixelOf(clip, view.viewport());
        EXPECT_NEAR(found.x(), pixel.x(),
                    kViewport.width / 2 * doubtOf(view.viewProjection(), 0, ray, share, clip));
        EXPECT_NEAR(found.y(), pixel.y(),
                    kViewport.height / 2 * doubtOf(view.viewProjection(), 1, ray, share, clip));
    }

    static Scalar largestOf(const RayRegion<Scalar>& ray, Scalar share) {
        return std::max(ray.from().cwiseAbs().maxCoeff(),
                        share * ray.direction().cwiseAbs().maxCoeff());
    }
    static Vector3<Scalar> endOf(const RayRegion<Scalar>& ray) {
        return ray.from() + ray.direction();
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Views, Scalars);

TYPED_TEST(Views, CastRaysFromTheNearPlaneToTheFarPlaneOfWhichEveryPointIsSeenAtThePixel) {
    Random random(0x5eed0702);
    int reversed = 0;
    for (int i = 0; i < 4000; ++i) {
        SCOPED_TRACE(i);
        const CameraLens lens = randomLens(random);
        const auto view = this->viewOf(lens, random.pointIn(-9, 9), random.pointIn(-9, 9));
        const Pixel pixel(random.between(0, 1500), random.between(0, 900));
        const RayRegion<TypeParam> ray = view.rayThrough(pixel, 500);
        ASSERT_FALSE(ray.isEmpty());
        for (const TypeParam share : {TypeParam(0), TypeParam(0.25), TypeParam(1)}) {
            this->expectSeenAt(view, ray, share, pixel);
        }
        const Vector3<double> from = ray.from().template cast<double>();
        const Vector3<double> to = this->endOf(ray).template cast<double>();
        const Eigen::Vector4d near = clipCoordinates(view.viewProjection(), from);
        const Eigen::Vector4d far = clipCoordinates(view.viewProjection(), to);
        const double least = lens.depthRange == DepthRange::zeroToOne ? 0 : -1;
        EXPECT_NEAR(near.z() / near.w(), lens.isReversed ? 1 : least,
                    this->doubtOf(view.viewProjection(), 2, ray, 0, near) * 4);
        if (std::isinf(lens.farPlane)) {
            EXPECT_NEAR(far.w() - near.w(), 500, 0.02);
        } else {
            EXPECT_NEAR(far.z() / far.w(), lens.isReversed ? least : 1,
                        this->doubtOf(view.viewProjection(), 2, ray, 1, far) * 4);
        }
        reversed += lens.isReversed ? 1 : 0;
    }
    EXPECT_GT(reversed, 1000);
}

TYPED_TEST(Views, AreExactThoughTheFarPlaneIsAMillionTimesAsFarAsTheNearOne) {
    Random random(0x5eed0703);
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE(i);
        CameraLens lens = randomLens(random);
        lens.isOrthographic = false;
        lens.fieldOfView = random.between(0.3, 2);
        lens.nearPlane = random.logBetween(0.01, 1);
        lens.farPlane = 1e6 * lens.nearPlane;
        const auto view = this->viewOf(lens, random.pointIn(-1, 1), random.pointIn(-9, 9));
        const Pixel pixel(random.between(100, 1380), random.between(50, 770));
        const RayRegion<TypeParam> ray = view.rayThrough(pixel);
        for (const double share : {1e-3, 0.5, 1.0}) {
            const auto along = static_cast<TypeParam>(share);
            const Vector3<TypeParam> point = ray.from() + along * ray.direction();
            const Pixel found = pixelOf(
                clipCoordinates(view.viewProjection(), point.template cast<double>()), kViewport);
            EXPECT_LT((found - pixel).norm(), sizeof(TypeParam) == sizeof(float) ? 0.01 : 1e-7);
        }
    }
}

TYPED_TEST(Views, CastRaysAsFarAsNumbersReach) {
    CameraLens lens;
    lens.farPlane = std::numeric_limits<double>::infinity();
    const auto view = this->viewOf(lens, {0, 0, 0}, {0, 0, -1});
    for (const double farthest : {1e30, 1e39, 1e300, std::numeric_limits<double>::infinity()}) {
        for (const Pixel& pixel : {middleOf(kViewport), Pixel(3, 5)}) {
            const RayRegion<TypeParam> ray = view.rayThrough(pixel, farthest);
            ASSERT_FALSE(ray.isEmpty()) << farthest;
            EXPECT_GE(-this->endOf(ray).z(), TypeParam(1e30)) << farthest;
            const Vector3<TypeParam> onIt =
                ray.from() + ray.direction() * (100 / ray.direction().norm());
            const Aabb<TypeParam> box(onIt - Vector3<TypeParam>::Constant(1),
                                      onIt + Vector3<TypeParam>::Constant(1));
            EXPECT_GE(ray.key(box), 0) << farthest;
        }
    }
    lens.isOrthographic = true;
    lens.nearPlane = -2e38;
    lens.farPlane = 2e38;
    EXPECT_FALSE(this->viewOf(lens, {0, 0, 0}, {0, 0, -1}).rayThrough(Pixel(3, 5)).isEmpty());
}

// Lengyel, "Oblique View Frustum Depth Projection and Clipping" (2005): the near plane is that of a
// mirror or of water, and the far plane goes wherever that leaves it.
TYPED_TEST(Views, CastRaysFromObliqueNearPlanes) {
    Random random(0x5eed0704);
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE(i);
        CameraLens lens;
        lens.depthRange = DepthRange::minusOneToOne;
        Eigen::Matrix4d projection = projectionMatrix(lens);
        // Through a point before the eye, with the eye on its outer side.
        const Vector3<double> through(random.between(-1, 1), random.between(-1, 1), -3);
        const Vector3<double> inwards(random.between(-0.6, 0.6), random.between(-0.6, 0.6), -1);
        const Eigen::Vector4d plane(inwards.x(), inwards.y(), inwards.z(), -inwards.dot(through));
        const Eigen::Vector4d corner =
            projection.inverse() *
            Eigen::Vector4d(plane.x() < 0 ? -1 : 1, plane.y() < 0 ? -1 : 1, 1, 1);
        projection.row(2) = plane.transpose() * (2 / plane.dot(corner)) - projection.row(3);
        const Eigen::Matrix4d world = viewMatrix(random.pointIn(-9, 9), random.pointIn(-9, 9));
        const Camera<TypeParam> view((projection * world).template cast<TypeParam>(),
                                     lens.depthRange, kViewport);
        const Pixel pixel(random.between(100, 1380), random.between(50, 770));
        const RayRegion<TypeParam> ray = view.rayThrough(pixel, 200);
        ASSERT_FALSE(ray.isEmpty());
        const Eigen::Vector4d from = world * ray.from().template cast<double>().homogeneous();
        EXPECT_NEAR(plane.dot(from), 0, 1e-3);
        this->expectSeenAt(view, ray, 0, pixel);
        this->expectSeenAt(view, ray, 1, pixel);
    }
}

TYPED_TEST(Views, TakeTheOrderOfDepthsFromThePerspective) {
    Random random(0x5eed0705);
    for (int i = 0; i < 500; ++i) {
        CameraLens lens = randomLens(random);
        const auto matrix =
            cameraMatrix<TypeParam>(lens, random.pointIn(-9, 9), random.pointIn(-9, 9));
        const Camera<TypeParam> forth(matrix, lens.depthRange, kViewport, DepthOrder::nearFirst);
        const Camera<TypeParam> back(matrix, lens.depthRange, kViewport, DepthOrder::reversed);
        const Pixel pixel(random.between(100, 1380), random.between(50, 770));
        const RayRegion<TypeParam> a = forth.rayThrough(pixel);
        const RayRegion<TypeParam> b = back.rayThrough(pixel);
        EXPECT_EQ(a.from() == b.from(), !lens.isOrthographic) << i;
    }
}

TEST(Viewports, AreMadeOfAnyNumbers) {
    const int width = 640;
    const unsigned height = 480;
    const Viewport viewport{0, 0.5F, width, height};
    EXPECT_EQ(viewport.x, 0);
    EXPECT_EQ(viewport.y, 0.5);
    EXPECT_EQ(viewport.width, 640);
    EXPECT_EQ(viewport.height, 480);
}

TEST(ViewsFarAway, AreExactAHundredThousandKilometresFromTheOrigin) {
    Random random(0x5eed0706);
    for (int i = 0; i < 1000; ++i) {
        SCOPED_TRACE(i);
        CameraLens lens = randomLens(random);
        lens.fieldOfView = std::max(lens.fieldOfView, 0.3);
        const Vector3<double> eye = random.pointIn(-1e8, 1e8);
        const Eigen::Matrix4d matrix = cameraMatrix<double>(lens, eye, eye + random.pointIn(-9, 9));
        const Camera<double> view(matrix, lens.depthRange, kViewport);
        ASSERT_EQ(cameraError(matrix, kViewport), "");
        const double y = random.between(50, 770);
        const Pixel pixel(random.between(100, 1380), y);
        const RayRegion<double> ray = view.rayThrough(pixel, 1000);
        for (const double share : {0.1, 1.0}) {
            const Vector3<double> point = ray.from() + share * ray.direction();
            const Eigen::Vector4d clip = clipCoordinates(matrix, point);
            EXPECT_LT((pixelOf(clip, kViewport) - pixel).norm() * std::min(clip.w(), 1.0), 2e-3);
        }
    }
}

TYPED_TEST(Views, EndRaysAtTheFarthestDistance) {
    CameraLens lens;
    lens.farPlane = this->kInfinity;
    for (const bool isReversed : {false, true}) {
        lens.isReversed = isReversed;
        const auto view = this->viewOf(lens, {0, 0, 0}, {0, 0, -1});
        const auto depthOf = [&](double farthest) {
            return -this->endOf(view.rayThrough({300, 100}, farthest)).z();
        };
        EXPECT_NEAR(depthOf(50), 50.1, 1e-3);
        EXPECT_NEAR(-this->endOf(view.rayThrough({300, 100})).z(), kFarthestView, 1);
        EXPECT_TRUE(view.rayThrough({300, 100}, 0).isEmpty());
        EXPECT_TRUE(view.rayThrough({300, 100}, -1).isEmpty());
        EXPECT_TRUE(view.rayThrough({300, 100}, this->kInfinity).isEmpty() ||
                    depthOf(this->kInfinity) > 1e6);
    }
}

TYPED_TEST(Views, HaveTheUpperLeftCornerOfTheViewportAtItsOrigin) {
    const auto view = this->viewOf({}, {0, 0, 0}, {0, 0, -1});
    const auto whole = view.rectangleBetween({100, 50}, {1380, 770});
    EXPECT_EQ(whole.min(), wholeScreen<TypeParam>().min());
    EXPECT_EQ(whole.max(), wholeScreen<TypeParam>().max());
    const RayRegion<TypeParam> ray = view.rayThrough({100, 50});
    EXPECT_LT(ray.direction().x(), 0);
    EXPECT_GT(ray.direction().y(), 0);
    const RayRegion<TypeParam> middle = view.rayThrough({740, 410});
    EXPECT_NEAR(middle.direction().x(), 0, 1e-5);
    EXPECT_NEAR(middle.direction().y(), 0, 1e-5);
}

TYPED_TEST(Views, SeeNothingWhenTheyAreBad) {
    using Matrix4 = Eigen::Matrix<TypeParam, 4, 4>;
    const Matrix4 good = cameraMatrix<TypeParam>({}, {1, 2, 3}, {0, 0, 0});
    const auto errorOf = [](const Matrix4& matrix, const Viewport& viewport) {
        const Camera<TypeParam> view(matrix, DepthRange::zeroToOne, viewport);
        EXPECT_FALSE(view.isValid());
        EXPECT_TRUE(view.rayThrough({1, 1}).isEmpty());
        EXPECT_TRUE(view.rectangleBetween({0, 0}, {9, 9}).isEmpty());
        return cameraError(matrix, viewport);
    };
    EXPECT_EQ(cameraError(good, kViewport), "");
    Matrix4 bad = good;
    bad(3, 3) = std::numeric_limits<TypeParam>::quiet_NaN();
    EXPECT_NE(errorOf(bad, kViewport).find("Pass 16 finite numbers"), std::string::npos);
    bad = good;
    bad.row(1) = bad.row(0) * TypeParam(2);
    EXPECT_NE(errorOf(bad, kViewport).find("has no inverse"), std::string::npos);
    bad.setZero();
    EXPECT_NE(errorOf(bad, kViewport), "");
    for (const Viewport& viewport :
         {Viewport{}, Viewport{0, 0, 10, 0}, Viewport{0, 0, -10, 10},
          Viewport{0, 0, this->kInfinity, 1}, Viewport{std::nan(""), 0, 1, 1}}) {
        EXPECT_NE(errorOf(good, viewport)
                      .find("viewport is not finite, or its width or height is not above 0"),
                  std::string::npos);
    }
    // Everything is behind the eye.
    const Camera<TypeParam> behind(-good, DepthRange::zeroToOne, kViewport);
    EXPECT_TRUE(behind.rayThrough({700, 400}).isEmpty());
}

TYPED_TEST(Views, HaveEmptyRaysAtPixelsThatAreNaN) {
    const auto view = this->viewOf({}, {0, 0, 0}, {0, 0, -1});
    EXPECT_TRUE(view.rayThrough({std::nan(""), 100}).isEmpty());
    EXPECT_TRUE(view.rayThrough({100, this->kInfinity}).isEmpty());
    EXPECT_TRUE(view.rayThrough({100, 100}, std::nan("")).isEmpty());
    EXPECT_TRUE(view.rectangleBetween({std::nan(""), 100}, {200, 200}).isEmpty());
}

}  // namespace
}  // namespace hashphase::test
