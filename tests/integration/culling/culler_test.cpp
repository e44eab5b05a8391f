// SPDX-License-Identifier: Zlib

#include <integration/camera/frustum.hpp>
#include <integration/culling/culler.hpp>
#include <tests/integration/scene_lives.hpp>
#include <tests/support/cameras.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class CullerTest : public testing::Test {
protected:
    using View = ConvexRegion<Scalar>;

    static View viewFrom(const CameraLens& lens, const Vector3<double>& eye,
                         const Vector3<double>& target, Touch touch = Touch::byPlanes) {
        return frustumRegion<Scalar>(cameraMatrix<Scalar>(lens, eye, target), lens.depthRange,
                                     wholeScreen<Scalar>(), Containment::touching, touch);
    }

    /// Everything is in the set that touches the view; counted is what else is.
    static std::size_t expectNothingCulled(const Culler<Scalar>& culler, const View& view,
                                           std::span<const Placed<Scalar>> proxies) {
        std::size_t unseen = 0;
        for (const Placed<Scalar>& proxy : proxies) {
            if (view.key(proxy.box) >= 0) {
                EXPECT_TRUE(culler.isVisible(proxy.id)) << proxy.id.index;
            } else {
                unseen += culler.isVisible(proxy.id) ? 1 : 0;
            }
        }
        return unseen;
    }

    std::vector<Placed<Scalar>> addBoxes(Grid<Scalar>& grid, int count, double reach) {
        std::vector<Placed<Scalar>> proxies;
        for (int i = 0; i < count; ++i) {
            const auto box = boxAround<Scalar>(random_.pointIn(-reach, reach),
                                               Vector3<double>::Constant(random_.between(0.1, 1)));
            proxies.push_back({grid.add(box), box});
        }
        grid.update();
        return proxies;
    }

    Random random_{0x5eed0701};
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(CullerTest, Scalars);

TYPED_TEST(CullerTest, SeesWhatBruteForceSeesThroughEveryCameraInEveryScene) {
    std::size_t visible = 0;
    Culler<TypeParam> culler;
    playAllScenes<TypeParam>(0x5eed0702, 40, [&](const auto& grid, auto& script, int) {
        RegionMaker<TypeParam> make(script.random(), script.proxies());
        const Vector3<double> eye = make.point().template cast<double>();
        const Vector3<double> target = make.point().template cast<double>();
        const auto view = this->viewFrom(randomLens(script.random()), eye, target);
        culler.look(grid, view);
        EXPECT_EQ(this->expectNothingCulled(culler, view, script.proxies()), 0U);
        std::size_t listed = 0;
        culler.forEach([&](std::uint32_t index) {
            EXPECT_TRUE((culler.bits()[index / 64] >> (index % 64) & 1) != 0);
            ++listed;
        });
        EXPECT_EQ(listed, culler.count());
        visible += listed;
    });
    EXPECT_GT(visible, 3000U);
}

TYPED_TEST(CullerTest, KeepsItsSetOnlyWhileThatHasAllThatIsVisible) {
    Grid<TypeParam> grid;
    auto proxies = this->addBoxes(grid, 3000, 30);
    Culler<TypeParam> culler(TypeParam(2));
    CameraLens lens;
    lens.fieldOfView = 0.7;
    lens.farPlane = 40;
    Vector3<double> eye = Vector3<double>::Zero();
    double heading = 0;
    int kept = 0;
    for (int frame = 0; frame < 400; ++frame) {
        // Nobody moves farther than 0.05 m in a frame; the camera turns, and now and then jumps.
        for (int i = 0; i < 300; ++i) {
            auto& proxy = proxies[this->random_.below(3000)];
            const Vector3<double> way = this->random_.pointIn(-1, 1).normalized() * 0.05;
            proxy.box.translate(way.template cast<TypeParam>());
            grid.move(proxy.id, proxy.box);
        }
        grid.update();
        heading += this->random_.between(-0.003, 0.004);
        eye = frame % 100 == 99 ? this->random_.pointIn(-9, 9)
                                : Vector3<double>(eye + this->random_.pointIn(-0.03, 0.03));
        const auto view = this->viewFrom(
            lens, eye, eye + Vector3<double>(std::cos(heading), 0.1, std::sin(heading)));
        const QueryCost cost = culler.look(grid, view, TypeParam(0.051));
        kept += cost.hits + cost.boxesTested == 0 ? 1 : 0;
        this->expectNothingCulled(culler, view, proxies);
        ASSERT_FALSE(this->HasFailure()) << "frame " << frame;
    }
    EXPECT_GT(kept, 200);
    EXPECT_LT(kept, 396);
}

TYPED_TEST(CullerTest, LooksAnewWhenNobodyKnowsWhatMoved) {
    Grid<TypeParam> grid;
    this->addBoxes(grid, 500, 10);
    Culler<TypeParam> culler(TypeParam(1));
    const auto view = this->viewFrom({}, {0, 0, 0}, {1, 0, 0});
    constexpr auto nan = std::numeric_limits<TypeParam>::quiet_NaN();
    EXPECT_GT(culler.look(grid, view, 0).hits, 0U);  // there is nothing yet to be kept
    EXPECT_EQ(culler.look(grid, view, 0).hits, 0U);
    EXPECT_GT(culler.look(grid, view).hits, 0U);
    EXPECT_GT(culler.look(grid, view, nan).hits, 0U);
    EXPECT_GT(culler.look(grid, view, -1).hits, 0U);
    EXPECT_EQ(culler.look(grid, view, TypeParam(0.75)).hits, 0U);
    EXPECT_GT(culler.look(grid, view, TypeParam(0.75)).hits, 0U);  // altogether more than a margin
    // Of what lies inside, nothing is known when the volume moves.
    const auto matrix = cameraMatrix<TypeParam>({}, {0, 0, 0}, {1, 0, 0});
    const auto inside = frustumRegion<TypeParam>(matrix, DepthRange::zeroToOne,
                                                 wholeScreen<TypeParam>(), Containment::inside);
    EXPECT_GT(culler.look(grid, inside, 0).hits, 0U);
    EXPECT_GT(culler.look(grid, inside, 0).hits, 0U);
}

TYPED_TEST(CullerTest, KeepsItsSetWithAnInfiniteFarPlaneAndGivesItUpForABadCamera) {
    Grid<TypeParam> grid;
    this->addBoxes(grid, 500, 10);
    constexpr auto infinity = std::numeric_limits<TypeParam>::infinity();
    int kept = 0;
    for (int i = 0; i < 100; ++i) {
        CameraLens lens;
        lens.farPlane = std::numeric_limits<double>::infinity();
        const auto view = this->viewFrom(lens, this->random_.pointIn(-9, 9), {0, 0, 0});
        Culler<TypeParam> culler(TypeParam(3));
        culler.look(grid, view, 0);
        const std::size_t seen = culler.count();
        kept += culler.look(grid, view, TypeParam(0.1)).hits == 0 ? 1 : 0;
        EXPECT_EQ(culler.count(), seen);
        Culler<TypeParam> sloppy(infinity);
        sloppy.look(grid, view);
        EXPECT_EQ(sloppy.count(), grid.size());
        const auto nobody = [](ProxyId) { return false; };
        sloppy.look(grid, view, nobody);
        EXPECT_EQ(sloppy.count(), 0U) << "the filter has changed";
        Eigen::Matrix<TypeParam, 4, 4> bad = Eigen::Matrix<TypeParam, 4, 4>::Identity();
        bad(0, 0) = std::numeric_limits<TypeParam>::quiet_NaN();
        culler.look(grid, frustumRegion(bad, DepthRange::zeroToOne), 0);
        EXPECT_EQ(culler.count(), 0U);
        culler.look(grid, view, 0);
        EXPECT_EQ(culler.count(), seen);
    }
    // In single precision, rounding may bring the far plane back from infinity, where nothing is known
    // to a metre.
    EXPECT_GE(kept, sizeof(TypeParam) == sizeof(float) ? 95 : 100);
}

TYPED_TEST(CullerTest, AddsUpWhatMovesInFramesWithoutALook) {
    using Point = Vector3<TypeParam>;
    Grid<TypeParam> grid;
    const ProxyId id = grid.add({Point(0, 0, 0), Point(1, 1, 1)});
    Culler<TypeParam> culler(1);
    const ConvexRegion<TypeParam> everywhere({});
    culler.look(grid, everywhere);
    EXPECT_EQ(culler.findCount(), 1U);
    culler.noteMoves(TypeParam(0.5));
    culler.look(grid, everywhere, TypeParam(0.5));
    EXPECT_EQ(culler.findCount(), 1U);
    culler.noteMoves(TypeParam(0.25));
    culler.look(grid, everywhere, 0);
    EXPECT_EQ(culler.findCount(), 2U);
    EXPECT_TRUE(culler.isVisible(id));
    culler.forget(id.index);
    EXPECT_EQ(culler.count(), 0U);
    culler.forget(1'000'000);
    culler.look(grid, everywhere, 0);
    EXPECT_EQ(culler.count(), 0U) << "until the next set is found";
}

TYPED_TEST(CullerTest, LooksAnewWhenProxiesComeAndGoAndInAnotherGrid) {
    using Point = Vector3<TypeParam>;
    Grid<TypeParam> grid;
    Culler<TypeParam> culler(1);
    const ConvexRegion<TypeParam> everywhere({});
    const auto look = [&](Grid<TypeParam>& in, std::size_t expected) {
        const std::uint64_t found = culler.findCount();
        culler.look(in, everywhere, 0);
        EXPECT_EQ(culler.count(), expected);
        const bool hasLooked = culler.findCount() > found;
        culler.look(in, everywhere, 0);
        EXPECT_EQ(culler.findCount(), found + (hasLooked ? 1 : 0)) << "and then it is kept";
        return hasLooked;
    };
    EXPECT_TRUE(look(grid, 0));
    const ProxyId id = grid.add({Point(0, 0, 0), Point(1, 1, 1)});
    EXPECT_TRUE(look(grid, 1));
    grid.remove(id);
    EXPECT_EQ(grid.add({Point(3, 0, 0), Point(4, 1, 1)}).index, id.index);
    EXPECT_TRUE(look(grid, 1));
    grid.update();
    EXPECT_FALSE(look(grid, 1));
    grid.shiftOrigin(Point(8, 0, 0));
    EXPECT_TRUE(look(grid, 1));
    grid.clear();
    EXPECT_TRUE(look(grid, 0));
    for (int i = 0; i < 3; ++i) {  // where the one before has been, perhaps
        const auto other = std::make_unique<Grid<TypeParam>>();
        EXPECT_FALSE(other->add({Point(0, 0, 0), Point(1, 1, 1)}).isNull());
        EXPECT_TRUE(look(*other, 1));
    }
}

TYPED_TEST(CullerTest, StaysWithAFrozenViewAndStillSeesWhatMoves) {
    Grid<TypeParam> grid;
    this->addBoxes(grid, 500, 10);
    Culler<TypeParam> culler;
    const auto here = this->viewFrom({}, {0, 0, 0}, {1, 0, 0});
    const auto there = this->viewFrom({}, {0, 0, 0}, {-1, 0, 0});
    culler.look(grid, here);
    culler.freeze(true);
    const std::size_t seen = culler.count();
    culler.look(grid, there);
    EXPECT_EQ(culler.count(), seen);
    const ProxyId newcomer = grid.add(makeBox<TypeParam>(5, 0, 0, 6, 1, 1));
    culler.look(grid, there);
    EXPECT_TRUE(culler.isVisible(newcomer));
    culler.freeze(false);
    culler.look(grid, there);
    EXPECT_FALSE(culler.isVisible(newcomer));
}

TYPED_TEST(CullerTest, CountsWhatIsDrawnAndNotSeen) {
    Grid<TypeParam> grid;
    const auto proxies = this->addBoxes(grid, 4000, 20);
    std::size_t unseenByPlanes = 0;
    std::size_t unseenWithMargin = 0;
    for (int i = 0; i < 40; ++i) {
        CameraLens lens = randomLens(this->random_);
        lens.farPlane = 15;
        const Vector3<double> eye = this->random_.pointIn(-20, 20);
        const Vector3<double> target = this->random_.pointIn(-20, 20);
        const auto exact = this->viewFrom(lens, eye, target, Touch::exact);
        Culler<TypeParam> exactly;
        exactly.look(grid, exact);
        EXPECT_EQ(exactly.overdraw(grid).unseen, 0U);
        EXPECT_EQ(exactly.overdraw(grid).visible, exactly.count());
        for (const double margin : {0, 3}) {
            Culler<TypeParam> culler(static_cast<TypeParam>(margin));
            culler.look(grid, this->viewFrom(lens, eye, target));
            const Overdraw overdraw = culler.overdraw(grid);
            EXPECT_EQ(overdraw.unseen, this->expectNothingCulled(culler, exact, proxies));
            EXPECT_EQ(overdraw.visible, culler.count());
            (margin > 0 ? unseenWithMargin : unseenByPlanes) += overdraw.unseen;
        }
    }
    EXPECT_GT(unseenByPlanes, 0U);
    EXPECT_GT(unseenWithMargin, 10 * unseenByPlanes);
}

TYPED_TEST(CullerTest, SeesNothingThroughABadCameraOrInAnEmptyGrid) {
    Grid<TypeParam> grid;
    Culler<TypeParam> culler(std::numeric_limits<TypeParam>::quiet_NaN());
    culler.look(grid, ConvexRegion<TypeParam>({}));
    EXPECT_EQ(culler.count(), 0U);
    this->addBoxes(grid, 100, 10);
    Eigen::Matrix<TypeParam, 4, 4> matrix = Eigen::Matrix<TypeParam, 4, 4>::Identity();
    culler.look(grid, frustumRegion(matrix, DepthRange::zeroToOne));
    matrix(0, 0) = std::numeric_limits<TypeParam>::quiet_NaN();
    culler.look(grid, frustumRegion(matrix, DepthRange::zeroToOne));
    EXPECT_EQ(culler.count(), 0U);
    EXPECT_EQ(culler.overdraw(grid).visible, 0U);
}

#if HASHPHASE_ENABLE_ASSERTS
TYPED_TEST(CullerTest, DoesNotLookFromWithinItsOwnCallbacks) {
    const ThrowingAsserts throwing;
    Grid<TypeParam> grid;
    this->addBoxes(grid, 5, 3);
    const ConvexRegion<TypeParam> everything(std::span<const Eigen::Hyperplane<TypeParam, 3>>{});
    Culler<TypeParam> culler;
    int calls = 0;
    const auto lookAgain = [&] {
        ++calls;
        EXPECT_THROW(culler.look(grid, everything), BrokenAssert);
    };
    const auto filter = [&](ProxyId) {
        lookAgain();
        return true;
    };
    culler.look(grid, everything, filter);
    culler.forEach([&](std::uint32_t) { lookAgain(); });
    EXPECT_EQ(calls, 10);
    EXPECT_EQ(culler.count(), 5U);
}
#endif

}  // namespace
}  // namespace hashphase::test
