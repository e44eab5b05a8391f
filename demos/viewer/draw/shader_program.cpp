// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/shader_program.hpp>

#include <demos/viewer/draw/draw_error.hpp>
#include <demos/viewer/draw/shading.hpp>

#include <array>
#include <string>

namespace hashphase::demos {

namespace {

constexpr std::string_view kVersion = "#version 330 core\n";

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

/// Takes the shader along with it.
class Shader {
public:
    Shader(std::string_view name, GLenum kind, std::string_view source)
        : name_(glCreateShader(kind)) {
        const std::array parts{kVersion, kFrameBlock, source};
        std::array<const GLchar*, 3> texts{};
        std::array<GLint, 3> lengths{};
        for (std::size_t i = 0; i < parts.size(); ++i) {
            texts[i] = parts[i].data();
            lengths[i] = static_cast<GLint>(parts[i].size());
        }
        glShaderSource(name_, static_cast<GLsizei>(parts.size()), texts.data(), lengths.data());
        glCompileShader(name_);
        GLint isCompiled = GL_FALSE;
        glGetShaderiv(name_, GL_COMPILE_STATUS, &isCompiled);
        if (isCompiled == GL_FALSE) {
            const std::string log = infoLog(name_, glGetShaderiv, glGetShaderInfoLog);
            glDeleteShader(name_);
            const char* stage = kind == GL_VERTEX_SHADER ? "vertex" : "fragment";
            throw DrawError("The " + std::string(stage) + " shader of " + std::string(name) +
                            " does not compile: " + log);
        }
    }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    ~Shader() { glDeleteShader(name_); }

    [[nodiscard]] GLuint name() const { return name_; }

private:
    GLuint name_;
};

}  // namespace

ShaderProgram::ShaderProgram(std::string_view name, std::string_view vertexSource,
                             std::string_view fragmentSource)
    : name_(0) {
    const Shader vertexShader(name, GL_VERTEX_SHADER, vertexSource);
    const Shader fragmentShader(name, GL_FRAGMENT_SHADER, fragmentSource);
    name_ = glCreateProgram();
    glAttachShader(name_, vertexShader.name());
    glAttachShader(name_, fragmentShader.name());
    glLinkProgram(name_);
    GLint isLinked = GL_FALSE;
    glGetProgramiv(name_, GL_LINK_STATUS, &isLinked);
    if (isLinked == GL_FALSE) {
        const std::string log = infoLog(name_, glGetProgramiv, glGetProgramInfoLog);
        glDeleteProgram(name_);
        throw DrawError("The shaders of " + std::string(name) + " do not link: " + log);
    }
    const GLuint block = glGetUniformBlockIndex(name_, "Frame");
    if (block != GL_INVALID_INDEX) {
        glUniformBlockBinding(name_, block, kFrameBinding);
    }
}

ShaderProgram::~ShaderProgram() {
    glDeleteProgram(name_);
}

}  // namespace hashphase::demos
