// SPDX-License-Identifier: Zlib
#pragma once

// A counting sort of boxes by their buckets, on threads where there are some: each then deals with a range of
// buckets. After Knuth, "The Art of Computer Programming" 3, 5.2, algorithm D.

#include <broadphase/core/parted_blocks.hpp>
#include <broadphase/parallel_for.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

class BucketSort {
public:
    /// Calls find(first, last), on any thread, for ranges of boxes whose buckets it writes into `buckets`; those of
    /// kNoBucket are left out. counts[bucket] is then how many there are. What is in `order` is overwritten.
    void count(std::span<const std::uint32_t> buckets, std::span<std::uint32_t> counts,
               std::vector<std::uint32_t>& order, LoopBody find, ParallelFor parallelFor);

    /// After count(), whose `order` is `scratch`: makes of starts[bucket], its count, its first place in `order`,
    /// where its boxes stand, ascending. starts.back(), which has no count, is how many there are. Returns the
    /// greatest count, but for the last bucket's.
    std::uint32_t sort(std::span<const std::uint32_t> buckets, std::span<std::uint32_t> starts,
                       std::span<const std::uint32_t> scratch, std::vector<std::uint32_t>& order,
                       ParallelFor parallelFor);

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + blocks_.memoryBytes();
    }

private:
    static constexpr std::uint32_t kParts = PartedBlocks::kParts;

    PartedBlocks blocks_;
    std::array<std::uint32_t, kParts> countOf_{};  // of each part
    bool isParted_ = false;                        // else one thread does it all
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
