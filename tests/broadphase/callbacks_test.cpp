// SPDX-License-Identifier: Zlib

// What a callback may do, and where, is safe. What it may not do is in misuse_test.cpp.

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/call_each.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

using Box = Aabb<float>;

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

/// A grid that a collector changes at will.
struct Changed : Population<float> {
    using Matches = std::function<bool(ProxyId, const Box&)>;
    using Query = std::function<void(CallEach&)>;

    explicit Changed(std::size_t count) { addMany(count, scene.draw, 2); }

    void addOne() { add(scene.draw(random)); }
    void removeOne(std::size_t i) {
        touched.insert(proxies[i].id);
        removeAt(i);
    }
    void changeSomething(ProxyId found) {
        const double choice = random.unit();
        if (choice < 0.4) {
            std::size_t i = 0;
            while (proxies.at(i).id != found) {  // who was removed is not offered
                ++i;
            }
            removeOne(i);
        } else if (choice < 0.6 && proxies.size() > 1) {
            removeOne(any());
        } else if (choice < 0.8 && !proxies.empty()) {
            const std::size_t i = any();
            touched.insert(proxies[i].id);
            moveTo(i, scene.draw(random));
        } else {
            addOne();
        }
    }
    /// query(collector), whose collector calls change() for each proxy offered, must offer all
    /// those of which matches(id, box) was true before and that were neither moved nor removed
    /// meanwhile, once each, and nothing else that stayed as it was. Returns how many they are.
    std::size_t expectTheOthersOnce(const Matches& matches, const Query& query,
                                    const std::function<void(ProxyId, float)>& change) {
        touched.clear();
        std::map<ProxyId, int> expected;
        for (const Placed<float>& proxy : proxies) {
            expected[proxy.id] = matches(proxy.id, proxy.box) ? 1 : 0;
        }
        std::map<ProxyId, int> offered;
        CallEach collector{[&](ProxyId id, float key) {
            ++offered[id];
            change(id, key);
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
    /// The same for a query of the grid; what is offered is so where it is now.
    template <class Region>
    std::size_t visitAndChange(const Region& region) {
        return expectTheOthersOnce([&](ProxyId, const Box& box) { return region.key(box) >= 0; },
                                   [&](CallEach& collector) { grid.visit(region, collector); },
                                   [&](ProxyId id, float key) {
                                       EXPECT_EQ(key, region.key(grid.box(id)));
                                       changeSomething(id);
                                   });
    }
    std::size_t visitCellAndChange(const std::array<std::int64_t, 3>& cell) {
        return expectTheOthersOnce(
            [&](ProxyId id, const Box&) { return isCellOf(cell, grid.cellsOf(id)); },
            [&](CallEach& collector) { grid.visitCell(cell, collector); },
            [&](ProxyId id, float) { changeSomething(id); });
    }
    std::size_t forEachAndChange() {
        return expectTheOthersOnce(
            [](ProxyId, const Box&) { return true; },
            [&](CallEach& collector) {
                grid.forEach([&](ProxyId id, const Box&) { collector.add(id, 0); });
            },
            [&](ProxyId id, float) {
                if (random.chance(0.1)) {
                    changeSomething(id);
                }
            });
    }

    BoxScene<float> scene = spreadScene<float>("spread", 1, 0);
    std::set<ProxyId> touched;  // moved or removed since a query began
};

TEST(GridCallbacks, MayChangeTheGridInAQueryOfTheirOwn) {
    for (const int settled : {0, 1, 12}) {
        Changed changed(300);
        for (int i = 0; i < settled; ++i) {
            changed.update();
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
            changed.expectLikeBruteForce(BoxRegion<float>{cube(0, 3)});
            changed.expectLikeBruteForce(RayRegion<float>({-9, 0, 0}, {9, 1, 1}));
            if (round % 2 == 0) {
                changed.update();
            }
            while (changed.proxies.size() < 200) {
                changed.addOne();
            }
        }
        for (const std::size_t count : others) {
            EXPECT_GT(count, 5U) << "were neither moved nor removed";
        }
    }
}

TEST(GridCallbacks, MayReleaseTheMemoryOfProxiesThatAreStillToCome) {
    for (const std::size_t alive : {20U, 1000U}) {  // few of many are listed, and then visited
        Grid<float> grid;
        std::vector<ProxyId> ids;
        for (int i = 0; i < 1000; ++i) {
            ids.push_back(grid.add(cube(i)));
        }
        const auto removeFrom2To = [&](std::size_t end) {
            for (std::size_t i = 2; i < end; ++i) {
                if (grid.contains(ids[i])) {
                    grid.remove(ids[i]);
                }
            }
        };
        removeFrom2To(1000 - alive + 2);
        std::size_t calls = 0;
        grid.forEach([&](ProxyId, const Box&) {
            if (++calls == 2) {
                removeFrom2To(1000);
                grid.update();
                grid.releaseUnusedMemory();
            }
        });
        EXPECT_EQ(calls, 2U);
        EXPECT_EQ(grid.indexLimit(), 2U);
    }
}

// The tables are being read, and nothing is filed for the queries within: what an update has filed, or
// queries before this one.
class GridCallbacksAfterFiling : public testing::TestWithParam<bool> {};

TEST_P(GridCallbacksAfterFiling, MayChangeMuchAndAskAndFindWhatIsThere) {
    Changed changed(500);
    changed.update();
    const BoxRegion<float> around{cube(0, 3)};
    for (int i = 0; i < 100 && GetParam(); ++i) {
        changed.addOne();
    }
    const std::uint64_t filings = changed.grid.filingCount();
    for (int i = 0; i < 1000 && GetParam() && changed.grid.filingCount() == filings; ++i) {
        changed.expectLikeBruteForce(around);
    }
    const BoxRegion<float> asked{cube(0, 2)};
    const auto isSpared = [&](const Placed<float>& proxy) {  // every second one that is asked for
        return asked.key(proxy.box) >= 0 && proxy.id.index % 2 == 0;
    };
    const auto changeMuch = [&](ProxyId, float) {
        for (int i = 0; i < 50 && changed.proxies.size() > 100; ++i) {
            const std::size_t victim = changed.any();
            if (!isSpared(changed.proxies[victim])) {
                changed.removeOne(victim);
            }
        }
        for (int i = 0; i < 30; ++i) {
            changed.addOne();
        }
        changed.expectLikeBruteForce(around);
        changed.expectLikeBruteForce(RayRegion<float>({-9, 0, 0}, {9, 1, 1}));
        changed.expectLikeBruteForce(ConvexRegion<float>({}));
        CollectCount one;
        CollectCount each;
        changed.grid.visit(around, one);
        changed.grid.visitEach(std::span(&around, 1), std::span(&each, 1));
        EXPECT_EQ(one.count(), each.count());
        EXPECT_EQ(changed.grid.validate(), "");
    };
    const auto spared = std::ranges::count_if(changed.proxies, isSpared);
    const std::size_t others = changed.expectTheOthersOnce(
        [&](ProxyId, const Box& box) { return asked.key(box) >= 0; },
        [&](CallEach& collector) { changed.grid.visit(asked, collector); }, changeMuch);
    EXPECT_GE(others, static_cast<std::size_t>(spared));
    EXPECT_GT(spared, 5);
    EXPECT_EQ(changed.grid.validate(), "");
    changed.expectLikeBruteForce(around);
    changed.update();
    changed.expectLikeBruteForce(around);
}

INSTANTIATE_TEST_SUITE_P(ByUpdateOrQueries, GridCallbacksAfterFiling, testing::Bool());

// Filed by an update, or by queries since.
TEST(GridCallbacks, MayChangeInManyWaysWhatRestsAndIsStillToCome) {
    for (const int change : {0, 1, 2, 3, 4, 5}) {
        SCOPED_TRACE(change);
        Grid<float> grid;
        Sweeps<float> sweeps(grid);
        Pairs<float> pairs(grid, &sweeps);
        std::vector<ProxyId> resting;
        std::vector<ProxyId> mobile;
        for (int i = 0; i < 100; ++i) {
            resting.push_back(grid.add(cube(10 * i), Mobility::resting));
            mobile.push_back(grid.add(cube(10 * i + 5)));
        }
        for (int update = 0; update < 9; ++update) {
            for (const ProxyId id : mobile) {
                grid.move(id, cube(10 * id.index, 1 + 0.1 * update));
            }
            static_cast<void>(pairs.update());
        }
        ASSERT_EQ(pairs.lastCost().grid.resting, resting.size());
        if (change % 2 == 1) {
            for (const ProxyId id : mobile) {
                grid.move(id, cube(10 * id.index));
            }
            grid.expectQueries(1'000'000);
        }
        std::map<ProxyId, int> offered;
        CallEach collector{[&](ProxyId found, float) {
            for (std::size_t i = 0; i < resting.size() && offered.empty(); ++i) {
                if (change / 2 == 0) {
                    grid.move(resting[i], cube(10 * static_cast<double>(i) + 1));
                } else if (change / 2 == 1) {
                    grid.setGroups(resting[i], {2, 1});
                } else {
                    sweeps.set(resting[i], {1, 0, 0});
                }
            }
            ++offered[found];
        }};
        grid.visit(SphereRegion<float>({0, 0, 0}, 1e9F), collector);
        for (const ProxyId id : resting) {
            EXPECT_GE(offered[id], 1);
        }
        for (const ProxyId id : mobile) {
            EXPECT_EQ(offered[id], 1) << "has not been changed";
        }
        static_cast<void>(pairs.update());
        EXPECT_EQ(pairs.validate(), "");
    }
}

TEST(GridCallbacks, MayAskWithinAQuery) {
    // 4 x 4 x 4 unit cubes: each finds itself and those that touch it, (2 + 3 + 3 + 2) cubed.
    Population<float> block;
    for (int i = 0; i < 64; ++i) {
        block.add(
            boxAround<float>({double(i % 4), double(i / 4 % 4), double(i / 16)}, {0.5, 0.5, 0.5}));
    }
    std::size_t neighbours = 0;
    CallEach collector{[&](ProxyId id, float) {
        neighbours += find(block.grid, BoxRegion<float>{block.grid.box(id)}).size();
    }};
    block.grid.visit(BoxRegion<float>{cube(0, 9)}, collector);
    EXPECT_EQ(neighbours, 1000U);
}

TEST(SweepsCallbacks, MayChangeWhatSweeps) {
    Grid<float> grid;
    Sweeps<float> sweeps(grid);
    Pairs<float> pairs(grid, &sweeps);
    std::vector<ProxyId> ids;
    for (int i = 0; i < 40; ++i) {
        ids.push_back(grid.add(cube(0)));
        sweeps.set(ids.back(), {float(i), 0, 0});
    }
    pairs.update();
    std::size_t found = 0;
    std::map<ProxyId, int> offered;
    CallEach collector{[&](ProxyId id, float) {
        EXPECT_TRUE(grid.contains(id));
        ++offered[id];
        sweeps.set(ids[(7 * found) % 30],
                   found % 2 == 0 ? Vector3<float>(0, 0, 0) : Vector3<float>(0, 5, 0));
        if (++found % 4 == 0) {
            sweeps.set(grid.add(cube(0)), {1, 1, 1});
        }
    }};
    sweeps.visit(BoxRegion<float>{cube(0)}, collector);
    EXPECT_GT(found, 10U);
    for (std::size_t i = 30; i < ids.size(); ++i) {
        EXPECT_EQ(offered[ids[i]], 1) << "nobody has changed how it sweeps";
    }
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(sweeps.validate(), "");
        EXPECT_EQ(grid.validate(), "");
        pairs.update();
    }
}

}  // namespace
}  // namespace hashphase::test
