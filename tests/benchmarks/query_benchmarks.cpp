// SPDX-License-Identifier: Zlib

// Which rays are cast through which scenes, and who looks for neighbours where.

#include <integration/bullet/conversions.hpp>
#include <tests/benchmarks/catalog.hpp>
#include <tests/benchmarks/ray_workload.hpp>
#include <tests/support/camera_matrices.hpp>

#include <demos/scenes/brownian_scene.hpp>
#include <demos/scenes/paper_scene.hpp>
#include <integration/camera/camera.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hashphase::benchmarks {
namespace {

using demos::BrownianBoxes;
using demos::Random;
using Boxes = std::vector<Aabb<float>>;
using MakeScene = std::function<std::unique_ptr<demos::BoxScene>(std::size_t, std::uint64_t)>;

constexpr float kShort = 5;             // [m]
constexpr float kSparseSide = 3000;     // [m]
constexpr float kAgentRadius = 10;      // [m]
constexpr double kAgentsPerRadius = 4;  // on average, within kAgentRadius

template <BrownianBoxes (*scatterBoxes)(std::size_t, std::uint64_t)>
std::unique_ptr<demos::BoxScene> brownian(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<demos::BrownianScene>(scatterBoxes(objects, seed), seed);
}

std::unique_ptr<demos::BoxScene> paper(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<demos::PaperScene>(objects, seed);
}

// Cubes of 1 m in a cube, or on a square, of the given side.
BrownianBoxes unitBoxes(std::size_t objects, std::uint64_t seed, const Vector3<float>& room) {
    Random random(seed);
    BrownianBoxes boxes;
    for (std::size_t i = 0; i < objects; ++i) {
        const Vector3<float> share(random.unit(), random.unit(), random.unit());
        boxes.bodies.push_back({share.cwiseProduct(room), Vector3<float>::Constant(0.5F), 0.2F,
                                Aabb<float>(Vector3<float>::Zero(), room)});
    }
    return boxes;
}

BrownianBoxes sparseBoxes(std::size_t objects, std::uint64_t seed) {
    return unitBoxes(objects, seed, Vector3<float>::Constant(kSparseSide));
}

BrownianBoxes agentBoxes(std::size_t objects, std::uint64_t seed) {
    constexpr double kPi = 3.14159265358979;
    const double circle = kPi * kAgentRadius * kAgentRadius;
    const double area = static_cast<double>(objects) * circle / kAgentsPerRadius;
    const auto side = static_cast<float>(std::sqrt(area));
    return unitBoxes(objects, seed, {side, 0, side});
}

const Aabb<float>& anyBox(Random& random, const Boxes& boxes) {
    const float share = random.unit() * static_cast<float>(boxes.size());
    return boxes[std::min(static_cast<std::size_t>(share), boxes.size() - 1)];
}

// From the neighbourhood of one box to that of another: rays where the boxes are.
Ray rayBetweenBoxes(Random& random, const Boxes& boxes) {
    const auto near = [&random](const Aabb<float>& box) {
        const Vector3<float> off(random.between(-2, 2), random.between(-2, 2),
                                 random.between(-2, 2));
        return toBullet(box.center() + off);
    };
    const btVector3 from = near(anyBox(random, boxes));
    return {from, near(anyBox(random, boxes))};
}

// The same start, and a way of so many metres.
Ray shortened(const Ray& ray, float length) {
    const btVector3 way = ray.to - ray.from;
    return {ray.from, way.fuzzyZero() ? ray.from : ray.from + way.normalized() * length};
}

Ray shortRay(Random& random, const Boxes& boxes) {
    return shortened(rayBetweenBoxes(random, boxes), kShort);
}

// A shot across the country: from eye level above one walker to the feet of another, up to 100 m on.
Ray rayOverTerrain(Random& random, const Boxes& boxes) {
    constexpr float kFarthest = 100;
    const Aabb<float>& shooter = anyBox(random, boxes);
    const Aabb<float>& target = anyBox(random, boxes);
    const btVector3 from = toBullet(shooter.center()) + btVector3(0, 3, 0);
    const btVector3 way = toBullet(target.center()) - from;
    return shortened({from, from + way}, std::min(way.length(), kFarthest));
}

// What is under a pointer anywhere on the screen: the camera looks at one of the boxes from 40 m away.
Ray rayThroughPixel(Random& random, const Boxes& boxes) {
    constexpr Viewport kWindow{0, 0, 1920, 1080};
    const test::CameraLens lens;
    const Vector3<double> target = anyBox(random, boxes).center().cast<double>();
    const Vector3<double> eye = target + Vector3<double>(24, 20, 24);
    const Camera<float> view(test::cameraMatrix<float>(lens, eye, target), lens.depthRange,
                             kWindow);
    const RayRegion<float> ray =
        view.rayThrough({random.between(0, 1920), random.between(0, 1080)});
    return {toBullet(ray.from()), toBullet(ray.from() + ray.direction())};
}

bool answersQueries(const ContestantKind& kind, std::size_t /*objects*/) {
    return kind.name == "hash" || kind.name == kBaseline;
}

Benchmark queryBenchmark(std::string name, std::string description, std::size_t objects) {
    Benchmark benchmark;
    benchmark.name = std::move(name);
    benchmark.group = "queries";
    benchmark.description = std::move(description);
    benchmark.sizes = {objects};
    benchmark.admits = answersQueries;
    return benchmark;
}

Benchmark rays(std::string name, std::string description, MakeScene makeScene, RayPlan plan) {
    constexpr std::size_t kObjects = 30'000;
    Benchmark benchmark = queryBenchmark(std::move(name), std::move(description), kObjects);
    benchmark.operation = plan.probe == Probe::box ? "box" : "ray";
    benchmark.make = [makeScene = std::move(makeScene), plan = std::move(plan)](
                         std::size_t objects, std::uint64_t seed) {
        return std::make_unique<RayWorkload>(makeScene(objects, seed), plan, ~seed);
    };
    return benchmark;
}

RayPlan planOf(DrawRay draw) {
    RayPlan plan;
    plan.draw = std::move(draw);
    return plan;
}

Benchmark interleaved(std::string name, std::string description, Probe probe) {
    constexpr std::size_t kObjects = 10'000;
    Benchmark benchmark = queryBenchmark(std::move(name), std::move(description), kObjects);
    benchmark.operation = "write and query";
    benchmark.make = [probe](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<InterleavedWorkload>(brownian<demos::uniformBoxes>(objects, seed),
                                                     probe, shortRay, ~seed);
    };
    return benchmark;
}

}  // namespace

std::vector<Benchmark> queryBenchmarks() {
    const MakeScene dense = brownian<demos::uniformBoxes>;
    std::vector<Benchmark> all;
    all.push_back(
        rays("rays-dense-short", "rays of 5 m among uniform boxes", dense, planOf(shortRay)));
    all.push_back(rays("rays-dense-long", "rays across a cube of uniform boxes", dense,
                       planOf(rayBetweenBoxes)));
    all.push_back(rays("rays-sparse", "long rays through a nearly empty cube of 3,000 m",
                       brownian<sparseBoxes>, planOf(rayBetweenBoxes)));
    all.push_back(rays("rays-piles", "rays from pile to pile, over 10 x 10 km",
                       brownian<demos::pileBoxes>, planOf(rayBetweenBoxes)));
    RayPlan terrain = planOf(rayOverTerrain);
    terrain.movesScene = true;
    all.push_back(rays("rays-terrain",
                       "shots of up to 100 m across the paper's terrain, all moving", paper,
                       terrain));
    RayPlan closest = planOf(rayBetweenBoxes);
    closest.closestOnly = true;
    all.push_back(rays("rays-closest", "rays-dense-long, but only the nearest box is wanted", dense,
                       closest));
    RayPlan pick = planOf(rayThroughPixel);
    all.push_back(rays("picking", "all boxes under the pointer, 500 times, among uniform boxes",
                       dense, pick));
    pick.closestOnly = true;
    all.push_back(
        rays("picking-closest", "picking, but only the nearest box is wanted", dense, pick));
    RayPlan fat = planOf(shortRay);
    fat.castHalfExtents = btVector3(0.5F, 0.5F, 0.5F);
    all.push_back(rays("rays-fat", "a box of 1 m cast 5 m far among uniform boxes", dense, fat));
    RayPlan boxes = planOf(rayBetweenBoxes);
    boxes.probe = Probe::box;
    all.push_back(rays("boxes",
                       "what overlaps a box of 2 m, one box at a time, among uniform boxes", dense,
                       boxes));
    all.push_back(
        interleaved("interleaved-rays", "set one box, cast one ray, set the next", Probe::ray));
    all.push_back(
        interleaved("interleaved-boxes", "set one box, ask for one box, set the next", Probe::box));
    Benchmark neighbours = queryBenchmark(
        "neighbours", "every agent asks who is within 10 m; all move; four others on average",
        50'000);
    neighbours.operation = "agent";
    neighbours.make = [](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<NeighbourWorkload>(brownian<agentBoxes>(objects, seed),
                                                   kAgentRadius);
    };
    all.push_back(std::move(neighbours));
    return all;
}

}  // namespace hashphase::benchmarks
