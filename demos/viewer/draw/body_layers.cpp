// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/body_layers.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr float kLargestDot = 3.5F;  // radius [pixels]
constexpr float kLargestPoint = 16;

constexpr DrawState kHiddenLineState{
    .blends = true, .writesDepth = false, .depthFunction = GL_GEQUAL};
constexpr float kHiddenOpacity = 0.3F;  // of lines on top, behind what hides them

// A quad or a point, on which the sphere is found by a ray through each pixel.
LayerKind sphereKind(std::string definitions, LayerShape shape) {
    return {.shader = "spheres",
            .definitions = std::move(definitions),
            .shape = shape,
            .state = {.blends = true},
            .fields = {4, kColour},
            .size = sizeof(DrawnSphere)};
}

/// OpenGL drops points whose middle is not on the screen, so spheres whose middle is beyond its edge, or on it,
/// are none.
bool isInside(const Vector3<float>& fromEye, float depth, const View& view) {
    const Eigen::Vector2f place(view.right.dot(fromEye) / view.tangents.x(),
                                view.up.dot(fromEye) / view.tangents.y());
    constexpr float kMargin = 2;  // [pixels]
    const Eigen::Vector2f limit = (1 - 2 * kMargin / view.size.array()) * depth;
    return std::abs(place.x()) < limit.x() && std::abs(place.y()) < limit.y();
}

}  // namespace

BodyLayers::BodyLayers()
    : contacts_({.shader = "contact_shade",
                 .shape = LayerShape::quads,
                 .state = {.blends = true, .writesDepth = false},
                 .fields = {4, 4},
                 .size = sizeof(Spot)}),
      boxes_({.shader = "boxes",
              .shape = LayerShape::quads,
              .fields = {3, 3, 3, kColour},
              .size = sizeof(Face)}),
      // A box around each, on which the capsule is found by a ray through each pixel.
      capsules_({.shader = "capsules",
                 .shape = LayerShape::cuboids,
                 .state = {.blends = true, .isSeenFromInside = true},
                 .fields = {3, 3, 1, kColour},
                 .size = sizeof(DrawnCapsule)}),
      dots_{Layer(sphereKind("#define DOTS\n", LayerShape::points))},
      points_{Layer(sphereKind("#define POINTS\n", LayerShape::points))},
      quads_{Layer(sphereKind("#define QUADS\n", LayerShape::quads))},
      lines_({.shader = "lines",
              .shape = LayerShape::quads,
              .state = {.blends = true, .writesDepth = false},
              .fields = {3, 3, kColour},
              .size = sizeof(DrawnLine)}) {}

void BodyLayers::draw(const Picture& picture, const View& view, const Ground& ground) {
    drawContacts(picture, view, ground);
    drawBoxes(picture.boxes, view);
    drawCapsules(picture.capsules, view);
    drawSpheres(picture.spheres, view, picture.leastRadius);
    drawLines(picture.lines);
}

// Contact shade: a soft dark spot on the ground below each sphere that is near it, which is what makes a sphere
// stand on the ground in the eye of who looks.
void BodyLayers::drawContacts(const Picture& picture, const View& view, const Ground& ground) {
    constexpr float kFull = 1.45F;  // so much larger than the least, spots are as dark as they get
    constexpr float kReach = 1.5F;  // a sphere so many radii above the ground has no spot
    constexpr float kSpotRadius = 1.4F;    // in radii of the sphere
    constexpr float kMostStrength = 0.8F;  // of the spot below a sphere that touches the ground
    const float least = picture.contactFrom;
    spots_.clear();
    for (const DrawnSphere& sphere : picture.spheres) {
        const float depth = view.depth(sphere.centre);
        const float pixels = depth > 0 ? view.pixels(sphere.radius, depth) : 0;
        if (pixels <= least) {
            continue;
        }
        const auto below = ground.at(sphere.centre.x(), sphere.centre.z());
        if (!below) {
            continue;
        }
        const float gap = sphere.centre.y() - below->position.y() - sphere.radius;
        const float nearness = 1 - std::max(gap, 0.0F) / (kReach * sphere.radius);
        if (nearness > 0 && gap > -2 * sphere.radius) {
            const float size = std::min((pixels - least) / ((kFull - 1) * least), 1.0F);
            spots_.push_back({below->position, kSpotRadius * sphere.radius, below->normal,
                              kMostStrength * size * nearness * nearness});
        }
    }
    contacts_.draw<Spot>(spots_);
}

// --- Boxes and capsules --------------------------------------------------------------------------

// Those that look towards the eye: of the two across an axis the one on whose outer side the eye is.
void BodyLayers::addFaces(const DrawnBox& box, const View& view) {
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

// The nearest first, so that most of what is hidden costs nothing.
void BodyLayers::drawBoxes(std::span<const DrawnBox> boxes, const View& view) {
    order_.clear();
    faces_.clear();
    for (const DrawnBox& box : boxes) {
        if (view.depth(box.centre) > -box.halfExtents.norm()) {
            addFaces(box, view);
        }
    }
    boxes_.draw<Face>(faces_, order_);
}

void BodyLayers::drawCapsules(std::span<const DrawnCapsule> capsules, const View& view) {
    order_.clear();
    for (std::uint32_t i = 0; i < capsules.size(); ++i) {
        const DrawnCapsule& capsule = capsules[i];
        const float one = view.depth(capsule.from), other = view.depth(capsule.to);
        if (std::max(one, other) > -capsule.radius) {
            order_.add(std::max((one + other) / 2, 0.0F), i);
        }
    }
    capsules_.draw(capsules, order_);
}

// --- Spheres -------------------------------------------------------------------------------------

BodyLayers::Batch& BodyLayers::batchFor(const Vector3<float>& fromEye, float depth, float pixels,
                                        const View& view) {
    if (pixels > kLargestPoint || !isInside(fromEye, depth, view)) {
        return quads_;
    }
    return pixels > kLargestDot ? points_ : dots_;
}

// Spheres that the eye is in, or that lie behind it, cannot be seen. Of two that are apart, the one whose
// tangents from the eye are longer hides nothing of the other. Dots have one depth each, and go by that.
void BodyLayers::drawSpheres(std::span<const DrawnSphere> spheres, const View& view,
                             float leastRadius) {
    const std::array batches{&dots_, &points_, &quads_};
    for (Batch* const batch : batches) {
        batch->order.clear();
    }
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
        const Vector3<float> fromEye = spheres[i].centre - view.eye;
        const float depth = view.forward.dot(fromEye);
        const float radius = spheres[i].radius;
        const float tangentSquared = fromEye.squaredNorm() - radius * radius;
        if (depth > 0 && tangentSquared > 0) {
            const float pixels = std::max(view.pixels(radius, depth), leastRadius);
            Batch& batch = batchFor(fromEye, depth, pixels, view);
            batch.order.add(&batch == &dots_ ? depth : tangentSquared, i);
        }
    }
    for (Batch* const batch : batches) {
        batch->layer.draw(spheres, batch->order);
    }
}

// --- Lines ---------------------------------------------------------------------------------------

void BodyLayers::drawLines(std::span<const DrawnLine> lines) {
    sortedLines_.assign(lines.begin(), lines.end());
    const auto firstOnTop =
        std::stable_partition(sortedLines_.begin(), sortedLines_.end(),
                              [](const DrawnLine& line) { return !line.isOnTop; });
    const auto onTop = static_cast<std::size_t>(sortedLines_.end() - firstOnTop);
    glUniform1f(lines_.uniform("opacity"), 1);
    lines_.draw<DrawnLine>(sortedLines_);
    if (onTop > 0) {
        glUniform1f(lines_.uniform("opacity"), kHiddenOpacity);
        lines_.drawAgain(kHiddenLineState, sortedLines_.size() - onTop, onTop);
    }
}

}  // namespace hashphase::demos
