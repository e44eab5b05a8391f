// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/crowd_workload.hpp>

#include <demos/report/frame_clock.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace hashphase::benchmarks {
namespace {

struct Agent {
    std::int64_t strip;  // of the plane, one radius wide
    float z;
    Vector3<float> position;
    std::uint32_t object;
};

// Sorts the agents by strips along x and by z, and compares each with whoever may be near enough.
void findExactNeighbours(const std::vector<Aabb<float>>& boxes, float radius,
                         std::vector<AgentAnswer>& exact) {
    std::vector<Agent> agents;
    for (const Aabb<float>& box : boxes) {
        const Vector3<float> position = box.min() / 2 + box.max() / 2;
        agents.push_back({static_cast<std::int64_t>(std::floor(position[0] / radius)), position[2],
                          position, static_cast<std::uint32_t>(agents.size())});
    }
    const auto isBefore = [](const Agent& a, const Agent& b) {
        return a.strip != b.strip ? a.strip < b.strip : a.z < b.z;
    };
    std::sort(agents.begin(), agents.end(), isBefore);
    exact.assign(agents.size(), {});
    const float reach = radius * 1.001F;
    // In each strip, where those begin that may be near; it moves on as the agents do.
    std::array<std::size_t, 3> begins{};
    for (const Agent& agent : agents) {
        for (std::size_t i = 0; i < begins.size(); ++i) {
            // By rounding, an agent may be so many strips away.
            const std::int64_t strip = agent.strip + static_cast<std::int64_t>(i) - 1;
            const Agent first{strip, agent.z - reach, {}, 0};
            std::size_t& begin = begins[i];
            while (begin < agents.size() && isBefore(agents[begin], first)) {
                ++begin;
            }
            for (std::size_t k = begin; k < agents.size(); ++k) {
                const Agent& other = agents[k];
                if (other.strip != strip || other.z > agent.z + reach) {
                    break;
                }
                const Vector3<float> way = other.position - agent.position;
                const float squared = (way[0] * way[0] + way[1] * way[1]) + way[2] * way[2];
                if (squared <= radius * radius && other.object != agent.object) {
                    exact[agent.object].add(other.object);
                }
            }
        }
    }
}

}  // namespace

void CrowdWorkload::add(const ContestantKind& kind) {
    for (const CrowdKind& known : crowdKinds(objects())) {
        if (known.kind.name == kind.name) {
            entries_.push_back({known.make(), kind.onThreads});
            entries_.back().contestant->move(scene_.frame());
        }
    }
}

void CrowdWorkload::beginFrame() {
    scene_.advance();
    for (Entry& entry : entries_) {
        entry.contestant->move(scene_.frame());
    }
}

double CrowdWorkload::runFrame(std::size_t contestant) {
    Entry& entry = entries_[contestant];
    const demos::FrameClock watch(entry.onThreads);
    entry.contestant->ask(radius_);
    return watch.milliseconds();
}

void CrowdWorkload::listAnswers(std::size_t contestant, std::vector<Answer>& answers) {
    const Entry& entry = entries_[contestant];
    answers_.assign(objects(), {});
    entry.contestant->listAnswers(radius_, answers_);
    answers.clear();
    for (std::size_t agent = 0; agent < answers_.size(); ++agent) {
        const AgentAnswer& answer = answers_[agent];
        const bool isWrong = entry.contestant->tellsWho() && answer.sum != exact_[agent].sum;
        answers.push_back(Answer{agent} << 32 | (isWrong ? ~answer.count : answer.count));
    }
}

void CrowdWorkload::listExactAnswers(std::vector<Answer>& answers) {
    findExactNeighbours(scene_.boxes(), radius_, exact_);
    answers.clear();
    for (std::size_t agent = 0; agent < exact_.size(); ++agent) {
        answers.push_back(Answer{agent} << 32 | exact_[agent].count);
    }
}

Memory CrowdWorkload::memory(std::size_t contestant) const {
    return {std::nullopt, entries_[contestant].contestant->ownBytes()};
}

}  // namespace hashphase::benchmarks
