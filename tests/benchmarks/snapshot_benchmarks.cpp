// SPDX-License-Identifier: Zlib

// What does it cost to save a grid or a Bullet world, and to go back, beside the frame itself? All take turns in one
// world, as in a program: each first goes back to where the frame began, then runs it.
//
// Timed     `frame`: the frame. `save`: saving after it. `restore`: going back to where it ended, from some frames
//           later, as netcode does.
// Answers   are the pairs of the grid, or a hash of where all bodies are: as in a world that never goes back.

#include <broadphase/grid_snapshot.hpp>
#include <demos/compare/reference_pairs.hpp>
#include <demos/scenes/physics_world.hpp>
#include <demos/scenes/world_scenes.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/bullet/world_snapshot.hpp>
#include <tests/benchmarks/workload.hpp>

#include <algorithm>
#include <stdexcept>

namespace hashphase::benchmarks {
namespace {

constexpr int kFramesBack = 8;

/// A world, and what it goes back to.
class Rolled : public Interface {
public:
    virtual void advance() = 0;
    /// Some frames that are not those of the workload.
    virtual void stray(int frames) = 0;
    virtual void save() = 0;
    virtual void restore() = 0;
    /// The same, but for where a frame began.
    virtual void saveStart() = 0;
    virtual void restoreStart() = 0;
    virtual void listState(std::vector<Answer>& answers) const = 0;
    [[nodiscard]] virtual std::size_t snapshotBytes() const = 0;
};

class SnapshotRunner final : public Runner {
public:
    SnapshotRunner(const ContestantKind& kind, Rolled& rolled)
        : saves_(kind.name == "save"), restores_(kind.name == "restore"), rolled_(rolled) {}

    void prepare() override {
        rolled_.restoreStart();
        if (saves_ || restores_) {
            rolled_.advance();
        }
        if (restores_) {
            rolled_.save();
            rolled_.stray(kFramesBack);
        }
    }
    void run() override {
        if (saves_) {
            rolled_.save();
        } else if (restores_) {
            rolled_.restore();
        } else {
            rolled_.advance();
        }
    }
    void listAnswers(std::vector<Answer>& answers) override { rolled_.listState(answers); }

    [[nodiscard]] std::optional<OwnBytes> ownBytes() const override {
        return saves_ || restores_ ? std::optional(OwnBytes{rolled_.snapshotBytes(), 0})
                                   : std::nullopt;
    }

private:
    bool saves_;
    bool restores_;
    Rolled& rolled_;
};

// --- A grid ---------------------------------------------------------------------------------------

class RolledGrid final : public Rolled {
public:
    explicit RolledGrid(const SceneBoxes& scene) : scene_(scene) {
        for (const Aabb<float>& box : scene.boxes()) {
            ids_.push_back(grid_.add(box));
        }
        pairs_.update();
    }

    void advance() override { moveBy(0); }
    void stray(int frames) override {
        for (int i = 1; i <= frames; ++i) {
            moveBy(0.1F * static_cast<float>(i));
        }
    }
    void save() override { snapshot_.save(pairs_); }
    void restore() override { snapshot_.restore(pairs_); }
    void saveStart() override { start_.save(pairs_); }
    void restoreStart() override { start_.restore(pairs_); }
    void listState(std::vector<Answer>& answers) const override {
        std::vector<ProxyPair> listed;
        pairs_.collect(listed);
        answers.clear();
        for (const ProxyPair& pair : listed) {
            answers.push_back(demos::pairKey(pair.first.index, pair.second.index));
        }
    }
    [[nodiscard]] std::size_t snapshotBytes() const override { return snapshot_.memoryBytes(); }

private:
    /// Every second box to the side by so much of where the scene has it [m].
    void moveBy(float aside) {
        const Vector3<float> shift(aside, 0, 0);
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            const Aabb<float>& box = scene_.boxes()[i];
            grid_.move(ids_[i], i % 2 == 0 ? box : box.translated(shift));
        }
        pairs_.update();
    }

    const SceneBoxes& scene_;
    Grid<float> grid_;
    Pairs<float> pairs_{grid_};
    std::vector<ProxyId> ids_;  // by object, which is its index
    GridSnapshot<float> snapshot_;
    GridSnapshot<float> start_;
};

class GridSnapshots final : public Workload {
public:
    explicit GridSnapshots(std::unique_ptr<demos::BoxScene> scene) : scene_(std::move(scene)) {}

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override {
        return std::make_unique<SnapshotRunner>(kind, rolled_);
    }
    void beginFrame() override {
        scene_.advance();
        rolled_.saveStart();
    }
    void listExactAnswers(std::vector<Answer>& answers) override {
        demos::findExactPairs(demos::ReferenceMethod::kSweep, scene_.boxes(), {}, answers);
    }
    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }

private:
    SceneBoxes scene_;
    RolledGrid rolled_{scene_};
};

// --- A Bullet world -------------------------------------------------------------------------------

constexpr btScalar kStep = btScalar(1) / btScalar(60);  // [s]

class RolledWorld final : public Rolled {
public:
    RolledWorld(const demos::WorldSceneKind& scene, std::size_t objects, std::uint64_t seed)
        : physics_(demos::physicsBroadphase(demos::kHashName), demos::ListOrder::asShipped) {
        scene.fill(physics_.contents(), objects, seed);
        for (const auto& body : physics_.contents().bodies()) {
            if (!body->isStaticObject()) {
                body->setActivationState(DISABLE_DEACTIVATION);  // a step of all of them
            }
        }
        physics_.step(kStep, kSettlingSteps);
    }

    void advance() override { physics_.step(kStep); }
    void stray(int frames) override { physics_.step(kStep, frames); }
    void save() override { refuseFault(snapshot_.save(physics_.world(), broadphase())); }
    void restore() override { refuseFault(snapshot_.restore(physics_.world(), broadphase())); }
    void saveStart() override { refuseFault(start_.save(physics_.world(), broadphase())); }
    void restoreStart() override { refuseFault(start_.restore(physics_.world(), broadphase())); }
    void listState(std::vector<Answer>& answers) const override {
        answers.assign(1, demos::stateHash(physics_.contents()));
    }
    [[nodiscard]] std::size_t snapshotBytes() const override { return snapshot_.memoryBytes(); }

private:
    static constexpr int kSettlingSteps = 30;

    static void refuseFault(const std::string& fault) {
        if (!fault.empty()) {
            throw std::runtime_error(fault);
        }
    }
    [[nodiscard]] SpatialHashBroadphase& broadphase() {
        return dynamic_cast<SpatialHashBroadphase&>(*physics_.world().getBroadphase());
    }

    demos::PhysicsWorld physics_;
    WorldSnapshot snapshot_;
    WorldSnapshot start_;
};

class WorldSnapshots final : public Workload {
public:
    WorldSnapshots(const demos::WorldSceneKind& scene, std::size_t objects, std::uint64_t seed)
        : objects_(objects), rolled_(scene, objects, seed), reference_(scene, objects, seed) {}

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override {
        return std::make_unique<SnapshotRunner>(kind, rolled_);
    }
    void beginFrame() override {
        rolled_.saveStart();
        reference_.advance();
    }
    void listExactAnswers(std::vector<Answer>& answers) override { reference_.listState(answers); }
    [[nodiscard]] std::size_t objects() const override { return objects_; }

private:
    std::size_t objects_;
    RolledWorld rolled_;
    RolledWorld reference_;
};

// --------------------------------------------------------------------------------------------------

Benchmark snapshots(const char* name, std::string description) {
    Benchmark benchmark{.name = name, .group = "snapshots", .description = std::move(description)};
    benchmark.sizes = {1'000, 30'000};
    benchmark.onRequest = true;
    benchmark.contestants = [](std::size_t, std::uint64_t) {
        return std::vector<ContestantKind>{{.name = "frame", .title = "the frame itself"},
                                           {.name = "save", .title = "save()", .ours = true},
                                           {.name = "restore", .title = "restore()", .ours = true}};
    };
    return benchmark;
}

Benchmark gridSnapshots(const char* name, std::string_view scene) {
    Benchmark benchmark =
        snapshots(name, "GridSnapshot of S2-uniform and its pairs, all boxes moving");
    benchmark.make = [makeScene = sceneNamed(scene)](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<GridSnapshots>(makeScene(objects, seed));
    };
    return benchmark;
}

Benchmark worldSnapshots(const char* name, std::string_view scene) {
    const auto scenes = demos::worldSceneKinds();
    const demos::WorldSceneKind& kind =
        *std::find_if(scenes.begin(), scenes.end(),
                      [scene](const demos::WorldSceneKind& each) { return each.name == scene; });
    Benchmark benchmark = snapshots(
        name, "WorldSnapshot of a Bullet world, scene " + std::string(scene) + ", nothing asleep");
    benchmark.make = [&kind](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<WorldSnapshots>(kind, objects, seed);
    };
    return benchmark;
}

}  // namespace

std::vector<Benchmark> snapshotBenchmarks() {
    return {gridSnapshots("snapshots-grid", "uniform"), worldSnapshots("snapshots-stack", "stack"),
            worldSnapshots("snapshots-pile", "pile"),
            worldSnapshots("snapshots-city", "static-city")};
}

}  // namespace hashphase::benchmarks
