// SPDX-License-Identifier: Zlib

// Cameras and margins at the ends of what numbers can say: what is visible is never culled.

#include <integration/camera/frustum.hpp>
#include <integration/culling/culler.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/oracles.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class HardViews : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(HardViews, Scalars);

template <class Scalar>
ConvexRegion<Scalar> viewFrom(const CameraLens& lens, const Vector3<double>& eye,
                              const Vector3<double>& target, Touch touch) {
    return frustumRegion<Scalar>(cameraMatrix<Scalar>(lens, eye, target), lens.depthRange,
                                 wholeScreen<Scalar>(), Containment::touching, touch);
}

/// The cube from 0 to `edge`.
template <class Scalar>
ConvexRegion<Scalar> cubeView(Scalar edge) {
    using Plane = typename ConvexRegion<Scalar>::Plane;
    std::vector<Plane> planes;
    for (int axis = 0; axis < 3; ++axis) {
        planes.emplace_back(Vector3<Scalar>::Unit(axis), Scalar(0));
        planes.emplace_back(-Vector3<Scalar>::Unit(axis), edge);
    }
    return ConvexRegion<Scalar>(planes);
}

// Ten thousand frames and more in which boxes approach by the margin, or by so little that a sum of
// such steps would be rounded down: whoever is visible is in the set, in every frame.
TYPED_TEST(HardViews, NeverDriftsOutOfItsMargin) {
    constexpr auto most = std::numeric_limits<TypeParam>::max();
    const auto view = cubeView<TypeParam>(8);
    // A quarter of what changes the last digit of a number between a half and one.
    const TypeParam tiny = std::numeric_limits<TypeParam>::epsilon() / 8;
    for (const TypeParam step :
         {tiny, std::nextafter(tiny, most), TypeParam(0.25), std::nextafter(TypeParam(0.25), most),
          std::nextafter(TypeParam(0.25), TypeParam(0)), TypeParam(1),
          std::nextafter(TypeParam(1), most), std::nextafter(TypeParam(1), TypeParam(0))}) {
        SCOPED_TRACE(step);
        Grid<TypeParam> grid;
        std::vector<Placed<TypeParam>> proxies;
        Culler<TypeParam> culler(1);
        for (int k = 0; k < 8; ++k) {
            // Just outside of the margin, by 800 of the least steps at most, so that they are not
            // in the set at first.
            const TypeParam front = -1 - 100 * tiny * static_cast<TypeParam>(k + 1);
            const Aabb<TypeParam> box(Vector3<TypeParam>(front - 1, 2, TypeParam(k) / 2),
                                      Vector3<TypeParam>(front, 3, TypeParam(k) / 2));
            proxies.push_back({grid.add(box), box});
        }
        culler.look(grid, view);
        const auto approach = [&](TypeParam by) {
            TypeParam moved = 0;  // at most, of what rounding made of it
            for (Placed<TypeParam>& proxy : proxies) {
                const TypeParam from = proxy.box.max()[0];
                proxy.box.max()[0] += by;
                moved = std::max(moved, std::nextafter(proxy.box.max()[0] - from, most));
                grid.move(proxy.id, proxy.box);
            }
            culler.look(grid, view, moved);
        };
        approach(1 - 20'000 * tiny);  // nearly the whole margin at once
        std::size_t visible = 0;
        const int frames = step < TypeParam(0.1) ? 25'000 : 10'000;
        for (int frame = 0; frame < frames; ++frame) {
            approach(step);
            for (const Placed<TypeParam>& proxy : proxies) {
                const bool isInView = view.key(proxy.box) >= 0;
                visible += isInView ? 1 : 0;
                ASSERT_TRUE(!isInView || culler.isVisible(proxy.id)) << "frame " << frame;
            }
            if (proxies[0].box.max()[0] > 8) {
                for (Placed<TypeParam>& proxy : proxies) {
                    proxy.box.max()[0] -= 10;
                }
            }
        }
        EXPECT_GT(visible, 0U);
    }
}

TYPED_TEST(HardViews, SeesTheBoxAroundTheCameraAndTheOneAroundAllThatIsSeen) {
    Grid<TypeParam> grid;
    const ProxyId around = grid.add(makeBox<TypeParam>(-1, -1, -1, 1, 1, 1));
    const ProxyId everything = grid.add(makeBox<TypeParam>(-1e6, -1e6, -1e6, 1e6, 1e6, 1e6));
    const ProxyId plane = grid.add(makeBox<TypeParam>(-1e18, -1e18, -1e18, 1e18, -0.5, 1e18));
    const ProxyId behind = grid.add(makeBox<TypeParam>(-5, -1, -1, -4, 1, 1));
    Culler<TypeParam> culler;
    for (const double farPlane : {100.0, 1e5, std::numeric_limits<double>::infinity()}) {
        for (const Touch touch : {Touch::exact, Touch::byPlanes}) {
            for (const bool filed : {false, true}) {
                CameraLens lens;
                lens.farPlane = farPlane;
                culler.look(grid, viewFrom<TypeParam>(lens, {0, 0, 0}, {1, 0, 0}, touch));
                EXPECT_TRUE(culler.isVisible(around)) << farPlane;
                EXPECT_TRUE(culler.isVisible(everything)) << farPlane;
                EXPECT_TRUE(culler.isVisible(plane)) << farPlane;
                EXPECT_FALSE(culler.isVisible(behind)) << farPlane;
                if (!filed) {
                    grid.update();
                }
            }
        }
    }
}

// A frustum that is a line or a point sees what these go through; one that is turned inside out has no
// point, and sees nothing.
TYPED_TEST(HardViews, SeesThroughAFrustumWithoutAnAreaWhatLiesOnItsLine) {
    using Rectangle = decltype(wholeScreen<TypeParam>());
    Grid<TypeParam> grid;
    const ProxyId ahead = grid.add(makeBox<TypeParam>(5, -1, -1, 6, 1, 1));
    const ProxyId beside = grid.add(makeBox<TypeParam>(5, 2, 2, 6, 3, 3));
    CameraLens lens;
    const auto camera = cameraMatrix<TypeParam>(lens, {0, 0, 0}, {1, 0, 0});
    Rectangle line = wholeScreen<TypeParam>();
    line.min().x() = line.max().x() = 0;
    Rectangle middle = line;
    middle.min().y() = middle.max().y() = 0;
    Culler<TypeParam> culler;
    for (const Rectangle& rectangle : {line, middle}) {
        for (const Touch touch : {Touch::exact, Touch::byPlanes}) {
            culler.look(grid, frustumRegion<TypeParam>(camera, lens.depthRange, rectangle,
                                                       Containment::touching, touch));
            EXPECT_TRUE(culler.isVisible(ahead));
            EXPECT_FALSE(culler.isVisible(beside));
        }
    }
    auto planes = frustumPlanes<TypeParam>(camera, lens.depthRange);
    for (auto& plane : planes) {
        plane.coeffs() *= -1;
    }
    const ConvexRegion<TypeParam> insideOut(planes);
    EXPECT_TRUE(insideOut.isEmpty());
    EXPECT_EQ(culler.look(grid, insideOut).hits, 0U);
}

}  // namespace
}  // namespace hashphase::test
