// SPDX-License-Identifier: Zlib
#pragma once

// Every agent of a crowd asks who is within a radius of its centre, in every frame; all move.
//
// Timed     what leads from the agents' boxes to the answers of all: taking them in where a structure
//           is made anew, and asking.
// Answers   are an agent and its number of neighbours. Who tells who they are tells it by a sum, and
//           a wrong sum is a wrong answer.

#include <demos/scenes/box_scene.hpp>
#include <tests/benchmarks/scene_boxes.hpp>
#include <tests/benchmarks/workload.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace hashphase::benchmarks {

/// The neighbours of one agent.
struct AgentAnswer {
    std::uint32_t count = 0;
    std::uint32_t sum = 0;  // of mixed(object)

    [[nodiscard]] static constexpr std::uint32_t mixed(std::uint32_t object) noexcept {
        return (object + 1) * 0x9e3779b1U;
    }
    void add(std::uint32_t object) noexcept {
        ++count;
        sum += mixed(object);
    }
    friend bool operator==(const AgentAnswer&, const AgentAnswer&) = default;
};

class CrowdContestant {
public:
    CrowdContestant() = default;
    CrowdContestant(const CrowdContestant&) = delete;
    CrowdContestant& operator=(const CrowdContestant&) = delete;
    virtual ~CrowdContestant() = default;

    /// Before a frame, untimed: the agents are where these boxes are.
    virtual void move(const FrameBoxes& frame) = 0;

    /// The timed part.
    virtual void ask(float radius) = 0;

    /// Sets the answers of the last frame, by object; may ask again.
    virtual void listAnswers(float radius, std::vector<AgentAnswer>& answers) = 0;

    /// Whether an answer's sum is there.
    [[nodiscard]] virtual bool tellsWho() const { return true; }

    [[nodiscard]] virtual std::optional<OwnBytes> ownBytes() const { return std::nullopt; }
};

struct CrowdKind {
    ContestantKind kind;
    std::function<std::unique_ptr<CrowdContestant>()> make;
};

/// All that this build can measure, for so many agents.
[[nodiscard]] std::vector<CrowdKind> crowdKinds(std::size_t agents);

class CrowdWorkload : public Workload {
public:
    CrowdWorkload(std::unique_ptr<demos::BoxScene> scene, float radius)
        : scene_(std::move(scene)), radius_(radius) {}

    void add(const ContestantKind& kind) override;
    void beginFrame() override;
    double runFrame(std::size_t contestant) override;
    void listAnswers(std::size_t contestant, std::vector<Answer>& answers) override;
    void listExactAnswers(std::vector<Answer>& answers) override;
    [[nodiscard]] Memory memory(std::size_t contestant) const override;
    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }
    [[nodiscard]] std::size_t operations() const override { return scene_.size(); }

private:
    struct Entry {
        std::unique_ptr<CrowdContestant> contestant;
        bool onThreads = false;
    };

    SceneBoxes scene_;
    float radius_;
    std::vector<Entry> entries_;
    std::vector<AgentAnswer> exact_;
    std::vector<AgentAnswer> answers_;
};

}  // namespace hashphase::benchmarks
