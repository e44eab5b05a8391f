// SPDX-License-Identifier: Zlib

// The kernels without vector instructions: the definition of what the others give.

#include <broadphase/detail/kernel_types.hpp>
#include <broadphase/detail/quantise.hpp>

namespace hashphase::detail {
namespace {

template <class Scalar>
class Lanes {
public:
    Lanes(const Scalar* const* columns, std::uint32_t number)
        : low_{columns[0][number], columns[1][number], columns[2][number]},
          high_{columns[3][number], columns[4][number], columns[5][number]} {}

    [[nodiscard]] std::uint32_t overlapMask(const Scalar* const* columns,
                                            std::uint32_t first) const {
        std::uint32_t mask = 0;
        for (std::uint32_t k = 0; k < 8; ++k) {
            const std::uint32_t i = first + k;
            const auto isHit = static_cast<std::uint32_t>(
                (columns[0][i] <= high_[0]) & (low_[0] <= columns[3][i]) &
                (columns[1][i] <= high_[1]) & (low_[1] <= columns[4][i]) &
                (columns[2][i] <= high_[2]) & (low_[2] <= columns[5][i]));
            mask |= isHit << k;
        }
        return mask;
    }

    static constexpr std::uint32_t kLongWidth = 8;

    [[nodiscard]] std::uint32_t longOverlapMask(const Scalar* const* columns,
                                                std::uint32_t first) const {
        return overlapMask(columns, first);
    }

    static bool isApart(const PaddedBox<Scalar>& a, const PaddedBox<Scalar>& b) {
        return ((a.low[0] <= b.high[0]) & (b.low[0] <= a.high[0]) & (a.low[1] <= b.high[1]) &
                (b.low[1] <= a.high[1]) & (a.low[2] <= b.high[2]) & (b.low[2] <= a.high[2])) == 0;
    }

private:
    Scalar low_[3];
    Scalar high_[3];
};

#include <broadphase/detail/corners_scalar.inl>
#include <broadphase/detail/kernels.inl>

}  // namespace

extern const Kernels<float> kScalarKernelsFloat;
extern const Kernels<double> kScalarKernelsDouble;
const Kernels<float> kScalarKernelsFloat = kKernels<float>;
const Kernels<double> kScalarKernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
