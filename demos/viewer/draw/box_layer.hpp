// SPDX-License-Identifier: Zlib
#pragma once

// Boxes in any orientation, with edges that show.

#include <demos/viewer/draw/depth_order.hpp>
#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/shader_program.hpp>
#include <demos/viewer/draw/stream_buffer.hpp>
#include <demos/viewer/draw/view.hpp>

namespace hashphase::demos {

class BoxLayer {
public:
    BoxLayer();

    /// The farthest first, because boxes may be translucent.
    void draw(std::span<const DrawnBox> boxes, const View& view);

private:
    ShaderProgram program_;
    GlVertexArray vertexArray_;
    GlBuffer corners_;
    StreamBuffer instances_;
    DepthOrder order_;
};

}  // namespace hashphase::demos
