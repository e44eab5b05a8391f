// SPDX-License-Identifier: Zlib
#include <broadphase/hash/level_layout.hpp>

#include <broadphase/core/fixed_list.hpp>
#include <broadphase/geometry/origin_shift.hpp>

#include <cmath>
#include <limits>
#include <optional>

namespace hashphase::detail {
namespace {

// How often the cell sizes are looked at again while the number of proxies stays about the same.
constexpr std::uint32_t kBuildsBetweenCensuses = 128;

// A layout reaches a little beyond the population, so that it holds for some builds.
std::int32_t marginOf(std::int32_t low, std::int32_t high) {
    return high - low < 8 ? 0 : 1 + (high - low) / 128;
}

// The cell of a box that is filed on this level, or nothing where it is not to be.
template <class Scalar>
std::optional<Cell> cellOn(const Level<Scalar>& level, const Aabb<Scalar>& box) {
    Cell low{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<Eigen::Index>(axis);
        const Scalar edge = box.max()[at] - box.min()[at];
        low[axis] = level.cell(box.min()[at], axis);
        const std::int32_t high = level.cell(box.max()[at], axis);
        const bool isClamped = low[axis] <= -kCellLimit || high >= kCellLimit;
        const bool spansAtMostTwo = high == low[axis] || high == low[axis] + 1;
        if (!(edge <= level.largestEdge) || isClamped || !spansAtMostTwo) {
            return std::nullopt;
        }
    }
    return low;
}

/// A cell size on its way to become levels: what both of them have in common, and what will be filed there.
template <class Scalar>
struct Candidate {
    Level<Scalar> level;
    CellReach reach;
};
template <class Scalar>
using Candidates = FixedList<Candidate<Scalar>, kMaxLevels>;

// Finds how many boxes each cell size has, and the cells between which they are.
template <class Scalar>
void measure(std::span<const PaddedBox<Scalar>> boxes, Candidates<Scalar>& candidates) {
    for (Candidate<Scalar>& candidate : candidates) {
        candidate.reach = {};
    }
    for (const PaddedBox<Scalar>& padded : boxes) {
        const Aabb<Scalar> box = unpadded(padded);
        for (Candidate<Scalar>& candidate : candidates) {
            if (const std::optional<Cell> cell = cellOn(candidate.level, box)) {
                candidate.reach.add(*cell);
                break;
            }
        }
    }
}

// Returns false when there are too many cells for so few boxes.
template <class Scalar>
bool makeDense(Level<Scalar>& level, std::uint32_t count) {
    std::array<std::uint64_t, 3> extent{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int32_t margin = marginOf(level.low[axis], level.high[axis]);
        level.low[axis] -= margin;
        level.high[axis] += margin;
        extent[axis] = static_cast<std::uint64_t>(level.high[axis] - level.low[axis]) + 1;
    }
    // An empty cell behind each row, which is the one before the next; where a layer has several
    // rows, an empty one behind them likewise; and an empty layer behind the last.
    const std::uint64_t pitch = extent[0] + 1;
    const std::uint64_t rows = extent[1] == 1 ? 1 : extent[1] + 1;
    const std::uint64_t layers = extent[2] == 1 ? 1 : extent[2] + 1;
    if (extent[1] * extent[2] > 8ULL * count || rows * layers > 16ULL * count + 64 ||
        pitch * rows * layers > std::uint64_t{kMostCellsPerBox} * count + kFewCells) {
        return false;
    }
    level.strideY = static_cast<std::uint32_t>(pitch);
    level.strideZ = static_cast<std::uint32_t>(pitch * rows);
    level.base = 0;
    level.base = 1 - level.low[0] - level.offset({level.low[1], level.low[2]});
    const std::uint64_t rowsBehind = rows * layers == 1 ? 0 : 1;
    level.bucketCount = static_cast<std::uint32_t>(pitch * (rows * layers + rowsBehind) + 2);
    return true;
}

// Cells go round after so many along x and y: all that there are along short axes, and equally many along the
// others, so that each of the things that lie far apart has its cells to itself and shares some with others.
// These numbers are odd, as that of buckets is, lest what lies at a power of two apart share all of them. They
// are no less than 3, and together no more than a quarter of the buckets, so that a cell and the 26 around it
// have a bucket each.
template <class Scalar>
void numberHashed(Level<Scalar>& level, const CellReach& reach, std::uint32_t bucketCount) {
    const auto extent = [&](std::size_t axis) {
        return double{1} + reach.high[axis] - reach.low[axis];
    };
    std::array<std::size_t, 3> shortestFirst{0, 1, 2};
    std::sort(shortestFirst.begin(), shortestFirst.end(),
              [&](std::size_t a, std::size_t b) { return extent(a) < extent(b); });
    std::array<std::uint32_t, 3> period{1, 1, 1};
    double left = bucketCount;
    double axesLeft = 3;
    for (const std::size_t axis : shortestFirst) {
        const double share = std::pow(left, 1 / axesLeft--);
        if (level.inverseCellSize[axis] != 0) {
            period[axis] =
                1 | static_cast<std::uint32_t>(std::min(std::max(extent(axis), 3.0) + 1, share));
            left /= period[axis];
        }
    }
    level.strideY = period[0];
    level.strideZ = period[0] * period[1];
    level.bucketCount = bucketCount;
    level.lapsPerBucket = 1 / static_cast<double>(bucketCount);
    // So many whole laps that no cell has a negative number.
    const std::int64_t most = level.offset({kCellLimit, kCellLimit}) + kCellLimit;
    level.base = (most / bucketCount + 1) * bucketCount;
}

// The cell sizes as they were chosen, but for those that few boxes have: what is of such a size goes to
// the next larger cells, or to the list.
template <class Scalar>
Candidates<Scalar> candidatesFor(const LevelSizes& sizes, const std::array<Scalar, 3>& origin,
                                 std::span<const PaddedBox<Scalar>> boxes) {
    Candidates<Scalar> all;
    for (std::size_t i = 0; i < static_cast<std::size_t>(sizes.count); ++i) {
        Candidate<Scalar> candidate;
        candidate.level.largestEdge = static_cast<Scalar>(sizes.cellSize[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool isFlat = ((sizes.flatAxes[i] >> axis) & 1) != 0;
            candidate.level.origin[axis] = origin[axis];
            candidate.level.inverseCellSize[axis] =
                isFlat ? Scalar(0) : static_cast<Scalar>(1 / sizes.cellSize[i]);
        }
        all.push(candidate);
    }
    measure(boxes, all);
    Candidates<Scalar> kept;
    bool areFewElsewhere = false;
    for (const Candidate<Scalar>& candidate : all) {
        const bool areFew = candidate.reach.count < LevelLayout<Scalar>::kThinLevel;
        areFewElsewhere = areFewElsewhere || (areFew && candidate.reach.count > 0);
        if (!areFew) {
            kept.push(candidate);
        }
    }
    if (areFewElsewhere && !kept.empty()) {
        measure(boxes, kept);
    }
    return kept;
}

}  // namespace

// Cell sizes are chosen again when the number of proxies has changed, and now and then.
template <class Scalar>
bool LevelLayout<Scalar>::isTimeToChoose(std::size_t count) {
    const bool sameCount = 4 * count <= 5 * countWhenChosen_ && 5 * count >= 4 * countWhenChosen_;
    return !sameCount || ++buildsSinceChosen_ >= kBuildsBetweenCensuses;
}

template <class Scalar>
void LevelLayout<Scalar>::choose(std::span<const PaddedBox<Scalar>> boxes,
                                 const LevelSizes& fixed) {
    countWhenChosen_ = boxes.size();
    buildsSinceChosen_ = 0;
    census_.clear();
    for (const PaddedBox<Scalar>& box : boxes) {
        census_.add(unpadded(box));
    }
    const LevelSizes fresh = fixed.count > 0 ? fixed : census_.cheapestLevels();
    // Only a clear gain changes the sizes, so that they do not oscillate.
    if (sizes_.count == 0 || census_.modelledCost(fresh) < 0.9 * census_.modelledCost(sizes_)) {
        sizes_ = fresh;
    }
    census_.flatten(sizes_);
    const std::array<double, 3> middle = census_.middle();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        origin_[axis] = static_cast<Scalar>(middle[axis]);
    }
    middle_ = census_.range(kShareOfStrays);
}

// A few strays must not keep all the others from being dense: where the whole population
// is too sparse, its middle may be dense enough.
template <class Scalar>
void LevelLayout<Scalar>::layOutDense(Level<Scalar>& level, const CellReach& reach) const {
    level.kind = LevelKind::dense;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        level.low[axis] = reach.low[axis];
        level.high[axis] = reach.high[axis];
    }
    if (makeDense(level, reach.count)) {
        return;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        level.low[axis] = level.cell(static_cast<Scalar>(middle_.low[axis]), axis);
        level.high[axis] = level.cell(static_cast<Scalar>(middle_.high[axis]), axis);
    }
    if (!makeDense(level, reach.count)) {
        std::fill_n(level.low, 3, 1);
        std::fill_n(level.high, 3, 0);
        level.bucketCount = 1;
    }
}

// Which cells share buckets is chance, unless things lie at equal distances: then the same chance may be that of
// many. So some numbers of buckets are tried, until cells of a sample share no more than by chance; where most boxes
// are in dense cells, the first will do.
template <class Scalar>
void LevelLayout<Scalar>::layOutHashed(Level<Scalar>& level, const CellReach& reach,
                                       std::uint32_t count,
                                       std::span<const PaddedBox<Scalar>> boxes) {
    constexpr std::size_t kMostSamples = 2048;
    constexpr std::uint32_t kMostTries = 8;
    level.kind = LevelKind::hashed;
    const auto bucketCountOf = [count](std::uint32_t attempt) {
        return 1 | static_cast<std::uint32_t>(
                       std::max(std::uint64_t{64}, std::uint64_t{count} * (32 + attempt) / 16));
    };
    if (count < reach.count) {
        numberHashed(level, reach, bucketCountOf(0));
        return;
    }
    cells_.clear();
    for (std::size_t i = 0; i < boxes.size(); i += 1 + boxes.size() / kMostSamples) {
        if (const std::optional<Cell> cell = cellOn(level, unpadded(boxes[i]))) {
            cells_.push_back(*cell);
        }
    }
    std::sort(cells_.begin(), cells_.end());
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
    std::uint32_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t attempt = 0; attempt < kMostTries && least > 1.25; ++attempt) {
        numberHashed(level, reach, bucketCountOf(attempt));
        const double crowding = crowdingOf(level);
        if (crowding < least) {
            least = crowding;
            best = attempt;
        }
    }
    numberHashed(level, reach, bucketCountOf(best));
}

// How many pairs of the sampled cells share a bucket, of how many would by chance.
template <class Scalar>
double LevelLayout<Scalar>::crowdingOf(const Level<Scalar>& level) {
    buckets_.clear();
    for (const auto& [x, y, z] : cells_) {
        buckets_.push_back(level.bucket(x, {y, z}));
    }
    std::sort(buckets_.begin(), buckets_.end());
    std::size_t pairs = 0;
    std::size_t run = 0;
    for (std::size_t i = 1; i < buckets_.size(); ++i) {
        run = buckets_[i] == buckets_[i - 1] ? run + 1 : 0;
        pairs += run;
    }
    const auto cells = static_cast<double>(cells_.size());
    return static_cast<double>(pairs) / (1 + cells * cells / (2.0 * level.bucketCount));
}

template <class Scalar>
void LevelLayout<Scalar>::layOut(std::span<const PaddedBox<Scalar>> boxes,
                                 std::vector<Level<Scalar>>& levels) {
    levels.clear();
    for (const auto& [level, reach] : candidatesFor(sizes_, origin_, boxes)) {
        Level<Scalar>& dense = levels.emplace_back(level);
        layOutDense(dense, reach);
        const std::uint32_t hashedCount =
            dense.isEmpty() ? reach.count : reach.count / kBoxesPerStray;
        layOutHashed(levels.emplace_back(level), reach, hashedCount, boxes);
    }
    levels.emplace_back();
    std::uint32_t firstBucket = 0;
    for (Level<Scalar>& level : levels) {
        level.firstBucket = firstBucket;
        firstBucket += level.bucketCount;
    }
}

template <class Scalar>
void LevelLayout<Scalar>::shiftOrigin(const Vector3<Scalar>& shift) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Scalar by = shift[static_cast<Eigen::Index>(axis)];
        origin_[axis] = shiftedWithin<Scalar>(origin_[axis], by);
        middle_.low[axis] = shiftedWithin<Scalar>(middle_.low[axis], by);
        middle_.high[axis] = shiftedWithin<Scalar>(middle_.high[axis], by);
    }
}

template class LevelLayout<float>;
template class LevelLayout<double>;

}  // namespace hashphase::detail
