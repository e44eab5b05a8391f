// SPDX-License-Identifier: Zlib
#include <integration/distributed/partition.hpp>
#include <tests/support/box_scenes.hpp>

#include <broadphase/regions.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace hashphase::test {
namespace {

std::vector<WeightedPoint<float>> pointsIn(Random& random, std::size_t count) {
    std::vector<WeightedPoint<float>> points;
    while (points.size() < count) {
        const Vector3<float> at =
            random.pointIn(-50, 50).cwiseProduct(random.pointIn(0, 1)).cast<float>();
        points.push_back({at, random.between(0.5, 3)});
    }
    return points;
}

TEST(Partition, OwnsEveryPointOnce) {
    Random random(1);
    for (std::uint32_t ranks = 1; ranks <= 40; ++ranks) {
        const auto points = pointsIn(random, 300);
        const auto partition = Partition<float>::balanced(ranks, points);
        EXPECT_EQ(ranks, partition.rankCount());
        for (int i = 0; i < 200; ++i) {
            Vector3<float> at = points[random.below(300)].at;  // on cuts as well
            if (random.chance(0.3)) {
                at = random.pointIn(-1e3, 1e3).cast<float>();
            }
            const std::uint32_t owner = partition.rankOf(at);
            std::uint32_t owners = 0;
            for (std::uint32_t rank = 0; rank < ranks; ++rank) {
                const Aabb<float> region = partition.region(rank);
                const bool owns = (at.array() >= region.min().array()).all() &&
                                  (at.array() < region.max().array()).all();
                owners += owns ? 1 : 0;
                EXPECT_EQ(owns, rank == owner);
            }
            EXPECT_EQ(1U, owners);
        }
    }
}

TEST(Partition, SharesTheWeight) {
    Random random(2);
    const auto points = pointsIn(random, 20'000);
    for (const std::uint32_t ranks : {2U, 3U, 7U, 8U, 13U, 64U}) {
        const auto partition = Partition<float>::balanced(ranks, points);
        std::vector<double> weights(ranks);
        for (const WeightedPoint<float>& point : points) {
            weights[partition.rankOf(point.at)] += point.weight;
        }
        const double mean = std::accumulate(weights.begin(), weights.end(), 0.0) / ranks;
        EXPECT_LT(*std::max_element(weights.begin(), weights.end()), 1.05 * mean) << ranks;
    }
}

TEST(Partition, CutsAcrossTheLongestAxisWhateverAFewOutliersDo) {
    Random random(3);
    std::vector<WeightedPoint<float>> points;
    for (int i = 0; i < 1000; ++i) {
        const Vector3<float> at = random.pointIn({0, 0, 0}, {10, 100, 20}).cast<float>();
        points.push_back({at, 1});
    }
    for (int i = 0; i < 50; ++i) {
        points.push_back({Vector3<float>(-1e30F, 0, std::numeric_limits<float>::infinity()), 1});
    }
    EXPECT_EQ(1U, Partition<float>::balanced(2, points).cuts()[0].axis);
}

TEST(Partition, OfPointsThatAreNoneOrOneOrHaveNanStillOwnsAllOfSpace) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const std::size_t count : {0U, 1U, 5U}) {
        std::vector<WeightedPoint<float>> points(count, {Vector3<float>(1, 2, 3), 1});
        points.push_back({Vector3<float>(nan, 0, 0), 1e9});
        const auto partition = Partition<float>::balanced(5, points);
        EXPECT_EQ(5U, partition.rankCount());
        EXPECT_LT(partition.rankOf(Vector3<float>(1, 2, 3)), 5U);
    }
}

// Brute force: a box touches a region if it has a point in it.
TEST(Partition, VisitsTheRanksThatABoxTouches) {
    Random random(4);
    for (const BoxScene<float>& scene : allBoxScenes<float>()) {
        SCOPED_TRACE(scene.name);
        std::vector<WeightedPoint<float>> points;
        for (int i = 0; i < 100; ++i) {
            points.push_back({scene.draw(random).min(), 1});
        }
        const auto partition = Partition<float>::balanced(11, points);
        for (int i = 0; i < 200; ++i) {
            const Aabb<float> box = scene.draw(random);
            std::vector<std::uint32_t> visited;
            partition.forEachRank(box, [&](std::uint32_t rank) { visited.push_back(rank); });
            std::vector<std::uint32_t> expected;
            for (std::uint32_t rank = 0; rank < 11 && !hasNan(box); ++rank) {
                const Aabb<float> region = partition.region(rank);
                const Aabb<float> hull = hullOf(box);
                bool touches = true;
                for (int axis = 0; axis < 3; ++axis) {
                    const float end = region.max()[axis];
                    const bool isOpen = end == std::numeric_limits<float>::infinity();
                    touches &= hull.max()[axis] >= region.min()[axis] &&
                               (isOpen || hull.min()[axis] < end);
                }
                if (touches) {
                    expected.push_back(rank);
                }
            }
            EXPECT_EQ(expected, visited);
        }
    }
}

// The promise by which each pair is reported once.
TEST(Partition, PutsThePointOfAPairOnARankThatBothBoxesTouch) {
    Random random(5);
    for (const BoxScene<double>& scene : allBoxScenes<double>()) {
        SCOPED_TRACE(scene.name);
        const auto boxes = drawBoxes<double>(random, 120, scene.draw);
        std::vector<WeightedPoint<double>> points;
        for (const Aabb<double>& box : boxes) {
            points.push_back({box.min(), 1});
        }
        const auto partition = Partition<double>::balanced(9, points);
        for (const Aabb<double>& a : boxes) {
            for (const Aabb<double>& b : boxes) {
                if (!overlaps(a, b)) {
                    continue;
                }
                const std::uint32_t owner = partition.rankOf(pairPoint(a, b));
                for (const Aabb<double>* box : {&a, &b}) {
                    bool touches = false;
                    partition.forEachRank(*box,
                                          [&](std::uint32_t rank) { touches |= rank == owner; });
                    EXPECT_TRUE(touches);
                }
            }
        }
    }
}

TEST(Partition, VisitsARankForEveryBoxThatARayHits) {
    Random random(6);
    for (const BoxScene<float>& scene : allBoxScenes<float>()) {
        SCOPED_TRACE(scene.name);
        const auto boxes = drawBoxes<float>(random, 60, scene.draw);
        std::vector<WeightedPoint<float>> points;
        for (const Aabb<float>& box : boxes) {
            points.push_back({box.min(), 1});
        }
        const auto partition = Partition<float>::balanced(7, points);
        for (int i = 0; i < 60; ++i) {
            const Vector3<float> from = scene.draw(random).min();
            const Vector3<float> to = random.chance(0.8) ? scene.draw(random).max() : from;
            const RayRegion<float> ray(from, to);
            std::vector<bool> isVisited(7);
            partition.forEachRankWithKey(ray, [&](std::uint32_t rank) { isVisited[rank] = true; });
            for (const Aabb<float>& box : boxes) {
                if (ray.key(box) < 0) {
                    continue;
                }
                bool isFound = false;
                partition.forEachRank(box, [&](std::uint32_t rank) { isFound |= isVisited[rank]; });
                EXPECT_TRUE(isFound);
            }
        }
    }
}

TEST(Partition, IsMadeAgainOfItsCuts) {
    Random random(7);
    const auto partition = Partition<float>::balanced(21, pointsIn(random, 500));
    EXPECT_EQ(partition, Partition<float>(partition.cuts()));
}

TEST(Partition, RefusesCutsThatAreNone) {
    const Cut<float> nan{std::numeric_limits<float>::quiet_NaN(), 0};
    const Cut<float> axis{1, 3};
    for (const Cut<float>& cut : {nan, axis}) {
        EXPECT_THROW(Partition<float>(std::span(&cut, 1)), std::invalid_argument);
    }
}

}  // namespace
}  // namespace hashphase::test
