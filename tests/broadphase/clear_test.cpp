// SPDX-License-Identifier: Zlib

// What is cleared is as new: the same calls have the same results, in the same order, at the same cost.

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class Clear : public testing::Test {
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Clear, Scalars);

/// A World for scripts that writes down all that it is told, by index, and what everything costs.
template <class Scalar>
struct ToldWorld {
    explicit ToldWorld(const GridConfig& config = {}, bool hasPairs = true) : grid(config) {
        if (hasPairs) {
            sweeps = std::make_unique<Sweeps<Scalar>>(grid);
            pairs = std::make_unique<Pairs<Scalar>>(grid, sweeps.get());
        }
    }
    ProxyId add(const Aabb<Scalar>& box, Mobility mobility) {
        const ProxyId id = grid.add(box, mobility);
        told << id.index << ' ';
        if (sweeps != nullptr && id.index % 7 == 0) {
            sweeps->set(id, box.sizes() * 5);
        }
        if (pairs != nullptr && findsNow && id.index % 11 == 0) {
            tell(pairs->findPairsNow(id, acceptAllPairs));
        }
        return id;
    }
    void move(ProxyId id, const Aabb<Scalar>& box) { grid.move(id, box); }
    void remove(ProxyId id) { grid.remove(id); }
    static void refilter(ProxyId /*id*/) {}

    void tell(const PairChanges& changes) {
        for (const auto* pairsOf : {&changes.died, &changes.born}) {
            for (const ProxyPair& pair : *pairsOf) {
                told << pair.first.index << '-' << pair.second.index << ' ';
            }
            told << "; ";
        }
    }
    void endFrame() {
        UpdateCost cost;
        if (pairs != nullptr) {
            tell(pairs->update());
            told << pairs->lastCost().boxesTested << ' ' << pairs->lastCost().pairsWatched << ' '
                 << sweeps->lastCost().segments << ' ';
            cost = pairs->lastCost().grid;
        } else {
            cost = grid.update();
        }
        told << cost.changed << ' ' << cost.filed << ' ' << cost.resting << ' ' << cost.largestCell
             << ' ' << grid.cellSize() << ' ';
        std::vector<ProxyId> found;
        CollectAll all(found);
        const auto everywhere = Vector3<Scalar>::Constant(std::numeric_limits<Scalar>::infinity());
        const QueryCost asked = grid.visit(BoxRegion<Scalar>{{-everywhere, everywhere}}, all);
        for (const ProxyId id : found) {  // in the order of the tables
            told << id.index << ' ';
        }
        told << asked.rowsVisited << ' ' << asked.boxesTested << '\n';
    }
    void clear() {
        if (pairs != nullptr) {
            pairs->clear();
        } else {
            grid.clear();
        }
        told.str({});
    }
    [[nodiscard]] std::size_t memoryBytes() const {
        return grid.memoryBytes() + (pairs != nullptr ? pairs->memoryBytes() : 0) +
               (sweeps != nullptr ? sweeps->memoryBytes() : 0);
    }

    Grid<Scalar> grid;
    std::unique_ptr<Sweeps<Scalar>> sweeps;
    std::unique_ptr<Pairs<Scalar>> pairs;
    std::ostringstream told;
    bool findsNow = true;
};

template <class Scalar>
std::string play(ToldWorld<Scalar>& world, const BoxScene<Scalar>& scene, std::uint64_t seed,
                 int frames) {
    ScriptRates rates;
    Script<Scalar> script(scene, seed, rates);
    script.begin(world);
    for (int frame = 0; frame < frames; ++frame) {
        if (frame > 0) {
            script.playFrame(world);
        }
        world.endFrame();
    }
    return world.told.str();
}

TYPED_TEST(Clear, LeavesAGridAndItsPairsAsNewOnes) {
    const auto scenes = allBoxScenes<TypeParam>();
    for (const bool hasPairs : {false, true}) {
        for (std::size_t i = 0; i < scenes.size(); ++i) {
            GridConfig config;
            config.cellSize = i % 4 == 0 ? 1.5 : 0;
            SCOPED_TRACE(testing::Message() << scenes[i].name << ", pairs " << hasPairs);
            ToldWorld<TypeParam> fresh(config, hasPairs);
            const std::string expected = play(fresh, scenes[i], 1, 34);
            // Another scene before it, left with changes that no update has seen.
            ToldWorld<TypeParam> used(config, hasPairs);
            play(used, scenes[(i + 3) % scenes.size()], 5 + i, 13);
            static_cast<void>(
                used.add(boxAround<TypeParam>({1, 2, 3}, {1, 1, 1}), Mobility::mobile));
            for (int times = 0; times < 2; ++times) {
                used.clear();
                EXPECT_EQ(used.grid.validate(), "");
                ASSERT_EQ(play(used, scenes[i], 1, 34), expected);
            }
        }
    }
}

TYPED_TEST(Clear, LeavesNothingToBeFoundAndNoIdValid) {
    for (const bool hasPairs : {false, true}) {
        ToldWorld<TypeParam> world({}, hasPairs);
        world.findsNow = false;
        std::vector<ProxyId> ids;
        for (int round = 0; round < 3; ++round) {
            for (int i = 0; i < 100; ++i) {
                const auto box = boxAround<TypeParam>({i * 0.5, 0, 0}, {1, 1, 1});
                ids.push_back(world.add(box, i % 2 == 0 ? Mobility::mobile : Mobility::resting));
                EXPECT_EQ(ids.back().index, static_cast<std::uint32_t>(i)) << "in a new order";
                if (i % 5 == 4) {
                    world.remove(ids.back());
                    ids.push_back(world.add(box, Mobility::mobile));
                }
            }
            for (int frame = 0; frame < round * 8; ++frame) {
                world.endFrame();
            }
            world.clear();
            EXPECT_EQ(world.grid.size(), 0U);
            CollectCount count;
            world.grid.visit(BoxRegion<TypeParam>{boxAround<TypeParam>({0, 0, 0}, {99, 99, 99})},
                             count);
            EXPECT_EQ(count.count(), 0U);
            EXPECT_TRUE(world.pairs == nullptr || world.pairs->count() == 0);
            static_cast<void>(world.add({}, Mobility::mobile));
            for (const ProxyId id : ids) {
                EXPECT_FALSE(world.grid.contains(id));
            }
            world.clear();
        }
    }
}

TYPED_TEST(Clear, GivesBackTheMemoryOfTablesAndPairs) {
    ToldWorld<TypeParam> world;
    world.endFrame();
    for (int i = 0; i < 20000; ++i) {
        static_cast<void>(
            world.add(boxAround<TypeParam>({i % 100 * 0.9, i / 100 * 0.9, 0}, {0.5, 0.5, 0.5}),
                      Mobility::mobile));
    }
    world.endFrame();
    world.clear();
    const std::size_t perIndex = 20 * sizeof(TypeParam) + 16;  // a record, and three lists' room
    EXPECT_LE(world.memoryBytes(), 2 * 20000 * perIndex + 100'000);
}

#if HASHPHASE_ENABLE_ASSERTS

TEST(ClearMisuse, OfAGridWithPairsAndWithinQueriesIsAsserted) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    static_cast<void>(grid.add(boxAround<float>({0, 0, 0}, {1, 1, 1})));
    struct Clearing {
        void add(ProxyId, float) const { EXPECT_THROW(clear(), BrokenAssert); }
        static float limit() { return 1; }
        std::function<void()> clear;
    };
    const BoxRegion<float> here{boxAround<float>({0, 0, 0}, {1, 1, 1})};
    Clearing clearing{[&] { grid.clear(); }};
    EXPECT_EQ(grid.visit(here, clearing).hits, 1U);
    Pairs<float> pairs(grid);
    EXPECT_THROW(grid.clear(), BrokenAssert);
    clearing.clear = [&] { pairs.clear(); };
    EXPECT_EQ(grid.visit(here, clearing).hits, 1U);
    static_cast<void>(grid.add(boxAround<float>({0, 0, 0}, {1, 1, 1})));
    pairs.update([&](ProxyId, ProxyId) {
        EXPECT_THROW(pairs.clear(), BrokenAssert);
        return true;
    });
    EXPECT_EQ(pairs.count(), 1U);
    pairs.clear();
    EXPECT_EQ(grid.size(), 0U);
}

#endif

}  // namespace
}  // namespace hashphase::test
