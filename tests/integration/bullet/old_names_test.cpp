// SPDX-License-Identifier: Zlib

// Programs written for an earlier version: old names compile, with a warning, and do what the new ones do.

#include <tests/support/box_scenes.hpp>
#include <tests/support/camera_matrices.hpp>

#include <broadphase/crowd.hpp>
#include <broadphase/frustum.hpp>
#include <broadphase/ground_footprint.hpp>
#include <broadphase/moving_box.hpp>
#include <broadphase/nearest.hpp>
#include <broadphase/pairs.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/bullet/pair_cache.hpp>
#include <integration/culling/culler.hpp>
#include <integration/effects/scene_cost.hpp>
#include <integration/picking/view.hpp>

#include <gtest/gtest.h>

#include <array>
#include <type_traits>

namespace hashphase::test {
namespace {

static_assert(std::is_same_v<Crowd<float>, RadiusSearch<float>>);
static_assert(std::is_same_v<View<double>, Camera<double>>);
static_assert(std::is_same_v<Culler<float>::View, Culler<float>::Frustum>);
static_assert(std::is_same_v<ProxyCouple, BulletProxyPair>);
static_assert(SceneCounter::couplesWatched == SceneCounter::pairsWatched);

TEST(OldNames, FindThePairsOfANewProxyAtOnce) {
    Grid<float> grid;
    Pairs<float> pairs(grid);
    const ProxyId a = grid.add(makeBox<float>(0, 0, 0, 1, 1, 1));
    const ProxyId b = grid.add(makeBox<float>(0.5, 0, 0, 2, 1, 1));
    EXPECT_EQ(pairs.announce(a, acceptAllPairs).born.size(), 1U);
    EXPECT_EQ(pairs.announce(b, std::array{a}, acceptAllPairs).born.size(), 0U) << "it is known";
}

TEST(OldNames, BoundAWay) {
    const MovingBox<float> moving{makeBox<float>(0, 0, 0, 1, 1, 1), {3, 0, 0}};
    EXPECT_EQ(wayBounds(moving).max(), sweptBounds(moving).max());
    EXPECT_EQ(wayBounds(moving, 0, 0.5).max(), sweptBounds(moving, 0, 0.5).max());
}

TEST(OldNames, SeeThroughACamera) {
    const Eigen::Matrix4f matrix = cameraMatrix<float>({}, {0, 0, 0}, {0, 0, -1});
    EXPECT_EQ(viewError(matrix, Viewport(0, 0, 800, 600)), "");
    EXPECT_NE(viewError(matrix, Viewport(0, 0, 0, 600)), "");
    Grid<float> grid;
    Culler<float> culler(0);
    const auto frustum = frustumRegion<float>(matrix, DepthRange::zeroToOne);
    culler.look(grid, frustum);
    EXPECT_EQ(&culler.view(), &culler.frustum());
    EXPECT_TRUE(culler.view() == frustum);
}

TEST(OldNames, ReadTheSearchOfARarestColour) {
    RarestColour<float> rarest;
    EXPECT_EQ(&rarest.crowd(), &rarest.search());
}

}  // namespace
}  // namespace hashphase::test
