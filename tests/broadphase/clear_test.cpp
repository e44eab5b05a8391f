// SPDX-License-Identifier: Zlib

// What is cleared is as new: the same calls have the same results, in the same order, at the same cost. That it
// is empty, and no old id valid, is among the random operations (tests/fuzz).

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

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
        if (pairs != nullptr && id.index % 11 == 0) {
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
    /// All that is told of a script.
    std::string play(const BoxScene<Scalar>& scene, std::uint64_t seed, int frames) {
        Script<Scalar> script(scene, seed);
        script.begin(*this);
        for (int frame = 0; frame < frames; ++frame) {
            if (frame > 0) {
                script.playFrame(*this);
            }
            endFrame();
        }
        return told.str();
    }

    Grid<Scalar> grid;
    std::unique_ptr<Sweeps<Scalar>> sweeps;
    std::unique_ptr<Pairs<Scalar>> pairs;
    std::ostringstream told;
};

TYPED_TEST(Clear, LeavesAGridAndItsPairsAsNewOnes) {
    const auto scenes = allBoxScenes<TypeParam>();
    for (const bool hasPairs : {false, true}) {
        for (std::size_t i = 0; i < scenes.size(); ++i) {
            SCOPED_TRACE(testing::Message() << scenes[i].name << ", pairs " << hasPairs);
            const GridConfig config{.cellSize = i % 4 == 0 ? 1.5 : 0};
            const std::string expected =
                ToldWorld<TypeParam>(config, hasPairs).play(scenes[i], 1, 34);
            // Another scene before it, left with changes that no update has seen.
            ToldWorld<TypeParam> used(config, hasPairs);
            used.play(scenes[(i + 3) % scenes.size()], 5 + i, 13);
            used.add(boxAround<TypeParam>({1, 2, 3}, {1, 1, 1}), Mobility::mobile);
            for (int times = 0; times < 2; ++times) {
                used.clear();
                EXPECT_EQ(used.grid.validate(), "");
                ASSERT_EQ(used.play(scenes[i], 1, 34), expected);
            }
        }
    }
}

TYPED_TEST(Clear, GivesBackTheMemoryOfTablesAndPairs) {
    ToldWorld<TypeParam> world;
    world.endFrame();
    for (int i = 0; i < 20000; ++i) {
        world.add(boxAround<TypeParam>({i % 100 * 0.9, i / 100 * 0.9, 0}, {0.5, 0.5, 0.5}),
                  Mobility::mobile);
    }
    world.endFrame();
    world.clear();
    const std::size_t perIndex = 20 * sizeof(TypeParam) + 16;  // a record, and three lists' room
    EXPECT_LE(world.grid.memoryBytes() + world.pairs->memoryBytes() + world.sweeps->memoryBytes(),
              2 * 20000 * perIndex + 100'000);
}

}  // namespace
}  // namespace hashphase::test
