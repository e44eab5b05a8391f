// SPDX-License-Identifier: Zlib
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace hashphase::detail {

/// An array that grows at its end and never moves its elements. Their addresses follow from their
/// indices without a look at a list of them; each block begins on a cache line.
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
            blocks_.push_back(std::make_unique<Block>());
        }
    }

    [[nodiscard]] std::size_t capacity() const noexcept { return blocks_.size() * kBlockSize; }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return blocks_.size() * sizeof(Block) + blocks_.capacity() * sizeof(blocks_[0]);
    }

private:
    static constexpr std::size_t kBlockSize = 64;

    struct alignas(64) Block {
        std::array<Element, kBlockSize> elements{};
    };

    std::vector<std::unique_ptr<Block>> blocks_;
};

}  // namespace hashphase::detail
