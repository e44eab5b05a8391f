// SPDX-License-Identifier: Zlib

// Building follows Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by
// Spatial Hashing" (wipe and refile everything), as a counting sort.

#include <broadphase/detail/table.hpp>

#include <algorithm>
#include <bit>
#include <limits>

namespace hashphase::detail {
namespace {

// A level of so few proxies costs every walk more than reading them as a list.
constexpr std::uint32_t kThinLevel = 32;

// How often the cell sizes are looked at again while the number of proxies stays about the same.
constexpr std::uint32_t kBuildsBetweenCensuses = 64;

// Multipliers of hashed rows: odd, with well-mixed low bits.
constexpr std::uint32_t kHashStrideY = 0x9e3779b1U;
constexpr std::uint32_t kHashStrideZ = 0x85ebca77U;

bool isInside(const Cell& cell) noexcept {
    return std::all_of(cell.begin(), cell.end(),
                       [](std::int32_t c) { return c > -kCellLimit && c < kCellLimit; });
}

}  // namespace

template <class Scalar>
void Table<Scalar>::chooseLevels(std::span<const std::uint32_t> slots, const Aabb<Scalar>* boxes,
                                 const LevelSizes& fixed) {
    const std::uint64_t count = slots.size();
    const bool sameCount = 4 * count <= 5 * countWhenChosen_ && 5 * count >= 4 * countWhenChosen_;
    if (sameCount && ++buildsSinceChosen_ < kBuildsBetweenCensuses) {
        return;
    }
    countWhenChosen_ = count;
    buildsSinceChosen_ = 0;
    census_.clear();
    for (const std::uint32_t slot : slots) {
        census_.add(boxes[slot]);
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
typename Table<Scalar>::Filed Table<Scalar>::file(const Aabb<Scalar>& box) const noexcept {
    const auto listed = static_cast<std::uint32_t>(levels_.size() - 1);
    for (std::uint32_t i = 0; i < listed; ++i) {
        const Level<Scalar>& level = levels_[i];
        Cell low;
        Cell high;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = level.cell(box.min()[static_cast<int>(axis)], axis);
            high[axis] = level.cell(box.max()[static_cast<int>(axis)], axis);
        }
        const auto spansAtMostTwo = [&low, &high](std::size_t axis) {
            return static_cast<std::uint32_t>(high[axis] - low[axis]) <= 1;
        };
        if (spansAtMostTwo(0) && spansAtMostTwo(1) && spansAtMostTwo(2) && isInside(low) &&
            isInside(high)) {
            return {low, i};
        }
    }
    return {Cell{}, listed};
}

template <class Scalar>
void Table<Scalar>::layOutLevel(Level<Scalar>& level, std::uint32_t count,
                                std::uint32_t& firstBucket) {
    level.firstBucket = firstBucket;
    std::uint64_t cells = 1;
    if (level.hasCells) {
        // One empty column behind each row, so that a run may step over either end of it.
        const auto extent = [&level](std::size_t axis) {
            return static_cast<std::uint64_t>(level.high[axis] - level.low[axis]) + 1;
        };
        const std::uint64_t pitch = extent(0) + 1;
        const bool fits = extent(1) * extent(2) <= 8ULL * count &&
                          pitch * extent(1) * extent(2) <= 4ULL * count + 1024;
        level.isDense = fits;
        cells = fits ? pitch * extent(1) * extent(2) : 2ULL * count;
        level.strideY = fits ? static_cast<std::uint32_t>(pitch) : kHashStrideY;
        level.strideZ = fits ? static_cast<std::uint32_t>(pitch * extent(1)) : kHashStrideZ;
    }
    const std::uint64_t buckets = std::bit_ceil(std::max<std::uint64_t>(cells, 1));
    level.bucketMask = static_cast<std::uint32_t>(buckets - 1);
    firstBucket += static_cast<std::uint32_t>(buckets);
}

template <class Scalar>
void Table<Scalar>::layOutBuckets(std::span<const std::uint32_t> counts) {
    std::uint32_t firstBucket = 0;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        layOutLevel(levels_[i], counts[i], firstBucket);
    }
    bucketStart_.assign(firstBucket + 1, 0);
}

template <class Scalar>
std::uint32_t Table<Scalar>::bucketOf(const Filed& filed) const noexcept {
    const Level<Scalar>& level = levels_[filed.level];
    if (!level.hasCells) {
        return level.firstBucket;
    }
    const std::uint32_t base = level.rowBase(filed.cell[1], filed.cell[2]);
    return level.firstBucket +
           ((base + static_cast<std::uint32_t>(filed.cell[0])) & level.bucketMask);
}

template <class Scalar>
void Table<Scalar>::build(std::span<const std::uint32_t> slots, const Aabb<Scalar>* boxes,
                          const LevelSizes& fixed) {
    chooseLevels(slots, boxes, fixed);
    const auto count = static_cast<std::uint32_t>(slots.size());

    const auto listed = static_cast<std::uint32_t>(sizes_.count);
    levels_.assign(listed + 1, {});
    for (std::uint32_t i = 0; i < listed; ++i) {
        levels_[i].origin = origin_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool isFlat = ((sizes_.flatAxes[i] >> axis) & 1) != 0;
            levels_[i].inverseCellSize[axis] =
                isFlat ? Scalar(0) : static_cast<Scalar>(1 / sizes_.cellSize[i]);
        }
        levels_[i].low.fill(kCellLimit);
        levels_[i].high.fill(-kCellLimit);
    }

    // File every box: its level, and the cell of its min corner.
    filed_.resize(count);
    std::array<std::uint32_t, kMaxLevels + 1> counts{};
    for (std::uint32_t i = 0; i < count; ++i) {
        const Filed filed = file(boxes[slots[i]]);
        filed_[i] = filed;
        ++counts[filed.level];
        Level<Scalar>& level = levels_[filed.level];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            level.low[axis] = std::min(level.low[axis], filed.cell[axis]);
            level.high[axis] = std::max(level.high[axis], filed.cell[axis]);
        }
    }

    // Thin levels join the list.
    std::array<std::uint32_t, kMaxLevels + 1> joins{};
    for (std::uint32_t i = 0; i <= listed; ++i) {
        levels_[i].hasCells = i < listed && counts[i] >= kThinLevel;
        joins[i] = levels_[i].hasCells ? i : listed;
        if (i < listed && !levels_[i].hasCells) {
            counts[listed] += counts[i];
            counts[i] = 0;
        }
    }
    layOutBuckets(counts);

    // Count the entries of each bucket, then turn counts into the buckets' first entries.
    buckets_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        filed_[i].level = joins[filed_[i].level];
        buckets_[i] = bucketOf(filed_[i]);
        ++bucketStart_[buckets_[i]];
    }
    std::uint32_t sum = 0;
    for (std::uint32_t& start : bucketStart_) {
        sum += start;
        start = sum;
    }

    // Scatter backwards, which leaves each start at its bucket's first entry and keeps order.
    slots_.resize(count);
    for (std::uint32_t i = count; i-- > 0;) {
        slots_[--bucketStart_[buckets_[i]]] = slots[i];
    }
    for (std::uint32_t i = 0; i <= listed; ++i) {
        levels_[i].firstEntry = bucketStart_[levels_[i].firstBucket];
        levels_[i].lastEntry = levels_[i].firstEntry + counts[i];
    }

    // Gather the boxes into columns, in the order in which walks will read them.
    for (auto& column : bounds_) {
        column.resize(count + kLanes);
    }
    for (std::uint32_t entry = 0; entry < count; ++entry) {
        const Aabb<Scalar>& box = boxes[slots_[entry]];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bounds_[axis][entry] = box.min()[static_cast<int>(axis)];
            bounds_[axis + 3][entry] = box.max()[static_cast<int>(axis)];
        }
    }
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
           (bucketStart_.capacity() + slots_.capacity() + buckets_.capacity()) *
               sizeof(std::uint32_t) +
           6 * bounds_[0].capacity() * sizeof(Scalar) + filed_.capacity() * sizeof(Filed) +
           census_.memoryBytes();
}

template <class Scalar>
std::string Table<Scalar>::validate() const {
    std::uint32_t entry = 0;
    for (std::uint32_t i = 0; i < levels_.size(); ++i) {
        const Level<Scalar>& level = levels_[i];
        for (std::uint32_t b = level.firstBucket; b <= level.firstBucket + level.bucketMask; ++b) {
            if (bucketStart_[b] != entry || bucketStart_[b] > bucketStart_[b + 1]) {
                return "Buckets partition the entries in order: broken.";
            }
            for (; entry < bucketStart_[b + 1]; ++entry) {
                const Aabb<Scalar> box = this->box(entry);
                if (hasNan(box) || !level.hasCells) {
                    continue;
                }
                const Filed filed = file(box);
                if (filed.level != i) {
                    return "Every entry is on the finest level where its box spans at most two "
                           "cells an axis, or is listed without cells: broken.";
                }
                if (bucketOf(filed) != b) {
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
