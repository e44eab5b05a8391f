// SPDX-License-Identifier: Zlib
#include <demos/accuracy/baselines/paper_map.hpp>
#include <demos/scenes/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace hashphase::demos {
namespace {

constexpr float kSide = 100;
constexpr std::array kCellSizes{0.7F, 3.0F, 10.0F, 30.0F, 250.0F};

Aabb<float> domainOfMap() {
    return {Vector3<float>(-20, 0, 5), Vector3<float>(kSide - 20, 9, kSide + 5)};
}

std::vector<Aabb<float>> boxesOfMap(std::uint32_t count, float largest, std::uint64_t seed) {
    Random random(seed);
    std::vector<Aabb<float>> boxes;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vector3<float> low(random.between(-20, kSide - 20 - largest), random.between(0, 5),
                                 random.between(5, kSide + 5 - largest));
        boxes.emplace_back(
            low, low + Vector3<float>(random.between(0, largest), 1, random.between(0, largest)));
    }
    return boxes;
}

bool isIn(const PaperMap& map, std::uint32_t object, int x, int z) {
    const std::span<const std::uint32_t> bucket = map.objects(x, z);
    return std::count(bucket.begin(), bucket.end(), object) == 1;
}

TEST(PaperMap, HasEachBoxOnceInEveryCellOfItsRangeAndInNoOther) {
    const std::vector<Aabb<float>> boxes = boxesOfMap(200, 12, 3);
    for (const float cellSize : kCellSizes) {
        PaperMap map(domainOfMap(), cellSize);
        for (int wipe = 0; wipe < 2; ++wipe) {
            map.refile(boxes);
            const PaperMap::Range all = map.all();
            for (int z = all.lowZ; z <= all.highZ; ++z) {
                std::vector<std::uint32_t> row;
                for (int x = all.lowX; x <= all.highX; ++x) {
                    const std::span<const std::uint32_t> bucket = map.objects(x, z);
                    const std::size_t begin = row.size();
                    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
                        const PaperMap::Range cells = map.range(boxes[i]);
                        if (x >= cells.lowX && x <= cells.highX && z >= cells.lowZ &&
                            z <= cells.highZ) {
                            row.push_back(i);
                        }
                    }
                    ASSERT_TRUE(std::ranges::equal(bucket, std::span(row).subspan(begin)))
                        << x << ' ' << z;
                }
                EXPECT_TRUE(std::ranges::equal(map.row(all.lowX, all.highX, z), row)) << z;
            }
        }
    }
}

TEST(PaperMap, PutsTheBoxesOfAPairThatOverlapsIntoOneCellAtLeast) {
    // Many meet exactly at borders of cells, where a product and a quotient are rounded differently.
    std::vector<Aabb<float>> boxes = boxesOfMap(300, 8, 5);
    for (int i = 0; i < 100; ++i) {
        const Vector3<float> corner(-20 + 0.7F * static_cast<float>(i), 0, 5);
        boxes.emplace_back(corner - Vector3<float>(0.7F, 0, 0), corner + Vector3<float>(0, 1, 1));
    }
    for (const float cellSize : kCellSizes) {
        PaperMap map(domainOfMap(), cellSize);
        map.refile(boxes);
        for (std::size_t a = 0; a < boxes.size(); ++a) {
            for (std::size_t b = a + 1; b < boxes.size(); ++b) {
                if (overlaps(boxes[a], boxes[b])) {
                    const PaperMap::Cell first =
                        map.cellAt(std::max(boxes[a].min().x(), boxes[b].min().x()),
                                   std::max(boxes[a].min().z(), boxes[b].min().z()));
                    ASSERT_TRUE(isIn(map, static_cast<std::uint32_t>(a), first.x, first.z));
                    ASSERT_TRUE(isIn(map, static_cast<std::uint32_t>(b), first.x, first.z));
                }
            }
        }
    }
}

TEST(PaperMap, HasEachPointInTheCellOfItsPlace) {
    Random random(7);
    std::vector<Vector3<float>> points;
    for (int i = 0; i < 500; ++i) {
        points.emplace_back(random.between(-20, kSide - 20), 0, random.between(5, kSide + 5));
    }
    for (const float cellSize : kCellSizes) {
        PaperMap map(domainOfMap(), cellSize);
        map.refile(points);
        std::size_t filed = 0;
        const PaperMap::Range all = map.all();
        for (int z = all.lowZ; z <= all.highZ; ++z) {
            filed += map.row(all.lowX, all.highX, z).size();
        }
        EXPECT_EQ(filed, points.size());
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            const PaperMap::Cell cell = map.cellAt(points[i].x(), points[i].z());
            ASSERT_TRUE(isIn(map, i, cell.x, cell.z));
            Aabb<float> square = map.square(cell.x, cell.z);
            square.min().array() -= 1e-3F;
            square.max().array() += 1e-3F;
            ASSERT_TRUE(square.contains(points[i]));
        }
    }
}

TEST(PaperMap, HasWhatLiesBeyondTheDomainInTheOutermostCells) {
    PaperMap map(domainOfMap(), 30);
    EXPECT_EQ(map.all().highX, 3);
    EXPECT_EQ(map.all().highZ, 3);
    const std::array points{Vector3<float>(-1e30F, 0, 1e30F), Vector3<float>(-20.5F, 0, 105)};
    map.refile(points);
    EXPECT_TRUE(isIn(map, 0, 0, 3));
    EXPECT_TRUE(isIn(map, 1, 0, 3));
    const PaperMap::Range all = map.range(-1e30F, -1e30F, 1e30F, 1e30F);
    EXPECT_EQ(all.lowX, 0);
    EXPECT_EQ(all.lowZ, 0);
    EXPECT_EQ(all.highX, 3);
    EXPECT_EQ(all.highZ, 3);
}

}  // namespace
}  // namespace hashphase::demos
