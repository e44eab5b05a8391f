// SPDX-License-Identifier: Zlib
#pragma once

// The ground, with the lines of a grid and a map of how full its cells are.

#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/ground_levels.hpp>
#include <demos/viewer/draw/ground_mesh.hpp>
#include <demos/viewer/draw/shader_program.hpp>
#include <demos/viewer/draw/shading.hpp>
#include <demos/viewer/draw/stream_buffer.hpp>

#include <array>
#include <optional>

namespace hashphase::demos {

class GroundLayer {
public:
    GroundLayer();

    /// Takes over what the picture's ground is, if it is another one than in the last call. Returns
    /// whether it was.
    bool update(const DrawnGround& ground);

    /// As of the last update().
    [[nodiscard]] const GroundMesh& mesh() const { return mesh_; }

    void draw(const Picture& picture, const View& view);

private:
    /// What is drawn on the ground; a program for each, so that nobody pays for what is not shown.
    struct Variant {
        explicit Variant(bool hasLines, bool hasHeat);
        ShaderProgram program;
    };

    void setUniforms(const ShaderProgram& program, const Picture& picture);
    void uploadHeat(const HeatMap& heatMap);

    std::array<Variant, 4> variants_;
    GlVertexArray vertexArray_;
    GlBuffer vertexBuffer_;
    StreamBuffer indexBuffer_;
    GlTexture loads_;
    GLsizei loadsWidth_ = 0;
    GLsizei loadsHeight_ = 0;
    GlTexture ramp_;
    GroundMesh mesh_;
    GroundLevels levels_;
    std::vector<std::uint32_t> indices_;  // what is drawn
    std::optional<std::uint64_t> version_;
};

}  // namespace hashphase::demos
