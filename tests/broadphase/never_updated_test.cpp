// SPDX-License-Identifier: Zlib

// Grids that are asked and changed, and never updated, as in editors, servers and navigation bakers:
// what they hold, and what a question costs, follows from who is there, not from who has been.

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

constexpr int kPerLevel = 600;
constexpr int kLevels = 60;

template <class Scalar>
Aabb<Scalar> levelBox(int i, double height = 0) {
    return boxAround<Scalar>({i % 25 * 2.0, height, i / 25 * 2.0}, {0.7, 0.7, 0.7});
}

enum class With { nothing, pairs, sweeps };

/// A grid with nothing around it, with Pairs, or with these and Sweeps.
template <class Scalar>
struct Asked {
    explicit Asked(With with) {
        if (with == With::sweeps) {
            sweeps = std::make_unique<Sweeps<Scalar>>(grid);
        }
        if (with != With::nothing) {
            pairs = std::make_unique<Pairs<Scalar>>(grid, sweeps.get());
        }
    }
    std::vector<ProxyId> addLevel() {
        std::vector<ProxyId> ids;
        for (int i = 0; i < kPerLevel; ++i) {
            ids.push_back(
                grid.add(levelBox<Scalar>(i), i % 3 == 0 ? Mobility::resting : Mobility::mobile));
            if (sweeps != nullptr && i % 4 == 0) {
                sweeps->set(ids.back(), {1, 0, 0});
            }
        }
        return ids;
    }
    void removeAll(const std::vector<ProxyId>& ids) {
        for (const ProxyId id : ids) {
            grid.remove(id);
        }
    }
    /// What it costs to cast rays down the level.
    QueryCost castRays() {
        QueryCost sum;
        for (int i = 0; i < 40; ++i) {
            const Vector3<Scalar> from(Scalar(i), 9, Scalar(i) / 2);
            CollectCount count;
            sum += grid.visit(RayRegion<Scalar>(from, from - Vector3<Scalar>(0, 18, 0)), count);
        }
        return sum;
    }
    void update() {
        if (pairs != nullptr) {
            pairs->update();
        } else {
            grid.update();
        }
    }
    [[nodiscard]] std::size_t memoryBytes() const {
        return grid.memoryBytes() + (pairs != nullptr ? pairs->memoryBytes() : 0) +
               (sweeps != nullptr ? sweeps->memoryBytes() : 0);
    }

    Grid<Scalar> grid;
    std::unique_ptr<Sweeps<Scalar>> sweeps;
    std::unique_ptr<Pairs<Scalar>> pairs;
};

template <class Scalar>
class NeverUpdated : public testing::Test {
protected:
    template <class Test>
    static void forEachKind(const Test& test) {
        for (const With with : {With::nothing, With::pairs, With::sweeps}) {
            SCOPED_TRACE(static_cast<int>(with));
            Asked<Scalar> world(with);
            test(world);
            EXPECT_EQ(world.grid.validate(), "");
        }
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(NeverUpdated, Scalars);

TYPED_TEST(NeverUpdated, HoldsNoMoreAndAsksNoMoreAfterManyLevelsThanAfterAFew) {
    this->forEachKind([](Asked<TypeParam>& world) {
        constexpr int kFew = 5;
        std::size_t memory = 0;
        QueryCost cost;
        for (int level = 1; level <= kLevels; ++level) {
            const auto ids = world.addLevel();
            const QueryCost present = world.castRays();
            world.removeAll(ids);
            if (level == kFew) {
                memory = world.memoryBytes();
                cost = present;
            } else if (level > kFew) {
                ASSERT_LE(world.grid.indexLimit(), 2U * kPerLevel);
                ASSERT_EQ(present.hits, cost.hits);
                ASSERT_LE(present.boxesTested, cost.boxesTested + cost.boxesTested / 8);
            }
        }
        EXPECT_LE(world.memoryBytes(), memory);
    });
}

TYPED_TEST(NeverUpdated, HoldsNoMoreWhereOthersWereThereAtTheLastUpdate) {
    Asked<TypeParam> world(With::sweeps);
    auto present = world.addLevel();
    for (int i = 0; i < 20; ++i) {
        world.update();
    }
    for (int level = 0; level < kLevels; ++level) {
        world.removeAll(present);  // the first time those that the update has seen
        present = world.addLevel();
        world.castRays();
    }
    EXPECT_EQ(world.grid.indexLimit(), static_cast<std::uint32_t>(2 * kPerLevel));
    world.update();
    world.removeAll(present);
    world.update();
    EXPECT_EQ(world.pairs->count(), 0U);
    EXPECT_EQ(world.grid.indexLimit(), static_cast<std::uint32_t>(2 * kPerLevel));
}

// As after a level that was played, in a program that only asks from now on.
TYPED_TEST(NeverUpdated, DoesNotLookAtWhatCameToRestBeforeAndWasRemoved) {
    for (const With with : {With::nothing, With::pairs}) {
        Asked<TypeParam> world(with);
        const auto ids = world.addLevel();
        for (int i = 0; i < 20; ++i) {
            world.update();
        }
        EXPECT_GT(world.castRays().boxesTested, 0U);
        for (std::size_t first : {0U, 1U}) {
            for (std::size_t i = first; i < ids.size(); i += 2) {
                world.grid.remove(ids[i]);
            }
            EXPECT_EQ(world.castRays().hits > 0,
                      first == 0);  // so many that they file what is left
            EXPECT_EQ(world.grid.validate(), "");
        }
        static_cast<void>(world.grid.add(levelBox<TypeParam>(0)));
        EXPECT_LE(world.castRays().boxesTested, 40U) << "but the one that is there";
        world.update();
        EXPECT_TRUE(with == With::nothing || world.pairs->validate().empty());
        EXPECT_TRUE(with == With::nothing || world.pairs->count() == 0);
    }
}

TYPED_TEST(NeverUpdated, HoldsNoMoreWhereAllThatIsThereMoves) {
    this->forEachKind([](Asked<TypeParam>& world) {
        const auto ids = world.addLevel();
        std::size_t memory = 0;
        for (int turn = 0; turn < kLevels; ++turn) {
            for (std::size_t i = 0; i < ids.size(); ++i) {
                world.grid.move(ids[i], levelBox<TypeParam>(static_cast<int>(i), 0.01 * turn));
            }
            EXPECT_LE(world.castRays().boxesTested, 40U * 200);  // beside the ray, and what waits
            memory = turn == 1 ? world.memoryBytes() : memory;
        }
        EXPECT_LE(world.memoryBytes(), memory);
    });
}

// --- Announced pairs -----------------------------------------------------------------------------

TYPED_TEST(NeverUpdated, HoldsNoMoreWherePairsAreAnnounced) {
    // Some are refused; one proxy lasts, and one of each tenth level stays.
    Population<TypeParam, PairWorld> world;
    const auto add = [&](int i, double height) {
        const ProxyId id = world.add(levelBox<TypeParam>(i, height));
        world.paint(world.proxies.size() - 1, id.index % 3);
        return id;
    };
    add(0, 0);
    world.update();
    std::size_t memory = 0;
    constexpr std::size_t kGhosts = 60;
    for (std::size_t level = 0; level < kLevels; ++level) {
        const std::size_t before = world.proxies.size();
        for (std::size_t i = 0; i < kGhosts; ++i) {
            world.findPairsNow(add(static_cast<int>(i) / 4, 0.1 * static_cast<double>(i % 4)));
        }
        const std::size_t kept = level % 10 == 0 ? before + level % kGhosts : 0;
        world.keepOnly([&](std::size_t i) { return i < before || i == kept; });
        ASSERT_EQ(world.pairs.count(), world.set().size());
        memory = level == kLevels / 2 ? world.pairs.memoryBytes() : memory;
    }
    EXPECT_LE(world.grid.indexLimit(), 6U * kGhosts);
    EXPECT_LE(world.pairs.memoryBytes(), 2 * memory);
    world.updateAndCheck();
}

// Each pair is looked at about once, however many are announced at the same time.
TYPED_TEST(NeverUpdated, AnnouncesManyAtACostThatFollowsTheirNumber) {
    Asked<TypeParam> world(With::pairs);
    std::size_t died = 0;
    std::size_t born = 0;
    for (int level = 0; level < 4; ++level) {
        std::vector<ProxyId> ids;
        for (int i = 0; i < 3000; ++i) {
            ids.push_back(world.grid.add(levelBox<TypeParam>(i / 2, 0.1 * (i % 2))));
            const PairChanges changes = world.pairs->findPairsNow(ids.back(), acceptAllPairs);
            born += changes.born.size();
            died += changes.died.size();
        }
        world.removeAll(ids);
    }
    died += world.pairs->update().died.size();
    EXPECT_EQ(born, 4U * 1500);
    EXPECT_EQ(died, born);
    EXPECT_EQ(world.pairs->count(), 0U);
}

}  // namespace
}  // namespace hashphase::test
