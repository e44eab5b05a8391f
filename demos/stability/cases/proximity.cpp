// SPDX-License-Identifier: Zlib
//
// Who is near: within no distance, a negative one, all the world, and none at all.

#include <demos/stability/cases/cases.hpp>

#include <demos/scenes/random.hpp>
#include <demos/stability/isolation.hpp>
#include <demos/stability/pair_scene.hpp>
#include <integration/bullet/conversions.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

using Point = Vector3<float>;

// The closed ball and the closed box, in double precision: no rounding decides on these boxes.
bool isWithin(const Aabb<float>& box, const Point& center, float radius) {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double outside = std::max(
            {static_cast<double>(box.min()[axis]) - static_cast<double>(center[axis]),
             static_cast<double>(center[axis]) - static_cast<double>(box.max()[axis]), 0.0});
        squared += outside * outside;
    }
    const auto reach = static_cast<double>(radius);
    return reach >= 0 && squared <= reach * reach;
}

void judgeBall(PairScene& scene, CaseTally& tally, const Point& center, float radius) {
    Objects exact;
    {
        const LimitPause pause;
        for (std::uint32_t i = 0; i < scene.size(); ++i) {
            if (isWithin(scene.boxes()[i], center, radius)) {
                exact.push_back(i);
            }
        }
    }
    Objects found;
    if (const SpatialHashBroadphase* hash = scene.hash()) {
        NoteIndices collector;
        const QueryCost cost = hash->grid().visit(SphereRegion<float>(center, radius), collector);
        found = std::move(collector.found);
        tally.addCost(static_cast<double>(cost.boxesTested) / static_cast<double>(scene.size()), 1);
    } else {
        NoteObjects callback;
        const Point reach = Point::Constant(radius);
        scene.broadphase().aabbTest(toBullet(center - reach), toBullet(center + reach), callback);
        found = std::move(callback.found);
    }
    std::sort(found.begin(), found.end());
    tally.compare(found, exact);
}

CaseOutcome anyRadius(const CaseContext& context) {
    Random random(context.seed);
    Boxes boxes;
    for (int i = 0; i < 1000; ++i) {
        const auto on = [&] { return std::floor(random.between(-160, 160)) / 8; };
        const float x = on();
        const float y = on();
        const float z = on();
        boxes.emplace_back(Point(x, y, z), Point(x + 1, y + 0.5F, z + 0.25F));
    }
    CaseTally tally;
    PairScene scene(context, boxes);
    scene.findPairs();
    const std::array centers{boxes[0].min(),         boxes[1].max(),  Point(0, 0, 0),
                             Point(3.5F, -7.25F, 1), Point(60, 0, 0), Point(1e6F, -1e6F, 1e6F)};
    for (const Point& center : centers) {
        for (const float radius : {0.0F, -1.0F, 0.125F, 3.0F, 40.0F, 1e30F, -1e30F,
                                   std::numeric_limits<float>::quiet_NaN()}) {
            judgeBall(scene, tally, center, radius);
        }
    }
    judgeBall(scene, tally, Point::Constant(std::numeric_limits<float>::quiet_NaN()), 3);
    tally.note(context.kind.ours ? "Cost: boxes tested at most, by all there are."
                                 : "By aabbTest() with the box around the ball.");
    return tally.outcome();
}

constexpr std::array kProximityCases{
    HardCase{
        "H43", "radii of 0, -1, 1e30 and NaN",
        "balls of such radii, and of 1/8, 3 and 40 m, around six points, on boxes, between them, "
        "and 1e6 m outside of all 1,000",
        "the closed ball, empty for negative and NaN; no more tests than boxes", anyRadius},
};

}  // namespace

std::span<const HardCase> proximityCases() {
    return kProximityCases;
}

}  // namespace hashphase::demos
