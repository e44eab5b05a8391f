// SPDX-License-Identifier: Zlib
//
// Who is near: within no distance, a negative one, all the world, and none at all; and nobody at all.

#include <demos/stability/cases/cases.hpp>

#include <array>

namespace hashphase::demos {
namespace {

// The closed ball and the closed box, in double precision: no rounding decides on these boxes.
template <class Scalar>
bool isWithin(const Aabb<Scalar>& box, const Vector3<Scalar>& center, Scalar radius) {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<double>(center[axis]);
        const double outside = std::max({static_cast<double>(box.min()[axis]) - at,
                                         at - static_cast<double>(box.max()[axis]), 0.0});
        squared += outside * outside;
    }
    const auto reach = static_cast<double>(radius);
    return reach >= 0 && squared <= reach * reach;
}

template <class Scalar>
void judgeBall(CaseRun<Scalar>& run, PairScene<Scalar>& scene, const Vector3<Scalar>& center,
               Scalar radius) {
    Objects exact;
    {
        const LimitPause pause;
        exact = objectsThat(scene.boxes(),
                            [&](const Aabb<Scalar>& box) { return isWithin(box, center, radius); });
    }
    if (scene.grid() == nullptr) {
        const Vector3<Scalar> reach = Vector3<Scalar>::Constant(radius);
        run.compare(scene.touching({center - reach, center + reach}), exact);
        return;
    }
    NoteIndices<Scalar> found;
    const QueryCost cost = scene.grid()->visit(SphereRegion<Scalar>(center, radius), found);
    run.addCost(static_cast<double>(cost.boxesTested) / static_cast<double>(scene.size()), 1);
    run.compare(found.sorted(), exact);
}

constexpr auto anyRadius = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    Random random(run.seed);
    Boxes<Scalar> boxes;
    for (int i = 0; i < 1000; ++i) {
        const auto on = [&] { return std::floor(Scalar(random.between(-160, 160))) / 8; };
        const Scalar x = on();
        const Scalar y = on();
        const Scalar z = on();
        boxes.emplace_back(Point(x, y, z), Point(x + 1, y + Scalar(0.5), z + Scalar(0.25)));
    }
    PairScene<Scalar> scene(run, boxes);
    scene.findPairs();
    const std::array centers{boxes[0].min(),         boxes[1].max(),  Point(0, 0, 0),
                             Point(3.5F, -7.25F, 1), Point(60, 0, 0), Point(1e6F, -1e6F, 1e6F)};
    for (const Point& center : centers) {
        for (const Scalar radius : {Scalar(0), Scalar(-1), Scalar(0.125F), Scalar(3), Scalar(40),
                                    Scalar(1e30F), Scalar(-1e30F), kNan<Scalar>}) {
            judgeBall(run, scene, center, radius);
        }
    }
    judgeBall(run, scene, Point(Point::Constant(kNan<Scalar>)), Scalar(3));
    run.note(run.isOurs ? "Cost: boxes that a query tests at most, divided by the number of boxes."
                        : "The query is aabbTest() with the box around the sphere.");
};

// --- Nobody --------------------------------------------------------------------------------------

/// Beyond all cells, each in a corner of its own: no pairs for many frames, and found all the same; two
/// that touch are a pair.
template <class Scalar>
void judgeStrays(CaseRun<Scalar>& run) {
    using Point = Vector3<Scalar>;
    for (const double cellSize : {0.0, 1e-30, 1.0}) {
        for (const int count : {0, 1, 40}) {
            Boxes<Scalar> boxes;
            for (int i = 0; i < count; ++i) {
                const Scalar far = Scalar(1e25F) * static_cast<Scalar>(1 + i);
                const Point at(far, -far, i % 2 == 0 ? far : -far);
                boxes.emplace_back(at, at);
            }
            PairScene<Scalar> scene(run, boxes, {.cellSize = cellSize});
            for (int frame = 0; frame < 12; ++frame) {
                scene.judge();
            }
            const Point most = Point::Constant(std::numeric_limits<Scalar>::max());
            run.compare(scene.touching({-most, most}),
                        objectsThat(boxes, [](const Aabb<Scalar>&) { return true; }));
            if (scene.grid() != nullptr) {
                scene.judgeQuery(RayRegion<Scalar>({0, 0, 0}, {1, 1, 1}));
            }
            if (count > 1) {
                scene.move(0, makeBox<Scalar>(0, 0, 0, 1, 1, 1));
                scene.move(1, makeBox<Scalar>(1, 1, 1, 2, 2, 2));
                scene.judge();
            }
            for (std::uint32_t i = 0; i < scene.size(); ++i) {
                scene.destroy(i);
            }
            scene.judge();
        }
    }
}

constexpr auto nothingThere = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    const Aabb<Scalar> world = cubeAt<Scalar>({0, 0, 0}, 2);
    for (const std::size_t count : {0U, 1U, 40U}) {
        Boxes<Scalar> boxes;
        for (std::size_t i = 0; i < count; ++i) {
            boxes.push_back(cubeAt<Scalar>({1000 + 3 * static_cast<Scalar>(i), 0, 0}, 1));
        }
        if (count > 1) {
            boxes[1] = boxes[0];  // a pair, so that not everything is nothing
        }
        PairScene<Scalar> scene(run, boxes, {}, world);
        scene.judge();
        run.compare(scene.touching(world), Objects{});
        const std::optional<Objects> onRay =
            scene.subject().rayTest({-20, 0, 0}, {20, 0, 0}, pointBox<Scalar>());
        run.compare(onRay.value_or(Objects{}), Objects{});
        // Destroyed to the last one.
        for (std::uint32_t i = 0; i < scene.size(); ++i) {
            scene.destroy(i);
        }
        scene.judge();
    }
    if (run.isOurs) {
        judgeStrays(run);
    }
};

constexpr HardCase kProximityCases[] = {
    {"H43", "radii of 0, -1, 1e30 and NaN",
     "1,000 boxes; spheres of these radii, and of 1/8, 3, 40 and -1e30 m, around six points: on "
     "boxes, between boxes, and 1e6 m away; also around a point with NaN",
     "the boxes that the closed sphere touches; none for a negative radius or NaN; no more tests "
     "than boxes",
     anyRadius},
    {"H44", "no boxes, or all boxes outside",
     "0, 1 and 40 boxes, 1 km outside the region of the queries and the world of the axis sweep; "
     "two of the 40 at one place; then all are destroyed",
     "exact pairs, no hit, no crash", nothingThere},
};

}  // namespace

std::span<const HardCase> proximityCases() {
    return kProximityCases;
}

}  // namespace hashphase::demos
