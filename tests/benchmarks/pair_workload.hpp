// SPDX-License-Identifier: Zlib
#pragma once

// The frame of a game: the boxes are set, and then the complete current set of pairs is there.

#include <tests/benchmarks/scene_boxes.hpp>
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
                          Setting setting = Setting::everything);

    void add(const ContestantKind& kind) override;
    void beginFrame() override;
    double runFrame(std::size_t contestant) override;
    void runWatchedFrame(std::size_t contestant) override;
    void listAnswers(std::size_t contestant, std::vector<Answer>& answers) override;
    void listExactAnswers(std::vector<Answer>& answers) override;
    void endFrame(std::size_t contestant) override;
    [[nodiscard]] Memory memory(std::size_t contestant) const override;
    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }
    [[nodiscard]] std::size_t operations() const override { return scene_.size(); }

protected:
    /// What is handed to contestants of the kind.
    [[nodiscard]] virtual FrameBoxes frameFor(const ContestantKind& /*kind*/) const {
        return scene_.frame();
    }

    [[nodiscard]] const SceneBoxes& scene() const noexcept { return scene_; }

private:
    struct Entry {
        ContestantKind kind;
        std::unique_ptr<Contestant> contestant;
        demos::HeapMeter heap;
    };

    SceneBoxes scene_;
    Setting setting_;
    bool begun_ = false;
    std::vector<Entry> entries_;
};

}  // namespace hashphase::benchmarks
