// SPDX-License-Identifier: Zlib
#include <demos/compare/world_trial.hpp>

#include <demos/compare/filled_broadphase.hpp>
#include <demos/compare/observed_world.hpp>
#include <demos/console/format.hpp>
#include <demos/report/stopwatch.hpp>

#include <utility>

namespace hashphase::demos {
namespace {

constexpr btScalar kStep = btScalar(1) / btScalar(60);  // [s]

// Large enough that contacts come from the pools and never from the heap, whose growth is measured
// around the broadphase: removing a pair frees its contacts.
btDefaultCollisionConstructionInfo roomyPools() {
    btDefaultCollisionConstructionInfo info;
    info.m_defaultMaxPersistentManifoldPoolSize = 16'384;
    info.m_defaultMaxCollisionAlgorithmPoolSize = 16'384;
    return info;
}

Aabb<float> boxOf(const btBroadphaseProxy& proxy) {
    return {Vector3<float>(proxy.m_aabbMin.x(), proxy.m_aabbMin.y(), proxy.m_aabbMin.z()),
            Vector3<float>(proxy.m_aabbMax.x(), proxy.m_aabbMax.y(), proxy.m_aabbMax.z())};
}

/// Ends the filling of a world from within.
struct FillingStopped {};

}  // namespace

struct WorldTrial::World {
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

WorldTrial::WorldTrial(FillWorld fill, ReferenceMethod reference, const TellWaiting& tell)
    : fill_(std::move(fill)), reference_(reference) {
    constexpr BroadphaseKind kTree{
        {},
        {},
        {},
        false,
        0,
        false,
        [](const BroadphaseNeeds&) -> std::unique_ptr<btBroadphaseInterface> {
            return std::make_unique<btDbvtBroadphase>();
        }};
    World measured(kTree, {});
    measured.world->setAdditionObserver([&tell](std::size_t bodies) {
        if (tell && bodies % kObjectsBetweenLooks == 0) {
            tell(withThousands(bodies) + " bodies");
        }
    });
    fill_(*measured.contents);

    const btCollisionObjectArray& objects = measured.world->getCollisionObjectArray();
    needs_.objects = static_cast<std::size_t>(objects.size());
    for (int i = 0; i < objects.size(); ++i) {
        const Aabb<float> box = boxOf(*objects[i]->getBroadphaseHandle());
        // Planes have no end; their boxes would leave an axis sweep no resolution.
        constexpr float kWithoutEnd = 1e15F;
        if (box.min().minCoeff() > -kWithoutEnd && box.max().maxCoeff() < kWithoutEnd) {
            needs_.bounds.extend(box);
        }
    }
    // Room for what falls and flies.
    constexpr float kRoom = 100;  // [m]
    if (needs_.bounds.isEmpty()) {
        needs_.bounds.extend(Vector3<float>::Zero());
    }
    needs_.bounds.extend(Vector3<float>(needs_.bounds.min().array() - kRoom));
    needs_.bounds.extend(Vector3<float>(needs_.bounds.max().array() + kRoom));
}

WorldTrial::~WorldTrial() = default;

std::optional<double> WorldTrial::add(const BroadphaseKind& kind, const GoOn& goOn) {
    auto filled = std::make_unique<World>(kind, needs_);
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
    world.world->setPairObserver([this, &world] { observe(world); });
    return world.makingMs + world.world->additionMs();
}

Observation WorldTrial::runFrame(std::size_t contestant) {
    const ObservedWorld::StepTimes times = worlds_[contestant]->world->stepOnce(kStep);
    Observation seen;
    seen.setAabbMs = times.updateAabbsMs;
    seen.calculateMs = times.calculateMs;
    seen.stepMs = times.wholeMs;
    seen.reported = reported_;
    seen.exact = exact_;
    seen.boxes = boxes_;
    seen.cellSize = cellSizeOf(*worlds_[contestant]->broadphase);
    return seen;
}

std::optional<std::int64_t> WorldTrial::memoryBytes(std::size_t contestant) const {
    return std::as_const(*worlds_[contestant]->world).heap().bytes();
}

void WorldTrial::observe(World& world) {
    const btCollisionObjectArray& objects = world.world->getCollisionObjectArray();
    boxes_.clear();
    filters_.clear();
    for (int i = 0; i < objects.size(); ++i) {
        const btBroadphaseProxy& proxy = *objects[i]->getBroadphaseHandle();
        boxes_.push_back(boxOf(proxy));
        filters_.push_back({proxy.m_collisionFilterGroup, proxy.m_collisionFilterMask});
    }
    findExactPairs(reference_, boxes_, filters_, exact_);
    listPairs(
        *world.broadphase->getOverlappingPairCache(),
        [](const btBroadphaseProxy& proxy) {
            const auto* object = static_cast<const btCollisionObject*>(proxy.m_clientObject);
            return static_cast<std::uint32_t>(object->getWorldArrayIndex());
        },
        reported_);
}

}  // namespace hashphase::demos
