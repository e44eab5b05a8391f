// SPDX-License-Identifier: Zlib
//
// Borders of cells, and numbers that are rounded on their way there.

#include <demos/stability/cases/cases.hpp>

#include <broadphase/pairs.hpp>
#include <demos/scenes/random.hpp>
#include <demos/stability/flush_to_zero.hpp>
#include <demos/stability/grid_scene.hpp>
#include <demos/stability/pair_scene.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

float below(float x) {
    return std::nextafter(x, -kInfinity);
}
float above(float x) {
    return std::nextafter(x, kInfinity);
}

// --- No extent ------------------------------------------------------------------------------------

CaseOutcome pointsAndPlates(const CaseContext& context) {
    Boxes boxes;
    const auto add = [&](Vector3<float> low, Vector3<float> high) {
        boxes.emplace_back(low, high);
    };
    for (const float at : {0.0F, 0.1F, 1.0F, -3.7F, 1e6F}) {
        const Vector3<float> point = Vector3<float>::Constant(at);
        for (int twice = 0; twice < 2; ++twice) {
            add(point, point);
            for (int axis = 0; axis < 3; ++axis) {
                Vector3<float> wide = Vector3<float>::Ones();
                wide[axis] = 0;
                add(point - wide, point + wide);  // a plate through the point
                add(point, point + wide);         // a plate with the point as its corner
                add(point - (Vector3<float>::Ones() - wide), point);  // a line that ends there
            }
        }
        add(point.array() + 1, point.array() + 2);  // a box that touches what reaches so far
    }
    CaseTally tally;
    judgePairs(context, tally, boxes);
    judgePairs(context, tally, boxes, {.cellSize = 1});
    return tally.outcome();
}

CaseOutcome signsOfZero(const CaseContext& context) {
    Boxes boxes;
    for (int signs = 0; signs < 64; ++signs) {
        const auto zero = [&](int bit) { return (signs >> bit & 1) != 0 ? -0.0F : 0.0F; };
        const Vector3<float> border(zero(0), zero(1), zero(2));
        const Vector3<float> other(zero(3), zero(4), zero(5));
        boxes.emplace_back(border, border + Vector3<float>::Ones());
        boxes.emplace_back(-Vector3<float>::Ones(), border);
        boxes.emplace_back(border, other);
    }
    CaseTally tally;
    PairScene scene(context, boxes, {.cellSize = 1});
    scene.judge(tally);
    // The sign of a border changes, and no pair with it.
    for (std::uint32_t i = 0; i < scene.size(); i += 2) {
        scene.move(i, {-boxes[i].max(), -boxes[i].min()});
    }
    scene.judge(tally);
    return tally.outcome();
}

// --- Borders --------------------------------------------------------------------------------------

// At the border k * cell, boxes that touch, overlap by an ulp, and miss each other by one on either
// side, and boxes of a cell from border to border that touch; each pair in a lane of its own.
void addBoxesAtBorder(Boxes& boxes, int k, int axis, float cell) {
    const auto border = [&](int number) { return static_cast<float>(number) * cell; };
    const auto add = [&](int lane, float from, float to) {
        Vector3<float> low = Vector3<float>::Constant(3 * cell * static_cast<float>(lane));
        Vector3<float> high = low + Vector3<float>::Constant(cell / 2);
        low[axis] = from;
        high[axis] = to;
        boxes.emplace_back(low, high);
    };
    const float x = border(k);
    const std::array<std::array<float, 2>, 4> ends{
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
Boxes boxesAtBorders(float cell, int axis, int firstBorder, int lastBorder) {
    Boxes boxes;
    addBoxesAtBorder(boxes, 0, axis, cell);
    for (int k = firstBorder; k <= lastBorder; ++k) {
        addBoxesAtBorder(boxes, k, axis, cell);
        addBoxesAtBorder(boxes, -k, axis, cell);
    }
    Vector3<float> aside = Vector3<float>::Constant(-3 * cell);
    aside[axis] = 0;
    boxes.emplace_back(aside, aside + Vector3<float>::Constant(cell / 2));
    return boxes;
}

// Every box stands apart from all but the other one of its pair.
void judgePairs(const CaseContext& context, CaseTally& tally, const Boxes& boxes, float cell) {
    PairScene scene(context, boxes, {.cellSize = static_cast<double>(cell)});
    scene.findPairs();
    std::vector<PairKey> exact;
    for (std::uint32_t i = 0; i + 1 < scene.size(); i += 2) {
        if (overlaps(boxes[i], boxes[i + 1])) {
            exact.push_back(pairKey(i, i + 1));
        }
    }
    tally.compare(scene.reported(), exact);
}

CaseOutcome multiplesOfTheCell(const CaseContext& context) {
    // Only ours has cells. The others are asked about some of the same boxes.
    const int step = context.kind.ours ? context.quickOrFull(50, 1) : context.quickOrFull(250, 125);
    const int borders = context.kind.ours ? 1000 : context.quickOrFull(100, 200);
    // Of more boxes than 2,047, not all count for the median.
    constexpr int kBordersAtOnce = 100;
    CaseTally tally;
    int sizes = 0;
    for (int tenths = 1; tenths <= 1000; tenths += step) {
        const float cell = 0.1F * static_cast<float>(tenths);
        for (int first = 1; first < borders; first += kBordersAtOnce) {
            const int last = std::min(first + kBordersAtOnce, borders) - 1;
            const int axis = (tenths + first / kBordersAtOnce) % 3;
            judgePairs(context, tally, boxesAtBorders(cell, axis, first, last), cell);
        }
        ++sizes;
    }
    tally.note(std::to_string(borders) + " borders of each sign for " + std::to_string(sizes) +
               " cell sizes.");
    return tally.outcome();
}

CaseOutcome cornersOfCells(const CaseContext& context) {
    Boxes boxes;
    constexpr float kCell = 0.7F;
    for (const int k : {-1000, -7, -1, 0, 1, 3, 10, 999}) {
        const Vector3<float> corner = Vector3<float>::Constant(static_cast<float>(k) * kCell);
        for (int octant = 0; octant < 8; ++octant) {
            const Vector3<float> away((octant & 1) != 0 ? 0.5F : -0.5F,
                                      (octant & 2) != 0 ? 0.5F : -0.5F,
                                      (octant & 4) != 0 ? 0.5F : -0.5F);
            const Vector3<float> far = corner + away;
            boxes.emplace_back(corner.cwiseMin(far), corner.cwiseMax(far));
        }
    }
    CaseTally tally;
    judgePairs(context, tally, boxes, {.cellSize = static_cast<double>(kCell)});
    judgePairs(context, tally, boxes);
    return tally.outcome();
}

// --- Denormal numbers -----------------------------------------------------------------------------

// Boxes of which all coordinates are denormal, and some that are not.
Boxes denormalBoxes() {
    Boxes boxes;
    for (int i = 0; i < 60; ++i) {
        const float at = 1e-40F * static_cast<float>(i % 20);
        const Vector3<float> low(at, i < 30 ? 0.0F : -at, 0);
        boxes.emplace_back(low, low + Vector3<float>::Constant(1.5e-40F));
        boxes.emplace_back(Vector3<float>(1e-20F * static_cast<float>(i), 0, 0),
                           Vector3<float>(1e-20F * static_cast<float>(i + 1), at, 1));
    }
    return boxes;
}

CaseOutcome denormalNumbers(const CaseContext& context) {
    CaseTally tally;
    for (const bool flushes : {false, true}) {
        // What is compared, and by whom, goes by the same rules.
        const FlushToZero flush(flushes);
        judgePairs(context, tally, denormalBoxes(), {.cellSize = 1e-30});
        judgePairs(context, tally, denormalBoxes());
    }
    // Where no comparison is between two denormal numbers, the pairs are the same.
    Boxes apart;
    for (int i = 0; i < 50; ++i) {
        const float at = static_cast<float>(i) * 0x1p-100F;
        apart.emplace_back(Vector3<float>(at, -1e-40F, 0),
                           Vector3<float>(at + 0x1p-100F, 1e-40F, 1));
    }
    std::array<std::vector<PairKey>, 2> found;
    for (const bool flushes : {false, true}) {
        const FlushToZero flush(flushes);
        PairScene scene(context, apart);
        scene.judge(tally);
        found[flushes ? 1 : 0] = scene.reported();
    }
    tally.compare(found[1], found[0]);
    if (context.kind.ours) {
        tally.expect(!configError({.cellSize = 1e-38}).empty(), "cells of 1e-38 m are refused");
    }
    if (!FlushToZero::isAvailable()) {
        tally.note("This processor cannot flush to zero.");
    }
    return tally.outcome();
}

// --- Far from the origin --------------------------------------------------------------------------

Aabb<float> roundedOutward(const Aabb<double>& box) {
    Aabb<float> rounded = box.cast<float>();
    for (int axis = 0; axis < 3; ++axis) {
        if (static_cast<double>(rounded.min()[axis]) > box.min()[axis]) {
            rounded.min()[axis] = below(rounded.min()[axis]);
        }
        if (static_cast<double>(rounded.max()[axis]) < box.max()[axis]) {
            rounded.max()[axis] = above(rounded.max()[axis]);
        }
    }
    return rounded;
}

CaseOutcome unitBoxesFarOut(const CaseContext& context) {
    CaseTally tally;
    std::uint64_t beyondTruth = 0;
    for (const double far : {0x1p24, 1e7, 5e7, 1e8, 1e9}) {
        std::vector<Aabb<double>> boxes;
        Random random(context.seed);
        for (int i = 0; i < 150; ++i) {
            const auto at = [&] { return far + 8 * static_cast<double>(random.unit()); };
            const Vector3<double> low(at(), at(), -at());
            boxes.emplace_back(low, low + Vector3<double>::Ones());
        }
        Boxes rounded;
        for (const Aabb<double>& box : boxes) {
            rounded.push_back(roundedOutward(box));
        }
        PairScene scene(context, rounded);
        scene.judge(tally);
        std::vector<PairKey> truth;
        for (std::uint32_t a = 0; a < boxes.size(); ++a) {
            for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
                if (overlaps(boxes[a], boxes[b])) {
                    truth.push_back(pairKey(a, b));
                }
            }
        }
        CaseTally inDouble;
        inDouble.compare(scene.reported(), truth);
        tally.expect(inDouble.outcome().missing == 0, "no pair of the boxes in double is lost");
        beyondTruth += inDouble.outcome().extra;
        if (context.kind.ours) {
            tally.compare(gridPairs<double>(boxes), truth);
        }
    }
    tally.note("Rounding outward adds " + std::to_string(beyondTruth) +
               " pairs to those of the boxes in double precision" +
               (context.kind.ours ? "; Grid<double> has exactly the latter." : "."));
    return tally.outcome();
}

CaseOutcome shiftedScene(const CaseContext& context) {
    // Multiples of 1/8 m stay themselves at 2^20 m, and multiples of 128 m at 2^30 m.
    const auto scene = [&](double unit, double shift) {
        std::vector<Aabb<double>> boxes;
        Random random(context.seed);
        for (int i = 0; i < 200; ++i) {
            const auto at = [&] { return shift + unit * std::floor(random.between(-40, 40)); };
            const Vector3<double> low(at(), at(), at());
            boxes.emplace_back(
                low, low + Vector3<double>::Constant(unit * std::floor(random.between(1, 16))));
        }
        return boxes;
    };
    const auto inSingle = [](const std::vector<Aabb<double>>& boxes) {
        Boxes single;
        for (const Aabb<double>& box : boxes) {
            single.push_back(box.cast<float>());
        }
        return single;
    };
    CaseTally tally;
    const auto judgeShift = [&](double unit, double shift) {
        PairScene here(context, inSingle(scene(unit, 0)));
        PairScene there(context, inSingle(scene(unit, shift)));
        here.judge(tally);
        there.judge(tally);
        tally.compare(there.reported(), here.exact());
    };
    judgeShift(0.125, 0x1p20);
    judgeShift(128, 0x1p30);
    if (context.kind.ours) {
        tally.compare(gridPairs<double>(scene(0.125, 0x1p30)), gridPairs<double>(scene(0.125, 0)));
    }
    return tally.outcome();
}

constexpr std::array kBorderCases{
    HardCase{"H6", "points, plates and lines",
             "boxes without extent on three, one and two axes, each twice, at the same places, and "
             "boxes that touch them",
             "closed boxes: what touches pairs", pointsAndPlates},
    HardCase{"H7", "-0 and +0 as a border",
             "boxes that end or begin at 0, in all 64 combinations of signs; then mirrored",
             "-0 is +0: the same pairs, whatever the signs", signsOfZero},
    HardCase{
        "H8", "multiples of the cell size",
        "for cells of 0.1, 0.2 ... 100 m (ours; some of them for the others, which have no "
        "cells), at x = fl(k * cell), k = 0 ... 999 and the negatives, boxes that touch, overlap "
        "by an ulp, miss by an ulp on either side, and boxes from one border to the next, along "
        "one axis after the other; cells begin at 0",
        "exact pairs on both sides of every border", multiplesOfTheCell},
    HardCase{"H9", "eight boxes at a cell's corner",
             "eight boxes that touch in the corner (k, k, k) of cells of 0.7 m, k = -1000 ... 999",
             "each of the 28 pairs once", cornersOfCells},
    HardCase{
        "H10", "denormal numbers",
        "boxes of 1.5e-40 m and such as differ in denormal digits; cells of 1e-30 m; the "
        "processor set to flush denormals to zero (FTZ, DAZ), and not",
        "pairs as comparing says under the same setting, and the same ones where no two denormal "
        "numbers are compared; smaller cells are refused",
        denormalNumbers},
    HardCase{
        "H11", "unit boxes 2^24 to 1e9 m away",
        "150 boxes of 1 m at 2^24, 1e7, 5e7, 1e8, 1e9 m in double precision, rounded outward to "
        "single",
        "exact pairs of the rounded boxes, so none of the true ones is lost; in double "
        "precision exactly those",
        unitBoxesFarOut},
    HardCase{"H12", "a scene at 0, 2^20 and 2^30 m",
             "200 boxes on multiples of 1/8 m shifted by 2^20 m, of 128 m by 2^30 m; in double "
             "precision of 1/8 m by 2^30 m",
             "identical pairs", shiftedScene},
};

}  // namespace

std::span<const HardCase> borderCases() {
    return kBorderCases;
}

}  // namespace hashphase::demos
