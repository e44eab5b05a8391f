// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/contact_layer.hpp>

#include <algorithm>
#include <cstddef>

namespace hashphase::demos {

namespace {

// A square in the plane of the ground. It comes nearer to the eye by a part of its radius, which
// moves nothing on the screen, and so it is not swallowed by ground that bulges.
constexpr const char* kContactVertexShader = R"glsl(
layout(location = 0) in vec4 spot;
layout(location = 1) in vec4 ground;

out vec2 offset;
flat out float strength;

void main() {
    offset = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) * 2.0 - 1.0;
    vec3 right = normalize(vec3(ground.y, -ground.x, 0.0));
    vec3 ahead = cross(right, ground.xyz);
    vec3 place = spot.xyz + spot.w * (right * offset.x + ahead * offset.y);
    vec3 towardsEye = normalize(eye.xyz - place);
    gl_Position = clipFromWorld * vec4(place + 0.35 * spot.w * towardsEye, 1.0);
    strength = ground.w * (1.0 - haze(spot.xyz - eye.xyz));
}
)glsl";

constexpr const char* kContactFragmentShader = R"glsl(
in vec2 offset;
flat in float strength;

out vec4 colour;

void main() {
    float inside = max(1.0 - dot(offset, offset), 0.0);
    colour = vec4(shadow.rgb * 0.3, strength * inside * inside);
}
)glsl";

constexpr float kFull = 1.45F;       // so much larger than the least, spots are as dark as they get
constexpr float kReach = 1.5F;       // a sphere so many radii above the ground has no spot
constexpr float kSpotRadius = 1.4F;  // in radii of the sphere
constexpr float kMostStrength = 0.8F;  // of the spot below a sphere that touches the ground

}  // namespace

ContactLayer::ContactLayer()
    : program_("contact shade", kContactVertexShader, kContactFragmentShader) {
    glBindVertexArray(vertexArray_.name());
    vertices_.bind();
    describeVertexField({0, 4, GL_FLOAT, false, offsetof(Spot, centre)}, sizeof(Spot));
    describeVertexField({1, 4, GL_FLOAT, false, offsetof(Spot, normal)}, sizeof(Spot));
}

void ContactLayer::draw(std::span<const DrawnSphere> spheres, const View& view, float least,
                        QuadIndices& quads) {
    findSpots(spheres, view, least);
    if (spots_.empty()) {
        return;
    }
    vertices_.fill<Spot>(QuadIndices::kCorners * spots_.size(), [this](std::span<Spot> vertices) {
        auto next = vertices.begin();
        for (const Spot& spot : spots_) {
            next = std::fill_n(next, QuadIndices::kCorners, spot);
        }
    });
    program_.use();
    glBindVertexArray(vertexArray_.name());
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    quads.draw(0, spots_.size());
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

void ContactLayer::findSpots(std::span<const DrawnSphere> spheres, const View& view, float least) {
    spots_.clear();
    for (const DrawnSphere& sphere : spheres) {
        const float depth = view.depth(sphere.centre);
        if (depth <= 0) {
            continue;
        }
        const float pixels = view.pixels(sphere.radius, depth);
        if (pixels <= least) {
            continue;
        }
        const auto ground = heights_.at(sphere.centre.x(), sphere.centre.z());
        if (!ground) {
            continue;
        }
        const float gap = sphere.centre.y() - ground->height - sphere.radius;
        const float nearness = 1 - std::max(gap, 0.0F) / (kReach * sphere.radius);
        if (nearness > 0 && gap > -2 * sphere.radius) {
            Vector3<float> centre = sphere.centre;
            centre.y() = ground->height;
            const float size = std::min((pixels - least) / ((kFull - 1) * least), 1.0F);
            spots_.push_back({centre, kSpotRadius * sphere.radius, ground->normal,
                              kMostStrength * size * nearness * nearness});
        }
    }
}

}  // namespace hashphase::demos
