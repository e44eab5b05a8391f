// SPDX-License-Identifier: Zlib

// Memory runs out at every allocation of every operation that makes one, and then is there again.

#include <broadphase/neighbours.hpp>
#include <broadphase/radius_search.hpp>
#include <tests/broadphase/failing_world.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace hashphase::test {
namespace {

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
    const auto settled = [] { return settledRun(200); };
    const auto unfiled = [] { return std::make_unique<FailingWorld>(200); };
    for (const bool isRay : {false, true}) {
        const auto ask = [=](FailingWorld& world) {
            const BoxRegion<float> box{boxAround<float>({0, 0, 0}, {3, 3, 3})};
            const RayRegion<float> ray({-9, 0, 0}, {9, 1, 1});
            world.grid.expectRays(isRay ? 1'000'000 : 0);
            for (int i = 0; i < 12; ++i) {  // of which one files
                CollectCount count;
                isRay ? world.grid.visit(ray, count) : world.grid.visit(box, count);
            }
        };
        const auto check = [](FailingWorld& world, std::size_t n) {
            world.expectQueriesLikeBruteForce(10);
            checkPairsGoOn(world, n);
        };
        expectGoesOn(isRay ? 55 : 40, unfiled, ask, check);
        expectGoesOn(isRay ? 55 : 40, settled, ask, check);
    }
}

TEST_F(OutOfMemory, AnUpdateOfAGridAloneIsRepeated) {
    using Alone = Population<float>;
    const std::size_t failures = runOutOfMemory(
        [] {
            auto world = std::make_unique<Alone>(GridConfig{.slack = 0.2});
            const auto draw = spreadScene<float>("spread", 1, 0).draw;
            world->addMany(150, draw, 2);
            world->update();
            world->addMany(150, draw, 2);
            return world;
        },
        [](Alone& world) {
            for (int frame = 0; frame < 20; ++frame) {  // in which half of them settle
                world.update();
                const WorkingAllocations lifted;
                world.tremble(0, 150, kTrembling);
            }
            const WorkingAllocations lifted;
            EXPECT_GT(world.grid.update().resting, 150U);
        },
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
    const auto checkShifted = [&](FailingWorld& world, std::size_t n) {
        SCOPED_TRACE("after " + std::to_string(n / 2) + " allocations");
        bool hasHappened = true;
        try {
            const FailingAllocations failing(n / 2);
            world.grid.shiftOrigin(shift);
        } catch (const std::bad_alloc&) {
            hasHappened = false;
        }
        EXPECT_EQ(hasHappened, n >= 2) << "only room for the boxes of the last update is needed";
        for (Placed<float>& proxy : world.proxies) {
            const Vector3<float> by = hasHappened ? shift : Vector3<float>(0, 0, 0);
            for (Aabb<float>* const box : {&proxy.box, &proxy.home}) {
                *box = Aabb<float>(box->min() - by, box->max() - by);
            }
            EXPECT_TRUE(isSameBits(world.grid.box(proxy.id), proxy.box));
        }
        if (n % 3 == 0) {
            const std::size_t before = world.set().size();
            world.refilter(world.proxies[0].id);
            EXPECT_GE(world.set().size(), before) << "nothing dies";
        }
    };
    for (std::size_t n = 0; n < 12; ++n) {
        const std::unique_ptr<FailingWorld> world = longRun();
        if (n % 2 == 0) {
            world->update();
        }
        checkShifted(*world, n);
        checkPairsGoOn(*world, n / 4);
        const std::unique_ptr<FailingWorld> settled = settledRun();
        checkShifted(*settled, n);
        checkTremblingGoesOn(*settled, n / 4);
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

TEST_F(OutOfMemory, FailedUpdateKeepsRefusedPairs) {
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
        const std::unique_ptr<FailingWorld> world = failures % 2 == 0 ? longRun() : settledRun();
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
