// SPDX-License-Identifier: Zlib

// All benchmarks, and those of pairs: of which scenes, in which frames, with cells of which size, and how far
// away.

#include <demos/console/format.hpp>
#include <demos/scenes/scatter.hpp>
#include <tests/benchmarks/grid_contestant.hpp>
#include <tests/benchmarks/pair_workload.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

namespace hashphase::benchmarks {
namespace {

using Sizes = std::vector<std::size_t>;

const demos::BoxSceneKind& sceneKind(std::string_view name) {
    const auto kinds = demos::boxSceneKinds();
    return *std::find_if(kinds.begin(), kinds.end(),
                         [name](const demos::BoxSceneKind& kind) { return kind.name == name; });
}

MakeScene scattered(const demos::ScatterPlan& plan) {
    return brownian([plan](std::size_t objects, std::uint64_t seed) {
        return demos::scatter(plan, objects, seed);
    });
}

Benchmark pairs(std::string name, const char* group, std::string description, Sizes sizes,
                MakeScene makeScene, PairFrame what = PairFrame::setAll) {
    return {.name = std::move(name),
            .group = group,
            .description = std::move(description),
            .sizes = std::move(sizes),
            .admits = takesPartInFrames,
            .make = makePairWorkload(std::move(makeScene), what)};
}

Benchmark pairsIn(const char* name, std::string_view scene,
                  Sizes sizes = {1'000, 3'000, 10'000, 30'000, 100'000}) {
    return pairs(name, "pairs", std::string(sceneKind(scene).description), std::move(sizes),
                 sceneNamed(scene));
}

// For a hundred frames btDbvtBroadphase improves the tree of what has come to rest.
constexpr int kFramesOfOptimisation = 120;

// A world in which nothing moves, and what is handed in nevertheless.
Benchmark stillPairs(const char* name, const char* description, PairFrame what) {
    const MakeScene makeScene = brownian([](std::size_t objects, std::uint64_t seed) {
        return demos::withStatics(demos::scatter({.movingShare = 0}, objects, seed), 2);
    });
    Benchmark still = pairs(name, "pairs", description, {1'000, 3'000, 100'000}, makeScene, what);
    still.warmUpFrames = kFramesOfOptimisation;
    return still;
}

// About Box3D's large world: up to a hundred boxes roam over a wide ground of static ones.
MakeScene largeWorld() {
    return brownian([](std::size_t objects, std::uint64_t seed) {
        constexpr std::size_t kMostMovers = 100;
        constexpr float kStep = 0.2F;  // [m] a frame and axis
        demos::BrownianBoxes boxes =
            demos::scatter({.placement = demos::Placement::plain, .movingShare = 0}, objects, seed);
        const std::size_t movers = std::min(kMostMovers, (objects + 9) / 10);
        for (demos::BrownianBoxes::Body& body : std::span(boxes.bodies).first(movers)) {
            body.step = kStep;
        }
        return demos::withStatics(std::move(boxes), 1);
    });
}

Benchmark scatteredPairs(std::string name, const char* group, const demos::ScatterPlan& plan,
                         std::size_t objects) {
    Benchmark benchmark = pairs(std::move(name), group, describe(plan), {objects}, scattered(plan));
    benchmark.takesOtherSizes = false;
    return benchmark;
}

// One size, and sizes from a micrometre to a thousand kilometres, so to speak, as dense.
Benchmark pairsOfSizes(const char* name, demos::SizeLaw sizes, float ratio) {
    Benchmark benchmark = scatteredPairs(
        name, "pairs", {.sizes = sizes, .sizeRatio = ratio, .overlapsPerBox = 1}, 20'000);
    benchmark.onRequest = true;
    return benchmark;
}

std::vector<Benchmark> randomBenchmarks(std::uint64_t seed) {
    constexpr std::size_t kRandomScenes = 8;
    std::vector<Benchmark> all;
    for (std::size_t i = 1; i <= kRandomScenes; ++i) {
        const demos::RandomScene drawn = demos::drawScene(seed * kRandomScenes + i);
        all.push_back(
            scatteredPairs("random-" + std::to_string(i), "random", drawn.plan, drawn.objects));
    }
    return all;
}

// --- Objects that come and go --------------------------------------------------------------------

std::vector<Benchmark> populationBenchmarks() {
    const auto population = [](const char* name, const char* description, PairFrame what,
                               Sizes sizes, MakeScene makeScene = sceneNamed("uniform")) {
        const bool areRemoved = what != PairFrame::create;
        Benchmark benchmark =
            pairs(name, "population", description, std::move(sizes), std::move(makeScene), what);
        benchmark.operation = areRemoved ? "removal" : "object";
        benchmark.admits = [what, areRemoved](const ContestantKind& kind, std::size_t objects) {
            // The grid alone notes a removal and deals with it when it is asked for pairs.
            const bool isComplete = kind.bullet != nullptr || what != PairFrame::remove;
            return isFastEnough(kind, objects) && objects <= kind.fillsUpTo && !kind.onThreads &&
                   (!areRemoved || (kind.changes && isComplete));
        };
        return benchmark;
    };
    Benchmark ofStatics = population(
        "creation-static", "the boxes of large-world are created, until all pairs are found",
        PairFrame::create, {2'000'000}, largeWorld());
    ofStatics.largest = 2'000'000;
    ofStatics.frames = 5;  // with btDbvtBroadphase each takes a quarter of a minute
    ofStatics.warmUpFrames = 2;
    ofStatics.onRequest = true;
    return {population("removal", "1,000 uniform boxes are destroyed", PairFrame::remove, {50'000}),
            population("removal-and-pairs", "the same, until all pairs are found",
                       PairFrame::removeAndFind, {50'000}),
            population("creation", "uniform boxes are created, until all pairs are found",
                       PairFrame::create, {1'000, 3'000, 10'000}),
            std::move(ofStatics)};
}

// --- Cell sizes ----------------------------------------------------------------------------------

// What the automatic cell sizes cost against the best fixed one: the same frames for a grid that
// chooses for itself and for grids with cells of 0.25 to 64 times the mean edge.
Benchmark cellSizes(const std::string& name, demos::ScatterPlan plan, float overlapsPerBox) {
    plan.overlapsPerBox = overlapsPerBox;
    const auto density = static_cast<double>(overlapsPerBox);
    Benchmark benchmark =
        pairs("cellsize-" + name + "-" + demos::fixed(density, density < 1 ? 1 : 0), "cell size",
              describe(plan), {1'000, 10'000, 100'000}, scattered(plan));
    benchmark.onRequest = true;
    benchmark.dropFactor = 5;  // a size that takes so much longer cannot be the best
    benchmark.contestants = [plan](std::size_t objects, std::uint64_t seed) {
        const double edge = meanEdge(demos::scatter(plan, objects, seed));
        std::vector<ContestantKind> kinds{gridKind("cells-auto")};
        for (const double factor : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
            const int digits = factor < 0.5 ? 2 : factor < 1 ? 1 : 0;
            kinds.push_back(gridKind("cells-" + demos::fixed(factor, digits),
                                     {.config = {.cellSize = factor * edge}}));
        }
        return kinds;
    };
    return benchmark;
}

std::vector<Benchmark> cellSizeBenchmarks() {
    using demos::Placement;
    using demos::SizeLaw;
    std::vector<Benchmark> all;
    for (const auto& [name, plan] :
         {std::pair("uniform", demos::ScatterPlan{}),
          std::pair("clustered", demos::ScatterPlan{.placement = Placement::clusters}),
          std::pair("sizes-1000",
                    demos::ScatterPlan{.sizes = SizeLaw::logUniform, .sizeRatio = 1000})}) {
        for (const float overlapsPerBox : {0.2F, 2.0F, 10.0F}) {
            all.push_back(cellSizes(name, plan, overlapsPerBox));
        }
    }
    return all;
}

// --- Far away ------------------------------------------------------------------------------------

// A scene whose coordinates are multiples of a millimetre, about, so that they are exact far away.
class LatticeScene : public demos::BoxScene {
public:
    explicit LatticeScene(std::unique_ptr<demos::BoxScene> scene) : scene_(std::move(scene)) {
        filters_ = scene_->filters();
        round();
    }
    void advance() override {
        scene_->advance();
        round();
    }
    [[nodiscard]] Aabb<float> bounds() const override {
        const Vector3<float> step = Vector3<float>::Constant(kStep);
        return {scene_->bounds().min() - step, scene_->bounds().max() + step};
    }

private:
    static constexpr float kStep = 0x1p-10F;

    void round() {
        const auto rounded = [](const Vector3<float>& x) -> Vector3<float> {
            return (x / kStep).array().round() * kStep;
        };
        boxes_.clear();
        for (const Aabb<float>& box : scene_->boxes()) {
            boxes_.emplace_back(rounded(box.min()), rounded(box.max()));
        }
    }

    std::unique_ptr<demos::BoxScene> scene_;
};

// What it costs to be far from the origin, and to shift the origin: the same frames for grids that
// have them at home and far away.
std::vector<Benchmark> farBenchmarks() {
    const auto far = [](const char* name, const char* description, const MakeScene& makeScene) {
        Benchmark benchmark =
            pairs(name, "far", description, {30'000, 100'000},
                  [makeScene](std::size_t objects, std::uint64_t seed) {
                      return std::make_unique<LatticeScene>(makeScene(objects, seed));
                  });
        benchmark.onRequest = true;
        benchmark.contestants = [](std::size_t, std::uint64_t) {
            return std::vector{
                gridKind("home", {.distance = 0, .isDouble = true}),
                gridKind("at-2^20", {.distance = 0x1p20, .isDouble = true}),
                gridKind("at-2^30", {.distance = 0x1p30, .isDouble = true}),
                gridKind("shifting", {.distance = 0x1p30, .shift = 0x1p20, .isDouble = true}),
                gridKind("home-single", {.distance = 0}),
                gridKind("at-2^12-single", {.distance = 0x1p12}),
                gridKind("shifting-single", {.distance = 0x1p12, .shift = 0x1p11})};
        };
        return benchmark;
    };
    return {far("far-uniform", "S2-uniform, near the origin and far from it",
                brownian(demos::uniformBoxes)),
            far("far-resting", "uniform boxes of which 2 % move, near and far",
                brownian(demos::restingBoxes))};
}

}  // namespace

// --- Scenes --------------------------------------------------------------------------------------

MakeScene brownian(std::function<demos::BrownianBoxes(std::size_t, std::uint64_t)> scatter) {
    return [scatter = std::move(scatter)](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<demos::BrownianScene>(scatter(objects, seed), seed);
    };
}

MakeScene cubesIn(const Vector3<float>& room, float halfEdge, float step) {
    return brownian([=](std::size_t objects, std::uint64_t seed) {
        demos::Random random(seed);
        demos::BrownianBoxes boxes;
        for (std::size_t i = 0; i < objects; ++i) {
            const Vector3<float> share(random.unit(), random.unit(), random.unit());
            boxes.bodies.push_back({share.cwiseProduct(room), Vector3<float>::Constant(halfEdge),
                                    step, Aabb<float>(Vector3<float>::Zero(), room)});
        }
        return boxes;
    });
}

MakeScene sceneNamed(std::string_view name) {
    return sceneKind(name).make;
}

// --- The catalog ---------------------------------------------------------------------------------

bool isFastEnough(const ContestantKind& kind, std::size_t objects) {
    return objects <= kind.upTo;
}

bool takesPartInFrames(const ContestantKind& kind, std::size_t objects) {
    return isFastEnough(kind, objects) && !kind.inBatches && !kind.onThreads;
}

std::vector<Benchmark> pairBenchmarks() {
    const Sizes nearSizes{100, 1'000, 3'000, 10'000, 30'000, 100'000};
    Benchmark paper = pairsIn("S1-paper", "paper");
    // At a million every sphere would overlap a hundred others.
    paper.largest = 300'000;
    Benchmark terdiman = pairsIn("terdiman", "terdiman", {1'000, 3'000, 10'000, 100'000});
    // In its fixed cube, pairs grow with the square of the boxes.
    terdiman.takesOtherSizes = false;
    Benchmark tiny = pairsIn("tiny", "uniform", {10, 32, 100, 300, 1000});
    tiny.takesOtherSizes = false;
    Benchmark threads = pairsIn("threads", "uniform", {30'000, 100'000});
    threads.description = "S2-uniform, with hashphase on one thread and on all";
    threads.admits = [](const ContestantKind& kind, std::size_t /*objects*/) {
        return kind.name == kBaseline || kind.name == "hash" || kind.onThreads;
    };
    threads.onRequest = true;
    Benchmark large =
        pairs("large-world", "pairs",
              "static boxes, and up to 100 roaming boxes; only the roaming boxes are set",
              {1'000'000}, largeWorld(), PairFrame::setMovers);
    large.operation = "mover";
    large.warmUpFrames = kFramesOfOptimisation;
    large.onRequest = true;
    large.admits = [](const ContestantKind& kind, std::size_t objects) {
        return takesPartInFrames(kind, objects) && objects <= kind.fillsUpTo && kind.changes;
    };
    Benchmark trillion = pairsOfSizes("sizes-trillion", demos::SizeLaw::logUniform, 0x1p40F);
    trillion.admits = [](const ContestantKind& kind, std::size_t objects) {
        // ODE's hash space ends the program where its cells have too large numbers.
        return takesPartInFrames(kind, objects) && !kind.name.starts_with("ode-");
    };
    return {std::move(paper),
            pairsIn("S2-uniform", "uniform"),
            pairsIn("S3-logsizes", "logsizes"),
            pairsIn("S4-moving-5", "moving-5"),
            pairsIn("S4-moving-2", "moving-2"),
            pairsIn("S5-static-90", "static-90"),
            pairsIn("S6-piles", "piles"),
            pairsIn("trembling", "trembling", nearSizes),
            pairsIn("creeping", "creeping", nearSizes),
            pairsIn("breathing", "breathing", nearSizes),
            pairsIn("mixed-2", "mixed-2", nearSizes),
            pairsIn("mixed-20", "mixed-20", nearSizes),
            std::move(terdiman),
            pairsIn("brownian", "brownian"),
            std::move(tiny),
            stillPairs("quiet", "uniform boxes, all set again in each frame, unchanged",
                       PairFrame::setAll),
            stillPairs("sleeping", "uniform boxes, half static, half asleep; no box is set",
                       PairFrame::setNothing),
            std::move(threads),
            std::move(large),
            pairsOfSizes("sizes-one", demos::SizeLaw::equal, demos::ScatterPlan().sizeRatio),
            std::move(trillion)};
}

std::vector<Benchmark> catalog(std::uint64_t seed) {
    std::vector<Benchmark> all;
    for (std::vector<Benchmark>& part : std::array{
             pairBenchmarks(), randomBenchmarks(seed), populationBenchmarks(), rayBenchmarks(),
             neighbourBenchmarks(), crowdBenchmarks(), cullingBenchmarks(), sweepBenchmarks(),
             terrainBenchmarks(), worldsBenchmarks(), cellSizeBenchmarks(), farBenchmarks(),
             effectsBenchmarks(), snapshotBenchmarks()}) {
        std::move(part.begin(), part.end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace hashphase::benchmarks
