// SPDX-License-Identifier: Zlib

#include <integration/picking/drag_selection.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/picking_oracle.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class DragSelection : public testing::Test {
protected:
    // Closer than rounding can tell, both answers are right.
    static constexpr double kNearly = sizeof(Scalar) == sizeof(float) ? 2e-4 : 1e-9;

    DragSelection() {
        Random random(0x5eed0730);
        for (int i = 0; i < 400; ++i) {
            const auto box = boxAround<Scalar>(
                random.pointIn(-20, 20), Vector3<double>::Constant(random.logBetween(0.05, 3)));
            bodies.push_back({grid.add(box), box});
        }
    }

    bool isSelected(ProxyId id) const {
        return std::binary_search(selected.begin(), selected.end(), id);
    }

    Grid<Scalar> grid;
    std::vector<Placed<Scalar>> bodies;
    std::vector<ProxyId> selected;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(DragSelection, Scalars);

Pixel anyPixel(Random& random) {
    return {random.between(0, 1480), random.between(-50, 870)};  // some beside the viewport
}

TYPED_TEST(DragSelection, FindsWhatBruteForceFindsWhateverTheOrderOfCorners) {
    Random random(0x5eed0731);
    std::size_t found = 0;
    std::size_t inside = 0;
    for (int i = 0; i < 150; ++i) {
        SCOPED_TRACE(i);
        const CameraLens lens = randomLens(random);
        const auto matrix =
            cameraMatrix<TypeParam>(lens, random.pointIn(-20, 20), random.pointIn(-9, 9));
        const Camera<TypeParam> view(matrix, lens.depthRange, kViewport);
        const Pixel a = anyPixel(random);
        const Pixel b = random.chance(0.3)
                            ? Pixel(a + Pixel(random.between(0, 40), random.between(0, 40)))
                            : anyPixel(random);
        const auto planes = planesBetween(matrix, lens.depthRange, kViewport, a, b);
        const bool isBeside = (a.x() < 100 && b.x() < 100) || (a.x() > 1380 && b.x() > 1380) ||
                              (a.y() < 50 && b.y() < 50) || (a.y() > 770 && b.y() > 770);
        EXPECT_EQ(selectionError(view, a, b).empty(), !isBeside);
        select(this->grid, view, a, b, this->selected);
        for (const auto& body : this->bodies) {
            const double depth = depthInVolume(planes, body.box.template cast<double>());
            if (isBeside || std::abs(depth) > this->kNearly) {
                ASSERT_EQ(this->isSelected(body.id), depth > 0 && !isBeside) << depth;
            }
        }
        found += this->selected.size();
        const std::vector<ProxyId> touched = this->selected;
        for (const auto& [first, second] :
             {std::pair(b, a), std::pair(Pixel(a.x(), b.y()), Pixel(b.x(), a.y()))}) {
            select(this->grid, view, first, second, this->selected);
            EXPECT_EQ(this->selected, touched);
        }
        select(this->grid, view, a, b, this->selected, Containment::inside);
        for (const auto& body : this->bodies) {
            double least = std::numeric_limits<double>::infinity();
            for (const OraclePlane& plane : planes) {
                for (unsigned corner = 0; corner < 8; ++corner) {
                    const auto type = static_cast<typename Aabb<TypeParam>::CornerType>(corner);
                    least = std::min(
                        least, plane.signedDistance(body.box.corner(type).template cast<double>()));
                }
            }
            if (isBeside || std::abs(least) > this->kNearly) {
                ASSERT_EQ(this->isSelected(body.id), least > 0 && !isBeside);
            }
        }
        inside += this->selected.size();
    }
    EXPECT_GT(found, 1500U);
    EXPECT_GT(inside, 300U);
}

// Found when a slightly smaller box is met by the ray, and not unless a slightly larger one is.
TYPED_TEST(DragSelection, OfNoAreaIsWhatLiesUnderThePoint) {
    Random random(0x5eed0732);
    std::size_t found = 0;
    for (int i = 0; i < 1500; ++i) {
        SCOPED_TRACE(i);
        const CameraLens lens = randomLens(random);
        const auto matrix =
            cameraMatrix<TypeParam>(lens, random.pointIn(-20, 20), random.pointIn(-9, 9));
        const Camera<TypeParam> view(
            matrix, lens.depthRange, kViewport,
            lens.isReversed ? DepthOrder::reversed : DepthOrder::nearFirst);
        const Pixel pixel(random.between(100, 1380), random.between(50, 770));
        const RayRegion<TypeParam> ray = view.rayThrough(pixel, 1000);
        select(this->grid, view, pixel, pixel, this->selected);
        for (const auto& body : this->bodies) {
            const Vector3<TypeParam> doubt =
                Vector3<TypeParam>::Constant(static_cast<TypeParam>(this->kNearly * 10));
            const Aabb<TypeParam> smaller(body.box.min() + doubt, body.box.max() - doubt);
            const Aabb<TypeParam> larger(body.box.min() - doubt, body.box.max() + doubt);
            if (ray.key(smaller) >= 0) {
                ASSERT_TRUE(this->isSelected(body.id));
            } else if (ray.key(larger) < 0) {
                ASSERT_FALSE(this->isSelected(body.id));
            }
        }
        found += this->selected.size();
    }
    EXPECT_GT(found, 1000U);
}

/// Looking level: the horizon is in the middle.
template <class Scalar>
Camera<Scalar> levelView() {
    CameraLens lens;
    lens.farPlane = std::numeric_limits<double>::infinity();
    return {cameraMatrix<Scalar>(lens, {0, 2, 0}, {0, 2, -1}), lens.depthRange, kViewport};
}

TYPED_TEST(DragSelection, BesideTheViewportSelectsNothingAndSaysSo) {
    const auto view = levelView<TypeParam>();
    const auto errorOf = [&](const Pixel& a, const Pixel& b) {
        this->selected.assign(3, ProxyId{});
        select(this->grid, view, a, b, this->selected);
        EXPECT_TRUE(this->selected.empty());
        EXPECT_TRUE(selectionRegion(view, a, b).isEmpty());
        return selectionError(view, a, b);
    };
    EXPECT_NE(errorOf({0, 100}, {99, 600}).find("outside the viewport"), std::string::npos);
    EXPECT_NE(errorOf({500, 771}, {600, 900}).find("outside the viewport"), std::string::npos);
    EXPECT_NE(errorOf({500, -9}, {400, -5}).find("outside the viewport"), std::string::npos);
    EXPECT_NE(errorOf({std::nan(""), 100}, {700, 600}).find("NaN"), std::string::npos);
    EXPECT_EQ(selectionError(view, {100, 50}, {20, 10}), "");  // the viewport's corner
    EXPECT_EQ(selectionError(view, {-1e9, -1e9}, {1e9, 1e9}), "");
    const Camera<TypeParam> bad(view.viewProjection(), view.depthRange(), Viewport{});
    EXPECT_NE(selectionError(bad, {0, 0}, {9, 9})
                  .find("viewport is not finite, or its width or height is not above 0"),
              std::string::npos);
    this->selected.assign(3, ProxyId{});
    select(this->grid, bad, {0, 0}, {9, 9}, this->selected);
    EXPECT_TRUE(this->selected.empty());
}

TYPED_TEST(DragSelection, AsksTheFilter) {
    const auto view = levelView<TypeParam>();
    const auto isEven = [](ProxyId id) { return id.index % 2 == 0; };
    select(this->grid, view, {100, 50}, {1380, 770}, this->selected);
    std::vector<ProxyId> expected = this->selected;
    std::erase_if(expected, [&](ProxyId id) { return !isEven(id); });
    EXPECT_LT(expected.size(), this->selected.size());
    select(this->grid, view, {100, 50}, {1380, 770}, this->selected, Containment::touching, isEven);
    EXPECT_EQ(this->selected, expected);
}

}  // namespace
}  // namespace hashphase::test
