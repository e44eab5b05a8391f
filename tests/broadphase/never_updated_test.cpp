// SPDX-License-Identifier: Zlib

// Grids that are asked and changed, and never updated, as in editors, servers and navigation bakers:
// what they hold, and what a question costs, follows from who is there, not from who has been.

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/pair_world.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <set>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class NeverUpdated : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(NeverUpdated, Scalars);

constexpr int kPerLevel = 600;
constexpr int kLevels = 60;
constexpr int kFew = 5;

template <class Scalar>
Aabb<Scalar> boxAt(int i, double height = 0) {
    return boxAround<Scalar>({i % 25 * 2.0, height, i / 25 * 2.0}, {0.7, 0.7, 0.7});
}

/// A grid with nothing around it, with Pairs, or with these and Sweeps.
template <class Scalar>
struct Asked {
    enum class With { nothing, pairs, sweeps };

    explicit Asked(With with) {
        if (with == With::sweeps) {
            sweeps = std::make_unique<Sweeps<Scalar>>(grid);
        }
        if (with != With::nothing) {
            pairs = std::make_unique<Pairs<Scalar>>(grid, sweeps.get());
        }
    }
    std::vector<ProxyId> addLevel(int count = kPerLevel) {
        std::vector<ProxyId> ids;
        for (int i = 0; i < count; ++i) {
            ids.push_back(
                grid.add(boxAt<Scalar>(i), i % 3 == 0 ? Mobility::resting : Mobility::mobile));
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
    [[nodiscard]] std::size_t memoryBytes() const {
        return grid.memoryBytes() + (pairs != nullptr ? pairs->memoryBytes() : 0) +
               (sweeps != nullptr ? sweeps->memoryBytes() : 0);
    }

    Grid<Scalar> grid;
    std::unique_ptr<Sweeps<Scalar>> sweeps;
    std::unique_ptr<Pairs<Scalar>> pairs;
};

template <class Scalar>
constexpr std::array kAllKinds{Asked<Scalar>::With::nothing, Asked<Scalar>::With::pairs,
                               Asked<Scalar>::With::sweeps};

TYPED_TEST(NeverUpdated, HoldsNoMoreAndAsksNoMoreAfterManyLevelsThanAfterAFew) {
    for (const auto with : kAllKinds<TypeParam>) {
        SCOPED_TRACE(static_cast<int>(with));
        Asked<TypeParam> world(with);
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
        EXPECT_EQ(world.grid.validate(), "");
    }
}

TYPED_TEST(NeverUpdated, HoldsNoMoreWhereNothingIsAsked) {
    for (const auto with : kAllKinds<TypeParam>) {
        Asked<TypeParam> world(with);
        for (int level = 0; level < kLevels; ++level) {
            world.removeAll(world.addLevel());
        }
        EXPECT_EQ(world.grid.indexLimit(), static_cast<std::uint32_t>(kPerLevel));
        EXPECT_EQ(world.grid.validate(), "");
    }
}

TYPED_TEST(NeverUpdated, KeepsWhatStaysOfEachLevelAndGivesTheOtherIndicesAway) {
    for (const auto with : kAllKinds<TypeParam>) {
        Asked<TypeParam> world(with);
        std::vector<Placed<TypeParam>> kept;
        for (int level = 0; level < kLevels; ++level) {
            auto ids = world.addLevel();
            const std::size_t stays = static_cast<std::size_t>(level * 7 % kPerLevel);
            kept.push_back({ids[stays], world.grid.box(ids[stays])});
            ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(stays));
            world.castRays();
            world.removeAll(ids);
        }
        EXPECT_LE(world.grid.indexLimit(), 2U * kPerLevel + kLevels);
        EXPECT_EQ(world.grid.size(), kept.size());
        EXPECT_EQ(world.grid.validate(), "");
        const auto all = Vector3<TypeParam>::Constant(1000);
        CollectCount count;
        world.grid.visit(BoxRegion<TypeParam>{{-all, all}}, count);
        EXPECT_EQ(count.count(), kept.size());
        for (const Placed<TypeParam>& proxy : kept) {
            EXPECT_TRUE(world.grid.contains(proxy.id));
        }
    }
}

TYPED_TEST(NeverUpdated, HoldsNoMoreWhereOthersWereThereAtTheLastUpdate) {
    Asked<TypeParam> world(Asked<TypeParam>::With::sweeps);
    const auto lasting = world.addLevel();
    for (int i = 0; i < 20; ++i) {
        world.pairs->update();
    }
    auto present = lasting;
    for (int level = 0; level < kLevels; ++level) {
        world.removeAll(present);  // the first time those that the update has seen
        present = world.addLevel();
        world.castRays();
    }
    EXPECT_EQ(world.grid.indexLimit(), static_cast<std::uint32_t>(2 * kPerLevel));
    world.pairs->update();
    world.removeAll(present);
    world.pairs->update();
    EXPECT_EQ(world.pairs->count(), 0U);
    EXPECT_EQ(world.grid.indexLimit(), static_cast<std::uint32_t>(2 * kPerLevel));
}

// As after a level that was played, in a program that only asks from now on.
TYPED_TEST(NeverUpdated, DoesNotLookAtWhatCameToRestBeforeAndWasRemoved) {
    for (const bool hasPairs : {false, true}) {
        Asked<TypeParam> world(hasPairs ? Asked<TypeParam>::With::pairs
                                        : Asked<TypeParam>::With::nothing);
        const auto ids = world.addLevel();
        for (int i = 0; i < 20; ++i) {
            if (hasPairs) {
                world.pairs->update();
            } else {
                world.grid.update();
            }
        }
        EXPECT_GT(world.castRays().boxesTested, 0U);
        for (std::size_t i = 0; i < ids.size(); i += 2) {
            world.grid.remove(ids[i]);
        }
        EXPECT_GT(world.castRays().hits, 0U);
        EXPECT_EQ(world.grid.validate(), "");
        for (std::size_t i = 1; i < ids.size(); i += 2) {
            world.grid.remove(ids[i]);
        }
        world.castRays();  // so many that they file what is left
        static_cast<void>(world.grid.add(boxAt<TypeParam>(0)));
        EXPECT_LE(world.castRays().boxesTested, 40U) << "but the one that is there";
        if (hasPairs) {
            world.pairs->update();
            EXPECT_EQ(world.pairs->validate(), "");
            EXPECT_EQ(world.pairs->count(), 0U);
        }
    }
}

TYPED_TEST(NeverUpdated, HoldsNoMoreWhereAllThatIsThereMoves) {
    for (const auto with : kAllKinds<TypeParam>) {
        Asked<TypeParam> world(with);
        const auto ids = world.addLevel();
        std::size_t memory = 0;
        for (int turn = 0; turn < kLevels; ++turn) {
            for (std::size_t i = 0; i < ids.size(); ++i) {
                world.grid.move(ids[i], boxAt<TypeParam>(static_cast<int>(i), 0.01 * turn));
            }
            const QueryCost cost = world.castRays();
            EXPECT_LE(cost.boxesTested, 40U * 200);  // those beside the ray, and what waits
            memory = turn == 1 ? world.memoryBytes() : memory;
        }
        EXPECT_LE(world.memoryBytes(), memory);
    }
}

// --- Announced pairs -----------------------------------------------------------------------------

TYPED_TEST(NeverUpdated, TellsOnceOfThePairsThatWereAnnouncedOfWhatCameAndWent) {
    PairWorld<TypeParam> world;
    const ProxyId a = world.add(boxAt<TypeParam>(0));
    world.update();
    const ProxyId b = world.add(boxAt<TypeParam>(0, 0.5));
    world.findPairsNow(b);
    EXPECT_TRUE(world.set().contains(makePair(a, b)));
    world.remove(b);
    const ProxyId c = world.add(boxAt<TypeParam>(0, 0.25));
    world.update();
    EXPECT_EQ(world.set(), std::set<ProxyPair>{makePair(a, c)});
    world.checkThoroughly(
        std::vector<Placed<TypeParam>>{{a, boxAt<TypeParam>(0)}, {c, boxAt<TypeParam>(0, 0.25)}});
}

TYPED_TEST(NeverUpdated, HoldsNoMoreWherePairsAreAnnounced) {
    // Some are refused; one proxy lasts, and one of each tenth level stays.
    PairWorld<TypeParam> world(
        {}, [](ProxyId a, ProxyId b) { return coloursPair(a.index % 3, b.index % 3); });
    std::vector<Placed<TypeParam>> kept;
    const auto add = [&](int i, double height) {
        const Aabb<TypeParam> box = boxAt<TypeParam>(i, height);
        Placed<TypeParam> proxy;
        proxy.id = world.add(box);
        proxy.box = box;
        proxy.colour = proxy.id.index % 3;
        return proxy;
    };
    kept.push_back(add(0, 0));
    world.update();
    std::size_t memory = 0;
    constexpr int kGhosts = 60;
    for (int level = 0; level < kLevels; ++level) {
        std::vector<Placed<TypeParam>> present;
        for (int i = 0; i < kGhosts; ++i) {
            present.push_back(add(i / 4, 0.1 * (i % 4)));
            world.findPairsNow(present.back().id);
        }
        if (level % 10 == 0) {
            kept.push_back(present[static_cast<std::size_t>(level) % kGhosts]);
        }
        for (const Placed<TypeParam>& proxy : present) {
            if (proxy.id != kept.back().id) {
                world.remove(proxy.id);
            }
        }
        ASSERT_EQ(world.pairs.count(), world.set().size());
        memory = level == kLevels / 2 ? world.pairs.memoryBytes() : memory;
    }
    EXPECT_LE(world.grid.indexLimit(), 6U * kGhosts);
    EXPECT_LE(world.pairs.memoryBytes(), 2 * memory);
    world.update();
    world.checkThoroughly(kept);
}

// Each pair is looked at about once, however many are announced at the same time.
TYPED_TEST(NeverUpdated, AnnouncesManyAtACostThatFollowsTheirNumber) {
    Asked<TypeParam> world(Asked<TypeParam>::With::pairs);
    std::size_t died = 0;
    std::size_t born = 0;
    for (int level = 0; level < 4; ++level) {
        std::vector<ProxyId> ids;
        for (int i = 0; i < 3000; ++i) {
            ids.push_back(world.grid.add(boxAt<TypeParam>(i / 2, 0.1 * (i % 2))));
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
