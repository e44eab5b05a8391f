// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/sphere_layer.hpp>

#include <algorithm>
#include <cstddef>

namespace hashphase::demos {

namespace {

// From the eye, a sphere of radius 1 at distance D = 1 / s is the cone around the circle in which rays
// touch it: radius c = sqrt(1 - s^2), s nearer to the eye than the centre. The quad lies in the plane of
// that circle, so its edge is exactly the sphere's in any perspective: |offset| = 1 there.
//
// The ray through c * offset on that plane meets the sphere at D / (D + h) of the way to the plane, where
// h = sqrt(1 - |offset|^2). With the axis towards the eye, the normal there is
// (c * offset, s + h) / (1 + s * h), and the depth is what the plane's is, and s * h times the eye's
// depth before the division by w, divided by the plane's w.
constexpr const char* kVertexShader = R"glsl(
layout(location = 0) in vec4 sphere;
layout(location = 1) in vec4 colourOfSphere;

out vec2 offset;
flat out vec4 tint;
flat out vec4 lightInQuad;  // towards the light, in the axes of the quad; and the share of haze
flat out vec4 shape;        // s, c, the radius on the screen [pixels], the eye's depth times s

void main() {
    vec3 fromEye = sphere.xyz - eye.xyz;
    float depth = dot(fromEye, cameraForward.xyz);
    float radius = max(sphere.w, screen.w * depth / screen.z);
    float distance = length(fromEye);
    vec3 axis = fromEye / distance;
    vec3 right = normalize(cross(axis, cameraUp.xyz));
    vec3 up = cross(right, axis);
    float s = radius / distance;
    float c = sqrt(1.0 - s * s);
    float pixels = screen.z * radius / depth;

    vec2 corner = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) * 2.0 - 1.0;
    offset = corner * (1.0 + 0.5 / pixels);
    vec3 place = eye.xyz + axis * (distance - radius * s) +
                 radius * c * (right * offset.x + up * offset.y);
    gl_Position = clipFromWorld * vec4(place, 1.0);
    tint = colourOfSphere;
    lightInQuad = vec4(dot(right, light.xyz), dot(up, light.xyz), -dot(axis, light.xyz),
                       haze(fromEye));
    shape = vec4(s, c, pixels, eye.w * s);
}
)glsl";

constexpr const char* kFragmentShader = R"glsl(
in vec2 offset;
flat in vec4 tint;
flat in vec4 lightInQuad;
flat in vec4 shape;

out vec4 colour;

void main() {
    float squared = dot(offset, offset);
    float coverage = min((1.0 - sqrt(squared)) * shape.z + 0.5, 1.0);
    if (coverage <= 0.0) {
        discard;
    }
    float h = sqrt(max(1.0 - squared, 0.0));
    float s = shape.x;
    vec3 normal = vec3(shape.y * offset, s + h) / (1.0 + s * h);
    vec3 lit = shade(tint.rgb, dot(normal, lightInQuad.xyz));
    float rim = (1.0 - h) * (1.0 - h);
    lit += 0.12 * rim * horizon.rgb;
    colour = vec4(mix(lit, horizon.rgb, lightInQuad.w), tint.a * coverage);
    gl_FragDepth = gl_FragCoord.z + shape.w * h * gl_FragCoord.w;
}
)glsl";

constexpr std::size_t kCorners = 4;

}  // namespace

SphereLayer::SphereLayer() : program_("spheres", kVertexShader, kFragmentShader) {
    glBindVertexArray(vertexArray_.name());
    vertices_.bind();
    describeVertexField({0, 4, GL_FLOAT, false, offsetof(DrawnSphere, centre)},
                        sizeof(DrawnSphere));
    describeVertexField({1, 4, GL_UNSIGNED_BYTE, true, offsetof(DrawnSphere, colour)},
                        sizeof(DrawnSphere));
}

void SphereLayer::draw(std::span<const DrawnSphere> spheres, const View& view, QuadIndices& quads) {
    // Spheres that the eye is in, or that lie behind it, cannot be seen.
    order_.clear();
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
        const Vector3<float> fromEye = spheres[i].centre - view.eye;
        const float depth = view.forward.dot(fromEye);
        const float radius = spheres[i].radius;
        if (depth > 0 && fromEye.squaredNorm() > radius * radius) {
            order_.add(depth, i);
        }
    }
    const auto farthestFirst = order_.sort();
    if (farthestFirst.empty()) {
        return;
    }
    vertices_.fill<DrawnSphere>(kCorners * farthestFirst.size(),
                                [&](std::span<DrawnSphere> vertices) {
                                    auto next = vertices.begin();
                                    for (const DepthOrder::Entry& entry : farthestFirst) {
                                        next = std::fill_n(next, kCorners, spheres[entry.index]);
                                    }
                                });
    program_.use();
    glBindVertexArray(vertexArray_.name());
    glEnable(GL_BLEND);
    quads.draw(0, farthestFirst.size());
    glDisable(GL_BLEND);
}

}  // namespace hashphase::demos
