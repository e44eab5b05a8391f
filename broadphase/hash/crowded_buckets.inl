// SPDX-License-Identifier: Zlib
#pragma once

// Where many boxes share a cell, because it is much larger than they are, a search would have to read
// them all; when they are sorted, only what is near along the axis. Those that lie at one place, where no
// axis tells them apart, are mostly some that may not pair: by groups, a search need not read what it
// cannot pair with.

#include <broadphase/hash/table.hpp>

#include <broadphase/hash/bucket_census.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>

namespace hashphase::detail {
namespace {

// So few of a crowd are not worth sorting along an axis.
constexpr std::size_t kFewest = 64;

// Sorts the crowd by the groups of its boxes; does nothing, and returns false, where so many kinds of
// them are there that telling them apart takes longer than it spares.
template <class GroupsOf>
bool sortByGroups(std::span<std::uint32_t> crowd, const GroupsOf& groupsOf) {
    constexpr std::size_t kMostKinds = 32;
    std::array<ProxyGroups, kMostKinds> kinds;  // the first kindCount
    std::size_t kindCount = 0;
    ProxyGroups last = groupsOf(crowd[0]);
    for (const std::uint32_t i : crowd) {
        const ProxyGroups groups = groupsOf(i);
        if (kindCount > 0 && groups == last) {
            continue;
        }
        last = groups;
        const auto known = std::span(kinds).first(kindCount);
        if (std::find(known.begin(), known.end(), groups) != known.end()) {
            continue;
        }
        if (kindCount == kMostKinds) {
            return false;
        }
        kinds[kindCount++] = groups;
    }
    if (kindCount > 1) {
        const auto key = [&](std::uint32_t i) {
            const ProxyGroups groups = groupsOf(i);
            return std::uint64_t{groups.group} << 32 | groups.mask;
        };
        std::sort(crowd.begin(), crowd.end(), [&](std::uint32_t a, std::uint32_t b) {
            return key(a) != key(b) ? key(a) < key(b) : a < b;
        });
    }
    return true;
}

}  // namespace

template <class Scalar>
void Table<Scalar>::sortCrowdedBuckets(std::span<const std::uint32_t> boxIndices,
                                       std::span<const PaddedBox<Scalar>> boxes,
                                       const ProxyGroups* groups) {
    sortedBuckets_.clear();
    for (Level<Scalar>& level : levels_) {
        const std::size_t countBefore = sortedBuckets_.size();
        const bool mayBeCrowded =
            level.hasCells() ? largestBucket_ > kCrowdedBucket : groups != nullptr;
        const bool isSearched = mayBeCrowded && level.count() > kCrowdedBucket;
        for (std::uint32_t i = 0; isSearched && i < level.bucketCount; ++i) {
            const std::uint32_t bucket = level.firstBucket + i;
            if (bucketStart_[bucket + 1] - bucketStart_[bucket] > kCrowdedBucket) {
                sortBucket(bucket, level.hasCells(), boxIndices, boxes, groups);
            }
        }
        level.sortedCount = static_cast<std::uint32_t>(sortedBuckets_.size() - countBefore);
    }
}

// In parts of the same groups, if there are groups.
template <class Scalar>
void Table<Scalar>::sortBucket(std::uint32_t bucket, bool hasCells,
                               std::span<const std::uint32_t> boxIndices,
                               std::span<const PaddedBox<Scalar>> boxes,
                               const ProxyGroups* groups) {
    const auto groupsOf = [&](std::uint32_t i) { return groups[2 * std::size_t{boxIndices[i]}]; };
    std::uint32_t first = bucketStart_[bucket];
    std::span<std::uint32_t> crowd =
        std::span(order_).subspan(first, bucketStart_[bucket + 1] - first);
    const bool haveGroups = groups != nullptr && sortByGroups(crowd, groupsOf);
    while (!crowd.empty()) {
        std::size_t count = crowd.size();
        if (haveGroups) {
            const auto others = std::find_if(crowd.begin(), crowd.end(), [&](std::uint32_t i) {
                return !(groupsOf(i) == groupsOf(crowd[0]));
            });
            count = static_cast<std::size_t>(others - crowd.begin());
        }
        std::optional<SortedBucket<Scalar>> sorted;
        if (hasCells && count > kFewest) {
            sorted = sortedAlong(crowd.first(count), boxes);
        }
        if (!sorted && haveGroups) {
            sorted = SortedBucket<Scalar>{};  // all count as long
        }
        const std::uint32_t last = first + static_cast<std::uint32_t>(count);
        if (sorted) {
            sorted->bucket = bucket;
            sorted->first = first;
            sorted->firstLong += first;
            sorted->last = last;
            sorted->haveSameGroups = haveGroups;
            sorted->groups = haveGroups ? groupsOf(crowd[0]) : ProxyGroups{};
            sortedBuckets_.push_back(*sorted);
        }
        first = last;
        crowd = crowd.subspan(count);
    }
}

// Sorts the crowd along the axis that serves best; none where none does. Sets the axis, the reach, and
// how many are not long.
template <class Scalar>
std::optional<SortedBucket<Scalar>> Table<Scalar>::sortedAlong(
    std::span<std::uint32_t> crowd, std::span<const PaddedBox<Scalar>> boxes) {
    const BucketCensus<Scalar> census(crowd, boxes);
    const std::optional<std::uint32_t> axis = census.sweepAxis();
    if (!axis) {
        return std::nullopt;
    }
    const auto isLong = [&](std::uint32_t i) { return census.isLong(boxes[i], *axis); };
    longOnes_.clear();
    std::copy_if(crowd.begin(), crowd.end(), std::back_inserter(longOnes_), isLong);
    const auto shortEnd = std::remove_if(crowd.begin(), crowd.end(), isLong);
    std::copy(longOnes_.begin(), longOnes_.end(), shortEnd);
    std::sort(crowd.begin(), shortEnd, [&](std::uint32_t a, std::uint32_t b) {
        const Scalar lowA = boxes[a].low[*axis];
        const Scalar lowB = boxes[b].low[*axis];
        return lowA != lowB ? lowA < lowB : a < b;
    });
    SortedBucket<Scalar> sorted{};
    sorted.axis = *axis;
    sorted.firstLong = static_cast<std::uint32_t>(shortEnd - crowd.begin());
    sorted.reach = census.reach(crowd.first(sorted.firstLong), boxes, *axis);
    return sorted;
}

}  // namespace hashphase::detail
