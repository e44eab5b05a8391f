// SPDX-License-Identifier: Zlib
//
// Coordinates that are no numbers, or too large for a cell.

#include <demos/stability/cases/cases.hpp>

#include <array>
#include <cmath>

namespace hashphase::demos {
namespace {

/// Some that touch each other, for the strange ones to stand among.
template <class Scalar>
Boxes<Scalar> ordinaryBoxes(const CaseRun<Scalar>& run) {
    return scatteredCubes<Scalar>(60, 8, 0.5F, 1.5F, run.seed);
}

/// A unit box at the origin, but for one axis.
template <class Scalar>
Aabb<Scalar> along(int axis, Scalar low, Scalar high) {
    Aabb<Scalar> box = makeBox<Scalar>(0, 0, 0, 1, 1, 1);
    box.min()[axis] = low;
    box.max()[axis] = high;
    return box;
}

constexpr auto hugeCoordinates = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    const CountedMessages messages;
    Boxes<Scalar> boxes = ordinaryBoxes(run);
    for (const Scalar far : {Scalar(3e9F), Scalar(-3e9F), Scalar(1e18F), Scalar(-1e18F),
                             kInfinity<Scalar>, -kInfinity<Scalar>, kNan<Scalar>}) {
        for (int axis = 0; axis < 3; ++axis) {
            Point low = Point::Zero();
            low[axis] = far;
            boxes.emplace_back(low, low + Point::Ones());  // beyond on one axis
            boxes.emplace_back(Point::Constant(-1).cwiseMin(low),
                               Point::Ones().cwiseMax(low));  // from here to there
        }
        boxes.push_back(cubeAt(Point(Point::Constant(far)), 1));
    }
    judgePairs(run, boxes, {1, 0});
    if (!run.isOurs) {
        return;
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (const Scalar far : {Scalar(3e9), Scalar(1e18), std::numeric_limits<Scalar>::max(),
                                 kInfinity<Scalar>, kNan<Scalar>}) {
            for (const Scalar x : {far, -far}) {
                boxes.push_back(along<Scalar>(axis, x, x));
                boxes.push_back(along<Scalar>(axis, x - 1, x + 1));
                boxes.push_back(
                    along<Scalar>(axis, std::min<Scalar>(x, 0), std::max<Scalar>(x, 0)));
            }
            boxes.push_back(along<Scalar>(axis, -far, far));
        }
    }
    judgePairs(run, boxes, {1, 0, 1e-30, 1e30});
    PairScene<Scalar> scene(run, boxes, {.cellSize = 1});
    for (const Aabb<Scalar>& box : boxes) {
        scene.judgeQuery(BoxRegion<Scalar>{box});
    }
};

// --- Planes without end ---------------------------------------------------------------------------

/// Boxes in motion, with or without a plane that all of them touch.
template <class Scalar>
class PlaneWorld {
public:
    PlaneWorld(CaseRun<Scalar>& run, std::size_t count, bool hasPlane, double cellSize = 0)
        : hasPlane_(hasPlane),
          boxes_(scatteredCubes<Scalar>(count, 60, 0.5F, 1.5F, run.seed)),
          scene(run, withPlane(), {.cellSize = cellSize}, worldOf<Scalar>(boxes_)) {}

    void frame() {
        shift_ = shift_ > 0 ? Scalar(-0.25) : Scalar(0.25);
        for (Aabb<Scalar>& box : boxes_) {
            box.translate(Vector3<Scalar>(shift_, 0, 0));
        }
        scene.moveAll(withPlane());
        scene.findPairs();
    }
    [[nodiscard]] double work() const { return static_cast<double>(scene.cost().boxesTested); }

private:
    [[nodiscard]] Boxes<Scalar> withPlane() const {
        Boxes<Scalar> all = boxes_;
        if (hasPlane_) {
            const Scalar end = std::is_same_v<Scalar, float> ? Scalar(1e18F) : Scalar(1e30);
            all.push_back({Vector3<Scalar>::Constant(-end), Vector3<Scalar>::Constant(end)});
        }
        return all;
    }

    bool hasPlane_;
    Scalar shift_ = 0;
    Boxes<Scalar> boxes_;

public:
    PairScene<Scalar> scene;
};

constexpr auto endlessPlane = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    const std::size_t count = run.template quickOrFull<std::size_t>(500, 2000);
    PlaneWorld<Scalar> with(run, count, true);
    PlaneWorld<Scalar> without(run, count, false);
    // That a box still touches the plane is one test; that is all that the plane may add.
    const auto addWork = [&run, count](const PlaneWorld<Scalar>& more,
                                       const PlaneWorld<Scalar>& less) {
        const double added = more.work() - less.work() - static_cast<double>(count);
        run.addCost(1 + std::max(0.0, added) / less.work(), 1.05);
    };
    with.scene.judge();
    without.scene.judge();
    for (int i = 0; i < 4; ++i) {
        with.frame();
        without.frame();
    }
    with.scene.judge();
    const auto time = [](PlaneWorld<Scalar>& world) {
        return shortestTime(5, [&] { world.frame(); });
    };
    const double ratio = time(with) / time(without);
    if (with.scene.grid() == nullptr) {
        run.addCost(ratio, 3);
        run.note("Cost: time of a frame with the plane, divided by the time without the plane.");
        return;
    }
    addWork(with, without);
    run.note(
        "Cost: boxes tested in a frame with the plane (minus one for each pair with the plane), "
        "divided by the boxes tested without the plane. With the plane, a frame takes " +
        rounded(ratio, 1) + " times as long.");
    for (const double cellSize : {0.0, 1.0}) {
        PlaneWorld<Scalar> first(run, count, true, cellSize);
        PlaneWorld<Scalar> alone(run, count, false, cellSize);
        first.scene.judge();
        alone.scene.judge();
        run.expect(first.scene.cost().grid.filed == count + 1, "the plane is stored once");
        addWork(first, alone);
    }
};

// --- NaN ------------------------------------------------------------------------------------------

// Handed over field by field: Eigen's boxes are built from corners.
template <class Scalar>
Aabb<Scalar> withNan(Aabb<Scalar> box, int field) {
    (field < 3 ? box.min() : box.max())[field % 3] = kNan<Scalar>;
    return box;
}

constexpr auto nanInOneField = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    for (int field = 0; field < 6; ++field) {
        const CountedMessages messages;
        Boxes<Scalar> boxes = ordinaryBoxes(run);
        boxes[7] = withNan(boxes[7], field);
        PairScene<Scalar> scene(run, boxes);
        scene.judge();
        // The others live on, and one more becomes NaN and good again.
        for (int frame = 0; frame < 6; ++frame) {
            const Scalar by = Scalar(0.2F) * static_cast<Scalar>(frame);
            for (std::uint32_t i = 20; i < 40; ++i) {
                scene.move(i, boxes[i].translated(Vector3<Scalar>(by, 0, 0)));
            }
            scene.move(3, frame == 2 ? withNan(boxes[3], field) : boxes[3]);
            scene.judge();
        }
        if (scene.grid() != nullptr) {
            run.expect(scene.grid()->nanCount() == 1, "the grid counts the boxes with NaN");
            run.expect(messages.count() == 1, "NaN is reported once");
        }
    }
};

// --- Boxes inside out -----------------------------------------------------------------------------

constexpr auto invertedBoxes = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    Boxes<Scalar> boxes = ordinaryBoxes(run);
    const Scalar most = std::numeric_limits<Scalar>::max();
    for (int axes = 1; axes < 8; ++axes) {
        Point low(-1, -1, -1);
        Point high(1, 1, 1);
        for (int axis = 0; axis < 3; ++axis) {
            if ((axes >> axis & 1) != 0) {
                std::swap(low[axis], high[axis]);
            }
        }
        boxes.emplace_back(low, high);
        boxes.emplace_back(50 * low, 50 * high);
    }
    for (const Scalar end : {most, kInfinity<Scalar>}) {
        boxes.emplace_back(Point::Constant(end), Point::Constant(-end));
    }
    PairScene<Scalar> scene(run, boxes, {}, worldOf<Scalar>(ordinaryBoxes(run)));
    scene.judge();
    for (std::uint32_t i = 0; i < 30; ++i) {
        scene.move(i, boxes[i].translated(Point(0.3F, 0, 0)));
    }
    scene.judge();
    if (!run.isOurs) {
        return;
    }
    // Many, sorted along an axis, share a cell, where some end before they begin.
    for (int i = 0; i < 400; ++i) {
        boxes.push_back(makeBox<Scalar>(0.1 * i, 0, 0, 0.1 * i + 0.05, 3, 3));
    }
    for (int i = 0; i < 40; ++i) {
        boxes.push_back(makeBox<Scalar>(2, 2, 2, 1, 1, 1));
        boxes.push_back(makeBox<Scalar>(i, 0, 0, i + 1, 3, 3));
    }
    boxes.push_back(makeBox<Scalar>(30, 0, 0, 10, 1, 1));
    boxes.push_back(makeBox<Scalar>(10, 0, 0, 9.97, 1, 1));
    judgePairs(run, boxes, {0, 1, 100});
};

// --- Cell numbers ---------------------------------------------------------------------------------

/// Cells have numbers beyond those of 32 bits, up to the last that there is.
template <class Scalar>
void expectCellsBeyond32Bits(CaseRun<Scalar>& run) {
    Grid<Scalar> grid({.cellSize = 1});
    for (const double x : {0x1p31, -0x1p31, 0x1p40, -0x1p40}) {
        const auto cell = static_cast<std::int64_t>(x);
        const CellRange cells = grid.cellsOf(
            grid.add(along<Scalar>(2, static_cast<Scalar>(x), static_cast<Scalar>(x))));
        NoteIndices<Scalar> found;
        grid.visitCell({0, 0, cell}, found);
        run.expect(cells.lowest[2] == cell && cells.highest[2] == cell && found.found.size() == 1,
                   "cell indices can exceed 32 bits");
    }
    constexpr std::int64_t kLast = 9'000'000'000'000'000'000;
    run.expect(grid.cellAt(Vector3<Scalar>(Scalar(1e30), Scalar(-1e30), 0)) ==
                   std::array<std::int64_t, 3>{kLast, -kLast, 0},
               "cell indices end at +-9e18");
}

constexpr auto largeCellIndices = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    const auto cornerAt = [](int corner, Scalar far) {
        return Point((corner & 1) != 0 ? far : -far, (corner & 2) != 0 ? far : -far,
                     (corner & 4) != 0 ? far : -far);
    };
    for (const Scalar far : {0x1p31F, 0x1p32F, 0x1p62F, 0x1p64F}) {
        Boxes<Scalar> boxes = ordinaryBoxes(run);
        const Scalar ulp = far * std::numeric_limits<Scalar>::epsilon();
        for (int corner = 0; corner < 8; ++corner) {
            for (const Scalar aside : {-ulp, Scalar(0), ulp, 2 * ulp}) {
                const Point low = cornerAt(corner, far) + Point::Constant(aside);
                boxes.emplace_back(low, low + Point::Constant(ulp));
            }
        }
        judgePairs(run, boxes, {1});
    }
    if (!run.isOurs) {
        return;
    }
    Boxes<Scalar> boxes;
    for (int corner = 0; corner < 8; ++corner) {
        addBlock(boxes, (cornerAt(corner, 0x1p31F).template cast<double>().array() - 2).matrix());
    }
    addBlock(boxes, {0, 0, 0});
    judgePairs(run, boxes, {1, 0, 0.25});
    expectCellsBeyond32Bits(run);
};

constexpr HardCase kNumberCases[] = {
    {"H1", "huge, infinite and NaN coordinates",
     "60 boxes around the origin; boxes that lie at or extend to +-3e9, +-1e18, +-infinity and "
     "NaN, on one axis or on all axes; cells of 1 m, and of automatic size",
     "exact pairs, by comparing the coordinates; no conversion overflows", hugeCoordinates},
    {"H2", "a plane of 1e18 m",
     "a box as of btStaticPlaneShape, from -1e18 to 1e18 m on all axes (in double precision 1e30 "
     "m), around 2,000 boxes that all move (--quick: 500)",
     "one pair of the plane with each box; the plane costs no more than these pairs", endlessPlane},
    {"H3", "NaN in one field of a box",
     "60 boxes; one box has NaN in one of its six fields (x, y, z of min and max); in six frames, "
     "other boxes move, and in one of these frames a second box has NaN",
     "a box with NaN is in no pair; it is counted, and reported once; all other pairs are exact",
     nanInOneField},
    {"H5", "boxes with min > max",
     "60 boxes; small and large boxes with min > max on one, two or three axes; empty boxes, from "
     "FLT_MAX to -FLT_MAX and from infinity to -infinity",
     "exact pairs, by comparing the coordinates as Bullet's own overlap test does", invertedBoxes},
    {"H30", "cell indices beyond 2^31",
     "cells of 1 m; boxes of 1 to 2 ulp at the points (+-x, +-x, +-x) for x = 2^31, 2^32, 2^62 and "
     "2^64",
     "exact pairs; no product overflows", largeCellIndices},
};

}  // namespace

std::span<const HardCase> numberCases() {
    return kNumberCases;
}

}  // namespace hashphase::demos
