// SPDX-License-Identifier: Zlib
#include <demos/compare/filled_broadphase.hpp>
#include <demos/compare/observed_world.hpp>
#include <demos/compare/trial.hpp>
#include <demos/console/format.hpp>
#include <demos/report/stopwatch.hpp>
#include <integration/bullet/conversions.hpp>

#include <utility>

namespace hashphase::demos {
namespace {

constexpr btScalar kStep = btScalar(1) / btScalar(60);  // [s]

Aabb<float> boxOf(const btBroadphaseProxy& proxy) {
    return toAabb(proxy.m_aabbMin, proxy.m_aabbMax);
}

struct World {
    World(const BroadphaseKind& kind, const BroadphaseNeeds& needs)
        : freesProxies(kind.freesProxies), configuration(roomyPools()), dispatcher(&configuration) {
        HeapMeter construction;
        {
            const HeapScope scope(construction);
            const Stopwatch watch;
            broadphase = kind.make(needs);
            makingMs = watch.milliseconds();
        }
        world =
            std::make_unique<ObservedWorld>(&dispatcher, broadphase.get(), &solver, &configuration);
        world->heap() = construction;
        world->reserve(needs.objects);
        contents = std::make_unique<WorldContents>(*world);
    }
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    // What frees its proxies all at once is spared to remove them one by one, each of which takes
    // Bullet's axis sweep a walk past all the others.
    ~World() {
        if (!freesProxies) {
            return;
        }
        btOverlappingPairCache& cache = *broadphase->getOverlappingPairCache();
        for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
            cache.cleanOverlappingPair(cache.getOverlappingPairArray()[i], &dispatcher);
        }
        btCollisionObjectArray& objects = world->getCollisionObjectArray();
        for (int i = 0; i < objects.size(); ++i) {
            objects[i]->setBroadphaseHandle(nullptr);
        }
    }

    bool freesProxies;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher;
    btSequentialImpulseConstraintSolver solver;
    std::unique_ptr<btBroadphaseInterface> broadphase;
    std::unique_ptr<ObservedWorld> world;
    std::unique_ptr<WorldContents> contents;
    double makingMs = 0;  // of the broadphase
};

/// How many objects there are, and where, with room for what falls and flies.
TrialFacts factsOf(const FillWorld& fill, const TellWaiting& tell) {
    World measured(broadphaseKind("dbvt"), {});
    measured.world->setAdditionObserver([&tell](std::size_t bodies) {
        if (tell && bodies % kObjectsBetweenLooks == 0) {
            tell(withThousands(bodies) + " bodies");
        }
    });
    fill(*measured.contents);
    const btCollisionObjectArray& objects = measured.world->getCollisionObjectArray();
    TrialFacts facts{static_cast<std::size_t>(objects.size()), {}, false};
    for (int i = 0; i < objects.size(); ++i) {
        const Aabb<float> box = boxOf(*objects[i]->getBroadphaseHandle());
        // Planes have no end; their boxes would leave an axis sweep no resolution.
        constexpr float kWithoutEnd = 1e15F;
        if (box.min().minCoeff() > -kWithoutEnd && box.max().maxCoeff() < kWithoutEnd) {
            facts.bounds.extend(box);
        }
    }
    constexpr float kRoom = 100;  // [m]
    if (facts.bounds.isEmpty()) {
        facts.bounds.extend(Vector3<float>::Zero());
    }
    facts.bounds.extend(Vector3<float>(facts.bounds.min().array() - kRoom));
    facts.bounds.extend(Vector3<float>(facts.bounds.max().array() + kRoom));
    return facts;
}

/// Ends the filling of a world from within.
struct FillingStopped {};

class WorldTrial final : public Trial {
public:
    /// Without a reference it is profiled, and not verified.
    WorldTrial(const TrialFacts& itsFacts, FillWorld fill, std::optional<ReferenceMethod> reference)
        : Trial(itsFacts), fill_(std::move(fill)), reference_(reference) {}

    std::optional<double> add(const BroadphaseKind& kind, const GoOn& goOn) override {
        auto filled = std::make_unique<World>(kind, BroadphaseNeeds{facts.bounds, facts.objects});
        filled->world->setAdditionObserver([&goOn](std::size_t bodies) {
            if (bodies % kObjectsBetweenLooks == 0 && !goOn(bodies)) {
                throw FillingStopped();
            }
        });
        try {
            fill_(*filled->contents);
        } catch (const FillingStopped&) {
            return std::nullopt;
        }
        filled->world->setAdditionObserver({});
        worlds_.push_back(std::move(filled));
        World& world = *worlds_.back();
        if (reference_) {
            world.world->setPairObserver([this, &world] { observe(world); });
        }
        return world.makingMs + world.world->additionMs();
    }

    void beginFrame() override {}

    Observation runFrame(std::size_t contestant) override {
        ObservedWorld& world = *worlds_[contestant]->world;
        Observation seen;
        ObservedWorld::StepTimes times;
        const auto takeStep = [&] { times = world.stepOnce(kStep); };
        if (reference_) {
            takeStep();
        } else {
            zones_ = profileZonesOf(takeStep);
            seen.zones = zones_;
            seen.shapeBoxesMs = world.timeShapeBoxes();
        }
        seen.setAabbMs = times.updateAabbsMs;
        seen.calculateMs = times.calculateMs;
        seen.stepMs = times.wholeMs;
        seen.reported = reported_;
        seen.exact = exact_;
        seen.boxes = boxes_;
        seen.cellSize = cellSizeOf(*worlds_[contestant]->broadphase);
        return seen;
    }

    std::optional<double> removeObjects(std::size_t /*contestant*/, std::size_t /*count*/,
                                        const GoOn& /*goOn*/) override {
        return std::nullopt;
    }

    [[nodiscard]] std::optional<std::int64_t> memoryBytes(std::size_t contestant) const override {
        return std::as_const(*worlds_[contestant]->world).heap().bytes();
    }

    [[nodiscard]] std::unique_ptr<Trial> profiled() const override {
        return std::make_unique<WorldTrial>(facts, fill_, std::nullopt);
    }

private:
    void observe(World& world) {
        const btCollisionObjectArray& objects = world.world->getCollisionObjectArray();
        boxes_.clear();
        filters_.clear();
        for (int i = 0; i < objects.size(); ++i) {
            const btBroadphaseProxy& proxy = *objects[i]->getBroadphaseHandle();
            boxes_.push_back(boxOf(proxy));
            filters_.push_back({proxy.m_collisionFilterGroup, proxy.m_collisionFilterMask});
        }
        findExactPairs(*reference_, boxes_, filters_, exact_);
        listPairs(
            *world.broadphase->getOverlappingPairCache(),
            [](const btBroadphaseProxy& proxy) {
                const auto* object = static_cast<const btCollisionObject*>(proxy.m_clientObject);
                return static_cast<std::uint32_t>(object->getWorldArrayIndex());
            },
            reported_);
    }

    FillWorld fill_;
    std::optional<ReferenceMethod> reference_;
    std::vector<std::unique_ptr<World>> worlds_;
    std::vector<ProfileZone> zones_;
    std::vector<Aabb<float>> boxes_;
    std::vector<CollisionFilter> filters_;
    std::vector<PairKey> exact_;
    std::vector<PairKey> reported_;
};

}  // namespace

std::unique_ptr<Trial> worldTrial(FillWorld fill, ReferenceMethod reference,
                                  const TellWaiting& tell) {
    const TrialFacts facts = factsOf(fill, tell);
    return std::make_unique<WorldTrial>(facts, std::move(fill), reference);
}

}  // namespace hashphase::demos
