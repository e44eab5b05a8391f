// SPDX-License-Identifier: Zlib
#pragma once

// Names of OpenGL objects that own what they name. All of it needs a current context.

#include <epoxy/gl.h>

#include <cstdint>
#include <utility>

namespace hashphase::demos {

enum class GlKind : std::uint8_t { buffer, framebuffer, renderbuffer, texture, vertexArray };

[[nodiscard]] GLuint createGlObject(GlKind kind);
void destroyGlObject(GlKind kind, GLuint name) noexcept;

/// Made with it, and gone with it.
template <GlKind kKind>
class GlObject {
public:
    GlObject() : name_(createGlObject(kKind)) {}
    GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlObject() { destroyGlObject(kKind, name_); }

    [[nodiscard]] GLuint name() const { return name_; }

private:
    GLuint name_;
};

using GlBuffer = GlObject<GlKind::buffer>;
using GlFramebuffer = GlObject<GlKind::framebuffer>;
using GlRenderbuffer = GlObject<GlKind::renderbuffer>;
using GlTexture = GlObject<GlKind::texture>;
using GlVertexArray = GlObject<GlKind::vertexArray>;

/// A field of a vertex, as a shader reads it: always as floats.
struct VertexField {
    GLuint location;
    GLint componentCount;
    GLenum type;
    bool isNormalised;  // integers stand for 0 to 1, or -1 to 1
    std::size_t offset;
};

/// For the bound vertex array and the bound GL_ARRAY_BUFFER.
void describeVertexField(const VertexField& field, std::size_t stride, GLuint divisor = 0);

}  // namespace hashphase::demos
