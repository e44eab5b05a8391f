// SPDX-License-Identifier: Zlib

// Building follows Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by
// Spatial Hashing" (wipe and refile everything), as a counting sort.

#include <broadphase/hash/table.hpp>

#include <broadphase/core/on_failure.hpp>
#include <broadphase/hash/crowded_buckets.inl>
#include <broadphase/hash/table_shift.inl>

#include <broadphase/core/compiler.hpp>
#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/simd/kernels.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace hashphase::detail {
namespace {

// Boxes that one thread deals with at a time.
constexpr std::size_t kTableGrain = 4096;

}  // namespace

template <class Scalar>
void Table<Scalar>::layOut(std::span<const PaddedBox<Scalar>> boxes) {
    layout_->layOut(boxes, levels_);
    bucketStart_.resize(levels_.back().firstBucket + levels_.back().bucketCount + 1);
}

template <class Scalar>
FixedList<SizeClass<Scalar>, kMaxLevels> Table<Scalar>::sizeClasses() const {
    FixedList<SizeClass<Scalar>, kMaxLevels> classes;
    const Level<Scalar>* dense = nullptr;
    for (const Level<Scalar>& level : levels_) {
        if (level.kind == LevelKind::dense) {
            dense = &level;
        } else if (level.kind == LevelKind::hashed) {
            classes.push({dense, &level});
        }
    }
    return classes;
}

// Finds every box's bucket and counts how many each has. Returns how many boxes are strays: listed without
// cells, or beyond the cells that are dense where there are any.
template <class Scalar>
std::size_t Table<Scalar>::countBuckets(std::span<const PaddedBox<Scalar>> boxes,
                                        ParallelFor parallelFor) {
    buckets_.resize(boxes.size());
    const FixedList<SizeClass<Scalar>, kMaxLevels> classes = sizeClasses();
    const auto find = [&](std::size_t begin, std::size_t end) {
        kernels<Scalar>().fileBoxes(classes.data(), classes.size(), levels_.back().firstBucket,
                                    boxes.data() + begin, end - begin, buckets_.data() + begin);
    };
    bucketSort_->count(buckets_, std::span(bucketStart_).first(bucketStart_.size() - 1),
                       bucketOfEntry_, find, parallelFor);
    std::size_t count = bucketStart_[levels_.back().firstBucket];
    for (const auto& [dense, hashed] : classes) {
        const auto* const first = bucketStart_.data() + hashed->firstBucket;
        count += dense->isEmpty()
                     ? 0
                     : std::accumulate(first, first + hashed->bucketCount, std::size_t{0});
    }
    return count;
}

// Boxes that come in the order of the last time are read and written nearly in sequence.
template <class Scalar>
void Table<Scalar>::sortEntries(std::span<const std::uint32_t> boxIndices,
                                std::span<const PaddedBox<Scalar>> boxes, const ProxyGroups* groups,
                                ParallelFor parallelFor) {
    largestBucket_ = bucketSort_->sort(buckets_, bucketStart_, bucketOfEntry_, order_, parallelFor);
    const std::size_t count = order_.size();
    proxyIndices_.resize(count);
    bucketOfEntry_.resize(count);
    for (auto& column : bounds_) {
        column.resize(count + kColumnPadding);
    }
    for (Level<Scalar>& level : levels_) {
        level.firstEntry = bucketStart_[level.firstBucket];
        level.lastEntry = bucketStart_[level.firstBucket + level.bucketCount];
    }
    sortCrowdedBuckets(boxIndices, boxes, groups);

    parallelFor(count, kTableGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t entry = begin; entry < end; ++entry) {
            const std::uint32_t i = order_[entry];
            proxyIndices_[entry] = boxIndices[i];
            bucketOfEntry_[entry] = buckets_[i];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                bounds_[axis][entry] = boxes[i].low[axis];
                bounds_[axis + 3][entry] = boxes[i].high[axis];
            }
        }
    });
    computeExtents();
    linkLevels();
}

// No search need look beyond the cells that a hashed level has. Along a flat axis, cells do not tell where
// the boxes are; inverted ones end before they begin.
template <class Scalar>
void Table<Scalar>::computeExtents() {
    for (Level<Scalar>& level : levels_) {
        for (std::size_t axis = 0; level.hasCells() && level.count() > 0 && axis < 3; ++axis) {
            const auto rangeOf = [&](std::size_t column) {
                Scalar least{};
                Scalar most{};
                kernels<Scalar>().findRange(bounds_[column].data(), level.firstEntry,
                                            level.lastEntry, &least, &most);
                return std::array{least, most};
            };
            const bool isFlat = level.inverseCellSize[axis] == 0;
            if (level.isDense() && !isFlat) {
                continue;
            }
            const auto [least, greatest] = rangeOf(axis);
            if (!level.isDense()) {
                level.low[axis] = level.cell(least, axis);
                level.high[axis] = level.cell(greatest, axis);
            }
            if (isFlat) {
                const auto [leastEnd, greatestEnd] = rangeOf(axis + 3);
                level.lowest[axis] = std::min(least, leastEnd);
                level.highest[axis] = std::max(greatest, greatestEnd);
            }
        }
    }
}

template <class Scalar>
void Table<Scalar>::build(std::span<const std::uint32_t> boxIndices,
                          std::span<const PaddedBox<Scalar>> boxes, const LevelSizes& fixed,
                          ParallelFor parallelFor, const ProxyGroups* groups) {
    HASHPHASE_ASSERT(boxIndices.size() == boxes.size(),
                     "Table::build(): boxIndices and boxes have different lengths. Pass one index "
                     "for each box.");
    if (boxes.empty()) {
        clear();
        return;
    }
    const OnFailure clearAll([&] { clear(); });
    if (layout_ == nullptr) {
        layout_ = std::make_unique<LevelLayout<Scalar>>();
    }
    if (bucketSort_ == nullptr) {
        bucketSort_ = std::make_unique<BucketSort>();
    }
    unsettle();
    findBuckets(boxes, fixed, parallelFor);
    sortEntries(boxIndices, boxes, groups, parallelFor);
}

// In the cells of the last time, unless too many boxes have left them.
template <class Scalar>
void Table<Scalar>::findBuckets(std::span<const PaddedBox<Scalar>> boxes, const LevelSizes& fixed,
                                ParallelFor parallelFor) {
    const auto areMany = [&](std::size_t strays, std::size_t usual) {
        using Layout = LevelLayout<Scalar>;
        return strays > 2 * usual + Layout::kThinLevel + boxes.size() / kBoxesPerStray;
    };
    // Every search reads all of them.
    const auto areTooManyListed = [&] {
        return bucketStart_[levels_.back().firstBucket] >
               2 * listedWhenChosen_ + LevelLayout<Scalar>::kThinLevel;
    };
    bool mustChoose = layout_->isTimeToChoose(boxes.size()) || levels_.empty();
    if (!mustChoose && areMany(countBuckets(boxes, parallelFor), strayCount_)) {
        layOut(boxes);
        strayCount_ = countBuckets(boxes, parallelFor);
        // Boxes that have outgrown their cells are strays wherever these lie.
        mustChoose = areMany(strayCount_, straysWhenChosen_);
    } else if (!mustChoose) {
        mustChoose = areTooManyListed();
    }
    if (mustChoose) {
        layout_->choose(boxes, fixed);
        layOut(boxes);
        strayCount_ = countBuckets(boxes, parallelFor);
        straysWhenChosen_ = strayCount_;
        listedWhenChosen_ = bucketStart_[levels_.back().firstBucket];
    }
}

// Levels point into the table's arrays, which stay where they are when tables are moved or swapped.
template <class Scalar>
void Table<Scalar>::linkLevels() noexcept {
    const SortedBucket<Scalar>* sorted = sortedBuckets_.data();
    for (Level<Scalar>& level : levels_) {
        for (std::size_t i = 0; i < bounds_.size(); ++i) {
            level.columns[i] = bounds_[i].data();
        }
        level.bucketStart = bucketStart_.data() + level.firstBucket;
        level.bucketOfEntry = bucketOfEntry_.data();
        level.proxyIndices = proxyIndices_.data();
        level.sortedBuckets = sorted;
        sorted += level.sortedCount;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            level.filedLow[axis] =
                isSettled() ? settled_->filedLow[axis].data() : bounds_[axis].data();
        }
    }
}

template <class Scalar>
void Table<Scalar>::clear() noexcept {
    largestBucket_ = 0;
    levels_.clear();
    proxyIndices_.clear();
    order_.clear();
    sortedBuckets_.clear();
    unsettle();
}

// --- Boxes that move within those by which they are filed ----------------------------------------

// Sorted buckets are searched by them; and in hashed cells they tell in which row an entry is.
template <class Scalar>
bool Table<Scalar>::asksForFiledLow() const noexcept {
    return !sortedBuckets_.empty() || std::ranges::any_of(levels_, [](const Level<Scalar>& level) {
        return level.kind == LevelKind::hashed && level.count() > 0;
    });
}

template <class Scalar>
void Table<Scalar>::settle() {
    if (size() == 0) {
        return;
    }
    const OnFailure clearAll([&] { clear(); });
    if (settled_ == nullptr) {
        settled_ = std::make_unique<Settled>();
    }
    for (auto& column : settled_->before) {
        column.resize(bounds_[0].size());
    }
    for (std::size_t axis = 0; axis < 3 && asksForFiledLow(); ++axis) {
        settled_->filedLow[axis] = bounds_[axis];
    }
    linkLevels();
}

template <class Scalar>
void Table<Scalar>::refresh(std::uint32_t entry, const Scalar* corners,
                            std::size_t stride) noexcept {
    HASHPHASE_ASSERT(
        !hasNan(box(entry)),
        "Table::refresh(): the entry was erased. Refresh only entries that are present.");
    const Scalar* const now = corners + stride * proxyIndices_[entry];
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
        settled_->before[i][entry] = std::exchange(bounds_[i][entry], now[i]);
    }
    settled_->isRefreshed = true;
}

template <class Scalar>
void Table<Scalar>::refreshAll(const Scalar* corners, std::size_t stride, ParallelFor parallelFor) {
    constexpr std::size_t kAhead = 12;
    bounds_.swap(settled_->before);
    settled_->isRefreshed = true;
    linkLevels();
    const Bounds& before = settled_->before;
    parallelFor(size(), kTableGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t entry = begin; entry < end; ++entry) {
            prefetch(corners + stride * proxyIndices_[std::min(entry + kAhead, end - 1)]);
            const bool isErased = before[0][entry] != before[0][entry];
            const Scalar* const now = corners + stride * proxyIndices_[entry];
            for (std::size_t i = 0; i < bounds_.size(); ++i) {
                bounds_[i][entry] = isErased ? before[i][entry] : now[i];
            }
        }
    });
}

template <class Scalar>
void Table<Scalar>::unsettle() noexcept {
    if (settled_ == nullptr) {
        return;
    }
    for (auto& column : settled_->before) {
        column.clear();
    }
    for (auto& column : settled_->filedLow) {
        column.clear();
    }
    settled_->isRefreshed = false;
    linkLevels();
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
           (bucketStart_.capacity() + proxyIndices_.capacity() + order_.capacity() +
            bucketOfEntry_.capacity() + buckets_.capacity() + longOnes_.capacity()) *
               sizeof(std::uint32_t) +
           (bucketSort_ != nullptr ? bucketSort_->memoryBytes() : 0) +
           6 * bounds_[0].capacity() * sizeof(Scalar) +
           sortedBuckets_.capacity() * sizeof(SortedBucket<Scalar>) +
           (settled_ != nullptr ? sizeof(*settled_) + (6 * settled_->before[0].capacity() +
                                                       3 * settled_->filedLow[0].capacity()) *
                                                          sizeof(Scalar)
                                : 0) +
           (layout_ != nullptr ? layout_->memoryBytes() : 0);
}

template <class Scalar>
void Table<Scalar>::releaseUnusedMemory() noexcept {
    if (proxyIndices_.empty()) {
        *this = {};
        return;
    }
    layout_->releaseUnusedMemory();
    levels_.shrink_to_fit();
    for (auto* numbers : {&bucketStart_, &proxyIndices_, &order_, &bucketOfEntry_}) {
        numbers->shrink_to_fit();
    }
    sortedBuckets_.shrink_to_fit();
    for (auto& column : bounds_) {
        column.shrink_to_fit();
    }
    if (!isSettled()) {
        settled_.reset();
    } else {
        for (auto& column : settled_->before) {
            column.shrink_to_fit();
        }
        for (auto& column : settled_->filedLow) {
            column.shrink_to_fit();
        }
    }
    freeArrays(buckets_, longOnes_);
    bucketSort_.reset();
    linkLevels();
}

// Erased entries of a table that is not settled have no corner any more.
template <class Scalar>
bool Table<Scalar>::isSorted(const SortedBucket<Scalar>& sorted) const {
    const Scalar* const keys = levels_.front().filedLow[sorted.axis];
    for (std::uint32_t entry = sorted.first + 1; entry < sorted.firstLong; ++entry) {
        if (keys[entry] < keys[entry - 1]) {
            return false;
        }
    }
    return true;
}

template <class Scalar>
bool Table<Scalar>::areSorted() const {
    for (std::size_t i = 0; i < sortedBuckets_.size(); ++i) {
        const SortedBucket<Scalar>& sorted = sortedBuckets_[i];
        const bool isFirst = i == 0 || sortedBuckets_[i - 1].bucket != sorted.bucket;
        const bool isLast =
            i + 1 == sortedBuckets_.size() || sortedBuckets_[i + 1].bucket != sorted.bucket;
        if (sorted.first != (isFirst ? bucketStart_[sorted.bucket] : sortedBuckets_[i - 1].last) ||
            (isLast && sorted.last != bucketStart_[sorted.bucket + 1]) ||
            sorted.firstLong < sorted.first || sorted.firstLong > sorted.last ||
            !isSorted(sorted)) {
            return false;
        }
    }
    return true;
}

template <class Scalar>
std::string Table<Scalar>::validate(BoxOfEntry filedBox) const {
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
            for (; entry < bucketStart_[b + 1]; ++entry) {
                if (hasNan(this->box(entry)) || !level.hasCells()) {
                    continue;
                }
                const Aabb<Scalar> box = filedBox(entry);
                if (!isWithin(padded(this->box(entry)), padded(box))) {
                    return "Each box lies within that by which it is filed: broken.";
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
                if (level.firstBucket + level.bucket(low[0], Row{low[1], low[2]}) != b ||
                    bucketOfEntry_[entry] != b) {
                    return "Every entry lies in the bucket of the cell of its min corner: broken.";
                }
            }
        }
    }
    if (entry != proxyIndices_.size()) {
        return "Buckets partition the entries in order: broken.";
    }
    return areSorted() ? std::string()
                       : "A sorted bucket is sorted along its axis, and its parts follow each "
                         "other: broken.";
}

template class HASHPHASE_INSTANCE_EXPORT Table<float>;
template class HASHPHASE_INSTANCE_EXPORT Table<double>;

}  // namespace hashphase::detail
