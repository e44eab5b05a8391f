// SPDX-License-Identifier: Zlib

// The kernels with the vectors of WebAssembly.

#include <broadphase/geometry/quantise.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <wasm_simd128.h>

namespace hashphase::detail {
namespace {

template <class Scalar>
struct Pack;

// pmin(b, a) is a < b ? a : b, and pmax(b, a) is b < a ? a : b. (min and max would pass NaN on, from
// either side.)
template <>
struct Pack<float> {
    static constexpr std::uint32_t kWidth = 4;
    using Numbers = v128_t;
    static Numbers load(const float* from) { return wasm_v128_load(from); }
    static void store(float* to, Numbers a) { wasm_v128_store(to, a); }
    static Numbers broadcast(float x) { return wasm_f32x4_splat(x); }
    static Numbers minus(Numbers a, Numbers b) { return wasm_f32x4_sub(a, b); }
    static Numbers plus(Numbers a, Numbers b) { return wasm_f32x4_add(a, b); }
    static Numbers times(Numbers a, Numbers b) { return wasm_f32x4_mul(a, b); }
    static Numbers least(Numbers a, Numbers b) { return wasm_f32x4_pmin(b, a); }
    static Numbers greatest(Numbers a, Numbers b) { return wasm_f32x4_pmax(b, a); }
    static Numbers abs(Numbers a) { return wasm_f32x4_abs(a); }
    static v128_t lessEqual(Numbers a, Numbers b) { return wasm_f32x4_le(a, b); }
    static v128_t bitAnd(v128_t a, v128_t b) { return wasm_v128_and(a, b); }
    static std::uint32_t bits(v128_t hits) { return wasm_i32x4_bitmask(hits); }
};

template <>
struct Pack<double> {
    static constexpr std::uint32_t kWidth = 2;
    using Numbers = v128_t;
    static Numbers load(const double* from) { return wasm_v128_load(from); }
    static void store(double* to, Numbers a) { wasm_v128_store(to, a); }
    static Numbers broadcast(double x) { return wasm_f64x2_splat(x); }
    static Numbers minus(Numbers a, Numbers b) { return wasm_f64x2_sub(a, b); }
    static Numbers plus(Numbers a, Numbers b) { return wasm_f64x2_add(a, b); }
    static Numbers times(Numbers a, Numbers b) { return wasm_f64x2_mul(a, b); }
    static Numbers least(Numbers a, Numbers b) { return wasm_f64x2_pmin(b, a); }
    static Numbers greatest(Numbers a, Numbers b) { return wasm_f64x2_pmax(b, a); }
    static Numbers abs(Numbers a) { return wasm_f64x2_abs(a); }
    static v128_t lessEqual(Numbers a, Numbers b) { return wasm_f64x2_le(a, b); }
    static v128_t bitAnd(v128_t a, v128_t b) { return wasm_v128_and(a, b); }
    static std::uint32_t bits(v128_t hits) { return wasm_i64x2_bitmask(hits); }
};

template <class Scalar>
using WidePack = Pack<Scalar>;

inline std::uint32_t isApart(const PaddedBox<float>& a, const PaddedBox<float>& b) {
    const v128_t one = wasm_f32x4_le(wasm_v128_load(a.low), wasm_v128_load(b.high));
    const v128_t other = wasm_f32x4_le(wasm_v128_load(b.low), wasm_v128_load(a.high));
    return !wasm_i32x4_all_true(wasm_v128_and(one, other));
}

inline std::uint32_t isApart(const PaddedBox<double>& a, const PaddedBox<double>& b) {
    v128_t all = wasm_f64x2_le(wasm_v128_load(a.low), wasm_v128_load(b.high));
    all = wasm_v128_and(all, wasm_f64x2_le(wasm_v128_load(b.low), wasm_v128_load(a.high)));
    all = wasm_v128_and(all, wasm_f64x2_le(wasm_v128_load(a.low + 2), wasm_v128_load(b.high + 2)));
    all = wasm_v128_and(all, wasm_f64x2_le(wasm_v128_load(b.low + 2), wasm_v128_load(a.high + 2)));
    return !wasm_i64x2_all_true(all);
}

inline void padCorners(const float* corners, PaddedBox<float>& box) {
    const v128_t none = wasm_f32x4_const_splat(0);
    wasm_v128_store(box.low, wasm_f32x4_replace_lane(wasm_v128_load(corners), 3, 0));
    wasm_v128_store(box.high, wasm_i32x4_shuffle(wasm_v128_load(corners + 2), none, 1, 2, 3, 4));
}

inline void padCorners(const double* corners, PaddedBox<double>& box) {
    wasm_v128_store(box.low, wasm_v128_load(corners));
    wasm_v128_store(box.low + 2, wasm_v128_load64_zero(corners + 2));
    wasm_v128_store(box.high, wasm_v128_load(corners + 3));
    wasm_v128_store(box.high + 2, wasm_v128_load64_zero(corners + 5));
}

inline std::uint64_t equalBytes(const std::uint8_t* bytes, std::uint8_t value) {
    std::uint64_t mask = 0;
    for (std::uint32_t k = 0; k < 64; k += 16) {
        const v128_t equal = wasm_i8x16_eq(wasm_v128_load(bytes + k), wasm_u8x16_splat(value));
        mask |= std::uint64_t{wasm_i8x16_bitmask(equal)} << k;
    }
    return mask;
}

inline std::uint32_t bitCount(std::uint64_t word) {
    return static_cast<std::uint32_t>(__builtin_popcountll(word));
}

#include <broadphase/simd/corners_scalar.inl>

#include <broadphase/simd/write_hits_scalar.inl>

#include <broadphase/simd/kernels.inl>

}  // namespace

extern const Kernels<float> kSimd128KernelsFloat;
extern const Kernels<double> kSimd128KernelsDouble;
const Kernels<float> kSimd128KernelsFloat = kKernels<float>;
const Kernels<double> kSimd128KernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
