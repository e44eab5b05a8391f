// SPDX-License-Identifier: Zlib
#pragma once

// What is drawn in one way, and how.

#include <demos/viewer/draw/depth_order.hpp>
#include <demos/viewer/draw/gl_objects.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// A vertex and a fragment shader, compiled and linked. Both are in the file shaders/<name>.glsl, one where
/// VERTEX is defined, one where it is not; before them come `definitions` and frame.glsl, whose block `Frame`
/// is bound to kFrameBinding.
class ShaderProgram {
public:
    /// Throws DrawError, naming the program and quoting the compiler, where a shader is wrong.
    explicit ShaderProgram(std::string_view name, std::string_view definitions = {});
    ShaderProgram(const ShaderProgram&) = delete;
    ShaderProgram& operator=(const ShaderProgram&) = delete;
    ~ShaderProgram() { glDeleteProgram(name_); }

    void use() const { glUseProgram(name_); }
    /// Where the uniform is, or -1, which OpenGL ignores.
    [[nodiscard]] GLint uniform(const char* name) const {
        return glGetUniformLocation(name_, name);
    }

    static constexpr GLuint kFrameBinding = 0;

private:
    GLuint name_ = 0;
};

/// The text of a file in shaders/, as it was when the program was built.
[[nodiscard]] std::string_view shaderText(std::string_view name);

/// For the bound vertex array and the bound GL_ARRAY_BUFFER: how many floats each field of a vertex has, from
/// location 0 on and without gaps; kColour stands for four bytes, which shaders read as 0 to 1.
inline constexpr int kColour = 0;
void describeVertex(const std::vector<int>& fields, std::size_t size, GLuint divisor = 0);

/// OpenGL's state while something is drawn.
struct DrawState {
    bool blends = false;
    bool writesDepth = true;
    GLenum depthFunction = GL_LESS;
    bool isSeenFromInside = false;  // its far sides alone
};
void setState(const DrawState& state);

/// `madeUp` has no vertices of its own: the shader makes them up from their number.
enum class LayerShape : std::uint8_t { madeUp, points, quads, cuboids };

struct LayerKind {
    std::string shader;
    std::string definitions = {};
    LayerShape shape = LayerShape::madeUp;
    DrawState state = {};
    std::vector<int> fields = {};  // see describeVertex()
    std::size_t size = 0;          // of a vertex [bytes]
};

class Layer {
public:
    explicit Layer(LayerKind kind);

    /// All things, in this order, or those that `order` names, in its order.
    template <class Thing>
    void draw(std::span<const Thing> things) {
        fillAndDraw<Thing>(things.size(), [&](std::span<Thing> vertices) {
            auto next = vertices.begin();
            for (const Thing& thing : things) {
                next = std::fill_n(next, copies(), thing);
            }
        });
    }
    template <class Thing>
    void draw(std::span<const Thing> things, DepthOrder& order) {
        fillAndDraw<Thing>(order.size(), [&](std::span<Thing> vertices) {
            order.write(things, vertices, copies());
        });
    }

    /// Draws some of the things that were drawn last once more, or the first time, where `count` vertices are
    /// made up.
    void drawAgain(const DrawState& state, std::size_t first, std::size_t count);

    /// With the program in use.
    [[nodiscard]] GLint uniform(const char* name) const;

private:
    // Four copies of a quad's vertex, told apart by gl_VertexID, are drawn faster than an instance for each:
    // software rendering begins anew for each instance.
    static constexpr std::size_t kCorners = 4;

    [[nodiscard]] std::size_t copies() const {
        return kind_.shape == LayerShape::quads ? kCorners : 1;
    }
    template <class Thing, class Write>
    void fillAndDraw(std::size_t count, const Write& write) {
        if (count > 0) {
            vertices_.fill<Thing>(copies() * count, write);
            drawAgain(kind_.state, 0, count);
        }
    }
    void bindQuads(std::size_t count);

    LayerKind kind_;
    ShaderProgram program_;
    GlVertexArray vertexArray_;
    StreamBuffer vertices_{GL_ARRAY_BUFFER};
    GlBuffer quadIndices_;
    std::size_t quadCapacity_ = 0;
};

}  // namespace hashphase::demos
