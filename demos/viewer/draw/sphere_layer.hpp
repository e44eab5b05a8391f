// SPDX-License-Identifier: Zlib
#pragma once

// Spheres: a quad or a point each, on which the sphere is found by a ray through each pixel.

#include <demos/viewer/draw/depth_order.hpp>
#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/quad_indices.hpp>
#include <demos/viewer/draw/shader_program.hpp>
#include <demos/viewer/draw/stream_buffer.hpp>
#include <demos/viewer/draw/view.hpp>

#include <string>
#include <string_view>

namespace hashphase::demos {

class SphereLayer {
public:
    SphereLayer();

    /// After all that is solid. The edges are smooth, and so the farthest are painted first; but
    /// what is small on the screen before what is not. None is smaller than `leastRadius` [pixels].
    void draw(std::span<const DrawnSphere> spheres, const View& view, float leastRadius,
              QuadIndices& indices);

private:
    /// Spheres that are drawn in one way.
    struct Batch {
        Batch(std::string_view name, const std::string& vertexShader,
              const std::string& fragmentShader);

        /// Makes all that `order` names ready to be drawn, with so many vertices each.
        void fill(std::span<const DrawnSphere> spheres, std::size_t copies);

        ShaderProgram program;
        GlVertexArray vertexArray;
        StreamBuffer vertices;
        DepthOrder order;
    };

    /// How to draw a sphere of that radius in `pixels`.
    Batch& batchFor(const Vector3<float>& fromEye, float depth, float pixels, const View& view);
    void sort(std::span<const DrawnSphere> spheres, const View& view, float leastRadius);

    Batch dots_;
    Batch points_;
    Batch quads_;
};

}  // namespace hashphase::demos
