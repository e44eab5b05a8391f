// SPDX-License-Identifier: Zlib
#pragma once

// Quads of four vertices each, drawn as two triangles. Four copies of what a sphere is, told apart
// by gl_VertexID, are drawn faster than an instance for each: software rendering begins anew for
// each instance.

#include <demos/viewer/draw/gl_objects.hpp>

#include <cstddef>

namespace hashphase::demos {

class QuadIndices {
public:
    static constexpr std::size_t kCorners = 4;  // of a quad

    /// Draws quads `first` to `first + count` of the bound vertex array.
    void draw(std::size_t first, std::size_t count);

private:
    void grow(std::size_t quadCount);

    GlBuffer buffer_;
    std::size_t capacity_ = 0;  // [quads]
};

}  // namespace hashphase::demos
