// SPDX-License-Identifier: Zlib

// What an update of the grid costs, who rests, and what a callback may do to proxies.

#include <broadphase/grid.hpp>
#include <tests/broadphase/grid_cubes.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

using Box = Aabb<float>;

TEST(GridUpdate, AnUnchangedMoveMarksNothing) {
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 300; ++i) {
        ids.push_back(grid.add(rowCube(i), i % 2 == 0 ? Mobility::mobile : Mobility::resting));
    }
    EXPECT_EQ(grid.update().changed, 300U);
    for (int frame = 0; frame < 30; ++frame) {
        for (int i = 0; i < 300; ++i) {
            grid.move(ids[static_cast<std::size_t>(i)], rowCube(i));
        }
        const UpdateCost cost = grid.update();
        EXPECT_EQ(cost.changed, 0U);
        EXPECT_EQ(cost.filed, 0U);
    }
}

TEST(GridUpdate, CountsEachChangedProxyOnce) {
    Grid<float> grid;
    const ProxyId a = grid.add(rowCube(0));
    const ProxyId b = grid.add(rowCube(1));
    grid.update();
    grid.move(a, rowCube(2));
    grid.move(a, rowCube(3));
    EXPECT_EQ(grid.update().changed, 1U);
    grid.move(a, rowCube(4));
    grid.remove(b);
    EXPECT_EQ(grid.update().changed, 2U);
}

TEST(GridProxies, MayBeAddedWithTheBoxOfAnotherOne) {
    Grid<float> grid;
    const ProxyId first = grid.add(rowCube(1));
    for (int i = 0; i < 300; ++i) {
        const ProxyId copy = grid.add(grid.box(first));  // records move now and then
        ASSERT_EQ(grid.box(copy).min(), rowCube(1).min()) << "copy " << i;
    }
}

TEST(GridProxies, HaveRoomThoughAsManyHaveJustBeenRemoved) {
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 128; ++i) {
        ids.push_back(grid.add(rowCube(i)));
    }
    grid.update();
    for (const ProxyId id : ids) {
        grid.remove(id);
    }
    grid.reserve(128);
    const std::size_t bytes = grid.memoryBytes();
    for (int i = 0; i < 128; ++i) {
        static_cast<void>(grid.add(rowCube(i)));
    }
    EXPECT_EQ(grid.memoryBytes(), bytes);
}

TEST(GridProxies, AreVisitedWithoutThoseThatAreAddedOnTheWay) {
    Grid<float> grid;
    for (int i = 0; i < 3; ++i) {
        static_cast<void>(grid.add(rowCube(i)));
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
        ids.push_back(grid.add(rowCube(2 * i)));
    }
    grid.update();
    for (std::size_t i = 0; i < ids.size() && byQueries; ++i) {
        grid.move(ids[i], rowCube(2 * static_cast<double>(i) + 0.5));
    }
    const std::uint64_t filings = grid.filingCount();
    for (int i = 0; i < 1000 && byQueries && grid.filingCount() == filings; ++i) {
        countWithinBox(grid, rowCube(0));
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
                    grid.move(ids[i], rowCube(100000 + 2 * static_cast<double>(i)));
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
        EXPECT_EQ(countWithinBox(grid, makeBox<float>(-10, -10, -10, 1000, 10, 10)), 1U);
        EXPECT_EQ(grid.validate(), "");
    }
}

TEST(GridCallback, IsOfferedTheKeyOfWhereThingsAreNow) {
    struct MoveAll {
        void add(ProxyId id, float key) {
            EXPECT_EQ(key, region.key(grid.box(id)));
            if (++offered == 1) {
                for (const ProxyId each : ids) {
                    grid.move(each, rowCube(grid.box(each).min().x() + 7));
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
        together.push_back(grid.add(rowCube(0), Mobility::resting));
        static_cast<void>(grid.add(rowCube(100 + 10 * i)));
    }
    EXPECT_EQ(grid.update().largestCell, 1000U);
    EXPECT_EQ(grid.update().largestCell, 1000U) << "though nothing has changed";
    for (const ProxyId id : together) {
        grid.move(id, rowCube(1));
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
        ids.push_back(grid.add(rowCube(2 * i)));
    }
    for (int frame = 0; frame < 30; ++frame) {
        for (std::size_t i = 0; i < 10; ++i) {
            grid.move(ids[i], rowCube(-5 - frame - 3 * static_cast<double>(i)));
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
    grid.move(ids[500], rowCube(-900));
    const UpdateCost cost = grid.update();
    EXPECT_EQ(cost.filed, 11U);
    EXPECT_EQ(cost.resting, 989U);
    EXPECT_EQ(countWithinBox(grid, rowCube(1000)), 0U);
    EXPECT_EQ(countWithinBox(grid, rowCube(-900)), 1U);
    EXPECT_EQ(grid.validate(), "");
}

TEST(GridUpdate, PutsToRestAtOnceWhatIsSaidToRestUnlessItMoved) {
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 100; ++i) {
        ids.push_back(grid.add(rowCube(2 * i), Mobility::resting));
    }
    const ProxyId mover = grid.add(rowCube(-2));
    EXPECT_EQ(grid.update().resting, 0U);
    grid.move(mover, rowCube(-3));
    EXPECT_EQ(grid.update().resting, 100U);
    for (int i = 0; i < 50; ++i) {
        grid.move(ids[static_cast<std::size_t>(i)], rowCube(2 * i + 0.5));
    }
    EXPECT_EQ(grid.update().resting, 50U);
    grid.move(mover, rowCube(-4));
    EXPECT_EQ(grid.update().resting, 50U);
    for (int frame = 0; frame < 10; ++frame) {
        grid.move(mover, rowCube(-5 - frame));
        grid.update();
    }
    grid.move(mover, rowCube(-20));
    EXPECT_EQ(grid.update().resting, 100U);
}

TEST(GridUpdate, ManyRestingProxiesMayLeaveAtOnce) {
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 1000; ++i) {
        ids.push_back(grid.add(rowCube(2 * i), Mobility::resting));
    }
    for (int frame = 0; frame < 5; ++frame) {
        grid.move(ids[0], rowCube(-9 - frame));
        grid.update();
    }
    for (std::size_t i = 0; i < 1000; i += 2) {
        grid.remove(ids[i]);
    }
    EXPECT_EQ(grid.validate(), "");
    for (int frame = 0; frame < 5; ++frame) {
        grid.move(ids[1], rowCube(-9 - frame));
        grid.update();
        ASSERT_EQ(grid.validate(), "");
        EXPECT_EQ(countWithinBox(grid, makeBox<float>(-50, 0, 0, 3000, 1, 1)), 500U);
    }
}

}  // namespace
}  // namespace hashphase::test
