// SPDX-License-Identifier: Zlib

// Life in the grid: proxies come, move, rest and go, and what an update of that costs. What queries find is in
// grid_query_test.cpp; all of it at random in tests/fuzz.

#include <broadphase/grid.hpp>
#include <broadphase/grid_config.hpp>
#include <broadphase/pairs.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

namespace hashphase::test {
namespace {

Aabb<float> rowCube(double x) {
    return makeBox<float>(x, 0, 0, x + 1, 1, 1);
}

Aabb<float> nanCube() {
    return makeBox<float>(0, 0, std::numeric_limits<double>::quiet_NaN(), 1, 1, 1);
}

std::size_t countIn(const Grid<float>& grid, const Aabb<float>& box) {
    return find(grid, BoxRegion<float>{box}).size();
}

TEST(Grid, HasAProxyUntilItIsRemovedAndItsIdNeverAgain) {
    Grid<float> grid;
    EXPECT_FALSE(grid.contains({}));
    EXPECT_TRUE(grid.idAt(0).isNull());
    const ProxyId first = grid.add(rowCube(0));
    const ProxyId second = grid.add(rowCube(1));
    EXPECT_FALSE(first.isNull());
    EXPECT_NE(first, second);
    EXPECT_TRUE(grid.contains(first));
    EXPECT_EQ(grid.box(second).min(), rowCube(1).min());
    EXPECT_EQ(grid.idAt(second.index), second);
    EXPECT_TRUE(grid.idAt(grid.indexLimit()).isNull());
    for (const ProxyId strange : {ProxyId{first.index, first.generation + 1},
                                  {second.index + 1, second.generation},
                                  {first.index, 0},
                                  {0xffffffffU, 0xffffffffU}}) {
        EXPECT_FALSE(grid.contains(strange));
    }
    grid.remove(first);
    for (int i = 0; i < 10; ++i) {
        EXPECT_FALSE(grid.contains(first));
        EXPECT_TRUE(grid.idAt(first.index).isNull());
        EXPECT_EQ(grid.size(), 1U);
        grid.update();
        const ProxyId next = grid.add(rowCube(0));
        EXPECT_EQ(next.index, first.index) << "indices are used again";
        EXPECT_EQ(grid.idAt(first.index), next);
        EXPECT_EQ(countIn(grid, rowCube(0)), 2U);
        grid.remove(next);
    }
}

TEST(ProxyId, IsAKeyOfUnorderedMaps) {
    std::unordered_map<ProxyId, std::uint32_t> names;
    std::set<std::size_t> hashes;
    for (std::uint32_t i = 0; i < 200; ++i) {
        const ProxyId id{i / 2, 1 + i % 2 * 2};
        names[id] = i;
        hashes.insert(std::hash<ProxyId>{}(id));
        EXPECT_EQ(names.at(id), i);
    }
    EXPECT_EQ(names.size(), 200U);
    EXPECT_EQ(hashes.size(), 200U);
}

TEST(Grid, TakesTheBoxOfAnotherProxyForANewOne) {
    Grid<float> grid;
    const ProxyId first = grid.add(rowCube(1));
    for (int i = 0; i < 300; ++i) {
        const ProxyId copy = grid.add(grid.box(first));  // records move now and then
        ASSERT_EQ(grid.box(copy).min(), rowCube(1).min()) << "copy " << i;
    }
}

TEST(Grid, ReportsNanOnceAndCountsIt) {
    const CaughtMessages messages;
    Grid<float> grid;
    const ProxyId a = grid.add(rowCube(0));
    EXPECT_TRUE(messages.all().empty());
    grid.move(a, nanCube());
    const ProxyId b = grid.add(nanCube());
    ASSERT_EQ(messages.all().size(), 1U);
    EXPECT_NE(messages.all()[0].find("NaN"), std::string::npos);
    EXPECT_EQ(grid.nanCount(), 2U);
    grid.move(a, rowCube(0));
    grid.remove(b);
    EXPECT_EQ(grid.nanCount(), 0U);
    grid.move(a, nanCube());
    EXPECT_EQ(messages.all().size(), 1U);
    // All may have it, said to rest or not.
    for (int i = 0; i < 200; ++i) {
        static_cast<void>(grid.add(nanCube(), i % 2 == 0 ? Mobility::mobile : Mobility::resting));
    }
    for (int i = 0; i < 12; ++i) {
        grid.update();
        EXPECT_EQ(countIn(grid, makeBox<float>(-9, -9, -9, 9, 9, 9)), 0U);
        EXPECT_EQ(grid.validate(), "");
    }
    EXPECT_EQ(grid.nanCount(), 201U);
}

// --- Updates -------------------------------------------------------------------------------------

/// Cubes in a row, two metres apart.
struct GridUpdate : testing::Test {
    void addRow(int count, Mobility mobility = Mobility::mobile) {
        for (int i = 0; i < count; ++i) {
            row.add(rowCube(2 * i), mobility);
        }
    }
    UpdateCost update() { return row.grid.update(); }

    Population<float> row;
};

TEST_F(GridUpdate, CountsEachChangedProxyOnceAndAnUnchangedMoveNot) {
    addRow(150);
    addRow(150, Mobility::resting);
    EXPECT_EQ(update().changed, 300U);
    for (int frame = 0; frame < 30; ++frame) {
        for (std::size_t i = 0; i < 300; ++i) {
            row.moveTo(i, Aabb<float>(row.proxies[i].box));
        }
        const UpdateCost cost = update();
        EXPECT_EQ(cost.changed, 0U);
        EXPECT_EQ(cost.filed, 0U);
    }
    row.moveTo(0, rowCube(2));
    row.moveTo(0, rowCube(3));
    EXPECT_EQ(update().changed, 1U);
    row.moveTo(0, rowCube(4));
    row.removeAt(1);
    EXPECT_EQ(update().changed, 2U);
}

TEST_F(GridUpdate, TellsHowManyShareACell) {
    Population<float> world(GridConfig{.cellSize = 2});
    EXPECT_EQ(world.grid.update().largestCell, 0U);
    for (int i = 0; i < 1000; ++i) {
        world.add(rowCube(0), Mobility::resting);
    }
    for (int i = 0; i < 1000; ++i) {
        world.add(rowCube(100 + 10 * i));
    }
    EXPECT_EQ(world.grid.update().largestCell, 1000U);
    EXPECT_EQ(world.grid.update().largestCell, 1000U) << "though nothing has changed";
    for (std::size_t i = 0; i < 1000; ++i) {
        world.moveTo(i, rowCube(1));
    }
    EXPECT_EQ(world.grid.update().largestCell, 1000U) << "of those that move";
    world.keepOnly([](std::size_t i) { return i >= 1000; });
    EXPECT_EQ(world.grid.update().largestCell, 1U);
}

TEST_F(GridUpdate, LeavesRestingProxiesAlone) {
    addRow(1000);
    for (int frame = 0; frame < 30; ++frame) {
        for (std::size_t i = 0; i < 10; ++i) {
            row.moveTo(i, rowCube(-5 - frame - 3 * static_cast<double>(i)));
        }
        const UpdateCost cost = update();
        EXPECT_EQ(cost.changed, frame == 0 ? 1000U : 10U);
        if (frame > 10) {
            EXPECT_EQ(cost.filed, 10U);
            EXPECT_EQ(cost.resting, 990U);
        }
        ASSERT_EQ(row.grid.validate(), "");
    }
    // One of them wakes: it is filed among the ten, the others stay where they are.
    row.moveTo(500, rowCube(-900));
    const UpdateCost cost = update();
    EXPECT_EQ(cost.filed, 11U);
    EXPECT_EQ(cost.resting, 989U);
    EXPECT_EQ(countIn(row.grid, rowCube(1000)), 0U);
    EXPECT_EQ(countIn(row.grid, rowCube(-900)), 1U);
    // And many leave at once.
    row.keepOnly([](std::size_t i) { return i % 2 == 0; });
    EXPECT_EQ(row.grid.validate(), "");
    row.moveTo(0, rowCube(-800));
    update();
    EXPECT_EQ(row.grid.validate(), "");
    EXPECT_EQ(countIn(row.grid, makeBox<float>(-2000, 0, 0, 3000, 1, 1)), 500U);
}

TEST_F(GridUpdate, PutsToRestAtOnceWhatIsSaidToRestUnlessItMoved) {
    addRow(100, Mobility::resting);
    row.add(rowCube(-2));
    int at = -2;
    const auto restingAfterAMove = [&] {
        row.moveTo(100, rowCube(--at));
        return update().resting;
    };
    EXPECT_EQ(update().resting, 0U);
    EXPECT_EQ(restingAfterAMove(), 100U);
    for (std::size_t i = 0; i < 50; ++i) {
        row.moveTo(i, rowCube(2 * static_cast<double>(i) + 0.5));
    }
    EXPECT_EQ(update().resting, 50U);
    EXPECT_EQ(restingAfterAMove(), 50U);
    for (int frame = 0; frame < 10; ++frame) {
        restingAfterAMove();
    }
    EXPECT_EQ(restingAfterAMove(), 100U);
}

// --- Configurations ------------------------------------------------------------------------------

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The sentence names the field, the value's valid range, and is what the constructors throw.
void expectRefused(const GridConfig& config, const std::string& field, const std::string& range) {
    const std::string error = configError(config);
    EXPECT_NE(error.find(field), std::string::npos) << error;
    EXPECT_NE(error.find(range), std::string::npos) << error;
    const auto expectThrow = [&](auto construct) {
        try {
            construct();
            ADD_FAILURE() << "accepted: " << error;
        } catch (const std::invalid_argument& refused) {
            EXPECT_EQ(refused.what(), error);
        }
    };
    expectThrow([&] { const Grid<float> grid(config); });
    expectThrow([&] { const Grid<double> grid(config); });
}

TEST(GridConfig, IsRefusedWithASentenceWhereANumberIsOutOfItsRange) {
    for (const double bad : {-1.0, -1e-40, 9e-31, 1.1e30, kInfinity, -kInfinity, kNan}) {
        expectRefused({.cellSize = bad}, "cellSize",
                      "0 (choose automatically) or between 1e-30 and 1e30 [m]");
    }
    for (const double bad : {0.0, 1.0, 1.999, 64.1, -4.0, kInfinity, kNan}) {
        expectRefused({.levelRatio = bad}, "levelRatio", "between 2 and 64");
    }
    for (const std::uint32_t bad : {0U, 1'000'001U, std::numeric_limits<std::uint32_t>::max()}) {
        expectRefused({.updatesBeforeRest = bad}, "updatesBeforeRest", "between 1 and 1000000");
    }
    for (const double bad : {-1e-9, 1.1e30, kInfinity, kNan}) {
        expectRefused({.slack = bad}, "slack",
                      "empty (follow each proxy's motion) or between 0 and 1e30 [m]");
    }
    std::vector<GridConfig> accepted{
        {}, {.updatesBeforeRest = 1}, {.updatesBeforeRest = 1'000'000}};
    for (const double good : {0.0, -0.0, 1e-30, 1e-3, 1.0, 1e30}) {
        accepted.push_back({.cellSize = good});
    }
    for (const double good : {0.0, 1e-9, 1e30}) {
        accepted.push_back({.slack = good});
    }
    for (const double good : {2.0, 2.5, 64.0}) {
        accepted.push_back({.levelRatio = good});
    }
    for (const GridConfig& config : accepted) {
        EXPECT_EQ(configError(config), "");
        const Grid<float> asFloat(config);
        const Grid<double> asDouble(config);
    }
}

// --- Where numbers that are counted up come round ------------------------------------------------

struct LongLimits : testing::Test {
    void SetUp() override {
        if (std::getenv("HASHPHASE_LONG_TESTS") == nullptr) {
            GTEST_SKIP() << "takes minutes; set HASHPHASE_LONG_TESTS";
        }
    }
    Grid<float> grid;
    const Aabb<float> box = makeBox<float>(0, 0, 0, 1, 1, 1);
};

TEST_F(LongLimits, OfTheNumbersOfUpdatesAreNotNoticed) {
    Pairs<float> pairs(grid);
    static_cast<void>(grid.add(box, Mobility::resting));
    static_cast<void>(grid.add(box));
    const ProxyId mover = grid.add(box);
    EXPECT_EQ(pairs.update().born.size(), 3U);
    for (std::uint64_t update = 0; update < (std::uint64_t{1} << 32) + 1000; ++update) {
        if ((update & 0xffffff) < 20 || update + 1000 > (std::uint64_t{1} << 32)) {
            const auto y = static_cast<double>(update % 2) / 2;
            grid.move(mover, makeBox<float>(0, y, 0, 1, y + 1, 1));
        }
        const PairChanges changes = pairs.update();
        ASSERT_EQ(changes.born.size() + changes.died.size(), 0U) << update;
    }
    EXPECT_EQ(pairs.count(), 3U);
    EXPECT_EQ(grid.validate(), "");
    EXPECT_EQ(pairs.validate(), "");
}

TEST_F(LongLimits, OfIdsAreReachedWithoutOneThatNamesTwoProxies) {
    const ProxyId first = grid.add(box);
    ProxyId id = first;
    std::uint64_t count = 0;
    for (; id.index == first.index; ++count) {
        grid.remove(id);
        ASSERT_FALSE(grid.contains(id));
        grid.update();
        id = grid.add(box);
        ASSERT_FALSE(grid.contains(first));
    }
    EXPECT_EQ(count, (std::uint64_t{1} << 31) - 1);
    EXPECT_EQ(grid.size(), 1U);
    EXPECT_EQ(grid.validate(), "");
}

}  // namespace
}  // namespace hashphase::test
