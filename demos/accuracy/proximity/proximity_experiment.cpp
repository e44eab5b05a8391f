// SPDX-License-Identifier: Zlib
#include <demos/accuracy/proximity/proximity_experiment.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hashphase::demos {
namespace {

constexpr std::string_view kProximityDeclaration =
#include <demos/accuracy/proximity/proximity.sql>
    ;

constexpr double kAgentEdge = 0.5;      // [m]
constexpr double kStepByRadius = 0.02;  // on an axis, in a frame

/// How many of those that an estimate by cells finds are really near. Agents of edge e lie
/// anywhere. The cells that the box of a ball of radius r touches are 2 r + c wide on average, c
/// being their edge, and an agent touches them when its centre is at most e / 2 outside; so on a
/// plain pi r^2 / (2 r + c + e)^2, and in space 4/3 pi r^3 / (2 r + c + e)^3.
double estimatePrecision(const Crowd& crowd) {
    const double edge = 2 * crowd.radius + crowd.cellSize() + kAgentEdge;
    return std::numbers::pi * (crowd.radius * crowd.radius) / (edge * edge);
}

AgentPlan agentPlan(const Crowd& crowd) {
    return {crowd.agents, crowd.side(), kAgentEdge, kStepByRadius * crowd.radius};
}

void decide(const NeighbourSearch& search, std::span<const std::uint32_t> colours,
            std::span<std::uint32_t> chosen) {
    if (search.decide) {
        search.decide(colours, chosen);
        return;
    }
    search.forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
        ColourCounts counts{};
        for (const std::uint32_t neighbour : neighbours) {
            ++counts[colours[neighbour]];
        }
        chosen[agent] = rarestOf(counts);
    });
}

/// The methods at work on a crowd, side by side.
class Trial {
public:
    Trial(const Crowd& crowd, std::size_t number, std::span<const NeighbourMethod> methods,
          std::uint64_t seed, Measurements& measured)
        : crowd_(crowd),
          number_(number),
          measured_(measured),
          scene_(agentPlan(crowd), seed),
          colours_(crowd.agents) {
        Random random(seed);
        for (std::uint32_t& colour : colours_) {
            colour = static_cast<std::uint32_t>(random.unit() *
                                                static_cast<float>(ColourCounts().size()));
        }
        const NeighbourNeeds needs{crowd.agents, scene_.bounds(), static_cast<float>(crowd.radius),
                                   static_cast<float>(crowd.cellSize())};
        for (const NeighbourMethod& method : methods) {
            if (crowd.hasAllMethods || method.is("uses_cells")) {
                entries_.push_back(
                    {method.name, method.make(needs), std::vector<std::uint32_t>(crowd.agents)});
            }
        }
    }

    void judge(const ProximityPlan& plan) {
        Frame frame;
        for (int i = 0; i < plan.judgedFrames; ++i) {
            advance(frame);
            findTruth(frame, plan.mostJudgedAgents);
            for (Entry& entry : entries_) {
                step(entry, frame);
                judge(entry);
            }
        }
    }

    void time(const ProximityPlan& plan) {
        std::vector<Frame> frames(static_cast<std::size_t>(plan.framesTogether));
        std::vector<TimedMethod> methods;
        for (Entry& entry : entries_) {
            methods.push_back(
                {{{"trial", number_}, {"method", entry.method}}, [this, &frames, &entry] {
                     for (const Frame& frame : frames) {
                         step(entry, frame);
                     }
                 }});
        }
        const auto begin = [&](int /*round*/) {
            for (Frame& frame : frames) {
                advance(frame);
            }
        };
        measureTimes(measured_, {plan.rounds, 1, 1.0 / plan.framesTogether}, begin, methods);
    }

private:
    struct Frame {
        std::vector<Aabb<float>> boxes;
        std::vector<BulletBox> bulletBoxes;
    };
    struct Entry {
        std::string_view method;
        NeighbourSearch search;
        std::vector<std::uint32_t> chosen;
    };
    struct Truth {
        std::vector<std::uint32_t> neighbours;  // sorted
        ColourCounts colours{};
    };

    void advance(Frame& frame) {
        scene_.advance();
        frame.boxes = scene_.boxes();
        toBulletBoxes(frame.boxes, frame.bulletBoxes);
    }

    void step(Entry& entry, const Frame& frame) const {
        entry.search.take({frame.boxes, frame.bulletBoxes});
        decide(entry.search, colours_, entry.chosen);
    }

    /// By looking at everybody, for agents that have all around them what others have: nearer to
    /// the border are fewer.
    void findTruth(const Frame& frame, std::size_t most) {
        truths_.assign(crowd_.agents, std::nullopt);
        const double margin = crowd_.radius + crowd_.cellSize() + kAgentEdge;
        std::size_t judged = 0;
        for (std::uint32_t agent = 0; agent < crowd_.agents && judged < most; ++agent) {
            const Vector3<double> place = frame.boxes[agent].cast<double>().center();
            const double nearest = std::min(place.x(), place.z());
            const double farthest = std::max(place.x(), place.z());
            if (nearest >= margin && farthest <= crowd_.side() - margin) {
                truths_[agent] = truthOf(agent, place, frame);
                ++judged;
            }
        }
        if (judged == 0) {
            throw std::invalid_argument(crowd_.name + ": the square is too small for the cells.");
        }
    }

    [[nodiscard]] Truth truthOf(std::uint32_t agent, const Vector3<double>& place,
                                const Frame& frame) const {
        Truth truth;
        for (std::uint32_t other = 0; other < crowd_.agents; ++other) {
            const Vector3<double> way = frame.boxes[other].cast<double>().center() - place;
            if (other != agent && way.squaredNorm() <= crowd_.radius * crowd_.radius) {
                truth.neighbours.push_back(other);
                ++truth.colours[colours_[other]];
            }
        }
        return truth;
    }

    /// Compares its lists and its decisions with the truth.
    void judge(Entry& entry) {
        std::size_t neighbours = 0;
        std::size_t found = 0;
        std::size_t wrongly = 0;
        std::vector<std::uint32_t> named;
        entry.search.forEach([&](std::uint32_t agent, std::span<const std::uint32_t> those) {
            if (!truths_[agent]) {
                return;
            }
            named.assign(those.begin(), those.end());
            std::sort(named.begin(), named.end());
            named.erase(std::unique(named.begin(), named.end()), named.end());
            const std::vector<std::uint32_t>& right = truths_[agent]->neighbours;
            neighbours += right.size();
            found += right.size() - countMissing(right, named);
            wrongly += countMissing(named, right);
        });
        int decisions = 0;
        int wrong = 0;
        int worse = 0;
        for (std::size_t agent = 0; agent < truths_.size(); ++agent) {
            if (truths_[agent]) {
                const ColourCounts& counts = truths_[agent]->colours;
                const std::uint32_t chosen = entry.chosen[agent];
                const std::uint32_t rarest = rarestOf(counts);
                ++decisions;
                wrong += chosen != rarest ? 1 : 0;
                worse += counts[chosen] > counts[rarest] ? 1 : 0;
            }
        }
        measured_.add("judged", {{"trial", number_},
                                 {"method", entry.method},
                                 {"neighbours", neighbours},
                                 {"found", found},
                                 {"wrongly", wrongly},
                                 {"decisions", decisions},
                                 {"wrong", wrong},
                                 {"worse", worse}});
    }

    const Crowd& crowd_;
    std::size_t number_;
    Measurements& measured_;
    AgentScene scene_;
    std::vector<std::uint32_t> colours_;
    std::vector<Entry> entries_;
    std::vector<std::optional<Truth>> truths_;  // by agent; of those that are judged
};

Crowd crowdOf(std::size_t agents, double neighbours, double radiusByCell) {
    return {withThousands(agents) + " agents, each with " + valueText(neighbours) +
                " others within 5 m",
            agents,
            neighbours,
            5,
            radiusByCell,
            radiusByCell == 1};
}

ProximityPlan proximityPlan(const Effort& effort) {
    ProximityPlan plan;
    plan.mostJudgedAgents = effort.quickOrFull<std::size_t>(300, 1000);
    const auto agents = effort.quickOrFull<std::size_t>(1'200, 5'000);
    for (const double ratio :
         effort.isQuick ? std::vector{0.5, 1.0, 4.0} : std::vector{0.1, 0.5, 1.0, 2.0, 4.0, 8.0}) {
        plan.crowds.push_back(crowdOf(agents, 20, ratio));
    }
    // FLAME GPU's benchmark: one agent a square metre, who sees 2 m far.
    plan.crowds.push_back(
        {"Circles: " + withThousands(agents) + " agents, one a square metre, radius 2 m", agents,
         4 * std::numbers::pi, 2});
    if (!effort.isQuick) {
        for (const double ratio : {1.0, 4.0}) {
            plan.crowds.push_back(crowdOf(10'000, 20, ratio));
        }
        for (const double neighbours : {5.0, 80.0}) {
            plan.crowds.push_back(crowdOf(agents / 2, neighbours, 1));
        }
    }
    return plan;
}

}  // namespace

double Crowd::side() const {
    return radius * std::sqrt(std::numbers::pi * static_cast<double>(agents) / neighbours);
}

Findings measureProximity(const ProximityPlan& plan, std::span<const NeighbourMethod> methods,
                          std::uint64_t seed, const TellProgress& tell) {
    Measurements measured;
    addMethods(methods, {"exact", "complete", "estimate", "uses_cells"}, measured);
    for (std::size_t i = 0; i < plan.crowds.size(); ++i) {
        const Crowd& crowd = plan.crowds[i];
        tell(static_cast<double>(i) / static_cast<double>(plan.crowds.size()), crowd.name);
        measured.add("trials", {{"trial", i},
                                {"crowd", crowd.name},
                                {"agents", crowd.agents},
                                {"cell", crowd.cellSize()},
                                {"ratio", crowd.radiusByCell},
                                {"estimate_precision", estimatePrecision(crowd)}});
        Trial trial(crowd, i, methods, seed, measured);
        trial.judge(plan);
        trial.time(plan);
    }
    measureStatedEstimates(plan.statedEstimates, seed, measured);
    return findingsOf(kProximityDeclaration, measured);
}

Experiment proximityExperiment() {
    return {"P3",
            "Proximity for AI",
            "How many decisions are wrong with approximate neighbours, and how much time is saved?",
            5,
            100,
            [](const Effort& effort, const TellProgress& tell) {
                return measureProximity(proximityPlan(effort), neighbourMethods(), effort.seed,
                                        tell);
            }};
}

}  // namespace hashphase::demos
