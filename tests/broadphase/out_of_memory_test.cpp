// SPDX-License-Identifier: Zlib

// Memory runs out at every allocation of every operation that makes one, and then is there again.

#include <broadphase/neighbours.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/radius_search.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>

namespace hashphase::test {
namespace {

using Box = Aabb<float>;
using Point = Vector3<float>;

constexpr std::uint32_t kColours = 3;  // of which those above 0 refuse each other

/// Grid, sweeps and pairs, and what they must be like.
struct World {
    explicit World(std::uint32_t count) { addSome(count); }

    void addSome(std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) {
            add(i % 3 == 0 ? Mobility::resting : Mobility::mobile);
        }
    }
    void add(Mobility mobility) {
        const Box box = draw();
        const ProxyId id = grid.add(box, mobility);
        proxies.push_back({id, box, static_cast<std::uint32_t>(proxies.size()) % kColours});
        colours.resize(std::max<std::size_t>(colours.size(), id.index + 1), 0);
        colours[id.index] = proxies.back().colour;
    }
    void moveSome(std::uint32_t step) {
        for (std::size_t i = 0; i < proxies.size(); i += step) {
            proxies[i].box = draw();
            grid.move(proxies[i].id, proxies[i].box);
        }
    }
    void removeSome(std::uint32_t step) {
        for (std::size_t i = 0; i < proxies.size(); i += step) {
            grid.remove(proxies[i].id);
            proxies[i] = proxies.back();
            proxies.pop_back();
        }
    }
    void sweepSome(std::uint32_t step) {
        for (std::size_t i = 0; i < proxies.size(); i += step) {
            const Point way = random.pointIn(-30, 30).cast<float>();
            sweeps.set(proxies[i].id, way);
            ways[proxies[i].id] = way;
        }
    }
    Box draw() { return scene.draw(random); }

    [[nodiscard]] auto filter() const {
        return [this](ProxyId a, ProxyId b) {
            return coloursPair(colours[a.index], colours[b.index]);
        };
    }
    void update() {
        const PairChanges changes = pairs.update(filter());
        for (const ProxyPair& pair : changes.died) {
            EXPECT_EQ(set.erase(pair), 1U) << "dies but was no pair";
        }
        for (const ProxyPair& pair : changes.born) {
            EXPECT_TRUE(set.insert(pair).second) << "is born but was a pair";
        }
    }

    [[nodiscard]] std::span<const Placed<float>> placed() const { return proxies; }

    void checkQueries() {
        EXPECT_EQ(grid.validate(), "");
        EXPECT_EQ(sweeps.validate(), "");
        EXPECT_EQ(grid.size(), proxies.size());
        if (!proxies.empty()) {
            RegionMaker<float> regions(random, placed());
            expectLikeBruteForce(grid, placed(), regions.box());
            expectLikeBruteForce(grid, placed(), regions.ray());
        }
    }
    void checkPairs() {
        const auto moving = [this](const Placed<float>& proxy) {
            const auto way = ways.find(proxy.id);
            return MovingBox<float>{proxy.box,
                                    way != ways.end() ? way->second : Point(Point::Zero())};
        };
        const std::vector<ProxyPair> expected =
            pairsByBruteForce(placed(), [&](const Placed<float>& a, const Placed<float>& b) {
                return overlaps(a.box, b.box) ||
                       (!ways.empty() && firstContact(moving(a), moving(b)).has_value());
            });
        EXPECT_EQ(differences(std::vector(set.begin(), set.end()), expected), "");
        EXPECT_EQ(pairs.validate(), "");
        EXPECT_EQ(pairs.count(), expected.size());
    }

    Random random{5};
    BoxScene<float> scene = spreadScene<float>("spread", 1, 0);
    std::vector<Placed<float>> proxies;
    std::vector<std::uint32_t> colours;
    std::map<ProxyId, Point> ways;
    std::set<ProxyPair> set;
    Grid<float> grid;
    Sweeps<float> sweeps{grid};
    Pairs<float> pairs{grid, &sweeps};
};

/// Which has seen frames enough for most to rest, and then some changes.
std::unique_ptr<World> longRun() {
    auto world = std::make_unique<World>(45);
    for (int frame = 0; frame < 10; ++frame) {
        world->moveSome(9);
        world->update();
    }
    world->addSome(45);
    world->moveSome(2);
    world->removeSome(7);
    return world;
}

class OutOfMemory : public testing::Test {
protected:
    void SetUp() override {
        if (!kCountsAllocations) {
            GTEST_SKIP() << "this program has another `new`";
        }
    }
};

/// After a failure or none the world goes on as if there had been none.
void checkPairsGoOn(World& world, std::size_t n) {
    world.checkQueries();
    if (n % 2 == 1) {  // what changes meanwhile comes in addition
        world.moveSome(5);
        world.removeSome(11);
        world.addSome(3);
    }
    for (int frame = 0; frame < 2; ++frame) {
        world.update();
        world.checkPairs();
        world.moveSome(13);
    }
    world.checkQueries();
}

void failUpdateOf(const std::function<std::unique_ptr<World>()>& make, std::size_t fewest) {
    const std::size_t failures = runOutOfMemory(
        make,
        [](World& world) {
            // What it tells is not told again.
            const PairChanges changes = world.pairs.update(world.filter());
            const WorkingAllocations lifted;
            for (const ProxyPair& pair : changes.died) {
                world.set.erase(pair);
            }
            world.set.insert(changes.born.begin(), changes.born.end());
        },
        checkPairsGoOn);
    EXPECT_GE(failures, fewest);
}

TEST_F(OutOfMemory, TheFirstUpdateOfPairsIsRepeated) {
    failUpdateOf([] { return std::make_unique<World>(70); }, 40);
}

TEST_F(OutOfMemory, AnUpdateOfPairsIsRepeatedThoughManyRest) {
    failUpdateOf(longRun, 20);
}

TEST_F(OutOfMemory, AnUpdateOfPairsIsRepeatedThoughSomeSweep) {
    failUpdateOf(
        [] {
            auto world = longRun();
            world->sweepSome(4);
            return world;
        },
        40);
}

TEST_F(OutOfMemory, AnUpdateInWhichManyComeToRestIsRepeated) {
    failUpdateOf(
        [] {
            auto world = std::make_unique<World>(90);
            for (int frame = 0; frame < 9; ++frame) {
                world->update();
                world->moveSome(50);
            }
            return world;
        },
        3);
}

TEST_F(OutOfMemory, AnnouncingAndFilteringAgainHaveHappenedOrNot) {
    for (const bool isRefiltered : {false, true}) {
        const std::size_t failures = runOutOfMemory(
            [] {
                auto world = longRun();
                world->update();
                world->moveSome(3);
                return world;
            },
            [=](World& world) {
                const ProxyId id = world.proxies[0].id;
                const PairChanges changes = isRefiltered
                                                ? world.pairs.refilter(id, world.filter())
                                                : world.pairs.findPairsNow(id, world.filter());
                const WorkingAllocations lifted;
                world.set.insert(changes.born.begin(), changes.born.end());
            },
            checkPairsGoOn);
        EXPECT_GE(failures, 1U);
    }
}

TEST_F(OutOfMemory, AddingHasHappenedOrNotAndMovingAndRemovingAllocateNothing) {
    const std::size_t failures = runOutOfMemory(
        [] { return std::make_unique<World>(0); },
        [](World& world) {
            for (int i = 0; i < 200; ++i) {
                const Box box = boxAround<float>(Vector3<double>::Constant(i), {1, 1, 1});
                const ProxyId id = world.grid.add(box);
                const WorkingAllocations lifted;
                world.proxies.push_back({id, box, 0});
            }
        },
        [](World& world, std::size_t) {
            world.colours.assign(1000, 0);
            world.checkQueries();
            world.update();
            {
                const FailingAllocations failing(0);
                for (Placed<float>& proxy : world.proxies) {
                    proxy.box.translate(Point(0.5F, 0, 0));
                    world.grid.move(proxy.id, proxy.box);
                }
                world.removeSome(2);
            }
            world.checkQueries();
            world.update();
            world.checkPairs();
        });
    EXPECT_GE(failures, 10U);
}

TEST_F(OutOfMemory, AQueryThatFilesOrGrowsATreeIsRepeated) {
    for (const bool isRay : {false, true}) {
        const std::size_t failures = runOutOfMemory(
            [] { return std::make_unique<World>(200); },
            [=](World& world) {
                for (int i = 0; i < 8; ++i) {  // of which one files
                    CollectCount count;
                    if (isRay) {
                        world.grid.visit(RayRegion<float>({-9, 0, 0}, {9, 1, 1}), count);
                    } else {
                        world.grid.visit(BoxRegion<float>{boxAround<float>({0, 0, 0}, {3, 3, 3})},
                                         count);
                    }
                }
            },
            checkPairsGoOn);
        EXPECT_GE(failures, isRay ? 30U : 20U);
    }
}

TEST_F(OutOfMemory, AnUpdateOfAGridAloneIsRepeated) {
    struct Alone {
        Grid<float> grid;
        std::vector<Placed<float>> proxies;
        Random random{7};
    };
    const std::size_t failures = runOutOfMemory(
        [] {
            auto world = std::make_unique<Alone>();
            const BoxScene<float> scene = spreadScene<float>("spread", 1, 0);
            for (int i = 0; i < 300; ++i) {
                const Box box = scene.draw(world->random);
                const auto mobility = i % 2 == 0 ? Mobility::mobile : Mobility::resting;
                world->proxies.push_back({world->grid.add(box, mobility), box, 0});
                if (i == 150) {
                    world->grid.update();
                }
            }
            return world;
        },
        [](Alone& world) { world.grid.update(); },
        [](Alone& world, std::size_t n) {
            for (int frame = 0; frame < 2; ++frame) {
                EXPECT_EQ(world.grid.validate(), "");
                RegionMaker<float> regions(world.random,
                                           std::span<const Placed<float>>(world.proxies));
                expectLikeBruteForce<float>(world.grid, world.proxies, regions.box());
                expectLikeBruteForce<float>(world.grid, world.proxies, regions.ray());
                world.grid.move(world.proxies[n % 300].id, world.proxies[0].box);
                world.proxies[n % 300].box = world.proxies[0].box;
                world.grid.update();
            }
        });
    EXPECT_GE(failures, 20U);
}

// Where what is rounded cannot be filed anew, the shift has happened all the same.
TEST_F(OutOfMemory, AShiftOfTheOriginHasHappenedOrNot) {
    const Point shift(1000.1F, -300.3F, 0.7F);
    for (std::size_t n = 0; n < 12; ++n) {
        SCOPED_TRACE("after " + std::to_string(n / 2) + " allocations");
        const std::unique_ptr<World> world = longRun();
        if (n % 2 == 0) {
            world->update();
        }
        bool hasHappened = true;
        try {
            const FailingAllocations failing(n / 2);
            world->grid.shiftOrigin(shift);
        } catch (const std::bad_alloc&) {
            hasHappened = false;
        }
        EXPECT_EQ(hasHappened, n >= 2) << "only room for the boxes of the last update is needed";
        for (Placed<float>& proxy : world->proxies) {
            const Point by = hasHappened ? shift : Point(Point::Zero());
            proxy.box = Box(proxy.box.min() - by, proxy.box.max() - by);
            EXPECT_EQ(world->grid.box(proxy.id).min(), proxy.box.min());
            EXPECT_EQ(world->grid.box(proxy.id).max(), proxy.box.max());
        }
        if (n % 3 == 0) {
            EXPECT_EQ(world->pairs.refilter(world->proxies[0].id, world->filter()).died.size(), 0U);
        }
        checkPairsGoOn(*world, n / 4);
    }
}

TEST_F(OutOfMemory, SettingASweepHasHappenedOrNot) {
    const std::size_t failures =
        runOutOfMemory([] { return std::make_unique<World>(40); },
                       [](World& world) {
                           for (const Placed<float>& proxy : world.proxies) {
                               world.sweeps.set(proxy.id, {9, 0, 0});
                           }
                       },
                       [](World& world, std::size_t) {
                           for (const Placed<float>& proxy : world.proxies) {
                               const Point way = world.sweeps.motion(proxy.id).displacement;
                               if (!way.isZero(0)) {
                                   world.ways[proxy.id] = way;
                               }
                           }
                           checkPairsGoOn(world, 0);
                       });
    EXPECT_GE(failures, 1U);
}

TEST_F(OutOfMemory, VisitingEachTellsEveryRegionWhatItFindsWhenRepeated) {
    struct Asked {
        World world{300};
        std::vector<BoxRegion<float>> regions;
        std::vector<CollectCount> counts;
    };
    const auto ask = [](Asked& asked) {
        asked.counts.assign(asked.regions.size(), {});
        asked.world.grid.visitEach(std::span<const BoxRegion<float>>(asked.regions),
                                   std::span(asked.counts));
    };
    const std::size_t failures = runOutOfMemory(
        [] {
            auto asked = std::make_unique<Asked>();
            for (int i = 0; i < 40; ++i) {
                asked->regions.push_back({boxAround<float>({0, 0, 0}, {9, 9, 9})});
            }
            return asked;
        },
        ask,
        [&](Asked& asked, std::size_t) {
            ask(asked);
            for (std::size_t i = 0; i < asked.regions.size(); ++i) {
                CollectCount expected;
                visitByBruteForce(asked.world.placed(), asked.regions[i], expected);
                EXPECT_EQ(asked.counts[i].count(), expected.count());
            }
        });
    EXPECT_GE(failures, 20U);
}

TEST_F(OutOfMemory, NeighboursAndCrowdsAreFoundWhenAskedAgain) {
    struct Asked {
        World world{200};
        Neighbours<float> neighbours;
        RadiusSearch<float> search;
        std::vector<std::uint32_t> counts = std::vector<std::uint32_t>(200);
        std::size_t pairCount = 0;

        void ask() {
            pairCount = neighbours.find(world.grid, 1).size();
            search.take(world.grid, 2);
            search.count(counts);
        }
    };
    Asked whole;
    whole.ask();
    const std::size_t failures =
        runOutOfMemory([] { return std::make_unique<Asked>(); }, [](Asked& asked) { asked.ask(); },
                       [&](Asked& asked, std::size_t) {
                           EXPECT_TRUE(asked.search.size() == 0 || asked.search.size() == 200);
                           asked.ask();
                           EXPECT_EQ(asked.pairCount, whole.pairCount);
                           EXPECT_EQ(asked.counts, whole.counts);
                       });
    EXPECT_GE(failures, 50U);
}

TEST(PairsFailure, AFilterThatThrowsLeavesTheFrameToTheNextUpdate) {
    int failures = 0;
    for (bool hasThrown = true; hasThrown;) {
        const std::unique_ptr<World> world = longRun();
        int asked = 0;
        const auto throwing = [&](ProxyId a, ProxyId b) {
            if (asked++ == 5 * failures) {
                throw std::runtime_error("no");
            }
            return world->filter()(a, b);
        };
        hasThrown = false;
        try {
            world->pairs.update(throwing);
        } catch (const std::runtime_error&) {
            hasThrown = true;
            checkPairsGoOn(*world, static_cast<std::size_t>(failures++));
        }
    }
    EXPECT_GE(failures, 5);
}

}  // namespace
}  // namespace hashphase::test
