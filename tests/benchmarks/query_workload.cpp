// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/query_workload.hpp>

#include <demos/report/frame_clock.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <algorithm>

namespace hashphase::benchmarks {
namespace {

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

}  // namespace

void QueryWorkload::add(const ContestantKind& kind) {
    Entry entry{std::make_unique<demos::FilledBroadphase>(*kind.bullet, scene_.needs()), {}};
    const FrameBoxes frame = scene_.frame();
    for (std::size_t i = 0; i < scene_.size(); ++i) {
        entry.filled->create(static_cast<std::uint32_t>(i), frame.bulletBoxes[i],
                             frame.filterOf(i));
    }
    entry.filled->findPairs();
    entries_.push_back(std::move(entry));
}

double QueryWorkload::runFrame(std::size_t contestant) {
    Entry& entry = entries_[contestant];
    entry.answers.clear();
    const demos::FrameClock watch;
    ask(*entry.filled, entry.answers);
    return watch.milliseconds();
}

void QueryWorkload::listAnswers(std::size_t contestant, std::vector<Answer>& answers) {
    answers = entries_[contestant].answers;
}

void QueryWorkload::advanceScene() {
    scene_.advance();
    for (Entry& entry : entries_) {
        entry.filled->setAll(scene_.frame().bulletBoxes);
        entry.filled->findPairs();
    }
}

void NeighbourWorkload::ask(demos::FilledBroadphase& filled, std::vector<Answer>& answers) {
    regions_.clear();
    for (const Aabb<float>& box : scene().boxes()) {
        regions_.emplace_back(box.center(), radius_);
    }
    if (const auto* own = dynamic_cast<SpatialHashBroadphase*>(&filled.broadphase())) {
        askForAll(*own, answers);
        return;
    }
    const btVector3 reach(radius_, radius_, radius_);
    for (std::size_t agent = 0; agent < regions_.size(); ++agent) {
        const btVector3 centre = toBullet(scene().boxes()[agent].center());
        NeighbourCallback callback(regions_[agent], agent, answers);
        filled.broadphase().aabbTest(centre - reach, centre + reach, callback);
    }
}

// Whoever is near an agent's centre is near its box.
void NeighbourWorkload::askForAll(const SpatialHashBroadphase& broadphase,
                                  std::vector<Answer>& answers) {
    const std::vector<Aabb<float>>& boxes = scene().boxes();
    const auto askOne = [&](std::uint32_t agent, std::uint32_t other) {
        if (regions_[agent].key(boxes[other]) >= 0) {
            answers.push_back(answerOf(agent, other));
        }
    };
    const auto objectOf = [&broadphase](ProxyId id) {
        return demos::FilledBroadphase::objectOf(*broadphase.proxyOf(id));
    };
    for (const auto& [first, second] : neighbours_.find(broadphase.grid(), radius_)) {
        const std::uint32_t a = objectOf(first);
        const std::uint32_t b = objectOf(second);
        askOne(a, b);
        askOne(b, a);
    }
    for (std::uint32_t agent = 0; agent < boxes.size(); ++agent) {
        askOne(agent, agent);
    }
}

void NeighbourWorkload::listExactAnswers(std::vector<Answer>& answers) {
    // Whoever is near enough is so as well by boxes that are grown by the radius, and a little more
    // for rounding.
    std::vector<Aabb<float>> grown = scene().boxes();
    for (Aabb<float>& box : grown) {
        box.min().array() -= 0.6F * radius_;
        box.max().array() += 0.6F * radius_;
    }
    std::vector<demos::PairKey> candidates;
    demos::findExactPairs(demos::ReferenceMethod::kSweep, grown, {}, candidates);
    answers.clear();
    const auto askOne = [this, &answers](std::uint32_t agent, std::uint32_t other) {
        const SphereRegion<float> region(scene().boxes()[agent].center(), radius_);
        if (region.key(scene().boxes()[other]) >= 0) {
            answers.push_back(answerOf(agent, other));
        }
    };
    for (std::uint32_t agent = 0; agent < scene().size(); ++agent) {
        askOne(agent, agent);
    }
    for (const demos::PairKey pair : candidates) {
        askOne(demos::firstOf(pair), demos::secondOf(pair));
        askOne(demos::secondOf(pair), demos::firstOf(pair));
    }
    std::sort(answers.begin(), answers.end());
}

}  // namespace hashphase::benchmarks
