// SPDX-License-Identifier: Zlib
#pragma once

// The frame of a game: boxes are set, or objects come or go, and then the complete current set of
// pairs is there.

#include <demos/scenes/random.hpp>
#include <tests/benchmarks/workload.hpp>

namespace hashphase::benchmarks {

/// What is done and timed in a frame.
enum class PairFrame {
    setAll,      // all boxes are set, moved or not, as Bullet does, and the pairs found
    setMovers,   // those that are not static alone are set, and the pairs found
    setNothing,  // none after the first time: everything is static or asleep; pairs are found
    remove,      // 1,000 objects are removed, others in each frame, and put back untimed: the calls
    removeAndFind,  // the same, and pairs are found
    create,         // a broadphase of all objects is made anew, and the pairs found
};

class PairWorkload : public Workload {
public:
    PairWorkload(std::unique_ptr<demos::BoxScene> scene, PairFrame what, std::uint64_t seed);

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override;
    void beginFrame() override;
    void listExactAnswers(std::vector<Answer>& answers) override;
    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }
    [[nodiscard]] std::size_t operations() const override {
        return what_ == PairFrame::setMovers ? movers_.size()
               : removals_ > 0               ? removals_
                                             : objects();
    }
    [[nodiscard]] bool watchesHeap() const override {
        return removals_ == 0 && what_ != PairFrame::create;
    }

    /// What is handed to contestants of the kind.
    [[nodiscard]] virtual FrameBoxes frameFor(const ContestantKind& /*kind*/) const {
        return scene_.frame();
    }

    [[nodiscard]] const SceneBoxes& scene() const noexcept { return scene_; }
    [[nodiscard]] PairFrame what() const noexcept { return what_; }
    [[nodiscard]] std::span<const std::uint32_t> movers() const { return movers_; }
    [[nodiscard]] std::span<const std::uint32_t> removed() const {
        return std::span(order_).first(removals_);
    }

private:
    SceneBoxes scene_;
    PairFrame what_;
    demos::Random random_;
    std::vector<std::uint32_t> movers_;  // where they alone are set
    std::vector<std::uint32_t> order_;   // those to be removed come first
    std::size_t removals_ = 0;
    bool moves_;
};

/// Of the scene.
[[nodiscard]] std::function<std::unique_ptr<Workload>(std::size_t, std::uint64_t)> makePairWorkload(
    MakeScene makeScene, PairFrame what = PairFrame::setAll);

}  // namespace hashphase::benchmarks
