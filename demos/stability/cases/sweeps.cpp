// SPDX-License-Identifier: Zlib
//
// What moves so fast that it matters what it passes.

#include <demos/stability/cases/cases.hpp>
#include <demos/stability/swept_scene.hpp>

#include <array>

namespace hashphase::demos {
namespace {

// --- Far and fast ---------------------------------------------------------------------------------

// Cubes that stand on multiples of the unit, and some that fly.
template <class Scalar>
SweptScene<Scalar> flyingFrame(std::uint64_t seed, int standing, int flying, float side, float way,
                               float unit) {
    using Point = Vector3<float>;
    Random random(seed);
    const auto on = [&](float low, float high) {
        return std::floor(random.between(low, high) / unit) * unit;
    };
    SweptScene<Scalar> frame;
    frame.movers = static_cast<std::uint32_t>(flying);
    for (int i = 0; i < flying + standing; ++i) {
        Point displacement = Point::Zero();
        const float edge = on(0.5F, 1.5F) + unit;
        Point low(on(-side / 2, side / 2), on(-side / 2, side / 2), on(-side / 2, side / 2));
        if (i < flying) {
            // From one side, through the middle, to the other.
            low[0] = -std::floor(way / 2 / unit) * unit;
            displacement = Point(std::floor(way / unit) * unit, on(-4, 4), on(-4, 4));
        }
        const Aabb<float> box(low, low + Point::Constant(edge));
        frame.objects.push_back({box.cast<Scalar>(), displacement.cast<Scalar>()});
    }
    return frame;
}

/// Through crowds at the start and here and there along the ways, as far as numbers go: the cost does
/// not follow the way.
template <class Scalar>
void judgeTeleports(CaseRun<Scalar>& run) {
    using Point = Vector3<Scalar>;
    constexpr double kUnit = 0x1p-20;
    const Lattice lattice(kUnit);
    std::array<std::uint64_t, 3> testsOfShortWays{};
    for (const Scalar length : {1e6F, 2e9F}) {
        Random random(run.seed);
        SweptScene<Scalar> frame;
        frame.movers = 40;
        for (std::uint32_t i = 0; i < 640; ++i) {
            const Point around = pointIn<Scalar>(random, -9, 9);
            if (i < frame.movers) {
                const Scalar ahead = between<Scalar>(random, 0.5F, 1);
                const Scalar y = between<Scalar>(random, -0.02F, 0.02F);
                const Scalar z = between<Scalar>(random, -0.02F, 0.02F);
                frame.objects.push_back({lattice.on<Scalar>(cubeAt(around, 1)),
                                         lattice.on<Scalar>(Point(ahead, y, z) * length)});
                continue;
            }
            const MovingBox<Scalar>& mover = frame.objects[i % frame.movers];
            const Scalar share = i % 2 == 0 ? Scalar(0) : between<Scalar>(random, 0, 1);
            const Point at = mover.box.center() + share * mover.displacement + around;
            frame.objects.push_back({lattice.on<Scalar>(cubeAt(at, 4)), Point::Zero()});
        }
        const auto tests = judgeFrame(run, frame, kUnit, {.cellSize = 1});
        for (std::size_t mode = 0; mode < tests.size(); ++mode) {
            run.expect(tests[mode] <= 90'000 &&
                           (length == 1e6F || 4 * tests[mode] <= 5 * testsOfShortWays[mode]),
                       "long paths cost at most 1.25 times as much as short paths");
        }
        testsOfShortWays = tests;
    }
}

/// A crowd far away decides where cells are counted from: here their numbers have as many digits as a
/// coordinate, and what lies at the edge of the world may be filed some cells farther in.
template <class Scalar>
void judgeRoundedCells(CaseRun<Scalar>& run) {
    using Point = Vector3<Scalar>;
    const Lattice lattice(0x1p-20);
    for (const Scalar shift : {0.0F, 3.0F, 6.0F, 9.0F, 12.0F}) {
        Random random(run.seed);
        SweptScene<Scalar> frame;
        frame.movers = 100;
        const auto add = [&](const Point& center, const Point& way) {
            frame.objects.push_back({lattice.on<Scalar>(cubeAt(center, Scalar(0.9))), way});
        };
        const Point way = lattice.on<Scalar>(Point(-200, Scalar(0.01), 0));
        for (int i = 0; i < 400; ++i) {
            Point at = pointIn<Scalar>(random, -10, 10);
            at[0] = i < 100 ? Scalar(80) : 20 + 2 * at[0] + shift;
            add(at, i < 100 ? way : Point(Point::Zero()));
        }
        const Keys exact = truthOf(frame, lattice);
        for (int i = 0; i < 3000; ++i) {
            add(Point(2e8F, static_cast<Scalar>(10 * i), 1000), Point::Zero());
        }
        judgeFrame(run, frame, exact, {.cellSize = 1});
    }
}

constexpr auto millionCells = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    const auto frame = flyingFrame<Scalar>(run.seed, 2000, 20, 40, 1e6F, 0.125F);
    judgeFrame(run, frame, 0.125);
    if (run.isOurs) {
        // Far ways cost what near ones do that pass the same cubes.
        const auto near = flyingFrame<Scalar>(run.seed, 2000, 20, 40, 200, 0.125F);
        const auto work = [](const SweptScene<Scalar>& of) {
            return static_cast<double>(sweepOurs(of, Sweep::automatic).second.boxesTested);
        };
        run.addCost(work(frame) / std::max(1.0, work(near)), 4);
        run.note(
            "Cost: boxes tested, divided by the boxes tested for paths of 200 m through the same "
            "cubes.");
        judgeTeleports(run);
        judgeRoundedCells(run);
    }
    // And teleported, without a way.
    const Boxes<Scalar> boxes = scatteredCubes<Scalar>(400, 20, 0.5F, 1.5F, run.seed);
    PairScene<Scalar> scene(run, boxes, {.cellSize = 1},
                            Aabb<Scalar>(Point::Constant(-2e6F), Point::Constant(2e6F)));
    scene.judge();
    for (const Scalar to : {1e6F, -1e6F, 0.0F}) {
        for (std::uint32_t i = 0; i < 40; ++i) {
            scene.move(i, boxes[i].translated(Point(to, -to, to)));
        }
        scene.judge();
    }
};

/// Two unit boxes along x, of which the first begins at 0: how far the other is away, how much higher it is,
/// their ways, and whether they touch.
template <class Scalar>
struct Meeting {
    Scalar gap;
    Scalar height;
    Scalar way;
    Scalar otherWay;
    bool doTouch;
};

template <class Scalar>
void judgeMeetings(CaseRun<Scalar>& run, Scalar face,
                   const std::vector<Meeting<Scalar>>& meetings) {
    using Point = Vector3<Scalar>;
    for (const Meeting<Scalar>& meeting : meetings) {
        const Point low(face + meeting.gap, meeting.height, 0);
        const MovingBox<Scalar> one{{Point(face - 1, 0, 0), Point(face, 1, 1)},
                                    {meeting.way, 0, 0}};
        const MovingBox<Scalar> other{{low, low + Point::Ones()}, {meeting.otherWay, 0, 0}};
        judgeFrame<Scalar>(run, {{one, other}, 2}, meeting.doTouch ? Keys{pairKey(0, 1)} : Keys{});
    }
}

constexpr auto noMotion = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    const Boxes<Scalar> boxes = scatteredCubes<Scalar>(150, 6, 0.5F, 1.5F, run.seed);
    const Keys exact = touchingPairs(boxes);
    for (const Scalar speed : {0.0F, -0.0F, 1e-12F, 1e-30F, 1e-40F}) {
        SweptScene<Scalar> frame;
        frame.movers = static_cast<std::uint32_t>(boxes.size());
        for (const Aabb<Scalar>& box : boxes) {
            frame.objects.push_back({box, Vector3<Scalar>(speed, 0, -speed)});
        }
        judgeFrame(run, frame, exact);
    }
    if (run.isOurs) {
        // By less than an ulp: as standing still, but for what is nearer than that.
        using Limits = std::numeric_limits<Scalar>;
        const Scalar ulp = above(Scalar(1000)) - 1000;
        judgeMeetings<Scalar>(run, 1000,
                              {{0, 0, 0, 0, true},
                               {ulp, 0, 0, 0, false},
                               {0, 0, ulp / 8, 0, true},
                               {0, 0, -ulp / 8, 0, true},
                               {ulp, 0, ulp / 8, 0, false},
                               {ulp, 0, ulp, 0, true},
                               {ulp, 0, ulp * 7 / 8, 0, false},
                               {0, 0, Limits::denorm_min(), 0, true},
                               {ulp, 0, Limits::min(), 0, false}});
    }
};

// --- Thin walls -----------------------------------------------------------------------------------

// Lanes, each with a wall somewhere along it and a bullet that passes it, begins in it or ends in it; every
// other one flies the other way. Coordinates are multiples of an eighth of a millimetre up to 1024 m, so
// that none is rounded.
template <class Scalar>
SweptScene<Scalar> bulletsAtWalls(int lanes, float thickness, Random& random) {
    using Point = Vector3<float>;
    constexpr float kUnit = 0x1p-13F;
    constexpr float kBullet = 0x1p-7F;  // 8 mm
    const auto on = [](float x) { return std::floor(x / kUnit) * kUnit; };
    const float way = on(200.0F / 60);
    const float thick = std::max(kUnit, std::round(thickness / kUnit) * kUnit);
    SweptScene<Scalar> frame;
    frame.movers = static_cast<std::uint32_t>(lanes);
    std::vector<MovingBox<Scalar>> walls;
    for (int i = 0; i < lanes; ++i) {
        const float y = 0.5F * static_cast<float>(i % 128);
        const float z = 0.5F * static_cast<float>(i / 128);
        const float wall = on(random.between(-1000, 1000));
        // From the bullet's front to the wall's: negative for a bullet that begins in the wall.
        const float phase = on(random.between(-(thick + kBullet), way));
        const bool isForward = i % 2 == 0;
        const Point low(isForward ? wall - phase - kBullet : wall + thick + phase, y, z);
        const Aabb<float> bullet(low, low + Point::Constant(kBullet));
        frame.objects.push_back(
            {bullet.cast<Scalar>(), Vector3<Scalar>(isForward ? way : -way, 0, 0)});
        const Aabb<float> box(Point(wall, y - 0.125F, z - 0.125F),
                              Point(wall + thick, y + 0.125F, z + 0.125F));
        walls.push_back({box.cast<Scalar>()});
    }
    frame.objects.insert(frame.objects.end(), walls.begin(), walls.end());
    return frame;
}

constexpr auto thinWalls = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    Random random(run.seed);
    constexpr int kLanes = 2000;
    const int phases = run.isOurs ? run.quickOrFull(10'000, 1'000'000) : 10'000;
    Keys exact;
    for (std::uint32_t i = 0; i < kLanes; ++i) {
        exact.push_back(pairKey(i, i + kLanes));
    }
    for (int tried = 0; tried < phases; tried += 3 * kLanes) {
        for (const float thickness : {0.1F, 0.01F, 0.001F}) {
            judgeFrame(run, bulletsAtWalls<Scalar>(kLanes, thickness, random), exact);
        }
    }
};

// --- Grazing and crossing -------------------------------------------------------------------------

/// A box and its way, and another box that it touches for a moment, by an edge: along one axis it leaves
/// it when along another one it arrives, at a time that is rounded; at 1,728 places.
template <class Scalar>
void judgeMoments(CaseRun<Scalar>& run) {
    using Point = Vector3<Scalar>;
    Random random(run.seed);
    const auto draw = [&](std::uint32_t count) {
        return static_cast<Scalar>(1 + indexBelow(random, count));
    };
    SweptScene<Scalar> frame;
    std::vector<MovingBox<Scalar>> others;
    Keys exact;
    for (int i = 0; i < 12 * 12 * 12; ++i) {
        const Point where = Vector3<int>(i / 144, i / 12 % 12, i % 12).cast<Scalar>() * 1000;
        const Scalar parts = draw(30);
        const Scalar passed = draw(static_cast<std::uint32_t>(parts));
        const Scalar x = draw(9);
        const Scalar y = draw(9);
        const Point step(x, y, draw(9) - 5);
        const Point way = passed * step;
        frame.objects.push_back({{where, where + Point(1, 1, 40)}, parts * step});
        others.push_back({{where + Point(way[0] - 3, 1 + way[1], way[2] + 1),
                           where + Point(way[0], 3 + way[1], way[2] + 2)}});
        exact.push_back(pairKey(frame.movers, frame.movers + 1728));
        ++frame.movers;
    }
    frame.objects.insert(frame.objects.end(), others.begin(), others.end());
    judgeFrame(run, frame, exact);
}

constexpr auto grazing = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    for (const int apart : {-1, 0, 1}) {
        // Along an axis, past a face; 1 ulp of the coordinates at 1024 m.
        const Scalar gap = 0x1p-13F * static_cast<Scalar>(apart);
        const MovingBox<Scalar> passing{{Point(0, 1024 + gap, 0), Point(1, 1025 + gap, 1)},
                                        {500, 0, 0}};
        judgeFrame<Scalar>(run, {{passing, {{Point(250, 1023, 0), Point(251, 1024, 1)}}}, 1},
                           0x1p-13);
        // Slantwise, past an edge: the lower right corner, (1, 0), runs along y = x - 1 and meets
        // the edge at (129, 128); 1 ulp there.
        const Scalar aside = 0x1p-16F * static_cast<Scalar>(apart);
        const MovingBox<Scalar> slanting{{Point(0, 0, 0), Point(1, 1, 1)}, {240, 240, 0}};
        judgeFrame<Scalar>(
            run, {{slanting, {{Point(129 + aside, 127, 0), Point(130 + aside, 128, 1)}}}, 1},
            0x1p-16);
    }
    if (run.isOurs) {
        judgeMoments(run);
    }
};

/// Infinite corners, inverted boxes: differences of coordinates need not be numbers.
template <class Scalar>
void judgeInfiniteBoxes(CaseRun<Scalar>& run) {
    using Point = Vector3<Scalar>;
    constexpr Scalar kFar = kInfinity<Scalar>;
    const auto judge = [&](const Aabb<Scalar>& mover, const Point& way, const Aabb<Scalar>& other) {
        judgeFrame<Scalar>(run, {{{mover, way}, {other, {0, 0, 0}}}, 1}, Keys{pairKey(0, 1)});
    };
    judge({Point(8, kFar, 3), Point(8.25F, kFar, 4.5F)}, {0, 10, 9.5F},
          {Point(8, -4, 5.5F), Point(10, kFar, 6)});
    judge({Point(-9, -7, kFar), Point(-8.5F, -5, 1e6F)}, {10, 1.7e38F, -1e6F},
          {Point(0, 1e37F, 0), Point(1, 2e38F, kFar)});
}

constexpr auto crossing = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    SweptScene<Scalar> frame;
    const auto add = [&frame](const Vector3<Scalar>& low, const Vector3<Scalar>& way) {
        frame.objects.push_back({{low, low + Vector3<Scalar>::Ones()}, way});
        ++frame.movers;
    };
    add({0, 0, 0}, {1000, 0, 0});  // these two meet in the middle
    add({1000, 0, 0}, {-1000, 0, 0});
    add({500, -500, 50}, {0, 1000, 0});  // these cross at the same time
    add({0, 0, 50}, {1000, 0, 0});
    add({500, -500, 100}, {0, 1000, 0});  // these cross one after the other
    add({0, 0, 100}, {500, 0, 0});
    add({0, 0, 200}, {100, 0, 0});  // touch at 0 and part
    add({-1, 0, 200}, {-100, 0, 0});
    add({0, 0, 300}, {100, 0, 0});  // touch at 1 only
    add({102, 0, 300}, {-1, 0, 0});
    add({0, 0, 400}, {100, 0, 0});  // miss by 1/8 m at 1
    add({102.125F, 0, 400}, {-1, 0, 0});
    add({0, 0, 500}, {1000, 0, 0});  // fly side by side, a cell apart
    add({0, 2, 500}, {1000, 0, 0});
    judgeFrame<Scalar>(run, frame, 0.125);
    if (run.isOurs) {
        // Towards each other, at the first or the last moment: inside by an ulp, touching, apart by one.
        judgeMeetings<Scalar>(run, 1,
                              {{29, 0, 40, -40, true},
                               {29, 0, 40, 40, false},
                               {0, 0, -9, 9, true},
                               {above(Scalar(1)) - 1, 0, -9, 9, false},
                               {16, 0, 9, -7, true},
                               {above(Scalar(16)), 0, 9, -7, false},
                               {29, below(Scalar(1)), 40, -40, true},
                               {29, 1, 40, -40, true},
                               {29, above(Scalar(1)), 40, -40, false}});
        judgeInfiniteBoxes(run);
    }
};

constexpr HardCase kSweepCases[] = {
    {"H20", "boxes that fly 1e6 m in a frame",
     "20 cubes that fly 1e6 m through a crowd of 2,000 cubes in one frame; 40 of 400 cubes that "
     "are moved by 1e6 m and back, without a sweep",
     "exactly the pairs that touch at some time; the cost does not grow with the speed",
     millionCells},
    {"H21", "sweeps of 0 to 1e-12 m", "150 cubes with sweeps of 0, -0, 1e-12, 1e-30 and 1e-40 m",
     "exactly the pairs that touch without sweeps", noMotion},
    {"H22", "bullets of 200 m/s at thin walls",
     "bullets of 8 mm that fly 3.3 m in a frame, in both directions, at walls of 100, 10 and 1 mm, "
     "up to 1 km away; each bullet passes its wall, begins in it or ends in it, at random; for "
     "hashphase a million bullets (--quick: 10,000), each with Sweep::automatic, box and line; for "
     "Bullet's broadphases 10,000",
     "every bullet meets its wall", thinWalls},
    {"H23", "grazing by -1, 0 and 1 ulp",
     "a box that passes another box along an axis, or diagonally past an edge: 1 ulp inside, "
     "touching, or 1 ulp apart",
     "a pair if the boxes touch, no pair if they do not", grazing},
    {"H24", "crossing paths",
     "pairs of fast boxes that meet head-on, cross at the same time or one after the other, touch "
     "only at the first or only at the last moment, miss by 1/8 m, or fly side by side",
     "exactly the pairs that touch at some moment", crossing},
};

}  // namespace

std::span<const HardCase> sweepCases() {
    return kSweepCases;
}

}  // namespace hashphase::demos
