// SPDX-License-Identifier: Zlib

// Where memory runs out while objects are changed, nothing has happened: the change may be made again.

#include <integration/distributed/rank_grid.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

/// A part of space whose objects are added, moved and removed, one after the other.
struct Part {
    static constexpr std::uint64_t kObjects = 40;

    Part() : grid(0, Partition<float>(std::vector<Cut<float>>{{30, 0}}), {{}, 8}) {}

    static Aabb<float> box(std::uint64_t i, float shift) {
        const float x = 0.9F * static_cast<float>(i) + shift;
        return {Vector3<float>(x, 0, 0), Vector3<float>(x + 1, 1, 1)};
    }

    /// Goes on where it has stopped.
    void go() {
        for (; done < 3 * kObjects; ++done) {
            const std::uint64_t i = done % kObjects;
            const ProxyId id = grid.find(GlobalId{i});
            if (done < kObjects) {
                grid.add(GlobalId{i}, box(i, 0));
            } else if (done < 2 * kObjects) {
                grid.move(id, box(i, 0.5F));
                grid.payload(id)[0] = std::byte{7};
            } else if (i % 3 == 0) {
                grid.remove(id);
            }
        }
    }

    RankGrid<float> grid;
    std::uint64_t done = 0;
};

TEST(RankGridOutOfMemory, LeavesChangesToBeMadeAgain) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    const std::size_t failures = runOutOfMemory(
        [] { return std::make_unique<Part>(); }, [](Part& part) { part.go(); },
        [](Part& part, std::size_t) {
            part.go();
            part.grid.pack();
            part.grid.finish({});
            std::vector<GlobalPair> pairs;
            part.grid.collect(pairs);
            std::vector<GlobalPair> expected;
            for (std::uint64_t i = 0; i + 1 < Part::kObjects; ++i) {
                const bool isHere = Part::box(i + 1, 0.5F).min()[0] < 30;  // the pair's point
                if (i % 3 != 0 && (i + 1) % 3 != 0 && isHere) {
                    expected.push_back({GlobalId{i}, GlobalId{i + 1}});
                }
            }
            EXPECT_EQ(expected, pairs);
            EXPECT_EQ("", part.grid.validate());
        });
    EXPECT_GT(failures, 20U);
}

}  // namespace
}  // namespace hashphase::test
