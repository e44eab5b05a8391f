// SPDX-License-Identifier: Zlib
#include <broadphase/hash/level_layout.hpp>

#include <broadphase/core/fixed_list.hpp>
#include <broadphase/geometry/origin_shift.hpp>

#include <bit>
#include <optional>

namespace hashphase::detail {
namespace {

// How often the cell sizes are looked at again while the number of proxies stays about the same.
constexpr std::uint32_t kBuildsBetweenCensuses = 128;

// Multipliers of hashed rows: odd, with well-mixed low bits.
constexpr std::uint32_t kHashStrideY = 0x9e3779b1U;
constexpr std::uint32_t kHashStrideZ = 0x85ebca77U;

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
    level.denseBase = 1 - static_cast<std::uint32_t>(level.low[0]) -
                      static_cast<std::uint32_t>(level.low[1]) * level.strideY -
                      static_cast<std::uint32_t>(level.low[2]) * level.strideZ;
    level.bucketCount = static_cast<std::uint32_t>(pitch * (rows * layers + 1) + 2);
    return true;
}

template <class Scalar>
void layOutHashed(Level<Scalar>& level, std::uint32_t count) {
    level.kind = LevelKind::hashed;
    level.strideY = kHashStrideY;
    level.strideZ = kHashStrideZ;
    level.bucketCount = std::bit_ceil(std::max(2 * count, 64U));
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
    middle_ = census_.range(0.5 / kStrays);
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

template <class Scalar>
void LevelLayout<Scalar>::layOut(std::span<const PaddedBox<Scalar>> boxes,
                                 std::vector<Level<Scalar>>& levels) {
    levels.clear();
    for (const auto& [level, reach] : candidatesFor(sizes_, origin_, boxes)) {
        Level<Scalar>& dense = levels.emplace_back(level);
        layOutDense(dense, reach);
        const bool hasCells = dense.low[0] <= dense.high[0];
        layOutHashed(levels.emplace_back(level), hasCells ? reach.count / kStrays : reach.count);
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
