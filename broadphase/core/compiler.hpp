// SPDX-License-Identifier: Zlib
#pragma once

// What each compiler calls the same thing. The libraries know no compiler and no processor but by this
// header, by <broadphase/export.hpp>, and where instructions are chosen (<broadphase/simd/>).
//
// Attributes stand in brackets, alone or among others, before the declaration:
//
//     [[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline int f();
//
// HASHPHASE_ALWAYS_INLINE     inlined wherever it is called, also where nothing else is optimised
// HASHPHASE_NO_INLINE         never inlined: what is seldom needed does not lengthen what often runs
// HASHPHASE_FLATTEN           all that the function calls is inlined in it, and what that calls (by Clang
//                             before 22, what it calls itself)
// HASHPHASE_LIFETIME_BOUND    of a parameter to which the new object keeps a reference: a compiler that
//                             knows it warns where a temporary would die before the object
// HASHPHASE_KEPT              of a variable that compiler and linker keep though nothing uses it
// HASHPHASE_HAS_SSE2, HASHPHASE_HAS_NEON, HASHPHASE_HAS_SIMD128
//                             1 where every processor that this code is compiled for has these instructions
// HASHPHASE_STANDARD_LIBRARY  the name of a symbol that says which standard library this is, where programs
//                             and libraries may be at odds about it (core/same_library.hpp)
// HASHPHASE_HAS_EXCEPTIONS    1 where this code is compiled with exceptions (without -fno-exceptions)
// HASHPHASE_HAS_RTTI          1 where this code is compiled with RTTI (without -fno-rtti), and an object tells
//                             whether its class was. With MSVC none tells, and Bullet is compiled without
// HASHPHASE_IS_OPTIMISED      1 where this code is optimised. MSVC does not say; there, 1 without its run-time
//                             library for debugging
// HASHPHASE_OVERLOOKS_NAN     1 where comparisons may be compiled as if no number were NaN or infinite
//                             (-ffast-math); isNan() and isFinite() look at the bits then

#include <bit>
#include <cfloat>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

// A float that is calculated with more bits (x87) is another one where it is stored, and a box would no longer
// be filed where it is looked for.
#if FLT_EVAL_METHOD == 1 || FLT_EVAL_METHOD == 2 || (defined(__i386__) && !defined(__SSE2_MATH__))
#error "hashphase needs SSE2 on 32-bit x86: x87 rounds differently. Add -msse2 -mfpmath=sse."
#endif

#if defined(__clang__) || defined(__GNUC__)
#define HASHPHASE_ALWAYS_INLINE gnu::always_inline
#define HASHPHASE_NO_INLINE gnu::noinline
#define HASHPHASE_FLATTEN gnu::flatten
#if defined(__ELF__) && __has_cpp_attribute(gnu::retain)
#define HASHPHASE_KEPT gnu::used, gnu::retain
#else
#define HASHPHASE_KEPT gnu::used
#endif
#elif defined(_MSC_VER)
#define HASHPHASE_ALWAYS_INLINE msvc::forceinline
#define HASHPHASE_NO_INLINE msvc::noinline
#define HASHPHASE_FLATTEN msvc::flatten
#define HASHPHASE_KEPT maybe_unused
#include <intrin.h>
#else
// Which changes nothing; some parsers take no empty brackets.
#define HASHPHASE_ALWAYS_INLINE maybe_unused
#define HASHPHASE_NO_INLINE maybe_unused
#define HASHPHASE_FLATTEN maybe_unused
#define HASHPHASE_KEPT maybe_unused
#endif

#if __has_cpp_attribute(clang::lifetimebound)
#define HASHPHASE_LIFETIME_BOUND clang::lifetimebound
#elif __has_cpp_attribute(msvc::lifetimebound)
#define HASHPHASE_LIFETIME_BOUND msvc::lifetimebound
#else
#define HASHPHASE_LIFETIME_BOUND maybe_unused
#endif

#if defined(__SSE2__) || (defined(_M_X64) && !defined(_M_ARM64EC)) ||                              \
    (defined(_M_IX86_FP) && _M_IX86_FP >= 2)
#define HASHPHASE_HAS_SSE2 1
#else
#define HASHPHASE_HAS_SSE2 0
#endif
#if (defined(__aarch64__) && !defined(__ARM_BIG_ENDIAN)) || defined(_M_ARM64)
#define HASHPHASE_HAS_NEON 1
#else
#define HASHPHASE_HAS_NEON 0
#endif
#if defined(__wasm_simd128__)
#define HASHPHASE_HAS_SIMD128 1
#else
#define HASHPHASE_HAS_SIMD128 0
#endif

#if defined(_LIBCPP_VERSION)
#define HASHPHASE_STANDARD_LIBRARY librariesAreCompiledFor_libcxx
#elif defined(_GLIBCXX_DEBUG)
#define HASHPHASE_STANDARD_LIBRARY librariesAreCompiledWith_GLIBCXX_DEBUG
#elif defined(_GLIBCXX_USE_CXX11_ABI) && !_GLIBCXX_USE_CXX11_ABI
#define HASHPHASE_STANDARD_LIBRARY librariesAreCompiledWithout_GLIBCXX_USE_CXX11_ABI
#elif defined(__GLIBCXX__)
#define HASHPHASE_STANDARD_LIBRARY librariesAreCompiledFor_libstdcxx
#elif defined(_ITERATOR_DEBUG_LEVEL) && _ITERATOR_DEBUG_LEVEL == 2
#define HASHPHASE_STANDARD_LIBRARY librariesAreCompiledWith_ITERATOR_DEBUG_LEVEL_2
#elif defined(_ITERATOR_DEBUG_LEVEL) && _ITERATOR_DEBUG_LEVEL == 1
#define HASHPHASE_STANDARD_LIBRARY librariesAreCompiledWith_ITERATOR_DEBUG_LEVEL_1
#else
#define HASHPHASE_STANDARD_LIBRARY librariesAreCompiledForAnyStandardLibrary
#endif

#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
#define HASHPHASE_HAS_EXCEPTIONS 1
#else
#define HASHPHASE_HAS_EXCEPTIONS 0
#endif
#if defined(__cpp_rtti) && !defined(_MSC_VER)
#define HASHPHASE_HAS_RTTI 1
#else
#define HASHPHASE_HAS_RTTI 0
#endif
#if defined(__clang__) || defined(__GNUC__)
#if defined(__OPTIMIZE__)
#define HASHPHASE_IS_OPTIMISED 1
#else
#define HASHPHASE_IS_OPTIMISED 0
#endif
#elif defined(_DEBUG)
#define HASHPHASE_IS_OPTIMISED 0
#else
#define HASHPHASE_IS_OPTIMISED 1
#endif
#if (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || defined(_M_FP_FAST)
#if defined(__clang__)  // takes even an infinity that a function returns for undefined
#error "hashphase needs infinity and NaN, which -ffast-math drops. Add -fno-finite-math-only."
#endif
#define HASHPHASE_OVERLOOKS_NAN 1
#else
#define HASHPHASE_OVERLOOKS_NAN 0
#endif

namespace hashphase::detail {

/// Begins to fetch what lies there into the processor's cache. Any address will do, also null.
[[HASHPHASE_ALWAYS_INLINE]] inline void prefetch([[maybe_unused]] const void* address) noexcept {
#if defined(__clang__) || defined(__GNUC__)
    __builtin_prefetch(address);
#if !defined(__clang__)
    // GCC takes a function that does nothing else for one without effects, and leaves out the calls of it.
    __asm__ volatile("");
#endif
#elif defined(_M_X64) || defined(_M_IX86)
    _mm_prefetch(static_cast<const char*>(address), 1);  // _MM_HINT_T0
#elif defined(_M_ARM64)
    __prefetch(address);
#endif
}

/// The same for all of a large object.
template <class Object>
[[HASHPHASE_ALWAYS_INLINE]] inline void prefetchAll(const Object& object) noexcept {
    constexpr std::size_t kCacheLine = 64;
    const auto* const begin = reinterpret_cast<const char*>(&object);
    for (std::size_t at = 0; at < sizeof(Object); at += kCacheLine) {
        prefetch(begin + at);
    }
}

/// The number of the lowest bit that is set in a word that is not 0.
template <std::unsigned_integral Word>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline std::uint32_t lowestBit(Word word) noexcept {
    // Not by std::countr_zero() alone: where that is not inlined, the linker might keep a copy that was compiled
    // for another processor.
#if defined(__clang__) || defined(__GNUC__)
    return static_cast<std::uint32_t>(sizeof(Word) <= 4 ? __builtin_ctz(static_cast<unsigned>(word))
                                                        : __builtin_ctzll(word));
#elif defined(_M_X64) || defined(_M_ARM64)
    unsigned long bit = 0;
    _BitScanForward64(&bit, word);
    return bit;
#else
    return static_cast<std::uint32_t>(std::countr_zero(word));
#endif
}

/// |x|, of which no branch is made. Of NaN, NaN.
template <std::floating_point Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline Scalar magnitude(Scalar x) noexcept {
#if defined(__clang__) || defined(__GNUC__)
    return static_cast<Scalar>(__builtin_fabs(static_cast<double>(x)));
#else
    return std::fabs(x);
#endif
}

/// The bits of |x|: in the order of the numbers, those of infinity after them, those of NaN last.
template <std::floating_point Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline auto magnitudeBits(const Scalar& x) noexcept {
    using Bits = std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t>;
    return static_cast<Bits>(std::bit_cast<Bits>(x) & (~Bits{0} >> 1));
}
template <std::floating_point Scalar>
inline constexpr auto kInfinityBits =
    std::bit_cast<std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t>>(
        std::numeric_limits<Scalar>::infinity());

/// std::isnan() and std::isfinite(), with -ffast-math as well.
template <std::floating_point Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline bool isNan(const Scalar& x) noexcept {
    return HASHPHASE_OVERLOOKS_NAN ? magnitudeBits(x) > kInfinityBits<Scalar> : x != x;
}
template <std::floating_point Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline bool isFinite(const Scalar& x) noexcept {
    return HASHPHASE_OVERLOOKS_NAN ? magnitudeBits(x) < kInfinityBits<Scalar> : std::isfinite(x);
}
/// std::isunordered(), with -ffast-math as well.
template <std::floating_point Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline bool areUnordered(const Scalar& a,
                                                                const Scalar& b) noexcept {
    return HASHPHASE_OVERLOOKS_NAN ? isNan(a) || isNan(b) : std::isunordered(a, b);
}

/// Where an object of a class with virtual members says which one it has. Objects of one class mostly have equal ones,
/// those of two classes never.
template <class Object>
[[nodiscard]] const void* const* virtualTableOf(const Object& object) noexcept {
    const void* const* virtualTable = nullptr;
    std::memcpy(&virtualTable, static_cast<const void*>(&object), sizeof(virtualTable));
    return virtualTable;
}

/// Whether dynamic_cast may ask an object, which has virtual functions: its class, and this code, were
/// compiled with RTTI.
template <class Object>
[[nodiscard]] bool knowsItsType([[maybe_unused]] const Object& object) noexcept {
#if HASHPHASE_HAS_RTTI
    return virtualTableOf(object)[-1] != nullptr;
#else
    return false;
#endif
}

}  // namespace hashphase::detail
