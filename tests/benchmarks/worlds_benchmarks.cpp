// SPDX-License-Identifier: Zlib

// Hundreds of small worlds at the same place, as for training: what are they to each other? The same boxes in a
// WorldsBroadphase, in a broadphase for each world, and in one for all with a filter that tells worlds apart.

#include <integration/bullet/worlds_broadphase.hpp>
#include <tests/benchmarks/pair_workload.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

namespace hashphase::benchmarks {
namespace {

constexpr std::uint32_t kBodiesPerWorld = 30;

std::size_t worldCountFor(std::size_t objects) {
    return (objects + kBodiesPerWorld - 1) / kBodiesPerWorld;
}

/// An object whose user index is its number.
std::uint32_t objectOf(const btBroadphaseProxy& proxy) {
    const auto& client = *static_cast<const btCollisionObject*>(proxy.m_clientObject);
    return static_cast<std::uint32_t>(client.getUserIndex());
}

struct SameWorld final : btOverlapFilterCallback {
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
        return objectOf(*a) / kBodiesPerWorld == objectOf(*b) / kBodiesPerWorld;
    }
};

std::unique_ptr<btBroadphaseInterface> makeWorlds(std::size_t objects) {
    return std::make_unique<WorldsBroadphase>(
        WorldsConfig{.worldCount = static_cast<int>(worldCountFor(objects)),
                     .worldOf = [](const btCollisionObject& object) {
                         return object.getUserIndex() / static_cast<int>(kBodiesPerWorld);
                     }});
}

/// One broadphase of Bullet's kind for all worlds, or one for each.
class ManyWorlds final : public Contestant {
public:
    using Broadphase = std::unique_ptr<btBroadphaseInterface>;

    explicit ManyWorlds(std::vector<Broadphase> broadphases) : all_(std::move(broadphases)) {}
    ManyWorlds(Broadphase one, bool filters) {
        all_.push_back(std::move(one));
        if (filters) {
            all_[0]->getOverlappingPairCache()->setOverlapFilterCallback(&sameWorld_);
        }
    }
    ~ManyWorlds() override {
        for (std::uint32_t object = 0; object < proxies_.size(); ++object) {
            of(object).destroyProxy(proxies_[object], nullptr);  // dbvt leaks what is left to it
        }
    }

    void fill(const FrameBoxes& frame) override {
        for (const demos::BulletBox& box : frame.bulletBoxes) {
            const auto object = static_cast<std::uint32_t>(proxies_.size());
            clients_.emplace_back().setUserIndex(static_cast<int>(object));
            proxies_.push_back(of(object).createProxy(
                box.min, box.max, BOX_SHAPE_PROXYTYPE, &clients_.back(),
                btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter, nullptr));
        }
    }
    void setAll(const FrameBoxes& frame) override {
        for (std::uint32_t object = 0; object < proxies_.size(); ++object) {
            const demos::BulletBox& box = frame.bulletBoxes[object];
            of(object).setAabb(proxies_[object], box.min, box.max, nullptr);
        }
    }
    void findPairs() override {
        for (const Broadphase& broadphase : all_) {
            broadphase->calculateOverlappingPairs(nullptr);
        }
    }
    void listPairs(std::vector<demos::PairKey>& pairs) override {
        pairs.clear();
        for (const Broadphase& broadphase : all_) {
            const btBroadphasePairArray& array =
                broadphase->getOverlappingPairCache()->getOverlappingPairArray();
            for (int i = 0; i < array.size(); ++i) {
                pairs.push_back(
                    demos::pairKey(objectOf(*array[i].m_pProxy0), objectOf(*array[i].m_pProxy1)));
            }
        }
    }

private:
    [[nodiscard]] btBroadphaseInterface& of(std::uint32_t object) const {
        return *all_[all_.size() == 1 ? 0 : object / kBodiesPerWorld];
    }

    SameWorld sameWorld_;
    std::deque<btCollisionObject> clients_;
    std::vector<Broadphase> all_;
    std::vector<btBroadphaseProxy*> proxies_;  // by object
};

std::unique_ptr<Contestant> makeAlone(std::size_t objects) {
    std::vector<ManyWorlds::Broadphase> broadphases(worldCountFor(objects));
    std::generate(broadphases.begin(), broadphases.end(),
                  [] { return std::make_unique<SpatialHashBroadphase>(); });
    return std::make_unique<ManyWorlds>(std::move(broadphases));
}

std::vector<ContestantKind> worldsKinds() {
    using demos::BroadphaseNeeds;
    ContestantKind dbvt = contestantKind(kBaseline);
    dbvt.title = "btDbvtBroadphase, with a filter";
    dbvt.bullet = nullptr;
    dbvt.make = [](const BroadphaseNeeds&) {
        return std::make_unique<ManyWorlds>(std::make_unique<btDbvtBroadphase>(), true);
    };
    return {{.name = "hash",
             .title = "WorldsBroadphase",
             .ours = true,
             .make =
                 [](const BroadphaseNeeds& needs) {
                     return std::make_unique<ManyWorlds>(makeWorlds(needs.objects), false);
                 }},
            {.name = "hash-alone",
             .title = "a SpatialHashBroadphase for each world",
             .ours = true,
             .make = [](const BroadphaseNeeds& needs) { return makeAlone(needs.objects); }},
            {.name = "hash-filtered",
             .title = "SpatialHashBroadphase, with a filter",
             .ours = true,
             .make =
                 [](const BroadphaseNeeds&) {
                     return std::make_unique<ManyWorlds>(std::make_unique<SpatialHashBroadphase>(),
                                                         true);
                 }},
            std::move(dbvt)};
}

/// Of which each 30 are a world.
class WorldsWorkload final : public PairWorkload {
public:
    using PairWorkload::PairWorkload;

    void listExactAnswers(std::vector<Answer>& answers) override {
        const std::vector<Aabb<float>>& boxes = scene().boxes();
        answers.clear();
        for (std::uint32_t a = 0; a < boxes.size(); ++a) {
            for (std::uint32_t b = a + 1; b < boxes.size() && b % kBodiesPerWorld != 0; ++b) {
                if (overlaps(boxes[a], boxes[b])) {
                    answers.push_back(demos::pairKey(a, b));
                }
            }
        }
        std::sort(answers.begin(), answers.end());
    }
};

}  // namespace

std::vector<Benchmark> worldsBenchmarks() {
    const Vector3<float> room = Vector3<float>::Constant(5);
    return {{.name = "worlds",
             .group = "worlds",
             .description = "300 worlds of 30 cubes of 1 m that move, in the same 5 m",
             .sizes = {300 * kBodiesPerWorld},
             .contestants = [](std::size_t, std::uint64_t) { return worldsKinds(); },
             .make =
                 [room](std::size_t objects, std::uint64_t seed) {
                     return std::make_unique<WorldsWorkload>(
                         cubesIn(room, 0.5F, 0.05F)(objects, seed), PairFrame::setAll, seed);
                 }}};
}

}  // namespace hashphase::benchmarks
