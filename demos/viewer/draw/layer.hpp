// SPDX-License-Identifier: Zlib
#pragma once

// What is drawn in one way, and how. All of it needs a current OpenGL context.

#include <demos/viewer/draw/image.hpp>

#include <broadphase/core/radix_sort.hpp>

#include <epoxy/gl.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hashphase::demos {

/// An object of OpenGL that is made with it, and gone with it.
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

/// Things by their distance, the farthest first: what has soft edges is painted over what lies behind it. Or, by
/// the inverse of it, the nearest first: what is hidden costs little. Depths that differ by less than one part in
/// 8,000 count as equal; of equal ones those of smaller indices come first. Keeps its memory from frame to frame.
class DepthOrder {
public:
    void clear() { keys_.clear(); }
    [[nodiscard]] std::size_t size() const { return keys_.size(); }

    /// Something so far in front of the eye; its `depth` is any positive number, its `index` the caller's.
    void add(float depth, std::uint32_t index) {
        // The bits of positive floats are in the order of the floats; inverted, the farthest come first.
        const std::uint64_t key = ~std::bit_cast<std::uint32_t>(depth) >> (32 - kBits);
        keys_.push_back(key << 32 | index);
    }

    /// Writes all that were added since clear(), in order and each so many times in a row; `to` has just
    /// room for them.
    template <class Thing>
    void write(std::span<const Thing> things, std::span<Thing> to, std::size_t copies) {
        detail::radixSort(keys_, 1U << kBits, scratch_);
        auto next = to.begin();
        for (const std::uint64_t key : keys_) {
            next = std::fill_n(next, copies, things[static_cast<std::uint32_t>(key)]);
        }
    }

private:
    static constexpr unsigned kBits = 22;  // of a depth, and enough for any index

    std::vector<std::uint64_t> keys_;  // depth << 32 | index
    std::vector<std::uint64_t> scratch_;
};

// --- Programs and layers -------------------------------------------------------------------------

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
