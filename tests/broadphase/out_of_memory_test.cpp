// SPDX-License-Identifier: Zlib

// Memory runs out at every allocation of every operation that makes one, and then is there again.

#include <broadphase/neighbours.hpp>
#include <broadphase/radius_search.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace hashphase::test {
namespace {

/// Grid, sweeps and pairs, some of which refuse each other, and what they must be like.
struct FailingWorld : Population<float, PairWorld> {
    explicit FailingWorld(std::size_t count) { addSome(count); }

    void addSome(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            add(scene.draw(random), i % 3 == 0 ? Mobility::resting : Mobility::mobile);
            paint(proxies.size() - 1, static_cast<std::uint32_t>(proxies.size() - 1) % 3);
        }
    }
    void moveSome(std::size_t step) {
        for (std::size_t i = 0; i < proxies.size(); i += step) {
            moveTo(i, scene.draw(random));
        }
    }
    void removeSome(std::size_t step) {
        for (std::size_t i = 0; i < proxies.size(); i += step) {
            removeAt(i);
        }
    }
    void sweepSome(std::size_t step) {
        for (std::size_t i = 0; i < proxies.size(); i += step) {
            const Vector3<float> way = random.pointIn(-30, 30).cast<float>();
            sweep(proxies[i].id, way, Sweep::automatic);
        }
    }
    void checkQueries() {
        EXPECT_EQ(grid.validate() + sweeps.validate(), "");
        EXPECT_EQ(grid.size(), proxies.size());
        if (!proxies.empty()) {
            RegionMaker<float> regions(random, proxies);
            expectLikeBruteForce(regions.box());
            expectLikeBruteForce(regions.ray());
        }
    }
    void updateAndCheckPairs() {
        update();
        check(proxies);
        EXPECT_EQ(pairs.validate(), "");
    }

    BoxScene<float> scene = spreadScene<float>("spread", 1, 0);
};

/// Which has seen frames enough for most to rest, and then some changes.
std::unique_ptr<FailingWorld> longRun() {
    auto world = std::make_unique<FailingWorld>(45);
    for (int frame = 0; frame < 10; ++frame) {
        world->moveSome(9);
        world->update();
    }
    world->addSome(45);
    world->moveSome(2);
    world->removeSome(7);
    return world;
}

/// After a failure or none the world goes on as if there had been none.
void checkPairsGoOn(FailingWorld& world, std::size_t n) {
    world.checkQueries();
    if (n % 2 == 1) {  // what changes meanwhile comes in addition
        world.moveSome(5);
        world.removeSome(11);
        world.addSome(3);
    }
    for (int frame = 0; frame < 2; ++frame) {
        world.updateAndCheckPairs();
        world.moveSome(13);
    }
    world.checkQueries();
}

struct OutOfMemory : testing::Test {
    using Make = std::function<std::unique_ptr<FailingWorld>()>;

    void SetUp() override {
        if (!kCountsAllocations) {
            GTEST_SKIP() << "this program has another `new`";
        }
    }
    /// The attempt fails at least so often, and the world goes on each time.
    static void expectGoesOn(std::size_t fewest, const Make& make,
                             const std::function<void(FailingWorld&)>& attempt) {
        EXPECT_GE(runOutOfMemory(make, attempt, checkPairsGoOn), fewest);
    }
};

TEST_F(OutOfMemory, AnUpdateOfPairsIsRepeated) {
    const auto update = [](FailingWorld& world) { updatePairsInWant(world); };
    expectGoesOn(
        40, [] { return std::make_unique<FailingWorld>(70); }, update);
    // Though many rest, some sweep, or many come to rest.
    expectGoesOn(20, longRun, update);
    const auto withSweeps = [] {
        auto world = longRun();
        world->sweepSome(4);
        return world;
    };
    expectGoesOn(40, withSweeps, update);
    const auto withIdle = [] {
        auto world = std::make_unique<FailingWorld>(90);
        for (int frame = 0; frame < 9; ++frame) {
            world->update();
            world->moveSome(50);
        }
        return world;
    };
    expectGoesOn(3, withIdle, update);
}

TEST_F(OutOfMemory, AnnouncingAndFilteringAgainHaveHappenedOrNot) {
    const auto moved = [] {
        auto world = longRun();
        world->update();
        world->moveSome(3);
        return world;
    };
    for (const bool isRefiltered : {false, true}) {
        expectGoesOn(1, moved, [=](FailingWorld& world) {
            const auto filter = [&](ProxyId a, ProxyId b) { return world.colours.accept(a, b); };
            for (const Placed<float>& proxy : world.proxies) {
                const PairChanges changes = isRefiltered
                                                ? world.pairs.refilter(proxy.id, filter)
                                                : world.pairs.findPairsNow(proxy.id, filter);
                const WorkingAllocations lifted;
                world.apply(changes);
            }
        });
    }
}

TEST_F(OutOfMemory, AddingHasHappenedOrNotAndMovingAndRemovingAllocateNothing) {
    const std::size_t failures = runOutOfMemory(
        [] { return std::make_unique<FailingWorld>(0); },
        [](FailingWorld& world) {
            for (int i = 0; i < 200; ++i) {
                const auto box = boxAround<float>(Vector3<double>::Constant(i), {1, 1, 1});
                const ProxyId id = world.grid.add(box);
                const WorkingAllocations lifted;
                world.proxies.push_back({id, box, 0});
            }
        },
        [](FailingWorld& world, std::size_t) {
            world.checkQueries();
            world.update();
            for (Placed<float>& proxy : world.proxies) {
                proxy.box.translate(Vector3<float>(0.5F, 0, 0));
                const FailingAllocations failing(0);
                world.grid.move(proxy.id, proxy.box);
            }
            for (std::size_t i = 0; i < world.proxies.size(); i += 2) {
                const FailingAllocations failing(0);
                world.removeAt(i);
            }
            world.checkQueries();
            world.updateAndCheckPairs();
        });
    EXPECT_GE(failures, 10U);
}

TEST_F(OutOfMemory, AQueryThatFilesOrGrowsATreeIsRepeated) {
    for (const bool isRay : {false, true}) {
        const auto ask = [=](FailingWorld& world) {
            const BoxRegion<float> box{boxAround<float>({0, 0, 0}, {3, 3, 3})};
            const RayRegion<float> ray({-9, 0, 0}, {9, 1, 1});
            for (int i = 0; i < 8; ++i) {  // of which one files
                CollectCount count;
                isRay ? world.grid.visit(ray, count) : world.grid.visit(box, count);
            }
        };
        expectGoesOn(
            isRay ? 30 : 20, [] { return std::make_unique<FailingWorld>(200); }, ask);
    }
}

TEST_F(OutOfMemory, AnUpdateOfAGridAloneIsRepeated) {
    using Alone = Population<float>;
    const std::size_t failures = runOutOfMemory(
        [] {
            auto world = std::make_unique<Alone>();
            const auto draw = spreadScene<float>("spread", 1, 0).draw;
            world->addMany(150, draw, 2);
            world->update();
            world->addMany(150, draw, 2);
            return world;
        },
        [](Alone& world) { world.update(); },
        [](Alone& world, std::size_t n) {
            for (int frame = 0; frame < 2; ++frame) {
                EXPECT_EQ(world.grid.validate(), "");
                world.expectQueriesLikeBruteForce(1);
                world.moveTo(n % 300, Aabb<float>(world.proxies[0].box));
                world.update();
            }
        });
    EXPECT_GE(failures, 20U);
}

// Where what is rounded cannot be filed anew, the shift has happened all the same.
TEST_F(OutOfMemory, AShiftOfTheOriginHasHappenedOrNot) {
    const Vector3<float> shift(1000.1F, -300.3F, 0.7F);
    for (std::size_t n = 0; n < 12; ++n) {
        SCOPED_TRACE("after " + std::to_string(n / 2) + " allocations");
        const std::unique_ptr<FailingWorld> world = longRun();
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
            const Vector3<float> by = hasHappened ? shift : Vector3<float>(0, 0, 0);
            proxy.box = Aabb<float>(proxy.box.min() - by, proxy.box.max() - by);
            EXPECT_TRUE(isSameBits(world->grid.box(proxy.id), proxy.box));
        }
        if (n % 3 == 0) {
            const std::size_t before = world->set().size();
            world->refilter(world->proxies[0].id);
            EXPECT_GE(world->set().size(), before) << "nothing dies";
        }
        checkPairsGoOn(*world, n / 4);
    }
}

TEST_F(OutOfMemory, SettingASweepHasHappenedOrNot) {
    const std::size_t failures = runOutOfMemory(
        [] { return std::make_unique<FailingWorld>(40); },
        [](FailingWorld& world) {
            for (const Placed<float>& proxy : world.proxies) {
                world.sweeps.set(proxy.id, {9, 0, 0});
            }
        },
        [](FailingWorld& world, std::size_t) {
            for (const Placed<float>& proxy : world.proxies) {
                const Vector3<float> way = world.sweeps.motion(proxy.id).displacement;
                world.sweep(proxy.id, way, Sweep::automatic);  // which it does already, if it does
            }
            checkPairsGoOn(world, 0);
        });
    EXPECT_GE(failures, 1U);
}

/// Asks for much at once, and of many.
struct AskedWorld {
    FailingWorld world{300};
    std::vector<BoxRegion<float>> regions{40, {boxAround<float>({0, 0, 0}, {9, 9, 9})}};
    std::vector<CollectCount> found;
    std::vector<std::uint32_t> counts = std::vector<std::uint32_t>(300);
    Neighbours<float> neighbours;
    RadiusSearch<float> search;
    std::size_t pairCount = 0;

    void ask() {
        EXPECT_TRUE(search.size() == 0 || search.size() == 300) << "after a failure";
        found.assign(regions.size(), {});
        world.grid.visitEach(std::span<const BoxRegion<float>>(regions), std::span(found));
        pairCount = neighbours.find(world.grid, 1).size();
        search.take(world.grid, 2);
        search.count(counts);
    }
    [[nodiscard]] auto answer() const { return std::tuple(found[39].count(), pairCount, counts); }
};

TEST_F(OutOfMemory, RegionsNeighboursAndCrowdsAreFoundWhenAskedAgain) {
    EXPECT_GE(askOutOfMemory<AskedWorld>(), 70U);
}

TEST_F(OutOfMemory, LeavesWhatIsRefusedAsItWasWhenAFailedUpdateIsRepairedInVain) {
    struct Refusing {
        Refusing() {
            for (int i = 0; i < 100; ++i) {
                ids.push_back(grid.add(boxAt(0.9 * i), Mobility::resting));
            }
            for (int i = 0; i < 4; ++i) {
                pairs.update(refuse);
                grid.move(ids[0], boxAt(0.001 * (i + 1)));
            }
            EXPECT_THROW(pairs.update([](ProxyId, ProxyId) -> bool { throw 1; }), int);
        }
        static Aabb<float> boxAt(double x) { return boxAround<float>({x, 0, 0}, {0.5, 0.5, 0.5}); }
        static bool refuse(ProxyId, ProxyId) { return false; }
        Grid<float> grid;
        Pairs<float> pairs{grid};
        std::vector<ProxyId> ids;
    };
    const std::size_t failures = runOutOfMemory(
        [] { return std::make_unique<Refusing>(); },
        [](Refusing& world) { world.pairs.refilter(world.ids[50], Refusing::refuse); },
        [](Refusing& world, std::size_t) { EXPECT_EQ(world.pairs.refusedCount(), 99U); });
    EXPECT_GE(failures, 1U);
}

TEST(PairsFailure, AFilterThatThrowsLeavesTheFrameToTheNextUpdate) {
    std::size_t failures = 0;
    for (bool hasThrown = true; hasThrown;) {
        const std::unique_ptr<FailingWorld> world = longRun();
        std::size_t asked = 0;
        const auto throwing = [&](ProxyId a, ProxyId b) {
            if (asked++ == 5 * failures) {
                throw std::runtime_error("no");
            }
            return world->colours.accept(a, b);
        };
        hasThrown = false;
        try {
            world->pairs.update(throwing);
        } catch (const std::runtime_error&) {
            hasThrown = true;
            checkPairsGoOn(*world, failures++);
        }
    }
    EXPECT_GE(failures, 5U);
}

}  // namespace
}  // namespace hashphase::test
