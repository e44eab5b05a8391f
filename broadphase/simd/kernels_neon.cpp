// SPDX-License-Identifier: Zlib

// The kernels with what every 64-bit ARM processor has.

#include <broadphase/geometry/quantise.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <arm_neon.h>

namespace hashphase::detail {
namespace {

template <class Scalar>
struct Pack;

// Two registers side by side, whose masks become one number together. (vminq and vmaxq would pass NaN
// on, from either side.)
template <>
struct Pack<float> {
    static constexpr std::uint32_t kWidth = 8;
    struct Numbers {
        float32x4_t a;
        float32x4_t b;
    };
    struct Hits {
        uint32x4_t a;
        uint32x4_t b;
    };
    static Numbers load(const float* from) { return {vld1q_f32(from), vld1q_f32(from + 4)}; }
    static void store(float* to, Numbers x) {
        vst1q_f32(to, x.a);
        vst1q_f32(to + 4, x.b);
    }
    static Numbers broadcast(float x) { return {vdupq_n_f32(x), vdupq_n_f32(x)}; }
    static Numbers minus(Numbers x, Numbers y) {
        return {vsubq_f32(x.a, y.a), vsubq_f32(x.b, y.b)};
    }
    static Numbers plus(Numbers x, Numbers y) { return {vaddq_f32(x.a, y.a), vaddq_f32(x.b, y.b)}; }
    static Numbers times(Numbers x, Numbers y) {
        return {vmulq_f32(x.a, y.a), vmulq_f32(x.b, y.b)};
    }
    static Numbers least(Numbers x, Numbers y) {
        return {vbslq_f32(vcltq_f32(x.a, y.a), x.a, y.a), vbslq_f32(vcltq_f32(x.b, y.b), x.b, y.b)};
    }
    static Numbers greatest(Numbers x, Numbers y) {
        return {vbslq_f32(vcgtq_f32(x.a, y.a), x.a, y.a), vbslq_f32(vcgtq_f32(x.b, y.b), x.b, y.b)};
    }
    static Numbers abs(Numbers x) { return {vabsq_f32(x.a), vabsq_f32(x.b)}; }
    static Hits lessEqual(Numbers x, Numbers y) {
        return {vcleq_f32(x.a, y.a), vcleq_f32(x.b, y.b)};
    }
    static Hits bitAnd(Hits x, Hits y) { return {vandq_u32(x.a, y.a), vandq_u32(x.b, y.b)}; }
    static std::uint32_t bits(Hits hits) {
        constexpr std::uint16_t kBits[] = {1, 2, 4, 8, 16, 32, 64, 128};
        const uint16x8_t all =
            vuzp1q_u16(vreinterpretq_u16_u32(hits.a), vreinterpretq_u16_u32(hits.b));
        return vaddvq_u16(vandq_u16(all, vld1q_u16(kBits)));
    }
};

template <>
struct Pack<double> {
    static constexpr std::uint32_t kWidth = 4;
    struct Numbers {
        float64x2_t a;
        float64x2_t b;
    };
    struct Hits {
        uint64x2_t a;
        uint64x2_t b;
    };
    static Numbers load(const double* from) { return {vld1q_f64(from), vld1q_f64(from + 2)}; }
    static void store(double* to, Numbers x) {
        vst1q_f64(to, x.a);
        vst1q_f64(to + 2, x.b);
    }
    static Numbers broadcast(double x) { return {vdupq_n_f64(x), vdupq_n_f64(x)}; }
    static Numbers minus(Numbers x, Numbers y) {
        return {vsubq_f64(x.a, y.a), vsubq_f64(x.b, y.b)};
    }
    static Numbers plus(Numbers x, Numbers y) { return {vaddq_f64(x.a, y.a), vaddq_f64(x.b, y.b)}; }
    static Numbers times(Numbers x, Numbers y) {
        return {vmulq_f64(x.a, y.a), vmulq_f64(x.b, y.b)};
    }
    static Numbers least(Numbers x, Numbers y) {
        return {vbslq_f64(vcltq_f64(x.a, y.a), x.a, y.a), vbslq_f64(vcltq_f64(x.b, y.b), x.b, y.b)};
    }
    static Numbers greatest(Numbers x, Numbers y) {
        return {vbslq_f64(vcgtq_f64(x.a, y.a), x.a, y.a), vbslq_f64(vcgtq_f64(x.b, y.b), x.b, y.b)};
    }
    static Numbers abs(Numbers x) { return {vabsq_f64(x.a), vabsq_f64(x.b)}; }
    static Hits lessEqual(Numbers x, Numbers y) {
        return {vcleq_f64(x.a, y.a), vcleq_f64(x.b, y.b)};
    }
    static Hits bitAnd(Hits x, Hits y) { return {vandq_u64(x.a, y.a), vandq_u64(x.b, y.b)}; }
    static std::uint32_t bits(Hits hits) {
        constexpr std::uint32_t kBits[] = {1, 2, 4, 8};
        const uint32x4_t all =
            vuzp1q_u32(vreinterpretq_u32_u64(hits.a), vreinterpretq_u32_u64(hits.b));
        return vaddvq_u32(vandq_u32(all, vld1q_u32(kBits)));
    }
};

template <class Scalar>
using WidePack = Pack<Scalar>;

inline std::uint32_t isApart(const PaddedBox<float>& a, const PaddedBox<float>& b) {
    const uint32x4_t one = vcleq_f32(vld1q_f32(a.low), vld1q_f32(b.high));
    const uint32x4_t other = vcleq_f32(vld1q_f32(b.low), vld1q_f32(a.high));
    return vminvq_u32(vandq_u32(one, other)) == 0;
}

inline std::uint32_t isApart(const PaddedBox<double>& a, const PaddedBox<double>& b) {
    uint64x2_t all = vcleq_f64(vld1q_f64(a.low), vld1q_f64(b.high));
    all = vandq_u64(all, vcleq_f64(vld1q_f64(b.low), vld1q_f64(a.high)));
    all = vandq_u64(all, vcleq_f64(vld1q_f64(a.low + 2), vld1q_f64(b.high + 2)));
    all = vandq_u64(all, vcleq_f64(vld1q_f64(b.low + 2), vld1q_f64(a.high + 2)));
    return vminvq_u32(vreinterpretq_u32_u64(all)) == 0;
}

inline void padCorners(const float* corners, PaddedBox<float>& box) {
    vst1q_f32(box.low, vsetq_lane_f32(0, vld1q_f32(corners), 3));
    vst1q_f32(box.high, vextq_f32(vld1q_f32(corners + 2), vdupq_n_f32(0), 1));
}

inline void padCorners(const double* corners, PaddedBox<double>& box) {
    const float64x2_t none = vdupq_n_f64(0);
    vst1q_f64(box.low, vld1q_f64(corners));
    vst1q_f64(box.low + 2, vld1q_lane_f64(corners + 2, none, 0));
    vst1q_f64(box.high, vld1q_f64(corners + 3));
    vst1q_f64(box.high + 2, vld1q_lane_f64(corners + 5, none, 0));
}

// Four times sixteen bytes: each byte of a hit keeps its own bit of eight, and neighbours are added up.
inline std::uint64_t equalBytes(const std::uint8_t* bytes, std::uint8_t value) {
    constexpr std::uint8_t kBits[] = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    const uint8x16_t bits = vld1q_u8(kBits);
    const uint8x16_t wanted = vdupq_n_u8(value);
    const uint8x16x4_t all = vld1q_u8_x4(bytes);
    const uint8x16_t low = vpaddq_u8(vandq_u8(vceqq_u8(all.val[0], wanted), bits),
                                     vandq_u8(vceqq_u8(all.val[1], wanted), bits));
    const uint8x16_t high = vpaddq_u8(vandq_u8(vceqq_u8(all.val[2], wanted), bits),
                                      vandq_u8(vceqq_u8(all.val[3], wanted), bits));
    const uint8x16_t sums = vpaddq_u8(low, high);
    return vgetq_lane_u64(vreinterpretq_u64_u8(vpaddq_u8(sums, sums)), 0);
}

inline std::uint32_t bitCount(std::uint64_t word) {
    return vaddv_u8(vcnt_u8(vcreate_u8(word)));
}

#include <broadphase/simd/corners_scalar.inl>

#include <broadphase/simd/write_hits_scalar.inl>

#include <broadphase/simd/kernels.inl>

}  // namespace

extern const Kernels<float> kNeonKernelsFloat;
extern const Kernels<double> kNeonKernelsDouble;
const Kernels<float> kNeonKernelsFloat = kKernels<float>;
const Kernels<double> kNeonKernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
