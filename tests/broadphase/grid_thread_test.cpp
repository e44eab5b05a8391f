// SPDX-License-Identifier: Zlib

// Readers at the same time, right after many changes. What goes wrong here is mostly for the thread
// sanitizer to see.

#include <broadphase/grid.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace hashphase::test {
namespace {

constexpr std::size_t kThreads = 4;

/// Boxes that are added and not filed yet, for readers on several threads.
struct GridThreads : testing::Test {
    GridThreads() { boxes.addMany(1000, scene.draw); }

    void moveAll() {
        for (std::size_t i = 0; i < boxes.proxies.size(); ++i) {
            boxes.moveTo(i, shifted(boxes.random, boxes.proxies[i].box, 0.5));
        }
    }

    /// All start together: the first query is the one that files. Nothing that they say is wrong.
    static void expectNothingWrong(
        const std::function<void(std::size_t thread, std::string& wrong)>& read) {
        std::atomic<std::size_t> ready{0};
        std::array<std::string, kThreads> wrong;
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < kThreads; ++t) {
            threads.emplace_back([&, t] {
                ready.fetch_add(1);
                while (ready.load() < kThreads) {
                    std::this_thread::yield();
                }
                read(t, wrong[t]);
            });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
        for (const std::string& text : wrong) {
            ASSERT_EQ(text, "");
        }
    }

    template <class Region>
    void check(const Region& region, std::string& wrong) {
        CollectKeys<float> found;
        CollectKeys<float> expected;
        boxes.grid.visit(region, found);
        visitByBruteForce<float>(boxes.proxies, region, expected);
        wrong += differences(found.sorted(), expected.sorted());
    }

    BoxScene<float> scene = spreadScene<float>("evenly spread", 1, 0);
    Population<float> boxes;
};

TEST_F(GridThreads, QueriesRightAfterManyChangesAllSeeThem) {
    for (int round = 0; round < 20; ++round) {
        moveAll();
        expectNothingWrong([&](std::size_t t, std::string& wrong) {
            Random random(0x5eed0802U + t);
            RegionMaker<float> make(random, boxes.proxies);
            for (int i = 0; i < 5; ++i) {
                check(make.box(), wrong);
                check(make.sphere(), wrong);
                check(make.ray(), wrong);
            }
        });
        if (round % 3 == 0) {
            boxes.update();
        }
    }
}

TEST_F(GridThreads, RaysRightAfterAnUpdateAllFindTheTreesMade) {
    for (int round = 0; round < 20; ++round) {
        moveAll();
        boxes.update();  // nothing waits: only the trees are to be made
        expectNothingWrong([&](std::size_t t, std::string& wrong) {
            Random random(0x5eed0803U + t);
            RegionMaker<float> make(random, boxes.proxies);
            for (int i = 0; i < 5; ++i) {
                check(make.ray(), wrong);
            }
        });
    }
}

TEST_F(GridThreads, WhateverIsConstMayBeAskedBesideTheQueryThatFiles) {
    const Grid<float>& grid = boxes.grid;
    for (int round = 0; round < 10; ++round) {
        moveAll();
        expectNothingWrong([&](std::size_t t, std::string& wrong) {
            const Placed<float>& proxy = boxes.proxies[t * 100];
            if (t == 0) {
                check(BoxRegion<float>{proxy.box}, wrong);
                return;
            }
            std::size_t seen = 0;
            grid.forEach([&seen](ProxyId, const Aabb<float>&) { ++seen; });
            const bool isRight = grid.contains(proxy.id) && grid.size() == 1000 && seen == 1000 &&
                                 isSameBits(grid.box(proxy.id), proxy.box) &&
                                 grid.cellsOf(proxy.id).lowest == grid.cellAt(proxy.box.min());
            wrong += isRight ? "" : "const members";
        });
    }
}

}  // namespace
}  // namespace hashphase::test
