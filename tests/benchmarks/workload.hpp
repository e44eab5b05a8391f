// SPDX-License-Identifier: Zlib
#pragma once

// What is measured: a scene, what is asked of every contestant in each of its frames - to keep the pairs,
// to cast rays, to change the population - and who takes part. What runs a workload knows nothing of it
// but its answers.
//
// Order    make() for each contestant; then for each frame beginFrame() of the workload and of each
//          runner; then, runner by runner in any order, prepare(), run(), which alone is timed, and endFrame().
// Answers  are numbers: a pair's two objects, or a query and an object that it found. Every answer
//          that a contestant gives is compared with the exact ones.

#include <demos/scenes/box_scene.hpp>
#include <demos/scenes/brownian_scene.hpp>
#include <tests/benchmarks/contestant.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::benchmarks {

/// A pair of objects, or the number of a query in the upper half and its find in the lower.
using Answer = std::uint64_t;

[[nodiscard]] constexpr Answer answerOf(std::size_t query, std::uint32_t found) noexcept {
    return Answer{query} << 32 | found;
}

/// A contestant at work on a workload.
class Runner : public Interface {
public:
    /// Takes in what the workload has drawn.
    virtual void beginFrame() {}

    /// Whatever must be done just before run().
    virtual void prepare() {}

    virtual void run() = 0;

    /// Replaces `answers` by those of the last frame, in any order. For before endFrame().
    virtual void listAnswers(std::vector<Answer>& answers) = 0;

    /// What is left to do after a frame and not part of it.
    virtual void endFrame() {}

    [[nodiscard]] virtual std::optional<OwnBytes> ownBytes() const { return std::nullopt; }
};

class Workload : public Interface {
public:
    /// The contestant, filled. It goes on reading the workload and the kind.
    [[nodiscard]] virtual std::unique_ptr<Runner> make(const ContestantKind& kind) = 0;

    /// Draws the next frame; the first call shows the initial state.
    virtual void beginFrame() = 0;

    /// Replaces `answers` by the exact ones, sorted.
    virtual void listExactAnswers(std::vector<Answer>& answers) = 0;

    [[nodiscard]] virtual std::size_t objects() const = 0;

    /// By how many a frame's time is divided: objects, rays, removals.
    [[nodiscard]] virtual std::size_t operations() const { return objects(); }

    /// Whether it matters what contestants take from the heap while filling and warming up, with the
    /// tables by which the measurement finds an object's proxy (up to 12 bytes an object).
    [[nodiscard]] virtual bool watchesHeap() const { return false; }
};

/// A scene and its current boxes in all the forms that contestants take.
class SceneBoxes {
public:
    explicit SceneBoxes(std::unique_ptr<demos::BoxScene> scene) : scene_(std::move(scene)) {
        convert();
    }

    void advance() {
        scene_->advance();
        convert();
    }

    [[nodiscard]] FrameBoxes frame() const {
        return {scene_->boxes(), bulletBoxes_, scene_->filters(), mins_, maxs_};
    }
    [[nodiscard]] const std::vector<Aabb<float>>& boxes() const { return scene_->boxes(); }
    [[nodiscard]] std::size_t size() const { return scene_->boxes().size(); }
    [[nodiscard]] demos::BroadphaseNeeds needs() const { return {scene_->bounds(), size()}; }

private:
    void convert() {
        demos::toBulletBoxes(scene_->boxes(), bulletBoxes_);
        mins_.clear();
        maxs_.clear();
        for (const demos::BulletBox& box : bulletBoxes_) {
            mins_.push_back(box.min);
            maxs_.push_back(box.max);
        }
    }

    std::unique_ptr<demos::BoxScene> scene_;
    std::vector<demos::BulletBox> bulletBoxes_;
    std::vector<btVector3> mins_;
    std::vector<btVector3> maxs_;
};

/// A broadphase of Bullet's kind with all boxes of the scene, its pairs found.
[[nodiscard]] std::unique_ptr<demos::FilledBroadphase> filledWith(
    const SceneBoxes& scene, const demos::BroadphaseKind& kind);

using MakeScene = std::function<std::unique_ptr<demos::BoxScene>(std::size_t, std::uint64_t)>;

/// Of boxes that move at random.
[[nodiscard]] MakeScene brownian(
    std::function<demos::BrownianBoxes(std::size_t, std::uint64_t)> scatter);

/// Of cubes that are evenly spread over the room, which may be flat, and move by up to `step` an axis.
[[nodiscard]] MakeScene cubesIn(const Vector3<float>& room, float halfEdge, float step);

/// A kind of box scene by its name.
[[nodiscard]] MakeScene sceneNamed(std::string_view name);

/// A scene and what is asked of it, at any size.
struct Benchmark {
    std::string name = {};  // without blanks; "/" and the size are appended for a case
    std::string group = {};
    std::string description = {};
    std::string operation = "object";  // what ns are counted per

    std::vector<std::size_t> sizes = {};  // objects
    bool takesOtherSizes = true;          // --sizes replaces them
    std::size_t largest = 1'000'000;

    /// Measured, unless asked otherwise; 0: as many as of others of that size.
    int frames = 0;

    /// Before those, where ten are too few or take too long; 0: as many as of others.
    int warmUpFrames = 0;

    /// Only measured when it is asked for by name.
    bool onRequest = false;

    /// Contestants slower than the fastest by this factor drop out while warming up; 0 for none.
    double dropFactor = 0;

    /// Who takes part of the chosen contestants.
    std::function<bool(const ContestantKind&, std::size_t objects)> admits = {};

    /// In place of the chosen contestants, where there is one.
    std::function<std::vector<ContestantKind>(std::size_t objects, std::uint64_t seed)>
        contestants = {};

    std::function<std::unique_ptr<Workload>(std::size_t objects, std::uint64_t seed)> make = {};
};

/// All of them, in the order in which they are run. The seed decides what the random ones are.
[[nodiscard]] std::vector<Benchmark> catalog(std::uint64_t seed);

// The parts of the catalog.
[[nodiscard]] std::vector<Benchmark> pairBenchmarks();
[[nodiscard]] std::vector<Benchmark> rayBenchmarks();
[[nodiscard]] std::vector<Benchmark> neighbourBenchmarks();
[[nodiscard]] std::vector<Benchmark> crowdBenchmarks();
[[nodiscard]] std::vector<Benchmark> cullingBenchmarks();
[[nodiscard]] std::vector<Benchmark> sweepBenchmarks();
[[nodiscard]] std::vector<Benchmark> terrainBenchmarks();
[[nodiscard]] Benchmark terrainEditBenchmark();
[[nodiscard]] std::vector<Benchmark> effectsBenchmarks();
[[nodiscard]] std::vector<Benchmark> snapshotBenchmarks();
[[nodiscard]] std::vector<Benchmark> worldsBenchmarks();

/// True for contestants that are not too slow for so many objects.
[[nodiscard]] bool isFastEnough(const ContestantKind& kind, std::size_t objects);

/// True for those of them whose frames differ from those of others.
[[nodiscard]] bool takesPartInFrames(const ContestantKind& kind, std::size_t objects);

}  // namespace hashphase::benchmarks
