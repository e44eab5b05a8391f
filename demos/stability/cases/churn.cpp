// SPDX-License-Identifier: Zlib
//
// Changes: of one pair in many cells, by a hair, again and again, and of everything at random.

#include <demos/stability/cases/cases.hpp>

#include <broadphase/convex_region.hpp>
#include <integration/culling/culler.hpp>

#include <array>

namespace hashphase::demos {
namespace {

// --- Once -----------------------------------------------------------------------------------------

constexpr auto duplicates = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    const GridConfig config{.cellSize = 1, .levelRatio = 4};
    Boxes<Scalar> boxes;
    for (const Scalar edge : {0.9F, 1.1F, 3.5F, 4.5F, 15.0F, 20.0F}) {
        for (int i = 0; i < 5; ++i) {
            const Point at = Point::Constant(Scalar(0.125F) * static_cast<Scalar>(i));
            boxes.push_back(cubeAt(at, edge));
        }
    }
    PairScene<Scalar> scene(run, boxes, config);
    scene.judge();
    if (!run.isOurs) {
        return;
    }
    // To where others were, and away from everything, some a frame: all pairs are born and die once.
    for (const Scalar way : {Scalar(16), Scalar(100)}) {
        for (std::uint32_t i = 0; i < scene.size(); ++i) {
            scene.move(i, boxes[i].translated(Point(way * static_cast<Scalar>(i + 1), 0, 0)));
            if (i % 3 == 0) {
                scene.judge();
            }
        }
        scene.judge();
    }
    run.expect(scene.reported().empty(), "all pairs have ended");
};

// --- By a hair ------------------------------------------------------------------------------------

constexpr float kMargin = 0.05F;  // by which btDbvtBroadphase fattens boxes [m]

// An ulp of the margin [m]. As long as nothing is farther from 0 than 2^24 of them, moves by the
// margin and an ulp more or less are not rounded.
constexpr float kMarginUlp = 0x1p-28F;

constexpr std::array kUlpsBeyond{-1.0F, 0.0F, 1.0F};

// A cube at 0, and on each of its sides three boxes side by side that begin where the cube ends
// when it has moved by the margin, an ulp less and an ulp more.
template <class Scalar>
Boxes<Scalar> boxesAtTheMargin() {
    using Point = Vector3<float>;
    constexpr float kHalf = 0x1p20F * kMarginUlp;  // 4 mm
    Boxes<Scalar> boxes{cubeAt<Scalar>({0, 0, 0}, 2 * kHalf)};
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool isBelow : {false, true}) {
            for (const float ulps : kUlpsBeyond) {
                Point low = Point::Constant(-kHalf / 4);
                Point high = Point::Constant(kHalf / 4);
                low[(axis + 1) % 3] += ulps * 0.75F * kHalf;
                high[(axis + 1) % 3] += ulps * 0.75F * kHalf;
                low[axis] = kHalf + kMargin + ulps * kMarginUlp;
                high[axis] = low[axis] + kHalf;
                const Aabb<float> box = isBelow ? Aabb<float>(-high, -low) : Aabb<float>(low, high);
                boxes.push_back(box.cast<Scalar>());
            }
        }
    }
    return boxes;
}

// The pairs, and what is kept of the mover, however fat, has it at both ends.
template <class Scalar>
void judgeMove(CaseRun<Scalar>& run, PairScene<Scalar>& scene) {
    scene.judge();
    const Aabb<Scalar> box = scene.boxes()[0];
    for (const Vector3<Scalar>& end : {box.min(), box.max()}) {
        const Objects found = scene.touching({end, end});
        run.expect(std::count(found.begin(), found.end(), 0U) == 1,
                   "point queries at the min and max corners of the moving cube find it");
    }
}

// To the margin and back at a stroke, by an ulp less, nothing and an ulp more, then creeping across
// it by an ulp a frame; along each axis, both ways.
template <class Scalar>
void moveByTheMargin(CaseRun<Scalar>& run, int frames) {
    PairScene<Scalar> scene(run, boxesAtTheMargin<Scalar>());
    const Aabb<Scalar> rest = scene.boxes()[0];
    constexpr float kAtRest = kInfinity<float>;
    constexpr std::array kPlaces{-1.0F, kAtRest, 0.0F, kAtRest, 1.0F,  kAtRest,
                                 -1.0F, 0.0F,    1.0F, 0.0F,    -1.0F, kAtRest};
    for (int frame = 0; frame < frames; ++frame) {
        const std::size_t place = static_cast<std::size_t>(frame) % kPlaces.size();
        const int round = frame / static_cast<int>(kPlaces.size());
        Vector3<Scalar> by = Vector3<Scalar>::Zero();
        if (kPlaces[place] != kAtRest) {
            const Scalar step = kMargin + kPlaces[place] * kMarginUlp;
            by[round % 3] = round / 3 % 2 == 0 ? step : -step;
        }
        scene.move(0, rest.translated(by));
        judgeMove(run, scene);
        const Vector3<Scalar> moved = scene.boxes()[0].min() - rest.min();
        run.expect(moved == by && scene.boxes()[0].max() - rest.max() == by,
                   "moves by the margin are not rounded");
    }
}

// On and on by the margin, past others.
template <class Scalar>
void walkByTheMargin(CaseRun<Scalar>& run, int frames) {
    using Point = Vector3<Scalar>;
    Boxes<Scalar> boxes{cubeAt<Scalar>({0, 0, 0}, 1)};
    for (int i = 0; i < frames / 100; ++i) {
        boxes.push_back(cubeAt<Scalar>({5 * static_cast<Scalar>(i), 1, 0}, 1));
    }
    const Aabb<Scalar> world(Point::Constant(-10),
                             Point::Constant(Scalar(0.1F) * static_cast<Scalar>(frames)));
    PairScene<Scalar> scene(run, boxes, {}, world);
    for (int frame = 0; frame < frames; ++frame) {
        scene.move(0, scene.boxes()[0].translated(Point(kMargin, 0, 0)));
        judgeMove(run, scene);
    }
}

/// The boxes of `culler`'s margin: boxes approach a view by the margin, or by so little that a sum of
/// such steps would be rounded down; what is visible is in the set, in every frame.
template <class Scalar>
void approachAView(CaseRun<Scalar>& run, Scalar step, int frames) {
    using Point = Vector3<Scalar>;
    const Scalar tiny = std::numeric_limits<Scalar>::epsilon() / 8;
    std::array<Plane<Scalar>, 6> planes;  // of the cube from 0 to 8
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        planes[2 * at] = Plane<Scalar>(Point(Point::Unit(axis)), Scalar(0));
        planes[2 * at + 1] = Plane<Scalar>(Point(-Point::Unit(axis)), Scalar(8));
    }
    const ConvexRegion<Scalar> view(planes);
    Grid<Scalar> grid;
    std::vector<std::pair<ProxyId, Aabb<Scalar>>> proxies;
    for (int k = 0; k < 8; ++k) {
        // Just outside of the margin, by 800 of the least steps at most.
        const Scalar front = -1 - 100 * tiny * static_cast<Scalar>(k + 1);
        const Scalar z = static_cast<Scalar>(k) / 2;
        const Aabb<Scalar> box(Point(front - 1, 2, z), Point(front, 3, z));
        proxies.emplace_back(grid.add(box), box);
    }
    Culler<Scalar> culler(1);
    culler.look(grid, view);
    const auto approach = [&](Scalar by) {
        Scalar moved = 0;  // at most, of what rounding made of it
        for (auto& [id, box] : proxies) {
            const Scalar from = box.max()[0];
            box.max()[0] += by;
            moved = std::max(moved, above(box.max()[0] - from));
            grid.move(id, box);
        }
        culler.look(grid, view, moved);
    };
    approach(1 - 20'000 * tiny);  // nearly the whole margin at once
    std::size_t visible = 0;
    bool areAllSeen = true;
    for (int frame = 0; frame < frames; ++frame) {
        approach(step);
        for (const auto& [id, box] : proxies) {
            const bool isInView = view.key(box) >= 0;
            visible += isInView ? 1 : 0;
            areAllSeen &= !isInView || culler.isVisible(id);
        }
        if (proxies[0].second.max()[0] > 8) {
            for (auto& [id, box] : proxies) {
                box.max()[0] -= 10;
            }
        }
    }
    run.expect(areAllSeen && visible > 0, "a box that enters the view by a tiny step is visible");
}

constexpr auto smallMoves = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    const int frames = run.quickOrFull(1000, 10'000);
    moveByTheMargin(run, frames);
    walkByTheMargin(run, frames);
    if (!run.isOurs) {
        return;
    }
    // A quarter of what changes the last digit of a number between a half and one.
    const Scalar tiny = std::numeric_limits<Scalar>::epsilon() / 8;
    for (const Scalar step : {tiny, above(tiny)}) {
        approachAView(run, step, 25'000);
    }
    for (const Scalar step : {Scalar(0.25), Scalar(1)}) {
        for (const Scalar by : {step, above(step), below(step)}) {
            approachAView(run, by, frames);
        }
    }
};

// --- Everything, at random ------------------------------------------------------------------------

// The pairs by brute force, kept up to date change by change.
template <class Scalar>
class Truth {
public:
    explicit Truth(std::size_t count) : boxes_(count), isThere_(count, false) {}

    void set(std::uint32_t object, const Aabb<Scalar>& box) {
        remove(object);
        boxes_[object] = box;
        isThere_[object] = true;
        for (std::uint32_t other = 0; other < boxes_.size(); ++other) {
            if (other != object && isThere_[other] && doTouch(box, boxes_[other])) {
                const PairKey pair = pairKey(object, other);
                pairs_.insert(std::lower_bound(pairs_.begin(), pairs_.end(), pair), pair);
            }
        }
    }
    void remove(std::uint32_t object) {
        isThere_[object] = false;
        std::erase_if(pairs_, [object](PairKey pair) {
            return firstOf(pair) == object || secondOf(pair) == object;
        });
    }
    [[nodiscard]] bool has(std::uint32_t object) const { return isThere_[object]; }
    [[nodiscard]] const Keys& pairs() const noexcept { return pairs_; }

private:
    Boxes<Scalar> boxes_;
    std::vector<char> isThere_;
    Keys pairs_;
};

// Mostly cubes in a crowd; sometimes points, plates, far ones, large ones.
template <class Scalar>
Aabb<Scalar> anyBox(Random& random) {
    using Point = Vector3<Scalar>;
    const auto near = [&] { return between<Scalar>(random, -4, 4); };
    const Point at(near(), near(), near());
    const float kind = random.unit();
    if (kind < 0.02F) {
        return cubeAt(at, 1e4F);
    }
    if (kind < 0.05F) {
        return cubeAt<Scalar>(1000 * at, 0.5F);
    }
    if (kind < 0.1F) {
        return {at, at};
    }
    if (kind < 0.4F) {  // on borders of cells, so that many touch exactly
        const Point low = at.array().floor();
        return {low, low + Point::Ones()};
    }
    return cubeAt(at, between<Scalar>(random, 0.1F, 1.5F));
}

constexpr auto randomChanges = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    constexpr std::uint32_t kObjects = 40;
    const int changes = run.quickOrFull(20'000, 1'000'000) / (run.isOurs ? 1 : 50);
    Random random(run.seed);
    Boxes<Scalar> boxes;
    Truth<Scalar> truth(kObjects);
    for (std::uint32_t i = 0; i < kObjects; ++i) {
        boxes.push_back(anyBox<Scalar>(random));
        truth.set(i, boxes[i]);
    }
    PairScene<Scalar> scene(run, boxes, {}, cubeAt<Scalar>({0, 0, 0}, 1e4F));
    for (int i = 0; i < changes; ++i) {
        const std::uint32_t object = indexBelow(random, kObjects);
        if (truth.has(object) && random.unit() < 0.2F) {
            scene.destroy(object);
            truth.remove(object);
        } else {
            const bool isThere = truth.has(object);
            const Aabb<Scalar> box = !isThere || random.unit() < 0.5F
                                         ? anyBox<Scalar>(random)
                                         : scene.boxes()[object].translated(Vector3<Scalar>(
                                               between<Scalar>(random, -0.1F, 0.1F), 0, 0));
            isThere ? scene.move(object, box) : scene.create(object, box);
            truth.set(object, box);
        }
        scene.findPairs();
        run.compare(scene.reported(), truth.pairs());
    }
    scene.expectValid();
    run.note(std::to_string(changes) + " changes; the pairs were compared after each change.");
};

constexpr HardCase kChurnCases[] = {
    {"H33", "one pair in many cells",
     "30 cubes of 0.9 to 20 m that all overlap, in cells of 1, 4 and 16 m; a pair shares up to 8 "
     "cells and spans 3 levels; then hashphase's cubes move apart",
     "each pair is reported once, begins once and ends once", duplicates},
    {"H34", "repeated moves by a margin",
     "btDbvtBroadphase enlarges boxes by 5 cm. Next to other boxes, a cube moves by 5 cm, 5 cm - 1 "
     "ulp and 5 cm + 1 ulp, and then by 1 ulp per frame around 5 cm, in both directions along each "
     "axis. Another cube moves on by 5 cm in each frame, past other cubes. 10,000 frames each "
     "(--quick: 1,000). For hashphase, boxes also move into a culled region by tiny steps",
     "in every frame, exact pairs; point queries at the min and max corners of the moving cube "
     "find it",
     smallMoves},
    {"H35", "random changes",
     "1,000,000 (--quick: 20,000) creations, moves and removals of 40 boxes, for Bullet's "
     "broadphases 1/50 of that; some boxes are points, large, or far away, and some only touch",
     "after each change, exactly the pairs that brute force finds", randomChanges},
};

}  // namespace

std::span<const HardCase> churnCases() {
    return kChurnCases;
}

}  // namespace hashphase::demos
