// SPDX-License-Identifier: Zlib
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace hashphase::detail {

/// An array that never moves its elements. Their addresses follow from their indices without a look
/// at a list of them; each block of them begins on a cache line.
template <class Element>
class StableArray {
public:
    /// As with pointers, a constant array does not make its elements constant.
    [[nodiscard]] Element* at(std::size_t i) const noexcept {
        return &blocks_[i / kBlockSize]->elements[i % kBlockSize];
    }

    /// Makes room for at least `count` elements, which begin as Element().
    void reserve(std::size_t count) {
        while (capacity() < count) {
            addBlocks();
        }
    }

    [[nodiscard]] std::size_t capacity() const noexcept { return blocks_.size() * kBlockSize; }

    /// Gives back the memory of the elements at the end, but for the first `count`.
    void shrink(std::size_t count) noexcept {
        while (!owners_.empty() && owners_.back().firstBlock * kBlockSize >= count) {
            blocks_.resize(owners_.back().firstBlock);
            owners_.pop_back();
        }
        blocks_.shrink_to_fit();
        owners_.shrink_to_fit();
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return blocks_.size() * sizeof(Block) + blocks_.capacity() * sizeof(void*) +
               owners_.capacity() * sizeof(owners_[0]);
    }

private:
    static constexpr std::size_t kBlockSize = 16;
    static constexpr std::size_t kBlocksAtOnce = 4;  // once there are as many

    struct alignas(64) Block {
        std::array<Element, kBlockSize> elements{};
    };

    /// Blocks that were made at once.
    struct Owner {
        std::unique_ptr<Block[]> blocks;
        std::size_t firstBlock;
    };

    void addBlocks() {
        const std::size_t first = blocks_.size();
        const std::size_t count = first < kBlocksAtOnce ? 1 : kBlocksAtOnce;
        blocks_.reserve(std::max<std::size_t>(first + count, first + first / 2));
        owners_.push_back({std::make_unique<Block[]>(count), first});
        for (std::size_t i = 0; i < count; ++i) {
            blocks_.push_back(&owners_.back().blocks[i]);
        }
    }

    std::vector<Block*> blocks_;  // of those owned, in their order
    std::vector<Owner> owners_;
};

}  // namespace hashphase::detail
