// SPDX-License-Identifier: Zlib
#pragma once

// Capsules: a box around each, on which the capsule is found by a ray through each pixel.

#include <demos/viewer/draw/depth_order.hpp>
#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/shader_program.hpp>
#include <demos/viewer/draw/stream_buffer.hpp>
#include <demos/viewer/draw/view.hpp>

namespace hashphase::demos {

class CapsuleLayer {
public:
    CapsuleLayer();

    /// After what is solid. The edges are smooth, and so the farthest are painted first.
    void draw(std::span<const DrawnCapsule> capsules, const View& view);

private:
    ShaderProgram program_;
    GlVertexArray vertexArray_;
    StreamBuffer instances_;
    DepthOrder order_;
};

}  // namespace hashphase::demos
