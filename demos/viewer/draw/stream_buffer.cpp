// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/stream_buffer.hpp>

#include <demos/viewer/draw/draw_error.hpp>

namespace hashphase::demos {

void* StreamBuffer::map(std::size_t byteCount) {
    bind();
    if (byteCount > capacity_) {
        capacity_ = byteCount + byteCount / 2;
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(capacity_), nullptr, GL_STREAM_DRAW);
    }
    void* memory = glMapBufferRange(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(byteCount),
                                    GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    if (memory == nullptr) {
        throw DrawError("OpenGL has no memory for the vertices of a frame.");
    }
    return memory;
}

void StreamBuffer::unmap() const {
    bind();
    glUnmapBuffer(GL_ARRAY_BUFFER);
}

}  // namespace hashphase::demos
