// SPDX-License-Identifier: Zlib

// Life in the grid: proxies come, move, rest and go. What queries find is in grid_query_test.cpp.

#include <broadphase/grid.hpp>
#include <tests/broadphase/grid_cubes.hpp>
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

Box nanCube() {
    Box box = rowCube(0);
    box.min()[2] = kNanCoordinate;
    return box;
}

TEST(Grid, GivesEveryProxyAnIdOfItsOwnAndKeepsItsBox) {
    Grid<float> grid;
    std::set<ProxyId> ids;
    for (int i = 0; i < 100; ++i) {
        const ProxyId id = grid.add(rowCube(i));
        EXPECT_FALSE(id.isNull());
        EXPECT_TRUE(ids.insert(id).second);
        EXPECT_TRUE(grid.contains(id));
        EXPECT_EQ(grid.box(id).min(), rowCube(i).min());
        EXPECT_LT(id.index, 100U);
    }
    EXPECT_EQ(grid.size(), 100U);
    EXPECT_EQ(grid.validate(), "");
}

TEST(Grid, ForgetsARemovedProxyForEver) {
    Grid<float> grid;
    const ProxyId old = grid.add(rowCube(0));
    grid.remove(old);
    EXPECT_FALSE(grid.contains(old));
    EXPECT_EQ(grid.size(), 0U);
    EXPECT_EQ(countWithinBox(grid, rowCube(0)), 0U);
    for (int i = 0; i < 10; ++i) {
        grid.update();
        const ProxyId id = grid.add(rowCube(0));
        EXPECT_NE(id, old);
        EXPECT_FALSE(grid.contains(old));
        EXPECT_EQ(countWithinBox(grid, rowCube(0)), 1U);
        grid.remove(id);
        EXPECT_EQ(grid.validate(), "");
    }
}

TEST(Grid, UsesSlotsAgainSoThatIndicesStayBelowTheMostEverAlive) {
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 50; ++i) {
        ids.push_back(grid.add(rowCube(i)));
    }
    for (int frame = 0; frame < 40; ++frame) {
        for (int i = 0; i < 10; ++i) {
            grid.remove(ids.back());
            ids.pop_back();
        }
        grid.update();
        for (int i = 0; i < 10; ++i) {
            ids.push_back(grid.add(rowCube(i)));
            EXPECT_LT(ids.back().index, 50U);
        }
    }
    EXPECT_EQ(grid.validate(), "");
}

TEST(Grid, ContainsNeitherNullNorStrangeIds) {
    Grid<float> grid;
    EXPECT_FALSE(grid.contains({}));
    const ProxyId id = grid.add(rowCube(0));
    EXPECT_FALSE(grid.contains({id.index, id.generation + 1}));
    EXPECT_FALSE(grid.contains({id.index + 1, id.generation}));
    EXPECT_FALSE(grid.contains({id.index, 0}));
    EXPECT_FALSE(grid.contains({0xffffffffU, 0xffffffffU}));
}

TEST(Grid, LeadsFromAnIndexBackToTheProxyAliveThatHasIt) {
    Grid<float> grid;
    EXPECT_TRUE(grid.idAt(0).isNull());
    const ProxyId first = grid.add(rowCube(0));
    const ProxyId second = grid.add(rowCube(1));
    EXPECT_EQ(grid.idAt(first.index), first);
    EXPECT_EQ(grid.idAt(second.index), second);
    EXPECT_TRUE(grid.idAt(grid.indexLimit()).isNull());
    grid.remove(first);
    EXPECT_TRUE(grid.idAt(first.index).isNull());
    grid.update();
    const ProxyId third = grid.add(rowCube(2));
    EXPECT_EQ(third.index, first.index);
    EXPECT_EQ(grid.idAt(first.index), third);
}

TEST(ProxyId, IsAKeyOfUnorderedMaps) {
    Grid<float> grid;
    std::unordered_map<ProxyId, int> names;
    std::set<std::size_t> hashes;
    for (int i = 0; i < 100; ++i) {
        const ProxyId id = grid.add(rowCube(i));
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
        ids.push_back(grid.add(i == 7 ? nanCube() : rowCube(i)));
    }
    grid.remove(ids[3]);
    ids.erase(ids.begin() + 3);
    std::vector<ProxyId> visited;
    grid.forEach([&](ProxyId id, const Box&) { visited.push_back(id); });
    EXPECT_EQ(visited, ids);
}

// --- Bad data ------------------------------------------------------------------------------------

TEST(GridNan, IsReportedOnceAndCounted) {
    const CaughtMessages messages;
    Grid<float> grid;
    const ProxyId a = grid.add(rowCube(0));
    EXPECT_TRUE(messages.all().empty());
    grid.move(a, nanCube());
    const ProxyId b = grid.add(nanCube());
    ASSERT_EQ(messages.all().size(), 1U);
    EXPECT_NE(messages.all()[0].find("NaN"), std::string::npos);
    EXPECT_EQ(grid.nanCount(), 2U);
    EXPECT_EQ(grid.size(), 2U);
    grid.move(a, rowCube(0));
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
        const ProxyId good = grid.add(rowCube(0.5));
        const ProxyId bad = grid.add(rowCube(0));
        for (int phase = 0; phase < 3; ++phase) {
            Box box = rowCube(0);
            (field < 3 ? box.min() : box.max())[field % 3] = kNanCoordinate;
            grid.move(bad, box);
            EXPECT_EQ(countWithinBox(grid, makeBox<float>(-9, -9, -9, 9, 9, 9)), 1U);
            if (phase > 0) {
                grid.update();
            }
            EXPECT_EQ(countWithinBox(grid, makeBox<float>(-9, -9, -9, 9, 9, 9)), 1U);
            EXPECT_TRUE(hasNan(grid.box(bad)));
            EXPECT_EQ(grid.validate(), "");
            grid.move(bad, rowCube(0));
            EXPECT_EQ(countWithinBox(grid, makeBox<float>(-9, -9, -9, 9, 9, 9)), 2U);
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
        EXPECT_EQ(countWithinBox(grid, makeBox<float>(-9, -9, -9, 9, 9, 9)), 0U);
        EXPECT_EQ(grid.validate(), "");
    }
    EXPECT_EQ(grid.nanCount(), 200U);
}

// --- Accounts and misuse -------------------------------------------------------------------------

TEST(Grid, MemoryIsGivenAndGrowsWithTheProxies) {
    Grid<float> grid;
    EXPECT_GE(grid.memoryBytes(), sizeof(grid));
    for (int i = 0; i < 10000; ++i) {
        static_cast<void>(grid.add(rowCube(i)));
    }
    grid.update();
    EXPECT_GE(grid.memoryBytes(), 10000 * 2 * sizeof(Box));
    EXPECT_LT(grid.memoryBytes(), 10000U * 500U);
}

#if HASHPHASE_ENABLE_ASSERTS
TEST(Grid, MisuseOfIdsIsAsserted) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    EXPECT_THROW(grid.move({}, rowCube(0)), BrokenAssert);
    EXPECT_THROW(grid.remove({}), BrokenAssert);
    EXPECT_THROW(static_cast<void>(grid.box({})), BrokenAssert);
    const ProxyId id = grid.add(rowCube(0));
    grid.remove(id);
    EXPECT_THROW(grid.remove(id), BrokenAssert);
    EXPECT_THROW(grid.move(id, rowCube(1)), BrokenAssert);
    EXPECT_THROW(static_cast<void>(grid.box(id)), BrokenAssert);
    EXPECT_THROW(static_cast<void>(grid.cellsOf(id)), BrokenAssert);
    EXPECT_THROW(grid.move({77, 1}, rowCube(1)), BrokenAssert);
    grid.update();
    static_cast<void>(grid.add(rowCube(0)));
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
