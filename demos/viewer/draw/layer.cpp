// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/layer.hpp>

#include <array>
#include <utility>

namespace hashphase::demos {

namespace {

/// What the compiler or the linker said.
template <typename GetParameter, typename GetLog>
std::string infoLog(GLuint object, const GetParameter& getParameter, const GetLog& getLog) {
    GLint length = 0;
    getParameter(object, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    getLog(object, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

/// Compiles a shader into the program, which takes it along when it goes.
void attach(GLuint program, GLenum kind, std::string_view name, std::string_view definitions) {
    const bool isVertex = kind == GL_VERTEX_SHADER;
    const std::array<std::string_view, 4> parts{
        isVertex ? "#version 330 core\n#define VERTEX\n" : "#version 330 core\n", definitions,
        shaderText("frame"), shaderText(name)};
    std::array<const GLchar*, parts.size()> texts{};
    std::array<GLint, parts.size()> lengths{};
    for (std::size_t i = 0; i < parts.size(); ++i) {
        texts[i] = parts[i].data();
        lengths[i] = static_cast<GLint>(parts[i].size());
    }
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, static_cast<GLsizei>(parts.size()), texts.data(), lengths.data());
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);  // when the program no longer has it
    GLint isCompiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &isCompiled);
    if (isCompiled == GL_FALSE) {
        throw DrawError("The " + std::string(isVertex ? "vertex" : "fragment") + " shader of " +
                        std::string(name) +
                        " does not compile: " + infoLog(shader, glGetShaderiv, glGetShaderInfoLog));
    }
}

void link(GLuint program, std::string_view name) {
    glLinkProgram(program);
    GLint isLinked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &isLinked);
    if (isLinked == GL_FALSE) {
        throw DrawError("The shaders of " + std::string(name) +
                        " do not link: " + infoLog(program, glGetProgramiv, glGetProgramInfoLog));
    }
}

constexpr std::array<std::uint32_t, 6> kTrianglesOfQuad{0, 1, 2, 2, 1, 3};
constexpr GLsizei kVerticesOfCuboid = 36;

void enable(GLenum capability, bool isOn) {
    (isOn ? glEnable : glDisable)(capability);
}

}  // namespace

// --- Programs ------------------------------------------------------------------------------------

ShaderProgram::ShaderProgram(std::string_view name, std::string_view definitions)
    : name_(glCreateProgram()) {
    try {
        attach(name_, GL_VERTEX_SHADER, name, definitions);
        attach(name_, GL_FRAGMENT_SHADER, name, definitions);
        link(name_, name);
    } catch (const DrawError&) {
        glDeleteProgram(name_);
        throw;
    }
    const GLuint block = glGetUniformBlockIndex(name_, "Frame");
    if (block != GL_INVALID_INDEX) {
        glUniformBlockBinding(name_, block, kFrameBinding);
    }
}

void describeVertex(const std::vector<int>& fields, std::size_t size, GLuint divisor) {
    std::size_t offset = 0;
    for (GLuint location = 0; location < fields.size(); ++location) {
        const bool isColour = fields[location] == kColour;
        glEnableVertexAttribArray(location);
        glVertexAttribPointer(location, isColour ? 4 : fields[location],
                              isColour ? GL_UNSIGNED_BYTE : GL_FLOAT, isColour ? GL_TRUE : GL_FALSE,
                              static_cast<GLsizei>(size), reinterpret_cast<const void*>(offset));
        glVertexAttribDivisor(location, divisor);
        offset += isColour ? 4 : sizeof(float) * static_cast<std::size_t>(fields[location]);
    }
}

void setState(const DrawState& state) {
    enable(GL_BLEND, state.blends);
    enable(GL_CULL_FACE, state.isSeenFromInside);
    glCullFace(GL_FRONT);
    glDepthMask(state.writesDepth ? GL_TRUE : GL_FALSE);
    glDepthFunc(state.depthFunction);
}

// --- Layers --------------------------------------------------------------------------------------

Layer::Layer(LayerKind kind) : kind_(std::move(kind)), program_(kind_.shader, kind_.definitions) {
    glBindVertexArray(vertexArray_.name());
    vertices_.bind();
    describeVertex(kind_.fields, kind_.size, kind_.shape == LayerShape::cuboids ? 1 : 0);
}

GLint Layer::uniform(const char* name) const {
    program_.use();
    return program_.uniform(name);
}

void Layer::drawAgain(const DrawState& state, std::size_t first, std::size_t count) {
    program_.use();
    setState(state);
    glBindVertexArray(vertexArray_.name());
    const auto begin = static_cast<GLint>(first);
    const auto size = static_cast<GLsizei>(count);
    switch (kind_.shape) {
        case LayerShape::madeUp:
            glDrawArrays(GL_TRIANGLES, begin, size);
            break;
        case LayerShape::points:
            glEnable(GL_PROGRAM_POINT_SIZE);
            glDrawArrays(GL_POINTS, begin, size);
            break;
        case LayerShape::quads:
            bindQuads(first + count);
            glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count * kTrianglesOfQuad.size()),
                           GL_UNSIGNED_INT,
                           reinterpret_cast<const void*>(first * sizeof(kTrianglesOfQuad)));
            break;
        case LayerShape::cuboids:
            glDrawArraysInstanced(GL_TRIANGLES, 0, kVerticesOfCuboid, size);
            break;
    }
}

void Layer::bindQuads(std::size_t count) {
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, quadIndices_.name());
    if (count <= quadCapacity_) {
        return;
    }
    quadCapacity_ = count + count / 2;
    std::vector<std::uint32_t> indices;
    indices.reserve(quadCapacity_ * kTrianglesOfQuad.size());
    for (std::uint32_t quad = 0; quad < quadCapacity_; ++quad) {
        for (const std::uint32_t corner : kTrianglesOfQuad) {
            indices.push_back(static_cast<std::uint32_t>(kCorners) * quad + corner);
        }
    }
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
                 GL_STATIC_DRAW);
}

}  // namespace hashphase::demos
