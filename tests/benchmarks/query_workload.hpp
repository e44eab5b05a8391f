// SPDX-License-Identifier: Zlib
#pragma once

// Questions to a filled broadphase: what do these rays, or boxes, or agents meet? Each frame asks
// others. The exact answers come from testing every object.

#include <broadphase/neighbours.hpp>
#include <demos/scenes/random.hpp>
#include <tests/benchmarks/scene_boxes.hpp>
#include <tests/benchmarks/workload.hpp>

#include <functional>

namespace hashphase::benchmarks {

[[nodiscard]] constexpr Answer answerOf(std::size_t query, std::uint32_t found) noexcept {
    return Answer{query} << 32 | found;
}

/// What the query workloads have in common: broadphases of Bullet's kind, and their answers.
class QueryWorkload : public Workload {
public:
    explicit QueryWorkload(std::unique_ptr<demos::BoxScene> scene) : scene_(std::move(scene)) {}

    void add(const ContestantKind& kind) override;
    double runFrame(std::size_t contestant) override;
    void listAnswers(std::size_t contestant, std::vector<Answer>& answers) override;
    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }

protected:
    /// The timed part: asks all queries of the frame and writes down the answers.
    virtual void ask(demos::FilledBroadphase& filled, std::vector<Answer>& answers) = 0;

    /// Moves all boxes on, in every broadphase.
    void advanceScene();

    [[nodiscard]] const SceneBoxes& scene() const noexcept { return scene_; }
    [[nodiscard]] demos::FilledBroadphase& filled(std::size_t contestant) {
        return *entries_[contestant].filled;
    }

private:
    struct Entry {
        std::unique_ptr<demos::FilledBroadphase> filled;
        std::vector<Answer> answers;
    };

    SceneBoxes scene_;
    std::vector<Entry> entries_;
};

/// Every agent asks who is within `radius` [m] of its centre; all agents move before each frame.
class NeighbourWorkload : public QueryWorkload {
public:
    NeighbourWorkload(std::unique_ptr<demos::BoxScene> scene, float radius)
        : QueryWorkload(std::move(scene)), radius_(radius) {}

    void beginFrame() override { advanceScene(); }
    void listExactAnswers(std::vector<Answer>& answers) override;
    [[nodiscard]] std::size_t operations() const override { return scene().size(); }

private:
    void ask(demos::FilledBroadphase& filled, std::vector<Answer>& answers) override;
    void askForAll(const SpatialHashBroadphase& broadphase, std::vector<Answer>& answers);

    float radius_;
    std::vector<SphereRegion<float>> regions_;  // of the agents
    Neighbours<float> neighbours_;
};

}  // namespace hashphase::benchmarks
