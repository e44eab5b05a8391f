// SPDX-License-Identifier: Zlib
#pragma once

// A vertex and a fragment shader, compiled and linked.

#include <epoxy/gl.h>

#include <string_view>

namespace hashphase::demos {

class ShaderProgram {
public:
    /// Both sources come without #version, and after kFrameBlock (shading.hpp), which they may use.
    /// Throws DrawError, naming the program and quoting the compiler, where one is wrong.
    ShaderProgram(std::string_view name, std::string_view vertexSource,
                  std::string_view fragmentSource);
    ShaderProgram(const ShaderProgram&) = delete;
    ShaderProgram& operator=(const ShaderProgram&) = delete;
    ~ShaderProgram();

    void use() const { glUseProgram(name_); }

    /// Where the uniform is, or -1, which OpenGL ignores.
    [[nodiscard]] GLint uniform(const char* name) const {
        return glGetUniformLocation(name_, name);
    }

private:
    GLuint name_;
};

}  // namespace hashphase::demos
