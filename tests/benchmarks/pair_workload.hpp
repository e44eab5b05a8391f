// SPDX-License-Identifier: Zlib
#pragma once

// The frame of a game: the boxes are set, and then the complete current set of pairs is there.

#include <tests/benchmarks/workload.hpp>

namespace hashphase::benchmarks {

/// Which boxes are handed in.
enum class Setting {
    everything,  // in every frame all, moved or not, as Bullet does
    nothing,     // none after the first time: everything is static or asleep
};

class PairWorkload : public Workload {
public:
    explicit PairWorkload(std::unique_ptr<demos::BoxScene> scene,
                          Setting setting = Setting::everything)
        : scene_(std::move(scene)), setting_(setting) {}

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override;
    void beginFrame() override;
    void listExactAnswers(std::vector<Answer>& answers) override;
    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }
    [[nodiscard]] bool watchesHeap() const override { return true; }

    /// What is handed to contestants of the kind.
    [[nodiscard]] virtual FrameBoxes frameFor(const ContestantKind& /*kind*/) const {
        return scene_.frame();
    }

    [[nodiscard]] const SceneBoxes& scene() const noexcept { return scene_; }
    [[nodiscard]] Setting setting() const noexcept { return setting_; }

private:
    SceneBoxes scene_;
    Setting setting_;
    bool begun_ = false;
};

/// Of the scene.
[[nodiscard]] std::function<std::unique_ptr<Workload>(std::size_t, std::uint64_t)> makePairWorkload(
    MakeScene makeScene, Setting setting = Setting::everything);

}  // namespace hashphase::benchmarks
