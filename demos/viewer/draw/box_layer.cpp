// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/box_layer.hpp>

#include <array>
#include <cstddef>

namespace hashphase::demos {

namespace {

constexpr const char* kVertexShader = R"glsl(
layout(location = 0) in vec3 corner;
layout(location = 1) in vec3 face;
layout(location = 2) in vec3 centre;
layout(location = 3) in vec3 halfExtents;
layout(location = 4) in vec4 orientation;
layout(location = 5) in vec4 colourOfBox;

out vec3 onFace;       // the coordinates across the face, and 0
flat out vec3 widths;  // of the face, where onFace is not 0
flat out vec4 tint;
flat out float hazeOfBox;

vec3 rotate(vec3 v) {
    return v + 2.0 * cross(orientation.xyz, cross(orientation.xyz, v) + orientation.w * v);
}

void main() {
    vec3 place = centre + rotate(corner * halfExtents);
    onFace = (corner - face) * halfExtents;
    widths = (vec3(1.0) - abs(face)) * halfExtents;
    tint = vec4(shade(colourOfBox.rgb, dot(rotate(face), light.xyz)), colourOfBox.a);
    hazeOfBox = haze(centre - eye.xyz);
    gl_Position = clipFromWorld * vec4(place, 1.0);
}
)glsl";

// Edges are a pixel and a half wide, and fade where the box is too small for them.
constexpr const char* kFragmentShader = R"glsl(
in vec3 onFace;
flat in vec3 widths;
flat in vec4 tint;
flat in float hazeOfBox;

out vec4 colour;

void main() {
    vec3 pixel = max(fwidth(onFace), vec3(1e-9));
    vec3 fromEdge = (widths - abs(onFace)) / pixel;
    vec3 size = widths / pixel;
    float edge = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        if (widths[axis] > 0.0) {
            edge = max(edge, clamp(2.0 - fromEdge[axis], 0.0, 1.0) *
                             clamp(size[axis] * 0.2 - 0.5, 0.0, 1.0));
        }
    }
    vec3 lit = mix(tint.rgb, tint.rgb * 0.55, edge);
    colour = vec4(mix(lit, horizon.rgb, hazeOfBox), mix(tint.a, 1.0, 0.5 * edge * tint.a));
}
)glsl";

struct CubeVertex {
    Vector3<float> corner;
    Vector3<float> face;
};

constexpr GLsizei kVertexCount = 36;

/// The twelve triangles of a cube from -1 to 1, each counterclockwise seen from outside.
std::array<CubeVertex, kVertexCount> cube() {
    constexpr std::array<std::array<float, 2>, 6> kPlaces{
        {{-1, -1}, {1, -1}, {-1, 1}, {-1, 1}, {1, -1}, {1, 1}}};
    std::array<CubeVertex, kVertexCount> vertices;
    auto next = vertices.begin();
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) {
            Vector3<float> face = Vector3<float>::Zero();
            face[axis] = side;
            for (const auto& place : kPlaces) {
                Vector3<float> corner = face;
                corner[(axis + 1) % 3] = side * place[0];
                corner[(axis + 2) % 3] = place[1];
                *next++ = {corner, face};
            }
        }
    }
    return vertices;
}

}  // namespace

BoxLayer::BoxLayer() : program_("boxes", kVertexShader, kFragmentShader) {
    const auto vertices = cube();
    glBindVertexArray(vertexArray_.name());
    glBindBuffer(GL_ARRAY_BUFFER, corners_.name());
    glBufferData(GL_ARRAY_BUFFER, sizeof(vertices), vertices.data(), GL_STATIC_DRAW);
    describeVertexField({0, 3, GL_FLOAT, false, offsetof(CubeVertex, corner)}, sizeof(CubeVertex));
    describeVertexField({1, 3, GL_FLOAT, false, offsetof(CubeVertex, face)}, sizeof(CubeVertex));
    instances_.bind();
    const std::size_t stride = sizeof(DrawnBox);
    describeVertexField({2, 3, GL_FLOAT, false, offsetof(DrawnBox, centre)}, stride, 1);
    describeVertexField({3, 3, GL_FLOAT, false, offsetof(DrawnBox, halfExtents)}, stride, 1);
    describeVertexField({4, 4, GL_FLOAT, false, offsetof(DrawnBox, orientation)}, stride, 1);
    describeVertexField({5, 4, GL_UNSIGNED_BYTE, true, offsetof(DrawnBox, colour)}, stride, 1);
}

void BoxLayer::draw(std::span<const DrawnBox> boxes, const View& view) {
    order_.clear();
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        const float depth = view.depth(boxes[i].centre);
        if (depth > -boxes[i].halfExtents.norm()) {
            order_.add(std::max(depth, 0.0F), i);
        }
    }
    if (order_.size() == 0) {
        return;
    }
    instances_.fill<DrawnBox>(
        order_.size(), [&](std::span<DrawnBox> instances) { order_.write(boxes, instances); });
    program_.use();
    glBindVertexArray(vertexArray_.name());
    glEnable(GL_BLEND);
    glEnable(GL_CULL_FACE);
    glDrawArraysInstanced(GL_TRIANGLES, 0, kVertexCount, static_cast<GLsizei>(order_.size()));
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
}

}  // namespace hashphase::demos
