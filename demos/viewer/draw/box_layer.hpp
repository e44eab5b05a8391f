// SPDX-License-Identifier: Zlib
#pragma once

// Boxes in any orientation, with edges that show.

#include <demos/viewer/draw/depth_order.hpp>
#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/quad_indices.hpp>
#include <demos/viewer/draw/shader_program.hpp>
#include <demos/viewer/draw/stream_buffer.hpp>
#include <demos/viewer/draw/view.hpp>

#include <span>
#include <vector>

namespace hashphase::demos {

class BoxLayer {
public:
    BoxLayer();

    /// The nearest first, so that most of what is hidden costs nothing.
    void draw(std::span<const DrawnBox> boxes, const View& view, QuadIndices& quads);

private:
    /// From its middle to the middles of two of its sides; right, up and outward are as x, y and z.
    struct Face {
        Vector3<float> middle;
        Vector3<float> right;
        Vector3<float> up;
        Colour colour;
    };

    void addFaces(const DrawnBox& box, const View& view);

    ShaderProgram program_;
    GlVertexArray vertexArray_;
    StreamBuffer vertices_;
    std::vector<Face> faces_;
    DepthOrder order_;
};

}  // namespace hashphase::demos
