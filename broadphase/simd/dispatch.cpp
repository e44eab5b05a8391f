// SPDX-License-Identifier: Zlib

// Which instructions the kernels use: the best of those that they were compiled for, as CMake tells
// (broadphase/CMakeLists.txt), and that this processor has.

#include <broadphase/diagnostics.hpp>
#include <broadphase/simd/kernels.hpp>

#include <algorithm>
#include <array>
#include <atomic>

#if HASHPHASE_HAS_AVX_KERNELS && defined(_MSC_VER)
#include <immintrin.h>
#include <intrin.h>
#endif

namespace hashphase::detail {

extern const Kernels<float> kScalarKernelsFloat;
extern const Kernels<double> kScalarKernelsDouble;
extern const Kernels<float> kSse2KernelsFloat;
extern const Kernels<double> kSse2KernelsDouble;
extern const Kernels<float> kAvx2KernelsFloat;
extern const Kernels<double> kAvx2KernelsDouble;
extern const Kernels<float> kAvx512KernelsFloat;
extern const Kernels<double> kAvx512KernelsDouble;
extern const Kernels<float> kNeonKernelsFloat;
extern const Kernels<double> kNeonKernelsDouble;
extern const Kernels<float> kSimd128KernelsFloat;
extern const Kernels<double> kSimd128KernelsDouble;

namespace {

bool isEverywhere() noexcept {
    return true;
}

#if HASHPHASE_HAS_AVX_KERNELS && defined(_MSC_VER)

// What /arch:AVX2 and /arch:AVX512 let the compiler use. Of CPUID leaf 7 EBX: BMI1, AVX2, BMI2; and AVX-512 F, DQ,
// CD, BW, VL. Of XCR0: what the system saves of registers.
constexpr unsigned kAvx2 = 1U << 3 | 1U << 5 | 1U << 8;
constexpr unsigned kAvx512 = kAvx2 | 1U << 16 | 1U << 17 | 1U << 28 | 1U << 30 | 1U << 31;
constexpr unsigned kSavesAvx = 0x06;
constexpr unsigned kSavesAvx512 = 0xe6;

bool hasInstructions(unsigned wanted, unsigned saved) noexcept {
    // Of leaf 1 ECX: FMA, MOVBE, and that XCR0 can be read. Of leaf 0x80000001 ECX: LZCNT.
    constexpr unsigned kFmaMovbeXgetbv = 1U << 12 | 1U << 22 | 1U << 27;
    constexpr unsigned kLzcnt = 1U << 5;
    const auto has = [](int number, std::size_t part, unsigned bits) {
        std::array<int, 4> leaf{};
        __cpuidex(leaf.data(), number, 0);
        return (static_cast<unsigned>(leaf[part]) & bits) == bits;
    };
    std::array<int, 4> last{};
    __cpuid(last.data(), 0);
    return last[0] >= 7 && has(1, 2, kFmaMovbeXgetbv) && (_xgetbv(0) & saved) == saved &&
           has(7, 1, wanted) && has(static_cast<int>(0x80000001), 2, kLzcnt);
}

bool hasAvx2() noexcept {
    return hasInstructions(kAvx2, kSavesAvx);
}

bool hasAvx512() noexcept {
    return hasInstructions(kAvx512, kSavesAvx512);
}

#elif HASHPHASE_HAS_AVX_KERNELS

bool hasAvx2() noexcept {
    return __builtin_cpu_supports("avx2") != 0;
}

bool hasAvx512() noexcept {
    return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
           __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512dq") != 0;
}

#endif

struct Implementation {
    InstructionSet set;
    bool (*isHere)() noexcept;
    const Kernels<float>* ofFloat;
    const Kernels<double>* ofDouble;
};

// The best one last.
constexpr Implementation kImplementations[] = {
    {InstructionSet::scalar, &isEverywhere, &kScalarKernelsFloat, &kScalarKernelsDouble},
#if HASHPHASE_HAS_SSE2_KERNELS
    {InstructionSet::sse2, &isEverywhere, &kSse2KernelsFloat, &kSse2KernelsDouble},
#endif
#if HASHPHASE_HAS_AVX_KERNELS
    {InstructionSet::avx2, &hasAvx2, &kAvx2KernelsFloat, &kAvx2KernelsDouble},
    {InstructionSet::avx512, &hasAvx512, &kAvx512KernelsFloat, &kAvx512KernelsDouble},
#endif
#if HASHPHASE_HAS_NEON_KERNELS
    {InstructionSet::neon, &isEverywhere, &kNeonKernelsFloat, &kNeonKernelsDouble},
#endif
#if HASHPHASE_HAS_SIMD128_KERNELS
    {InstructionSet::simd128, &isEverywhere, &kSimd128KernelsFloat, &kSimd128KernelsDouble},
#endif
};

/// Null where these kernels were not compiled, or not for this processor.
const Implementation* implementationOf(InstructionSet set) noexcept {
    const auto* const found = std::ranges::find(kImplementations, set, &Implementation::set);
    return found != std::end(kImplementations) && found->isHere() ? found : nullptr;
}

const Implementation* bestImplementation() noexcept {
    const Implementation* best = nullptr;
    for (const Implementation& implementation : kImplementations) {
        best = implementation.isHere() ? &implementation : best;
    }
    return best;
}

std::atomic<const Implementation*>& chosen() noexcept {
    static std::atomic<const Implementation*> implementation{bestImplementation()};
    return implementation;
}

const Implementation& implementation() noexcept {
    return *chosen().load(std::memory_order_relaxed);
}

}  // namespace

const char* nameOf(InstructionSet set) noexcept {
    static constexpr const char* kNames[] = {"scalar",  "SSE2", "AVX2",
                                             "AVX-512", "NEON", "SIMD128"};
    static_assert(std::size(kNames) == kInstructionSets.size());
    return kNames[static_cast<std::size_t>(set)];
}

bool isAvailable(InstructionSet set) noexcept {
    return implementationOf(set) != nullptr;
}

InstructionSet instructionSet() noexcept {
    return implementation().set;
}

void useInstructionSet(InstructionSet set) noexcept {
    const Implementation* const wanted = implementationOf(set);
    HASHPHASE_ASSERT(wanted != nullptr,
                     "useInstructionSet(): this build or processor does not have that set. Ask "
                     "isAvailable() first.");
    chosen().store(wanted, std::memory_order_relaxed);
}

template <>
const Kernels<float>& kernels<float>() noexcept {
    return *implementation().ofFloat;
}

template <>
const Kernels<double>& kernels<double>() noexcept {
    return *implementation().ofDouble;
}

}  // namespace hashphase::detail
