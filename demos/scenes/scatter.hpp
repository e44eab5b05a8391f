// SPDX-License-Identifier: Zlib
#pragma once

// Scenes by their properties: how sizes are distributed, where the boxes lie, how dense, and how
// many of them move. Some are fixed by a benchmark, others drawn from a seed.

#include <demos/scenes/brownian_scene.hpp>

#include <string>

namespace hashphase::demos {

enum class SizeLaw {
    equal,       // every edge the same
    near,        // edges 0.5 to 1.5 times the mean
    logUniform,  // as many of each order of magnitude
    fewLarge,    // one in a hundred is so much larger
};

enum class Placement {
    cube,      // all over a cube
    plain,     // all over a square, on the ground
    clusters,  // in cubes of 1,000, far apart
};

struct ScatterPlan {
    SizeLaw sizes = SizeLaw::near;
    float sizeRatio = 1;  // largest edge by smallest, for logUniform and fewLarge
    Placement placement = Placement::cube;
    float overlapsPerBox = 2;  // on average, if all pairs counted
    float movingShare = 1;
    float step = 0.2F;  // largest move on an axis in a frame, by the mean edge
};

/// The smallest edge is about 1 m. The same arguments give the same boxes.
[[nodiscard]] BrownianBoxes scatter(const ScatterPlan& plan, std::size_t objects,
                                    std::uint64_t seed);

/// The mean of all edges on all axes [m]; there must be a box.
[[nodiscard]] double meanEdge(const BrownianBoxes& boxes);

/// A plan drawn from a seed, and a number of objects for it.
struct RandomScene {
    ScatterPlan plan;
    std::size_t objects = 0;
};
[[nodiscard]] RandomScene drawScene(std::uint64_t seed);

/// "log-uniform edges 1:140, in clusters, 3.1 overlaps a box, 17 % moving".
[[nodiscard]] std::string describe(const ScatterPlan& plan);

}  // namespace hashphase::demos
