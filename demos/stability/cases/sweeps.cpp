// SPDX-License-Identifier: Zlib
//
// What moves so fast that it matters what it passes. Ours sweeps; Bullet's broadphases are given the box
// around start and end, as m_useContinuous does.

#include <demos/stability/cases/cases.hpp>

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <demos/accuracy/sweeps/sweep_truth.hpp>
#include <demos/scenes/random.hpp>
#include <demos/stability/grid_scene.hpp>
#include <demos/stability/isolation.hpp>
#include <demos/stability/pair_scene.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

using Point = Vector3<float>;
using Keys = std::vector<PairKey>;

constexpr std::array kSweeps{Sweep::automatic, Sweep::box, Sweep::line};

// The pairs of a frame that touch at some time, of one mover at least; in integers.
Keys truthOf(const SweptFrame& frame) {
    const LimitPause pause;
    Keys pairs;
    const auto count = static_cast<std::uint32_t>(frame.objects.size());
    for (std::uint32_t a = 0; a < frame.movers; ++a) {
        for (std::uint32_t b = a + 1; b < count; ++b) {
            if (exactContact(frame, a, b)) {
                pairs.push_back(pairKey(a, b));
            }
        }
    }
    return pairs;
}

// What Sweeps and Pairs find.
struct Swept {
    Keys pairs;
    SweepCost cost;
};
Swept sweepOurs(const SweptFrame& frame, Sweep sweep = Sweep::automatic) {
    Grid<float> grid;
    Sweeps<float> sweeps(grid);
    Pairs<float> pairs(grid, &sweeps);
    std::vector<ProxyId> ids;
    for (const MovingBox<float>& object : frame.objects) {
        ids.push_back(grid.add(object.box));
    }
    for (std::uint32_t i = 0; i < frame.movers; ++i) {
        sweeps.set(ids[i], frame.objects[i].displacement, sweep);
    }
    Swept swept;
    for (const ProxyPair& pair : pairs.update([](ProxyId, ProxyId) { return true; }).born) {
        swept.pairs.push_back(keyOf(pair));
    }
    swept.cost = sweeps.lastCost();
    return swept;
}

Keys withMovers(const Keys& pairs, std::uint32_t movers) {
    Keys kept;
    for (const PairKey pair : pairs) {
        if (firstOf(pair) < movers) {
            kept.push_back(pair);
        }
    }
    return kept;
}

// Of any broadphase: pairs of at least one mover, sorted.
Keys foundBy(const CaseContext& context, const SweptFrame& frame, Sweep sweep = Sweep::automatic) {
    if (context.kind.ours) {
        return withMovers(sweepOurs(frame, sweep).pairs, frame.movers);
    }
    Boxes boxes;
    for (const MovingBox<float>& object : frame.objects) {
        boxes.push_back(wayBox(object));
    }
    PairScene scene(context, boxes);
    scene.findPairs();
    return withMovers(scene.reported(), frame.movers);
}

void judgeFrame(const CaseContext& context, CaseTally& tally, const SweptFrame& frame) {
    tally.compare(foundBy(context, frame), truthOf(frame));
}

// --- Far and fast ---------------------------------------------------------------------------------

// Cubes that stand on multiples of the unit, and some that fly.
SweptFrame flyingFrame(const CaseContext& context, int standing, int flying, float side, float way,
                       float unit) {
    Random random(context.seed);
    const auto on = [&](float low, float high) {
        return std::floor(random.between(low, high) / unit) * unit;
    };
    SweptFrame frame;
    frame.unit.fill(unit);
    frame.movers = static_cast<std::uint32_t>(flying);
    for (int i = 0; i < flying + standing; ++i) {
        MovingBox<float> object;
        const float edge = on(0.5F, 1.5F) + unit;
        Point low(on(-side / 2, side / 2), on(-side / 2, side / 2), on(-side / 2, side / 2));
        if (i < flying) {
            // From one side, through the middle, to the other.
            low[0] = -std::floor(way / 2 / unit) * unit;
            object.displacement = Point(std::floor(way / unit) * unit, on(-4, 4), on(-4, 4));
        }
        object.box = {low, low + Point::Constant(edge)};
        frame.objects.push_back(object);
    }
    return frame;
}

CaseOutcome millionCells(const CaseContext& context) {
    CaseTally tally;
    const SweptFrame frame = flyingFrame(context, 2000, 20, 40, 1e6F, 0.125F);
    judgeFrame(context, tally, frame);
    if (context.kind.ours) {
        // Far ways cost what near ones do that pass the same cubes.
        const SweptFrame near = flyingFrame(context, 2000, 20, 40, 200, 0.125F);
        const auto work = [](const SweptFrame& of) {
            return static_cast<double>(sweepOurs(of).cost.boxesTested);
        };
        tally.addCost(work(frame) / std::max(1.0, work(near)), 4);
        tally.note("Cost: boxes tested, by those for ways of 200 m through the same cubes.");
    }
    // And teleported, without a way.
    Boxes boxes = scatteredCubes(400, 20, 0.5F, 1.5F, context.seed);
    PairScene scene(context, boxes, {.cellSize = 1},
                    Aabb<float>(Point::Constant(-2e6F), Point::Constant(2e6F)));
    scene.judge(tally);
    for (const float to : {1e6F, -1e6F, 0.0F}) {
        for (std::uint32_t i = 0; i < 40; ++i) {
            scene.move(i, boxes[i].translated(Point(to, -to, to)));
        }
        scene.judge(tally);
    }
    return tally.outcome();
}

CaseOutcome noMotion(const CaseContext& context) {
    const Boxes boxes = scatteredCubes(150, 6, 0.5F, 1.5F, context.seed);
    CaseTally tally;
    for (const float speed : {0.0F, -0.0F, 1e-12F, 1e-30F, 1e-40F}) {
        Keys exact;
        Keys found;
        {
            PairScene still(context, boxes);
            exact = still.exact();
        }
        if (context.kind.ours) {
            SweptFrame frame;
            frame.movers = static_cast<std::uint32_t>(boxes.size());
            for (const Aabb<float>& box : boxes) {
                frame.objects.push_back({box, Point(speed, 0, -speed)});
            }
            for (const Sweep sweep : kSweeps) {
                found = sweepOurs(frame, sweep).pairs;
                tally.compare(found, exact);
            }
        } else {
            Boxes ways;
            for (const Aabb<float>& box : boxes) {
                ways.push_back(box.merged(box.translated(Point(speed, 0, -speed))));
            }
            PairScene scene(context, ways);
            scene.findPairs();
            tally.compare(scene.reported(), exact);
        }
    }
    return tally.outcome();
}

// --- Thin walls -----------------------------------------------------------------------------------

// Lanes, each with a wall somewhere along it and a bullet that begins somewhere in front of the
// wall and ends behind; every other one flies the other way. Coordinates are multiples of an eighth
// of a millimetre up to 1024 m, so that none is rounded.
SweptFrame bulletsAtWalls(int lanes, float thickness, Random& random) {
    constexpr float kUnit = 0x1p-13F;
    constexpr float kBullet = 0x1p-7F;  // 8 mm
    constexpr float kFarthest = 1000;
    const auto on = [](float x) { return std::floor(x / kUnit) * kUnit; };
    const float way = on(200.0F / 60);
    const float thick = std::max(kUnit, std::round(thickness / kUnit) * kUnit);
    SweptFrame frame;
    frame.unit = {kUnit, 0x1p-7F, 0x1p-7F};
    frame.movers = static_cast<std::uint32_t>(lanes);
    std::vector<MovingBox<float>> walls;
    for (int i = 0; i < lanes; ++i) {
        const float y = 0.5F * static_cast<float>(i % 128);
        const float z = 0.5F * static_cast<float>(i / 128);
        const float wall = on(random.between(-kFarthest, kFarthest));
        const float phase = on(random.unit() * (way - kBullet - thick));
        const bool isForward = i % 2 == 0;
        const Point low(isForward ? wall - phase - kBullet : wall + thick + phase, y, z);
        frame.objects.push_back(
            {{low, low + Point::Constant(kBullet)}, Point(isForward ? way : -way, 0, 0)});
        walls.push_back(
            {{Point(wall, y - 0.125F, z - 0.125F), Point(wall + thick, y + 0.125F, z + 0.125F)}});
    }
    frame.objects.insert(frame.objects.end(), walls.begin(), walls.end());
    return frame;
}

CaseOutcome thinWalls(const CaseContext& context) {
    CaseTally tally;
    Random random(context.seed);
    constexpr int kLanes = 2000;
    const int phases = context.kind.ours ? context.quickOrFull(10'000, 1'000'000) : 10'000;
    Keys exact;
    for (std::uint32_t i = 0; i < kLanes; ++i) {
        exact.push_back(pairKey(i, i + kLanes));
    }
    for (int tried = 0; tried < phases; tried += 3 * kLanes) {
        for (const float thickness : {0.1F, 0.01F, 0.001F}) {
            const SweptFrame frame = bulletsAtWalls(kLanes, thickness, random);
            for (const Sweep sweep : kSweeps) {
                if (context.kind.ours || sweep == Sweep::automatic) {
                    tally.compare(foundBy(context, frame, sweep), exact);
                }
            }
        }
    }
    return tally.outcome();
}

// --- Grazing and crossing -------------------------------------------------------------------------

CaseOutcome grazing(const CaseContext& context) {
    CaseTally tally;
    for (const int apart : {-1, 0, 1}) {
        // Along an axis, past a face; 1 ulp of the coordinates at 1024 m.
        const float gap = 0x1p-13F * static_cast<float>(apart);
        SweptFrame straight;
        straight.unit.fill(0x1p-13F);
        straight.movers = 1;
        straight.objects.push_back(
            {{Point(0, 1024 + gap, 0), Point(1, 1025 + gap, 1)}, {500, 0, 0}});
        straight.objects.push_back({{Point(250, 1023, 0), Point(251, 1024, 1)}});
        judgeFrame(context, tally, straight);

        // Slantwise, past an edge: the lower right corner, (1, 0), runs along y = x - 1 and meets
        // the edge at (129, 128); 1 ulp there.
        const float slantingGap = 0x1p-16F * static_cast<float>(apart);
        SweptFrame slanting;
        slanting.unit.fill(0x1p-16F);
        slanting.movers = 1;
        slanting.objects.push_back({{Point(0, 0, 0), Point(1, 1, 1)}, {240, 240, 0}});
        slanting.objects.push_back(
            {{Point(129 + slantingGap, 127, 0), Point(130 + slantingGap, 128, 1)}});
        judgeFrame(context, tally, slanting);
    }
    return tally.outcome();
}

CaseOutcome crossing(const CaseContext& context) {
    CaseTally tally;
    SweptFrame frame;
    frame.unit.fill(0.125F);
    const auto add = [&](const Point& low, const Point& way) {
        frame.objects.push_back({{low, low + Point::Ones()}, way});
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
    frame.movers = static_cast<std::uint32_t>(frame.objects.size());
    judgeFrame(context, tally, frame);
    return tally.outcome();
}

constexpr std::array kSweepCases{
    HardCase{"H20", "a million cells in a frame",
             "20 cubes that fly 1e6 m through 2,000 others, and 40 of 400 that are moved by 1e6 m "
             "without a way, and back",
             "what they touch on their way, exactly; the work does not follow the speed",
             millionCells},
    HardCase{"H21", "a sweep that does not move",
             "150 cubes that move by 0, -0, 1e-12, 1e-30, 1e-40 m",
             "what they touch where they are", noMotion},
    HardCase{
        "H22", "200 m/s at walls of 1 to 100 mm",
        "bullets of 8 mm, 3.3 m a frame, both ways, at walls of 100, 10 and 1 mm, up to 1 km away, "
        "at random phases (ours a million, each with Sweep::automatic, box and line; 10,000 with "
        "--quick and for the others)",
        "every bullet meets its wall", thinWalls},
    HardCase{
        "H23", "grazing by -1, 0 and 1 ulp",
        "a box that passes another one along an axis, and slantwise past an edge, 1 ulp inside, "
        "touching, 1 ulp apart",
        "met when it touches, missed when it does not", grazing},
    HardCase{
        "H24", "crossing ways",
        "fast boxes that meet head on, cross at the same time and one after the other, touch at "
        "the first and at the last moment only, miss by 1/8 m, and fly side by side",
        "those who touch at some moment, exactly", crossing},
};

}  // namespace

std::span<const HardCase> sweepCases() {
    return kSweepCases;
}

}  // namespace hashphase::demos
