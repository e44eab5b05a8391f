// SPDX-License-Identifier: Zlib

// Life in the grid: proxies come, move, rest and go. What queries find is in grid_query_test.cpp.

#include <broadphase/grid.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/oracles.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <set>
#include <unordered_map>
#include <vector>

namespace hashphase::test {
namespace {

using Box = Aabb<float>;

constexpr float kNanCoordinate = std::numeric_limits<float>::quiet_NaN();

Box cubeAt(double x) {
    return makeBox<float>(x, 0, 0, x + 1, 1, 1);
}

Box nanCube() {
    Box box = cubeAt(0);
    box.min()[2] = kNanCoordinate;
    return box;
}

std::size_t countIn(const Grid<float>& grid, const Box& box) {
    CollectCount count;
    grid.visit(BoxRegion<float>{box}, count);
    return count.count();
}

TEST(Grid, GivesEveryProxyAnIdOfItsOwnAndKeepsItsBox) {
    Grid<float> grid;
    std::set<ProxyId> ids;
    for (int i = 0; i < 100; ++i) {
        const ProxyId id = grid.add(cubeAt(i));
        EXPECT_FALSE(id.isNull());
        EXPECT_TRUE(ids.insert(id).second);
        EXPECT_TRUE(grid.contains(id));
        EXPECT_EQ(grid.box(id).min(), cubeAt(i).min());
        EXPECT_LT(id.index, 100U);
    }
    EXPECT_EQ(grid.size(), 100U);
    EXPECT_EQ(grid.validate(), "");
}

TEST(Grid, ForgetsARemovedProxyForEver) {
    Grid<float> grid;
    const ProxyId old = grid.add(cubeAt(0));
    grid.remove(old);
    EXPECT_FALSE(grid.contains(old));
    EXPECT_EQ(grid.size(), 0U);
    EXPECT_EQ(countIn(grid, cubeAt(0)), 0U);
    for (int i = 0; i < 10; ++i) {
        grid.update();
        const ProxyId id = grid.add(cubeAt(0));
        EXPECT_NE(id, old);
        EXPECT_FALSE(grid.contains(old));
        EXPECT_EQ(countIn(grid, cubeAt(0)), 1U);
        grid.remove(id);
        EXPECT_EQ(grid.validate(), "");
    }
}

TEST(Grid, UsesSlotsAgainSoThatIndicesStayBelowTheMostEverAlive) {
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 50; ++i) {
        ids.push_back(grid.add(cubeAt(i)));
    }
    for (int frame = 0; frame < 40; ++frame) {
        for (int i = 0; i < 10; ++i) {
            grid.remove(ids.back());
            ids.pop_back();
        }
        grid.update();
        for (int i = 0; i < 10; ++i) {
            ids.push_back(grid.add(cubeAt(i)));
            EXPECT_LT(ids.back().index, 50U);
        }
    }
    EXPECT_EQ(grid.validate(), "");
}

TEST(Grid, ContainsNeitherNullNorStrangeIds) {
    Grid<float> grid;
    EXPECT_FALSE(grid.contains({}));
    const ProxyId id = grid.add(cubeAt(0));
    EXPECT_FALSE(grid.contains({id.index, id.generation + 1}));
    EXPECT_FALSE(grid.contains({id.index + 1, id.generation}));
    EXPECT_FALSE(grid.contains({id.index, 0}));
    EXPECT_FALSE(grid.contains({0xffffffffU, 0xffffffffU}));
}

TEST(Grid, LeadsFromAnIndexBackToTheProxyAliveThatHasIt) {
    Grid<float> grid;
    EXPECT_TRUE(grid.idAt(0).isNull());
    const ProxyId first = grid.add(cubeAt(0));
    const ProxyId second = grid.add(cubeAt(1));
    EXPECT_EQ(grid.idAt(first.index), first);
    EXPECT_EQ(grid.idAt(second.index), second);
    EXPECT_TRUE(grid.idAt(grid.indexLimit()).isNull());
    grid.remove(first);
    EXPECT_TRUE(grid.idAt(first.index).isNull());
    grid.update();
    const ProxyId third = grid.add(cubeAt(2));
    EXPECT_EQ(third.index, first.index);
    EXPECT_EQ(grid.idAt(first.index), third);
}

TEST(ProxyId, IsAKeyOfUnorderedMaps) {
    Grid<float> grid;
    std::unordered_map<ProxyId, int> names;
    std::set<std::size_t> hashes;
    for (int i = 0; i < 100; ++i) {
        const ProxyId id = grid.add(cubeAt(i));
        names[id] = i;
        hashes.insert(std::hash<ProxyId>{}(id));
        hashes.insert(std::hash<ProxyId>{}({id.index, id.generation + 2}));
        EXPECT_EQ(names.at(id), i);
    }
    EXPECT_EQ(names.size(), 100U);
    EXPECT_EQ(hashes.size(), 200U);
}

TEST(Grid, VisitsEveryProxyInTheOrderOfIndices) {
    const CaughtMessages messages;
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 20; ++i) {
        ids.push_back(grid.add(i == 7 ? nanCube() : cubeAt(i)));
    }
    grid.remove(ids[3]);
    ids.erase(ids.begin() + 3);
    std::vector<ProxyId> visited;
    grid.forEach([&](ProxyId id, const Box&) { visited.push_back(id); });
    EXPECT_EQ(visited, ids);
}

// --- What an update costs ------------------------------------------------------------------------

TEST(GridUpdate, AnUnchangedMoveMarksNothing) {
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 300; ++i) {
        ids.push_back(grid.add(cubeAt(i), i % 2 == 0 ? Mobility::mobile : Mobility::resting));
    }
    EXPECT_EQ(grid.update().changed, 300U);
    for (int frame = 0; frame < 30; ++frame) {
        for (int i = 0; i < 300; ++i) {
            grid.move(ids[static_cast<std::size_t>(i)], cubeAt(i));
        }
        const UpdateCost cost = grid.update();
        EXPECT_EQ(cost.changed, 0U);
        EXPECT_EQ(cost.filed, 0U);
    }
}

TEST(GridUpdate, CountsEachChangedProxyOnce) {
    Grid<float> grid;
    const ProxyId a = grid.add(cubeAt(0));
    const ProxyId b = grid.add(cubeAt(1));
    grid.update();
    grid.move(a, cubeAt(2));
    grid.move(a, cubeAt(3));
    EXPECT_EQ(grid.update().changed, 1U);
    grid.move(a, cubeAt(4));
    grid.remove(b);
    EXPECT_EQ(grid.update().changed, 2U);
}

TEST(GridProxies, MayBeAddedWithTheBoxOfAnotherOne) {
    Grid<float> grid;
    const ProxyId first = grid.add(cubeAt(1));
    for (int i = 0; i < 300; ++i) {
        const ProxyId copy = grid.add(grid.box(first));  // records move now and then
        ASSERT_EQ(grid.box(copy).min(), cubeAt(1).min()) << "copy " << i;
    }
}

TEST(GridProxies, HaveRoomThoughAsManyHaveJustBeenRemoved) {
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 128; ++i) {
        ids.push_back(grid.add(cubeAt(i)));
    }
    grid.update();
    for (const ProxyId id : ids) {
        grid.remove(id);
    }
    grid.reserve(128);
    const std::size_t bytes = grid.memoryBytes();
    for (int i = 0; i < 128; ++i) {
        static_cast<void>(grid.add(cubeAt(i)));
    }
    EXPECT_EQ(grid.memoryBytes(), bytes);
}

TEST(GridProxies, AreVisitedWithoutThoseThatAreAddedOnTheWay) {
    Grid<float> grid;
    for (int i = 0; i < 3; ++i) {
        static_cast<void>(grid.add(cubeAt(i)));
    }
    int visited = 0;
    grid.forEach([&](ProxyId, const Aabb<float>& box) {
        static_cast<void>(grid.add(box));
        ASSERT_LT(++visited, 100);
    });
    EXPECT_EQ(visited, 3);
    EXPECT_EQ(grid.size(), 6U);
}

/// Cubes along a line. Whether all are filed by an update, or by queries after changes.
std::vector<ProxyId> fileCubes(Grid<float>& grid, bool byQueries) {
    std::vector<ProxyId> ids;
    for (int i = 0; i < 300; ++i) {
        ids.push_back(grid.add(cubeAt(2 * i)));
    }
    grid.update();
    for (std::size_t i = 0; i < ids.size() && byQueries; ++i) {
        grid.move(ids[i], cubeAt(2 * static_cast<double>(i) + 0.5));
    }
    const std::uint64_t filings = grid.filingCount();
    for (int i = 0; i < 1000 && byQueries && grid.filingCount() == filings; ++i) {
        countIn(grid, cubeAt(0));
    }
    EXPECT_EQ(grid.filingCount(), filings + (byQueries ? 1 : 0));
    return ids;
}

TEST(GridCallback, IsOfferedWhatItHasMovedWhereItIsNow) {
    struct MoveAllButTheLast {
        void add(ProxyId id, float /*key*/) {
            found.push_back(id);
            if (found.size() == 1) {
                for (std::size_t i = 0; i + 1 < ids.size(); ++i) {
                    grid.move(ids[i], cubeAt(100000 + 2 * static_cast<double>(i)));
                }
            }
        }
        [[nodiscard]] static double limit() { return std::numeric_limits<double>::infinity(); }
        Grid<float>& grid;
        const std::vector<ProxyId>& ids;
        std::vector<ProxyId> found = {};
    };
    for (const bool byQueries : {false, true}) {
        Grid<float> grid;
        const std::vector<ProxyId> ids = fileCubes(grid, byQueries);
        MoveAllButTheLast collector{grid, ids};
        grid.visit(BoxRegion<float>{makeBox<float>(-10, -10, -10, 1000, 10, 10)}, collector);
        EXPECT_LE(collector.found.size(), 2U);
        EXPECT_EQ(collector.found.back(), ids.back());
        EXPECT_EQ(countIn(grid, makeBox<float>(-10, -10, -10, 1000, 10, 10)), 1U);
        EXPECT_EQ(grid.validate(), "");
    }
}

TEST(GridCallback, IsOfferedTheKeyOfWhereThingsAreNow) {
    struct MoveAll {
        void add(ProxyId id, float key) {
            EXPECT_EQ(key, region.key(grid.box(id)));
            if (++offered == 1) {
                for (const ProxyId each : ids) {
                    grid.move(each, cubeAt(grid.box(each).min().x() + 7));
                }
            }
        }
        [[nodiscard]] static double limit() { return std::numeric_limits<double>::infinity(); }
        Grid<float>& grid;
        const std::vector<ProxyId>& ids;
        SphereRegion<float> region{{0, 0, 0}, 1000};
        std::size_t offered = 0;
    };
    for (const bool byQueries : {false, true}) {
        Grid<float> grid;
        const std::vector<ProxyId> ids = fileCubes(grid, byQueries);
        MoveAll collector{grid, ids};
        grid.visit(SphereRegion<float>({0, 0, 0}, 1000), collector);
        EXPECT_GT(collector.offered, 100U);
        EXPECT_EQ(grid.validate(), "");
    }
}

TEST(GridUpdate, TellsHowManyShareACell) {
    Grid<float> grid({.cellSize = 2});
    EXPECT_EQ(grid.update().largestCell, 0U);
    std::vector<ProxyId> together;
    for (int i = 0; i < 1000; ++i) {
        together.push_back(grid.add(cubeAt(0), Mobility::resting));
        static_cast<void>(grid.add(cubeAt(100 + 10 * i)));
    }
    EXPECT_EQ(grid.update().largestCell, 1000U);
    EXPECT_EQ(grid.update().largestCell, 1000U) << "though nothing has changed";
    for (const ProxyId id : together) {
        grid.move(id, cubeAt(1));
    }
    EXPECT_EQ(grid.update().largestCell, 1000U) << "of those that move";
    for (const ProxyId id : together) {
        grid.remove(id);
    }
    EXPECT_EQ(grid.update().largestCell, 1U);
}

TEST(GridUpdate, LeavesRestingProxiesAlone) {
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 1000; ++i) {
        ids.push_back(grid.add(cubeAt(2 * i)));
    }
    for (int frame = 0; frame < 30; ++frame) {
        for (std::size_t i = 0; i < 10; ++i) {
            grid.move(ids[i], cubeAt(-5 - frame - 3 * static_cast<double>(i)));
        }
        const UpdateCost cost = grid.update();
        EXPECT_EQ(cost.changed, frame == 0 ? 1000U : 10U);
        if (frame > 10) {
            EXPECT_EQ(cost.filed, 10U);
            EXPECT_EQ(cost.resting, 990U);
        }
        ASSERT_EQ(grid.validate(), "");
    }
    // One of them wakes: it is filed among the ten, the others stay where they are.
    grid.move(ids[500], cubeAt(-900));
    const UpdateCost cost = grid.update();
    EXPECT_EQ(cost.filed, 11U);
    EXPECT_EQ(cost.resting, 989U);
    EXPECT_EQ(countIn(grid, cubeAt(1000)), 0U);
    EXPECT_EQ(countIn(grid, cubeAt(-900)), 1U);
    EXPECT_EQ(grid.validate(), "");
}

TEST(GridUpdate, PutsToRestAtOnceWhatIsSaidToRestUnlessItMoved) {
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 100; ++i) {
        ids.push_back(grid.add(cubeAt(2 * i), Mobility::resting));
    }
    const ProxyId mover = grid.add(cubeAt(-2));
    EXPECT_EQ(grid.update().resting, 0U);
    grid.move(mover, cubeAt(-3));
    EXPECT_EQ(grid.update().resting, 100U);
    for (int i = 0; i < 50; ++i) {
        grid.move(ids[static_cast<std::size_t>(i)], cubeAt(2 * i + 0.5));
    }
    EXPECT_EQ(grid.update().resting, 50U);
    grid.move(mover, cubeAt(-4));
    EXPECT_EQ(grid.update().resting, 50U);
    for (int frame = 0; frame < 10; ++frame) {
        grid.move(mover, cubeAt(-5 - frame));
        grid.update();
    }
    grid.move(mover, cubeAt(-20));
    EXPECT_EQ(grid.update().resting, 100U);
}

TEST(GridUpdate, ManyRestingProxiesMayLeaveAtOnce) {
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 1000; ++i) {
        ids.push_back(grid.add(cubeAt(2 * i), Mobility::resting));
    }
    for (int frame = 0; frame < 5; ++frame) {
        grid.move(ids[0], cubeAt(-9 - frame));
        grid.update();
    }
    for (std::size_t i = 0; i < 1000; i += 2) {
        grid.remove(ids[i]);
    }
    EXPECT_EQ(grid.validate(), "");
    for (int frame = 0; frame < 5; ++frame) {
        grid.move(ids[1], cubeAt(-9 - frame));
        grid.update();
        ASSERT_EQ(grid.validate(), "");
        EXPECT_EQ(countIn(grid, makeBox<float>(-50, 0, 0, 3000, 1, 1)), 500U);
    }
}

// --- Bad data ------------------------------------------------------------------------------------

TEST(GridNan, IsReportedOnceAndCounted) {
    const CaughtMessages messages;
    Grid<float> grid;
    const ProxyId a = grid.add(cubeAt(0));
    EXPECT_TRUE(messages.all().empty());
    grid.move(a, nanCube());
    const ProxyId b = grid.add(nanCube());
    ASSERT_EQ(messages.all().size(), 1U);
    EXPECT_NE(messages.all()[0].find("NaN"), std::string::npos);
    EXPECT_EQ(grid.nanCount(), 2U);
    EXPECT_EQ(grid.size(), 2U);
    grid.move(a, cubeAt(0));
    EXPECT_EQ(grid.nanCount(), 1U);
    grid.remove(b);
    EXPECT_EQ(grid.nanCount(), 0U);
    grid.move(a, nanCube());
    EXPECT_EQ(messages.all().size(), 1U);
}

TEST(GridNan, InAnyFieldHidesTheBoxAndHarmsNoOther) {
    const CaughtMessages messages;
    for (int field = 0; field < 6; ++field) {
        Grid<float> grid;
        const ProxyId good = grid.add(cubeAt(0.5));
        const ProxyId bad = grid.add(cubeAt(0));
        for (int phase = 0; phase < 3; ++phase) {
            Box box = cubeAt(0);
            (field < 3 ? box.min() : box.max())[field % 3] = kNanCoordinate;
            grid.move(bad, box);
            EXPECT_EQ(countIn(grid, makeBox<float>(-9, -9, -9, 9, 9, 9)), 1U);
            if (phase > 0) {
                grid.update();
            }
            EXPECT_EQ(countIn(grid, makeBox<float>(-9, -9, -9, 9, 9, 9)), 1U);
            EXPECT_TRUE(hasNan(grid.box(bad)));
            EXPECT_EQ(grid.validate(), "");
            grid.move(bad, cubeAt(0));
            EXPECT_EQ(countIn(grid, makeBox<float>(-9, -9, -9, 9, 9, 9)), 2U);
        }
        EXPECT_TRUE(grid.contains(good));
    }
}

TEST(GridNan, AllProxiesMayHaveIt) {
    const CaughtMessages messages;
    Grid<float> grid;
    for (int i = 0; i < 200; ++i) {
        static_cast<void>(grid.add(nanCube(), i % 2 == 0 ? Mobility::mobile : Mobility::resting));
    }
    for (int i = 0; i < 12; ++i) {
        grid.update();
        EXPECT_EQ(countIn(grid, makeBox<float>(-9, -9, -9, 9, 9, 9)), 0U);
        EXPECT_EQ(grid.validate(), "");
    }
    EXPECT_EQ(grid.nanCount(), 200U);
}

// --- Accounts and misuse -------------------------------------------------------------------------

TEST(Grid, MemoryIsGivenAndGrowsWithTheProxies) {
    Grid<float> grid;
    EXPECT_GE(grid.memoryBytes(), sizeof(grid));
    for (int i = 0; i < 10000; ++i) {
        static_cast<void>(grid.add(cubeAt(i)));
    }
    grid.update();
    EXPECT_GE(grid.memoryBytes(), 10000 * 2 * sizeof(Box));
    EXPECT_LT(grid.memoryBytes(), 10000U * 500U);
}

#if HASHPHASE_ENABLE_ASSERTS
TEST(Grid, MisuseOfIdsIsAsserted) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    EXPECT_THROW(grid.move({}, cubeAt(0)), BrokenAssert);
    EXPECT_THROW(grid.remove({}), BrokenAssert);
    EXPECT_THROW(static_cast<void>(grid.box({})), BrokenAssert);
    const ProxyId id = grid.add(cubeAt(0));
    grid.remove(id);
    EXPECT_THROW(grid.remove(id), BrokenAssert);
    EXPECT_THROW(grid.move(id, cubeAt(1)), BrokenAssert);
    EXPECT_THROW(static_cast<void>(grid.box(id)), BrokenAssert);
    EXPECT_THROW(static_cast<void>(grid.cellsOf(id)), BrokenAssert);
    EXPECT_THROW(grid.move({77, 1}, cubeAt(1)), BrokenAssert);
    grid.update();
    static_cast<void>(grid.add(cubeAt(0)));
    EXPECT_THROW(grid.remove(id), BrokenAssert);
    EXPECT_EQ(grid.size(), 1U);
    EXPECT_EQ(grid.validate(), "");
}

TEST(Grid, CellsOfWhatIsNotFiniteAreAsserted) {
    const CaughtMessages messages;
    const ThrowingAsserts throwing;
    Grid<float> grid;
    const ProxyId nan = grid.add(nanCube());
    EXPECT_THROW(static_cast<void>(grid.cellsOf(nan)), BrokenAssert);
    EXPECT_THROW(static_cast<void>(grid.cellAt({kNanCoordinate, 0, 0})), BrokenAssert);
    EXPECT_THROW(static_cast<void>(grid.cellAt({0, std::numeric_limits<float>::infinity(), 0})),
                 BrokenAssert);
}
#endif

}  // namespace
}  // namespace hashphase::test
