// SPDX-License-Identifier: Zlib

// Readers at the same time, right after many changes. What goes wrong here is mostly for the thread
// sanitizer to see.

#include <tests/support/box_scenes.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace hashphase::test {
namespace {

constexpr int kThreads = 4;

template <class Work>
void runOnThreads(Work&& work) {
    std::atomic<int> ready{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t) {
        threads.emplace_back([&, t] {
            // All start together: the first query is the one that files.
            ready.fetch_add(1);
            while (ready.load() < kThreads) {
                std::this_thread::yield();
            }
            work(t);
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
}

struct SharedCrowd {
    Grid<float> grid;
    std::vector<Placed<float>> proxies;
    Random random{0x5eed0801};

    /// Added, not filed yet.
    SharedCrowd() {
        const BoxScene<float> scene = spreadScene<float>("evenly spread", 1, 0);
        for (int i = 0; i < 1000; ++i) {
            const Aabb<float> box = scene.draw(random);
            proxies.push_back({grid.add(box), box});
        }
    }

    void moveMany() {
        for (Placed<float>& proxy : proxies) {
            proxy.box = shifted(random, proxy.box, 0.5);
            grid.move(proxy.id, proxy.box);
        }
    }
};

TEST(GridThreads, QueriesRightAfterManyChangesAllSeeThem) {
    SharedCrowd crowd;
    for (int round = 0; round < 20; ++round) {
        crowd.moveMany();
        std::vector<std::vector<std::string>> wrong(kThreads);
        runOnThreads([&](int t) {
            Random random(0x5eed0802U + static_cast<std::uint64_t>(t));
            RegionMaker<float> make(random, crowd.proxies);
            const auto check = [&](const auto& region) {
                CollectKeys<float> found;
                CollectKeys<float> expected;
                crowd.grid.visit(region, found);
                visitByBruteForce<float>(crowd.proxies, region, expected);
                if (found.sorted() != expected.sorted()) {
                    wrong[static_cast<std::size_t>(t)].push_back(
                        differences(found.sorted(), expected.sorted()));
                }
            };
            for (int i = 0; i < 5; ++i) {
                check(make.box());
                check(make.sphere());
                check(make.ray());
            }
        });
        for (const auto& ofThread : wrong) {
            ASSERT_EQ(ofThread, std::vector<std::string>{});
        }
        if (round % 3 == 0) {
            crowd.grid.update();
        }
    }
}

TEST(GridThreads, RaysRightAfterAnUpdateAllFindTheTreesMade) {
    SharedCrowd crowd;
    for (int round = 0; round < 20; ++round) {
        crowd.moveMany();
        crowd.grid.update();  // nothing waits: only the trees are to be made
        std::atomic<int> wrong{0};
        runOnThreads([&](int t) {
            Random random(0x5eed0803U + static_cast<std::uint64_t>(t));
            RegionMaker<float> make(random, crowd.proxies);
            for (int i = 0; i < 5; ++i) {
                const RayRegion<float> ray = make.ray();
                CollectKeys<float> found;
                CollectKeys<float> expected;
                crowd.grid.visit(ray, found);
                visitByBruteForce<float>(crowd.proxies, ray, expected);
                wrong += found.sorted() == expected.sorted() ? 0 : 1;
            }
        });
        ASSERT_EQ(wrong.load(), 0);
    }
}

TEST(GridThreads, WhateverIsConstMayBeAskedBesideTheQueryThatFiles) {
    for (int round = 0; round < 10; ++round) {
        SharedCrowd crowd;
        std::atomic<int> wrong{0};
        runOnThreads([&](int t) {
            const Placed<float>& proxy = crowd.proxies[static_cast<std::size_t>(t) * 100];
            const Grid<float>& grid = crowd.grid;
            if (t == 0) {
                CollectCount count;
                grid.visit(BoxRegion<float>{proxy.box}, count);
                wrong += count.count() >= 1 ? 0 : 1;
            } else {
                wrong += grid.contains(proxy.id) ? 0 : 1;
                wrong += grid.box(proxy.id).isApprox(proxy.box) ? 0 : 1;
                wrong += grid.size() == 1000 ? 0 : 1;
                wrong += grid.cellsOf(proxy.id).lowest == grid.cellAt(proxy.box.min()) ? 0 : 1;
                std::size_t seen = 0;
                grid.forEach([&seen](ProxyId, const Aabb<float>&) { ++seen; });
                wrong += seen == 1000 ? 0 : 1;
            }
        });
        ASSERT_EQ(wrong.load(), 0);
    }
}

}  // namespace
}  // namespace hashphase::test
