// SPDX-License-Identifier: Zlib
#pragma once

// The sky: a gradient by the direction of view, wherever nothing else is.

#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/shader_program.hpp>

namespace hashphase::demos {

class SkyLayer {
public:
    SkyLayer();

    /// After what is solid: only what still is as far away as can be is painted.
    void draw() const;

private:
    ShaderProgram program_;
    GlVertexArray vertices_;  // none: the shader makes them up
};

}  // namespace hashphase::demos
