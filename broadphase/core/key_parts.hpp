// SPDX-License-Identifier: Zlib
#pragma once

// Many keys of a FlatSet, put apart by the part of its table where each is looked for. What is found is noted in
// that order: what one thread writes lies together.

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/parallel_for_noexcept.hpp>
#include <broadphase/core/parted_blocks.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

class KeyParts {
public:
    /// What a search found that was not made; no number of a set of fewer keys.
    static constexpr std::uint32_t kNotSearched = FlatSet::kNone - 1;

    /// So that search() takes no memory.
    void reserve(std::size_t count) {
        ensureCapacity(order_, count);
        ensureCapacity(foundInOrder_, count);
        ensureCapacity(found_, count);
        blocks_.reserve(count);
    }

    /// Returns findInPart(i), which is FlatSet::vacateInPart() or insertInPart() of keyOf(i), for each i below
    /// `count`, ascending within a part; kNotSearched in place of nullopt. Any thread calls both, keyOf() more
    /// than once. prefetch(i) is called some time before findInPart(i). Valid until the next call.
    template <class KeyOf, class Prefetch, class FindInPart>
    std::span<std::uint32_t> search(std::size_t count, ParallelFor parallelFor, const KeyOf& keyOf,
                                    const Prefetch& prefetch,
                                    const FindInPart& findInPart) noexcept {
        order_.resize(count);
        foundInOrder_.resize(count);
        found_.resize(count);
        blocks_.resize(count);
        forBlocks(parallelFor, [&](std::size_t first, std::size_t last) {
            blocks_.sort(
                first, last, [&](std::size_t i) { return FlatSet::partOf(keyOf(i)); },
                order_.data());
            std::fill(foundInOrder_.data() + first, foundInOrder_.data() + last, kNotSearched);
        });
        parallelForNoexcept(
            parallelFor, FlatSet::kParts, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t part = begin; part < end; ++part) {
                    blocks_.forEachOf(part, [&](std::size_t first, std::size_t last) {
                        searchSome(first, last, prefetch, findInPart);
                    });
                }
            });
        forBlocks(parallelFor, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                found_[order_[i]] = foundInOrder_[i];
            }
        });
        return found_;
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + blocks_.memoryBytes() +
               (order_.capacity() + foundInOrder_.capacity() + found_.capacity()) *
                   sizeof(std::uint32_t);
    }

private:
    template <class Body>
    void forBlocks(ParallelFor parallelFor, const Body& body) noexcept {
        constexpr std::size_t kBlock = PartedBlocks::kBlock;
        parallelForNoexcept(parallelFor, PartedBlocks::blockCount(order_.size()), 1,
                            [&](std::size_t begin, std::size_t end) {
                                body(begin * kBlock, std::min(end * kBlock, order_.size()));
                            });
    }

    // Perhaps twice, where the loop throws: what has been found is not looked for again.
    template <class Prefetch, class FindInPart>
    void searchSome(std::size_t first, std::size_t last, const Prefetch& prefetch,
                    const FindInPart& findInPart) noexcept {
        constexpr std::size_t kAhead = 8;
        for (std::size_t i = first; i < std::min(first + kAhead, last); ++i) {
            prefetch(order_[i]);
        }
        for (std::size_t i = first; i < last; ++i) {
            if (i + kAhead < last) {
                prefetch(order_[i + kAhead]);
            }
            if (foundInOrder_[i] == kNotSearched) {
                foundInOrder_[i] = findInPart(order_[i]).value_or(kNotSearched);
            }
        }
    }

    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> foundInOrder_;
    std::vector<std::uint32_t> found_;
    PartedBlocks blocks_;
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
