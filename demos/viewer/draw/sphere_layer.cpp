// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/sphere_layer.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace hashphase::demos {

namespace {

// From the eye, a sphere of radius 1 at distance D = 1 / s is the cone around the circle in which
// rays touch it: radius c = sqrt(1 - s^2), s nearer to the eye than the centre. The quad lies in
// the plane of that circle, so its edge is exactly the sphere's in any perspective: |offset| = 1
// there.
//
// The ray through c * offset on that plane meets the sphere at D / (D + h) of the way to the plane,
// where h = sqrt(1 - |offset|^2). With the axis towards the eye, the normal there is (c * offset, s
// + h) / (1 + s * h), and the depth is what the plane's is, and s * h times the eye's depth before
// the division by w, divided by the plane's w.
//
// A small sphere is a point, whose square is a primitive instead of two and a vertex instead of
// four, which is what costs. There s is next to nothing, and offset a linear function of the pixel.
constexpr const char* kSphereOfVertex = R"glsl(
layout(location = 0) in vec4 sphere;
layout(location = 1) in vec4 colourOfSphere;

flat out vec4 tint;
flat out vec4 lightInQuad;  // towards the light, in the axes of the quad; and the share of haze
flat out vec4 shape;        // s, c, the radius on the screen [pixels], the eye's depth times s

vec3 axis;   // from the eye
vec3 right;  // of the quad
vec3 up;
float distance;
float depth;
float radius;

void placeSphere() {
    vec3 fromEye = sphere.xyz - eye.xyz;
    depth = dot(fromEye, cameraForward.xyz);
    radius = max(sphere.w, screen.w * depth / screen.z);
    distance = length(fromEye);
    axis = fromEye / distance;
    right = normalize(cross(axis, cameraUp.xyz));
    up = cross(right, axis);
    float s = min(radius / distance, 0.999);
    tint = colourOfSphere;
    lightInQuad = vec4(dot(right, light.xyz), dot(up, light.xyz), -dot(axis, light.xyz),
                       haze(fromEye));
    shape = vec4(s, sqrt(1.0 - s * s), screen.z * radius / depth, eye.w * s);
}
)glsl";

constexpr const char* kQuadOfVertex = R"glsl(
out vec2 offset;

void main() {
    placeSphere();
    vec2 corner = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) * 2.0 - 1.0;
    offset = corner * (1.0 + 0.5 / shape.z);
    vec3 place = eye.xyz + axis * (distance - radius * shape.x) +
                 radius * shape.y * (right * offset.x + up * offset.y);
    gl_Position = clipFromWorld * vec4(place, 1.0);
}
)glsl";

constexpr const char* kPointOfVertex = R"glsl(
flat out vec3 offsetOfPlace;  // x by x, y by x, y by y; x does not depend on y

void main() {
    placeSphere();
    // Away from the middle of the screen, spheres are drawn out by one over the cosine.
    float size = 2.0 * shape.z * distance / depth + 1.0;
    vec2 scale = vec2(size, -size) / shape.z;
    offsetOfPlace = vec3(dot(cameraRight.xyz, right) * scale.x, dot(cameraRight.xyz, up) * scale.x,
                         dot(cameraUp.xyz, up) * scale.y);
    gl_PointSize = size;
    gl_Position = clipFromWorld * vec4(sphere.xyz, 1.0);
}
)glsl";

constexpr const char* kSphereOfFragment = R"glsl(
flat in vec4 tint;
flat in vec4 lightInQuad;
flat in vec4 shape;

out vec4 colour;

void paintSphere(vec2 offset) {
    float squared = dot(offset, offset);
    float coverage = min((1.0 - sqrt(squared)) * shape.z + 0.5, 1.0);
    if (coverage <= 0.0) {
        discard;
    }
    float h = sqrt(max(1.0 - squared, 0.0));
    float s = shape.x;
    vec3 normal = vec3(shape.y * offset, s + h) / (1.0 + s * h);
    vec3 lit = shadeRound(tint.rgb, dot(normal, lightInQuad.xyz));
    float rim = (1.0 - h) * (1.0 - h);
    lit += 0.12 * rim * horizon.rgb;
    colour = vec4(mix(lit, horizon.rgb, lightInQuad.w), tint.a * coverage);
    gl_FragDepth = gl_FragCoord.z + shape.w * h * gl_FragCoord.w;
}
)glsl";

constexpr const char* kQuadOfFragment = R"glsl(
in vec2 offset;

void main() {
    paintSphere(offset);
}
)glsl";

constexpr const char* kPointOfFragment = R"glsl(
flat in vec3 offsetOfPlace;

void main() {
    vec2 place = gl_PointCoord - 0.5;
    paintSphere(place.x * offsetOfPlace.xy + vec2(0.0, place.y * offsetOfPlace.z));
}
)glsl";

/// The sphere that is copied to each vertex of what it is drawn by.
void describeSphere(const StreamBuffer& vertices) {
    vertices.bind();
    describeVertexField({0, 4, GL_FLOAT, false, offsetof(DrawnSphere, centre)},
                        sizeof(DrawnSphere));
    describeVertexField({1, 4, GL_UNSIGNED_BYTE, true, offsetof(DrawnSphere, colour)},
                        sizeof(DrawnSphere));
}

constexpr std::size_t kCorners = 4;
constexpr float kLargestPoint = 16;  // radius [pixels]

/// Whether the sphere is so small that a point will do. OpenGL drops points whose middle is not on
/// the screen, so those at its edge are none.
bool isPoint(const Vector3<float>& fromEye, float depth, float radius, const View& view) {
    if (view.pixels(radius, depth) > kLargestPoint) {
        return false;
    }
    const Eigen::Vector2f place(view.right.dot(fromEye) / view.tangents.x(),
                                view.up.dot(fromEye) / view.tangents.y());
    const Eigen::Vector2f limit = (1 - 4 * kLargestPoint / view.size.array()) * depth;
    return std::abs(place.x()) < limit.x() && std::abs(place.y()) < limit.y();
}

}  // namespace

SphereLayer::Batch::Batch(std::string_view name, const std::string& vertexShader,
                          const std::string& fragmentShader)
    : program(name, vertexShader, fragmentShader) {
    glBindVertexArray(vertexArray.name());
    describeSphere(vertices);
}

void SphereLayer::Batch::fill(std::span<const DrawnSphere> spheres, std::size_t copies) {
    const auto farthestFirst = order.sort();
    vertices.fill<DrawnSphere>(copies * farthestFirst.size(), [&](std::span<DrawnSphere> filled) {
        auto next = filled.begin();
        for (const DepthOrder::Entry& entry : farthestFirst) {
            next = std::fill_n(next, copies, spheres[entry.index]);
        }
    });
    program.use();
    glBindVertexArray(vertexArray.name());
}

SphereLayer::SphereLayer()
    : points_("small spheres", std::string(kSphereOfVertex) + kPointOfVertex,
              std::string(kSphereOfFragment) + kPointOfFragment),
      quads_("spheres", std::string(kSphereOfVertex) + kQuadOfVertex,
             std::string(kSphereOfFragment) + kQuadOfFragment) {}

void SphereLayer::draw(std::span<const DrawnSphere> spheres, const View& view,
                       QuadIndices& indices) {
    // Spheres that the eye is in, or that lie behind it, cannot be seen.
    points_.order.clear();
    quads_.order.clear();
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
        const Vector3<float> fromEye = spheres[i].centre - view.eye;
        const float depth = view.forward.dot(fromEye);
        const float radius = spheres[i].radius;
        if (depth > 0 && fromEye.squaredNorm() > radius * radius) {
            (isPoint(fromEye, depth, radius, view) ? points_ : quads_).order.add(depth, i);
        }
    }
    glEnable(GL_BLEND);
    glEnable(GL_PROGRAM_POINT_SIZE);
    if (points_.order.size() > 0) {
        points_.fill(spheres, 1);
        glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(points_.order.size()));
    }
    if (quads_.order.size() > 0) {
        quads_.fill(spheres, kCorners);
        indices.draw(0, quads_.order.size());
    }
    glDisable(GL_PROGRAM_POINT_SIZE);
    glDisable(GL_BLEND);
}

}  // namespace hashphase::demos
