// SPDX-License-Identifier: Zlib
#include <broadphase/simd/kernels.hpp>

#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <array>
#include <atomic>

namespace hashphase::detail {

extern const Kernels<float> kScalarKernelsFloat;
extern const Kernels<double> kScalarKernelsDouble;
#if HASHPHASE_HAS_X86_KERNELS
extern const Kernels<float> kSse2KernelsFloat;
extern const Kernels<double> kSse2KernelsDouble;
extern const Kernels<float> kAvx2KernelsFloat;
extern const Kernels<double> kAvx2KernelsDouble;
extern const Kernels<float> kAvx512KernelsFloat;
extern const Kernels<double> kAvx512KernelsDouble;
#endif

namespace {

struct Implementation {
    InstructionSet set;
    const char* name;
    const Kernels<float>* ofFloat;
    const Kernels<double>* ofDouble;
};

// By InstructionSet.
#if HASHPHASE_HAS_X86_KERNELS
const std::array<Implementation, 4> kImplementations{{
    {InstructionSet::scalar, "scalar", &kScalarKernelsFloat, &kScalarKernelsDouble},
    {InstructionSet::sse2, "SSE2", &kSse2KernelsFloat, &kSse2KernelsDouble},
    {InstructionSet::avx2, "AVX2", &kAvx2KernelsFloat, &kAvx2KernelsDouble},
    {InstructionSet::avx512, "AVX-512", &kAvx512KernelsFloat, &kAvx512KernelsDouble},
}};
#else
const std::array<Implementation, 1> kImplementations{{
    {InstructionSet::scalar, "scalar", &kScalarKernelsFloat, &kScalarKernelsDouble},
}};
#endif

bool hasInstructions([[maybe_unused]] InstructionSet set) noexcept {
#if HASHPHASE_HAS_X86_KERNELS
    switch (set) {
        case InstructionSet::avx2:
            return __builtin_cpu_supports("avx2") != 0;
        case InstructionSet::avx512:
            return __builtin_cpu_supports("avx512f") != 0 &&
                   __builtin_cpu_supports("avx512vl") != 0 &&
                   __builtin_cpu_supports("avx512bw") != 0 &&
                   __builtin_cpu_supports("avx512dq") != 0;
        default:
            break;
    }
#endif
    return true;
}

const Implementation& bestImplementation() noexcept {
    std::size_t best = 0;
    for (std::size_t i = 0; i < kImplementations.size(); ++i) {
        best = hasInstructions(kImplementations[i].set) ? i : best;
    }
    return kImplementations[best];
}

std::atomic<const Implementation*>& chosen() noexcept {
    static std::atomic<const Implementation*> implementation{&bestImplementation()};
    return implementation;
}

const Implementation& implementation() noexcept {
    return *chosen().load(std::memory_order_relaxed);
}

}  // namespace

const char* nameOf(InstructionSet set) noexcept {
    static constexpr const char* kNames[] = {"scalar", "SSE2", "AVX2", "AVX-512"};
    return kNames[static_cast<std::size_t>(set)];
}

bool isAvailable(InstructionSet set) noexcept {
    return static_cast<std::size_t>(set) < kImplementations.size() && hasInstructions(set);
}

InstructionSet instructionSet() noexcept {
    return implementation().set;
}

void useInstructionSet(InstructionSet set) noexcept {
    HASHPHASE_ASSERT(isAvailable(set), "Only an instruction set that is available can be used.");
    chosen().store(&kImplementations[static_cast<std::size_t>(set)], std::memory_order_relaxed);
}

template <>
const Kernels<float>& kernels<float>() noexcept {
    return *implementation().ofFloat;
}

template <>
const Kernels<double>& kernels<double>() noexcept {
    return *implementation().ofDouble;
}

// --- PairList ------------------------------------------------------------------------------------

bool PairList::grow(PairSink& sink, std::size_t count) {
    auto& list = *static_cast<PairList*>(sink.owner);
    const auto size = static_cast<std::size_t>(sink.next - list.data_.get());
    // What a search finds in a frame like the last ones has room.
    constexpr std::size_t kFewest = 128;
    const auto capacity = std::max<std::size_t>({2 * list.capacity_, size + count, kFewest});
    auto data = std::make_unique_for_overwrite<IndexPair[]>(capacity);
    std::copy_n(list.data_.get(), size, data.get());
    list.data_ = std::move(data);
    list.capacity_ = capacity;
    sink.next = list.data_.get() + size;
    sink.end = list.data_.get() + capacity;
    return true;
}

void PairList::shrink() {
    if (size_ < capacity_) {
        PairList fresh;
        if (size_ > 0) {
            std::copy_n(data_.get(), size_, fresh.resize(size_));
        }
        swap(fresh);
    }
}

IndexPair* PairList::resize(std::size_t count) {
    if (capacity_ < count) {
        append([&](PairSink& sink) { grow(sink, count); });
    }
    size_ = count;
    return data_.get();
}

bool FewPairs::grow(PairSink& sink, std::size_t count) {
    auto& list = *static_cast<FewPairs*>(sink.owner);
    const auto size = static_cast<std::size_t>(sink.next - list.data_);
    const std::size_t capacity = std::max(2 * list.capacity_, size + count);
    auto many = std::make_unique_for_overwrite<IndexPair[]>(capacity);
    std::copy_n(list.data_, size, many.get());
    list.many_ = std::move(many);
    list.data_ = list.many_.get();
    list.capacity_ = capacity;
    sink.next = list.data_ + size;
    sink.end = list.data_ + capacity;
    return true;
}

}  // namespace hashphase::detail
