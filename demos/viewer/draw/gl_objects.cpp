// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/gl_objects.hpp>

namespace hashphase::demos {

GLuint createGlObject(GlKind kind) {
    GLuint name = 0;
    switch (kind) {
        case GlKind::buffer:
            glGenBuffers(1, &name);
            break;
        case GlKind::framebuffer:
            glGenFramebuffers(1, &name);
            break;
        case GlKind::renderbuffer:
            glGenRenderbuffers(1, &name);
            break;
        case GlKind::texture:
            glGenTextures(1, &name);
            break;
        case GlKind::vertexArray:
            glGenVertexArrays(1, &name);
            break;
    }
    return name;
}

void destroyGlObject(GlKind kind, GLuint name) noexcept {
    if (name == 0) {
        return;
    }
    switch (kind) {
        case GlKind::buffer:
            glDeleteBuffers(1, &name);
            break;
        case GlKind::framebuffer:
            glDeleteFramebuffers(1, &name);
            break;
        case GlKind::renderbuffer:
            glDeleteRenderbuffers(1, &name);
            break;
        case GlKind::texture:
            glDeleteTextures(1, &name);
            break;
        case GlKind::vertexArray:
            glDeleteVertexArrays(1, &name);
            break;
    }
}

void describeVertexField(const VertexField& field, std::size_t stride, GLuint divisor) {
    glEnableVertexAttribArray(field.location);
    glVertexAttribPointer(field.location, field.componentCount, field.type,
                          field.isNormalised ? GL_TRUE : GL_FALSE, static_cast<GLsizei>(stride),
                          reinterpret_cast<const void*>(field.offset));
    glVertexAttribDivisor(field.location, divisor);
}

}  // namespace hashphase::demos
