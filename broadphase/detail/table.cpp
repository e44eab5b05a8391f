// SPDX-License-Identifier: Zlib

// Building follows Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by
// Spatial Hashing" (wipe and refile everything), as a counting sort.

#include <broadphase/detail/table.hpp>

#include <broadphase/detail/crowd_census.hpp>
#include <broadphase/detail/kernels.hpp>
#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace hashphase::detail {
namespace {

// A level of so few proxies costs every walk more than reading them as a list.
constexpr std::uint32_t kThinLevel = 32;

// How often the cell sizes are looked at again while the number of proxies stays about the same.
constexpr std::uint32_t kBuildsBetweenCensuses = 128;

// Multipliers of hashed rows: odd, with well-mixed low bits.
constexpr std::uint32_t kHashStrideY = 0x9e3779b1U;
constexpr std::uint32_t kHashStrideZ = 0x85ebca77U;

// Boxes that one thread deals with at a time.
constexpr std::size_t kGrain = 4096;

// Up to one in so many may lie beyond the cells that are numbered through.
constexpr std::uint32_t kStrays = 32;

// A layout reaches a little beyond the population, so that it holds for some builds.
std::int32_t marginOf(std::int32_t low, std::int32_t high) {
    return high - low < 8 ? 0 : 1 + (high - low) / 128;
}

}  // namespace

// Cell sizes are chosen again when the number of proxies has changed, and now and then.
template <class Scalar>
bool Table<Scalar>::isTimeToChoose(std::size_t count) {
    const bool sameCount = 4 * count <= 5 * countWhenChosen_ && 5 * count >= 4 * countWhenChosen_;
    return !sameCount || ++buildsSinceChosen_ >= kBuildsBetweenCensuses;
}

template <class Scalar>
void Table<Scalar>::chooseLevels(std::span<const PaddedBox<Scalar>> boxes,
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
}

template <class Scalar>
void Table<Scalar>::makeLevels() {
    levels_.assign(2 * static_cast<std::size_t>(sizes_.count) + 1, {});
    for (std::size_t i = 0; i + 1 < levels_.size(); ++i) {
        Level<Scalar>& level = levels_[i];
        level.hasCells = true;
        level.isDense = i % 2 == 0;
        level.largestEdge = static_cast<Scalar>(sizes_.cellSize[i / 2]);
        level.origin = origin_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool isFlat = ((sizes_.flatAxes[i / 2] >> axis) & 1) != 0;
            level.inverseCellSize[axis] =
                isFlat ? Scalar(0) : static_cast<Scalar>(1 / sizes_.cellSize[i / 2]);
        }
    }
}

// The cell of a box that is filed on this level, or nothing where it is not to be.
template <class Scalar>
std::optional<Cell> Table<Scalar>::cellOn(const Level<Scalar>& level,
                                          const Aabb<Scalar>& box) const noexcept {
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

// How many boxes each cell size has, and the cells between which they are.
template <class Scalar>
typename Table<Scalar>::Reaches Table<Scalar>::measure(
    std::span<const PaddedBox<Scalar>> boxes) const {
    Reaches reaches;
    for (const PaddedBox<Scalar>& padded : boxes) {
        const Aabb<Scalar> box = unpadded(padded);
        for (std::size_t i = 0; i < levels_.size() / 2; ++i) {
            const std::optional<Cell> cell = cellOn(levels_[2 * i], box);
            if (!cell) {
                continue;
            }
            reaches[i].add(*cell);
            break;
        }
    }
    return reaches;
}

// Decides which cells are numbered through: as the boxes are now, and a little further.
template <class Scalar>
void Table<Scalar>::layOut(std::span<const PaddedBox<Scalar>> boxes) {
    makeLevels();
    Reaches reaches = measure(boxes);
    // What is of a size that few have goes to the next larger cells, or to the list.
    bool isThinned = false;
    for (std::size_t i = 0; i < levels_.size() / 2; ++i) {
        if (reaches[i].count < kThinLevel) {
            isThinned = isThinned || reaches[i].count > 0;
            for (Level<Scalar>* level : {&levels_[2 * i], &levels_[2 * i + 1]}) {
                level->hasCells = false;
                level->largestEdge = std::numeric_limits<Scalar>::quiet_NaN();
            }
        }
    }
    if (isThinned) {
        reaches = measure(boxes);
    }
    std::uint32_t firstBucket = 0;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        Level<Scalar>& level = levels_[i];
        level.firstBucket = firstBucket;
        if (!level.hasCells) {
            level.isDense = false;
            level.bucketCount = 1;
        } else if (level.isDense) {
            layOutDense(level, reaches[i / 2]);
        } else {
            const bool takesAll = levels_[i - 1].low[0] > levels_[i - 1].high[0];
            layOutHashed(level, takesAll ? reaches[i / 2].count : reaches[i / 2].count / kStrays);
        }
        firstBucket += level.bucketCount;
    }
    bucketStart_.resize(firstBucket + 1);
}

// A few strays must not keep all the others from being numbered through: where the whole population
// is too sparse, its middle may be dense enough.
template <class Scalar>
void Table<Scalar>::layOutDense(Level<Scalar>& level, const Reach& reach) {
    level.low = reach.low;
    level.high = reach.high;
    if (numberThrough(level, reach.count)) {
        return;
    }
    const auto [low, high] = census_.range(0.5 / kStrays);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        level.low[axis] = level.cell(static_cast<Scalar>(low[axis]), axis);
        level.high[axis] = level.cell(static_cast<Scalar>(high[axis]), axis);
    }
    if (!numberThrough(level, reach.count)) {
        level.low.fill(1);
        level.high.fill(0);
        level.bucketCount = 1;
    }
}

// Returns false when there are too many cells for so few boxes.
template <class Scalar>
bool Table<Scalar>::numberThrough(Level<Scalar>& level, std::uint32_t count) const {
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
void Table<Scalar>::layOutHashed(Level<Scalar>& level, std::uint32_t count) const {
    level.strideY = kHashStrideY;
    level.strideZ = kHashStrideZ;
    level.bucketCount = std::bit_ceil(std::max(2 * count, 64U));
}

// Finds every box's bucket and counts how many each has. Returns how many boxes lie where it takes
// longer to find them: listed without cells, or beyond the cells that are numbered through.
template <class Scalar>
std::size_t Table<Scalar>::countBuckets(std::span<const PaddedBox<Scalar>> boxes,
                                        ParallelFor parallelFor) {
    buckets_.resize(boxes.size());
    views_.clear();
    for (const Level<Scalar>& level : levels_) {
        views_.push_back(view(level));
    }
    parallelFor(boxes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        kernels<Scalar>().fileBoxes(views_.data(), views_.size(), boxes.data() + begin, end - begin,
                                    buckets_.data() + begin);
    });
    std::fill(bucketStart_.begin(), bucketStart_.end(), 0);
    for (const std::uint32_t bucket : buckets_) {
        if (bucket != kNoBucket) {
            ++bucketStart_[bucket];
        }
    }
    std::size_t count = 0;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        const bool isStray = i % 2 == 1 || i + 1 == levels_.size();
        const auto first = bucketStart_.begin() + levels_[i].firstBucket;
        count +=
            isStray ? std::accumulate(first, first + levels_[i].bucketCount, std::size_t{0}) : 0;
    }
    return count;
}

// A counting sort. Boxes that come in the order of the last time are read and written nearly in
// sequence.
template <class Scalar>
void Table<Scalar>::sortEntries(std::span<const std::uint32_t> slots,
                                std::span<const PaddedBox<Scalar>> boxes, ParallelFor parallelFor) {
    std::uint32_t sum = 0;
    largestBucket_ = 0;
    const std::size_t listBucket = bucketStart_.size() - 2;  // and behind it the end
    for (std::size_t bucket = 0; bucket < listBucket; ++bucket) {
        largestBucket_ = std::max(largestBucket_, bucketStart_[bucket]);
        sum += std::exchange(bucketStart_[bucket], sum);
    }
    sum += std::exchange(bucketStart_[listBucket], sum);
    bucketStart_.back() = sum;
    const std::uint32_t count = sum;
    slots_.resize(count);
    order_.resize(count);
    bucketOfEntry_.resize(count);
    for (auto& column : bounds_) {
        column.resize(count + kColumnPadding);
    }
    for (Level<Scalar>& level : levels_) {
        level.firstEntry = bucketStart_[level.firstBucket];
        level.lastEntry = bucketStart_[level.firstBucket + level.bucketCount];
    }
    // Each start moves to its bucket's end, which is where the next one starts.
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (buckets_[i] != kNoBucket) {
            order_[bucketStart_[buckets_[i]]++] = static_cast<std::uint32_t>(i);
        }
    }
    std::copy_backward(bucketStart_.begin(), bucketStart_.end() - 1, bucketStart_.end());
    bucketStart_[0] = 0;
    sortCrowds(boxes);

    parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t entry = begin; entry < end; ++entry) {
            const std::uint32_t i = order_[entry];
            slots_[entry] = slots[i];
            bucketOfEntry_[entry] = buckets_[i];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                bounds_[axis][entry] = boxes[i].low[axis];
                bounds_[axis + 3][entry] = boxes[i].high[axis];
            }
        }
    });
    noteRows();
    noteHeights();
}

// Calls visit(span of entries in order_) for the crowded buckets of the level.
template <class Scalar>
template <class Visit>
void Table<Scalar>::forCrowds(const Level<Scalar>& level, const Visit& visit) {
    const std::uint32_t* starts = bucketStart_.data() + level.firstBucket;
    for (std::uint32_t bucket = 0; bucket < level.bucketCount; ++bucket) {
        const std::uint32_t count = starts[bucket + 1] - starts[bucket];
        if (count > kCrowd) {
            visit(std::span(order_).subspan(starts[bucket], count));
        }
    }
}

// Where many boxes share a cell, because it is much larger than they are, a search would have to
// read them all; when they are sorted, only what is near along the axis.
template <class Scalar>
void Table<Scalar>::sortCrowds(std::span<const PaddedBox<Scalar>> boxes) {
    for (Level<Scalar>& level : levels_) {
        level.sweepAxis = -1;
        if (largestBucket_ <= kCrowd || !level.hasCells || level.count() <= kCrowd) {
            continue;
        }
        CrowdCensus<Scalar> census;
        forCrowds(level, [&](std::span<std::uint32_t> crowd) { census.add(crowd, boxes); });
        level.sweepAxis = census.sweepAxis();
        if (level.sweepAxis < 0) {
            continue;
        }
        const auto axis = static_cast<std::size_t>(level.sweepAxis);
        level.sweepReach = census.reach(axis);
        forCrowds(level, [&](std::span<std::uint32_t> crowd) {
            std::sort(crowd.begin(), crowd.end(), [&](std::uint32_t a, std::uint32_t b) {
                const Scalar lowA = boxes[a].low[axis];
                const Scalar lowB = boxes[b].low[axis];
                return lowA != lowB ? lowA < lowB : a < b;
            });
        });
    }
}

// Hashed rows are told apart by their coordinates, and no search need look beyond them.
template <class Scalar>
void Table<Scalar>::noteRows() {
    const auto isHashed = [](const Level<Scalar>& level) {
        return level.hasCells && !level.isDense && level.count() > 0;
    };
    const bool isNeeded = std::any_of(levels_.begin(), levels_.end(), isHashed);
    rowOfEntry_.resize(isNeeded ? slots_.size() : 0);
    for (Level<Scalar>& level : levels_) {
        if (!isHashed(level)) {
            continue;
        }
        Reach reach;
        for (std::uint32_t i = level.firstEntry; i < level.lastEntry; ++i) {
            const Cell cell{level.cell(bounds_[0][i], 0), level.cell(bounds_[1][i], 1),
                            level.cell(bounds_[2][i], 2)};
            reach.add(cell);
            rowOfEntry_[i] = {cell[1], cell[2]};
        }
        level.low = reach.low;
        level.high = reach.high;
    }
}

// Along a flat axis, cells do not tell where the boxes are. Inverted ones end before they begin.
template <class Scalar>
void Table<Scalar>::noteHeights() {
    const auto find = kernels<Scalar>().findRange;
    for (Level<Scalar>& level : levels_) {
        for (std::size_t axis = 0; level.hasCells && axis < 3; ++axis) {
            if (level.inverseCellSize[axis] != 0 || level.count() == 0) {
                continue;
            }
            std::array<Scalar, 2> least{};
            std::array<Scalar, 2> greatest{};
            for (std::size_t end = 0; end < 2; ++end) {
                find(bounds_[axis + 3 * end].data(), level.firstEntry, level.lastEntry, &least[end],
                     &greatest[end]);
            }
            level.lowest[axis] = std::min(least[0], least[1]);
            level.highest[axis] = std::max(greatest[0], greatest[1]);
        }
    }
}

template <class Scalar>
void Table<Scalar>::build(std::span<const std::uint32_t> slots,
                          std::span<const PaddedBox<Scalar>> boxes, const LevelSizes& fixed,
                          ParallelFor parallelFor) {
    HASHPHASE_ASSERT(slots.size() == boxes.size(), "Every box has a slot.");
    const auto areMany = [&](std::size_t strays, std::size_t usual) {
        return strays > 2 * usual + kThinLevel + boxes.size() / kStrays;
    };
    const auto choose = [&] {
        chooseLevels(boxes, fixed);
        layOut(boxes);
        strayCount_ = countBuckets(boxes, parallelFor);
        straysWhenChosen_ = strayCount_;
    };
    if (isTimeToChoose(boxes.size()) || levels_.empty()) {
        choose();
    } else if (areMany(countBuckets(boxes, parallelFor), strayCount_)) {
        layOut(boxes);
        strayCount_ = countBuckets(boxes, parallelFor);
        // Boxes that have outgrown their cells are strays wherever these lie.
        if (areMany(strayCount_, straysWhenChosen_)) {
            choose();
        }
    }
    sortEntries(slots, boxes, parallelFor);
}

template <class Scalar>
LevelView<Scalar> Table<Scalar>::view(const Level<Scalar>& level) const noexcept {
    LevelView<Scalar> view{};
    for (std::size_t i = 0; i < 6; ++i) {
        view.columns[i] = bounds_[i].data();
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        view.origin[axis] = level.origin[axis];
        view.inverseCellSize[axis] = level.inverseCellSize[axis];
        view.lowest[axis] = level.lowest[axis];
        view.highest[axis] = level.highest[axis];
        view.low[axis] = level.low[axis];
        view.high[axis] = level.high[axis];
    }
    view.largestEdge = level.largestEdge;
    view.bucketStart = bucketStart_.data() + level.firstBucket;
    view.bucketOfEntry = bucketOfEntry_.data();
    view.rowOfEntry = rowOfEntry_.data();
    view.slots = slots_.data();
    view.firstBucket = level.firstBucket;
    view.firstEntry = level.firstEntry;
    view.lastEntry = level.lastEntry;
    view.bucketCount = level.bucketCount;
    view.strideY = level.strideY;
    view.strideZ = level.strideZ;
    view.denseBase = level.denseBase;
    view.isDense = level.isDense;
    view.hasCells = level.hasCells;
    view.sweepAxis = level.sweepAxis;
    view.sweepReach = level.sweepReach;
    return view;
}

template <class Scalar>
void Table<Scalar>::erase(std::uint32_t entry) noexcept {
    for (auto& column : bounds_) {
        column[entry] = std::numeric_limits<Scalar>::quiet_NaN();
    }
}

template <class Scalar>
std::size_t Table<Scalar>::memoryBytes() const noexcept {
    return levels_.capacity() * sizeof(Level<Scalar>) +
           (bucketStart_.capacity() + slots_.capacity() + order_.capacity() +
            bucketOfEntry_.capacity() + buckets_.capacity()) *
               sizeof(std::uint32_t) +
           6 * bounds_[0].capacity() * sizeof(Scalar) + rowOfEntry_.capacity() * sizeof(Row) +
           views_.capacity() * sizeof(LevelView<Scalar>) + census_.memoryBytes();
}

template <class Scalar>
bool Table<Scalar>::isSortedIfCrowded(const Level<Scalar>& level, std::uint32_t bucket) const {
    const std::uint32_t first = bucketStart_[bucket];
    const std::uint32_t last = bucketStart_[bucket + 1];
    if (level.sweepAxis < 0 || last - first <= kCrowd) {
        return true;
    }
    const Scalar* column = bounds_[static_cast<std::size_t>(level.sweepAxis)].data();
    return std::is_sorted(column + first, column + last);
}

template <class Scalar>
std::string Table<Scalar>::validate() const {
    std::uint32_t entry = 0;
    for (std::uint32_t i = 0; i < levels_.size(); ++i) {
        const Level<Scalar>& level = levels_[i];
        if (level.firstEntry != entry) {
            return "Buckets partition the entries in order: broken.";
        }
        const std::uint32_t end = level.firstBucket + level.bucketCount;
        for (std::uint32_t b = level.firstBucket; b < end; ++b) {
            if (bucketStart_[b] != entry || bucketStart_[b] > bucketStart_[b + 1]) {
                return "Buckets partition the entries in order: broken.";
            }
            if (!isSortedIfCrowded(level, b)) {
                return "Crowded buckets are sorted along their level's sweep axis, where it has "
                       "one: broken.";
            }
            for (; entry < bucketStart_[b + 1]; ++entry) {
                const Aabb<Scalar> box = this->box(entry);
                if (hasNan(box) || !level.hasCells) {
                    continue;
                }
                Cell low{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const auto at = static_cast<Eigen::Index>(axis);
                    low[axis] = level.cell(box.min()[at], axis);
                    const std::int32_t high = level.cell(box.max()[at], axis);
                    if (high < low[axis] || high > low[axis] + 1) {
                        return "Every entry spans at most two cells of its level an axis, or is "
                               "listed without cells: broken.";
                    }
                }
                if (level.firstBucket + level.bucket(low) != b || bucketOfEntry_[entry] != b) {
                    return "Every entry lies in the bucket of the cell of its min corner: broken.";
                }
            }
        }
    }
    if (entry != slots_.size()) {
        return "Buckets partition the entries in order: broken.";
    }
    return {};
}

template class Table<float>;
template class Table<double>;

}  // namespace hashphase::detail
