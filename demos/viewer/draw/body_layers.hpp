// SPDX-License-Identifier: Zlib
#pragma once

// What stands in the world: boxes, capsules, spheres and the shade below these, and lines.

#include <demos/viewer/draw/ground.hpp>
#include <demos/viewer/draw/layer.hpp>
#include <demos/viewer/draw/view.hpp>

#include <vector>

namespace hashphase::demos {

class BodyLayers {
public:
    BodyLayers();

    /// After the ground and the sky. What has smooth edges comes after what is solid, and of it the farthest
    /// first; but what is small on the screen before what is not. Lines come last.
    void draw(const Picture& picture, const View& view, const Ground& ground);

private:
    /// Of a box: from its middle to the middles of two of its sides. Right, up and outward are as x, y and z.
    struct Face {
        Vector3<float> middle;
        Vector3<float> right;
        Vector3<float> up;
        Colour colour;
    };

    /// Of contact shade, on the ground.
    struct Spot {
        Vector3<float> centre;
        float radius;
        Vector3<float> normal;
        float strength;  // 0 to 1
    };

    /// Spheres that are drawn in one way.
    struct Batch {
        Layer layer;
        DepthOrder order = {};
    };

    void drawContacts(const Picture& picture, const View& view, const Ground& ground);
    void addFaces(const DrawnBox& box, const View& view);
    void drawBoxes(std::span<const DrawnBox> boxes, const View& view);
    void drawCapsules(std::span<const DrawnCapsule> capsules, const View& view);
    void drawSpheres(std::span<const DrawnSphere> spheres, const View& view, float leastRadius);
    [[nodiscard]] Batch& batchFor(const Vector3<float>& fromEye, float depth, float pixels,
                                  const View& view);
    void drawLines(std::span<const DrawnLine> lines);

    Layer contacts_;
    Layer boxes_;
    Layer capsules_;
    Batch dots_;
    Batch points_;
    Batch quads_;
    Layer lines_;
    DepthOrder order_;  // of faces, and of capsules
    std::vector<Face> faces_;
    std::vector<Spot> spots_;
    std::vector<DrawnLine> sortedLines_;  // those on top come last
};

}  // namespace hashphase::demos
