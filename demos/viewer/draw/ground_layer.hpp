// SPDX-License-Identifier: Zlib
#pragma once

// The ground, with the lines of a grid and a map of how full its cells are.

#include <demos/viewer/draw/ground.hpp>
#include <demos/viewer/draw/layer.hpp>

#include <array>
#include <optional>

namespace hashphase::demos {

class GroundLayer {
public:
    GroundLayer();

    /// Takes over what the picture's ground is, if it is another one than in the last call.
    void update(const DrawnGround& ground);

    /// As of the last update().
    [[nodiscard]] const Ground& ground() const { return ground_; }

    void draw(const Picture& picture, const View& view);

private:
    void setUniforms(const ShaderProgram& program, const Picture& picture);
    void uploadHeat(const HeatMap& heatMap);

    // With lines (1) or heat (2) or both, so that nobody pays for what is not shown.
    std::array<ShaderProgram, 4> programs_;
    GlVertexArray vertexArray_;
    GlBuffer vertexBuffer_;
    StreamBuffer indexBuffer_{GL_ELEMENT_ARRAY_BUFFER};
    GlTexture loads_;
    GlTexture ramp_;
    Ground ground_;
    std::vector<std::uint32_t> indices_;  // what is drawn
    std::optional<std::uint64_t> version_;
    std::size_t cornerCount_ = 0;  // of that version
};

}  // namespace hashphase::demos
