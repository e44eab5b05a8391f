// SPDX-License-Identifier: Zlib
//
// Numbers that are rounded, or flushed: denormal ones, and those far from the origin.

#include <demos/stability/cases/cases.hpp>

#include <demos/stability/flush_to_zero.hpp>
#include <demos/stability/run_together.hpp>

#include <array>

namespace hashphase::demos {
namespace {

// --- Denormal numbers -----------------------------------------------------------------------------

// Boxes of which all coordinates are denormal, and some that are not.
template <class Scalar>
Boxes<Scalar> denormalBoxes() {
    using Point = Vector3<Scalar>;
    const Scalar unit = std::is_same_v<Scalar, float> ? Scalar(1e-40F) : Scalar(1e-310);
    Boxes<Scalar> boxes;
    for (int i = 0; i < 60; ++i) {
        const Scalar at = unit * static_cast<Scalar>(i % 20);
        const Point low(at, i < 30 ? Scalar(0) : -at, 0);
        boxes.emplace_back(low, low + Point::Constant(unit * Scalar(1.5F)));
        boxes.emplace_back(Point(Scalar(1e-20F) * static_cast<Scalar>(i), 0, 0),
                           Point(Scalar(1e-20F) * static_cast<Scalar>(i + 1), at, 1));
    }
    return boxes;
}

/// Of numbers that are not denormal, and of any size; many boxes end where others begin.
template <class Scalar>
Boxes<Scalar> boxesOfNormalNumbers(std::uint64_t seed) {
    Random random(seed);
    const double least = static_cast<double>(std::numeric_limits<Scalar>::min());
    std::vector<Scalar> numbers{0};
    while (numbers.size() < 60) {
        const double size =
            numbers.size() % 5 == 0
                ? least * (1 + 2 * static_cast<double>(random.unit()))
                : least * std::pow(1e29 / least, static_cast<double>(random.unit()));
        numbers.push_back(static_cast<Scalar>(numbers.size() % 2 == 0 ? size : -size));
    }
    Boxes<Scalar> boxes(300);
    for (Aabb<Scalar>& box : boxes) {
        for (int axis = 0; axis < 3; ++axis) {
            const Scalar a = numbers[indexBelow(random, 60)];
            const Scalar b = random.unit() < 0.3F ? a : numbers[indexBelow(random, 60)];
            box.min()[axis] = std::min(a, b);
            box.max()[axis] = std::max(a, b);
        }
    }
    return boxes;
}

/// Whatever the modes of who files, of the threads that do, and of who asks, the answers are the same.
template <class Scalar>
void judgeModesOfThreads(CaseRun<Scalar>& run) {
    const Boxes<Scalar> boxes = boxesOfNormalNumbers<Scalar>(run.seed);
    const Keys exact = touchingPairs(boxes);
    run.expect(exact.size() > 300, "more than 300 pairs of boxes without denormal numbers touch");
    for (const double cellSize : {0.0, 1e-30, 1.0, 1e10, 1e30}) {
        for (int modes = 0; modes < 4; ++modes) {
            const bool areThreadsFlushed = (modes & 2) != 0;
            const FlushToZero mode((modes & 1) != 0);
            Grid<Scalar> grid({.cellSize = cellSize});
            Pairs<Scalar> pairs(grid);
            for (const Aabb<Scalar>& box : boxes) {
                static_cast<void>(grid.add(box));
            }
            const auto onThreads = [&](std::size_t count, std::size_t grain, LoopBody body) {
                const auto work = [&](std::size_t begin, std::size_t end) {
                    const FlushToZero modeOfThread(areThreadsFlushed);
                    body(begin, end);
                };
                const std::size_t middle = count > grain ? count / 2 : 0;
                if (middle > 0) {
                    runTogether(1, [&](std::size_t) { work(0, middle); });
                }
                if (middle < count) {
                    work(middle, count);
                }
            };
            Keys found;
            for (const ProxyPair& pair : pairs.update(acceptAllPairs, onThreads).born) {
                found.push_back(pairKey(pair.first.index, pair.second.index));
            }
            run.compare(found, exact);
            // What was filed in one mode is looked for in the other.
            const FlushToZero opposite(!areThreadsFlushed);
            for (const Aabb<Scalar>& box : boxes) {
                NoteIndices<Scalar> touching;
                grid.visit(BoxRegion<Scalar>{box}, touching);
                run.compare(touching.sorted(), objectsThat(boxes, [&](const Aabb<Scalar>& other) {
                                return doTouch(other, box);
                            }));
            }
        }
    }
}

/// Denormal numbers are compared as the processor compares them: taken for zero, all of them touch.
template <class Scalar>
void judgeModesOfDenormals(CaseRun<Scalar>& run) {
    Random random(run.seed);
    const Scalar unit = std::numeric_limits<Scalar>::min() / 4096;
    Boxes<Scalar> boxes;
    for (int i = 0; i < 200; ++i) {
        const Vector3<Scalar> low = pointIn<Scalar>(random, -4000, 4000).array().round() * unit;
        boxes.emplace_back(low, low + Vector3<Scalar>::Constant(500 * unit));
    }
    std::array<std::size_t, 2> counts{};
    for (const bool flushes : {false, true}) {
        const FlushToZero mode(flushes);
        judgePairs(run, boxes, {0, 1e-30, 1});
        counts[flushes ? 1 : 0] = touchingPairs(boxes).size();
    }
    run.expect(!FlushToZero::isAvailable() || counts[1] == 200 * 199 / 2,
               "with flushing, all denormal boxes touch");
    run.expect(10 < counts[0] && (!FlushToZero::isAvailable() || counts[0] < counts[1]),
               "without flushing, only some denormal boxes touch");
}

constexpr auto denormalNumbers = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    for (const bool flushes : {false, true}) {
        // What is compared, and by whom, goes by the same rules.
        const FlushToZero flush(flushes);
        judgePairs(run, denormalBoxes<Scalar>(), {1e-30, 0});
    }
    // Where no comparison is between two denormal numbers, the pairs are the same.
    Boxes<Scalar> apart;
    const Scalar tiny = std::is_same_v<Scalar, float> ? Scalar(1e-40F) : Scalar(1e-310);
    for (int i = 0; i < 50; ++i) {
        const Scalar at = static_cast<Scalar>(i) * 0x1p-100F;
        apart.emplace_back(Vector3<Scalar>(at, -tiny, 0), Vector3<Scalar>(at + 0x1p-100F, tiny, 1));
    }
    std::array<Keys, 2> found;
    for (const bool flushes : {false, true}) {
        const FlushToZero flush(flushes);
        PairScene<Scalar> scene(run, apart);
        scene.judge();
        found[flushes ? 1 : 0] = scene.reported();
    }
    run.compare(found[1], found[0]);
    if (run.isOurs) {
        run.expect(!configError({.cellSize = 1e-38}).empty(), "cells of 1e-38 m are refused");
        judgeModesOfThreads(run);
        judgeModesOfDenormals(run);
    }
    if (!FlushToZero::isAvailable()) {
        run.note("This processor cannot flush denormal numbers to zero.");
    }
};

// --- Far from the origin --------------------------------------------------------------------------

template <class Scalar>
Aabb<Scalar> roundedOutward(const Aabb<double>& box) {
    Aabb<Scalar> rounded = box.cast<Scalar>();
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

/// Where numbers are two apart, boxes grow to their neighbours' neighbours, or to nothing. Some move,
/// and queries ask.
template <class Scalar>
void judgeLifeFarOut(CaseRun<Scalar>& run, double far) {
    Boxes<Scalar> boxes;
    addBlock(boxes, {far, 0, 0});
    addBlock(boxes, {far + 3, far, 0});
    addBlock(boxes, Vector3<double>::Constant(far + 3));
    judgePairs(run, boxes, {0, 1, 0.7});

    Random random(run.seed);
    PairScene<Scalar> scene(run, boxes);
    for (int frame = 0; frame < 10; ++frame) {
        scene.judgeQueriesAt(scene.boxes()[indexBelow(random, scene.size())],
                             scene.boxes()[indexBelow(random, scene.size())].min());
        scene.judge();
        for (int i = 0; i < 40; ++i) {
            // Most there, some anywhere from the origin on.
            const double share = i % 5 == 0 ? static_cast<double>(random.unit()) : 1;
            const Vector3<double> low =
                Vector3<double>::Constant(share * far) + pointIn<double>(random, -4, 4);
            const Vector3<double> high = low + pointIn<double>(random, 0.3, 3);
            scene.move(indexBelow(random, scene.size()), Aabb<double>(low, high).cast<Scalar>());
        }
    }
}

constexpr auto unitBoxesFarOut = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    std::uint64_t beyondTruth = 0;
    for (const double far : {0x1p24, 1e7, 5e7, 1e8, 1e9}) {
        Boxes<double> boxes;
        Boxes<Scalar> rounded;
        Random random(run.seed);
        for (int i = 0; i < 150; ++i) {
            const auto at = [&] { return far + 8 * static_cast<double>(random.unit()); };
            const Vector3<double> low(at(), at(), -at());
            boxes.emplace_back(low, low + Vector3<double>::Ones());
            rounded.push_back(roundedOutward<Scalar>(boxes.back()));
        }
        PairScene<Scalar> scene(run, rounded);
        scene.judge();
        CaseTally inDouble;
        inDouble.compare(scene.reported(), touchingPairs(boxes));
        run.expect(inDouble.outcome().missing == 0, "no pair of the original boxes is missing");
        beyondTruth += inDouble.outcome().extra;
        if (run.isOurs) {
            judgeLifeFarOut(run, far);
            judgeLifeFarOut(run, -far);
        }
    }
    run.expect(beyondTruth == 0 || std::is_same_v<Scalar, float>,
               "in double precision, no pair is extra");
    run.note("Rounding outward adds " + std::to_string(beyondTruth) +
             " pairs that the original boxes do not have" +
             (run.isOurs ? "; Grid<double> adds none." : "."));
};

/// A scene of multiples of a unit, shifted by so much.
Boxes<double> shiftedBoxes(double unit, const Vector3<double>& shift, std::uint64_t seed) {
    Boxes<double> boxes;
    Random random(seed);
    for (int i = 0; i < 200; ++i) {
        const auto at = [&] {
            return unit * static_cast<double>(std::floor(random.between(-40, 40)));
        };
        const Vector3<double> low = Vector3<double>(at(), at(), at());
        const double edge = unit * static_cast<double>(std::floor(random.between(1, 16)));
        boxes.emplace_back(low + shift, low + shift + Vector3<double>::Constant(edge));
    }
    return boxes;
}

template <class Scalar>
Boxes<Scalar> castTo(const Boxes<double>& boxes) {
    Boxes<Scalar> cast;
    for (const Aabb<double>& box : boxes) {
        cast.push_back(box.cast<Scalar>());
    }
    return cast;
}

/// Some frames of moves by multiples of the unit: the same pairs, and what queries find at much the
/// same cost.
template <class Scalar>
void judgeShiftedLife(CaseRun<Scalar>& run, double unit, const Vector3<double>& shift) {
    const Vector3<Scalar> by = shift.cast<Scalar>();
    PairScene<Scalar> here(run, castTo<Scalar>(shiftedBoxes(unit, {0, 0, 0}, run.seed)));
    PairScene<Scalar> there(run, castTo<Scalar>(shiftedBoxes(unit, shift, run.seed)));
    Random random(run.seed);
    std::array<std::uint64_t, 2> tests{};
    for (std::uint32_t frame = 0; frame < 8; ++frame) {
        here.judge();
        there.judge();
        run.compare(there.reported(), here.reported());
        tests[0] += here.cost().boxesTested;
        tests[1] += there.cost().boxesTested;
        for (std::uint32_t i = frame; i < here.size(); i += 3) {
            const Vector3<Scalar> step =
                static_cast<Scalar>(unit) * pointIn<Scalar>(random, -3, 3).array().round();
            here.move(i, here.boxes()[i].translated(step));
            there.move(i, there.boxes()[i].translated(step));
        }
        for (std::uint32_t i = 0; here.grid() != nullptr && i < here.size(); i += 20) {
            const Vector3<Scalar> low = here.boxes()[i].min();
            const Vector3<Scalar> to = low.reverse();
            const auto compare = [&](const auto& near, const auto& far) {
                NoteIndices<Scalar> foundNear;
                NoteIndices<Scalar> foundFar;
                tests[0] += here.grid()->visit(near, foundNear).boxesTested;
                tests[1] += there.grid()->visit(far, foundFar).boxesTested;
                run.compare(foundFar.sorted(), foundNear.sorted());
            };
            compare(BoxRegion<Scalar>{here.boxes()[i]}, BoxRegion<Scalar>{there.boxes()[i]});
            compare(SphereRegion<Scalar>{low, static_cast<Scalar>(9 * unit)},
                    SphereRegion<Scalar>{low + by, static_cast<Scalar>(9 * unit)});
            compare(RayRegion<Scalar>(low, to), RayRegion<Scalar>(low + by, to + by));
        }
    }
    run.expect(tests[1] <= tests[0] + tests[0] / 10 + 1000,
               "the shifted scene costs about as much as the scene at the origin");
}

constexpr auto shiftedScene = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    // Multiples of 1/8 m stay themselves at 2^20 m, and multiples of 128 m at 2^30 m.
    const auto judgeShift = [&](double unit, double shift) {
        const auto boxes = [&](double by) {
            return castTo<Scalar>(shiftedBoxes(unit, Vector3<double>::Constant(by), run.seed));
        };
        PairScene<Scalar> here(run, boxes(0));
        PairScene<Scalar> there(run, boxes(shift));
        here.judge();
        there.judge();
        run.compare(there.reported(), here.exact());
    };
    judgeShift(0.125, 0x1p20);
    judgeShift(128, 0x1p30);
    if (!run.isOurs) {
        return;
    }
    // As far as the numbers go: a step is the last digit of the farthest coordinate.
    constexpr bool kIsDouble = std::is_same_v<Scalar, double>;
    const double unit = kIsDouble ? 0x1p-20 : 0x1p-6;
    int axis = 0;
    for (int power = 10; power <= (kIsDouble ? 30 : 16); power += kIsDouble ? 5 : 2) {
        const double distance = std::ldexp(power % 4 == 0 ? -1 : 1, power);
        judgeShiftedLife(run, unit, Vector3<double>::Unit(axis++ % 3) * distance);
        judgeShiftedLife(run, unit, {distance, -distance, distance});
    }
};

constexpr HardCase kRoundingCases[] = {
    {"H10", "denormal numbers",
     "boxes of 1.5e-40 m (in double precision 1.5e-310 m), and boxes with some denormal "
     "coordinates; cells of 1e-30 m; with and without flushing of denormal numbers to zero (FTZ, "
     "DAZ)",
     "exact pairs, by comparing the coordinates under the same setting; the same pairs under both "
     "settings if no two denormal numbers are compared; cells of 1e-38 m are refused",
     denormalNumbers},
    {"H11", "unit boxes 2^24 to 1e9 m away",
     "150 boxes of 1 m at 2^24, 1e7, 5e7, 1e8 and 1e9 m, computed in double precision and rounded "
     "outward to single precision",
     "exact pairs of the rounded boxes, so that no pair of the original boxes is missing; in "
     "double precision exactly the pairs of the original boxes",
     unitBoxesFarOut},
    {"H12", "a scene at 0, 2^20 and 2^30 m",
     "200 boxes on multiples of 1/8 m, shifted by 2^20 m, and on multiples of 128 m, shifted by "
     "2^30 m; for hashphase also moving boxes on multiples of 2^-6 m, shifted by up to 2^16 m (in "
     "double precision 2^-20 m, by up to 2^30 m)",
     "the same pairs as at the origin", shiftedScene},
};

}  // namespace

std::span<const HardCase> roundingCases() {
    return kRoundingCases;
}

}  // namespace hashphase::demos
