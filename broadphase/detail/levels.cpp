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

double upperEdgeOfClass(int index) {
    return std::bit_cast<double>(
        static_cast<std::uint64_t>(kFirstClassBits + index + 1) << kFractionShift);
}

// Walks look at three cells an axis; no axis has more cells than the population spreads over.
double cellsAcross(double spread, double cellSize, double cells) {
    return std::min(cells, spread / cellSize + 1);
}

double shareInNeighbourhood(const std::array<double, 3>& spread, double cellSize) {
    double share = 1;
    for (const double axis : spread) {
        share *= std::min(1.0, 3 * cellSize / std::max(axis, cellSize));
    }
    return share;
}

double costOfLevel(const std::array<double, 3>& spread, double cellSize, double own,
                   double smaller) {
    const double rows =
        cellsAcross(spread[1], cellSize, 3) * cellsAcross(spread[2], cellSize, 3);
    const double share = shareInNeighbourhood(spread, cellSize);
    const double amongItself = own * (0.5 * (rows + 1) * kRunCost + 0.5 * own * share * kBoxCost);
    const double fromSmaller = smaller * (rows * kRunCost + own * share * kBoxCost);
    return amongItself + fromSmaller;
}

// Cells much smaller than the distance between proxies are nearly all empty: they find nothing
// sooner and only scatter memory.
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
    while (cells(cellSize / 1.125) <= 3 * count && cellSize > largest * 1e-7) {
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
    const auto bits = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(extent) >> kFractionShift);
    const std::int64_t index = std::clamp<std::int64_t>(bits - kFirstClassBits, 0, kQuarterOctaves - 1);
    ++histogram_[static_cast<std::size_t>(index)];
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
    histogram_.fill(0);
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
    const double floor =
        std::clamp(smallestUsefulCell(spread(), static_cast<double>(total_)), kSmallestCell,
                   kLargestCell);
    std::vector<SizeClass> classes;
    for (int i = 0; i < kQuarterOctaves; ++i) {
        const auto count = static_cast<double>(histogram_[static_cast<std::size_t>(i)]);
        if (count == 0) {
            continue;
        }
        const double edge = std::max(upperEdgeOfClass(i), floor);
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
                                                      countUpTo[q] - countUpTo[p], countUpTo[p]);
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
    return levels;
}

double SizeCensus::modelledCost(const LevelSizes& levels) const {
    const std::array<double, 3> extent = spread();
    const std::vector<SizeClass> classes = occupiedClasses();
    double cost = 0;
    double smaller = 0;
    auto next = classes.begin();
    for (int i = 0; i < levels.count; ++i) {
        const double cellSize = levels.cellSize[static_cast<std::size_t>(i)];
        double own = 0;
        for (; next != classes.end() && next->upperEdge <= cellSize; ++next) {
            own += next->count;
        }
        cost += costOfLevel(extent, cellSize, own, smaller);
        smaller += own;
    }
    const auto total = static_cast<double>(total_);
    return cost + total * (total - smaller) * kListedBoxCost;
}

LevelSizes fixedLevels(double cellSize, double ratio) {
    LevelSizes levels;
    for (; levels.count < kMaxLevels && cellSize <= 1e30; cellSize *= ratio) {
        levels.cellSize[static_cast<std::size_t>(levels.count++)] = cellSize;
    }
    return levels;
}

}  // namespace hashphase::detail
