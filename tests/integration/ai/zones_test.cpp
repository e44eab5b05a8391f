// SPDX-License-Identifier: Zlib

// Who enters, stays in and leaves zones.

#include <integration/ai/zones.hpp>
#include <tests/support/ai_oracles.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/script.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

using Events = std::vector<ZoneEvent>;

template <class Scalar>
class ZonesTest : public testing::Test {
protected:
    using Plane = Eigen::Hyperplane<Scalar, 3>;

    /// Of any shape and size, some of them bad.
    static Zone<Scalar> anyZone(Random& random, std::span<const Placed<Scalar>> proxies) {
        RegionMaker<Scalar> make(random, proxies);
        Zone<Scalar> zone;
        zone.presence = random.chance(0.5) ? Presence::position : Presence::box;
        switch (random.below(3)) {
            case 0:
                zone.shape = make.box();
                break;
            case 1:
                zone.shape = random.chance(0.1)
                                 ? SphereRegion<Scalar>(make.point(), hostileNumber<Scalar>(random))
                                 : make.sphere();
                break;
            default:
                std::array<Plane, 4> planes;
                for (Plane& plane : planes) {
                    const Vector3<Scalar> normal = random.pointIn(-1, 1).template cast<Scalar>();
                    plane = Plane(normal, make.point());
                }
                zone.shape = ConvexRegion<Scalar>(
                    planes, random.chance(0.3) ? Containment::inside : Containment::touching);
        }
        return zone;
    }

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

TYPED_TEST(ZonesTest, TellWhatBruteForceTellsInEveryScene) {
    std::array<std::size_t, 3> told{};
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        SCOPED_TRACE(scene.name);
        GridWorld<TypeParam> world;
        ScriptRates rates;
        rates.recolour = 0.02;
        Script<TypeParam> script(scene, 0x5eed0c01, rates);
        script.begin(world);
        Random& random = script.random();
        Zones<TypeParam> zones;
        ZonesByBruteForce<TypeParam> expected;
        std::vector<ZoneId> ids;
        ThreadedFor threads(3, 0x5eed0c02);
        // Some zones do not count who paired with their own kind.
        std::vector<bool> isOdd;
        const auto filter = [&](ZoneId zone, ProxyId proxy) {
            return zone.index % 2 == 0 || !isOdd[proxy.index];
        };
        for (int frame = 0; frame < 60; ++frame) {
            SCOPED_TRACE(testing::Message() << "frame " << frame);
            isOdd.assign(5 * scene.count, false);
            for (const Placed<TypeParam>& proxy : script.proxies()) {
                isOdd[proxy.id.index] = proxy.colour % 2 == 1;
            }
            while (ids.size() < 20 || random.chance(0.3)) {
                const Zone<TypeParam> zone = this->anyZone(random, script.proxies());
                ids.push_back(zones.add(zone));
                expected.set(ids.back(), zone);
            }
            for (std::size_t i = 0; i < ids.size(); ++i) {
                if (random.chance(0.05)) {
                    zones.remove(ids[i]);
                    expected.remove(ids[i]);
                    ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(i));
                } else if (random.chance(0.1)) {
                    const Zone<TypeParam> zone = this->anyZone(random, script.proxies());
                    zones.set(ids[i], zone);
                    expected.set(ids[i], zone);
                }
            }
            const ZoneEvents events = frame % 2 == 0
                                          ? zones.update(world.grid, filter)
                                          : zones.update(world.grid, filter, allZones, threads);
            const auto wanted = expected.update(script.proxies(), filter);
            ASSERT_EQ(differences(this->list(events.entered), wanted.entered), "");
            ASSERT_EQ(differences(this->list(events.stayed), wanted.stayed), "");
            ASSERT_EQ(differences(this->list(events.left), wanted.left), "");
            told[0] += wanted.entered.size();
            told[1] += wanted.stayed.size();
            told[2] += wanted.left.size();
            ASSERT_EQ(zones.size(), ids.size());
            for (const ZoneId id : ids) {
                const auto occupants = zones.occupants(id);
                ASSERT_TRUE(std::ranges::equal(occupants, expected.occupants(id)));
            }
            if (frame % 3 != 1) {
                world.grid.update();
            }
            script.playFrame(world);
        }
        EXPECT_GT(threads.mostRanges(), 1U);
    }
    EXPECT_GT(told[0], 20000U);
    EXPECT_GT(told[1], 20000U);
    EXPECT_GT(told[2], 20000U);
}

TYPED_TEST(ZonesTest, AtAPointAreThoseThatContainIt) {
    std::size_t foundCount = 0;
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        SCOPED_TRACE(scene.name);
        GridWorld<TypeParam> world;
        Script<TypeParam> script(scene, 0x5eed0c03);
        script.begin(world);
        Zones<TypeParam> zones;
        std::vector<std::pair<ZoneId, Zone<TypeParam>>> all;
        for (int i = 0; i < 40; ++i) {
            const auto zone = this->anyZone(script.random(), script.proxies());
            all.emplace_back(zones.add(zone), zone);
        }
        zones.remove(all[7].first);
        all.erase(all.begin() + 7);
        std::vector<ZoneId> found;
        for (int i = 0; i < 200; ++i) {
            const auto point = RegionMaker<TypeParam>(script.random(), script.proxies()).point();
            std::vector<ZoneId> expected;
            for (const auto& [id, zone] : all) {
                if (point.allFinite() && ZonesByBruteForce<TypeParam>::isIn(zone, {point, point})) {
                    expected.push_back(id);
                }
            }
            zones.zonesAt(point, found);
            ASSERT_EQ(differences(found, expected), "");
            foundCount += found.size();
        }
    }
    EXPECT_GT(foundCount, 5000U);
}

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

TEST(ZonesMisuse, OfWhatWasRemovedChangesNobodyWithoutAssertions) {
    const CaughtAsserts caught;
    Zones<float> zones;
    const ZoneId first = zones.add({SphereRegion<float>({0, 0, 0}, 1)});
    const ZoneId removed = zones.add({SphereRegion<float>({5, 0, 0}, 1)});
    zones.remove(removed);
    for (const ZoneId id : {removed, ZoneId{}, ZoneId{99, 1}}) {
        zones.set(id, {SphereRegion<float>({9, 0, 0}, 1)});
        zones.remove(id);
        EXPECT_TRUE(zones.occupants(id).empty());
        static_cast<void>(zones.zone(id));
    }
    std::vector<ZoneId> found;
    zones.zonesAt({0, 0, 0}, found);
    EXPECT_EQ(found, std::vector{first});
    EXPECT_GE(caught.count(), HASHPHASE_ENABLE_ASSERTS ? 9 : 0);
}

#if HASHPHASE_ENABLE_ASSERTS
TEST(ZonesDeathTest, OnlyAZoneThatWasNotRemovedCanBeUsed) {
    const ThrowingAsserts throwing;
    Zones<float> zones;
    const ZoneId id = zones.add({});
    zones.remove(id);
    EXPECT_THROW(zones.set(id, {}), BrokenAssert);
    EXPECT_THROW(zones.remove(id), BrokenAssert);
    EXPECT_THROW(static_cast<void>(zones.zone(id)), BrokenAssert);
    EXPECT_THROW(static_cast<void>(zones.occupants(ZoneId{})), BrokenAssert);
}
#endif

}  // namespace
}  // namespace hashphase::test
