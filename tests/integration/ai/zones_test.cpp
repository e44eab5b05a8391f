// SPDX-License-Identifier: Zlib

// Who enters, stays in and leaves zones; in lives of all scenes: ai_scenes_test.cpp.

#include <integration/ai/zones.hpp>
#include <tests/support/ai_oracles.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

using Events = std::vector<ZoneEvent>;

template <class Scalar>
class ZonesTest : public testing::Test {
protected:
    static Events list(std::span<const ZoneEvent> events) { return {events.begin(), events.end()}; }

    static Zone<Scalar> ball(Scalar x, Scalar radius, Presence presence = Presence::position) {
        return {SphereRegion<Scalar>({x, 0, 0}, radius), presence};
    }
    static Zone<Scalar> box(Scalar low, Scalar high, Presence presence = Presence::position) {
        return {
            BoxRegion<Scalar>{{Vector3<Scalar>::Constant(low), Vector3<Scalar>::Constant(high)}},
            presence};
    }
    static Aabb<Scalar> bodyAt(Scalar x) {
        return {Vector3<Scalar>(x - 1, -1, -1), Vector3<Scalar>(x + 1, 1, 1)};
    }

private:
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(ZonesTest, Scalars);

TYPED_TEST(ZonesTest, TellOfEachProxyOnceAFrame) {
    Grid<TypeParam> grid;
    Zones<TypeParam> zones;
    const ZoneId zone = zones.add(this->ball(0, 5));
    const ProxyId body = grid.add(this->bodyAt(9));
    const Events happened{{zone, body}};
    const auto expect = [&](const Events& entered, const Events& stayed, const Events& left) {
        const ZoneEvents events = zones.update(grid);
        EXPECT_EQ(this->list(events.entered), entered);
        EXPECT_EQ(this->list(events.stayed), stayed);
        EXPECT_EQ(this->list(events.left), left);
    };
    expect({}, {}, {});
    grid.move(body, this->bodyAt(5));
    expect(happened, {}, {});  // on the border
    expect({}, happened, {});
    grid.move(body, this->bodyAt(-4));
    expect({}, happened, {});
    grid.move(body, this->bodyAt(6));
    grid.move(body, this->bodyAt(4));
    expect({}, happened, {});  // out and in between two updates
    grid.move(body, this->bodyAt(TypeParam(5.5)));
    expect({}, {}, happened);  // its box still touches
    zones.set(zone, this->ball(0, 5, Presence::box));
    expect(happened, {}, {});
    zones.set(zone, this->ball(-5, 5, Presence::box));
    expect({}, {}, happened);
    expect({}, {}, {});
}

TYPED_TEST(ZonesTest, TellProxiesApartThatHaveTheSameIndexOneAfterTheOther) {
    Grid<TypeParam> grid;
    Zones<TypeParam> zones;
    const ZoneId zone = zones.add(this->box(-9, 9));
    const ProxyId first = grid.add(this->bodyAt(0));
    zones.update(grid);
    grid.remove(first);
    grid.update();
    const ProxyId second = grid.add(this->bodyAt(0));
    ASSERT_EQ(first.index, second.index);
    const ZoneEvents events = zones.update(grid);
    EXPECT_EQ(this->list(events.entered), (Events{{zone, second}}));
    EXPECT_TRUE(events.stayed.empty());
    EXPECT_EQ(this->list(events.left), (Events{{zone, first}}));
}

TYPED_TEST(ZonesTest, ThatAreRemovedAreLeftByAll) {
    Grid<TypeParam> grid;
    Zones<TypeParam> zones;
    const ProxyId body = grid.add(this->bodyAt(0));
    const ZoneId old = zones.add(this->box(-9, 9));
    const ZoneId other = zones.add(this->box(-9, 9));
    zones.update(grid);
    zones.remove(old);
    zones.remove(other);
    EXPECT_EQ(zones.size(), 0U);
    const ZoneId young = zones.add(this->ball(0, 1));
    EXPECT_FALSE(zones.contains(old));
    EXPECT_TRUE(zones.contains(young));
    ZoneEvents events = zones.update(grid);
    EXPECT_EQ(this->list(events.entered), (Events{{young, body}}));
    EXPECT_EQ(this->list(events.left), (Events{{old, body}, {other, body}}));
    events = zones.update(grid);
    EXPECT_TRUE(events.left.empty());
    EXPECT_EQ(this->list(events.stayed), (Events{{young, body}}));
}

TYPED_TEST(ZonesTest, GoOnWithAnotherGridOnceTheyForget) {
    using Point = Vector3<TypeParam>;
    Zones<TypeParam> zones;
    const Zone<TypeParam> here{SphereRegion<TypeParam>(Point::Zero(), 5)};
    const ZoneId kept = zones.add(here);
    const ZoneId removed = zones.add(here);
    for (int round = 0; round < 2; ++round) {
        Grid<TypeParam> grid;
        const ProxyId id = grid.add({Point(0, 0, 0), Point(1, 1, 1)});
        const ZoneEvents events = zones.update(grid);
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

TYPED_TEST(ZonesTest, WithBadShapesHoldNobody) {
    Grid<TypeParam> grid;
    Zones<TypeParam> zones;
    using Limits = std::numeric_limits<TypeParam>;
    const TypeParam nan = Limits::quiet_NaN();
    for (const Presence presence : {Presence::position, Presence::box}) {
        static_cast<void>(zones.add({}));
        static_cast<void>(zones.add(this->ball(0, -1, presence)));
        static_cast<void>(zones.add(this->ball(0, nan, presence)));
        static_cast<void>(zones.add(this->ball(nan, 9, presence)));
        static_cast<void>(zones.add(this->box(9, -9, presence)));
        static_cast<void>(zones.add(this->box(nan, 9, presence)));
    }
    const ProxyId body = grid.add(this->bodyAt(0));
    static_cast<void>(grid.add(this->bodyAt(nan)));
    EXPECT_TRUE(zones.update(grid).entered.empty());
    std::vector<ZoneId> found;
    zones.zonesAt(Vector3<TypeParam>::Zero(), found);
    EXPECT_TRUE(found.empty());

    const ZoneId huge = zones.add(this->ball(0, TypeParam(1e30)));
    const ZoneId endless = zones.add(this->ball(0, Limits::infinity()));
    const ZoneId all = zones.add({ConvexRegion<TypeParam>({}), Presence::position});
    const ZoneId point = zones.add(this->ball(0, 0));
    EXPECT_EQ(this->list(zones.update(grid).entered),
              (Events{{huge, body}, {endless, body}, {all, body}, {point, body}}));
    zones.zonesAt({nan, 0, 0}, found);
    EXPECT_TRUE(found.empty());
    zones.zonesAt({Limits::infinity(), 0, 0}, found);
    EXPECT_TRUE(found.empty());
    zones.zonesAt({1, 0, 0}, found);
    EXPECT_EQ(found, (std::vector{huge, endless, all}));
}

}  // namespace
}  // namespace hashphase::test
