// SPDX-License-Identifier: Zlib
#pragma once

// Objects that come and go in a world that stands still.

#include <demos/scenes/random.hpp>
#include <tests/benchmarks/scene_boxes.hpp>
#include <tests/benchmarks/workload.hpp>

namespace hashphase::benchmarks {

/// What a frame's time covers.
enum class RemovalTiming {
    removals,          // the calls that remove
    removalsAndPairs,  // those, and having the complete set of pairs afterwards
};

/// Removes so many objects, others in each frame; those of the frame before are put back, untimed.
class RemovalWorkload : public Workload {
public:
    RemovalWorkload(std::unique_ptr<demos::BoxScene> scene, std::size_t removals,
                    RemovalTiming timing, std::uint64_t seed);

    void add(const ContestantKind& kind) override;
    void beginFrame() override;
    double runFrame(std::size_t contestant) override;
    void listAnswers(std::size_t contestant, std::vector<Answer>& answers) override;
    void listExactAnswers(std::vector<Answer>& answers) override;
    void endFrame(std::size_t contestant) override;
    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }
    [[nodiscard]] std::size_t operations() const override { return removals_; }

private:
    [[nodiscard]] std::span<const std::uint32_t> removed() const {
        return std::span(order_).first(removals_);
    }

    SceneBoxes scene_;
    std::size_t removals_;
    RemovalTiming timing_;
    demos::Random random_;
    std::vector<std::uint32_t> order_;  // those to be removed come first
    std::vector<std::unique_ptr<Contestant>> contestants_;
};

/// Makes a broadphase of all objects and finds their pairs, anew in each frame.
class CreationWorkload : public Workload {
public:
    explicit CreationWorkload(std::unique_ptr<demos::BoxScene> scene);

    void add(const ContestantKind& kind) override;
    void beginFrame() override;
    double runFrame(std::size_t contestant) override;
    void listAnswers(std::size_t contestant, std::vector<Answer>& answers) override;
    void listExactAnswers(std::vector<Answer>& answers) override;
    void endFrame(std::size_t contestant) override;
    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }
    [[nodiscard]] std::size_t operations() const override { return scene_.size(); }

private:
    struct Entry {
        const ContestantKind* kind;
        std::unique_ptr<Contestant> contestant;
    };

    SceneBoxes scene_;
    std::vector<Entry> entries_;
};

}  // namespace hashphase::benchmarks
