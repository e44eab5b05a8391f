// SPDX-License-Identifier: Zlib
#pragma once

// Which cell sizes a table uses. Small proxies want small cells, large ones large cells, and every
// further size costs each smaller proxy a look at a few more rows. The choice is the cheapest one
// under a model of the walk's cost, found exactly by dynamic programming over size classes.

#include <broadphase/aabb.hpp>
#include <broadphase/hash/density_estimate.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::detail {

inline constexpr int kMaxLevels = 16;

/// Up to so many cells for each box of a level are dense, and a few more at any rate.
inline constexpr std::uint32_t kMostCellsPerBox = 6;
inline constexpr std::uint32_t kFewCells = 1024;

/// A hashed level has so many buckets for each box, or a few more.
inline constexpr std::uint32_t kHashedBucketsPerBox = 2;

/// Up to one box in so many may lie beyond the cells that are dense, half of them at either end of an axis.
inline constexpr std::uint32_t kBoxesPerStray = 32;
inline constexpr double kShareOfStrays = 0.5 / kBoxesPerStray;

/// Cell edges [m], finest first. What fits no level is filed without cells and is looked at by
/// every walk. Along its flat axes a level has one cell for everything: on a terrain, looking up
/// the layers above and below costs more than they keep away.
struct LevelSizes {
    std::array<double, kMaxLevels> cellSize{};
    std::array<AxisSet, kMaxLevels> flatAxes{};
    int count = 0;
};

/// Sizes, spread and crowding of a population: all that the choice of levels depends on. Allocates only while
/// it meets more samples or size classes than ever before.
class SizeCensus {
public:
    /// Counts one box, unless it has a NaN coordinate. Boxes with an infinite or negative edge count
    /// as fitting no level.
    /// Min corners are sampled to learn how far the population spreads, and how unevenly.
    template <class Scalar>
    void add(const Aabb<Scalar>& box);

    void clear();

    /// The level sizes with the least modelled cost for one walk per proxy. Deterministic: depends
    /// on the boxes counted and their order only. Cost: O(q^2) for q occupied quarter octaves.
    [[nodiscard]] LevelSizes cheapestLevels();

    /// Flattens each level along the axes where that is cheaper for the population.
    void flatten(LevelSizes& levels);

    /// Modelled cost [ns] of finding all pairs with levels of these cell sizes.
    [[nodiscard]] double modelledCost(const LevelSizes& levels);

    /// The middle of the population: the median min corner on each axis; finite.
    [[nodiscard]] std::array<double, 3> middle();

    /// Between which coordinates [m] the min corners lie, but for `share` of them at either end of
    /// each axis; finite.
    struct Range {
        std::array<double, 3> low{};
        std::array<double, 3> high{};
    };
    [[nodiscard]] Range range(double share);

    /// Bytes held beside the object itself, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    struct Bin {
        std::uint32_t count = 0;
        double largest = 0;  // [m]
    };
    // Sizes that share a level at any rate, and what cheapestLevels() finds out about them.
    struct SizeClass {
        double upperEdge = 0;  // [m]
        double countUpTo = 0;  // boxes of this class and smaller ones
        double leastCost = 0;  // of filing those, the last level ending here
        std::size_t from = 0;  // how many classes lie below that last level
    };

    void conclude();
    void measureSpread();
    void findClasses();
    [[nodiscard]] double smallestUsefulCell() const;
    [[nodiscard]] double rowsNearby(double cellSize, AxisSet flat) const;
    [[nodiscard]] double cellsAround(double cellSize, AxisSet flat) const;
    struct LevelCost {
        double cost = 0;
        AxisSet flat = 0;
    };
    [[nodiscard]] LevelCost costOfLevel(double cellSize, double own, double smaller) const;
    template <class Visit>
    double forLevels(const LevelSizes& levels, Visit&& visit);

    static constexpr int kQuarterOctaves = 4 * 256;
    static constexpr std::size_t kMaxSamples = 2048;

    [[nodiscard]] Bin& binOf(std::int64_t sizeClass);

    std::vector<Bin> histogram_;  // of the size classes from the smallest one met to the largest
    std::int64_t firstClass_ = 0;
    std::uint64_t total_ = 0;
    std::uint64_t sampleStep_ = 1;
    std::vector<std::array<double, 3>> samples_;

    // Drawn from the above by conclude().
    bool isConcluded_ = false;
    std::array<double, 3> spread_{};
    std::array<double, 3> mostOfSpread_{};  // but for the strays
    std::array<double, 3> middle_{};
    DensityEstimate density_;
    std::vector<SizeClass> classes_;  // occupied ones in ascending order, behind an empty one
    std::vector<double> column_;      // scratch
};

/// Levels of a fixed finest cell size: that size, and coarser ones by `ratio` for what is larger.
[[nodiscard]] inline LevelSizes fixedLevels(double cellSize, double ratio) {
    LevelSizes levels;
    for (; levels.count < kMaxLevels && cellSize <= 1e30; cellSize *= ratio) {
        levels.cellSize[static_cast<std::size_t>(levels.count++)] = cellSize;
    }
    return levels;
}

}  // namespace hashphase::detail
