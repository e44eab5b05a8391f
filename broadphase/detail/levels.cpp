// SPDX-License-Identifier: Zlib
#include <broadphase/detail/levels.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace hashphase::detail {
namespace {

// Modelled costs [ns], measured on a plain x86-64 build: looking up a run of buckets, testing a
// box found in one, and testing a box of the contiguous list of those that fit no level.
constexpr double kRunCost = 4.0;
constexpr double kBoxCost = 0.45;
constexpr double kListedBoxCost = 0.4;

// Cells beyond these sizes have no inverse in single precision.
constexpr double kSmallestCell = 1e-30;
constexpr double kLargestCell = 1e30;

// A quarter octave is the top of a double: the exponent and two bits of the fraction.
constexpr int kFractionShift = 50;
constexpr std::int64_t kLowestExponent = -128;
constexpr std::int64_t kFirstClassBits = (kLowestExponent + 1023) << 2;

// Cells are a little larger than the largest box of their class, so that rounding does not make it
// span a third one.
constexpr double kMargin = 1.01;

bool has(AxisSet axes, std::size_t axis) {
    return ((axes >> axis) & 1) != 0;
}

// Rows that a walk looks up, of the three cells an axis that are near; no axis has more cells than
// the population spreads over.
double rowsNearby(const std::array<double, 3>& spread, double cellSize, AxisSet flat) {
    double rows = 1;
    for (const std::size_t axis : {std::size_t{1}, std::size_t{2}}) {
        rows *= has(flat, axis) ? 1 : std::min(3.0, spread[axis] / cellSize + 1);
    }
    return rows;
}

// Share of the population in the 27 cells around a box.
double shareNearby(const std::array<double, 3>& spread, double cellSize, AxisSet flat) {
    double share = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        share *=
            has(flat, axis) ? 1 : std::min(1.0, 3 * cellSize / std::max(spread[axis], cellSize));
    }
    return share;
}

struct LevelCost {
    double cost = std::numeric_limits<double>::infinity();
    AxisSet flat = 0;
};

// Cost [ns] of the walks of `own` boxes on this level among themselves, and of those of `smaller`
// ones, with the axes flat that make it least.
LevelCost costOfLevel(const std::array<double, 3>& spread, double cellSize, double own,
                      double smaller) {
    LevelCost least;
    for (const AxisSet flat : {AxisSet{0b000}, AxisSet{0b010}, AxisSet{0b100}, AxisSet{0b110}}) {
        const double rows = rowsNearby(spread, cellSize, flat);
        const double boxes = own * shareNearby(spread, cellSize, flat);
        const double amongItself = own * 0.5 * ((rows + 1) * kRunCost + boxes * kBoxCost);
        const double fromSmaller = smaller * (rows * kRunCost + boxes * kBoxCost);
        if (amongItself + fromSmaller < least.cost) {
            least = {amongItself + fromSmaller, flat};
        }
    }
    return least;
}

// Cells much smaller than the distance between proxies are nearly all empty: they find nothing
// sooner and only scatter memory.
constexpr double kCellsPerBox = 16;

double smallestUsefulCell(const std::array<double, 3>& spread, double count) {
    const double largest = *std::max_element(spread.begin(), spread.end());
    // Below, divisions would come to a halt at the smallest number.
    if (!(largest > kSmallestCell)) {
        return 0;
    }
    double cellSize = largest;
    const auto cells = [&spread](double size) {
        double product = 1;
        for (const double axis : spread) {
            product *= std::max(1.0, axis / size);
        }
        return product;
    };
    while (cells(cellSize / 1.125) <= kCellsPerBox * count && cellSize > largest * 1e-7) {
        cellSize /= 1.125;
    }
    return cellSize;
}

}  // namespace

template <class Scalar>
void SizeCensus::add(const Aabb<Scalar>& box) {
    isConcluded_ = false;
    ++total_;
    const auto extent = static_cast<double>(box.sizes().maxCoeff());
    if (!(box.sizes().minCoeff() >= 0 && extent < kLargestCell / 2)) {
        return;
    }
    const auto bits =
        static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(extent) >> kFractionShift);
    const std::int64_t index =
        std::clamp<std::int64_t>(bits - kFirstClassBits, 0, kQuarterOctaves - 1);
    Bin& bin = histogram_[static_cast<std::size_t>(index)];
    ++bin.count;
    bin.largest = std::max(bin.largest, extent);
    if (total_ % sampleStep_ != 0 || !box.min().allFinite()) {
        return;
    }
    samples_.push_back({static_cast<double>(box.min()[0]), static_cast<double>(box.min()[1]),
                        static_cast<double>(box.min()[2])});
    if (samples_.size() == kMaxSamples) {
        // Keep every second sample and take them half as often from now on.
        for (std::size_t i = 0; i < kMaxSamples / 2; ++i) {
            samples_[i] = samples_[2 * i + 1];
        }
        samples_.resize(kMaxSamples / 2);
        sampleStep_ *= 2;
    }
}

template void SizeCensus::add<float>(const Aabb<float>&);
template void SizeCensus::add<double>(const Aabb<double>&);

void SizeCensus::clear() {
    isConcluded_ = false;
    histogram_.fill({});
    total_ = 0;
    sampleStep_ = 1;
    samples_.clear();
}

void SizeCensus::conclude() {
    if (!isConcluded_) {
        measureSpread();
        findClasses();
        isConcluded_ = true;
    }
}

void SizeCensus::measureSpread() {
    spread_ = {};
    middle_ = {};
    const auto [middle, same] = range(0.5);
    middle_ = middle;
    // The middle nine tenths, so that a few strays do not stretch the picture.
    const auto [low, high] = range(0.05);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double extent = high[axis] / 0.9 - low[axis] / 0.9;
        spread_[axis] = std::min(extent, std::numeric_limits<double>::max());
    }
}

SizeCensus::Range SizeCensus::range(double share) {
    Range result;
    for (std::size_t axis = 0; axis < 3 && !samples_.empty(); ++axis) {
        column_.clear();
        for (const auto& sample : samples_) {
            column_.push_back(sample[axis]);
        }
        const auto quantile = [this](double ofAll) {
            const double rank = ofAll * static_cast<double>(column_.size() - 1);
            const auto nth = column_.begin() + static_cast<std::ptrdiff_t>(rank);
            std::nth_element(column_.begin(), nth, column_.end());
            return *nth;
        };
        result.low[axis] = quantile(share);
        result.high[axis] = quantile(1 - share);
    }
    return result;
}

void SizeCensus::findClasses() {
    const double floor = std::clamp(smallestUsefulCell(spread_, static_cast<double>(total_)),
                                    kSmallestCell, kLargestCell);
    classes_.assign(1, {});
    for (const Bin& bin : histogram_) {
        if (bin.count == 0) {
            continue;
        }
        const double edge = std::max(bin.largest * kMargin, floor);
        if (classes_.back().upperEdge != edge) {
            classes_.push_back({edge, classes_.back().countUpTo});
        }
        classes_.back().countUpTo += bin.count;
    }
}

LevelSizes SizeCensus::cheapestLevels() {
    conclude();
    for (std::size_t q = 1; q < classes_.size(); ++q) {
        SizeClass& last = classes_[q];
        last.leastCost = std::numeric_limits<double>::infinity();
        for (std::size_t p = 0; p < q; ++p) {
            const SizeClass& below = classes_[p];
            const double cost =
                below.leastCost + costOfLevel(spread_, last.upperEdge,
                                              last.countUpTo - below.countUpTo, below.countUpTo)
                                      .cost;
            if (cost < last.leastCost) {
                last.leastCost = cost;
                last.from = p;
            }
        }
    }

    // What lies above the last level is listed without cells.
    const auto total = static_cast<double>(total_);
    std::size_t end = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t q = 0; q < classes_.size(); ++q) {
        const double listed = total - classes_[q].countUpTo;
        const double cost = classes_[q].leastCost + total * listed * kListedBoxCost;
        if (cost < least) {
            least = cost;
            end = q;
        }
    }

    LevelSizes levels;
    for (std::size_t q = end; q > 0 && levels.count < kMaxLevels; q = classes_[q].from) {
        levels.cellSize[static_cast<std::size_t>(levels.count++)] = classes_[q].upperEdge;
    }
    std::reverse(levels.cellSize.begin(), levels.cellSize.begin() + levels.count);
    flatten(levels);
    return levels;
}

// Calls visit(level number, boxes on it, boxes on finer ones) for each level, and returns how many
// boxes all of them have.
template <class Visit>
double SizeCensus::forLevels(const LevelSizes& levels, Visit&& visit) {
    conclude();
    double smaller = 0;
    std::size_t q = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(levels.count); ++i) {
        while (q + 1 < classes_.size() && classes_[q + 1].upperEdge <= levels.cellSize[i]) {
            ++q;
        }
        visit(i, classes_[q].countUpTo - smaller, smaller);
        smaller = classes_[q].countUpTo;
    }
    return smaller;
}

void SizeCensus::flatten(LevelSizes& levels) {
    forLevels(levels, [&](std::size_t i, double own, double smaller) {
        levels.flatAxes[i] = costOfLevel(spread_, levels.cellSize[i], own, smaller).flat;
    });
}

double SizeCensus::modelledCost(const LevelSizes& levels) {
    double cost = 0;
    const double filed = forLevels(levels, [&](std::size_t i, double own, double smaller) {
        cost += costOfLevel(spread_, levels.cellSize[i], own, smaller).cost;
    });
    const auto total = static_cast<double>(total_);
    return cost + total * (total - filed) * kListedBoxCost;
}

std::array<double, 3> SizeCensus::middle() {
    conclude();
    return middle_;
}

std::size_t SizeCensus::memoryBytes() const noexcept {
    return samples_.capacity() * sizeof(samples_[0]) + classes_.capacity() * sizeof(SizeClass) +
           column_.capacity() * sizeof(double);
}

LevelSizes fixedLevels(double cellSize, double ratio) {
    LevelSizes levels;
    for (; levels.count < kMaxLevels && cellSize <= 1e30; cellSize *= ratio) {
        levels.cellSize[static_cast<std::size_t>(levels.count++)] = cellSize;
    }
    return levels;
}

}  // namespace hashphase::detail
