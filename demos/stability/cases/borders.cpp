// SPDX-License-Identifier: Zlib
//
// Borders of cells, and what has no extent.

#include <demos/stability/cases/cases.hpp>

#include <array>

namespace hashphase::demos {
namespace {

// --- No extent ------------------------------------------------------------------------------------

constexpr auto pointsAndPlates = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    Boxes<Scalar> boxes;
    const auto add = [&](const Point& low, const Point& high) { boxes.emplace_back(low, high); };
    for (const Scalar at : {Scalar(0), Scalar(0.1F), Scalar(1), Scalar(-3.7F), Scalar(1e6F)}) {
        const Point point = Point::Constant(at);
        for (int twice = 0; twice < 2; ++twice) {
            add(point, point);
            for (int axis = 0; axis < 3; ++axis) {
                Point wide = Point::Ones();
                wide[axis] = 0;
                add(point - wide, point + wide);             // a plate through the point
                add(point, point + wide);                    // a plate with the point as its corner
                add(point - (Point::Ones() - wide), point);  // a line that ends there
            }
        }
        add(point.array() + 1, point.array() + 2);  // a box that touches what reaches so far
    }
    judgePairs(run, boxes, {0, 1});
    if (run.isOurs) {
        // More than a cell is searched for unsorted.
        for (const Scalar at : {Scalar(0), Scalar(0.1), Scalar(-3.7), Scalar(1e6)}) {
            boxes.insert(boxes.end(), 40, {Point::Constant(at), Point::Constant(at)});
        }
        judgePairs(run, boxes, {0, 0.1, 1, 100});
    }
};

constexpr auto signsOfZero = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    Boxes<Scalar> boxes;
    for (int signs = 0; signs < 64; ++signs) {
        const auto zero = [&](int bit) { return (signs >> bit & 1) != 0 ? -Scalar(0) : Scalar(0); };
        const Point border(zero(0), zero(1), zero(2));
        const Point other(zero(3), zero(4), zero(5));
        boxes.emplace_back(border, border + Point::Ones());
        boxes.emplace_back(-Point::Ones(), border);
        boxes.emplace_back(border, other);
    }
    PairScene<Scalar> scene(run, boxes, {.cellSize = 1});
    scene.judge();
    // The sign of a border changes, and no pair with it.
    for (std::uint32_t i = 0; i < scene.size(); i += 2) {
        scene.move(i, {-boxes[i].max(), -boxes[i].min()});
    }
    scene.judge();
    if (run.isOurs) {
        judgePairs(run, boxes, {0, 0.3, 100});
    }
};

// --- Borders --------------------------------------------------------------------------------------

// At the border k * cell, boxes that touch, overlap by an ulp, and miss each other by one on either
// side, and boxes of a cell from border to border that touch; each pair in a lane of its own.
template <class Scalar>
void addBoxesAtBorder(Boxes<Scalar>& boxes, int k, int axis, Scalar cell) {
    const auto border = [&](int number) { return static_cast<Scalar>(number) * cell; };
    const auto add = [&](int lane, Scalar from, Scalar to) {
        Vector3<Scalar> low = Vector3<Scalar>::Constant(3 * cell * static_cast<Scalar>(lane));
        Vector3<Scalar> high = low + Vector3<Scalar>::Constant(cell / 2);
        low[axis] = from;
        high[axis] = to;
        boxes.emplace_back(low, high);
    };
    const Scalar x = border(k);
    const std::array<std::array<Scalar, 2>, 4> ends{
        {{x, x}, {above(x), x}, {below(x), x}, {x, above(x)}}};
    for (int lane = 0; lane < 4; ++lane) {
        const auto [end, begin] = ends[static_cast<std::size_t>(lane)];
        add(lane, end - cell / 4, end);
        add(lane, begin, begin + cell / 4);
    }
    const int laneOfItsOwn = 4 + (k % 3 + 3) % 3;
    add(laneOfItsOwn, border(k - 1), x);
    add(laneOfItsOwn, x, border(k + 1));
}

// At the borders 0, k * cell and -k * cell. Cells are counted from the median of where boxes begin,
// which is made 0: half of them begin below, and one more there.
template <class Scalar>
Boxes<Scalar> boxesAtBorders(Scalar cell, int axis, int firstBorder, int lastBorder) {
    Boxes<Scalar> boxes;
    addBoxesAtBorder(boxes, 0, axis, cell);
    for (int k = firstBorder; k <= lastBorder; ++k) {
        addBoxesAtBorder(boxes, k, axis, cell);
        addBoxesAtBorder(boxes, -k, axis, cell);
    }
    Vector3<Scalar> aside = Vector3<Scalar>::Constant(-3 * cell);
    aside[axis] = 0;
    boxes.emplace_back(aside, aside + Vector3<Scalar>::Constant(cell / 2));
    return boxes;
}

// Every box stands apart from all but the other one of its pair.
template <class Scalar>
void judgeBorders(CaseRun<Scalar>& run, const Boxes<Scalar>& boxes, Scalar cell) {
    PairScene<Scalar> scene(run, boxes, {.cellSize = static_cast<double>(cell)});
    scene.findPairs();
    Keys exact;
    for (std::uint32_t i = 0; i + 1 < scene.size(); i += 2) {
        if (doTouch(boxes[i], boxes[i + 1])) {
            exact.push_back(pairKey(i, i + 1));
        }
    }
    run.compare(scene.reported(), exact);
}

constexpr auto multiplesOfTheCell = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    // Only ours has cells. The others are asked about some of the same boxes.
    const int step = run.isOurs ? run.quickOrFull(20, 1) : run.quickOrFull(250, 125);
    const int borders = run.isOurs ? 1000 : run.quickOrFull(100, 200);
    // Of more boxes than 2,047, not all count for the median.
    constexpr int kBordersAtOnce = 100;
    int sizes = 0;
    for (int tenths = 1; tenths <= 1000; tenths += step) {
        const Scalar cell = Scalar(0.1F) * static_cast<Scalar>(tenths);
        for (int first = 1; first < borders; first += kBordersAtOnce) {
            const int last = std::min(first + kBordersAtOnce, borders) - 1;
            const int axis = (tenths + first / kBordersAtOnce) % 3;
            judgeBorders(run, boxesAtBorders(cell, axis, first, last), cell);
        }
        ++sizes;
    }
    run.note(std::to_string(sizes) + " cell sizes, with " + std::to_string(borders - 1) +
             " borders in each direction.");
};

constexpr auto cornersOfCells = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    Boxes<Scalar> boxes;
    const Scalar cell = 0.7F;
    for (const int k : {-1000, -7, -1, 0, 1, 3, 10, 999}) {
        const Point corner = Point::Constant(static_cast<Scalar>(k) * cell);
        for (int octant = 0; octant < 8; ++octant) {
            const Point away((octant & 1) != 0 ? 0.5F : -0.5F, (octant & 2) != 0 ? 0.5F : -0.5F,
                             (octant & 4) != 0 ? 0.5F : -0.5F);
            const Point far = corner + away;
            boxes.emplace_back(corner.cwiseMin(far), corner.cwiseMax(far));
        }
    }
    judgePairs(run, boxes, {static_cast<double>(cell), 0});
    if (!run.isOurs) {
        return;
    }
    // Each of 27 corners of 8 cells is touched by 8 boxes of a cell.
    for (const double size : {1.0, 0.1, 0.7}) {
        for (const double first : {-2.0, 97.0, -100'001.0}) {
            Boxes<Scalar> block;
            addBlock(block, Vector3<double>::Constant(first), size);
            judgePairs(run, block, {size});
        }
    }
};

constexpr HardCase kBorderCases[] = {
    {"H6", "points, plates and lines",
     "boxes of size 0 on three, two or one axes (points, lines and plates), each twice at the same "
     "place, and boxes that touch them",
     "boxes are closed: two boxes that touch are a pair", pointsAndPlates},
    {"H7", "-0 and +0 as coordinates",
     "boxes that end or begin at 0, with all 64 combinations of +0 and -0; then every second box "
     "is mirrored at the origin",
     "-0 equals +0: no sign of a zero changes a pair", signsOfZero},
    {"H8", "multiples of the cell size",
     "cells of 0.1, 0.2 ... 100 m (--quick: every 20th size); at the borders x = k * cell, "
     "rounded, k = -999 ... 999, along one axis after the other, boxes that touch, overlap by an "
     "ulp, or miss by an ulp on either side, and boxes from one border to the next; cells begin at "
     "0; Bullet's broadphases, which have no cells, get some of these boxes",
     "exact pairs on both sides of every border", multiplesOfTheCell},
    {"H9", "eight boxes at a cell's corner",
     "eight boxes that touch at the corner (k, k, k) of cells of 0.7 m, for eight values of k from "
     "-1000 to 999",
     "each of the 28 pairs at a corner once", cornersOfCells},
};

}  // namespace

std::span<const HardCase> borderCases() {
    return kBorderCases;
}

}  // namespace hashphase::demos
