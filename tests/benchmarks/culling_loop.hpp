// SPDX-License-Identifier: Zlib
#pragma once

// What a program without a broadphase does: tests every box against every plane.

#include <cstddef>
#include <cstdint>

namespace hashphase::benchmarks {

/// The points p with slope . p + offset >= 0 are inside.
struct CullingPlane {
    float slope[3];
    float offset;
};

/// Sets marks[i] to 1 if box i, of `count` in columns of min x, y, z, max x, y, z, is not wholly outside of
/// any of six planes, or to 0.
void cullByLoop(const float* const* columns, std::size_t count, const CullingPlane* planes,
                std::uint8_t* marks);

/// The same, compiled for AVX-512 where there are such kernels.
void cullByWideLoop(const float* const* columns, std::size_t count, const CullingPlane* planes,
                    std::uint8_t* marks);

}  // namespace hashphase::benchmarks
