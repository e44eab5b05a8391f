// SPDX-License-Identifier: Zlib
#pragma once

// OpenGL objects that own what they name. All of it needs a current context.

#include <demos/viewer/draw/image.hpp>

#include <epoxy/gl.h>

#include <cstddef>
#include <span>
#include <utility>

namespace hashphase::demos {

/// Made with it, and gone with it.
template <auto* kMake, auto* kDelete>
class GlObject {
public:
    GlObject() { (*kMake)(1, &name_); }
    GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlObject() { (*kDelete)(1, &name_); }

    [[nodiscard]] GLuint name() const { return name_; }

private:
    GLuint name_ = 0;
};

using GlBuffer = GlObject<&glGenBuffers, &glDeleteBuffers>;
using GlFramebuffer = GlObject<&glGenFramebuffers, &glDeleteFramebuffers>;
using GlRenderbuffer = GlObject<&glGenRenderbuffers, &glDeleteRenderbuffers>;
using GlTexture = GlObject<&glGenTextures, &glDeleteTextures>;
using GlVertexArray = GlObject<&glGenVertexArrays, &glDeleteVertexArrays>;

/// Vertices, or indices, that are others in each frame. Grows to the largest frame seen, and from then on
/// allocates nothing. A frame's are written into memory that no earlier frame is still drawn from.
class StreamBuffer {
public:
    explicit StreamBuffer(GLenum target) : target_(target) {}

    void bind() const { glBindBuffer(target_, buffer_.name()); }

    /// Has `write` fill `count` (at least one) of them: write(std::span<Item>), which must not read them.
    template <typename Item, typename Write>
    void fill(std::size_t count, const Write& write) {
        bind();
        const std::size_t bytes = count * sizeof(Item);
        if (bytes > capacity_) {
            capacity_ = bytes + bytes / 2;
            glBufferData(target_, static_cast<GLsizeiptr>(capacity_), nullptr, GL_STREAM_DRAW);
        }
        void* memory = glMapBufferRange(target_, 0, static_cast<GLsizeiptr>(bytes),
                                        GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
        if (memory == nullptr) {
            throw DrawError("OpenGL has no memory for the vertices of a frame.");
        }
        write(std::span(static_cast<Item*>(memory), count));
        glUnmapBuffer(target_);
    }

private:
    GLenum target_;
    GlBuffer buffer_;
    std::size_t capacity_ = 0;  // [bytes]
};

}  // namespace hashphase::demos
