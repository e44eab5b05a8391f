// SPDX-License-Identifier: Zlib

// Rays and boxes through a scene, as btCollisionWorld casts them, and rays between two writes.

#include <demos/scenes/random.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/camera/camera.hpp>
#include <tests/benchmarks/query_workload.hpp>
#include <tests/support/camera_matrices.hpp>

#include <LinearMath/btAabbUtil2.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace hashphase::benchmarks {
namespace {

using demos::Random;
using Boxes = std::vector<Aabb<float>>;

// --- Which rays ------------------------------------------------------------------------------------

struct Ray {
    btVector3 from;
    btVector3 to;
};

/// Draws one ray through these boxes.
using DrawRay = Ray (*)(Random&, const Boxes&);

// From the neighbourhood of one box to that of another: rays where the boxes are.
Ray rayBetweenBoxes(Random& random, const Boxes& boxes) {
    const auto near = [&random](const Aabb<float>& box) {
        const Vector3<float> off(random.between(-2, 2), random.between(-2, 2),
                                 random.between(-2, 2));
        return toBullet(box.center() + off);
    };
    const btVector3 from = near(anyBox(random.unit(), boxes));
    return {from, near(anyBox(random.unit(), boxes))};
}

// The same start, and a way of so many metres.
Ray shortened(const Ray& ray, float length) {
    const btVector3 way = ray.to - ray.from;
    return {ray.from, way.fuzzyZero() ? ray.from : ray.from + way.normalized() * length};
}

Ray shortRay(Random& random, const Boxes& boxes) {
    constexpr float kShort = 5;  // [m]
    return shortened(rayBetweenBoxes(random, boxes), kShort);
}

// What a wheel or a foot stands on: straight down from a box, a few of its edges.
Ray rayBelowBox(Random& random, const Boxes& boxes) {
    constexpr float kFewEdges = 3;
    const Aabb<float>& box = anyBox(random.unit(), boxes);
    const btVector3 from = toBullet(box.center());
    return {from, from - btVector3(0, kFewEdges * box.sizes().mean(), 0)};
}

Ray rayOf30Edges(Random& random, const Boxes& boxes) {
    const float edge = anyBox(random.unit(), boxes).sizes().mean();
    return shortened(rayBetweenBoxes(random, boxes), 30 * edge);
}

// From as far east as one box and as far north as another: where mostly nothing is. To any box, but 100 m at
// most.
Ray rayFromNowhere(Random& random, const Boxes& boxes) {
    btVector3 from = toBullet(anyBox(random.unit(), boxes).center());
    from.setZ(anyBox(random.unit(), boxes).center().z());
    const btVector3 to = toBullet(anyBox(random.unit(), boxes).center());
    return shortened({from, to}, std::min(to.distance(from), 100.0F));
}

// A shot across the country: from eye level above one walker to the feet of another, up to 100 m on.
Ray rayOverTerrain(Random& random, const Boxes& boxes) {
    constexpr float kFarthest = 100;
    const Aabb<float>& shooter = anyBox(random.unit(), boxes);
    const Aabb<float>& target = anyBox(random.unit(), boxes);
    const btVector3 from = toBullet(shooter.center()) + btVector3(0, 3, 0);
    const btVector3 way = toBullet(target.center()) - from;
    return shortened({from, from + way}, std::min(way.length(), kFarthest));
}

// What is under a pointer anywhere on the screen: the camera looks at one of the boxes from 40 m away.
Ray rayThroughPixel(Random& random, const Boxes& boxes) {
    constexpr Viewport kWindow{0, 0, 1920, 1080};
    const test::CameraLens lens;
    const Vector3<double> target = anyBox(random.unit(), boxes).center().cast<double>();
    const Vector3<double> eye = target + Vector3<double>(24, 20, 24);
    const Camera<float> view(test::cameraMatrix<float>(lens, eye, target), lens.depthRange,
                             kWindow);
    const RayRegion<float> ray =
        view.rayThrough({random.between(0, 1920), random.between(0, 1080)});
    return {toBullet(ray.from()), toBullet(ray.from() + ray.direction())};
}

Ray drawRay(DrawRay draw, Random& random, const Boxes& boxes) {
    Ray ray = draw(random, boxes);
    while (ray.from == ray.to) {
        ray = draw(random, boxes);
    }
    return ray;
}

// --- What is asked ---------------------------------------------------------------------------------

/// What the ray meets, or what overlaps a box of 2 m around its start, or only how far the nearest box of
/// the ray is.
enum class Probe { ray, box, closest };

// The callback that btCollisionWorld::rayTest() makes, as far as broadphases see it.
struct RayCallback : btBroadphaseRayCallback {
    explicit RayCallback(const Ray& ray) {
        const btVector3 way = ray.to - ray.from;
        const btVector3 direction = way.normalized();
        for (int axis = 0; axis < 3; ++axis) {
            m_rayDirectionInverse[axis] =
                direction[axis] == 0 ? BT_LARGE_FLOAT : 1 / direction[axis];
            m_signs[axis] = m_rayDirectionInverse[axis] < 0 ? 1U : 0U;
        }
        m_lambda_max = direction.dot(way);
    }

    /// True when the cast box meets the box on its way: what every broadphase is to report.
    [[nodiscard]] bool meets(const Ray& ray, const Aabb<float>& box,
                             const btVector3& castHalfExtents) const {
        const std::array bounds{toBullet(box.min()) - castHalfExtents,
                                toBullet(box.max()) + castHalfExtents};
        btScalar distance = 1;
        return btRayAabb2(ray.from, m_rayDirectionInverse, m_signs, bounds.data(), distance, 0,
                          m_lambda_max);
    }
};

// Lists what a query finds: a ray, given as arguments of RayCallback, or a box.
template <class Callback>
struct Finds : Callback {
    template <class... Args>
    Finds(std::size_t number, std::vector<Answer>& answers, const Args&... args)
        : Callback(args...), number_(number), answers_(answers) {}

    bool process(const btBroadphaseProxy* proxy) override {
        answers_.push_back(answerOf(number_, demos::FilledBroadphase::objectOf(*proxy)));
        return true;
    }

private:
    std::size_t number_;
    std::vector<Answer>& answers_;
};

// The nearest of all hits: stock Bullet cannot stop early.
struct ClosestHit : RayCallback {
    explicit ClosestHit(const Ray& ray)
        : RayCallback(ray), region_(toEigen(ray.from), toEigen(ray.to)) {}

    bool process(const btBroadphaseProxy* proxy) override {
        take(toAabb(proxy->m_aabbMin, proxy->m_aabbMax));
        return true;
    }
    void take(const Aabb<float>& box) {
        const float key = region_.key(box);
        closest = key >= 0 ? std::min(closest, key) : closest;
    }

    float closest = std::numeric_limits<float>::infinity();

private:
    RayRegion<float> region_;
};

Aabb<float> probeBox(const Ray& ray) {
    const Vector3<float> half = Vector3<float>::Constant(1);
    return {toEigen(ray.from) - half, toEigen(ray.from) + half};
}

float closestTo(const Ray& ray, btBroadphaseInterface& broadphase) {
    if (const auto* own = dynamic_cast<const SpatialHashBroadphase*>(&broadphase)) {
        CollectClosest<float> closest;
        own->grid().visit(RayRegion<float>(toEigen(ray.from), toEigen(ray.to)), closest);
        return closest.key();
    }
    ClosestHit hit(ray);
    broadphase.rayTest(ray.from, ray.to, hit);
    return hit.closest;
}

struct Question {
    Probe probe = Probe::ray;
    btVector3 castHalfExtents{0, 0, 0};  // the box that is moved along the ray

    void ask(std::size_t number, const Ray& ray, btBroadphaseInterface& broadphase,
             std::vector<Answer>& answers) const {
        if (probe == Probe::box) {
            Finds<btBroadphaseAabbCallback> finds(number, answers);
            const Aabb<float> box = probeBox(ray);
            broadphase.aabbTest(toBullet(box.min()), toBullet(box.max()), finds);
        } else if (probe == Probe::ray) {
            Finds<RayCallback> hits(number, answers, ray);
            broadphase.rayTest(ray.from, ray.to, hits, -castHalfExtents, castHalfExtents);
        } else {
            answers.push_back(
                answerOf(number, std::bit_cast<std::uint32_t>(closestTo(ray, broadphase))));
        }
    }

    /// By testing all boxes.
    void askExactly(std::size_t number, const Ray& ray, const Boxes& boxes,
                    std::vector<Answer>& answers) const {
        ClosestHit test(ray);
        for (std::uint32_t object = 0; object < boxes.size(); ++object) {
            if (probe == Probe::closest) {
                test.take(boxes[object]);
            } else if (probe == Probe::ray ? test.meets(ray, boxes[object], castHalfExtents)
                                           : overlaps(probeBox(ray), boxes[object])) {
                answers.push_back(answerOf(number, object));
            }
        }
        if (probe == Probe::closest) {
            answers.push_back(answerOf(number, std::bit_cast<std::uint32_t>(test.closest)));
        }
    }
};

// --- The workload ----------------------------------------------------------------------------------

/// What moves: nothing, everything before each frame or as a part of it, or one box before each question, as
/// a game does that moves its characters one by one; then pairs are found after the frame, untimed.
enum class Moves { nothing, all, allTimed, oneByOne };

class RayWorkload final : public QueryWorkload {
public:
    RayWorkload(std::unique_ptr<demos::BoxScene> scene, Question question, DrawRay draw,
                Moves moves, std::size_t count, std::uint64_t seed)
        : QueryWorkload(std::move(scene), moves == Moves::all || moves == Moves::allTimed,
                        moves == Moves::allTimed),
          question_(question),
          draw_(draw),
          areBoxesSet_(moves == Moves::oneByOne),
          random_(seed),
          boxesAtEnd_(this->scene().boxes()),
          steps_(count) {}

    void listExactAnswers(std::vector<Answer>& answers) override {
        answers.clear();
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            if (areBoxesSet_) {
                boxes_[steps_[i].object] = toAabb(steps_[i].box.min, steps_[i].box.max);
            }
            question_.askExactly(i, steps_[i].ray, boxes_, answers);
        }
    }
    [[nodiscard]] std::size_t operations() const override { return steps_.size(); }

private:
    struct Step {
        std::uint32_t object = 0;
        demos::BulletBox box;
        Ray ray;
    };

    void drawQueries() override {
        if (!areBoxesSet_) {
            boxesAtEnd_ = scene().boxes();
        }
        boxes_ = boxesAtEnd_;
        for (Step& step : steps_) {
            if (areBoxesSet_) {
                setOne(step);
            }
            step.ray = drawRay(draw_, random_, boxesAtEnd_);
        }
    }
    void setOne(Step& step) {
        step.object =
            static_cast<std::uint32_t>(&anyBox(random_.unit(), boxesAtEnd_) - boxesAtEnd_.data());
        Aabb<float>& box = boxesAtEnd_[step.object];
        box.translate(
            Vector3<float>(random_.between(-1, 1), random_.between(-1, 1), random_.between(-1, 1)));
        step.box = {toBullet(box.min()), toBullet(box.max())};
    }
    void ask(demos::FilledBroadphase& filled, std::vector<Answer>& answers) override {
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            if (areBoxesSet_) {
                filled.set(steps_[i].object, steps_[i].box);
            }
            question_.ask(i, steps_[i].ray, filled.broadphase(), answers);
        }
    }
    void afterFrame(demos::FilledBroadphase& filled) override {
        if (areBoxesSet_) {
            filled.findPairs();
        }
    }

    Question question_;
    DrawRay draw_;
    bool areBoxesSet_;
    Random random_;
    Boxes boxes_;  // as of the beginning of the frame, until the exact answers are listed
    Boxes boxesAtEnd_;
    std::vector<Step> steps_;
};

Benchmark rays(const char* name, const char* description, MakeScene makeScene, DrawRay draw,
               Question question = {}, Moves moves = Moves::nothing) {
    const bool areBoxesSet = moves == Moves::oneByOne;
    return {.name = name,
            .group = "queries",
            .description = description,
            .operation = areBoxesSet                    ? "write and query"
                         : question.probe == Probe::box ? "box"
                                                        : "ray",
            .sizes = {areBoxesSet ? std::size_t{10'000} : 30'000},
            .admits = answersQueries,
            .make = [=](std::size_t objects, std::uint64_t seed) {
                return std::make_unique<RayWorkload>(makeScene(objects, seed), question, draw,
                                                     moves, areBoxesSet ? 200 : 500, ~seed);
            }};
}

// So many rays after each step in which everything moves; by themselves, or with the update.
std::vector<Benchmark> rayStepBenchmarks() {
    struct Length {
        std::string_view name;
        std::string_view description;
        DrawRay draw;
        std::vector<std::string_view> scenes;
    };
    const std::vector<Length> lengths{
        {"short", "from boxes to 3 edges below", rayBelowBox, {"uniform", "trembling"}},
        {"medium", "of 30 edges", rayOf30Edges, {"uniform", "trembling"}},
        {"long", "from box to box", rayBetweenBoxes, {"uniform", "trembling"}},
        {"shot", "of up to 100 m across the terrain", rayOverTerrain, {"paper"}},
        {"stray", "of up to 100 m, most of which hit nothing", rayFromNowhere, {"piles"}}};
    std::vector<Benchmark> all;
    for (const Length& length : lengths) {
        for (const std::string_view scene : length.scenes) {
            for (const std::size_t count : {1U, 4U, 40U, 500U}) {
                for (const Moves moves : {Moves::all, Moves::allTimed}) {
                    const bool isTimed = moves == Moves::allTimed;
                    const std::string rays = std::to_string(count) + "-" +
                                             std::string(length.name) + "-" + std::string(scene);
                    all.push_back(
                        {.name = (isTimed ? "step-and-rays-" : "rays-after-step-") + rays,
                         .group = "queries",
                         .description = std::to_string(count) + " rays " +
                                        std::string(length.description) + ", after each step" +
                                        (isTimed ? ", which is timed too" : ""),
                         .operation = isTimed ? "step" : "ray",
                         .sizes = {300, 1'000, 3'000, 30'000},
                         .onRequest = true,
                         .admits = answersQueries,
                         .make = [=, draw = length.draw, makeScene = sceneNamed(scene)](
                                     std::size_t objects, std::uint64_t seed) {
                             return std::make_unique<RayWorkload>(
                                 makeScene(objects, seed), Question{}, draw, moves, count, ~seed);
                         }});
                }
            }
        }
    }
    return all;
}

}  // namespace

std::vector<Benchmark> rayBenchmarks() {
    const MakeScene dense = brownian(demos::uniformBoxes);
    const MakeScene sparse = cubesIn(Vector3<float>::Constant(3000), 0.5F, 0.2F);
    std::vector<Benchmark> all = rayStepBenchmarks();
    for (Benchmark& benchmark : std::vector{
             rays("rays-dense-short", "rays of 5 m among uniform boxes", dense, shortRay),
             rays("rays-dense-long", "rays across a cube of uniform boxes", dense, rayBetweenBoxes),
             rays("rays-sparse", "long rays through a nearly empty cube of 3,000 m", sparse,
                  rayBetweenBoxes),
             rays("rays-piles", "rays from pile to pile, over 10 x 10 km",
                  brownian(demos::pileBoxes), rayBetweenBoxes),
             rays("rays-between-piles",
                  "rays of 100 m between these piles, most of which hit nothing",
                  brownian(demos::pileBoxes), rayFromNowhere),
             rays("rays-terrain", "shots of up to 100 m across the paper's terrain, all moving",
                  sceneNamed("paper"), rayOverTerrain, {}, Moves::all),
             rays("rays-closest", "rays-dense-long, but only the nearest box", dense,
                  rayBetweenBoxes, {Probe::closest}),
             rays("picking", "all boxes under 500 pixels, among uniform boxes", dense,
                  rayThroughPixel),
             rays("picking-closest", "picking, but only the nearest box", dense, rayThroughPixel,
                  {Probe::closest}),
             rays("rays-fat", "a box of 1 m cast 5 m far among uniform boxes", dense, shortRay,
                  {Probe::ray, btVector3(0.5F, 0.5F, 0.5F)}),
             rays("boxes",
                  "all boxes that overlap a box of 2 m, one query at a time, among uniform boxes",
                  dense, rayBetweenBoxes, {Probe::box}),
             rays("interleaved-rays", "set one box, cast one ray, set the next", dense, shortRay,
                  {}, Moves::oneByOne),
             rays("interleaved-boxes", "set one box, query one box, set the next", dense, shortRay,
                  {Probe::box}, Moves::oneByOne)}) {
        all.push_back(std::move(benchmark));
    }
    return all;
}

}  // namespace hashphase::benchmarks
