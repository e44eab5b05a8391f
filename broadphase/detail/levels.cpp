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
constexpr double kRunCost = 6.0;
constexpr double kBoxCost = 1.2;
constexpr double kListedBoxCost = 0.8;

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
    if (!(largest > 0)) {
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
    ++total_;
    const auto extent = static_cast<double>(box.sizes().maxCoeff());
    if (!(box.sizes().minCoeff() >= 0 && extent < kLargestCell / 2)) {
        ++unfit_;
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
    histogram_.fill({});
    total_ = 0;
    unfit_ = 0;
    sampleStep_ = 1;
    samples_.clear();
}

double SizeCensus::quantile(std::size_t axis, double share) const {
    if (samples_.empty()) {
        return 0;
    }
    std::vector<double> values(samples_.size());
    std::transform(samples_.begin(), samples_.end(), values.begin(),
                   [axis](const auto& sample) { return sample[axis]; });
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

std::array<double, 3> SizeCensus::spread() const {
    std::array<double, 3> spread{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // The middle nine tenths, so that a few strays do not stretch the picture.
        const double middle = quantile(axis, 0.95) / 0.9 - quantile(axis, 0.05) / 0.9;
        spread[axis] = std::min(middle, std::numeric_limits<double>::max());
    }
    return spread;
}

std::array<double, 3> SizeCensus::middle() const {
    return {quantile(0, 0.5), quantile(1, 0.5), quantile(2, 0.5)};
}

std::vector<SizeCensus::SizeClass> SizeCensus::occupiedClasses() const {
    const double floor = std::clamp(smallestUsefulCell(spread(), static_cast<double>(total_)),
                                    kSmallestCell, kLargestCell);
    std::vector<SizeClass> classes;
    for (const Bin& bin : histogram_) {
        const auto count = static_cast<double>(bin.count);
        if (bin.count == 0) {
            continue;
        }
        const double edge = std::max(bin.largest * kMargin, floor);
        if (!classes.empty() && classes.back().upperEdge == edge) {
            classes.back().count += count;
        } else {
            classes.push_back({edge, count});
        }
    }
    return classes;
}

LevelSizes SizeCensus::cheapestLevels() const {
    const std::vector<SizeClass> classes = occupiedClasses();
    const std::array<double, 3> extent = spread();
    const std::size_t n = classes.size();

    // best[q]: the least cost of filing the first q classes on levels, the last of which ends at
    // class q; from[q]: where that last level begins.
    std::vector<double> best(n + 1, std::numeric_limits<double>::infinity());
    std::vector<double> countUpTo(n + 1, 0);
    std::vector<std::size_t> from(n + 1, 0);
    best[0] = 0;
    for (std::size_t q = 1; q <= n; ++q) {
        countUpTo[q] = countUpTo[q - 1] + classes[q - 1].count;
        for (std::size_t p = 0; p < q; ++p) {
            const double cost = best[p] + costOfLevel(extent, classes[q - 1].upperEdge,
                                                      countUpTo[q] - countUpTo[p], countUpTo[p])
                                              .cost;
            if (cost < best[q]) {
                best[q] = cost;
                from[q] = p;
            }
        }
    }

    // What lies above the last level is listed without cells.
    const auto total = static_cast<double>(total_);
    std::size_t last = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t q = 0; q <= n; ++q) {
        const double listed = total - countUpTo[q];
        const double cost = best[q] + total * listed * kListedBoxCost;
        if (cost < least) {
            least = cost;
            last = q;
        }
    }

    LevelSizes levels;
    for (std::size_t q = last; q > 0 && levels.count < kMaxLevels; q = from[q]) {
        levels.cellSize[static_cast<std::size_t>(levels.count++)] = classes[q - 1].upperEdge;
    }
    std::reverse(levels.cellSize.begin(), levels.cellSize.begin() + levels.count);
    flatten(levels);
    return levels;
}

// Calls visit(level number, boxes on it, boxes on finer ones) for each level, and returns how many
// boxes all of them have.
template <class Visit>
double SizeCensus::forLevels(const LevelSizes& levels, Visit&& visit) const {
    const std::vector<SizeClass> classes = occupiedClasses();
    double smaller = 0;
    auto next = classes.begin();
    for (std::size_t i = 0; i < static_cast<std::size_t>(levels.count); ++i) {
        double own = 0;
        for (; next != classes.end() && next->upperEdge <= levels.cellSize[i]; ++next) {
            own += next->count;
        }
        visit(i, own, smaller);
        smaller += own;
    }
    return smaller;
}

void SizeCensus::flatten(LevelSizes& levels) const {
    const std::array<double, 3> extent = spread();
    forLevels(levels, [&](std::size_t i, double own, double smaller) {
        levels.flatAxes[i] = costOfLevel(extent, levels.cellSize[i], own, smaller).flat;
    });
}

double SizeCensus::modelledCost(const LevelSizes& levels) const {
    const std::array<double, 3> extent = spread();
    double cost = 0;
    const double filed = forLevels(levels, [&](std::size_t i, double own, double smaller) {
        cost += costOfLevel(extent, levels.cellSize[i], own, smaller).cost;
    });
    const auto total = static_cast<double>(total_);
    return cost + total * (total - filed) * kListedBoxCost;
}

LevelSizes fixedLevels(double cellSize, double ratio) {
    LevelSizes levels;
    for (; levels.count < kMaxLevels && cellSize <= 1e30; cellSize *= ratio) {
        levels.cellSize[static_cast<std::size_t>(levels.count++)] = cellSize;
    }
    return levels;
}

}  // namespace hashphase::detail
