// SPDX-License-Identifier: Zlib
#pragma once

// Vertices, or indices, that are others in each frame.

#include <demos/viewer/draw/gl_objects.hpp>

#include <cstddef>
#include <span>

namespace hashphase::demos {

/// Grows to the largest frame seen, and from then on allocates nothing. A frame's vertices are
/// written into memory that no earlier frame is still drawn from.
class StreamBuffer {
public:
    void bind(GLenum target = GL_ARRAY_BUFFER) const { glBindBuffer(target, buffer_.name()); }

    /// Has `write` fill `count` (at least one) vertices: write(std::span<Vertex>), which must not
    /// read them.
    template <typename Vertex, typename Write>
    void fill(std::size_t count, const Write& write) {
        write(std::span(static_cast<Vertex*>(map(count * sizeof(Vertex))), count));
        unmap();
    }

private:
    [[nodiscard]] void* map(std::size_t byteCount);
    void unmap() const;

    GlBuffer buffer_;
    std::size_t capacity_ = 0;  // [bytes]
};

}  // namespace hashphase::demos
