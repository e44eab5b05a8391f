// SPDX-License-Identifier: Zlib
//
// Rays along axes, borders and corners; of no length, too long, and none at all.

#include <demos/stability/cases/cases.hpp>

#include <demos/accuracy/exact_entry.hpp>
#include <demos/scenes/random.hpp>
#include <demos/stability/isolation.hpp>
#include <demos/stability/pair_scene.hpp>
#include <integration/bullet/conversions.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace hashphase::demos {
namespace {

using Point = Vector3<float>;

/// Notes objects, with the fields that btCollisionWorld::rayTest() gives its callback.
struct NoteHits final : btBroadphaseRayCallback {
    NoteHits(const btVector3& from, const btVector3& to) {
        btVector3 direction = to - from;
        direction /= direction.length();
        for (int axis = 0; axis < 3; ++axis) {
            m_rayDirectionInverse[axis] =
                direction[axis] == 0 ? btScalar(BT_LARGE_FLOAT) : btScalar(1) / direction[axis];
            m_signs[axis] = m_rayDirectionInverse[axis] < 0 ? 1 : 0;
        }
        m_lambda_max = direction.dot(to - from);
    }

    bool process(const btBroadphaseProxy* proxy) override {
        found.push_back(FilledBroadphase::objectOf(*proxy));
        return true;
    }

    Objects found;
};

/// What rays find, of ours both ways: asked by Grid::visit(), and by rayTest(), which is to answer as
/// Bullet's test of a box does.
struct RayTally : CaseTally {
    CaseTally throughBullet;
    bool isOurs = false;

    [[nodiscard]] CaseOutcome outcome() {
        if (isOurs) {
            note("By Grid::visit(). By its rayTest(), where Bullet's btRayAabb2() decides: " +
                 outcomeText(throughBullet.outcome()) + ".");
        }
        return CaseTally::outcome();
    }
};

class RayScene {
public:
    RayScene(const CaseContext& context, Boxes boxes, const GridConfig& grid = {})
        : scene_(context, std::move(boxes), grid) {
        scene_.findPairs();
    }

    /// Compares what the ray meets with the boxes for which isHit() is true: of ours by Grid::visit(),
    /// of others by rayTest().
    template <class IsHit>
    void judge(RayTally& tally, const Point& from, const Point& to, const IsHit& isHit) {
        const Objects exact = truth(isHit);
        if (const SpatialHashBroadphase* hash = scene_.hash()) {
            NoteIndices collector;
            cost_ = hash->grid().visit(RayRegion<float>(from, to), collector);
            tally.compare(sorted(std::move(collector.found)), exact);
            tally.isOurs = true;
            const Objects hits = throughBullet(from, to);
            tally.throughBullet.compare(hits, exact);
            tally.expect(hits == passing(from, to),
                         "rayTest() answers as btRayAabb2() of each box");
        } else {
            tally.compare(throughBullet(from, to), exact);
        }
    }

    /// In integers: for coordinates on the lattice of ExactRay.
    void judge(RayTally& tally, const Point& from, const Point& to) {
        const ExactRay exact(from, to);
        judge(tally, from, to,
              [&](const Aabb<float>& box) { return exact.entry(box).has_value(); });
    }

    /// Of the last ray of ours.
    [[nodiscard]] const QueryCost& cost() const noexcept { return cost_; }
    [[nodiscard]] bool isOurs() const noexcept { return scene_.hash() != nullptr; }
    [[nodiscard]] const Boxes& boxes() const noexcept { return scene_.boxes(); }

private:
    static Objects sorted(Objects objects) {
        std::sort(objects.begin(), objects.end());
        return objects;
    }

    [[nodiscard]] Objects throughBullet(const Point& from, const Point& to) {
        const btVector3 begin = toBullet(from);
        const btVector3 end = toBullet(to);
        NoteHits callback(begin, end);
        scene_.broadphase().rayTest(begin, end, callback);
        return sorted(std::move(callback.found));
    }

    // The boxes that pass Bullet's test, called as btDbvtBroadphase does.
    [[nodiscard]] Objects passing(const Point& from, const Point& to) const {
        const btVector3 begin = toBullet(from);
        const NoteHits fields(begin, toBullet(to));
        return truth([&](const Aabb<float>& box) {
            const std::array<btVector3, 2> bounds{toBullet(box.min()), toBullet(box.max())};
            btScalar enter = 0;
            return btRayAabb2(begin, fields.m_rayDirectionInverse, fields.m_signs, bounds.data(),
                              enter, 0, fields.m_lambda_max);
        });
    }

    template <class IsHit>
    [[nodiscard]] Objects truth(const IsHit& isHit) const {
        const LimitPause pause;
        Objects hit;
        for (std::uint32_t i = 0; i < boxes().size(); ++i) {
            if (isHit(boxes()[i])) {
                hit.push_back(i);
            }
        }
        return hit;
    }

    PairScene scene_;
    QueryCost cost_;
};

// Cubes of 1 m that fill a block, side by side.
Boxes block(int side) {
    Boxes boxes;
    for (int x = 0; x < side; ++x) {
        for (int y = 0; y < side; ++y) {
            for (int z = 0; z < side; ++z) {
                const Point low(static_cast<float>(x), static_cast<float>(y),
                                static_cast<float>(z));
                boxes.emplace_back(low, low + Point::Ones());
            }
        }
    }
    return boxes;
}

// Boxes on multiples of 1/64 m.
Boxes latticeBoxes(int count, float side, std::uint64_t seed) {
    Random random(seed);
    const auto rounded = [&](float low, float high) {
        return std::floor(64 * random.between(low, high)) / 64;
    };
    Boxes boxes;
    for (int i = 0; i < count; ++i) {
        Point low;
        Point size;
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = rounded(-side / 2, side / 2);
            size[axis] = rounded(0.25F, 3);
        }
        boxes.emplace_back(low, low + size);
    }
    return boxes;
}

CaseOutcome alongAxes(const CaseContext& context) {
    RayTally tally;
    Boxes boxes = latticeBoxes(399, 24, context.seed);
    boxes.insert(boxes.begin(), {Point::Zero(), Point::Ones()});
    RayScene scene(context, boxes);
    for (std::uint32_t i = 0; i < scene.boxes().size(); i += 8) {
        const Aabb<float> box = scene.boxes()[i];
        for (int axis = 0; axis < 3; ++axis) {
            for (const Point& through : {box.min(), box.max(), Point(box.center())}) {
                for (const float away : {30.0F, -30.0F}) {
                    Point from = through;
                    Point to = through;
                    from[axis] = -away;
                    to[axis] = away;
                    // Through a corner at 0, the difference is -0 on another axis.
                    to[(axis + 1) % 3] = from[(axis + 1) % 3] == 0 ? -0.0F : to[(axis + 1) % 3];
                    scene.judge(tally, from, to);
                }
            }
        }
    }
    return tally.outcome();
}

CaseOutcome alongBorders(const CaseContext& context) {
    RayTally tally;
    constexpr int kSide = 8;
    RayScene scene(context, block(kSide), {.cellSize = 1});
    const Point ones = Point::Ones();
    for (int k = 0; k <= kSide; ++k) {
        const auto at = static_cast<float>(k);
        for (int axis = 0; axis < 3; ++axis) {
            Point from = Point::Constant(at);
            Point to = from;
            from[axis] = -1;
            to[axis] = kSide + 1;
            scene.judge(tally, from, to);  // along an edge that four cubes share
            from[(axis + 1) % 3] = to[(axis + 1) % 3] = 0.5F;
            scene.judge(tally, from, to);  // in a face that two share
        }
    }
    const float end = kSide + 1;
    scene.judge(tally, -ones, end * ones);  // through corners
    scene.judge(tally, end * ones, -ones);
    scene.judge(tally, {-1, end, -1}, {end, -1, end});
    scene.judge(tally, {-1, -1, 3}, {end, end, 3});  // through edges
    scene.judge(tally, {0, 0, -1}, {kSide, kSide, 3});
    return tally.outcome();
}

CaseOutcome noLength(const CaseContext& context) {
    RayTally tally;
    RayScene scene(context, latticeBoxes(200, 10, context.seed));
    for (std::uint32_t i = 0; i < 200; i += 5) {
        const Aabb<float> box = scene.boxes()[i];
        for (const Point& point : {box.min(), box.max(), Point(box.min() + box.sizes() / 2),
                                   Point(box.max() + Point::Constant(0.25F))}) {
            scene.judge(tally, point, point,
                        [&](const Aabb<float>& other) { return other.contains(point); });
        }
    }
    return tally.outcome();
}

// A ray far along x through boxes here and there; how much our walk reads is bounded by what is there.
CaseOutcome farAlong(const CaseContext& context, float length, const Point& slope, float aside) {
    Boxes boxes;
    constexpr int kBoxes = 200;
    for (int i = 0; i <= kBoxes; ++i) {
        const float share = static_cast<float>(i) / kBoxes;
        Point on = (share * length) * slope;
        on = (on / 4).array().round() * 4;  // on the lattice of ExactRay, however far
        boxes.push_back({on - Point::Constant(4), on + Point::Constant(4)});
        const Point beside = on + Point(0, i % 2 == 0 ? aside : -aside, 0);
        boxes.push_back({beside - Point::Constant(4), beside + Point::Constant(4)});
    }
    RayTally tally;
    RayScene scene(context, boxes, {.cellSize = 1});
    Point to = length * slope;
    to = (to / 4).array().round() * 4;
    for (const auto& [begin, end] :
         {std::pair(Point(0, 0, 0), to), std::pair(to, Point(0, 0, 0))}) {
        scene.judge(tally, begin, end);
        if (scene.isOurs()) {
            const double all = static_cast<double>(boxes.size());
            tally.addCost(static_cast<double>(scene.cost().rowsVisited) / all, 3);
        }
    }
    if (scene.isOurs()) {
        tally.note("Cost: blocks of boxes read for each box that is there.");
    }
    return tally.outcome();
}

CaseOutcome manyCells(const CaseContext& context) {
    // A ray errs to the side of a hit by what its coordinates are rounded by: metres, there.
    return farAlong(context, 3.4e7F, Point(1, 0.5F, -0.25F), 1024);
}

CaseOutcome hundredThousandCells(const CaseContext& context) {
    return farAlong(context, 1e5F, Point(1, 0.37F, 0.61F), 12);
}

CaseOutcome tooLongForSquares(const CaseContext& context) {
    RayTally tally;
    for (const float length : {1e18F, 1e19F, 1e25F, 1e38F}) {
        Boxes boxes = latticeBoxes(200, 20, context.seed);
        boxes.push_back({Point(0.4F * length, -0.01F * length, -2), Point(length, length, 2)});
        RayScene scene(context, boxes);
        for (int axis = 0; axis < 3; ++axis) {
            for (const float sign : {1.0F, -1.0F}) {
                const Point through(0.5F, -0.25F, 1.5F);
                Point from = through;
                Point to = through;
                from[axis] = -sign * length / 2;
                to[axis] = sign * length / 2;
                // Along an axis, comparing coordinates decides.
                const Aabb<float> line(from.cwiseMin(to), from.cwiseMax(to));
                scene.judge(tally, from, to,
                            [&](const Aabb<float>& box) { return overlaps(box, line); });
            }
        }
    }
    return tally.outcome();
}

CaseOutcome noRay(const CaseContext& context) {
    RayTally tally;
    RayScene scene(context, latticeBoxes(2000, 40, context.seed));
    const auto never = [](const Aabb<float>& /*box*/) { return false; };
    scene.judge(tally, {-30, 1, 2}, {30, -1, 3});
    const double normalWork = static_cast<double>(scene.cost().rowsVisited);
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    double worst = 0;
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
        for (int axis = 0; axis < 3; ++axis) {
            Point from(-30, 1, 2);
            Point to(30, -1, 3);
            from[axis] = bad;
            scene.judge(tally, from, to, never);
            worst = std::max(worst, static_cast<double>(scene.cost().rowsVisited));
            from[axis] = 0;
            to[axis] = bad;
            scene.judge(tally, from, to, never);
            worst = std::max(worst, static_cast<double>(scene.cost().rowsVisited));
        }
    }
    if (scene.isOurs()) {
        tally.addCost(worst / normalWork, 2.5);
        tally.note("Cost: blocks read, by those of a ray that is one.");
    }
    return tally.outcome();
}

constexpr std::array kRayCases{
    HardCase{
        "H13", "rays along an axis",
        "rays along x, y and z, both ways, through the corners and centres of 50 of 400 boxes, one "
        "of them with a corner at 0; other components of the direction 0 and -0",
        "what the segment meets, closed", alongAxes},
    HardCase{"H14", "rays in faces, edges and corners",
             "512 cubes side by side, cells of 1 m; rays in the faces that they share, along their "
             "edges, through their corners",
             "the cubes on all sides", alongBorders},
    HardCase{"H15", "rays of no length",
             "from a point to itself: corners and insides of 40 of 200 boxes, and beside them",
             "what contains the point", noLength},
    HardCase{"H16", "a ray through 3.4e7 cells",
             "cells of 1 m, a ray of 3.4e7 m there and back, 201 boxes of 8 m on it, as many 1 km "
             "aside",
             "all hits; the work follows the boxes that there are, not the cells", manyCells},
    HardCase{
        "H17", "a ray through 1e5 cells",
        "cells of 1 m, a slanting ray of 1e5 m there and back, 201 boxes of 8 m on it, as many "
        "12 m aside",
        "all hits, up to the end; the work follows the boxes", hundredThousandCells},
    HardCase{"H18", "rays of 1e18 to 1e38 m",
             "rays along the axes, as long as that, whose squared lengths overflow; 201 boxes",
             "what the segment meets", tooLongForSquares},
    HardCase{"H19", "rays with NaN or infinity",
             "NaN and both infinities in each component of each end; 2,000 boxes",
             "no hit, at no more than 2.5 times the work of a ray", noRay},
};

}  // namespace

std::span<const HardCase> rayCases() {
    return kRayCases;
}

}  // namespace hashphase::demos
