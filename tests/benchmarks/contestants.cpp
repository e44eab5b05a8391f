// SPDX-License-Identifier: Zlib

// The broadphases of `hashphase compare` as contestants: ours in Bullet, pair cache included, and
// Bullet's own. And all contestants together.

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <tests/benchmarks/grid_contestant.hpp>
#include <tests/benchmarks/peers/peers.hpp>
#include <tests/benchmarks/workload.hpp>

#include <algorithm>
#include <numeric>

namespace hashphase::benchmarks {
namespace {

// A sweep and prune sorts each new box in along three axes: filling it takes quadratic time.
constexpr std::size_t kAxisSweepFillsUpTo = 3'000;

class BulletContestant final : public Contestant {
public:
    BulletContestant(const demos::BroadphaseKind& kind, const demos::BroadphaseNeeds& needs,
                     bool inBatches = false)
        : filled_(kind, needs), inBatches_(inBatches) {}

    void fill(const FrameBoxes& frame) override {
        std::vector<std::uint32_t> all(frame.boxes.size());
        std::iota(all.begin(), all.end(), 0U);
        add(all, frame);
    }
    void setAll(const FrameBoxes& frame) override {
        if (inBatches_) {
            filled_.setAllInBatch(frame.bulletMins, frame.bulletMaxs);
        } else {
            filled_.setAll(frame.bulletBoxes);
        }
    }
    void findPairs() override { filled_.findPairs(); }
    void listPairs(std::vector<demos::PairKey>& pairs) override { filled_.listPairs(pairs); }

    void add(std::span<const std::uint32_t> objects, const FrameBoxes& frame) override {
        if (inBatches_) {
            filled_.createInBatch(objects, frame.bulletBoxes, frame.filters);
            return;
        }
        for (const std::uint32_t object : objects) {
            filled_.create(object, frame.bulletBoxes[object], frame.filterOf(object));
        }
    }
    void remove(std::span<const std::uint32_t> objects) override {
        if (inBatches_) {
            filled_.destroyInBatch(objects);
            return;
        }
        for (const std::uint32_t object : objects) {
            filled_.destroy(object);
        }
    }

    void set(std::span<const std::uint32_t> objects, const FrameBoxes& frame) override {
        for (const std::uint32_t object : objects) {
            filled_.set(object, frame.bulletBoxes[object]);
        }
    }

    [[nodiscard]] std::optional<OwnBytes> ownBytes() const override {
        const auto* own = dynamic_cast<const SpatialHashBroadphase*>(&filled_.broadphase());
        if (own == nullptr) {
            return std::nullopt;
        }
        const auto& cache = dynamic_cast<const PairCache&>(*own->getOverlappingPairCache());
        return OwnBytes{own->memoryBytes() - cache.memoryBytes(), cache.memoryBytes()};
    }

private:
    demos::FilledBroadphase filled_;
    bool inBatches_;
};

std::vector<ContestantKind> allKinds() {
    std::vector<ContestantKind> kinds;
    for (const demos::BroadphaseKind& bullet : demos::broadphaseKinds()) {
        kinds.push_back(bulletKind(bullet));
        if (bullet.ours) {
            ContestantKind batches = bulletKind(bullet, true);
            batches.name += "-batches";
            batches.description = "the same, with many objects per call";
            kinds.push_back(std::move(batches));
        }
    }
    kinds.insert(kinds.begin() + 2, gridKind("grid"));
    for (const auto& peersOf :
         {threadedKinds, cgalKinds, fclKinds, odeKinds, joltKinds, physxKinds}) {
        for (ContestantKind& kind : peersOf()) {
            kinds.push_back(std::move(kind));
        }
    }
    return kinds;
}

}  // namespace

ContestantKind bulletKind(const demos::BroadphaseKind& bullet, bool inBatches) {
    return {.name = std::string(bullet.name),
            .title = std::string(bullet.title),
            .description = std::string(bullet.description),
            .package = bullet.ours ? "this build" : HASHPHASE_BENCHMARKS_BULLET_PACKAGE,
            .ours = bullet.ours,
            .changes = true,
            .inBatches = inBatches,
            .upTo = bullet.defaultUpTo,
            .fillsUpTo = bullet.name == "axis-sweep" ? kAxisSweepFillsUpTo : kAnyNumber,
            .make =
                [&bullet, inBatches](const demos::BroadphaseNeeds& needs) {
                    return std::make_unique<BulletContestant>(bullet, needs, inBatches);
                },
            .bullet = &bullet};
}

const std::vector<ContestantKind>& contestantKinds() {
    static const std::vector<ContestantKind> kinds = allKinds();
    return kinds;
}

const ContestantKind& contestantKind(std::string_view name) {
    const std::vector<ContestantKind>& kinds = contestantKinds();
    return *std::find_if(kinds.begin(), kinds.end(),
                         [name](const ContestantKind& kind) { return kind.name == name; });
}

std::unique_ptr<demos::FilledBroadphase> filledWith(const SceneBoxes& scene,
                                                    const demos::BroadphaseKind& kind) {
    auto filled = std::make_unique<demos::FilledBroadphase>(kind, scene.needs());
    const FrameBoxes frame = scene.frame();
    for (std::size_t i = 0; i < scene.size(); ++i) {
        filled->create(static_cast<std::uint32_t>(i), frame.bulletBoxes[i], frame.filterOf(i));
    }
    filled->findPairs();
    return filled;
}

}  // namespace hashphase::benchmarks
