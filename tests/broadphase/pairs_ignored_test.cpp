// SPDX-License-Identifier: Zlib

// Pairs that are ignored, many of them: what removals and failures leave. What is told of a few cubes is in
// pairs_test.cpp, random scripts are in pairs_script_test.cpp and pairs_remembered_test.cpp.

#include <tests/broadphase/failing_world.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

namespace hashphase::test {
namespace {

/// Cubes of 1 m in a row that touch their neighbours, and are all pairs.
struct IgnoredRow : testing::Test {
    void addMany(std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) {
            ids.push_back(grid.add(boxAround<float>({double(ids.size()), 0, 0}, {0.5, 0.5, 0.5})));
        }
        pairs.update();
    }
    [[nodiscard]] ProxyPair neighbours(std::size_t i) const { return makePair(ids[i], ids[i + 1]); }

    Grid<float> grid;
    Pairs<float> pairs{grid};
    std::vector<ProxyId> ids;
};

TEST_F(IgnoredRow, OfManyAtOnceAreToldSorted) {
    addMany(100);
    std::vector<ProxyPair> some;
    for (std::size_t i = 99; i-- > 0;) {
        some.push_back(i % 2 == 0 ? neighbours(i) : ProxyPair{ids[i + 1], ids[i]});
        some.push_back(neighbours(i / 2));                    // named twice
        some.push_back({ids[i], ids[i]});                     // no pair
        some.push_back({ids[i], ProxyId{ids[i].index, 99}});  // of no proxy alive
    }
    const PairChanges died = pairs.ignore(some);
    EXPECT_EQ(died.died.size(), 99U);
    EXPECT_TRUE(std::ranges::is_sorted(died.died));
    EXPECT_EQ(pairs.count(), 0U);
    EXPECT_EQ(pairs.refusedCount(), 99U);
    EXPECT_TRUE(pairs.ignore(some).died.empty());
    std::vector<ProxyPair> ignored;
    pairs.collectIgnored(ignored);
    EXPECT_EQ(ignored.size(), 99U);
    const PairChanges born = pairs.stopIgnoring(some, acceptAllPairs);
    EXPECT_TRUE(std::ranges::equal(born.born, ignored));
    EXPECT_TRUE(pairs.stopIgnoring(some, acceptAllPairs).born.empty());
    EXPECT_FALSE(pairs.isIgnored(neighbours(3)));
    EXPECT_EQ(pairs.validate(), "");
}

TEST_F(IgnoredRow, EndWithTheProxiesAndTakeNoMemoryThen) {
    addMany(1000);
    const auto replaceAll = [&] {
        for (std::size_t i = 0; i + 1 < ids.size(); ++i) {
            pairs.ignore(neighbours(i));
            EXPECT_TRUE(pairs.isIgnored(neighbours(i)));
        }
        const ProxyPair former = neighbours(0);
        for (const ProxyId id : ids) {
            grid.remove(id);
        }
        EXPECT_FALSE(pairs.isIgnored(former));
        ids.clear();
        pairs.update();
        addMany(1000);
        EXPECT_EQ(pairs.count(), 999U);
        EXPECT_FALSE(pairs.isIgnored(former));
        EXPECT_FALSE(pairs.stopIgnoring(former, acceptAllPairs).born.size() > 0);
    };
    replaceAll();
    replaceAll();
    const std::size_t bytes = pairs.memoryBytes();
    for (int i = 0; i < 30; ++i) {
        replaceAll();
    }
    EXPECT_LE(pairs.memoryBytes(), 2 * bytes);
    pairs.releaseUnusedMemory();
    EXPECT_EQ(pairs.validate(), "");
    pairs.clear();
    EXPECT_EQ(pairs.count(), 0U);
    addMany(1000);
    EXPECT_EQ(pairs.count(), 999U);
}

TEST_F(IgnoredRow, StayWhereMemoryIsGivenBack) {
    addMany(10);
    pairs.ignore(neighbours(3));
    pairs.ignore(neighbours(5));
    grid.remove(ids[6]);
    pairs.releaseUnusedMemory();
    EXPECT_TRUE(pairs.isIgnored(neighbours(3)));
    EXPECT_FALSE(pairs.isIgnored(neighbours(5)));
    EXPECT_EQ(pairs.stopIgnoring(neighbours(3), acceptAllPairs).born.size(), 1U);
}

TEST_F(IgnoredRow, StayIgnoredWhereTheFilterThrows) {
    addMany(4);
    pairs.ignore(neighbours(0));
    pairs.ignore(neighbours(1));
    const auto fail = [](ProxyId, ProxyId) -> bool { throw std::runtime_error("no answer"); };
    const std::vector<ProxyPair> both{neighbours(0), neighbours(1)};
    EXPECT_THROW(pairs.stopIgnoring(both, fail), std::runtime_error);
    EXPECT_TRUE(pairs.isIgnored(both[0]) && pairs.isIgnored(both[1]));
    EXPECT_TRUE(pairs.update(fail).born.empty()) << "it is not asked";
    EXPECT_EQ(pairs.count(), 1U);
    EXPECT_EQ(pairs.validate(), "");
}

TEST_F(OutOfMemory, IgnoringAndIgnoringNoMoreHaveHappenedOrNot) {
    const auto make = [] {
        auto world = longRun();
        world->update();
        world->moveSome(3);
        return world;
    };
    for (const bool isStopped : {false, true}) {
        const auto makeIgnoring = [&] {
            auto world = make();
            const std::set<ProxyPair> present = world->set();
            for (const ProxyPair& pair : present) {
                if (isStopped) {
                    world->ignore(pair);
                }
            }
            return world;
        };
        const auto attempt = [=](FailingWorld& world) {
            std::vector<ProxyPair> some;
            {
                const WorkingAllocations lifted;
                for (std::size_t i = 0; i + 1 < world.proxies.size(); ++i) {
                    for (std::size_t k = i + 1; k < world.proxies.size(); ++k) {
                        some.push_back(makePair(world.proxies[i].id, world.proxies[k].id));
                    }
                }
            }
            const auto filter = [&](ProxyId a, ProxyId b) { return world.colours.accept(a, b); };
            // There and back, so that the world of the test knows what is ignored.
            const auto apply = [&](const PairChanges& changes) {
                const WorkingAllocations lifted;
                world.apply(changes);
            };
            if (!isStopped) {
                apply(world.pairs.ignore(some));
            }
            apply(world.pairs.stopIgnoring(some, filter));
        };
        const auto check = [](FailingWorld& world, std::size_t n) {
            std::vector<ProxyPair> ignored;
            world.pairs.collectIgnored(ignored);
            for (const ProxyPair& pair : ignored) {
                EXPECT_FALSE(world.set().contains(pair)) << "an ignored pair is no pair";
            }
            world.apply(world.pairs.stopIgnoring(
                ignored, [&](ProxyId a, ProxyId b) { return world.colours.accept(a, b); }));
            world.forgetIgnored();
            checkPairsGoOn(world, n);
        };
        expectGoesOn(2, makeIgnoring, attempt, check);
    }
}

}  // namespace
}  // namespace hashphase::test
