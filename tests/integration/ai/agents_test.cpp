// SPDX-License-Identifier: Zlib

// What agents are told, where that is known without brute force; in lives of all scenes:
// ai_scenes_test.cpp.

#include <broadphase/grid_snapshot.hpp>
#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class AgentsTest : public testing::Test {
protected:
    static constexpr Scalar kNan = std::numeric_limits<Scalar>::quiet_NaN();
    static constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();
    static constexpr Scalar kPi = std::numbers::pi_v<Scalar>;

    ProxyId addPoint(Scalar x, Scalar y, Scalar z) {
        const Vector3<Scalar> point(x, y, z);
        return grid.add({point, point});
    }

    Grid<Scalar> grid;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(AgentsTest, Scalars);

// --- Proximity -----------------------------------------------------------------------------------

TYPED_TEST(AgentsTest, ThatAreEstimatedToBeNearAreAllThatAreAndNoneFartherThanACell) {
    GridConfig config;
    config.cellSize = 1;
    Grid<TypeParam> cells(config);
    Random random(0x5eed0a02);
    for (int i = 0; i < 4000; ++i) {
        const Vector3<double> at = random.pointIn(0, 20);
        static_cast<void>(cells.add(boxAround<TypeParam>(at, {0.25, 0.25, 0.25})));
    }
    std::vector<ProxyId> found;
    std::vector<ProxyId> estimated;
    for (const double radius : {0.25, 1.0, 4.0}) {
        const auto reach = static_cast<TypeParam>(radius);
        for (int i = 0; i < 100; ++i) {
            const Vector3<TypeParam> point = random.pointIn(2, 18).cast<TypeParam>();
            findWithin(cells, point, reach, found);
            estimateWithin(cells, point, reach, estimated);
            ASSERT_TRUE(std::ranges::includes(estimated, found));
            for (const ProxyId id : estimated) {
                const auto away = static_cast<double>(cells.box(id).exteriorDistance(point));
                ASSERT_LE(away, std::sqrt(3.0) * (radius + 1) * 1.00001);
            }
        }
    }
}

TYPED_TEST(AgentsTest, AreEquallyNearWhereSquaresOverflow) {
    const TypeParam far = sizeof(TypeParam) == sizeof(float) ? TypeParam(1e30) : TypeParam(1e200);
    std::vector<ProxyId> ids;
    for (const int times : {3, 1, 2}) {
        ids.push_back(this->addPoint(static_cast<TypeParam>(times) * far, 0, 0));
    }
    // So many others, still farther away, that the search takes its time.
    for (int i = 0; i < 5000; ++i) {
        this->addPoint(0, TypeParam(5) * far, 0);
    }
    this->grid.update();
    const auto isOneOfThree = [](ProxyId id) { return id.index < 3; };
    std::vector<KeyedProxy<TypeParam>> nearest;
    for (const std::size_t count : {1U, 2U, 3U}) {
        for (const bool isLimited : {false, true}) {  // so that the first one is too far away
            const TypeParam most = isLimited ? far * TypeParam(2.5) : this->kInfinity;
            findNearest(this->grid, {0, 0, 0}, count, most, nearest, isOneOfThree);
            ASSERT_EQ(nearest.size(), isLimited ? std::min<std::size_t>(count, 2) : count);
            for (std::size_t i = 0; i < nearest.size(); ++i) {
                EXPECT_EQ(nearest[i].id, ids[i + (isLimited ? 1 : 0)]);
            }
        }
    }
}

// --- Radar ---------------------------------------------------------------------------------------

TYPED_TEST(AgentsTest, AreOnARadarWhichTurnsWithTheHeading) {
    // Ahead along the heading is up in rows; to its side is up in columns.
    constexpr auto kQuarter = static_cast<TypeParam>(std::numbers::pi / 2);
    RadarWindow<TypeParam> window{.center = {100, 0, 200}, .columns = 3, .rows = 3};
    this->addPoint(100, 0, 210);
    using Counts = std::vector<std::uint32_t>;
    Radar<TypeParam> radar;
    const auto scan = [&] {
        const auto counts = radar.scan(this->grid, window, 1, [](ProxyId) { return 0U; });
        return Counts(counts.begin(), counts.end());
    };
    window.heading = TypeParam(0);
    EXPECT_EQ(scan(), (Counts{0, 0, 0, 0, 0, 0, 0, 1, 0})) << "ahead";
    window.heading = kQuarter;  // looks along x
    EXPECT_EQ(scan(), (Counts{0, 0, 0, 1, 0, 0, 0, 0, 0})) << "at its left";
    window.heading = 2 * kQuarter;
    EXPECT_EQ(scan(), (Counts{0, 1, 0, 0, 0, 0, 0, 0, 0})) << "behind";
    window.heading = -kQuarter;
    EXPECT_EQ(scan(), (Counts{0, 0, 0, 0, 0, 1, 0, 0, 0})) << "at its right";
    window.heading = kQuarter / 2;
    EXPECT_EQ(scan(), (Counts{0, 0, 0, 0, 0, 0, 1, 0, 0})) << "ahead, on the left";
}

// --- Sight ---------------------------------------------------------------------------------------

TYPED_TEST(AgentsTest, AreSeenInAConeByTheAngleToItsAxis) {
    // The definition, in higher precision.
    Random random(0x5eed0b03);
    int inside = 0;
    for (int i = 0; i < 20000; ++i) {
        Viewer<TypeParam> viewer;
        viewer.direction = random.pointIn(-1, 1).cast<TypeParam>() *
                           static_cast<TypeParam>(random.logBetween(1e-12, 1e12));
        viewer.halfAngle = static_cast<TypeParam>(random.chance(0.3) ? random.logBetween(1e-4, 1)
                                                                     : random.between(0, 3.1));
        Vector3<TypeParam> point = random.pointIn(-9, 9).cast<TypeParam>();
        if (random.chance(0.5)) {
            const auto aside = static_cast<TypeParam>(random.between(0, 2)) * viewer.halfAngle;
            point = viewer.direction.normalized() + point.normalized() * aside;
        }
        const Vector3<long double> axis = viewer.direction.template cast<long double>();
        const Vector3<long double> offset = point.template cast<long double>();
        const long double angle = std::atan2(axis.cross(offset).norm(), axis.dot(offset));
        const long double slack = 16 * std::numeric_limits<TypeParam>::epsilon();
        const TypeParam key = SightRegion<TypeParam>(viewer).key({point, point});
        if (angle < viewer.halfAngle - slack) {
            ASSERT_GE(key, 0) << static_cast<double>(angle) << ' ' << viewer.halfAngle;
            ++inside;
        }
        if (angle > viewer.halfAngle + slack) {
            ASSERT_EQ(key, -1) << static_cast<double>(angle) << ' ' << viewer.halfAngle;
        }
    }
    EXPECT_GT(inside, 4000);
}

TYPED_TEST(AgentsTest, WhoLookIntoANarrowConeReadFarLessThanItsBall) {
    Viewer<TypeParam> viewer;
    viewer.range = 50;
    const Aabb<TypeParam> ball = SightRegion<TypeParam>(viewer).bounds();
    viewer.halfAngle = TypeParam(0.2);
    const Aabb<TypeParam> cone = SightRegion<TypeParam>(viewer).bounds();
    EXPECT_LT(cone.volume(), ball.volume() / 40);
    EXPECT_TRUE(ball.contains(cone));
}

TYPED_TEST(AgentsTest, WhoLookInNoOrdinaryWaySeeWhatIsDefined) {
    const ProxyId ahead = this->addPoint(10, 0, 0);
    const ProxyId behind = this->addPoint(-10, 0, 0);
    const ProxyId beside = this->addPoint(0, 10, 0);
    const ProxyId here = this->grid.add(makeBox<TypeParam>(0, 0, 0, 0, 0, 0));
    const std::vector<ProxyId> none;
    const auto seenBy = [&](auto change) {
        Viewer<TypeParam> viewer;
        viewer.halfAngle = 1;
        change(viewer);
        std::vector<ProxyId> seen;
        const auto no = [](ProxyId) { return false; };
        visibleFrom(this->grid, viewer, seen, acceptAll, no);
        return seen;
    };
    using V = Viewer<TypeParam>;
    const TypeParam nan = this->kNan;
    const TypeParam infinity = this->kInfinity;
    EXPECT_EQ(seenBy([](V&) {}), (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([](V& v) { v.halfAngle = 0; }), (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([](V& v) { v.halfAngle = TypeParam(1.6); }),
              (std::vector{ahead, beside, here}));
    EXPECT_EQ(seenBy([](V& v) { v.halfAngle = TypeParam(3.14); }),
              (std::vector{ahead, beside, here}));
    EXPECT_EQ(seenBy([&](V& v) { v.halfAngle = this->kPi; }),
              (std::vector{ahead, behind, beside, here}));
    EXPECT_EQ(seenBy([&](V& v) { v.halfAngle = infinity; }).size(), 4U);
    EXPECT_EQ(seenBy([](V& v) { v.halfAngle = -1; }), none);
    EXPECT_EQ(seenBy([&](V& v) { v.halfAngle = nan; }), none);
    EXPECT_EQ(seenBy([](V& v) { v.direction.setZero(); }), none);
    EXPECT_EQ(seenBy([&](V& v) { v.direction[1] = nan; }), none);
    EXPECT_EQ(seenBy([&](V& v) { v.direction[0] = infinity; }), none);
    EXPECT_EQ(seenBy([&](V& v) {
                  v.direction.setZero();
                  v.halfAngle = 4;
              }).size(),
              4U);
    EXPECT_EQ(seenBy([&](V& v) {
                  v.direction[1] = nan;
                  v.halfAngle = this->kPi;
              }).size(),
              4U);
    EXPECT_EQ(seenBy([](V& v) { v.direction *= TypeParam(1e-30); }), (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([](V& v) { v.direction *= std::numeric_limits<TypeParam>::max(); }),
              (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([](V& v) { v.range = 10; }), (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([](V& v) { v.range = 9; }), std::vector{here});
    EXPECT_EQ(seenBy([](V& v) { v.range = 0; }), std::vector{here});
    EXPECT_EQ(seenBy([](V& v) { v.range = -1; }), none);
    EXPECT_EQ(seenBy([&](V& v) { v.range = nan; }), none);
    EXPECT_EQ(seenBy([](V& v) { v.range = TypeParam(1e30); }), (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([&](V& v) { v.eye[0] = nan; }), none);
    EXPECT_EQ(seenBy([&](V& v) { v.eye[0] = infinity; }), none);
    EXPECT_EQ(seenBy([](V& v) { v.eye[0] = TypeParam(-1e30); }).size(), 4U);
    EXPECT_FALSE(hasLineOfSight(this->grid, {nan, 0, 0}, {0, 0, 0}));
    EXPECT_FALSE(hasLineOfSight(this->grid, {0, 0, 0}, {infinity, 0, 0}));
    EXPECT_FALSE(canSee(this->grid, V{}, ProxyId{}));
}

// --- Zones ---------------------------------------------------------------------------------------

TYPED_TEST(AgentsTest, EnterZonesOfAnotherGridOnceTheseForget) {
    using Point = Vector3<TypeParam>;
    Zones<TypeParam> zones;
    const Zone<TypeParam> here{SphereRegion<TypeParam>(Point::Zero(), 5)};
    const ZoneId kept = zones.add(here);
    const ZoneId removed = zones.add(here);
    for (int round = 0; round < 2; ++round) {
        Grid<TypeParam> other;
        const ProxyId id = other.add({Point(0, 0, 0), Point(1, 1, 1)});
        const ZoneEvents events = zones.update(other);
        ASSERT_EQ(events.entered.size(), round == 0 ? 2U : 1U);
        EXPECT_EQ(events.entered[0], (ZoneEvent{kept, id}));
        EXPECT_TRUE(events.stayed.empty() && events.left.empty());
        if (round == 0) {
            zones.remove(removed);
        }
        zones.forgetOccupants();
        EXPECT_TRUE(zones.occupants(kept).empty());
    }
}

/// Proxies and zones that come, move and go as the number of the frame says.
template <class Scalar>
struct ZonedFrames {
    using Events = std::vector<ZoneEvent>;

    /// All that the frame tells, one list behind the other.
    Events play(std::uint64_t frame) {
        Random random(frame);
        for (ProxyId& id : proxies) {
            const auto box = boxAround<Scalar>(random.pointIn(0, 10), {0.5, 0.5, 0.5});
            if (id.isNull()) {
                id = grid.add(box);
            } else if (random.chance(0.1)) {
                grid.remove(std::exchange(id, {}));
            } else if (random.chance(0.4)) {
                grid.move(id, box);
            }
        }
        for (ZoneId& id : watched) {
            const Zone<Scalar> zone{
                SphereRegion<Scalar>(random.pointIn(0, 10).template cast<Scalar>(), 3)};
            if (id.isNull()) {
                id = zones.add(zone);
            } else if (random.chance(0.1)) {
                zones.remove(std::exchange(id, {}));
            } else if (random.chance(0.3)) {
                zones.set(id, zone);
            }
        }
        const auto isDue = [&](ZoneId) { return random.chance(0.8); };
        const ZoneEvents told = zones.update(grid, acceptAllInZones, isDue);
        Events all;
        for (const auto& list : {told.entered, told.stayed, told.left}) {
            all.insert(all.end(), list.begin(), list.end());
            all.emplace_back();
        }
        return all;
    }

    Grid<Scalar> grid;
    std::vector<ProxyId> proxies = std::vector<ProxyId>(60);
    std::vector<ZoneId> watched = std::vector<ZoneId>(5);
    Zones<Scalar> zones;
};

TYPED_TEST(AgentsTest, EnterStayInAndLeaveZonesAsBeforeWhereACopyOfTheZonesIsPutBack) {
    ZonedFrames<TypeParam> frames;
    for (std::uint64_t frame = 0; frame < 20; ++frame) {
        frames.play(frame);
    }
    GridSnapshot<TypeParam> snapshot;
    snapshot.save(frames.grid);
    const std::vector<ProxyId> proxies = frames.proxies;
    const std::vector<ZoneId> watched = frames.watched;
    const Zones<TypeParam> zones = frames.zones;
    std::vector<std::vector<ZoneEvent>> told;
    for (std::uint64_t frame = 20; frame < 40; ++frame) {
        told.push_back(frames.play(frame));
    }
    ASSERT_GT(told.front().size(), 10U);
    for (int round = 0; round < 3; ++round) {
        snapshot.restore(frames.grid);
        frames.proxies = proxies;
        frames.watched = watched;
        frames.zones = zones;
        for (std::uint64_t frame = 20; frame < 40; ++frame) {
            ASSERT_EQ(frames.play(frame), told[frame - 20]) << "frame " << frame;
        }
        frames.play(1000);
    }
}

TYPED_TEST(AgentsTest, StayInTheSpanOfTheirZoneWhileZonesAreAdded) {
    for (int i = 0; i < 20; ++i) {
        this->addPoint(static_cast<TypeParam>(i), 0, 0);
    }
    Zones<TypeParam> zones;
    const ZoneId id = zones.add({SphereRegion<TypeParam>({0, 0, 0}, TypeParam(9.5))});
    zones.update(this->grid);
    const std::span<const ProxyId> occupants = zones.occupants(id);
    ASSERT_EQ(occupants.size(), 10U);
    const std::vector<ProxyId> expected(occupants.begin(), occupants.end());
    for (int i = 0; i < 100; ++i) {
        static_cast<void>(zones.add({SphereRegion<TypeParam>({0, 0, 0}, 1)}));
        ASSERT_EQ(zones.occupants(id).data(), occupants.data()) << i << " zones more";
    }
    EXPECT_TRUE(std::equal(occupants.begin(), occupants.end(), expected.begin(), expected.end()));
}

}  // namespace
}  // namespace hashphase::test
