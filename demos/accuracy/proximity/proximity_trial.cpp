// SPDX-License-Identifier: Zlib
#include <demos/accuracy/proximity/proximity_trial.hpp>

#include <demos/accuracy/proximity/agent_scene.hpp>
#include <demos/accuracy/timing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>

namespace hashphase::demos {
namespace {

constexpr double kStepByRadius = 0.02;  // on an axis, in a frame

AgentPlan agentPlan(const ProximityCase& crowd) {
    AgentPlan plan;
    plan.agents = crowd.agents;
    plan.side = crowd.side();
    plan.edge = kAgentEdge;
    plan.step = kStepByRadius * crowd.radius;
    return plan;
}

double squared(double number) {
    return number * number;
}

class Trier {
public:
    Trier(const ProximityCase& crowd, std::span<const NeighbourMethod> methods, std::uint64_t seed)
        : crowd_(crowd), scene_(agentPlan(crowd), seed), colours_(crowd.agents) {
        Random random(seed);
        for (std::uint32_t& colour : colours_) {
            colour = static_cast<std::uint32_t>(random.unit() * static_cast<float>(kColourCount));
        }
        const NeighbourNeeds needs{crowd.agents, scene_.bounds(), static_cast<float>(crowd.radius),
                                   static_cast<float>(crowd.cellSize())};
        for (const NeighbourMethod& method : methods) {
            entries_.push_back({method.make(needs), {}, std::vector<std::uint32_t>(crowd.agents)});
        }
    }

    void judge(const ProximityPlan& plan) {
        for (int frame = 0; frame < plan.judgedFrames; ++frame) {
            advance(frame_);
            findTruth(plan.mostJudgedAgents);
            for (Entry& entry : entries_) {
                entry.search->take(frame_.view());
                entry.search->decide(colours_, entry.chosen);
                judgeLists(entry);
                judgeDecisions(entry);
            }
        }
    }

    void time(const ProximityPlan& plan) {
        block_.resize(static_cast<std::size_t>(plan.framesTogether));
        std::vector<std::function<void()>> runs;
        for (Entry& entry : entries_) {
            runs.push_back([this, &entry] {
                for (const Frame& frame : block_) {
                    entry.search->take(frame.view());
                    entry.search->decide(colours_, entry.chosen);
                }
            });
        }
        const auto begin = [&](int /*round*/) {
            for (Frame& frame : block_) {
                advance(frame);
            }
        };
        const std::vector<Spread> times = timeInTurn(plan.rounds, 1, begin, runs);
        const double share = 1.0 / plan.framesTogether;
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            entries_[i].measured.time = {times[i].median * share, times[i].low * share,
                                         times[i].high * share};
        }
    }

    [[nodiscard]] std::vector<ProximityMeasurement> measurements() const {
        std::vector<ProximityMeasurement> all;
        for (const Entry& entry : entries_) {
            all.push_back(entry.measured);
        }
        return all;
    }

private:
    struct Frame {
        std::vector<Aabb<float>> boxes;
        std::vector<BulletBox> bulletBoxes;

        [[nodiscard]] AgentFrame view() const { return {boxes, bulletBoxes}; }
    };
    struct Entry {
        std::unique_ptr<NeighbourSearch> search;
        ProximityMeasurement measured;
        std::vector<std::uint32_t> chosen;
    };
    struct Truth {
        std::vector<std::uint32_t> neighbours;  // sorted
        std::array<std::uint32_t, kColourCount> colours{};
    };

    void advance(Frame& frame) {
        scene_.advance();
        frame.boxes = scene_.boxes();
        toBulletBoxes(frame.boxes, frame.bulletBoxes);
    }

    /// By looking at everybody, for agents that have all around them what others have: nearer to the
    /// border are fewer.
    void findTruth(std::size_t most) {
        truths_.assign(crowd_.agents, std::nullopt);
        const double margin = crowd_.radius + crowd_.cellSize() + kAgentEdge;
        std::size_t judged = 0;
        for (std::uint32_t agent = 0; agent < crowd_.agents && judged < most; ++agent) {
            const Vector3<double> place = frame_.boxes[agent].cast<double>().center();
            const double nearest = std::min(place.x(), place.z());
            const double farthest = std::max(place.x(), place.z());
            if (nearest >= margin && farthest <= crowd_.side() - margin) {
                truths_[agent] = truthOf(agent, place);
                ++judged;
            }
        }
        if (judged == 0) {
            throw std::invalid_argument(crowd_.name + ": the square is too small for the cells.");
        }
    }

    [[nodiscard]] Truth truthOf(std::uint32_t agent, const Vector3<double>& place) const {
        Truth truth;
        for (std::uint32_t other = 0; other < crowd_.agents; ++other) {
            const Vector3<double> way = frame_.boxes[other].cast<double>().center() - place;
            if (other != agent && way.squaredNorm() <= squared(crowd_.radius)) {
                truth.neighbours.push_back(other);
                ++truth.colours[colours_[other]];
            }
        }
        return truth;
    }

    void judgeLists(Entry& entry) {
        entry.search->forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
            if (!truths_[agent]) {
                return;
            }
            named_.assign(neighbours.begin(), neighbours.end());
            std::sort(named_.begin(), named_.end());
            named_.erase(std::unique(named_.begin(), named_.end()), named_.end());
            const std::vector<std::uint32_t>& truth = truths_[agent]->neighbours;
            common_.clear();
            std::set_intersection(named_.begin(), named_.end(), truth.begin(), truth.end(),
                                  std::back_inserter(common_));
            entry.measured.neighbours += truth.size();
            entry.measured.found += common_.size();
            entry.measured.wrongly += named_.size() - common_.size();
        });
    }

    void judgeDecisions(Entry& entry) {
        ++entry.measured.judgedFrames;
        for (std::size_t agent = 0; agent < truths_.size(); ++agent) {
            if (truths_[agent]) {
                const auto& counts = truths_[agent]->colours;
                const std::uint32_t chosen = entry.chosen[agent];
                const std::uint32_t rarest = rarestOf(counts);
                ++entry.measured.decisions;
                entry.measured.wrong += chosen != rarest ? 1 : 0;
                entry.measured.worse += counts[chosen] > counts[rarest] ? 1 : 0;
            }
        }
    }

    const ProximityCase& crowd_;
    AgentScene scene_;
    std::vector<std::uint32_t> colours_;
    Frame frame_;
    std::vector<Frame> block_;
    std::vector<Entry> entries_;
    std::vector<std::optional<Truth>> truths_;  // by agent; of those that are judged
    std::vector<std::uint32_t> named_;
    std::vector<std::uint32_t> common_;
};

}  // namespace

double ProximityCase::side() const {
    return radius * std::sqrt(std::numbers::pi * static_cast<double>(agents) / neighbours);
}

double ProximityMeasurement::recall() const {
    return neighbours == 0 ? 1 : static_cast<double>(found) / static_cast<double>(neighbours);
}

std::optional<double> ProximityMeasurement::precision() const {
    if (found + wrongly == 0) {
        return std::nullopt;
    }
    return static_cast<double>(found) / static_cast<double>(found + wrongly);
}

double ProximityMeasurement::wrongShare() const {
    return decisions == 0 ? 0 : static_cast<double>(wrong) / static_cast<double>(decisions);
}

std::vector<ProximityMeasurement> tryProximity(const ProximityCase& crowd,
                                               std::span<const NeighbourMethod> methods,
                                               const ProximityPlan& plan, std::uint64_t seed) {
    Trier trier(crowd, methods, seed);
    trier.judge(plan);
    trier.time(plan);
    return trier.measurements();
}

}  // namespace hashphase::demos
