// SPDX-License-Identifier: Zlib
//
// Questions and changes within questions, and broadphases that are refused.

#include <demos/stability/bullet_subject.hpp>

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <array>
#include <stdexcept>

namespace hashphase::demos {
namespace {

using Point = Vector3<btScalar>;
using Bounds = Aabb<btScalar>;
using Scene = PairScene<btScalar>;
using Run = CaseRun<btScalar>;

// --- In the midst of it ---------------------------------------------------------------------------

// Asks again, for everything found, before it goes on.
struct AskWithin final : btBroadphaseAabbCallback {
    AskWithin(Scene& asked, Objects& list, int howDeep)
        : scene(asked), found(list), depth(howDeep) {}

    bool process(const btBroadphaseProxy* proxy) override {
        const std::uint32_t object = BulletSubject::objectOf(*proxy);
        found.push_back(object);
        if (depth > 0) {
            Objects inner;
            AskWithin callback(scene, inner, depth - 1);
            const Bounds& box = scene.boxes()[object];
            broadphaseOf(scene.subject())
                .aabbTest(toBullet(box.min()), toBullet(box.max()), callback);
            hasFoundItself &= std::count(inner.begin(), inner.end(), object) == 1;
        }
        return true;
    }

    Scene& scene;
    Objects& found;
    int depth;
    bool hasFoundItself = true;
};

// Of rays along x, 40 m long.
struct AlongX : btBroadphaseRayCallback {
    AlongX() {
        m_rayDirectionInverse = btVector3(1, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
        m_signs[0] = m_signs[1] = m_signs[2] = 0;
        m_lambda_max = 40;
    }
};

struct RayWithin final : AlongX {
    RayWithin(Scene& asked, int howDeep) : scene(asked), depth(howDeep) {}

    void cast() {
        broadphaseOf(scene.subject()).rayTest({-20, 0, 0}, {20, 0, 0}, *this);
        std::sort(found.begin(), found.end());
    }

    bool process(const btBroadphaseProxy* proxy) override {
        found.push_back(BulletSubject::objectOf(*proxy));
        if (depth > 0) {
            RayWithin inner(scene, depth - 1);
            inner.cast();
            isRepeated &= last.empty() || last == inner.found;
            last = std::move(inner.found);
        }
        return true;
    }

    Scene& scene;
    int depth;
    Objects found;
    Objects last;
    bool isRepeated = true;
};

Objects touching(const Scene& scene, const Bounds& region) {
    return objectsThat(scene.boxes(), [&](const Bounds& box) { return doTouch(box, region); });
}

Boxes<btScalar> someCubes(const Run& run) {
    return scatteredCubes<btScalar>(200, 10, 0.5F, 1.5F, run.seed);
}

void askNested(Scene& scene, Run& run) {
    Objects found;
    AskWithin callback(scene, found, 1);
    const Bounds region = cubeAt<btScalar>({0, 0, 0}, 6);
    broadphaseOf(scene.subject())
        .aabbTest(toBullet(region.min()), toBullet(region.max()), callback);
    std::sort(found.begin(), found.end());
    run.compare(found, touching(scene, region));
    run.expect(callback.hasFoundItself,
               "a box query in a callback finds the proxy whose box it uses, once");

    RayWithin alone(scene, 0);
    alone.cast();
    RayWithin nested(scene, 1);
    nested.cast();
    run.expect(nested.found == alone.found,
               "a ray finds the same proxies if its callback casts rays");
    run.expect(nested.isRepeated && nested.last == alone.found,
               "a ray in a callback finds the same proxies as the ray alone");
}

// Bullet's way to remove pairs while walking over them.
struct RemoveSome final : btOverlapCallback {
    bool processOverlap(btBroadphasePair& pair) override {
        ++seen;
        return BulletSubject::objectOf(*pair.m_pProxy0) % 2 == 0;
    }
    std::size_t seen = 0;
};

// Destroys, moves and creates while it is told who is there: of whom it is told, and of others.
struct Changes {
    explicit Changes(Scene& asked) : scene(asked), isChanged(asked.size(), false) {}

    void hear(const btBroadphaseProxy& proxy) {
        const std::uint32_t object = BulletSubject::objectOf(proxy);
        found.push_back(object);
        isDeadOffered |= hasNan(scene.boxes()[object]);
        if (object % 3 == 0) {
            change(object, object / 3);
            selfCount += 1;
        }
        if (object % 2 == 0) {
            change((object * 7 + 3) % scene.size(), object / 2);
        }
    }

    void change(std::uint32_t object, std::uint32_t how) {
        if (isChanged[object]) {
            return;
        }
        isChanged[object] = true;
        const Bounds box = scene.boxes()[object];
        if (how % 2 == 0) {
            scene.destroy(object);
            if (how % 4 == 0) {
                scene.create(object, box.translated(Point(0.25F, 0, 0)));
            }
        } else {
            scene.move(object, box.translated(Point(0, 20, 0)));
        }
    }

    Scene& scene;
    Objects found;
    std::vector<bool> isChanged;
    int selfCount = 0;  // how often who is told of was to be changed itself
    bool isDeadOffered = false;
};

struct ChangeInBox final : btBroadphaseAabbCallback {
    explicit ChangeInBox(Changes& made) : changes(made) {}
    bool process(const btBroadphaseProxy* proxy) override {
        changes.hear(*proxy);
        return true;
    }
    Changes& changes;
};

struct ChangeOnRay final : AlongX {
    explicit ChangeOnRay(Changes& made) : changes(made) {}
    bool process(const btBroadphaseProxy* proxy) override {
        changes.hear(*proxy);
        return true;
    }
    Changes& changes;
};

// What was not changed is found, once; nobody is found who is no more.
template <class Ask>
void judgeChanges(Run& run, const Bounds& region, const Ask& ask) {
    Scene scene(run, someCubes(run));
    scene.judge();
    Objects before = touching(scene, region);
    Changes changes(scene);
    ask(broadphaseOf(scene.subject()), changes);
    const auto isChanged = [&](std::uint32_t object) { return changes.isChanged[object]; };
    std::erase_if(before, isChanged);
    std::erase_if(changes.found, isChanged);
    std::sort(changes.found.begin(), changes.found.end());
    run.compare(changes.found, before);
    run.expect(!changes.isDeadOffered, "a query reports no proxy that its callback has destroyed");
    run.expect(changes.selfCount >= 8, "callbacks change proxies that are reported to them");
    scene.judge();
}

void changeNested(Run& run) {
    const Bounds region = cubeAt<btScalar>({0, 0, 0}, 6);
    judgeChanges(run, region, [&](btBroadphaseInterface& broadphase, Changes& changes) {
        ChangeInBox callback(changes);
        broadphase.aabbTest(toBullet(region.min()), toBullet(region.max()), callback);
    });
    // A box of 6 m along x.
    const Point half(0, 3, 3);
    const Bounds way(Point(-20, -3, -3), Point(20, 3, 3));
    judgeChanges(run, way, [&](btBroadphaseInterface& broadphase, Changes& changes) {
        ChangeOnRay callback(changes);
        broadphase.rayTest({-20, 0, 0}, {20, 0, 0}, callback, toBullet(-half), toBullet(half));
    });
}

void changesWithin(Run& run) {
    Scene scene(run, someCubes(run));
    scene.judge();
    askNested(scene, run);

    // The same proxies, moved, destroyed, created and moved again within a frame.
    Random random(run.seed);
    for (int frame = 0; frame < 20; ++frame) {
        for (int change = 0; change < 10; ++change) {
            const auto object = indexBelow(random, 10);
            const Bounds box =
                cubeAt<btScalar>({random.between(-5, 5), random.between(-5, 5), 0}, 1.5F);
            scene.move(object, box);
            scene.destroy(object);
            scene.create(object, box);
            scene.move(object, box.translated(Point(random.between(-1, 1), 0, 0)));
        }
        scene.judge();
    }
    askNested(scene, run);
    changeNested(run);

    RemoveSome callback;
    btOverlappingPairCache& cache = *broadphaseOf(scene.subject()).getOverlappingPairCache();
    const auto pairs = static_cast<std::size_t>(cache.getNumOverlappingPairs());
    cache.processAllOverlappingPairs(&callback, nullptr);
    run.expect(callback.seen == pairs, "each pair is visited once while pairs are removed");
}

// --- Cells of no size -----------------------------------------------------------------------------

// What a scene says: its pairs, and who is around the origin, in the order in which it tells.
std::pair<Keys, Objects> answersOf(Scene& scene) {
    scene.findPairs();
    return {scene.reported(), scene.subject().touching(makeBox<btScalar>(-2, -2, -2, 2, 2, 2))};
}

template <class Make>
bool isRefused(const Make& make) {
    try {
        static_cast<void>(make());
    } catch (const std::invalid_argument& refusal) {
        return *refusal.what() != '\0';
    }
    return false;
}

// A grid of either precision, and a broadphase, to which a pair cache is given.
void expectRefused(double cellSize, PairCache& cache, Run& run) {
    SpatialHashConfig config;
    config.grid.cellSize = cellSize;
    run.expect(
        isRefused([&] { return std::make_unique<Grid<float>>(config.grid); }) &&
            isRefused([&] { return std::make_unique<Grid<double>>(config.grid); }) &&
            isRefused([&] { return std::make_unique<SpatialHashBroadphase>(&cache, config); }) &&
            !configError(config.grid).empty(),
        "an invalid cell size is refused with a reason");
}

// The cache serves a broadphase.
void judgeCache(PairCache& cache, const Boxes<btScalar>& boxes, Run& run) {
    BulletSubject subject(std::make_unique<SpatialHashBroadphase>(&cache), boxes.size(), true);
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        subject.create(i, boxes[i]);
    }
    subject.findPairs();
    Keys reported;
    subject.listPairs(reported);
    run.compare(reported, touchingPairs(boxes));
}

void invalidCellSizes(Run& run) {
    if (!run.isOurs) {
        return;
    }
    Scene scene(run, scatteredCubes<btScalar>(60, 8, 0.5F, 1.5F, run.seed));
    scene.judge();
    const auto before = answersOf(scene);
    PairCache cache;
    const std::size_t cacheBytes = cache.memoryBytes();
    using Limits = std::numeric_limits<double>;
    for (const double size : {-1.0, Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(),
                              1e31, 1e-31, Limits::denorm_min()}) {
        expectRefused(size, cache, run);
    }
    run.expect(configError({.cellSize = 0}).empty(), "a cell size of 0 is valid");
    run.expect(answersOf(scene) == before, "an existing broadphase answers as before");
    run.expect(cache.memoryBytes() == cacheBytes && cache.validate().empty(),
               "a refused broadphase leaves the pair cache unchanged");
    judgeCache(cache, scene.boxes(), run);
    for (std::uint32_t i = 0; i < scene.size(); i += 3) {
        scene.move(i, scene.boxes()[i].translated(Point(0.5F, 0, 0)));
    }
    scene.judge();
}

constexpr HardCase kWithinCases[] = {
    {"H32", "queries and changes inside a query",
     "200 cubes. Callbacks of box queries start box queries, and callbacks of rays cast rays. "
     "Callbacks of both also destroy, create and move the reported proxy and other proxies. Ten "
     "times in each of 20 frames, a proxy is moved, destroyed, created and moved again. A callback "
     "removes pairs while processAllOverlappingPairs() visits them",
     "a nested query finds what it finds alone; a query reports each unchanged proxy once, and no "
     "destroyed proxy; exact pairs; each pair is visited once",
     changesWithin},
    {"H31", "invalid cell sizes",
     "a cell size of -1, NaN, infinity, -infinity, 1e31, 1e-31 or the smallest denormal number; "
     "and a cell size of 0",
     "refused with a reason, by the broadphase and by grids of both precisions; 0 is valid, and "
     "hashphase chooses the size; an existing broadphase answers as before; the pair cache passed "
     "to a refused broadphase is unchanged, and works with another broadphase",
     invalidCellSizes},
};

}  // namespace

std::span<const HardCase> bulletCases() {
    static const std::vector<HardCase> kAll =
        inOrder({bodyCases(), worldRollbackCases(), kWithinCases});
    return kAll;
}

std::span<const HardCase> hardCases() {
    static const std::vector<HardCase> kAll = inOrder({gridCases(), bulletCases()});
    return kAll;
}

}  // namespace hashphase::demos
