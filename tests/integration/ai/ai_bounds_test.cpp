// SPDX-License-Identifier: Zlib

// The most that a question of an agent may cost, however far it reaches: about one test for each proxy.

#include <broadphase/radius_search.hpp>
#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class AiBounds : public testing::Test {
protected:
    static constexpr std::uint64_t kCount = 4000;
    static constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();
    static constexpr Scalar kNan = std::numeric_limits<Scalar>::quiet_NaN();

    /// Agents along a street of small cells.
    AiBounds() : grid(smallCells()) {
        Random random(0x5eed0a03);
        for (std::uint64_t i = 0; i < kCount; ++i) {
            const Vector3<double> at = random.pointIn({0, 0, 0}, {1e6, 20, 20});
            static_cast<void>(grid.add(boxAround<Scalar>(at, {0.25, 0.25, 0.25})));
        }
        grid.update();
    }

    static GridConfig smallCells() {
        GridConfig config;
        config.cellSize = 1;
        return config;
    }

    static void expectAPass(const QueryCost& cost, std::uint64_t passes = 1) {
        EXPECT_LE(cost.boxesTested, passes * kCount * 5 / 4);
        EXPECT_LE(cost.rowsVisited, passes * kCount);
    }

    Grid<Scalar> grid;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(AiBounds, Scalars);

TYPED_TEST(AiBounds, OfAnyRadiusIsOnePassOverAll) {
    std::vector<ProxyId> found;
    const Vector3<TypeParam> outside = Vector3<TypeParam>::Constant(TypeParam(-1e9));
    for (const Vector3<TypeParam>& eye : {Vector3<TypeParam>(5e5, 1, 1), outside}) {
        for (const TypeParam radius :
             {TypeParam(1e6), TypeParam(1e10), TypeParam(1e30), this->kInfinity}) {
            this->expectAPass(findWithin(this->grid, eye, radius, found));
            EXPECT_EQ(found.size(), radius > TypeParam(1e9) * 2 || eye[0] > 0 ? this->kCount : 0);
            this->expectAPass(estimateWithin(this->grid, eye, radius, found));
            EXPECT_EQ(found.size(), radius > TypeParam(1e9) * 2 || eye[0] > 0 ? this->kCount : 0);
        }
        for (const TypeParam none : {TypeParam(-1), this->kNan, -this->kInfinity}) {
            EXPECT_EQ(findWithin(this->grid, eye, none, found).boxesTested, 0U);
            EXPECT_TRUE(found.empty());
            EXPECT_EQ(estimateWithin(this->grid, eye, none, found).boxesTested, 0U);
            EXPECT_TRUE(found.empty());
        }
    }
    EXPECT_EQ(findWithin(this->grid, {0, this->kNan, 0}, TypeParam(1e30), found).boxesTested, 0U);
}

TYPED_TEST(AiBounds, OfRadarsAndZonesIsOnePassOverAllEach) {
    Radar<TypeParam> radar;
    const auto everybody = [](ProxyId) { return 0U; };
    RadarWindow<TypeParam> window;
    for (const TypeParam cellSize : {TypeParam(1e6), TypeParam(1e30)}) {
        window.cellSize = cellSize;
        for (const bool turned : {false, true}) {
            window.heading = turned ? std::optional(TypeParam(0.5)) : std::nullopt;
            radar.scan(this->grid, window, 1, everybody);
            this->expectAPass(radar.lastCost());
        }
    }
    Zones<TypeParam> zones;
    static_cast<void>(zones.add({SphereRegion<TypeParam>({0, 0, 0}, TypeParam(1e30))}));
    static_cast<void>(zones.add({SphereRegion<TypeParam>({0, 0, 0}, this->kInfinity)}));
    static_cast<void>(zones.add({ConvexRegion<TypeParam>({})}));
    zones.update(this->grid);
    this->expectAPass(zones.lastCost(), 3);
    EXPECT_GE(zones.lastCost().hits, 3 * this->kCount);
}

TYPED_TEST(AiBounds, OfSightIsOnePassAndOneForEachTarget) {
    Viewer<TypeParam> viewer;
    viewer.eye = {-10, 10, 10};
    viewer.halfAngle = TypeParam(0.1);
    std::vector<ProxyId> seen;
    const auto fewTargets = [](ProxyId id) { return id.index % 400 == 0; };
    for (const TypeParam range : {TypeParam(1e30), this->kInfinity}) {
        viewer.range = range;
        this->expectAPass(visibleFrom(this->grid, viewer, seen, fewTargets), 11);
    }
    // Nobody has that many neighbours that an agent would be compared with somebody twice.
    RadiusSearch<TypeParam> search;
    search.take(this->grid, this->kInfinity, fewTargets);
    std::vector<std::uint32_t> counts(search.size());
    EXPECT_LE(search.count(counts).boxesTested, 10U * 16);
    EXPECT_EQ(counts, std::vector<std::uint32_t>(10, 9));
}

TYPED_TEST(AiBounds, OfTheNearestIsAFewCellsAndNeverTheGridOverAndOver) {
    Grid<TypeParam> many;
    Random random(0x5eed0913);
    constexpr std::uint64_t kMany = 20000;
    for (std::uint64_t i = 0; i < kMany; ++i) {
        static_cast<void>(many.add(boxAround<TypeParam>(random.pointIn(0, 100), {1, 1, 1})));
    }
    many.update();
    std::vector<KeyedProxy<TypeParam>> nearest;
    for (int i = 0; i < 100; ++i) {
        const auto point = Vector3<TypeParam>(random.pointIn(0, 100).cast<TypeParam>());
        QueryCost cost = findNearest(many, point, 4, this->kInfinity, nearest);
        EXPECT_LT(cost.boxesTested, kMany / 20);
        const auto none = [](ProxyId) { return false; };
        cost = findNearest(many, point, 4, this->kInfinity, nearest, none);
        EXPECT_LT(cost.boxesTested, 4 * kMany);
        const Vector3<TypeParam> away = point * TypeParam(1e12);
        cost = findNearest(many, away, 4, this->kInfinity, nearest);
        EXPECT_LT(cost.boxesTested, 4 * kMany);
        EXPECT_EQ(nearest.size(), 4U);
    }
}

}  // namespace
}  // namespace hashphase::test
