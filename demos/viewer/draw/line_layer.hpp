// SPDX-License-Identifier: Zlib
#pragma once

// Lines of one width, with smooth edges.

#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/picture.hpp>
#include <demos/viewer/draw/quad_indices.hpp>
#include <demos/viewer/draw/shader_program.hpp>
#include <demos/viewer/draw/stream_buffer.hpp>

namespace hashphase::demos {

class LineLayer {
public:
    LineLayer();

    /// Last of all that is in the world.
    void draw(std::span<const DrawnLine> lines, QuadIndices& quads);

private:
    ShaderProgram program_;
    GlVertexArray vertexArray_;
    StreamBuffer vertices_;
};

}  // namespace hashphase::demos
