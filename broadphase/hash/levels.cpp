// SPDX-License-Identifier: Zlib
#include <broadphase/hash/levels.hpp>

#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace hashphase::detail {
namespace {

// Modelled costs [ns], measured on a plain x86-64 build: looking up a run of buckets that are
// dense, or hashed, which may wrap around; one box more in a run; the mispredicted branches of a long
// run; a box of the contiguous list of those that fit no level; keeping a bucket.
constexpr double kRunCost = 3.7;
constexpr double kHashedRunCost = 4.5;
constexpr double kBoxCost = 0.15;
constexpr double kLongRunCost = 8.5;
constexpr double kListedBoxCost = 0.4;
constexpr double kBucketCost = 0.85;

// The first eight boxes of a run are tested at once, whether or not there are as many: of runs of
// this mean length about half are long.
constexpr double kLongRun = 10;

// What it takes to read so many boxes in so many runs.
double costOfReading(double runs, double boxes) {
    const double length = boxes / runs;
    const double shareOfLong = length * length / (length * length + kLongRun * kLongRun);
    return boxes * kBoxCost + runs * shareOfLong * kLongRunCost;
}

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

// Of sizes 1:65,536; boxes that settle are filed by more sizes than they have.
constexpr std::size_t kUsualClasses = 64;

bool has(AxisSet axes, std::size_t axis) {
    return ((axes >> axis) & 1) != 0;
}

// Cells much smaller than the distance between proxies are nearly all empty: they find nothing
// sooner and only scatter memory. So many a box can be dense.
constexpr double kCellsPerBox = 4;

}  // namespace

template <class Scalar>
void SizeCensus::add(const Aabb<Scalar>& box) {
    if (hasNan(box)) {
        return;  // it is not filed
    }
    isConcluded_ = false;
    ++total_;
    const auto extent = static_cast<double>(box.sizes().maxCoeff());
    if (!(box.sizes().minCoeff() >= 0 && extent < kLargestCell / 2)) {
        return;
    }
    const auto bits =
        static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(extent) >> kFractionShift);
    Bin& bin = binOf(std::clamp<std::int64_t>(bits - kFirstClassBits, 0, kQuarterOctaves - 1));
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

SizeCensus::Bin& SizeCensus::binOf(std::int64_t sizeClass) {
    firstClass_ = histogram_.empty() ? sizeClass : firstClass_;
    if (sizeClass < firstClass_) {
        histogram_.insert(histogram_.begin(), static_cast<std::size_t>(firstClass_ - sizeClass),
                          Bin{});
        firstClass_ = sizeClass;
    }
    const auto place = static_cast<std::size_t>(sizeClass - firstClass_);
    if (place >= histogram_.size()) {
        histogram_.resize(place + 1);
    }
    return histogram_[place];
}

void SizeCensus::clear() {
    isConcluded_ = false;
    histogram_.clear();
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

// Rows that a walk looks up, of the three cells an axis that are near; no axis has more cells than
// the population spreads over.
double SizeCensus::rowsNearby(double cellSize, AxisSet flat) const {
    double rows = 1;
    for (const std::size_t axis : {std::size_t{1}, std::size_t{2}}) {
        rows *= has(flat, axis) ? 1 : std::min(3.0, spread_[axis] / cellSize + 1);
    }
    return rows;
}

// Cells between the ends of all but a few of the population, which are those that may be dense.
double SizeCensus::cellsAround(double cellSize, AxisSet flat) const {
    double cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        cells *= has(flat, axis) ? 1 : mostOfSpread_[axis] / cellSize + 1;
    }
    return cells;
}

// Cost [ns] of a level for `own` boxes, of their walks among themselves, and of those of `smaller`
// ones, with the axes flat that make it least.
SizeCensus::LevelCost SizeCensus::costOfLevel(double cellSize, double own, double smaller) const {
    LevelCost least{std::numeric_limits<double>::infinity(), 0};
    for (const AxisSet flat : {AxisSet{0b000}, AxisSet{0b010}, AxisSet{0b100}, AxisSet{0b110}}) {
        const double rows = rowsNearby(cellSize, flat);
        const double boxes = own * density_.shareInCell(3 * cellSize, flat);
        // Cells that are too many to be dense are hashed.
        const double cells = cellsAround(cellSize, flat);
        const bool isDense = cells < kMostCellsPerBox * own + kFewCells;
        const double runCost = isDense ? kRunCost : kHashedRunCost;
        const double buckets = isDense ? cells : kHashedBucketsPerBox * own;
        const double runs = 0.5 * (rows + 1);
        const double cost = buckets * kBucketCost +
                            own * (runs * runCost + costOfReading(runs, 0.5 * boxes)) +
                            smaller * (rows * runCost + costOfReading(rows, boxes));
        if (cost < least.cost) {
            least = {cost, flat};
        }
    }
    return least;
}

double SizeCensus::smallestUsefulCell() const {
    const double largest = *std::max_element(spread_.begin(), spread_.end());
    // Below, divisions would come to a halt at the smallest number.
    if (!(largest > kSmallestCell)) {
        return 0;
    }
    const double fewest = 1 / (kCellsPerBox * static_cast<double>(total_));
    double cellSize = largest;
    while (density_.shareInCell(cellSize / 1.125, 0) >= fewest && cellSize > largest * 1e-7) {
        cellSize /= 1.125;
    }
    return cellSize;
}

void SizeCensus::measureSpread() {
    spread_ = {};
    mostOfSpread_ = {};
    middle_ = {};
    const auto [middle, same] = range(0.5);
    middle_ = middle;
    const auto [first, last] = range(kShareOfStrays);
    // The middle nine tenths, so that a few strays do not stretch the picture.
    const auto [low, high] = range(0.05);
    density_.measure(samples_, low, high);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double extent = high[axis] / 0.9 - low[axis] / 0.9;
        spread_[axis] = std::min(extent, std::numeric_limits<double>::max());
        mostOfSpread_[axis] =
            std::min(last[axis] - first[axis], std::numeric_limits<double>::max());
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
    const double floor = std::clamp(smallestUsefulCell(), kSmallestCell, kLargestCell);
    ensureCapacity(classes_, kUsualClasses);
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
                below.leastCost +
                costOfLevel(last.upperEdge, last.countUpTo - below.countUpTo, below.countUpTo).cost;
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
        levels.flatAxes[i] = costOfLevel(levels.cellSize[i], own, smaller).flat;
    });
}

double SizeCensus::modelledCost(const LevelSizes& levels) {
    double cost = 0;
    const double filed = forLevels(levels, [&](std::size_t i, double own, double smaller) {
        cost += costOfLevel(levels.cellSize[i], own, smaller).cost;
    });
    const auto total = static_cast<double>(total_);
    return cost + total * (total - filed) * kListedBoxCost;
}

std::array<double, 3> SizeCensus::middle() {
    conclude();
    return middle_;
}

std::size_t SizeCensus::memoryBytes() const noexcept {
    return histogram_.capacity() * sizeof(Bin) + samples_.capacity() * sizeof(samples_[0]) +
           classes_.capacity() * sizeof(SizeClass) + column_.capacity() * sizeof(double) +
           density_.memoryBytes();
}

}  // namespace hashphase::detail
