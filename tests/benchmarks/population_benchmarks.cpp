// SPDX-License-Identifier: Zlib

// Objects that come and go in a world that stands still.

#include <demos/scenes/random.hpp>
#include <tests/benchmarks/workload.hpp>

#include <algorithm>
#include <limits>
#include <numeric>

namespace hashphase::benchmarks {
namespace {

constexpr std::size_t kRemovals = 1000;

/// What a frame's time covers.
enum class RemovalTiming {
    removals,          // the calls that remove
    removalsAndPairs,  // those, and having the complete set of pairs afterwards
};

/// Removes so many objects, others in each frame; those of the frame before are put back, untimed.
class RemovalWorkload final : public Workload {
public:
    RemovalWorkload(std::unique_ptr<demos::BoxScene> scene, RemovalTiming timing,
                    std::uint64_t seed)
        : scene_(std::move(scene)),
          removals_(std::min(kRemovals, (scene_.size() + 1) / 2)),
          timing_(timing),
          random_(seed),
          order_(scene_.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
    }

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override {
        return std::make_unique<Removing>(*this, kind);
    }

    void beginFrame() override {
        for (std::size_t i = 0; i < removals_; ++i) {
            const float share = random_.unit();
            const auto left = static_cast<float>(order_.size() - i);
            const auto step = static_cast<std::size_t>(share * left);
            std::swap(order_[i], order_[std::min(i + step, order_.size() - 1)]);
        }
    }

    void listExactAnswers(std::vector<Answer>& answers) override {
        std::vector<Aabb<float>> left = scene_.boxes();
        for (const std::uint32_t object : removed()) {
            // Overlaps nothing.
            left[object].min().setConstant(std::numeric_limits<float>::quiet_NaN());
        }
        demos::findExactPairs(demos::ReferenceMethod::kSweep, left, scene_.frame().filters,
                              answers);
    }

    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }
    [[nodiscard]] std::size_t operations() const override { return removals_; }

private:
    class Removing final : public Runner {
    public:
        Removing(const RemovalWorkload& workload, const ContestantKind& kind)
            : workload_(workload), contestant_(kind.make(workload.scene_.needs())) {
            contestant_->fill(workload.scene_.frame());
            contestant_->findPairs();
            contestant_->afterFrame();
        }

        void run() override {
            contestant_->population()->remove(workload_.removed());
            if (workload_.timing_ == RemovalTiming::removalsAndPairs) {
                contestant_->findPairs();
            }
        }
        void listAnswers(std::vector<Answer>& answers) override { contestant_->listPairs(answers); }
        void endFrame() override {
            contestant_->afterFrame();
            contestant_->population()->add(workload_.removed(), workload_.scene_.frame());
            contestant_->findPairs();
            contestant_->afterFrame();
        }

    private:
        const RemovalWorkload& workload_;
        std::unique_ptr<Contestant> contestant_;
    };

    [[nodiscard]] std::span<const std::uint32_t> removed() const {
        return std::span(order_).first(removals_);
    }

    SceneBoxes scene_;
    std::size_t removals_;
    RemovalTiming timing_;
    demos::Random random_;
    std::vector<std::uint32_t> order_;  // those to be removed come first
};

/// Makes a broadphase of all objects and finds their pairs, anew in each frame.
class CreationWorkload final : public Workload {
public:
    explicit CreationWorkload(std::unique_ptr<demos::BoxScene> scene) : scene_(std::move(scene)) {}

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override {
        return std::make_unique<Creating>(scene_, kind);
    }
    void beginFrame() override { scene_.advance(); }
    void listExactAnswers(std::vector<Answer>& answers) override {
        demos::findExactPairs(demos::ReferenceMethod::kSweep, scene_.boxes(),
                              scene_.frame().filters, answers);
    }
    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }

private:
    class Creating final : public Runner {
    public:
        Creating(const SceneBoxes& scene, const ContestantKind& kind)
            : scene_(scene), kind_(kind) {}

        void beginFrame() override { contestant_ = kind_.make(scene_.needs()); }
        void run() override {
            contestant_->fill(scene_.frame());
            contestant_->findPairs();
        }
        void listAnswers(std::vector<Answer>& answers) override { contestant_->listPairs(answers); }
        void endFrame() override { contestant_.reset(); }

    private:
        const SceneBoxes& scene_;
        const ContestantKind& kind_;
        std::unique_ptr<Contestant> contestant_;
    };

    SceneBoxes scene_;
};

Benchmark removalBenchmark(const char* name, const char* description, RemovalTiming timing) {
    return {.name = name,
            .group = "population",
            .description = description,
            .operation = "removal",
            .sizes = {50'000},
            .admits =
                [timing](const ContestantKind& kind, std::size_t objects) {
                    // The grid alone notes a removal and deals with it when it is asked for pairs.
                    const bool complete =
                        kind.bullet != nullptr || timing == RemovalTiming::removalsAndPairs;
                    return kind.changes && complete && isFastEnough(kind, objects) &&
                           objects <= kind.fillsUpTo && !kind.onThreads;
                },
            .make =
                [timing](std::size_t objects, std::uint64_t seed) {
                    return std::make_unique<RemovalWorkload>(sceneNamed("uniform")(objects, seed),
                                                             timing, seed);
                }};
}

}  // namespace

std::vector<Benchmark> populationBenchmarks() {
    return {
        removalBenchmark("removal", "1,000 of uniform boxes are destroyed",
                         RemovalTiming::removals),
        removalBenchmark("removal-and-pairs", "the same, until the pairs are complete",
                         RemovalTiming::removalsAndPairs),
        {.name = "creation",
         .group = "population",
         .description = "uniform boxes are created, until the pairs are complete",
         .sizes = {1'000, 3'000, 10'000},
         .admits =
             [](const ContestantKind& kind, std::size_t objects) {
                 return isFastEnough(kind, objects) && objects <= kind.fillsUpTo && !kind.onThreads;
             },
         .make =
             [](std::size_t objects, std::uint64_t seed) {
                 return std::make_unique<CreationWorkload>(sceneNamed("uniform")(objects, seed));
             }}};
}

}  // namespace hashphase::benchmarks
