// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/bullet_contestant.hpp>

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <algorithm>
#include <numeric>

namespace hashphase::benchmarks {
namespace {

// A sweep and prune sorts each new box in along three axes: filling it takes quadratic time.
constexpr std::size_t kAxisSweepFillsUpTo = 3'000;

class BulletContestant : public Contestant, private Population {
public:
    BulletContestant(const demos::BroadphaseKind& kind, const demos::BroadphaseNeeds& needs)
        : filled_(kind, needs) {}

    void fill(const FrameBoxes& frame) override {
        std::vector<std::uint32_t> all(frame.boxes.size());
        std::iota(all.begin(), all.end(), 0U);
        add(all, frame);
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

protected:
    void add(std::span<const std::uint32_t> objects, const FrameBoxes& frame) override {
        for (const std::uint32_t object : objects) {
            filled_.create(object, frame.bulletBoxes[object], frame.filterOf(object));
        }
    }
    void remove(std::span<const std::uint32_t> objects) override {
        for (const std::uint32_t object : objects) {
            filled_.destroy(object);
        }
    }

    demos::FilledBroadphase filled_;
};

class BatchContestant : public BulletContestant {
public:
    using BulletContestant::BulletContestant;

private:
    void add(std::span<const std::uint32_t> objects, const FrameBoxes& frame) override {
        filled_.createInBatch(objects, frame.bulletBoxes, frame.filters);
    }
    void remove(std::span<const std::uint32_t> objects) override {
        filled_.destroyInBatch(objects);
    }
};

}  // namespace

ContestantKind bulletKind(const demos::BroadphaseKind& bullet) {
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
    return kind;
}

std::vector<ContestantKind> bulletKinds() {
    std::vector<ContestantKind> kinds;
    for (const demos::BroadphaseKind& bullet : demos::broadphaseKinds()) {
        kinds.push_back(bulletKind(bullet));
        if (bullet.ours) {
            ContestantKind batches = kinds.back();
            batches.name += "-batches";
            batches.description = "the same, told of many objects in one call";
            batches.inBatches = true;
            batches.make = [&bullet](const demos::BroadphaseNeeds& needs) {
                return std::make_unique<BatchContestant>(bullet, needs);
            };
            kinds.push_back(std::move(batches));
        }
    }
    return kinds;
}

}  // namespace hashphase::benchmarks
