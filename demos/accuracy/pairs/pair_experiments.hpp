// SPDX-License-Identifier: Zlib
#pragma once

// P2: what the size of cells costs. P10: what it saves not to tell the broadphase of every move, and what
// that gets wrong. Both try ways to know, frame by frame, which boxes overlap.

#include <demos/accuracy/experiment.hpp>
#include <demos/compare/filled_broadphase.hpp>
#include <demos/scenes/scatter.hpp>

namespace hashphase::demos {

/// One way at work on one scene.
struct PairSource {
    /// A frame: takes the boxes as they are now, and finds the pairs.
    std::function<void(std::span<const BulletBox>)> step;

    /// Replaces `pairs` by those that the last step left, sorted.
    std::function<void(std::vector<PairKey>& pairs)> listPairs;

    /// How many times the last step compared two boxes; empty: that is not counted.
    std::function<std::uint64_t()> boxesTested = {};
};

/// exact     promises the overlapping pairs, all of them and no other
/// complete  promises all of them, perhaps with others
struct PairMethod
    : Method<PairSource(const BroadphaseNeeds& needs, std::span<const BulletBox> boxes)> {
    std::optional<double> factor = {};  // cell size by mean edge, where somebody has that choice

    /// When it compares more boxes than this in a frame, it is judged, but not timed.
    double mostTestsTimed = std::numeric_limits<double>::infinity();
};

/// SpatialHashBroadphase, its pair cache included.
[[nodiscard]] PairMethod hashMethod(std::string name, const GridConfig& grid = {});

/// btDbvtBroadphase, with m_deferedcollide or without.
[[nodiscard]] PairMethod dbvtMethod(bool isDeferred);

/// Whether the closed boxes share a point.
[[nodiscard]] inline bool overlap(const BulletBox& a, const BulletBox& b) {
    bool isApart = false;
    for (int axis = 0; axis < 3; ++axis) {
        isApart |= (a.min[axis] > b.max[axis]) | (b.min[axis] > a.max[axis]);
    }
    return !isApart;
}

enum class FiledCells {
    kAll,      // every cell that the box touches
    kCorners,  // those of its corners, as printed: whoever spans three cells leaves out the middle
};

/// The grid of Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by
/// Spatial Hashing", in space: one cell size for all. Every frame all buckets are wiped, every object
/// is hashed into the cells that it touches, and the objects of a cell are compared with each other.
/// Cells that share a bucket are told apart, and a pair that meets in several cells is listed once.
/// Keeps no pair cache: the pairs of a frame are listed and forgotten.
[[nodiscard]] PairMethod paperGridMethod(std::string name, double cellSize, FiledCells filed);

/// In how many of its cells the boxes lie altogether.
[[nodiscard]] double filedCellCount(std::span<const BulletBox> boxes, double cellSize);

struct PairTrialPlan {
    int judgedFrames = 4;  // before the times are taken, and as many after them
    int rounds = 60;       // of `framesTogether` frames each, for which a method is timed
    int framesTogether = 1;
};

/// Runs all methods on the scene, which moves on. Adds to the tables that pairs.sql names, under
/// the number of the trial. The true pairs come from a sweep along one axis; brute force, up to
/// 20,000 objects, judges it.
void tryPairs(std::size_t trial, BoxScene& scene, std::span<const PairMethod> methods,
              const PairTrialPlan& plan, Measurements& measured);

// --- P2 --------------------------------------------------------------------------------------------

/// A population: where the boxes lie, and how many there are.
struct CellCase {
    std::string population;
    ScatterPlan plan;
    std::size_t objects = 0;
    std::vector<double> factors = {};  // of cell sizes, by the mean edge
    int judgedFrames = 2;

    [[nodiscard]] std::string name() const;
};

/// The ways to be compared for these boxes, of that mean edge [m].
using CellMethods = std::function<std::vector<PairMethod>(
    const CellCase& each, std::span<const BulletBox> boxes, double meanEdge)>;

/// All ways: automatic sizes and fixed ones, the paper's grids where an object does not lie in too
/// many cells, and btDbvtBroadphase.
[[nodiscard]] std::vector<PairMethod> cellMethods(const CellCase& each,
                                                  std::span<const BulletBox> boxes,
                                                  double meanEdge);

/// The experiment, on these cases with these methods (cell_size.sql).
[[nodiscard]] Findings measureCellSizes(std::span<const CellCase> cases, const CellMethods& methods,
                                        std::uint64_t seed, const TellProgress& tell);

// --- P10 -------------------------------------------------------------------------------------------

/// How many of the boxes move, and how far.
struct Motion {
    double share = 1;    // 0 to 1
    double step = 0.02;  // the largest move on an axis in a frame, by the mean edge of 1 m
    bool isTask = true;  // its policies compete as choices

    [[nodiscard]] std::string name() const;  // "5 % move by 2 cm"
};

struct UpdatePlan {
    std::size_t objects = 0;
    std::vector<Motion> motions;  // at least one; those with the step of the first are compared
    PairTrialPlan trial;          // frames are multiples of every period, so that rounds are alike
};

/// When a broadphase is told that a box has moved: every time, as few times as boxes that are grown
/// by a margin allow (btDbvtBroadphase does so by 5 cm), or in every so many frames only.
[[nodiscard]] std::vector<PairMethod> updatePolicies();

/// The experiment, with these policies (update_policies.sql).
[[nodiscard]] Findings measurePolicies(const UpdatePlan& plan, std::span<const PairMethod> policies,
                                       std::uint64_t seed, const TellProgress& tell);

}  // namespace hashphase::demos
