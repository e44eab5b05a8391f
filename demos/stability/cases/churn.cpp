// SPDX-License-Identifier: Zlib
//
// Changes: of one pair in many cells, by a hair, again and again, and of everything at random.

#include <demos/stability/cases/cases.hpp>

#include <broadphase/pairs.hpp>
#include <demos/scenes/random.hpp>
#include <demos/stability/grid_scene.hpp>
#include <demos/stability/pair_scene.hpp>
#include <integration/bullet/conversions.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

using Point = Vector3<float>;

// --- Once -----------------------------------------------------------------------------------------

CaseOutcome duplicates(const CaseContext& context) {
    CaseTally tally;
    Boxes boxes;
    for (const float edge : {0.9F, 1.1F, 3.5F, 4.5F, 15.0F, 20.0F}) {
        for (int i = 0; i < 5; ++i) {
            boxes.push_back(cubeAt(Point::Constant(0.125F * static_cast<float>(i)), edge));
        }
    }
    PairScene scene(context, boxes, {.cellSize = 1, .levelRatio = 4});
    scene.judge(tally);
    if (context.kind.ours) {
        Grid<float> grid({.cellSize = 1, .levelRatio = 4});
        Pairs<float> pairs(grid);
        std::vector<ProxyId> ids;
        for (const Aabb<float>& box : boxes) {
            ids.push_back(grid.add(box));
        }
        const auto all = [](ProxyId, ProxyId) { return true; };
        const auto keysOf = [](std::span<const ProxyPair> of) {
            std::vector<PairKey> keys;
            for (const ProxyPair& pair : of) {
                keys.push_back(keyOf(pair));
            }
            return keys;
        };
        tally.compare(keysOf(pairs.update(all).born), scene.exact());
        tally.expect(pairs.update(all).born.empty(), "a pair is born once");
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const float far = 100 * static_cast<float>(i + 1);
            grid.move(ids[i], boxes[i].translated(Point(far, 0, 0)));
        }
        tally.compare(keysOf(pairs.update(all).died), scene.exact());
        tally.expect(pairs.update(all).died.empty(), "a pair dies once");
    }
    return tally.outcome();
}

// --- By a hair ------------------------------------------------------------------------------------

constexpr float kMargin = 0.05F;  // by which btDbvtBroadphase fattens boxes [m]

// An ulp of the margin [m]. As long as nothing is farther from 0 than 2^24 of them, moves by the
// margin and an ulp more or less are not rounded.
constexpr float kMarginUlp = 0x1p-28F;

constexpr std::array kUlpsBeyond{-1.0F, 0.0F, 1.0F};

// A cube at 0, and on each of its sides three boxes side by side that begin where the cube ends
// when it has moved by the margin, an ulp less and an ulp more.
Boxes boxesAtTheMargin() {
    constexpr float kHalf = 0x1p20F * kMarginUlp;  // 4 mm
    Boxes boxes{cubeAt({0, 0, 0}, 2 * kHalf)};
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool isBelow : {false, true}) {
            for (const float ulps : kUlpsBeyond) {
                Point low = Point::Constant(-kHalf / 4);
                Point high = Point::Constant(kHalf / 4);
                low[(axis + 1) % 3] += ulps * 0.75F * kHalf;
                high[(axis + 1) % 3] += ulps * 0.75F * kHalf;
                low[axis] = kHalf + kMargin + ulps * kMarginUlp;
                high[axis] = low[axis] + kHalf;
                boxes.push_back(isBelow ? Aabb<float>(-high, -low) : Aabb<float>(low, high));
            }
        }
    }
    return boxes;
}

// What is kept of the mover, however fat, has it at both ends.
void expectFoundWhereItIs(PairScene& scene, CaseTally& tally) {
    const Aabb<float> box = scene.boxes()[0];
    for (const Point& end : {box.min(), box.max()}) {
        NoteObjects callback;
        scene.broadphase().aabbTest(toBullet(end), toBullet(end), callback);
        tally.expect(std::count(callback.found.begin(), callback.found.end(), 0U) == 1,
                     "a mover is found at both its ends");
    }
}

void judgeMove(PairScene& scene, CaseTally& tally) {
    scene.judge(tally);
    expectFoundWhereItIs(scene, tally);
    if (const SpatialHashBroadphase* hash = scene.hash()) {
        tally.expect(hash->validate().empty(), "all invariants hold in every frame");
    }
}

// To the margin and back at a stroke, by an ulp less, nothing and an ulp more, then creeping across
// it by an ulp a frame; along each axis, both ways.
void moveByTheMargin(const CaseContext& context, CaseTally& tally, int frames) {
    PairScene scene(context, boxesAtTheMargin());
    const Aabb<float> rest = scene.boxes()[0];
    constexpr float kAtRest = kInfinity;
    constexpr std::array kPlaces{-1.0F, kAtRest, 0.0F, kAtRest, 1.0F,  kAtRest,
                                 -1.0F, 0.0F,    1.0F, 0.0F,    -1.0F, kAtRest};
    for (int frame = 0; frame < frames; ++frame) {
        const std::size_t place = static_cast<std::size_t>(frame) % kPlaces.size();
        const int round = frame / static_cast<int>(kPlaces.size());
        Point by = Point::Zero();
        if (kPlaces[place] != kAtRest) {
            const float step = kMargin + kPlaces[place] * kMarginUlp;
            by[round % 3] = round / 3 % 2 == 0 ? step : -step;
        }
        scene.move(0, rest.translated(by));
        judgeMove(scene, tally);
        const Point moved = scene.boxes()[0].min() - rest.min();
        tally.expect(moved == by && scene.boxes()[0].max() - rest.max() == by,
                     "no move by the margin is rounded");
    }
}

// On and on by the margin, past others.
void walkByTheMargin(const CaseContext& context, CaseTally& tally, int frames) {
    Boxes boxes{cubeAt({0, 0, 0}, 1)};
    for (int i = 0; i < frames / 100; ++i) {
        boxes.push_back(cubeAt({5 * static_cast<float>(i), 1, 0}, 1));
    }
    const Aabb<float> world(Point::Constant(-10),
                            Point::Constant(0.1F * static_cast<float>(frames)));
    PairScene scene(context, boxes, {}, world);
    for (int frame = 0; frame < frames; ++frame) {
        scene.move(0, scene.boxes()[0].translated(Point(kMargin, 0, 0)));
        judgeMove(scene, tally);
    }
}

CaseOutcome smallMoves(const CaseContext& context) {
    CaseTally tally;
    const int frames = context.quickOrFull(1000, 10'000);
    moveByTheMargin(context, tally, frames);
    walkByTheMargin(context, tally, frames);
    return tally.outcome();
}

// --- Everything, at random ------------------------------------------------------------------------

// The pairs by brute force, kept up to date change by change.
class Truth {
public:
    explicit Truth(std::size_t count) : boxes_(count), isThere_(count, false) {}

    void set(std::uint32_t object, const Aabb<float>& box) {
        remove(object);
        boxes_[object] = box;
        isThere_[object] = true;
        for (std::uint32_t other = 0; other < boxes_.size(); ++other) {
            if (other != object && isThere_[other] && overlaps(box, boxes_[other])) {
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
    [[nodiscard]] const std::vector<PairKey>& pairs() const noexcept { return pairs_; }

private:
    Boxes boxes_;
    std::vector<char> isThere_;
    std::vector<PairKey> pairs_;
};

// Mostly cubes in a crowd; sometimes points, plates, far ones, large ones.
Aabb<float> anyBox(Random& random) {
    const auto near = [&] { return random.between(-4, 4); };
    const Point at(near(), near(), near());
    const float kind = random.unit();
    if (kind < 0.02F) {
        return cubeAt(at, 1e4F);
    }
    if (kind < 0.05F) {
        return cubeAt(1000 * at, 0.5F);
    }
    if (kind < 0.1F) {
        return {at, at};
    }
    if (kind < 0.4F) {  // on borders of cells, so that many touch exactly
        const Point low = at.array().floor();
        return {low, low + Point::Ones()};
    }
    return cubeAt(at, random.between(0.1F, 1.5F));
}

CaseOutcome randomChanges(const CaseContext& context) {
    constexpr std::uint32_t kObjects = 40;
    const int changes = context.quickOrFull(20'000, 1'000'000) / (context.kind.ours ? 1 : 50);
    CaseTally tally;
    Random random(context.seed);
    Boxes boxes;
    Truth truth(kObjects);
    for (std::uint32_t i = 0; i < kObjects; ++i) {
        boxes.push_back(anyBox(random));
        truth.set(i, boxes[i]);
    }
    PairScene scene(context, boxes, {}, cubeAt({0, 0, 0}, 1e4F));
    for (int i = 0; i < changes; ++i) {
        const auto object = static_cast<std::uint32_t>(random.unit() * kObjects);
        if (!truth.has(object)) {
            const Aabb<float> box = anyBox(random);
            scene.create(object, box);
            truth.set(object, box);
        } else if (random.unit() < 0.2F) {
            scene.destroy(object);
            truth.remove(object);
        } else {
            const Aabb<float> box =
                random.unit() < 0.5F
                    ? anyBox(random)
                    : scene.boxes()[object].translated(Point(random.between(-0.1F, 0.1F), 0, 0));
            scene.move(object, box);
            truth.set(object, box);
        }
        scene.findPairs();
        tally.compare(scene.reported(), truth.pairs());
    }
    if (const SpatialHashBroadphase* hash = scene.hash()) {
        tally.expect(hash->validate().empty(), "all invariants hold");
    }
    tally.note(std::to_string(changes) + " changes, compared after each.");
    return tally.outcome();
}

constexpr std::array kChurnCases{
    HardCase{
        "H33", "one pair in many cells",
        "30 cubes of 0.9 to 20 m in each other, cells of 1, 4 and 16 m: pairs that share up to 8 "
        "cells and span 3 levels",
        "each pair once; born once, died once", duplicates},
    HardCase{
        "H34", "moves by a margin, again and again",
        "a cube that moves by 5 cm and back, by 1 ulp less and 1 ulp more, and across by 1 ulp at "
        "a "
        "time, to where boxes begin, along each axis, both ways; one that moves on by 5 cm, past "
        "others; 10,000 frames each (--quick: 1,000); btDbvtBroadphase fattens boxes by 5 cm",
        "exact pairs, and a mover that is found at both its ends, in every frame", smallMoves},
    HardCase{
        "H35", "changes at random",
        "1,000,000 (--quick: 20,000; a fiftieth of it for the others) creations, moves and "
        "removals of 40 boxes, among them points, large and far ones, and such as touch exactly",
        "the pairs of brute force after each", randomChanges},
};

}  // namespace

std::span<const HardCase> churnCases() {
    return kChurnCases;
}

}  // namespace hashphase::demos
