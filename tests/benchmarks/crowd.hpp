// SPDX-License-Identifier: Zlib
#pragma once

// Every agent of a crowd asks who is within a radius of its centre, in every frame; all move.
//
// Timed     what leads from the agents' boxes to the answers of all: taking them in where a structure
//           is made anew, and asking.
// Answers   are an agent and its number of neighbours. Who tells who they are tells it by a sum, and
//           a wrong sum is a wrong answer.

#include <tests/benchmarks/workload.hpp>

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
};

struct Crowd {
    SceneBoxes scene;
    float radius;  // [m]
    std::vector<AgentAnswer> exact = {};

    [[nodiscard]] Vector3<float> centreOf(std::size_t object) const {
        const Aabb<float>& box = scene.boxes()[object];
        return box.min() / 2 + box.max() / 2;
    }
};

class CrowdRunner : public Runner {
public:
    explicit CrowdRunner(const Crowd& crowd) : crowd_(crowd) {}

    void listAnswers(std::vector<Answer>& answers) final;

protected:
    /// Sets the answers of the last frame, by object; may ask again. Returns whether their sums are there.
    virtual bool setAnswers(std::vector<AgentAnswer>& answers) = 0;

    const Crowd& crowd_;
};

struct CrowdKind {
    ContestantKind kind;
    std::function<std::unique_ptr<CrowdRunner>(const Crowd&)> make;
};

}  // namespace hashphase::benchmarks
