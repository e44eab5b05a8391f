// SPDX-License-Identifier: Zlib

// The loop of culling_loop.hpp, of which compilers make vector instructions. It calls no other function:
// what a file with more instructions emits must serve no other one.

#include <tests/benchmarks/culling_loop.hpp>

namespace hashphase::benchmarks {

// A thousand boxes at a time, so that they stay in the cache.
void HASHPHASE_CULLING_LOOP(const float* const* columns, std::size_t count,
                            const CullingPlane* planes, std::uint8_t* marks) {
    constexpr std::size_t atOnce = 1024;
    for (std::size_t begin = 0; begin < count; begin += atOnce) {
        const std::size_t end = count - begin < atOnce ? count : begin + atOnce;
        for (std::size_t i = begin; i < end; ++i) {
            marks[i] = 1;
        }
        for (const CullingPlane* plane = planes; plane != planes + 6; ++plane) {
            const CullingPlane all = *plane;
            const float* const x = columns[all.slope[0] > 0 ? 3 : 0];
            const float* const y = columns[all.slope[1] > 0 ? 4 : 1];
            const float* const z = columns[all.slope[2] > 0 ? 5 : 2];
            for (std::size_t i = begin; i < end; ++i) {
                const float sum =
                    all.slope[0] * x[i] + all.slope[1] * y[i] + all.slope[2] * z[i] + all.offset;
                marks[i] = static_cast<std::uint8_t>(marks[i] & (sum >= 0 ? 1 : 0));
            }
        }
    }
}

}  // namespace hashphase::benchmarks
