// SPDX-License-Identifier: Zlib
#pragma once

// Questions to a filled broadphase: what do these rays, or boxes, or agents meet? Each frame asks
// others. The exact answers come from testing every object.

#include <tests/benchmarks/workload.hpp>

namespace hashphase::benchmarks {

/// What the query workloads have in common: broadphases of Bullet's kind, and their answers.
class QueryWorkload : public Workload {
public:
    /// Where the scene moves, all boxes are set before each frame, or in it, as part of what is timed.
    QueryWorkload(std::unique_ptr<demos::BoxScene> scene, bool moves, bool timesUpdate = false)
        : scene_(std::move(scene)), moves_(moves), timesUpdate_(timesUpdate) {}

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override {
        return std::make_unique<Asking>(*this, kind);
    }
    void beginFrame() override {
        if (moves_) {
            scene_.advance();
        }
        drawQueries();
    }
    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }

protected:
    /// Those of the next frame.
    virtual void drawQueries() {}

    /// The timed part: asks all queries of the frame and writes down the answers.
    virtual void ask(demos::FilledBroadphase& filled, std::vector<Answer>& answers) = 0;

    virtual void afterFrame(demos::FilledBroadphase& /*filled*/) {}

    [[nodiscard]] const SceneBoxes& scene() const noexcept { return scene_; }

private:
    class Asking final : public Runner {
    public:
        Asking(QueryWorkload& workload, const ContestantKind& kind)
            : workload_(workload), filled_(filledWith(workload.scene_, *kind.bullet)) {}

        void beginFrame() override {
            if (workload_.moves_ && !workload_.timesUpdate_) {
                update();
            }
            answers_.clear();
        }
        void run() override {
            if (workload_.moves_ && workload_.timesUpdate_) {
                update();
            }
            workload_.ask(*filled_, answers_);
        }
        void listAnswers(std::vector<Answer>& answers) override { answers = answers_; }
        void endFrame() override { workload_.afterFrame(*filled_); }

    private:
        void update() {
            filled_->setAll(workload_.scene_.frame().bulletBoxes);
            filled_->findPairs();
        }

        QueryWorkload& workload_;
        std::unique_ptr<demos::FilledBroadphase> filled_;
        std::vector<Answer> answers_;
    };

    SceneBoxes scene_;
    bool moves_;
    bool timesUpdate_;
};

/// Hash and dbvt take part.
[[nodiscard]] inline bool answersQueries(const ContestantKind& kind, std::size_t /*objects*/) {
    return kind.name == "hash" || kind.name == kBaseline;
}

/// A box, of whose places `random` takes any.
[[nodiscard]] inline const Aabb<float>& anyBox(float share, const std::vector<Aabb<float>>& boxes) {
    const auto place = static_cast<std::size_t>(share * static_cast<float>(boxes.size()));
    return boxes[std::min(place, boxes.size() - 1)];
}

}  // namespace hashphase::benchmarks
