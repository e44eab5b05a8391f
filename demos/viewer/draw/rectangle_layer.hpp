// SPDX-License-Identifier: Zlib
#pragma once

// The rectangle that is being dragged, over everything else.

#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/picture.hpp>
#include <demos/viewer/draw/shader_program.hpp>

namespace hashphase::demos {

class RectangleLayer {
public:
    RectangleLayer();

    void draw(const DrawnRectangle& rectangle, Theme theme) const;

private:
    ShaderProgram program_;
    GlVertexArray vertices_;  // none: the shader makes them up
};

}  // namespace hashphase::demos
