// SPDX-License-Identifier: Zlib

// What a caller may not do is asserted; what a callback may do, and where, is safe.

#include <broadphase/convex_region.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/radius_search.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <vector>

namespace hashphase::test {
namespace {

using Box = Aabb<float>;
using Point = Vector3<float>;

/// A collector that calls a function for each proxy found.
struct CallEach {
    std::function<void(ProxyId)> call;

    void add(ProxyId id, float /*key*/) { call(id); }
    static constexpr float limit() { return std::numeric_limits<float>::infinity(); }
};

Box cube(double x, double half = 1) {
    return boxAround<float>({x, 0, 0}, Vector3<double>::Constant(half));
}

bool isCellOf(const std::array<std::int64_t, 3>& cell, const CellRange& range) {
    bool isWithin = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        isWithin =
            isWithin && range.lowest[axis] <= cell[axis] && cell[axis] <= range.highest[axis];
    }
    return isWithin;
}

/// A grid that a collector changes at will, and who is alive in it.
struct Changed {
    explicit Changed(int count) {
        for (int i = 0; i < count; ++i) {
            add(i % 2 == 0 ? Mobility::resting : Mobility::mobile);
        }
    }
    void add(Mobility mobility = Mobility::mobile) {
        const Box box = scene.draw(random);
        alive[grid.add(box, mobility)] = box;
    }
    void removeOne(ProxyId id) {
        grid.remove(id);
        alive.erase(id);
        touched.insert(id);
    }
    ProxyId any() {
        auto at = alive.begin();
        std::advance(at, random.below(static_cast<std::uint32_t>(alive.size())));
        return at->first;
    }
    void changeSomething(ProxyId found) {
        ASSERT_TRUE(alive.contains(found)) << "who was removed is offered";
        const double choice = random.unit();
        if (choice < 0.4) {
            removeOne(found);
        } else if (choice < 0.6 && alive.size() > 1) {
            removeOne(any());
        } else if (choice < 0.8) {
            const ProxyId id = alive.empty() ? ProxyId{} : any();
            if (!id.isNull()) {
                grid.move(id, alive[id] = scene.draw(random));
                touched.insert(id);
            }
        } else {
            add();
        }
    }
    /// query(collector), whose collector calls change() for each proxy offered, must offer all
    /// those of which matches(id, box) was true before and that were neither moved nor removed
    /// meanwhile, once each, and nothing else that stayed as it was. Returns how many they are.
    template <class Matches, class Query>
    std::size_t expectTheOthersOnce(const Matches& matches, const Query& query,
                                    const std::function<void(ProxyId)>& change) {
        touched.clear();
        std::map<ProxyId, int> expected;
        for (const auto& [id, box] : alive) {
            expected[id] = matches(id, box) ? 1 : 0;
        }
        std::map<ProxyId, int> offered;
        CallEach collector{[&](ProxyId id) {
            ++offered[id];
            change(id);
        }};
        query(collector);
        std::size_t others = 0;
        for (const auto& [id, times] : expected) {
            if (!touched.contains(id)) {
                EXPECT_EQ(offered[id], times) << testing::PrintToString(id);
                others += static_cast<std::size_t>(times);
            }
        }
        return others;
    }
    /// The same for a query of the grid.
    template <class Region>
    std::size_t visitAndChange(const Region& region) {
        return expectTheOthersOnce([&](ProxyId, const Box& box) { return region.key(box) >= 0; },
                                   [&](CallEach& collector) { grid.visit(region, collector); },
                                   [&](ProxyId id) { changeSomething(id); });
    }
    std::size_t visitCellAndChange(const std::array<std::int64_t, 3>& cell) {
        return expectTheOthersOnce(
            [&](ProxyId id, const Box&) { return isCellOf(cell, grid.cellsOf(id)); },
            [&](CallEach& collector) { grid.visitCell(cell, collector); },
            [&](ProxyId id) { changeSomething(id); });
    }
    std::size_t forEachAndChange() {
        return expectTheOthersOnce(
            [](ProxyId, const Box&) { return true; },
            [&](CallEach& collector) {
                grid.forEach([&](ProxyId id, const Box&) { collector.add(id, 0); });
            },
            [&](ProxyId id) {
                if (random.chance(0.1)) {
                    changeSomething(id);
                }
            });
    }
    template <class Region>
    void checkQuery(const Region& region) {
        std::vector<Placed<float>> placed;
        for (const auto& [id, box] : alive) {
            placed.push_back({id, box});
        }
        expectLikeBruteForce<float>(grid, placed, region);
    }

    Random random{2};
    BoxScene<float> scene = spreadScene<float>("spread", 1, 0);
    Grid<float> grid;
    std::map<ProxyId, Box> alive;
    std::set<ProxyId> touched;  // moved or removed since a query began
};

TEST(GridCallbacks, MayChangeTheGridInAQueryOfTheirOwn) {
    for (const int settled : {0, 1, 12}) {
        Changed changed(300);
        for (int i = 0; i < settled; ++i) {
            changed.grid.update();
        }
        std::array<std::size_t, 5> others{};
        for (int round = 0; round < 6; ++round) {
            others[0] += changed.visitAndChange(BoxRegion<float>{cube(0, 5)});
            others[1] += changed.visitAndChange(SphereRegion<float>({1, 0, 0}, 4));
            others[2] += changed.visitAndChange(RayRegion<float>({-9, 0, 0}, {9, 1, 1}));
            others[2] += changed.visitAndChange(RayRegion<float>({-9, 0, 0}, {9, 1, 1}, cube(0)));
            for (int corner = 0; corner < 8; ++corner) {
                others[3] += changed.visitCellAndChange(
                    {corner % 2 - 1, corner / 2 % 2 - 1, corner / 4 - 1});
            }
            others[4] += changed.forEachAndChange();
            EXPECT_EQ(changed.grid.validate(), "");
            changed.checkQuery(BoxRegion<float>{cube(0, 3)});
            changed.checkQuery(RayRegion<float>({-9, 0, 0}, {9, 1, 1}));
            if (round % 2 == 0) {
                changed.grid.update();
            }
            while (changed.alive.size() < 200) {
                changed.add();
            }
        }
        for (const std::size_t count : others) {
            EXPECT_GT(count, 5U) << "were neither moved nor removed";
        }
    }
}

// The tables are being read, and nothing is filed for the queries within: what an update has filed, or
// queries before this one.
class GridCallbacksAfterFiling : public testing::TestWithParam<bool> {};

TEST_P(GridCallbacksAfterFiling, MayChangeMuchAndAskAndFindWhatIsThere) {
    Changed changed(500);
    changed.grid.update();
    for (int i = 0; i < 100 && GetParam(); ++i) {
        changed.add();
    }
    const std::uint64_t filings = changed.grid.filingCount();
    for (int i = 0; i < 1000 && GetParam() && changed.grid.filingCount() == filings; ++i) {
        changed.checkQuery(BoxRegion<float>{cube(0, 3)});
    }
    const BoxRegion<float> asked{cube(0, 2)};
    std::set<ProxyId> spared;  // every second of those who are asked for
    for (const auto& [id, box] : changed.alive) {
        if (asked.key(box) >= 0 && id.index % 2 == 0) {
            spared.insert(id);
        }
    }
    const auto changeMuch = [&](ProxyId) {
        for (int i = 0; i < 50 && changed.alive.size() > 100; ++i) {
            const ProxyId id = changed.any();
            if (!spared.contains(id)) {
                changed.removeOne(id);
            }
        }
        for (int i = 0; i < 30; ++i) {
            changed.add();
        }
        const BoxRegion<float> region{cube(0, 3)};
        changed.checkQuery(region);
        changed.checkQuery(RayRegion<float>({-9, 0, 0}, {9, 1, 1}));
        changed.checkQuery(ConvexRegion<float>({}));
        CollectCount one;
        CollectCount each;
        changed.grid.visit(region, one);
        changed.grid.visitEach(std::span(&region, 1), std::span(&each, 1));
        EXPECT_EQ(one.count(), each.count());
        EXPECT_EQ(changed.grid.validate(), "");
    };
    const std::size_t others = changed.expectTheOthersOnce(
        [&](ProxyId, const Box& box) { return asked.key(box) >= 0; },
        [&](CallEach& collector) { changed.grid.visit(asked, collector); }, changeMuch);
    EXPECT_GE(others, spared.size());
    EXPECT_GT(spared.size(), 5U);
    EXPECT_EQ(changed.grid.validate(), "");
    changed.checkQuery(BoxRegion<float>{cube(0, 3)});
    changed.grid.update();
    changed.checkQuery(BoxRegion<float>{cube(0, 3)});
}

INSTANTIATE_TEST_SUITE_P(ByUpdateOrQueries, GridCallbacksAfterFiling, testing::Bool());

TEST(SweepsCallbacks, MayChangeWhatSweeps) {
    Grid<float> grid;
    Sweeps<float> sweeps(grid);
    std::vector<ProxyId> ids;
    for (int i = 0; i < 40; ++i) {
        ids.push_back(grid.add(cube(0)));
        sweeps.set(ids.back(), {float(i), 0, 0});
    }
    std::size_t found = 0;
    std::map<ProxyId, int> offered;
    CallEach collector{[&](ProxyId id) {
        EXPECT_TRUE(grid.contains(id));
        ++offered[id];
        sweeps.set(ids[(7 * found) % 30], found % 2 == 0 ? Point(0, 0, 0) : Point(0, 5, 0));
        if (++found % 4 == 0) {
            const ProxyId added = grid.add(cube(0));
            sweeps.set(added, {1, 1, 1});
        }
    }};
    sweeps.visit(BoxRegion<float>{cube(0)}, collector);
    EXPECT_GT(found, 10U);
    for (std::size_t i = 30; i < ids.size(); ++i) {
        EXPECT_EQ(offered[ids[i]], 1) << "nobody has changed how it sweeps";
    }
    EXPECT_EQ(sweeps.validate(), "");
    EXPECT_EQ(grid.validate(), "");
}

#if HASHPHASE_ENABLE_ASSERTS

/// Calls everything that changes a grid; all of it must be asserted, and none of it happen.
void expectThatNothingMayChange(Grid<float>& grid, ProxyId id) {
    EXPECT_THROW(static_cast<void>(grid.add(cube(0))), BrokenAssert);
    EXPECT_THROW(grid.move(id, cube(5)), BrokenAssert);
    EXPECT_THROW(grid.remove(id), BrokenAssert);
    EXPECT_THROW(grid.reserve(100), BrokenAssert);
}

TEST(GridCallbacks, MustNotChangeTheGridWhereManyAreDealtWithAtOnce) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    const ProxyId id = grid.add(cube(0));
    std::size_t calls = 0;
    CallEach collector{[&](ProxyId) {
        ++calls;
        expectThatNothingMayChange(grid, id);
    }};
    const BoxRegion<float> region{cube(0)};
    const RayRegion<float> ray({-9, 0, 0}, {9, 0, 0});
    grid.visitEach(std::span(&region, 1), std::span(&collector, 1));
    grid.visitEach(std::span(&ray, 1), std::span(&collector, 1));
    grid.visit(ConvexRegion<float>({}), collector);
    EXPECT_EQ(calls, 3U);
    grid.move(id, cube(1));
    EXPECT_EQ(grid.validate(), "");
}

TEST(GridCallbacks, MustNotBeginAnUpdate) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    static_cast<void>(grid.add(cube(0)));
    CallEach collector{[&](ProxyId) { grid.update(); }};
    EXPECT_THROW(grid.visit(BoxRegion<float>{cube(0)}, collector), BrokenAssert);
    grid.update();

    Grid<float> paired;
    Pairs<float> pairs(paired);
    static_cast<void>(paired.add(cube(0)));
    const auto all = [](ProxyId, ProxyId) { return true; };
    CallEach updating{[&](ProxyId) { pairs.update(all); }};
    EXPECT_THROW(paired.visit(BoxRegion<float>{cube(0)}, updating), BrokenAssert);
    pairs.update(all);
    EXPECT_EQ(pairs.validate(), "");
}

TEST(PairFilterCallback, MayAskTheGridButMustNotChangeItNorAskForPairs) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    Pairs<float> pairs(grid);
    const ProxyId a = grid.add(cube(0));
    static_cast<void>(grid.add(cube(1)));
    int calls = 0;
    const auto all = [](ProxyId, ProxyId) { return true; };
    const auto filter = [&](ProxyId, ProxyId) {
        ++calls;
        expectThatNothingMayChange(grid, a);
        EXPECT_THROW(pairs.update(all), BrokenAssert);
        EXPECT_THROW(pairs.findPairsNow(a, all), BrokenAssert);
        EXPECT_THROW(pairs.refilter(a, all), BrokenAssert);
        CollectCount count;
        grid.visit(BoxRegion<float>{cube(0)}, count);
        EXPECT_EQ(count.count(), 2U);
        return true;
    };
    EXPECT_EQ(pairs.update(filter).born.size(), 1U);
    EXPECT_TRUE(pairs.refilter(a, filter).born.empty());
    EXPECT_EQ(calls, 2);
    EXPECT_EQ(pairs.validate(), "");
}

TEST(GridMisuse, OfUpdateWherePairsEndTheFrameIsAsserted) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    const Pairs<float> pairs(grid);
    EXPECT_THROW(grid.update(), BrokenAssert);
}

TEST(GridMisuse, OfVisitEachWithoutACollectorForEachRegionIsAsserted) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    const std::vector<BoxRegion<float>> regions(2, {cube(0)});
    std::vector<CollectCount> counts(3);
    EXPECT_THROW(grid.visitEach(std::span(regions), std::span(counts)), BrokenAssert);
}

TEST(GridMisuse, OfRoomForMoreThanCanBeCountedIsRefused) {
    Grid<float> grid;
    grid.remove(grid.add(cube(0)));
    EXPECT_THROW(grid.reserve(~std::size_t{0}), std::length_error);
}

TEST(SweepsMisuse, OfAFilterOrConvexQueryThatSetsIsAsserted) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    Sweeps<float> sweeps(grid);
    Pairs<float> pairs(grid, &sweeps);
    const ProxyId id = grid.add(cube(0), Mobility::resting);
    static_cast<void>(grid.add(cube(1)));
    int calls = 0;
    const auto setting = [&](ProxyId, ProxyId) {
        ++calls;
        EXPECT_THROW(sweeps.set(id, {9, 0, 0}), BrokenAssert);
        return true;
    };
    EXPECT_EQ(pairs.update(setting).born.size(), 1U);
    CallEach collector{[&](ProxyId found) { setting(found, found); }};
    grid.visit(ConvexRegion<float>({}), collector);
    EXPECT_EQ(calls, 3);
    EXPECT_TRUE(sweeps.motion(id).displacement.isZero(0));
    EXPECT_EQ(sweeps.validate(), "");
}

TEST(SweepsMisuse, OfACollectorThatUpdatesIsAssertedWhenItIsOfferedWhatSweeps) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    Sweeps<float> sweeps(grid);
    Pairs<float> pairs(grid, &sweeps);
    sweeps.set(grid.add(cube(0)), {9, 0, 0});
    const auto all = [](ProxyId, ProxyId) { return true; };
    CallEach collector{[&](ProxyId) { pairs.update(all); }};
    EXPECT_THROW(sweeps.visit(BoxRegion<float>{cube(5)}, collector), BrokenAssert);
    pairs.update(all);
    EXPECT_EQ(sweeps.validate(), "");
}

TEST(SweepsMisuse, OfAStaleIdIsAsserted) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    const Sweeps<float> sweeps(grid);
    const ProxyId id = grid.add(cube(0));
    grid.remove(id);
    EXPECT_THROW(static_cast<void>(sweeps.motion(id)), BrokenAssert);
}

TEST(RadiusSearchMisuse, OfItsOwnCallbacksIsAsserted) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    const ProxyId id = grid.add(cube(0));
    RadiusSearch<float> search;
    int calls = 0;
    search.take(grid, 1, [&](ProxyId) {
        ++calls;
        expectThatNothingMayChange(grid, id);
        EXPECT_THROW(search.take(grid, 1), BrokenAssert);
        return true;
    });
    std::vector<std::uint32_t> counts(1);
    const auto ask = [&] {
        ++calls;
        EXPECT_THROW(search.take(grid, 2), BrokenAssert);
        EXPECT_THROW(search.count(counts), BrokenAssert);
    };
    search.forEach([&](std::uint32_t, std::span<const std::uint32_t>) { ask(); });
    const auto groupOf = [&](ProxyId) {
        ask();
        return 0U;
    };
    search.countGroups(1, groupOf, counts);
    EXPECT_GE(calls, 4);
    grid.move(id, cube(3));  // all scopes have ended
    search.take(grid, 1);
    EXPECT_EQ(search.position(0), Point(3, 0, 0));
}

TEST(GridMisuseDeathTest, EndsTheProgramWithASentence) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    Grid<float> grid;
    EXPECT_DEATH(grid.remove({}), "Only a proxy of this grid that was not removed can be removed");
}

#endif

}  // namespace
}  // namespace hashphase::test
