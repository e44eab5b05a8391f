// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/bullet_contestant.hpp>

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <algorithm>

namespace hashphase::benchmarks {
namespace {

// A sweep and prune sorts each new box in along three axes: filling it takes quadratic time.
constexpr std::size_t kAxisSweepFillsUpTo = 3'000;

class BulletContestant : public Contestant, private Population {
public:
    BulletContestant(const demos::BroadphaseKind& kind, const demos::BroadphaseNeeds& needs)
        : filled_(kind, needs) {}

    void fill(const FrameBoxes& frame) override {
        for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
            add(static_cast<std::uint32_t>(i), frame);
        }
    }
    void setAll(const FrameBoxes& frame) override { filled_.setAll(frame.bulletBoxes); }
    void findPairs() override { filled_.findPairs(); }
    void listPairs(std::vector<demos::PairKey>& pairs) override { filled_.listPairs(pairs); }

    Population* population() override { return this; }

    [[nodiscard]] std::optional<OwnBytes> ownBytes() const override {
        const auto* own = dynamic_cast<const SpatialHashBroadphase*>(&filled_.broadphase());
        if (own == nullptr) {
            return std::nullopt;
        }
        const auto& cache = dynamic_cast<const PairCache&>(*own->getOverlappingPairCache());
        return OwnBytes{own->memoryBytes() - cache.memoryBytes(), cache.memoryBytes()};
    }

private:
    void add(std::uint32_t object, const FrameBoxes& frame) override {
        filled_.create(object, frame.bulletBoxes[object], frame.filterOf(object));
    }
    void remove(std::uint32_t object) override { filled_.destroy(object); }

    demos::FilledBroadphase filled_;
};

}  // namespace

std::vector<ContestantKind> bulletKinds() {
    std::vector<ContestantKind> kinds;
    for (const demos::BroadphaseKind& bullet : demos::broadphaseKinds()) {
        ContestantKind kind;
        kind.name = bullet.name;
        kind.title = bullet.title;
        kind.description = bullet.description;
        kind.package = bullet.ours ? "this build" : HASHPHASE_BENCHMARKS_BULLET_PACKAGE;
        kind.ours = bullet.ours;
        kind.changes = true;
        kind.upTo = bullet.defaultUpTo;
        if (kind.name == "axis-sweep") {
            kind.fillsUpTo = kAxisSweepFillsUpTo;
        }
        kind.make = [&bullet](const demos::BroadphaseNeeds& needs) {
            return std::make_unique<BulletContestant>(bullet, needs);
        };
        kind.bullet = &bullet;
        kinds.push_back(std::move(kind));
    }
    return kinds;
}

}  // namespace hashphase::benchmarks
