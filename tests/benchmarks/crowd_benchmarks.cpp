// SPDX-License-Identifier: Zlib

// Which crowds are asked who is near whom, and who answers.

#include <broadphase/radius_search.hpp>
#include <integration/bullet/conversions.hpp>
#include <tests/benchmarks/peers/peers.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace hashphase::benchmarks {

void CrowdRunner::listAnswers(std::vector<Answer>& answers) {
    std::vector<AgentAnswer> all(crowd_.exact.size());
    const bool areSumsThere = setAnswers(all);
    answers.clear();
    for (std::size_t agent = 0; agent < all.size(); ++agent) {
        const bool isWrong = areSumsThere && all[agent].sum != crowd_.exact[agent].sum;
        answers.push_back(answerOf(agent, isWrong ? ~all[agent].count : all[agent].count));
    }
}

namespace {

// --- The exact answers -----------------------------------------------------------------------------

struct Agent {
    std::int64_t strip;  // of the plane, one radius wide
    float z;
    Vector3<float> position;
    std::uint32_t object;
};

// Sorts the agents by strips along x and by z, and compares each with whoever may be near enough.
void findExactNeighbours(Crowd& crowd) {
    const float radius = crowd.radius;
    std::vector<Agent> agents;
    for (std::uint32_t object = 0; object < crowd.scene.size(); ++object) {
        const Vector3<float> position = crowd.centreOf(object);
        agents.push_back({static_cast<std::int64_t>(std::floor(position[0] / radius)), position[2],
                          position, object});
    }
    const auto isBefore = [](const Agent& a, const Agent& b) {
        return a.strip != b.strip ? a.strip < b.strip : a.z < b.z;
    };
    std::sort(agents.begin(), agents.end(), isBefore);
    crowd.exact.assign(agents.size(), {});
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
                    crowd.exact[agent.object].add(other.object);
                }
            }
        }
    }
}

// --- Who answers ---------------------------------------------------------------------------------

enum class Telling { count, list };

/// A crowd of a grid's proxies.
class OwnCrowd final : public CrowdRunner {
public:
    OwnCrowd(const Crowd& crowd, Telling telling, ParallelFor parallelFor)
        : CrowdRunner(crowd), telling_(telling), parallelFor_(parallelFor) {
        for (const Aabb<float>& box : crowd.scene.boxes()) {
            ids_.push_back(grid_.add(box));
            objects_.resize(ids_.size());
            objects_[ids_.back().index] = static_cast<std::uint32_t>(ids_.size() - 1);
        }
        heads_.resize(ids_.size());
        counts_.resize(ids_.size());
    }

    void beginFrame() override {
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            grid_.move(ids_[i], crowd_.scene.boxes()[i]);
        }
        grid_.update();
    }

    void run() override {
        search_.take(grid_, crowd_.radius, acceptAll, parallelFor_);
        if (telling_ == Telling::count) {
            search_.count(counts_, parallelFor_);
            return;
        }
        search_.forEach(
            [this](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
                heads_[agent] = neighbours.empty() ? 0 : neighbours.front();
            },
            parallelFor_);
    }

    bool setAnswers(std::vector<AgentAnswer>& answers) override {
        const auto objectOf = [this](std::uint32_t agent) {
            return objects_[search_.id(agent).index];
        };
        if (telling_ == Telling::count) {
            for (std::uint32_t agent = 0; agent < counts_.size(); ++agent) {
                answers[objectOf(agent)].count = counts_[agent];
            }
            return false;
        }
        search_.forEach(
            [&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
                for (const std::uint32_t neighbour : neighbours) {
                    answers[objectOf(agent)].add(objectOf(neighbour));
                }
            },
            parallelFor_);
        return true;
    }

    [[nodiscard]] std::optional<OwnBytes> ownBytes() const override {
        return OwnBytes{search_.memoryBytes(), 0};
    }

private:
    Telling telling_;
    ParallelFor parallelFor_;
    Grid<float> grid_;
    RadiusSearch<float> search_;
    std::vector<ProxyId> ids_;            // by object
    std::vector<std::uint32_t> objects_;  // by index of proxy
    std::vector<std::uint32_t> counts_;
    std::vector<std::uint32_t> heads_;
};

/// A box query for each agent, whose finds are measured.
class DbvtCrowd final : public CrowdRunner {
public:
    explicit DbvtCrowd(const Crowd& crowd)
        : CrowdRunner(crowd),
          filled_(filledWith(crowd.scene, *contestantKind(kBaseline).bullet)),
          answers_(crowd.scene.size()) {}

    void beginFrame() override {
        filled_->setAll(crowd_.scene.frame().bulletBoxes);
        filled_->findPairs();
    }

    void run() override {
        const btVector3 reach(crowd_.radius, crowd_.radius, crowd_.radius);
        for (std::uint32_t agent = 0; agent < answers_.size(); ++agent) {
            answers_[agent] = {};
            Callback callback(crowd_, agent, answers_[agent]);
            const btVector3 middle = toBullet(callback.centre);
            filled_->broadphase().aabbTest(middle - reach, middle + reach, callback);
        }
    }

    bool setAnswers(std::vector<AgentAnswer>& answers) override {
        answers = answers_;
        return true;
    }

private:
    struct Callback : btBroadphaseAabbCallback {
        Callback(const Crowd& itsCrowd, std::uint32_t itsAgent, AgentAnswer& itsAnswer)
            : crowd(itsCrowd),
              agent(itsAgent),
              centre(itsCrowd.centreOf(itsAgent)),
              radiusSquared(itsCrowd.radius * itsCrowd.radius),
              answer(itsAnswer) {}

        bool process(const btBroadphaseProxy* proxy) override {
            const std::uint32_t object = demos::FilledBroadphase::objectOf(*proxy);
            const Vector3<float> way = crowd.centreOf(object) - centre;
            const float squared = (way[0] * way[0] + way[1] * way[1]) + way[2] * way[2];
            if (squared <= radiusSquared && object != agent) {
                answer.add(object);
            }
            return true;
        }

        const Crowd& crowd;
        std::uint32_t agent;
        Vector3<float> centre;
        float radiusSquared;
        AgentAnswer& answer;
    };

    std::unique_ptr<demos::FilledBroadphase> filled_;
    std::vector<AgentAnswer> answers_;
};

CrowdKind ownKind(const char* name, Telling telling,
                  std::optional<ParallelFor> threaded = std::nullopt) {
    return {{.name = name,
             .title = telling == Telling::count ? "hashphase::RadiusSearch::count"
                                                : "hashphase::RadiusSearch::forEach",
             .ours = true,
             .onThreads = threaded.has_value()},
            [=](const Crowd& crowd) {
                return std::make_unique<OwnCrowd>(crowd, telling, threaded.value_or(serialFor));
            }};
}

/// All that this build can measure, for so many agents.
std::vector<CrowdKind> crowdKinds(std::size_t agents) {
    constexpr std::size_t kMostForDbvt = 100'000;
    std::vector<CrowdKind> kinds{ownKind("hash", Telling::count),
                                 ownKind("hash-list", Telling::list)};
    if (const std::optional<ParallelFor> threaded = threadedLoop()) {
        kinds.push_back(ownKind("hash-threads", Telling::count, threaded));
        kinds.push_back(ownKind("hash-list-threads", Telling::list, threaded));
    }
    if (agents <= kMostForDbvt) {
        kinds.push_back({contestantKind(kBaseline),
                         [](const Crowd& crowd) { return std::make_unique<DbvtCrowd>(crowd); }});
    }
    for (CrowdKind& kind : nanoflannKinds()) {
        kinds.push_back(std::move(kind));
    }
    return kinds;
}

// --- Which crowds --------------------------------------------------------------------------------

class CrowdWorkload final : public Workload {
public:
    CrowdWorkload(std::unique_ptr<demos::BoxScene> scene, float radius)
        : crowd_{SceneBoxes(std::move(scene)), radius} {}

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override {
        const std::vector<CrowdKind> kinds = crowdKinds(objects());
        return std::find_if(kinds.begin(), kinds.end(),
                            [&](const CrowdKind& each) { return each.kind.name == kind.name; })
            ->make(crowd_);
    }
    void beginFrame() override { crowd_.scene.advance(); }
    void listExactAnswers(std::vector<Answer>& answers) override {
        findExactNeighbours(crowd_);
        answers.clear();
        for (std::size_t agent = 0; agent < crowd_.exact.size(); ++agent) {
            answers.push_back(answerOf(agent, crowd_.exact[agent].count));
        }
    }
    [[nodiscard]] std::size_t objects() const override { return crowd_.scene.size(); }

private:
    Crowd crowd_;
};

/// Agents whose boxes have edges of 2 m; so many on each square metre of a plane, or in each cubic metre.
Benchmark crowdBenchmark(const char* name, const char* description, std::size_t agents, int axes,
                         double density, float radius) {
    return {.name = name,
            .group = "crowds",
            .description = description,
            .operation = "agent",
            .sizes = {agents},
            .onRequest = agents > 100'000,
            .contestants =
                [](std::size_t objects, std::uint64_t /*seed*/) {
                    std::vector<ContestantKind> kinds;
                    for (CrowdKind& crowd : crowdKinds(objects)) {
                        kinds.push_back(std::move(crowd.kind));
                    }
                    return kinds;
                },
            .make =
                [axes, density, radius](std::size_t objects, std::uint64_t seed) {
                    const double volume = static_cast<double>(objects) / density;
                    const auto side = static_cast<float>(std::pow(volume, 1.0 / axes));
                    const Vector3<float> room(side, axes == 3 ? side : 0, side);
                    return std::make_unique<CrowdWorkload>(cubesIn(room, 1, 0.5F)(objects, seed),
                                                           radius);
                }};
}

}  // namespace

std::vector<Benchmark> crowdBenchmarks() {
    return {
        crowdBenchmark("crowd",
                       "for each agent, all agents within 10 m: 98 on average; all agents move",
                       50'000, 2, 0.3125, 10),
        crowdBenchmark("circles-2d", "FLAME GPU's Circles: one agent a square metre, within 2 m",
                       1'000'000, 2, 1, 2),
        crowdBenchmark("circles-3d", "FLAME GPU's Circles: one agent a cubic metre, within 2 m",
                       1'000'000, 3, 1, 2)};
}

}  // namespace hashphase::benchmarks
