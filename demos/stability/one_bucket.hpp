// SPDX-License-Identifier: Zlib
#pragma once

// Crowds that are in one bucket of the hash though far apart, as one makes them who means harm and knows how cells
// are numbered (broadphase/hash/level.hpp).

#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/hash/table.hpp>
#include <demos/scenes/random.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace hashphase::demos {

/// Boxes of such a crowd lie anywhere, or in a few rows, farther apart there than there are buckets.
enum class CrowdPlace : std::uint8_t { anywhere, longRows };

/// Boxes to be filed in cells of 1 m, and how a table does so.
template <class Scalar>
struct FiledCrowd {
    std::vector<Aabb<Scalar>> boxes;
    detail::Table<Scalar> table;
};

inline constexpr std::size_t kCrowdTwins = 300;

/// Throws std::bad_alloc.
template <class Scalar>
[[nodiscard]] detail::Table<Scalar> fileInCellsOfOneMetre(const std::vector<Aabb<Scalar>>& boxes) {
    std::vector<std::uint32_t> indices(boxes.size());
    std::iota(indices.begin(), indices.end(), 0U);
    std::vector<detail::PaddedBox<Scalar>> padded;
    for (const Aabb<Scalar>& box : boxes) {
        padded.push_back(detail::padded(box));
    }
    detail::Table<Scalar> table;
    table.build(indices, padded, detail::fixedLevels(1, 4));
    return table;
}

/// A step along y and z, of 1,000 rows or more, from each cell of a hashed level to one of the same bucket.
template <class Scalar>
[[nodiscard]] detail::Row stepWithinBucket(const detail::Level<Scalar>& level) {
    constexpr std::int32_t kLeast = 1000;
    detail::Row step{kLeast, kLeast};
    const auto isWithin = [&] {
        const detail::Row counted{level.inverseCellSize[1] == 0 ? 0 : step.y,
                                  level.inverseCellSize[2] == 0 ? 0 : step.z};
        return level.offset(counted) % level.bucketCount == 0;
    };
    while (!isWithin()) {
        step = step.y - kLeast < static_cast<std::int32_t>(level.bucketCount)
                   ? detail::Row{step.y + 1, step.z}
                   : detail::Row{kLeast, step.z + 1};
    }
    return step;
}

/// Of 12,000 boxes, two thirds in one bucket. None overlap, but for kCrowdTwins at the end, each of which
/// equals another one. How cells are numbered depends on the boxes of a sample, and on medians: of these the
/// other boxes take care, in two columns, which also make it too dear to file by x alone.
/// Throws std::bad_alloc. Cost: some builds of the table.
template <class Scalar>
[[nodiscard]] FiledCrowd<Scalar> crowdInOneBucket(CrowdPlace place) {
    constexpr std::int32_t kCount = 12'000 - static_cast<std::int32_t>(kCrowdTwins);
    constexpr int kPasses =
        4;  // the first ones find how cells are numbered, the last one that they stay so
    constexpr float kFar = 4e5F;
    FiledCrowd<Scalar> crowd;
    for (int pass = 0; pass < kPasses; ++pass) {
        const detail::Level<Scalar> level =
            pass == 0 ? detail::Level<Scalar>{} : crowd.table.levels()[1];
        const auto boxAt = [](double x, double y, double z) {
            const Vector3<double> middle(x, y, z);
            return Aabb<Scalar>((middle.array() - 0.125).matrix().template cast<Scalar>(),
                                (middle.array() + 0.125).matrix().template cast<Scalar>());
        };
        // Less than a lap along its row.
        const auto boxInBucket = [&](double x, double y, double z) {
            const Aabb<Scalar> box = boxAt(x, y, z);
            const auto laps = static_cast<std::int64_t>(level.bucketCount);
            std::int64_t number = level.cell(box.min()[0], 0);
            number += level.offset({level.cell(box.min()[1], 1), level.cell(box.min()[2], 2)});
            const std::int64_t rest = number % laps;
            return boxAt(x - static_cast<double>(rest < 0 ? rest + laps : rest), y, z);
        };
        Random random(0x5eed1307);
        crowd.boxes.clear();
        for (std::int32_t i = 0; i < kCount; ++i) {
            const double x = (i / 48 % 2 == 0 ? kFar : -kFar) * random.between(0.25F, 1);
            const double y = kFar * random.between(-1, 1);
            const double z = kFar * random.between(-1, 1);
            if (i % 3 == 0) {
                const double along = 2.0 * (i / 3 - kCount / 6);
                crowd.boxes.push_back(i / 48 % 2 == 0 ? boxAt(0.5, along + 0.5, 0.5)
                                                      : boxAt(0.5, 2.5, along + 0.5));
            } else if (place == CrowdPlace::anywhere) {
                crowd.boxes.push_back(
                    boxInBucket(std::floor(x) + 0.5, std::floor(y) + 0.5, std::floor(z) + 0.5));
            } else {
                const double lap = i / 73 - 80;
                crowd.boxes.push_back(
                    boxInBucket(lap * level.bucketCount + 0.5, 40 * (i % 73 - 36) + 0.5, 5.5));
            }
        }
        for (std::size_t i = 0; i < kCrowdTwins; ++i) {
            const Aabb<Scalar> box = crowd.boxes[i * 37];
            crowd.boxes.push_back(box);
        }
        crowd.table = fileInCellsOfOneMetre(crowd.boxes);
    }
    return crowd;
}

}  // namespace hashphase::demos
