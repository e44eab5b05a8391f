// SPDX-License-Identifier: Zlib
//
// Rays through more cells than steps can be added up, and of lengths that cannot be squared.

#include <demos/stability/cases/cases.hpp>

#include <demos/stability/ray_scene.hpp>

#include <array>
#include <set>

namespace hashphase::demos {
namespace {

/// What a ray finds beyond what it meets is no farther away than so much of the coordinates.
template <class Scalar>
constexpr double kDoubt = 8 * kEpsilon<Scalar>;

// A ray far along x through boxes here and there; how much our walk reads is bounded by what is there.
// Returns whether it was ours.
template <class Scalar>
bool judgeFarAlong(CaseRun<Scalar>& run, Scalar length, const Vector3<Scalar>& slope,
                   Scalar aside) {
    using Point = Vector3<Scalar>;
    const Lattice fours(4);
    Boxes<Scalar> boxes;
    constexpr int kBoxes = 200;
    for (int i = 0; i <= kBoxes; ++i) {
        const Scalar share = static_cast<Scalar>(i) / kBoxes;
        const Point on = fours.on<Scalar>((share * length) * slope);
        boxes.push_back({on - Point::Constant(4), on + Point::Constant(4)});
        const Point beside = on + Point(0, i % 2 == 0 ? aside : -aside, 0);
        boxes.push_back({beside - Point::Constant(4), beside + Point::Constant(4)});
    }
    RayScene<Scalar> scene(run, boxes, {.cellSize = 1});
    const Point to = fours.on<Scalar>(length * slope);
    const Point from = Point::Zero();
    for (const auto& [begin, end] : {std::pair(from, to), std::pair(to, from)}) {
        scene.judge(begin, end, fours);
        if (scene.isOurs()) {
            const double all = static_cast<double>(boxes.size());
            run.addCost(static_cast<double>(scene.cost().rowsVisited) / all, 3);
        }
    }
    if (scene.isOurs()) {
        run.note("Cost: blocks of boxes read, divided by the number of boxes.");
    }
    noteRaysThroughBullet(run);
    return scene.isOurs();
}

constexpr auto manyCells = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    // A ray errs to the side of a hit by what its coordinates are rounded by: metres, there.
    judgeFarAlong<Scalar>(run, 3.4e7F, {1, 0.5F, -0.25F}, 1024);
};

// --- A box in each cell ---------------------------------------------------------------------------

/// The boxes of a metre around the way near its end, as many as fit.
template <class Scalar>
Boxes<Scalar> cellsAround(const Vector3<double>& from, const Vector3<double>& to) {
    constexpr double kReach = 1200;
    const Vector3<double> way = to - from;
    int axis = 0;
    const double length = way.cwiseAbs().maxCoeff(&axis);
    std::set<std::array<int, 3>> cells;
    for (double steps = 0; steps <= std::min(length, kReach) + 1; ++steps) {
        const Vector3<double> at = to - way * std::min(steps / length, 1.0);
        for (int i = 0; i < 27; ++i) {
            const Vector3<double> cell =
                at.array().floor() + Eigen::Array3d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
            const Vector3<int> numbers = cell.cast<int>();
            cells.insert({numbers[0], numbers[1], numbers[2]});
        }
    }
    Boxes<Scalar> boxes;
    for (const auto& [x, y, z] : cells) {
        boxes.push_back(makeBox<Scalar>(x, y, z, x + 1, y + 1, z + 1));
    }
    return boxes;
}

/// The ray finds the boxes in the cells that it touches, and no others. Where it passes a cell nearer
/// than numbers tell, it may find that, too.
template <class Scalar>
void judgeSupercover(CaseRun<Scalar>& run, const Vector3<double>& from, const Vector3<double>& to,
                     double doubt = 0) {
    RayScene<Scalar> scene(run, cellsAround<Scalar>(from, to), {.cellSize = 1});
    scene.judge(from.cast<Scalar>(), to.cast<Scalar>(), Lattice(0x1p-13), doubt);
}

constexpr auto hundredThousandCells = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    if (!judgeFarAlong<Scalar>(run, 1e5F, {1, 0.37F, 0.61F}, 12)) {
        return;
    }
    // What adds up steps is 98 cells off at the end.
    judgeSupercover(run, {1e5, 0, 0}, {0, 0, 1e5});
    judgeSupercover(run, {0.125, 0.5, -0.25}, {-1e5, 2500.5, 41'250.25}, kDoubt<Scalar>);
    judgeSupercover(run, {0, 3, 5}, {1200, 3, 5});                 // in edges
    judgeSupercover(run, {7, 0.25, -2.5}, {7, -1200, -2.5});       // in faces
    judgeSupercover(run, {7.5, 0.25, 600}, {7.5, 0.25, -600});     // between them
    judgeSupercover(run, {0, 0, 0}, {500, 500, 500});              // through corners
    judgeSupercover(run, {300, -300, 5}, {-300, 300, 5});          // through edges, in faces
    judgeSupercover(run, {0.5, 0, 0.25}, {-499.5, 500, -499.75});  // through faces
    judgeSupercover(run, {-3, 9, 1}, {1021, 649, -383});           // through some corners
    judgeSupercover(run, {0.25, 0.5, 0.75}, {1200.25, 1.5, 1});    // nearly in faces
    judgeSupercover(run, {0.375, 0.125, -7}, {-811.5, 402.125, 737.25});
};

// --- Too long -------------------------------------------------------------------------------------

/// A slanted ray through boxes as far away as it is long, all so many times as large as numbers that
/// are exact: a power of two changes no answer.
template <class Scalar>
void judgeScaledUp(CaseRun<Scalar>& run, double scale) {
    using Point = Vector3<Scalar>;
    const Lattice lattice(0x1p-20);
    const double length = 0x1p20;
    Random random(run.seed);
    for (int i = 0; i < 6; ++i) {
        const Vector3<double> direction = pointIn<double>(random, -1, 1);
        const auto onLattice = [&](const Vector3<double>& point) {
            return lattice.on<Scalar>(Point(point.cast<Scalar>()));
        };
        const Point from = onLattice(-length * direction);
        const Point to = onLattice(length * direction);
        Boxes<Scalar> boxes;
        Boxes<Scalar> large;
        const auto by = static_cast<Scalar>(scale);
        for (int k = 0; k < 100; ++k) {
            const double away = k < 30 ? 0 : length * between<double>(random, -1, 1);
            const double half = k < 30 ? 16 : std::abs(away) * 1e-3;
            const Vector3<double> at = direction * away + pointIn<double>(random, -2, 2) * half;
            const Vector3<double> size = Vector3<double>::Constant(half);
            boxes.push_back({onLattice(at - size), onLattice(at + size)});
            large.push_back({boxes.back().min() * by, boxes.back().max() * by});
        }
        const RayRegion<Scalar> ray(from * by, to * by);
        PairScene<Scalar> scene(run, large);
        scene.findPairs();
        scene.judgeQuery(ray);
        bool areAllFound = true;
        bool isNoneFar = true;
        for (std::size_t k = 0; k < boxes.size(); ++k) {
            const bool isFound = ray.key(large[k]) >= 0;
            areAllFound &= isFound || !lattice.meets(from, to, boxes[k]);
            isNoneFar &= !isFound || lattice.meets(from, to, boxes[k], pointBox<Scalar>(),
                                                   4 * kDoubt<Scalar> * length);
        }
        run.expect(areAllFound && isNoneFar,
                   "a very long ray finds all boxes that it meets, and no distant box");
    }
}

constexpr auto tooLongForSquares = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    for (const Scalar length : {1e18F, 1e19F, 1e25F, 1e38F}) {
        Boxes<Scalar> boxes = latticeBoxes<Scalar>(200, 20, run.seed);
        boxes.push_back(
            {Point(Scalar(0.4F) * length, Scalar(-0.01F) * length, -2), Point(length, length, 2)});
        RayScene<Scalar> scene(run, boxes);
        for (int axis = 0; axis < 3; ++axis) {
            for (const Scalar sign : {Scalar(1), Scalar(-1)}) {
                const Point through(0.5F, -0.25F, 1.5F);
                Point from = through;
                Point to = through;
                from[axis] = -sign * length / 2;
                to[axis] = sign * length / 2;
                // Along an axis, comparing coordinates decides.
                const Aabb<Scalar> line(from.cwiseMin(to), from.cwiseMax(to));
                scene.judge(from, to, [&](const Aabb<Scalar>& box) { return doTouch(box, line); });
            }
        }
    }
    noteRaysThroughBullet(run);
    if (run.isOurs) {
        for (const double scale :
             {0x1p43, 0x1p80, std::is_same_v<Scalar, float> ? 0x1p106 : 0x1p1002}) {
            judgeScaledUp(run, scale);
        }
    }
};

constexpr HardCase kLongRayCases[] = {
    {"H16", "a ray through 3.4e7 cells",
     "cells of 1 m; a slanting ray, 3.4e7 m long along x, cast in both directions; 201 boxes of 8 "
     "m on the ray, and 201 boxes 1 km beside it",
     "all hits; the cost depends on the number of boxes, not on the number of cells", manyCells},
    {"H17", "a ray through 1e5 cells",
     "cells of 1 m; a slanting ray, 1e5 m long along x, cast in both directions; 201 boxes of 8 m "
     "on the ray, and 201 boxes 12 m beside it; for hashphase also 11 rays through boxes of 1 m "
     "that fill all cells around them",
     "all hits, up to the end of the ray; the cost depends on the number of boxes, not on the "
     "number of cells",
     hundredThousandCells},
    {"H18", "rays of 1e18 to 1e38 m",
     "201 boxes; rays along each axis, 1e18, 1e19, 1e25 and 1e38 m long: squares of the last two "
     "overflow in single precision; for hashphase also long slanting rays",
     "the boxes that the segment meets", tooLongForSquares},
};

}  // namespace

std::span<const HardCase> longRayCases() {
    return kLongRayCases;
}

}  // namespace hashphase::demos
