// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/box_layer.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace hashphase::demos {

namespace {

constexpr const char* kBoxVertexShader = R"glsl(
layout(location = 0) in vec3 middle;
layout(location = 1) in vec3 right;
layout(location = 2) in vec3 up;
layout(location = 3) in vec3 colourOfBox;

out vec2 onFace;       // from its middle, along both sides [m]
flat out vec2 widths;  // of its halves [m]
flat out vec4 tint;    // and the share of haze

void main() {
    vec2 corner = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) * 2.0 - 1.0;
    widths = vec2(length(right), length(up));
    onFace = corner * widths;
    vec3 normal = normalize(cross(right, up));
    tint = vec4(shade(colourOfBox, dot(normal, light.xyz)), haze(middle - eye.xyz));
    gl_Position = clipFromWorld * vec4(middle + corner.x * right + corner.y * up, 1.0);
}
)glsl";

// Edges are a pixel and a half wide, and fade where the face is too small for them.
constexpr const char* kBoxFragmentShader = R"glsl(
in vec2 onFace;
flat in vec2 widths;
flat in vec4 tint;

out vec4 colour;

void main() {
    vec2 pixel = max(fwidth(onFace), vec2(1e-9));
    vec2 fromEdge = (widths - abs(onFace)) / pixel;
    vec2 edges = clamp(2.0 - fromEdge, 0.0, 1.0) * clamp(widths / pixel * 0.2 - 0.5, 0.0, 1.0);
    vec3 lit = tint.rgb * (1.0 - 0.45 * max(edges.x, edges.y));
    colour = vec4(mix(lit, horizon.rgb, tint.a), 1.0);
}
)glsl";

}  // namespace

BoxLayer::BoxLayer() : program_("boxes", kBoxVertexShader, kBoxFragmentShader) {
    glBindVertexArray(vertexArray_.name());
    vertices_.bind();
    const std::size_t stride = sizeof(Face);
    describeVertexField({0, 3, GL_FLOAT, false, offsetof(Face, middle)}, stride);
    describeVertexField({1, 3, GL_FLOAT, false, offsetof(Face, right)}, stride);
    describeVertexField({2, 3, GL_FLOAT, false, offsetof(Face, up)}, stride);
    describeVertexField({3, 3, GL_UNSIGNED_BYTE, true, offsetof(Face, colour)}, stride);
}

// Those that look towards the eye: of the two across an axis the one on whose outer side the eye is.
void BoxLayer::addFaces(const DrawnBox& box, const View& view) {
    const Eigen::Matrix3f axes = Eigen::Quaternionf(box.orientation).toRotationMatrix();
    const Vector3<float> towardsEye = axes.transpose() * (view.eye - box.centre);
    const float nearness = 1 / std::max(view.depth(box.centre), 1e-6F);
    for (int axis = 0; axis < 3; ++axis) {
        const float halfExtent = box.halfExtents[axis];
        if (std::abs(towardsEye[axis]) > halfExtent) {
            const float side = towardsEye[axis] > 0 ? 1.0F : -1.0F;
            const int next = (axis + 1) % 3;
            const int last = (axis + 2) % 3;
            order_.add(nearness, static_cast<std::uint32_t>(faces_.size()));
            faces_.push_back({box.centre + side * halfExtent * axes.col(axis),
                              side * box.halfExtents[next] * axes.col(next),
                              box.halfExtents[last] * axes.col(last), box.colour});
        }
    }
}

void BoxLayer::draw(std::span<const DrawnBox> boxes, const View& view, QuadIndices& quads) {
    order_.clear();
    faces_.clear();
    for (const DrawnBox& box : boxes) {
        if (view.depth(box.centre) > -box.halfExtents.norm()) {
            addFaces(box, view);
        }
    }
    if (faces_.empty()) {
        return;
    }
    vertices_.fill<Face>(QuadIndices::kCorners * faces_.size(), [&](std::span<Face> vertices) {
        order_.write<Face>(faces_, vertices, QuadIndices::kCorners);
    });
    program_.use();
    glBindVertexArray(vertexArray_.name());
    quads.draw(0, faces_.size());
}

}  // namespace hashphase::demos
