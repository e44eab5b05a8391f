// SPDX-License-Identifier: Zlib
#pragma once

// The loops that find overlaps, compiled for several instruction sets and chosen at run time.
//
// All give the same pairs in the same order; the scalar one is the definition.
//
// Threads   The instruction set is chosen once, or by a test while nothing else runs. The kernels
//           may run anywhere, each with a list of pairs of its own.

#include <broadphase/export.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

enum class InstructionSet { scalar, sse2, avx2, avx512, neon, simd128 };

/// All that there are, the scalar one first.
inline constexpr std::array kInstructionSets{InstructionSet::scalar, InstructionSet::sse2,
                                             InstructionSet::avx2,   InstructionSet::avx512,
                                             InstructionSet::neon,   InstructionSet::simd128};

[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT const char* nameOf(InstructionSet set) noexcept;

/// True when the library was built with it and this processor has it.
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT bool isAvailable(InstructionSet set) noexcept;

/// The one in use: the best one available, or what was chosen by useInstructionSet().
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT InstructionSet instructionSet() noexcept;

/// For tests and measurements. It must be available.
HASHPHASE_BROADPHASE_EXPORT void useInstructionSet(InstructionSet set) noexcept;

/// Those of the instruction set in use.
template <class Scalar>
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT const Kernels<Scalar>& kernels() noexcept;
template <>
HASHPHASE_BROADPHASE_EXPORT const Kernels<float>& kernels<float>() noexcept;
template <>
HASHPHASE_BROADPHASE_EXPORT const Kernels<double>& kernels<double>() noexcept;

/// A growing array of pairs for kernels to write to. Does not initialise what it grows by, and
/// keeps its memory.
class PairList {
public:
    [[nodiscard]] std::span<const IndexPair> pairs() const noexcept { return {data_.get(), size_}; }
    [[nodiscard]] std::span<IndexPair> all() noexcept { return {data_.get(), size_}; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    void clear() noexcept { size_ = 0; }

    /// Calls kernel(PairSink&), which appends.
    template <std::invocable<PairSink&> Kernel>
    void append(const Kernel& kernel) {
        PairSink sink{data_.get() + size_, data_.get() + capacity_, &grow, this};
        kernel(sink);
        size_ = static_cast<std::size_t>(sink.next - data_.get());
    }

    void append(std::span<const IndexPair> pairs) {
        append([pairs](PairSink& sink) {
            makeRoom(sink, pairs.size());
            sink.next = std::copy(pairs.begin(), pairs.end(), sink.next);
        });
    }

    /// Appends one pair.
    void push(IndexPair pair) {
        append([&](PairSink& sink) {
            makeRoom(sink, 1);
            *sink.next++ = pair;
        });
    }

    /// Room for `count` pairs in all, whose values are the caller's to write.
    [[nodiscard]] IndexPair* resize(std::size_t count);

    [[nodiscard]] std::size_t memoryBytes() const noexcept { return capacity_ * sizeof(IndexPair); }
    [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }
    /// Gives back room for more pairs than there are. Where memory runs out, nothing has changed.
    void shrink();

    /// See core/copy_parts.hpp.
    void makeRoomFor(const PairList& from);
    void copyFrom(const PairList& from) noexcept {
        size_ = from.size_;
        std::ranges::copy(from.pairs(), data_.get());
    }

    void swap(PairList& other) noexcept {
        data_.swap(other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }

private:
    static bool grow(PairSink& sink, std::size_t count);

    std::unique_ptr<IndexPair[]> data_;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
};

/// The same for a search that finds few: they are on the stack, and on the heap when they are more.
class FewPairs {
public:
    // Its 4 kB are written before they are read.
    // cppcheck-suppress uninitMemberVar
    FewPairs() = default;
    FewPairs(const FewPairs&) = delete;
    FewPairs& operator=(const FewPairs&) = delete;

    [[nodiscard]] std::span<const IndexPair> pairs() const noexcept { return {data_, size_}; }

    /// Calls kernel(PairSink&), whose pairs take the place of all earlier ones.
    template <std::invocable<PairSink&> Kernel>
    void assign(const Kernel& kernel) {
        PairSink sink{data_, data_ + capacity_, &grow, this};
        kernel(sink);
        size_ = static_cast<std::size_t>(sink.next - data_);
    }

private:
    static constexpr std::size_t kFew = 512;

    static bool grow(PairSink& sink, std::size_t count);

    IndexPair few_[kFew];
    std::unique_ptr<IndexPair[]> many_;
    IndexPair* data_ = few_;
    std::size_t size_ = 0;
    std::size_t capacity_ = kFew;
};

/// Calls search(PairSink&), and use(pairs) with what it finds, block by block, in the order in which it
/// is found: however many there are, they take the memory of a block.
template <std::invocable<PairSink&> Search, std::invocable<std::span<const IndexPair>> Use>
void findInBlocks(const Search& search, const Use& use) {
    struct Blocks {
        const Use& use;
        std::vector<IndexPair> block;

        bool handOn(PairSink& sink) {
            use({block.data(), static_cast<std::size_t>(sink.next - block.data())});
            sink.next = block.data();
            return true;
        }
    };
    constexpr std::size_t kBlock = 4096;
    static_assert(kBlock >= kMostRoom);
    Blocks blocks{use, std::vector<IndexPair>(kBlock)};
    const auto grow = [](PairSink& sink, std::size_t /*count*/) {
        return static_cast<Blocks*>(sink.owner)->handOn(sink);
    };
    PairSink sink{blocks.block.data(), blocks.block.data() + kBlock, grow, &blocks};
    search(sink);
    blocks.handOn(sink);
}

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
