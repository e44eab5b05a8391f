// SPDX-License-Identifier: Zlib

// Agents of a broadphase who look for neighbours. Crowds of agents alone: crowd_benchmarks.cpp.

#include <broadphase/neighbours.hpp>
#include <demos/scenes/random.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <tests/benchmarks/query_workload.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase::benchmarks {
namespace {

constexpr float kRadius = 10;  // [m]

// Takes what a box query finds, if it is near enough: Bullet has no query for a sphere.
struct NeighbourCallback : btBroadphaseAabbCallback {
    NeighbourCallback(const SphereRegion<float>& region, std::size_t agent,
                      std::vector<Answer>& answers)
        : region_(region), agent_(agent), answers_(answers) {}

    bool process(const btBroadphaseProxy* proxy) override {
        if (region_.key(toAabb(proxy->m_aabbMin, proxy->m_aabbMax)) >= 0) {
            answers_.push_back(answerOf(agent_, demos::FilledBroadphase::objectOf(*proxy)));
        }
        return true;
    }

private:
    const SphereRegion<float>& region_;
    std::size_t agent_;
    std::vector<Answer>& answers_;
};

/// Every agent asks who is within kRadius of its centre; all agents move before each frame.
class NeighbourWorkload final : public QueryWorkload {
public:
    explicit NeighbourWorkload(std::unique_ptr<demos::BoxScene> scene)
        : QueryWorkload(std::move(scene), true) {}

    void listExactAnswers(std::vector<Answer>& answers) override {
        // Whoever is near enough is so as well by boxes that are grown by the radius, and a little more
        // for rounding.
        std::vector<Aabb<float>> grown = scene().boxes();
        for (Aabb<float>& box : grown) {
            box.min().array() -= 0.6F * kRadius;
            box.max().array() += 0.6F * kRadius;
        }
        std::vector<demos::PairKey> candidates;
        demos::findExactPairs(demos::ReferenceMethod::kSweep, grown, {}, candidates);
        takeRegions();
        answers.clear();
        for (const demos::PairKey pair : candidates) {
            askBoth(demos::firstOf(pair), demos::secondOf(pair), answers);
        }
        askThemselves(answers);
        std::sort(answers.begin(), answers.end());
    }

private:
    void ask(demos::FilledBroadphase& filled, std::vector<Answer>& answers) override {
        takeRegions();
        if (const auto* own = dynamic_cast<SpatialHashBroadphase*>(&filled.broadphase())) {
            const auto objectOf = [own](ProxyId id) {
                return demos::FilledBroadphase::objectOf(*own->proxyOf(id));
            };
            // Whoever is near an agent's centre is near its box.
            for (const auto& [first, second] : neighbours_.find(own->grid(), kRadius)) {
                askBoth(objectOf(first), objectOf(second), answers);
            }
            askThemselves(answers);
            return;
        }
        const btVector3 reach(kRadius, kRadius, kRadius);
        for (std::size_t agent = 0; agent < regions_.size(); ++agent) {
            const btVector3 centre = toBullet(scene().boxes()[agent].center());
            NeighbourCallback callback(regions_[agent], agent, answers);
            filled.broadphase().aabbTest(centre - reach, centre + reach, callback);
        }
    }

    void takeRegions() {
        regions_.clear();
        for (const Aabb<float>& box : scene().boxes()) {
            regions_.emplace_back(box.center(), kRadius);
        }
    }
    void askOne(std::uint32_t agent, std::uint32_t other, std::vector<Answer>& answers) const {
        if (regions_[agent].key(scene().boxes()[other]) >= 0) {
            answers.push_back(answerOf(agent, other));
        }
    }
    void askBoth(std::uint32_t a, std::uint32_t b, std::vector<Answer>& answers) const {
        askOne(a, b, answers);
        askOne(b, a, answers);
    }
    void askThemselves(std::vector<Answer>& answers) const {
        for (std::uint32_t agent = 0; agent < regions_.size(); ++agent) {
            askOne(agent, agent, answers);
        }
    }

    std::vector<SphereRegion<float>> regions_;  // of the agents
    Neighbours<float> neighbours_;
};

}  // namespace

std::vector<Benchmark> neighbourBenchmarks() {
    return {
        {.name = "neighbours",
         .group = "queries",
         .description = "for each agent, all boxes within 10 m: four on average; all agents move",
         .operation = "agent",
         .sizes = {50'000},
         .admits = answersQueries,
         .make = [](std::size_t objects, std::uint64_t seed) {
             constexpr double kNear = 4;  // on average, within the radius
             const double circle = 3.14159265358979 * kRadius * kRadius;
             const auto side =
                 static_cast<float>(std::sqrt(static_cast<double>(objects) * circle / kNear));
             return std::make_unique<NeighbourWorkload>(
                 cubesIn({side, 0, side}, 0.5F, 0.2F)(objects, seed));
         }}};
}

}  // namespace hashphase::benchmarks
