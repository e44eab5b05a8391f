// SPDX-License-Identifier: Zlib
#pragma once

// The hash table: boxes sorted by cell, each filed once.
//
// A box is filed under the cell of its min corner, on a level where it spans at most two cells an
// axis. Whatever overlaps a region then lies in the region's cells or one step before.
// Cells become buckets by rows: bucket = rowBase(y, z) + x, so that the cells of a run along x are
// neighbours in memory, and entries are sorted by bucket. After the spatial hashing of Hastings,
// Mesit and Guha, with rows in the place of single cells.
//
// Threads   Building and erasing need the table for themselves; everything const may run anywhere.

#include <broadphase/aabb.hpp>
#include <broadphase/core/fixed_list.hpp>
#include <broadphase/export.hpp>
#include <broadphase/function_ref.hpp>
#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/geometry/quantise.hpp>
#include <broadphase/hash/bucket_sort.hpp>
#include <broadphase/hash/level.hpp>
#include <broadphase/hash/level_layout.hpp>
#include <broadphase/hash/sorted_bucket.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// Columns min x, y, z, max x, y, z of boxes.
template <class Scalar>
using Columns = std::array<const Scalar*, 6>;

template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Table {
public:
    using BoxOfEntry = FunctionRef<Aabb<Scalar>(std::uint32_t entry)>;

    /// Files boxes[i], of boxIndices[i], for every i, anew; boxes with a NaN are left out. Cell sizes
    /// follow the population, or are fixed when `fixed.count` > 0. Where it throws, for want of
    /// memory, nothing is filed. Cost: a few passes over the boxes; least when they come in about the
    /// order of the last time, see order(). With groups[2 * index] of every index, what shares a crowded
    /// bucket is kept apart by groups, so that a search passes by all with which it cannot pair.
    void build(std::span<const std::uint32_t> boxIndices, std::span<const PaddedBox<Scalar>> boxes,
               const LevelSizes& fixed, ParallelFor parallelFor = serialFor,
               const ProxyGroups* groups = nullptr);

    /// Leaves nothing filed.
    void clear() noexcept;

    /// To be called after build(): the boxes that it was given are larger than those by which it is to answer,
    /// from the next refresh on. Where memory runs out, nothing is filed.
    void settle();
    [[nodiscard]] bool isSettled() const noexcept {
        return settled_ != nullptr && !settled_->before[0].empty();
    }
    /// Of a settled table: from now on answers for an entry, or for all that are not erased, are by other boxes,
    /// each of which lies within that by which it is filed. That of a proxy has its corners at
    /// corners + stride * proxyIndex, the min corner first. Those before can be had until endRefresh().
    void refresh(std::uint32_t entry, const Scalar* corners, std::size_t stride) noexcept;
    void refreshAll(const Scalar* corners, std::size_t stride, ParallelFor parallelFor);
    void endRefresh() noexcept {
        if (settled_ != nullptr) {
            settled_->isRefreshed = false;
        }
    }
    /// That of the last but one refresh, of an entry that was refreshed since the last endRefresh(); where none
    /// was, that of the last one.
    [[nodiscard]] Aabb<Scalar> boxBefore(std::uint32_t entry) const noexcept {
        return boxAt(settled_->isRefreshed ? settled_->before : bounds_, entry);
    }
    /// Files by boxes as they are. No entry is left that was filed by another one.
    void unsettle() noexcept;

    /// Takes the entry out of every later answer. Cost: O(1); its place is reclaimed by build().
    void erase(std::uint32_t entry) noexcept;

    /// Subtracts `shift` from every coordinate. Returns false when something was rounded, so that the
    /// table has to be built again before it is read. Cost: a pass over the boxes.
    [[nodiscard]] bool shiftOrigin(const Vector3<Scalar>& shift);

    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(proxyIndices_.size());
    }
    /// Those of each cell size, finest first, the dense one before the hashed one; and the list. None when
    /// nothing is filed.
    [[nodiscard]] std::span<const Level<Scalar>> levels() const noexcept { return levels_; }
    [[nodiscard]] std::span<const std::uint32_t> proxyIndices() const noexcept {
        return proxyIndices_;
    }
    [[nodiscard]] std::uint32_t proxyIndex(std::uint32_t entry) const noexcept {
        return proxyIndices_[entry];
    }
    /// For every entry the number under which build() was given it.
    [[nodiscard]] std::span<const std::uint32_t> order() const noexcept { return order_; }
    /// The most entries that share a bucket of cells.
    [[nodiscard]] std::uint32_t largestCell() const noexcept { return largestBucket_; }
    /// Edge of the finest cells [m]; infinity when nothing is filed by cells.
    [[nodiscard]] double finestCellSize() const noexcept {
        return !proxyIndices_.empty() && layout_->sizes().count > 0
                   ? layout_->sizes().cellSize[0]
                   : std::numeric_limits<double>::infinity();
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;
    /// Gives back what only build() uses, and room for more entries than there are.
    void releaseUnusedMemory() noexcept;

    /// The entry's box, or NaN when it was erased.
    [[nodiscard]] Aabb<Scalar> box(std::uint32_t entry) const noexcept {
        return boxAt(bounds_, entry);
    }

    /// Coordinates of all entries, by column; readable kColumnPadding past any entry.
    [[nodiscard]] Columns<Scalar> columns() const noexcept {
        return {bounds_[0].data(), bounds_[1].data(), bounds_[2].data(),
                bounds_[3].data(), bounds_[4].data(), bounds_[5].data()};
    }

    /// Says which invariant is broken, in a sentence; empty when all hold. Of a settled table `filedBox` tells the
    /// boxes by which entries are filed, which are meant in what follows.
    /// - Each box lies within that by which it is filed.
    /// - Every entry lies in the bucket of the cell of its min corner.
    /// - Every entry spans at most two cells of its level an axis, or is listed without cells.
    /// - Buckets partition the entries in order.
    /// - A sorted bucket is sorted along its axis, and its parts follow each other.
    [[nodiscard]] std::string validate() const {
        return validate([this](std::uint32_t entry) { return box(entry); });
    }
    [[nodiscard]] std::string validate(BoxOfEntry filedBox) const;

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(Table& to, const Table& from, const Visit& visit) {
        forEachPartToBuildOn(to, from, visit);
        visit(to.largestBucket_, from.largestBucket_);
        visit(to.proxyIndices_, from.proxyIndices_);
        visit(to.order_, from.order_);
        visit(to.bucketOfEntry_, from.bucketOfEntry_);
        visit(to.sortedBuckets_, from.sortedBuckets_);
        visit(to.bounds_, from.bounds_);
        visit(to.settled_, from.settled_);
    }
    void finishCopy() noexcept { linkLevels(); }
    /// The same of what the next build() goes by, and not what is filed.
    template <class Visit>
    static void forEachPartToBuildOn(Table& to, const Table& from, const Visit& visit) {
        visit(to.layout_, from.layout_);
        visit(to.strayCount_, from.strayCount_);
        visit(to.straysWhenChosen_, from.straysWhenChosen_);
        visit(to.listedWhenChosen_, from.listedWhenChosen_);
        visit(to.levels_, from.levels_);
        visit(to.bucketStart_, from.bucketStart_);
    }

private:
    using Bounds = std::array<std::vector<Scalar>, 6>;

    /// Of a table whose boxes move within those by which they are filed.
    struct Settled {
        Bounds before;  // as of the last but one refresh; empty for none
        // The least corners by which entries are filed, where searches ask for them.
        std::array<std::vector<Scalar>, 3> filedLow;
        bool isRefreshed = false;

        template <class Visit>
        static void forEachPart(Settled& to, const Settled& from, const Visit& visit) {
            visit(to.before, from.before);
            visit(to.filedLow, from.filedLow);
            visit(to.isRefreshed, from.isRefreshed);
        }
    };

    [[nodiscard]] static Aabb<Scalar> boxAt(const Bounds& bounds, std::uint32_t entry) noexcept {
        return {Vector3<Scalar>(bounds[0][entry], bounds[1][entry], bounds[2][entry]),
                Vector3<Scalar>(bounds[3][entry], bounds[4][entry], bounds[5][entry])};
    }
    [[nodiscard]] bool asksForFiledLow() const noexcept;
    void findBuckets(std::span<const PaddedBox<Scalar>> boxes, const LevelSizes& fixed,
                     ParallelFor parallelFor);
    void layOut(std::span<const PaddedBox<Scalar>> boxes);
    [[nodiscard]] FixedList<SizeClass<Scalar>, kMaxLevels> sizeClasses() const;
    [[nodiscard]] std::size_t countBuckets(std::span<const PaddedBox<Scalar>> boxes,
                                           ParallelFor parallelFor);
    void sortEntries(std::span<const std::uint32_t> boxIndices,
                     std::span<const PaddedBox<Scalar>> boxes, const ProxyGroups* groups,
                     ParallelFor parallelFor);
    void sortCrowdedBuckets(std::span<const std::uint32_t> boxIndices,
                            std::span<const PaddedBox<Scalar>> boxes, const ProxyGroups* groups);
    void sortBucket(std::uint32_t bucket, bool hasCells, std::span<const std::uint32_t> boxIndices,
                    std::span<const PaddedBox<Scalar>> boxes, const ProxyGroups* groups);
    [[nodiscard]] std::optional<SortedBucket<Scalar>> sortedAlong(
        std::span<std::uint32_t> crowd, std::span<const PaddedBox<Scalar>> boxes);
    [[nodiscard]] bool isSorted(const SortedBucket<Scalar>& sorted) const;
    [[nodiscard]] bool areSorted() const;
    void computeExtents();
    void linkLevels() noexcept;

    std::unique_ptr<LevelLayout<Scalar>> layout_;  // made when the first box is filed
    std::uint32_t largestBucket_ = 0;              // of those that are cells
    std::size_t strayCount_ = 0;                   // when the levels were laid out
    std::size_t straysWhenChosen_ = 0;             // when the cell sizes were chosen
    std::uint32_t listedWhenChosen_ = 0;           // of these, without cells
    std::vector<Level<Scalar>> levels_;
    std::vector<std::uint32_t> bucketStart_;
    std::vector<std::uint32_t> proxyIndices_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> bucketOfEntry_;
    std::vector<SortedBucket<Scalar>> sortedBuckets_;
    Bounds bounds_;                     // kColumnPadding longer than the entries
    std::unique_ptr<Settled> settled_;  // made when the first ones settle

    std::unique_ptr<BucketSort> bucketSort_;  // scratch of build()
    std::vector<std::uint32_t> buckets_;      // the same
    std::vector<std::uint32_t> longOnes_;     // the same
};

extern template class Table<float>;
extern template class Table<double>;

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
