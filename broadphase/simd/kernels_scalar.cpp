// SPDX-License-Identifier: Zlib

// The kernels without vector instructions: the definition of what the others give.

#include <broadphase/geometry/quantise.hpp>
#include <broadphase/simd/kernel_types.hpp>

namespace hashphase::detail {
namespace {

template <class Scalar>
struct Pack {
    static constexpr std::uint32_t kWidth = 1;
    using Numbers = Scalar;
    static Numbers load(const Scalar* from) { return *from; }
    static void store(Scalar* to, Numbers a) { *to = a; }
    static Numbers broadcast(Scalar x) { return x; }
    static Numbers minus(Numbers a, Numbers b) { return a - b; }
    static Numbers plus(Numbers a, Numbers b) { return a + b; }
    static Numbers times(Numbers a, Numbers b) { return a * b; }
    static Numbers least(Numbers a, Numbers b) { return a < b ? a : b; }
    static Numbers greatest(Numbers a, Numbers b) { return a > b ? a : b; }
    static Numbers abs(Numbers a) { return a < 0 ? -a : a; }
    static bool lessEqual(Numbers a, Numbers b) { return a <= b; }
    static bool bitAnd(bool a, bool b) { return a & b; }
    static std::uint32_t bits(bool hit) { return hit ? 1 : 0; }
};

template <class Scalar>
using WidePack = Pack<Scalar>;

template <class Scalar>
std::uint32_t isApart(const PaddedBox<Scalar>& a, const PaddedBox<Scalar>& b) {
    return ((a.low[0] <= b.high[0]) & (b.low[0] <= a.high[0]) & (a.low[1] <= b.high[1]) &
            (b.low[1] <= a.high[1]) & (a.low[2] <= b.high[2]) & (b.low[2] <= a.high[2])) == 0;
}

template <class Scalar>
void padCorners(const Scalar* corners, PaddedBox<Scalar>& box) {
    box = {{corners[0], corners[1], corners[2], 0}, {corners[3], corners[4], corners[5], 0}};
}

inline std::uint64_t equalBytes(const std::uint8_t* bytes, std::uint8_t value) {
    std::uint64_t mask = 0;
    for (std::uint32_t k = 0; k < 64; ++k) {
        mask |= std::uint64_t{bytes[k] == value} << k;
    }
    return mask;
}

#include <broadphase/simd/bit_count_scalar.inl>
#include <broadphase/simd/corners_scalar.inl>
#include <broadphase/simd/write_hits_scalar.inl>

#include <broadphase/simd/kernels.inl>

}  // namespace

extern const Kernels<float> kScalarKernelsFloat;
extern const Kernels<double> kScalarKernelsDouble;
const Kernels<float> kScalarKernelsFloat = kKernels<float>;
const Kernels<double> kScalarKernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
