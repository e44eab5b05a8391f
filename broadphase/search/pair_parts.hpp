// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/parallel_for.hpp>
#include <broadphase/simd/kernels.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// Pairs that a loop finds on several threads, put together in the loop's order: what it finds
/// does not depend on the threads. Keeps its memory.
class PairParts {
public:
    /// Calls search(first, last, PairSink&, KernelCost&) for ranges that cover 0 to count, each of
    /// about `grain` or more, and appends what they found to `found`.
    template <class Search>
    void collect(ParallelFor parallelFor, std::size_t count, std::size_t grain, PairList& found,
                 KernelCost& cost, const Search& search) {
        if (count == 0) {
            return;
        }
        const std::size_t chunkCount = (count + grain - 1) / grain;
        parts_.resize(std::max(parts_.size(), chunkCount));
        for (std::size_t i = 0; i < chunkCount; ++i) {
            parts_[i].found.clear();
            parts_[i].cost = {};
        }
        // Several chunks in one go are one part, which is that of the first one.
        parallelFor(chunkCount, 1, [&](std::size_t begin, std::size_t end) {
            KernelCost own;
            parts_[begin].found.append([&](PairSink& sink) {
                search(begin * grain, std::min(end * grain, count), sink, own);
            });
            parts_[begin].cost = own;
        });
        std::size_t size = found.size();
        for (std::size_t i = 0; i < chunkCount; ++i) {
            cost += parts_[i].cost;
            if (size == 0) {
                found.swap(parts_[i].found);
                size = found.size();
            } else {
                parts_[i].offset = size;
                size += parts_[i].found.size();
            }
        }
        if (size == found.size()) {
            return;
        }
        IndexPair* const all = found.resize(size);
        parallelFor(chunkCount, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                std::ranges::copy(parts_[i].found.pairs(), all + parts_[i].offset);
            }
        });
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        std::size_t bytes = parts_.capacity() * sizeof(Part);
        for (const Part& part : parts_) {
            bytes += part.found.memoryBytes();
        }
        return bytes;
    }

private:
    struct Part {
        PairList found;
        KernelCost cost;
        std::size_t offset = 0;  // of what was found among all
    };

    std::vector<Part> parts_;
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
