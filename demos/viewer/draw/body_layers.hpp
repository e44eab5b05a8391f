// SPDX-License-Identifier: Zlib
#pragma once

// What stands in the world: boxes, capsules, spheres and the shade below these, and lines.

#include <demos/viewer/draw/ground.hpp>
#include <demos/viewer/draw/layer.hpp>
#include <demos/viewer/draw/view.hpp>

#include <span>
#include <vector>

namespace hashphase::demos {

/// In any orientation, with edges that show; the nearest first, so that most of what is hidden costs nothing.
class BoxLayer {
public:
    BoxLayer();
    void draw(std::span<const DrawnBox> boxes, const View& view);

private:
    /// From its middle to the middles of two of its sides; right, up and outward are as x, y and z.
    struct Face {
        Vector3<float> middle;
        Vector3<float> right;
        Vector3<float> up;
        Colour colour;
    };

    void addFaces(const DrawnBox& box, const View& view);

    Layer layer_;
    std::vector<Face> faces_;
    DepthOrder order_;
};

/// A box around each, on which the capsule is found by a ray through each pixel. After what is solid: the
/// edges are smooth, and so the farthest are painted first.
class CapsuleLayer {
public:
    CapsuleLayer();
    void draw(std::span<const DrawnCapsule> capsules, const View& view);

private:
    Layer layer_;
    DepthOrder order_;
};

/// A quad or a point each, on which the sphere is found by a ray through each pixel. After all that is solid:
/// the edges are smooth, and so the farthest are painted first; but what is small on the screen before what is
/// not.
class SphereLayer {
public:
    SphereLayer();
    /// None is drawn smaller than `leastRadius` [pixels].
    void draw(std::span<const DrawnSphere> spheres, const View& view, float leastRadius);

private:
    /// Spheres that are drawn in one way.
    struct Batch {
        Layer layer;
        DepthOrder order;
    };

    [[nodiscard]] Batch& batchFor(const Vector3<float>& fromEye, float depth, float pixels,
                                  const View& view);

    Batch dots_;
    Batch points_;
    Batch quads_;
};

/// Contact shade: a soft dark spot on the ground below each sphere that is near it, which is what makes a
/// sphere stand on the ground in the eye of who looks. After the ground, before the spheres.
class ContactLayer {
public:
    ContactLayer();
    /// Spheres of `least` pixels or less have no spot.
    void draw(std::span<const DrawnSphere> spheres, const Ground& ground, const View& view,
              float least);

private:
    /// A spot on the ground.
    struct Spot {
        Vector3<float> centre;
        float radius;
        Vector3<float> normal;
        float strength;  // 0 to 1
    };

    Layer layer_;
    std::vector<Spot> spots_;
};

/// Of one width, with smooth edges. Last of all that is in the world.
class LineLayer {
public:
    LineLayer();
    void draw(std::span<const DrawnLine> lines);

private:
    Layer layer_;
    std::vector<DrawnLine> sorted_;  // those on top come last
};

}  // namespace hashphase::demos
