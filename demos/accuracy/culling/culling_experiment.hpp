// SPDX-License-Identifier: Zlib
#pragma once

// P4: ways to find out what a camera sees of objects that stand on flat ground at height 0.

#include <demos/accuracy/experiment.hpp>
#include <demos/scenes/camera_view.hpp>

#include <array>

namespace hashphase::demos {

/// What a look at the scene took.
struct CullingCost {
    std::uint64_t cells = 0;  // tested or walked through: rows of cells, or nodes, where those are
    std::uint64_t boxes = 0;  // tested one by one
};

/// A method that has filed a scene.
struct Culling {
    /// Finds what is to be drawn; this is what is timed.
    std::function<CullingCost(const CameraView&)> look;

    /// Whether the last look() found the object.
    std::function<bool(std::uint32_t object)> draws;
};

struct CullingScene {
    std::span<const Aabb<float>> boxes;
    float tallest;   // no object is higher [m]
    float cellSize;  // of methods that must be told [m]
};

/// must_see_all   a visible object that it does not draw breaks a check
/// must_be_exact  as does an invisible object that it draws, except by rounding
/// takes_cells    the scene's cell size matters
using CullingMethod = Method<Culling(const CullingScene&)>;

/// The paper's and others' on the paper's map of cells; the library's; Bullet's.
[[nodiscard]] std::vector<CullingMethod> cullingMethods();

/// How much is measured.
struct CullingPlan {
    std::size_t objects;
    std::size_t touching;  // in each view, its sides
    int flights;           // for each setting; a flight is eight views, one after another
    int frames;            // that are timed; a flight each
};

/// Counts what the methods get wrong, in all settings, and times them in the first one with all cell
/// sizes; says what it shows (culling.sql).
[[nodiscard]] Findings findCulling(const CullingPlan& plan, std::uint64_t seed,
                                   std::span<const CullingMethod> methods,
                                   const TellProgress& tell);

/// The truth about what a camera sees, by clipping in long double.
class ExactFrustum {
public:
    /// Of the matrix, its numbers taken as exact.
    explicit ExactFrustum(const CameraView& view);

    /// True when the closed box and the closed frustum share a point.
    [[nodiscard]] bool sees(const Aabb<float>& box) const;

private:
    using Real = long double;
    using Point = Vector3<Real>;
    using Plane = Eigen::Hyperplane<Real, 3>;

    [[nodiscard]] bool seesFaceOf(const Aabb<Real>& box) const;

    std::array<Plane, 6> planes_;
    Point corner_;  // any point of the frustum
};

}  // namespace hashphase::demos
