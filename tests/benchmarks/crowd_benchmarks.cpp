// SPDX-License-Identifier: Zlib

// Which crowds are asked who is near whom, and who answers.

#include <broadphase/radius_search.hpp>
#include <demos/scenes/brownian_scene.hpp>
#include <integration/bullet/conversions.hpp>
#include <tests/benchmarks/catalog.hpp>
#include <tests/benchmarks/crowd_workload.hpp>
#include <tests/benchmarks/peers/peers.hpp>

#include <cmath>
#include <utility>

namespace hashphase::benchmarks {
namespace {

// --- Who answers ---------------------------------------------------------------------------------

enum class Question { count, list };

/// A crowd of a grid's proxies.
class OwnContestant : public CrowdContestant {
public:
    OwnContestant(Question question, ParallelFor parallelFor)
        : question_(question), parallelFor_(parallelFor) {}

    void move(const FrameBoxes& frame) override {
        for (std::size_t i = ids_.size(); i < frame.boxes.size(); ++i) {
            ids_.push_back(grid_.add(frame.boxes[i]));
            objects_.resize(ids_.size());
            objects_[ids_[i].index] = static_cast<std::uint32_t>(i);
        }
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            grid_.move(ids_[i], frame.boxes[i]);
        }
        grid_.update();
        heads_.resize(ids_.size());
        counts_.resize(ids_.size());
    }

    void ask(float radius) override {
        search_.take(grid_, radius, acceptAll, parallelFor_);
        if (question_ == Question::count) {
            search_.count(counts_, parallelFor_);
            return;
        }
        search_.forEach(
            [this](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
                heads_[agent] = neighbours.empty() ? 0 : neighbours.front();
            },
            parallelFor_);
    }

    void listAnswers(float /*radius*/, std::vector<AgentAnswer>& answers) override {
        const auto objectOf = [this](std::uint32_t agent) {
            return objects_[search_.id(agent).index];
        };
        for (std::uint32_t agent = 0; question_ == Question::count && agent < counts_.size();
             ++agent) {
            answers[objectOf(agent)].count = counts_[agent];
        }
        if (question_ == Question::list) {
            search_.forEach(
                [&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
                    for (const std::uint32_t neighbour : neighbours) {
                        answers[objectOf(agent)].add(objectOf(neighbour));
                    }
                },
                parallelFor_);
        }
    }

    [[nodiscard]] bool tellsWho() const override { return question_ == Question::list; }
    [[nodiscard]] std::optional<OwnBytes> ownBytes() const override {
        return OwnBytes{search_.memoryBytes(), 0};
    }

private:
    Question question_;
    ParallelFor parallelFor_;
    Grid<float> grid_;
    RadiusSearch<float> search_;
    std::vector<ProxyId> ids_;            // by object
    std::vector<std::uint32_t> objects_;  // by index of proxy
    std::vector<std::uint32_t> counts_;
    std::vector<std::uint32_t> heads_;
};

/// A box query for each agent, whose finds are measured.
class DbvtContestant : public CrowdContestant {
public:
    void move(const FrameBoxes& frame) override {
        frame_ = frame;
        if (filled_ == nullptr) {
            filled_ = std::make_unique<demos::FilledBroadphase>(
                *contestantKind(kBaseline).bullet, demos::BroadphaseNeeds{{}, frame.boxes.size()});
            for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
                filled_->create(static_cast<std::uint32_t>(i), frame.bulletBoxes[i],
                                frame.filterOf(i));
            }
        }
        filled_->setAll(frame.bulletBoxes);
        filled_->findPairs();
        answers_.resize(frame.boxes.size());
    }

    void ask(float radius) override {
        const btVector3 reach(radius, radius, radius);
        for (std::uint32_t agent = 0; agent < answers_.size(); ++agent) {
            const Vector3<float> centre = centreOf(agent);
            answers_[agent] = {};
            Callback callback(*this, agent, centre, radius);
            const btVector3 middle = toBullet(centre);
            filled_->broadphase().aabbTest(middle - reach, middle + reach, callback);
        }
    }

    void listAnswers(float /*radius*/, std::vector<AgentAnswer>& answers) override {
        answers = answers_;
    }

private:
    struct Callback : btBroadphaseAabbCallback {
        Callback(DbvtContestant& itsOwner, std::uint32_t itsAgent, Vector3<float> itsCentre,
                 float radius)
            : owner(itsOwner),
              agent(itsAgent),
              centre(std::move(itsCentre)),
              radiusSquared(radius * radius) {}

        bool process(const btBroadphaseProxy* proxy) override {
            const std::uint32_t object = demos::FilledBroadphase::objectOf(*proxy);
            const Vector3<float> way = owner.centreOf(object) - centre;
            const float squared = (way[0] * way[0] + way[1] * way[1]) + way[2] * way[2];
            if (squared <= radiusSquared && object != agent) {
                owner.answers_[agent].add(object);
            }
            return true;
        }

        DbvtContestant& owner;
        std::uint32_t agent;
        Vector3<float> centre;
        float radiusSquared;
    };

    [[nodiscard]] Vector3<float> centreOf(std::uint32_t object) const {
        const Aabb<float>& box = frame_.boxes[object];
        return box.min() / 2 + box.max() / 2;
    }

    FrameBoxes frame_;
    std::unique_ptr<demos::FilledBroadphase> filled_;
    std::vector<AgentAnswer> answers_;
};

CrowdKind ownKind(std::string name, std::string description, Question question,
                  ParallelFor parallelFor, bool onThreads) {
    CrowdKind crowd;
    crowd.kind.name = std::move(name);
    crowd.kind.title = question == Question::count ? "hashphase::RadiusSearch::count"
                                                   : "hashphase::RadiusSearch::forEach";
    crowd.kind.description = std::move(description);
    crowd.kind.package = "this build";
    crowd.kind.ours = true;
    crowd.kind.onThreads = onThreads;
    crowd.make = [question, parallelFor] {
        return std::make_unique<OwnContestant>(question, parallelFor);
    };
    return crowd;
}

// --- Which crowds --------------------------------------------------------------------------------

/// Agents whose boxes have edges of 2 m, evenly spread, moving by up to half a metre an axis.
demos::BrownianBoxes agentsIn(const Vector3<float>& room, std::size_t agents, std::uint64_t seed) {
    demos::Random random(seed);
    demos::BrownianBoxes boxes;
    for (std::size_t i = 0; i < agents; ++i) {
        const Vector3<float> share(random.unit(), random.unit(), random.unit());
        boxes.bodies.push_back({share.cwiseProduct(room), Vector3<float>::Constant(1), 0.5F,
                                Aabb<float>(Vector3<float>::Zero(), room)});
    }
    return boxes;
}

/// So many agents on each square metre of a plane, or in each cubic metre.
Benchmark crowdBenchmark(std::string name, std::string description, std::size_t agents, int axes,
                         double density, float radius) {
    Benchmark benchmark;
    benchmark.name = std::move(name);
    benchmark.group = "crowds";
    benchmark.description = std::move(description);
    benchmark.operation = "agent";
    benchmark.sizes = {agents};
    benchmark.admits = [](const ContestantKind&, std::size_t) { return true; };
    benchmark.contestants = [](std::size_t objects, std::uint64_t /*seed*/) {
        std::vector<ContestantKind> kinds;
        for (CrowdKind& crowd : crowdKinds(objects)) {
            kinds.push_back(std::move(crowd.kind));
        }
        return kinds;
    };
    benchmark.make = [axes, density, radius](std::size_t objects, std::uint64_t seed) {
        const double volume = static_cast<double>(objects) / density;
        const auto side = static_cast<float>(std::pow(volume, 1.0 / axes));
        const Vector3<float> room(side, axes == 3 ? side : 0, side);
        return std::make_unique<CrowdWorkload>(
            std::make_unique<demos::BrownianScene>(agentsIn(room, objects, seed), seed), radius);
    };
    return benchmark;
}

}  // namespace

std::vector<CrowdKind> crowdKinds(std::size_t agents) {
    constexpr std::size_t kMostForDbvt = 100'000;
    std::vector<CrowdKind> kinds;
    kinds.push_back(ownKind("hash", "counts", Question::count, serialFor, false));
    kinds.push_back(ownKind("hash-list", "lists", Question::list, serialFor, false));
    if (const std::optional<ParallelFor> threaded = threadedLoop()) {
        kinds.push_back(
            ownKind("hash-threads", "counts, tbbFor", Question::count, *threaded, true));
        kinds.push_back(
            ownKind("hash-list-threads", "lists, tbbFor", Question::list, *threaded, true));
    }
    if (agents <= kMostForDbvt) {
        CrowdKind dbvt{contestantKind(kBaseline),
                       [] { return std::make_unique<DbvtContestant>(); }};
        kinds.push_back(std::move(dbvt));
    }
    for (CrowdKind& kind : nanoflannKinds()) {
        kinds.push_back(std::move(kind));
    }
    return kinds;
}

std::vector<Benchmark> crowdBenchmarks() {
    std::vector<Benchmark> all;
    all.push_back(crowdBenchmark(
        "crowd", "every agent asks who is within 10 m; all move; 98 others on average", 50'000, 2,
        0.3125, 10));
    all.push_back(crowdBenchmark("circles-2d",
                                 "FLAME GPU's Circles: one agent a square metre, within 2 m",
                                 1'000'000, 2, 1, 2));
    all.push_back(crowdBenchmark("circles-3d",
                                 "FLAME GPU's Circles: one agent a cubic metre, within 2 m",
                                 1'000'000, 3, 1, 2));
    for (std::size_t i = 1; i < all.size(); ++i) {
        all[i].onRequest = true;
    }
    return all;
}

}  // namespace hashphase::benchmarks
