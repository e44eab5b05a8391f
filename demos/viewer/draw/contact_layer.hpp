// SPDX-License-Identifier: Zlib
#pragma once

// Contact shade: a soft dark spot on the ground below each sphere that is near it, which is what
// makes a sphere stand on the ground in the eye of who looks.

#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/ground_heights.hpp>
#include <demos/viewer/draw/quad_indices.hpp>
#include <demos/viewer/draw/shader_program.hpp>
#include <demos/viewer/draw/stream_buffer.hpp>
#include <demos/viewer/draw/view.hpp>

namespace hashphase::demos {

class ContactLayer {
public:
    ContactLayer();

    /// The ground that lies below from now on.
    void setGround(const GroundMesh& mesh) { heights_ = GroundHeights(mesh); }

    /// After the ground, before the spheres. Those of `least` pixels or less have no spot.
    void draw(std::span<const DrawnSphere> spheres, const View& view, float least,
              QuadIndices& quads);

private:
    /// A spot on the ground.
    struct Spot {
        Vector3<float> centre;
        float radius;
        Vector3<float> normal;
        float strength;  // 0 to 1
    };

    void findSpots(std::span<const DrawnSphere> spheres, const View& view, float least);

    ShaderProgram program_;
    GlVertexArray vertexArray_;
    StreamBuffer vertices_;
    GroundHeights heights_;
    std::vector<Spot> spots_;
};

}  // namespace hashphase::demos
