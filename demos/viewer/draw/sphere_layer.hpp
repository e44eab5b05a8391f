// SPDX-License-Identifier: Zlib
#pragma once

// Spheres: a quad each, on which the sphere is found by a ray through each pixel.

#include <demos/viewer/draw/depth_order.hpp>
#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/quad_indices.hpp>
#include <demos/viewer/draw/shader_program.hpp>
#include <demos/viewer/draw/stream_buffer.hpp>
#include <demos/viewer/draw/view.hpp>

namespace hashphase::demos {

class SphereLayer {
public:
    SphereLayer();

    /// After all that is solid. The edges are smooth, and so the farthest are painted first.
    void draw(std::span<const DrawnSphere> spheres, const View& view, QuadIndices& quads);

private:
    ShaderProgram program_;
    GlVertexArray vertexArray_;
    StreamBuffer vertices_;
    DepthOrder order_;
};

}  // namespace hashphase::demos
