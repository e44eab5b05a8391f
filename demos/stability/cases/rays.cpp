// SPDX-License-Identifier: Zlib
//
// Rays along axes, borders and corners, of no length, and none at all.

#include <demos/stability/cases/cases.hpp>

#include <demos/stability/ray_scene.hpp>

#include <array>

namespace hashphase::demos {
namespace {

const Lattice kSmall(0x1p-13);

// Directions of 0 and -0, beginnings and boxes at 0 and -0, in the boxes' faces and beside them: all
// combinations.
template <class Scalar>
void judgeSignsOfZero(CaseRun<Scalar>& run) {
    using Point = Vector3<Scalar>;
    const Scalar zero = 0;
    Boxes<Scalar> boxes;
    for (int i = 0; i < 27; ++i) {
        const Point low(static_cast<Scalar>(i % 3 - 1), static_cast<Scalar>(i / 3 % 3 - 1),
                        static_cast<Scalar>(i / 9 - 1));
        Aabb<Scalar> box(low, low + Point::Ones());
        for (int axis = 0; axis < 3; ++axis) {
            box.min()[axis] = box.min()[axis] == 0 && i % 2 == 0 ? -zero : box.min()[axis];
            box.max()[axis] = box.max()[axis] == 0 && i % 4 < 2 ? -zero : box.max()[axis];
        }
        boxes.push_back(box);
    }
    boxes.push_back(makeBox<Scalar>(0, -1, -1, -0.0, 1, 1));  // a plate
    boxes.push_back(makeBox<Scalar>(-0.0, 0, -0.0, 0, -0.0, 0));
    RayScene<Scalar> scene(run, boxes, {.cellSize = 1});
    const std::array<std::array<Scalar, 2>, 8> ways{{{zero, zero},
                                                     {zero, -zero},
                                                     {-zero, zero},
                                                     {-zero, -zero},
                                                     {-3, 3},
                                                     {3, -3},
                                                     {1, 1},
                                                     {-1, -1}}};
    for (std::size_t i = 0; i < 512; ++i) {
        const auto& [x, y, z] = std::array{ways[i % 8], ways[i / 8 % 8], ways[i / 64]};
        scene.judge({x[0], y[0], z[0]}, {x[1], y[1], z[1]}, kSmall);
    }
}

constexpr auto alongAxes = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    Boxes<Scalar> boxes = latticeBoxes<Scalar>(399, 24, run.seed);
    boxes.insert(boxes.begin(), {Point::Zero(), Point::Ones()});
    RayScene<Scalar> scene(run, boxes);
    scene.atEveryStage([&] {
        for (std::uint32_t i = 0; i < scene.boxes().size(); i += 8) {
            const Aabb<Scalar> box = scene.boxes()[i];
            for (int axis = 0; axis < 3; ++axis) {
                for (const Point& through : {box.min(), box.max(), Point(box.center())}) {
                    for (const Scalar away : {Scalar(30), Scalar(-30)}) {
                        Point from = through;
                        Point to = through;
                        from[axis] = -away;
                        to[axis] = away;
                        // Through a corner at 0, the difference is -0 on another axis.
                        Scalar& other = to[(axis + 1) % 3];
                        other = other == 0 ? -Scalar(0) : other;
                        scene.judge(from, to, kSmall);
                    }
                }
            }
        }
    });
    noteRaysThroughBullet(run);
    if (run.isOurs) {
        judgeSignsOfZero(run);
    }
};

// Boxes that a box just touches with a face, an edge or a corner, somewhere on its way or at its end:
// what is met is found, and rounding decides in some.
template <class Scalar>
void judgeGrazingBoxes(CaseRun<Scalar>& run) {
    using Point = Vector3<Scalar>;
    Random random(run.seed);
    constexpr int kRays = 15'000;
    int extra = 0;
    bool areAllFound = true;
    for (int i = 0; i < kRays; ++i) {
        const Scalar scale = std::array{1.0F, 1e3F, 1e6F, 1e9F}[static_cast<std::size_t>(i % 4)];
        const Lattice lattice(scale > 1e4F ? 0x1p-28 : 0x1p-44);
        const Point from = lattice.on<Scalar>(pointIn(random, -scale, scale));
        Point to = lattice.on<Scalar>(pointIn(random, -scale, scale));
        for (int axis = 0; axis < 3; ++axis) {
            to[axis] = random.unit() < 0.15F ? from[axis] : to[axis];
        }
        const Scalar fat = std::pow(Scalar(10), between<Scalar>(random, -3, 3));
        const Point half = lattice.on<Scalar>(fat * pointIn<Scalar>(random, 0, 1));
        const Scalar share = random.unit() < 0.3F ? Scalar(1) : between<Scalar>(random, 0, 1);
        const Point there = lattice.on<Scalar>(from + share * (to - from));
        const Point size = lattice.on<Scalar>(pointIn<Scalar>(random, 0, scale / 2));
        Aabb<Scalar> box(there - size, there + size);
        for (int axis = 0; axis < 3; ++axis) {
            const std::uint32_t side = indexBelow(random, 3);  // that just touches; 2: overlaps
            if (side == 0) {
                box.min()[axis] = there[axis] + half[axis];
                box.max()[axis] = box.min()[axis] + size[axis];
            } else if (side == 1) {
                box.max()[axis] = there[axis] - half[axis];
                box.min()[axis] = box.max()[axis] - size[axis];
            }
        }
        const Aabb<Scalar> fatness(-half, half);
        const bool isMet = lattice.meets(from, to, lattice.on<Scalar>(box), fatness);
        const Scalar key = RayRegion<Scalar>(from, to, fatness).key(lattice.on<Scalar>(box));
        areAllFound &= key <= 1 && (key >= 0 || !isMet);
        extra += key >= 0 && !isMet ? 1 : 0;
    }
    run.expect(areAllFound, "a thick ray meets all boxes that it grazes");
    run.expect(extra < kRays / 2,
               "fewer than half of the thick rays meet a box that they just miss");
}

constexpr auto alongBorders = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    constexpr int kSide = 8;
    RayScene<Scalar> scene(run, block<Scalar>(kSide), {.cellSize = 1});
    const Point ones = Point::Ones();
    const Scalar end = kSide + 1;
    const auto ask = [&](const Aabb<Scalar>& fatness) {
        const auto judge = [&](const Point& from, const Point& to) {
            scene.judge(from, to, kSmall, 0, fatness);
        };
        for (int k = 0; k <= kSide; ++k) {
            const auto at = static_cast<Scalar>(k);
            for (int axis = 0; axis < 3; ++axis) {
                Point from = Point::Constant(at);
                Point to = from;
                from[axis] = -1;
                to[axis] = end;
                judge(from, to);  // along an edge that four cubes share
                from[(axis + 1) % 3] = to[(axis + 1) % 3] = 0.5F;
                judge(from, to);  // in a face that two share
            }
        }
        judge(-ones, end * ones);  // through corners
        judge(end * ones, -ones);
        judge({-1, end, -1}, {end, -1, end});
        judge({-1, -1, 3}, {end, end, 3});  // through edges
        judge({0, 0, -1}, {kSide, kSide, 3});
    };
    scene.atEveryStage([&] {
        ask(pointBox<Scalar>());
        if (run.isOurs) {
            ask(makeBox<Scalar>(-0.5, 0, -0.25, 0.5, 0.125, 0.25));
        }
    });
    noteRaysThroughBullet(run);
    if (run.isOurs) {
        judgeGrazingBoxes(run);
    }
};

constexpr auto noLength = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    RayScene<Scalar> scene(run, latticeBoxes<Scalar>(200, 10, run.seed));
    const Aabb<Scalar> fatness = makeBox<Scalar>(-0.25, -0.25, -0.25, 0.25, 0.25, 0.25);
    scene.atEveryStage([&] {
        for (std::uint32_t i = 0; i < 200; i += 5) {
            const Aabb<Scalar> box = scene.boxes()[i];
            for (const Point& point : {box.min(), box.max(), Point(box.min() + box.sizes() / 2),
                                       Point(box.max() + Point::Constant(0.25F))}) {
                scene.judge(point, point,
                            [&](const Aabb<Scalar>& other) { return other.contains(point); });
                if (run.isOurs) {
                    scene.judge(point, point, kSmall, 0, fatness);
                }
            }
        }
    });
    noteRaysThroughBullet(run);
};

// --- None ----------------------------------------------------------------------------------------

/// Bad numbers in both ends and in what is moved along, while some wait to be filed.
template <class Scalar>
void judgeWorseRays(CaseRun<Scalar>& run, RayScene<Scalar>& scene, const Vector3<Scalar>& from,
                    const Vector3<Scalar>& to) {
    using Point = Vector3<Scalar>;
    constexpr std::uint32_t kWaiting = 20;
    const auto never = [](const Aabb<Scalar>& /*box*/) { return false; };
    for (std::uint32_t i = 0; i < kWaiting; ++i) {
        scene.pairs().move(i, scene.boxes()[i + kWaiting]);
    }
    const auto judge = [&](const Point& begin, const Point& end) {
        scene.judge(begin, end, never);
        run.expect(scene.cost().rowsVisited == 0 && scene.cost().boxesTested <= kWaiting,
                   "an invalid ray tests only boxes that moved since the last update");
    };
    for (const Scalar bad : {kNan<Scalar>, kInfinity<Scalar>, -kInfinity<Scalar>}) {
        for (int axis = 0; axis < 3; ++axis) {
            Point there = from;
            there[axis] = bad;
            judge(there, to);
            judge(to, there);
            judge(there, there);
        }
    }
    // Good numbers, but the way between them is none.
    const Point most = Point::Constant(std::numeric_limits<Scalar>::max());
    judge(-most, most);
    for (int field = 0; field < 6; ++field) {
        Aabb<Scalar> fatness = makeBox<Scalar>(-1, -1, -1, 1, 1, 1);
        (field < 3 ? fatness.min() : fatness.max())[field % 3] = kNan<Scalar>;
        NoteIndices<Scalar> found;
        const QueryCost cost =
            scene.pairs().grid()->visit(RayRegion<Scalar>(from, to, fatness), found);
        run.expect(found.found.empty() && cost.boxesTested <= scene.boxes().size() + kWaiting,
                   "a thick ray with NaN in its thickness meets nothing");
    }
}

constexpr auto noRay = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    const CountedMessages messages;
    RayScene<Scalar> scene(run, latticeBoxes<Scalar>(2000, 40, run.seed));
    const auto never = [](const Aabb<Scalar>& /*box*/) { return false; };
    const Point begin(-30, 1, 2);
    const Point end(30, -1, 3);
    scene.judge(begin, end, kSmall);
    const double normalWork = static_cast<double>(scene.cost().rowsVisited);
    double worst = 0;
    for (const Scalar bad : {kNan<Scalar>, kInfinity<Scalar>, -kInfinity<Scalar>}) {
        for (int axis = 0; axis < 3; ++axis) {
            Point from = begin;
            Point to = end;
            from[axis] = bad;
            scene.judge(from, to, never);
            worst = std::max(worst, static_cast<double>(scene.cost().rowsVisited));
            from[axis] = 0;
            to[axis] = bad;
            scene.judge(from, to, never);
            worst = std::max(worst, static_cast<double>(scene.cost().rowsVisited));
        }
    }
    if (scene.isOurs()) {
        run.addCost(worst / normalWork, 2.5);
        judgeWorseRays(run, scene, begin, end);
        run.note("Cost: blocks of boxes read, divided by the blocks that a valid ray reads.");
    }
    noteRaysThroughBullet(run);
};

constexpr HardCase kRayCases[] = {
    {"H13", "rays along an axis",
     "rays along x, y and z, in both directions, through the min corners, max corners and centres "
     "of 50 of 400 boxes; one box has a corner at 0; the other components of the direction are 0 "
     "and -0",
     "the boxes that the segment meets or touches", alongAxes},
    {"H14", "rays in faces, edges and corners",
     "512 cubes side by side, cells of 1 m; rays in shared faces, along shared edges and through "
     "shared corners; for hashphase also thick rays that graze boxes",
     "all cubes that the ray touches, on all sides", alongBorders},
    {"H15", "rays of length 0",
     "rays from a point to the same point: at corners of 40 of 200 boxes, inside these boxes, and "
     "next to them",
     "the boxes that contain the point", noLength},
    {"H19", "rays with NaN or infinity",
     "2,000 boxes; rays with NaN, infinity or -infinity in one component of the start or the end",
     "no hit, at no more than 2.5 times the cost of a valid ray", noRay},
};

}  // namespace

std::span<const HardCase> rayCases() {
    return kRayCases;
}

}  // namespace hashphase::demos
