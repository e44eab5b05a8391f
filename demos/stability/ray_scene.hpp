// SPDX-License-Identifier: Zlib
#pragma once

// Boxes, and whether rays find those that they meet.

#include <demos/stability/scene.hpp>

namespace hashphase::demos {

/// Cubes of 1 m that fill a block, side by side.
template <class Scalar>
[[nodiscard]] Boxes<Scalar> block(int side) {
    Boxes<Scalar> boxes;
    for (int i = 0; i < side * side * side; ++i) {
        const Vector3<Scalar> low =
            Vector3<int>(i / side / side, i / side % side, i % side).cast<Scalar>();
        boxes.emplace_back(low, low + Vector3<Scalar>::Ones());
    }
    return boxes;
}

/// Boxes on multiples of 1/64 m.
template <class Scalar>
[[nodiscard]] Boxes<Scalar> latticeBoxes(int count, float side, std::uint64_t seed) {
    Random random(seed);
    const auto rounded = [&](float low, float high) {
        return static_cast<Scalar>(std::floor(64 * random.between(low, high)) / 64);
    };
    Boxes<Scalar> boxes;
    for (int i = 0; i < count; ++i) {
        Vector3<Scalar> low;
        Vector3<Scalar> size;
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = rounded(-side / 2, side / 2);
            size[axis] = rounded(0.25F, 3);
        }
        boxes.emplace_back(low, low + size);
    }
    return boxes;
}

/// Of ours: how its rays fare by rayTest().
template <class Scalar>
void noteRaysThroughBullet(CaseRun<Scalar>& run) {
    const CaseOutcome outcome = run.throughBullet.outcome();
    if (outcome.kind == OutcomeKind::nothing) {
        return;
    }
    std::string text;
    for (const auto& [sign, count] :
         {std::pair(" -", outcome.missing), std::pair(" +", outcome.extra)}) {
        text += count > 0 ? sign + std::to_string(count) : "";
    }
    run.note(
        "This outcome is for Grid::visit(). Outcome for rayTest(), which uses Bullet's "
        "btRayAabb2():" +
        (text.empty() ? " exact" : text) + ".");
}

/// What rays find, of ours asked by Grid::visit(), and of broadphases by rayTest(), which is to answer
/// as Bullet's test of a box does.
template <class Scalar>
class RayScene {
public:
    using Box = Aabb<Scalar>;
    using Point = Vector3<Scalar>;

    RayScene(CaseRun<Scalar>& run, Boxes<Scalar> boxes, const GridConfig& grid = {})
        : run_(run), scene_(run, std::move(boxes), grid) {
        scene_.findPairs();
    }

    /// Compares what the ray meets with the boxes for which isHit() is true.
    template <class IsHit>
    void judge(const Point& from, const Point& to, const IsHit& isHit) {
        judge(from, to, pointBox<Scalar>(),
              [&](const Objects&) { return objectsThat(boxes(), isHit); });
    }

    /// The same in integers. Beside what the ray meets, it may find what is nearer to it than `doubt`
    /// of the coordinates at hand.
    void judge(const Point& from, const Point& to, const Lattice& lattice, double doubt = 0,
               const Box& fatness = pointBox<Scalar>()) {
        const auto reach = [](const Point& point) {
            return static_cast<double>(point.cwiseAbs().maxCoeff());
        };
        judge(from, to, fatness, [&](const Objects& found) {
            Objects exact;
            for (std::uint32_t i = 0; i < boxes().size(); ++i) {
                const Box& box = boxes()[i];
                const double far = reach(box.min()) + reach(box.max()) + reach(from) + reach(to);
                if (lattice.meets(from, to, box, fatness) ||
                    (doubt > 0 && std::binary_search(found.begin(), found.end(), i) &&
                     lattice.meets(from, to, box, fatness, doubt * far))) {
                    exact.push_back(i);
                }
            }
            return exact;
        });
    }

    /// When all is filed, much waits, and all is at rest; others only as they are.
    template <class Ask>
    void atEveryStage(const Ask& ask) {
        ask();
        if (!run_.isOurs) {
            return;
        }
        isLater_ = true;
        for (std::uint32_t i = 0; i < scene_.size(); i += 2) {
            scene_.move(i, boxes()[i].translated(Point(0.25F, 0, -0.5F)));
        }
        ask();
        for (int frame = 0; frame < 20; ++frame) {
            scene_.findPairs();
        }
        ask();
    }

    /// Of the last ray of ours.
    [[nodiscard]] const QueryCost& cost() const noexcept { return cost_; }
    [[nodiscard]] bool isOurs() const { return scene_.grid() != nullptr; }
    [[nodiscard]] const Boxes<Scalar>& boxes() const noexcept { return scene_.boxes(); }
    [[nodiscard]] PairScene<Scalar>& pairs() noexcept { return scene_; }

private:
    template <class ExactOf>
    void judge(const Point& from, const Point& to, const Box& fatness, const ExactOf& exactOf) {
        const std::optional<Objects> throughBullet = scene_.subject().rayTest(from, to, fatness);
        if (!isOurs()) {
            const LimitPause pause;
            run_.compare(*throughBullet, exactOf(*throughBullet));
            return;
        }
        NoteIndices<Scalar> collector;
        const RayRegion<Scalar> region(from, to, fatness);
        cost_ = scene_.grid()->visit(region, collector);
        const Objects found = collector.sorted();
        NoteIndices<Scalar> together;
        scene_.grid()->visitEach(std::span(&region, 1), std::span(&together, 1));
        const LimitPause pause;
        run_.compare(found, exactOf(found));
        run_.expect(together.sorted() == found,
                    "visitEach() finds the same boxes as visit() for a ray");
        if (throughBullet) {
            if (fatness.min() == fatness.max() && !isLater_) {
                run_.throughBullet.compare(*throughBullet, exactOf(*throughBullet));
            }
            run_.expect(*throughBullet == objectsThat(boxes(),
                                                      [&](const Box& box) {
                                                          return scene_.subject().passesRayTest(
                                                              from, to, fatness, box);
                                                      }),
                        "rayTest() finds exactly the boxes that btRayAabb2() accepts");
        }
    }

    CaseRun<Scalar>& run_;
    PairScene<Scalar> scene_;
    QueryCost cost_;
    bool isLater_ = false;  // than the stage that others see, too
};

}  // namespace hashphase::demos
