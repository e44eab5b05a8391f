// SPDX-License-Identifier: Zlib

// Everything that agents ask, against a look at everybody, in every scene and on several threads.

#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>

#include <broadphase/cells_region.hpp>
#include <demos/stability/run_together.hpp>
#include <tests/integration/scene_lives.hpp>
#include <tests/support/ai_oracles.hpp>
#include <tests/support/radius_oracle.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

bool isEven(ProxyId id) {
    return id.index % 2 == 0;
}
bool isBlocker(ProxyId id) {
    return id.index % 5 == 0;
}
bool doesCount(ProxyId id) {
    return id.index % 7 != 0;
}

/// Agents of a grid, and the brute force that knows what they must be told. They remember from frame to
/// frame as a program does.
template <class Scalar>
class Agents {
public:
    using Proxies = std::span<const Placed<Scalar>>;
    using Colours = std::vector<std::uint32_t>;

    using Compared = std::map<std::string, std::size_t>;

    /// Adds up how much there was to be compared, where there is a list for it.
    explicit Agents(std::uint64_t seed, Compared* compared = nullptr)
        : random_(seed), threads_(3, seed), compared_(compared != nullptr ? *compared : own_) {
        for (std::uint32_t i = 0; i < 4096; ++i) {
            colours_.push_back(random_.below(9));  // one too many
        }
    }

    /// Expects the same from everything that can be asked in a frame.
    void ask(const Grid<Scalar>& grid, Proxies proxies) {
        ++frame_;
        RegionMaker<Scalar> make(random_, proxies);
        for (int i = 0; i < 5; ++i) {
            askNear(grid, proxies, make);
            askNearest(grid, proxies, make);
        }
        askRadar(grid, proxies, make);
        askSight(grid, proxies);
        changeZones(proxies);
        askZones(grid, proxies);
        askWhichZones(make);
        askColours(grid, proxies);
    }

private:
    Scalar someDistance(RegionMaker<Scalar>& make, const Vector3<Scalar>& from) {
        return (make.point() - from).cwiseAbs().maxCoeff();
    }
    const Placed<Scalar>& anyOf(Proxies proxies) {
        return proxies[random_.below(static_cast<std::uint32_t>(proxies.size()))];
    }

    void askNear(const Grid<Scalar>& grid, Proxies proxies, RegionMaker<Scalar>& make) {
        const Placed<Scalar>& agent = anyOf(proxies);
        const Vector3<Scalar> position = random_.chance(0.5) ? positionOf(agent.box) : make.point();
        const Scalar radius =
            random_.chance(0.1) ? hostileNumber<Scalar>(random_) : someDistance(make, position);
        const ProxyFilter filter = random_.chance(0.5) ? ProxyFilter(acceptAll) : isEven;
        std::vector<ProxyId> found;
        std::vector<ProxyId> expected;
        findWithin(grid, position, radius, found, filter, agent.id);
        findWithinByBruteForce(proxies, position, radius, expected, filter, agent.id);
        ASSERT_EQ(differences(found, expected), "") << position.transpose();
        compared_["near"] += found.size();

        std::vector<ProxyId> estimated;
        estimateWithin(grid, position, radius, estimated, filter, agent.id);
        ASSERT_TRUE(std::ranges::includes(estimated, found));
        const CellsRegion<Scalar> cells(position, radius, grid.cellSize());
        findInByBruteForce(proxies, cells, expected, filter, agent.id);
        ASSERT_EQ(differences(estimated, expected), "") << position.transpose();
    }

    void askNearest(const Grid<Scalar>& grid, Proxies proxies, RegionMaker<Scalar>& make) {
        // Now and then from so far away that all are last.
        const Vector3<Scalar> point = make.point() * Scalar(random_.chance(0.1) ? 1e10 : 1);
        const ProxyId self = anyOf(proxies).id;
        const auto count = static_cast<std::size_t>(random_.chance(0.1) ? 1000 : random_.below(12));
        const Scalar most = random_.chance(0.3)   ? std::numeric_limits<Scalar>::infinity()
                            : random_.chance(0.1) ? hostileNumber<Scalar>(random_)
                                                  : someDistance(make, point);
        const ProxyFilter filter = random_.chance(0.5) ? ProxyFilter(acceptAll) : isEven;
        std::vector<KeyedProxy<Scalar>> nearest;
        std::vector<KeyedProxy<Scalar>> expected;
        findNearest(grid, point, count, most, nearest, filter, self);
        findNearestByBruteForce(proxies, point, count, most, expected, filter, self);
        ASSERT_EQ(nearest, expected) << count << " within " << most << " of " << point.transpose();
        compared_["nearest"] += nearest.size();
        compared_["nearest that are cut off"] += nearest.size() == count ? 1 : 0;
    }

    void askRadar(const Grid<Scalar>& grid, Proxies proxies, RegionMaker<Scalar>& make) {
        RadarWindow<Scalar> window;
        window.center = make.point();
        window.cellSize = random_.chance(0.1) ? hostileNumber<Scalar>(random_)
                                              : someDistance(make, window.center) /
                                                    static_cast<Scalar>(random_.between(1, 9));
        window.columns = random_.below(8);
        window.rows = random_.below(8);
        window.layers = random_.chance(0.5) ? 0 : random_.below(5);
        window.up = static_cast<UpAxis>(random_.below(3));
        if (random_.chance(0.5)) {
            window.heading = random_.chance(0.1) ? hostileNumber<Scalar>(random_)
                                                 : static_cast<Scalar>(random_.between(-7, 7));
        }
        const auto groupOf = [](ProxyId id) { return id.index % 4; };
        const auto counts = radar_.scan(grid, window, 3, groupOf);
        ASSERT_TRUE(
            std::ranges::equal(counts, scanByBruteForce<Scalar>(proxies, window, 3, groupOf)))
            << window.center.transpose() << " by " << window.cellSize << " turned "
            << window.heading.value_or(0) << ", up " << static_cast<int>(window.up);
        compared_["radar"] += std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    }

    /// Looks from a proxy or from anywhere, at somebody or anywhere; some see badly.
    Viewer<Scalar> anyViewer(Proxies proxies) {
        RegionMaker<Scalar> make(random_, proxies);
        const Placed<Scalar>& self = anyOf(proxies);
        Viewer<Scalar> viewer;
        if (random_.chance(0.6)) {
            viewer.self = self.id;
        }
        viewer.eye = random_.chance(0.6) ? positionOf(self.box) : make.point();
        viewer.direction = random_.pointIn(-1, 1).template cast<Scalar>();
        if (random_.chance(0.7)) {
            viewer.direction = make.point() - viewer.eye;
        }
        viewer.range = random_.chance(0.3) ? std::numeric_limits<Scalar>::infinity()
                                           : someDistance(make, viewer.eye);
        viewer.halfAngle = static_cast<Scalar>(random_.between(0, 4));
        if (random_.chance(0.1)) {
            viewer.direction[random_.below(3)] = hostileNumber<Scalar>(random_);
        }
        if (random_.chance(0.1)) {
            (random_.chance(0.5) ? viewer.halfAngle : viewer.range) =
                hostileNumber<Scalar>(random_);
        }
        return viewer;
    }

    void askSight(const Grid<Scalar>& grid, Proxies proxies) {
        const auto isTarget = [](ProxyId id) { return id.index % 4 != 0; };
        const std::vector<Viewer<Scalar>> viewers{anyViewer(proxies), anyViewer(proxies)};
        sight_.look(grid, viewers, isTarget, isBlocker);
        for (std::size_t i = 0; i < viewers.size(); ++i) {
            std::vector<ProxyId> expected;
            visibleFromByBruteForce<Scalar>(proxies, viewers[i], expected, isTarget, isBlocker);
            const std::vector<ProxyId> seen(sight_.seenBy(i).begin(), sight_.seenBy(i).end());
            ASSERT_EQ(differences(seen, expected), "");
            std::vector<ProxyId> alone;
            visibleFrom(grid, viewers[i], alone, isTarget, isBlocker);
            ASSERT_EQ(differences(alone, expected), "");
            compared_["seen"] += seen.size();
            for (const Placed<Scalar>& target :
                 proxies.first(std::min<std::size_t>(10, proxies.size()))) {
                const bool isSeen = canSee(grid, viewers[i], target.id, isBlocker);
                ASSERT_TRUE(!isTarget(target.id) ||
                            isSeen == std::ranges::binary_search(seen, target.id));
                compared_["hidden"] += isSeen ? 0 : 1;
            }
            compared_["in cones"] +=
                expectLikeBruteForce(grid, proxies, SightRegion<Scalar>(viewers[i]));
        }
    }

    /// Of any shape and size, some of them bad.
    Zone<Scalar> anyZone(Proxies proxies) {
        RegionMaker<Scalar> make(random_, proxies);
        Zone<Scalar> zone;
        zone.presence = random_.chance(0.5) ? Presence::position : Presence::box;
        switch (random_.below(3)) {
            case 0:
                zone.shape = make.box();
                break;
            case 1:
                zone.shape = make.sphere();
                if (random_.chance(0.1)) {
                    const Vector3<Scalar> center = make.point();
                    zone.shape = SphereRegion<Scalar>(center, hostileNumber<Scalar>(random_));
                }
                break;
            default:
                zone.shape = make.convex();
        }
        return zone;
    }

    void changeZones(Proxies proxies) {
        while (zoneIds_.size() < 20 || random_.chance(0.3)) {
            const Zone<Scalar> zone = anyZone(proxies);
            zoneIds_.push_back(zones_.add(zone));
            expectedZones_.set(zoneIds_.back(), zone);
        }
        for (std::size_t i = 0; i < zoneIds_.size(); ++i) {
            const ZoneId id = zoneIds_[i];
            if (random_.chance(0.05)) {
                zones_.remove(id);
                expectedZones_.remove(id);
                zoneIds_.erase(zoneIds_.begin() + static_cast<std::ptrdiff_t>(i));
            } else if (random_.chance(0.1)) {
                const Zone<Scalar> zone = anyZone(proxies);
                zones_.set(id, zone);
                expectedZones_.set(id, zone);
            }
        }
    }

    void askZones(const Grid<Scalar>& grid, Proxies proxies) {
        // Some zones do not count everybody, and not always the same.
        const auto filter = [this](ZoneId zone, ProxyId proxy) {
            return zone.index % 2 == 0 || (proxy.index + frame_ / 5) % 3 != 0;
        };
        const ZoneEvents events = frame_ % 2 == 0 ? zones_.update(grid, filter)
                                                  : zones_.update(grid, filter, allZones, threads_);
        const auto wanted = expectedZones_.update(proxies, filter);
        const auto expect = [this](const char* what, std::span<const ZoneEvent> told,
                                   const std::vector<ZoneEvent>& expected) {
            ASSERT_EQ(differences(std::vector<ZoneEvent>(told.begin(), told.end()), expected), "")
                << what;
            compared_[what] += expected.size();
        };
        expect("entered", events.entered, wanted.entered);
        expect("stayed", events.stayed, wanted.stayed);
        expect("left", events.left, wanted.left);
        ASSERT_EQ(zones_.size(), zoneIds_.size());
        for (const ZoneId id : zoneIds_) {
            ASSERT_TRUE(std::ranges::equal(zones_.occupants(id), expectedZones_.occupants(id)));
        }
    }

    void askWhichZones(RegionMaker<Scalar>& make) {
        for (int i = 0; i < 5; ++i) {
            const Vector3<Scalar> point = make.point();
            std::vector<ZoneId> found;
            std::vector<ZoneId> expected;
            for (const auto& [id, zone] : expectedZones_.zones()) {
                if (point.allFinite() && ZonesByBruteForce<Scalar>::isIn(zone, {point, point})) {
                    expected.push_back(id);
                }
            }
            std::sort(expected.begin(), expected.end());
            zones_.zonesAt(point, found);
            ASSERT_EQ(differences(found, expected), "");
            compared_["zones at a point"] += found.size();
        }
    }

    /// RarestColour::update() by looking at every two agents that count.
    Colours rarestByBruteForce(Proxies proxies, Scalar radius, std::uint32_t colourCount) {
        std::vector<Placed<Scalar>> counting;
        std::ranges::copy_if(proxies, std::back_inserter(counting),
                             [](const Placed<Scalar>& proxy) { return doesCount(proxy.id); });
        Colours after = colours_;
        for (const auto& [id, neighbours] : neighboursByBruteForce<Scalar>(counting, radius)) {
            const auto counts = groupCounts(neighbours, colourCount,
                                            [this](ProxyId i) { return colours_[i.index]; });
            const auto rarest = std::min_element(counts.begin(), counts.end());
            after[id.index] = static_cast<std::uint32_t>(rarest - counts.begin());
        }
        return after;
    }

    // All change, or those whom a filter names, or some do as if all had looked.
    void askColours(const Grid<Scalar>& grid, Proxies proxies) {
        const Vector3<Scalar> way = positionOf(proxies[0].box) - positionOf(proxies[1].box);
        const Scalar radius = way.cwiseAbs().maxCoeff() / 2;
        const std::uint32_t most = 1 + random_.below(8);
        const Colours before = colours_;
        const Colours all = rarestByBruteForce(proxies, radius, most);
        Colours expected = all;
        Colours onThreads = colours_;
        if (frame_ % 2 == 0) {
            const ProxyFilter changes = frame_ % 4 == 0 ? ProxyFilter(acceptAll) : isEven;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const bool isKept = !changes(ProxyId{static_cast<std::uint32_t>(i), 1});
                expected[i] = isKept ? before[i] : expected[i];
            }
            rarest_.update(grid, radius, most, colours_, doesCount, changes);
            rarest_.update(grid, radius, most, onThreads, doesCount, changes, threads_);
        } else {
            std::vector<ProxyId> some;
            expected = before;
            for (const Placed<Scalar>& proxy : proxies) {
                if (doesCount(proxy.id) && random_.chance(0.3)) {
                    some.push_back(proxy.id);
                    expected[proxy.id.index] = all[proxy.id.index];
                }
            }
            rarest_.updateSome(grid, radius, most, colours_, some, doesCount);
            rarest_.updateSome(grid, radius, most, onThreads, some, doesCount, threads_);
        }
        ASSERT_EQ(colours_, expected);
        ASSERT_EQ(onThreads, expected);
        compared_["colours"] += colours_ != before ? 1 : 0;
    }

    Random random_;
    ThreadedFor threads_;
    Compared own_;
    Compared& compared_;
    std::uint32_t frame_ = 0;
    Radar<Scalar> radar_;
    Sight<Scalar> sight_;
    Zones<Scalar> zones_;
    ZonesByBruteForce<Scalar> expectedZones_;
    std::vector<ZoneId> zoneIds_;
    RarestColour<Scalar> rarest_;
    Colours colours_;
};

template <class Scalar>
class AgentsInScenes : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(AgentsInScenes, Scalars);

TYPED_TEST(AgentsInScenes, AreToldWhatBruteForceTells) {
    std::map<std::string, std::size_t> compared;
    for (const auto& [cellSize, frames] :
         {std::pair(0.0, 30), std::pair(1e-3, 8), std::pair(1.5, 8), std::pair(1e4, 8)}) {
        GridConfig config;
        config.cellSize = cellSize;
        std::unique_ptr<Agents<TypeParam>> agents;
        playAllScenes<TypeParam>(
            0x5eed0a00, frames,
            [&](const Grid<TypeParam>& grid, Script<TypeParam>& script, int frame) {
                if (frame == 0) {
                    agents = std::make_unique<Agents<TypeParam>>(0x5eed0a01, &compared);
                }
                agents->ask(grid, script.proxies());
            },
            config);
    }
    for (const char* what : {"near", "nearest", "radar", "seen", "hidden", "in cones", "entered",
                             "stayed", "left", "zones at a point"}) {
        EXPECT_GT(compared[what], 10000U) << what;
    }
    EXPECT_GT(compared["nearest that are cut off"], 1000U);
    EXPECT_GT(compared["colours"], 300U);
}

// Right after many changes, so that the first question files them. What goes wrong here is mostly for
// the thread sanitizer to see.
TEST(AgentsOnThreads, AskEverythingAtTheSameTime) {
    const BoxScene<float> scene = spreadScene<float>("evenly spread", 1, 0);
    GridWorld<float> world;
    Script<float> script(scene, 0x5eed0e01);
    script.begin(world);
    std::vector<std::unique_ptr<Agents<float>>> agents;
    for (std::uint64_t i = 0; i < 4; ++i) {
        agents.push_back(std::make_unique<Agents<float>>(i));
    }
    for (int frame = 0; frame < 20; ++frame) {
        demos::runTogether(agents.size(), [&](std::size_t thread) {
            agents[thread]->ask(world.grid, script.proxies());
        });
        ASSERT_FALSE(testing::Test::HasFailure()) << "frame " << frame;
        if (frame % 3 != 1) {
            world.grid.update();
        }
        script.playFrame(world);
    }
}

TYPED_TEST(AgentsInScenes, AreToldTheSameOnAnyNumberOfThreads) {
    const BoxScene<TypeParam> scene = spreadScene<TypeParam>("evenly spread", 1, 0);
    GridWorld<TypeParam> world;
    Script<TypeParam> script(scene, 0x5eed0b05);
    script.begin(world);
    RegionMaker<TypeParam> make(script.random(), script.proxies());
    std::vector<Viewer<TypeParam>> viewers(200);
    for (Viewer<TypeParam>& viewer : viewers) {
        viewer.eye = make.point();
    }
    Sight<TypeParam> alone;
    Sight<TypeParam> together;
    for (const std::size_t count : {200U, 20U, 100U}) {
        const auto some = std::span<const Viewer<TypeParam>>(viewers).first(count);
        const QueryCost cost = alone.look(world.grid, some, acceptAll, isBlocker);
        script.playFrame(world);
        script.playFrame(world);
        ThreadedFor threads(4, 0x5eed0b06);
        const QueryCost filed = together.look(world.grid, some, acceptAll, isBlocker, threads);
        EXPECT_GT(filed.hits, 0U);
        const QueryCost again = alone.look(world.grid, some, acceptAll, isBlocker);
        EXPECT_EQ(filed.boxesTested, again.boxesTested);
        EXPECT_GT(cost.hits, 0U);
        std::size_t seenCount = 0;
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_TRUE(std::ranges::equal(alone.seenBy(i), together.seenBy(i)));
            seenCount += alone.seenBy(i).size();
        }
        EXPECT_GT(seenCount, count);
        world.grid.update();
    }
}

}  // namespace
}  // namespace hashphase::test
