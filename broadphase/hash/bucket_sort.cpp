// SPDX-License-Identifier: Zlib
#include <broadphase/hash/bucket_sort.hpp>

#include <broadphase/simd/kernel_types.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace hashphase::detail {
namespace {

// A part's buckets.
struct BucketRange {
    std::size_t first;
    std::size_t last;
};

BucketRange rangeOf(std::size_t part, std::size_t bucketCount) noexcept {
    const auto firstOf = [=](std::size_t p) {
        return (p * bucketCount + PartedBlocks::kParts - 1) / PartedBlocks::kParts;
    };
    return {firstOf(part), firstOf(part + 1)};
}

std::uint32_t partOf(std::uint32_t bucket, std::size_t bucketCount) noexcept {
    return bucket == kNoBucket ? 0
                               : static_cast<std::uint32_t>(std::uint64_t{bucket} *
                                                            PartedBlocks::kParts / bucketCount);
}

std::uint32_t countIfAny(std::uint32_t bucket, std::uint32_t* counts) noexcept {
    if (bucket == kNoBucket) {
        return 0;
    }
    ++counts[bucket];
    return 1;
}

// Sorts the boxes of a range of buckets, whose starts are counts: forEachBox(visit) calls visit(box) for each of
// them, ascending, whose place is from `sum` on. Returns the greatest count of the buckets but for the last of all.
template <class ForEachBox>
std::uint32_t sortRange(BucketRange range, std::uint32_t sum,
                        std::span<const std::uint32_t> buckets, std::span<std::uint32_t> starts,
                        std::uint32_t* order, const ForEachBox& forEachBox) {
    const std::size_t lastBucket = starts.size() - 2;
    const std::uint32_t firstPlace = sum;
    std::uint32_t most = 0;
    for (std::size_t bucket = range.first; bucket < std::min(range.last, lastBucket); ++bucket) {
        most = std::max(most, starts[bucket]);
        sum += std::exchange(starts[bucket], sum);
    }
    if (range.first <= lastBucket && lastBucket < range.last) {
        starts[lastBucket] = sum;
    }
    forEachBox([&](std::uint32_t box) {
        if (buckets[box] != kNoBucket) {
            order[starts[buckets[box]]++] = box;
        }
    });
    // Each start has moved to its bucket's end, which is where the next one starts.
    if (range.first < range.last) {
        const auto ofRange = starts.subspan(range.first, range.last - range.first);
        std::copy_backward(ofRange.begin(), ofRange.end() - 1, ofRange.end());
        ofRange.front() = firstPlace;
    }
    return most;
}

}  // namespace

void BucketSort::count(std::span<const std::uint32_t> buckets, std::span<std::uint32_t> counts,
                       std::vector<std::uint32_t>& order, LoopBody find, ParallelFor parallelFor) {
    constexpr std::size_t kBlocksAtOnce = 2;
    const std::size_t blockCount = PartedBlocks::blockCount(buckets.size());
    const std::size_t bucketCount = counts.size();
    blocks_.resize(buckets.size());
    order.resize(buckets.size());
    isParted_ = true;
    parallelFor(blockCount, kBlocksAtOnce, [&](std::size_t begin, std::size_t end) {
        const std::size_t first = begin * PartedBlocks::kBlock;
        const std::size_t last = std::min(end * PartedBlocks::kBlock, buckets.size());
        find(first, last);
        if (end - begin == blockCount) {
            isParted_ = false;
            return;
        }
        blocks_.sort(
            first, last, [&](std::size_t i) { return partOf(buckets[i], bucketCount); },
            order.data());
    });
    if (!isParted_) {
        std::ranges::fill(counts, 0);
        countOf_ = {};
        for (const std::uint32_t bucket : buckets) {
            countOf_[0] += countIfAny(bucket, counts.data());
        }
        return;
    }
    parallelFor(kParts, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t part = begin; part < end; ++part) {
            const auto [first, last] = rangeOf(part, bucketCount);
            const auto ofPart = counts.subspan(first, last - first);
            std::ranges::fill(ofPart, 0);
            std::uint32_t count = 0;
            blocks_.forEachOf(part, [&](std::size_t from, std::size_t to) {
                for (std::size_t i = from; i < to; ++i) {
                    count += countIfAny(buckets[order[i]], counts.data());
                }
            });
            countOf_[part] = count;
        }
    });
}

std::uint32_t BucketSort::sort(std::span<const std::uint32_t> buckets,
                               std::span<std::uint32_t> starts,
                               std::span<const std::uint32_t> scratch,
                               std::vector<std::uint32_t>& order, ParallelFor parallelFor) {
    const std::size_t bucketCount = starts.size() - 1;
    std::array<std::uint32_t, kParts> firstPlaceOf;
    std::exclusive_scan(countOf_.begin(), countOf_.end(), firstPlaceOf.begin(), std::uint32_t{0});
    starts.back() = firstPlaceOf.back() + countOf_.back();
    order.resize(starts.back());
    if (!isParted_) {
        return sortRange({0, bucketCount}, 0, buckets, starts, order.data(),
                         [&](const auto& visit) {
                             for (std::uint32_t box = 0; box < buckets.size(); ++box) {
                                 visit(box);
                             }
                         });
    }
    std::array<std::uint32_t, kParts> mostOf;
    parallelFor(kParts, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t part = begin; part < end; ++part) {
            mostOf[part] = sortRange(
                rangeOf(part, bucketCount), firstPlaceOf[part], buckets, starts, order.data(),
                [&](const auto& visit) {
                    blocks_.forEachOf(part, [&](std::size_t from, std::size_t to) {
                        std::for_each(scratch.begin() + static_cast<std::ptrdiff_t>(from),
                                      scratch.begin() + static_cast<std::ptrdiff_t>(to), visit);
                    });
                });
        }
    });
    return *std::ranges::max_element(mostOf);
}

}  // namespace hashphase::detail
