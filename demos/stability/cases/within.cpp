// SPDX-License-Identifier: Zlib
//
// Questions: within questions, with changes in their midst, and about nothing.

#include <demos/stability/cases/cases.hpp>

#include <demos/scenes/random.hpp>
#include <demos/stability/pair_scene.hpp>
#include <integration/bullet/conversions.hpp>

#include <algorithm>
#include <array>

namespace hashphase::demos {
namespace {

using Point = Vector3<float>;

// --- In the midst of it ---------------------------------------------------------------------------

// Asks again, for everything found, before it goes on.
struct AskWithin final : btBroadphaseAabbCallback {
    AskWithin(PairScene& asked, Objects& list, int howDeep)
        : scene(asked), found(list), depth(howDeep) {}

    bool process(const btBroadphaseProxy* proxy) override {
        const std::uint32_t object = FilledBroadphase::objectOf(*proxy);
        found.push_back(object);
        if (depth > 0) {
            Objects inner;
            AskWithin callback(scene, inner, depth - 1);
            const Aabb<float>& box = scene.boxes()[object];
            scene.broadphase().aabbTest(toBullet(box.min()), toBullet(box.max()), callback);
            hasFoundItself &= std::count(inner.begin(), inner.end(), object) == 1;
        }
        return true;
    }

    PairScene& scene;
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
    RayWithin(PairScene& asked, int howDeep) : scene(asked), depth(howDeep) {}

    void cast() {
        scene.broadphase().rayTest({-20, 0, 0}, {20, 0, 0}, *this);
        std::sort(found.begin(), found.end());
    }

    bool process(const btBroadphaseProxy* proxy) override {
        found.push_back(FilledBroadphase::objectOf(*proxy));
        if (depth > 0) {
            RayWithin inner(scene, depth - 1);
            inner.cast();
            isRepeated &= last.empty() || last == inner.found;
            last = std::move(inner.found);
        }
        return true;
    }

    PairScene& scene;
    int depth;
    Objects found;
    Objects last;
    bool isRepeated = true;
};

Objects touching(const PairScene& scene, const Aabb<float>& region) {
    Objects objects;
    for (std::uint32_t i = 0; i < scene.size(); ++i) {
        if (overlaps(scene.boxes()[i], region)) {
            objects.push_back(i);
        }
    }
    return objects;
}

Boxes someCubes(const CaseContext& context) {
    return scatteredCubes(200, 10, 0.5F, 1.5F, context.seed);
}

void askNested(PairScene& scene, CaseTally& tally) {
    Objects found;
    AskWithin callback(scene, found, 1);
    const Aabb<float> region = cubeAt({0, 0, 0}, 6);
    scene.broadphase().aabbTest(toBullet(region.min()), toBullet(region.max()), callback);
    std::sort(found.begin(), found.end());
    tally.compare(found, touching(scene, region));
    tally.expect(callback.hasFoundItself, "a box query within a query finds the box it asks with");

    RayWithin alone(scene, 0);
    alone.cast();
    RayWithin nested(scene, 1);
    nested.cast();
    tally.expect(nested.found == alone.found, "a ray finds the same with rays within");
    tally.expect(nested.isRepeated && nested.last == alone.found,
                 "a ray within a ray finds the same as the ray alone");
}

// Bullet's way to remove pairs while walking over them.
struct RemoveSome final : btOverlapCallback {
    bool processOverlap(btBroadphasePair& pair) override {
        ++seen;
        return FilledBroadphase::objectOf(*pair.m_pProxy0) % 2 == 0;
    }
    std::size_t seen = 0;
};

// Destroys, moves and creates while it is told who is there: of whom it is told, and of others.
struct Changes {
    explicit Changes(PairScene& asked) : scene(asked), isChanged(asked.size(), false) {}

    void hear(const btBroadphaseProxy& proxy) {
        const std::uint32_t object = FilledBroadphase::objectOf(proxy);
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
        const Aabb<float> box = scene.boxes()[object];
        if (how % 2 == 0) {
            scene.destroy(object);
            if (how % 4 == 0) {
                scene.create(object, box.translated(Point(0.25F, 0, 0)));
            }
        } else {
            scene.move(object, box.translated(Point(0, 20, 0)));
        }
    }

    PairScene& scene;
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
void judgeChanges(const CaseContext& context, CaseTally& tally, const Aabb<float>& region,
                  const Ask& ask) {
    PairScene scene(context, someCubes(context));
    scene.judge(tally);
    Objects before = touching(scene, region);
    Changes changes(scene);
    ask(scene.broadphase(), changes);
    const auto isChanged = [&](std::uint32_t object) { return changes.isChanged[object]; };
    std::erase_if(before, isChanged);
    std::erase_if(changes.found, isChanged);
    std::sort(changes.found.begin(), changes.found.end());
    tally.compare(changes.found, before);
    tally.expect(!changes.isDeadOffered, "a query finds nobody whom its callback has destroyed");
    tally.expect(changes.selfCount >= 8, "callbacks change the proxies that they are given");
    scene.judge(tally);
    if (const SpatialHashBroadphase* hash = scene.hash()) {
        tally.expect(hash->validate().empty(), "all invariants hold after changes within");
    }
}

void changeNested(const CaseContext& context, CaseTally& tally) {
    const Aabb<float> region = cubeAt({0, 0, 0}, 6);
    judgeChanges(context, tally, region, [&](btBroadphaseInterface& broadphase, Changes& changes) {
        ChangeInBox callback(changes);
        broadphase.aabbTest(toBullet(region.min()), toBullet(region.max()), callback);
    });
    // A box of 6 m along x.
    const Point half(0, 3, 3);
    const Aabb<float> way(Point(-20, -3, -3), Point(20, 3, 3));
    judgeChanges(context, tally, way, [&](btBroadphaseInterface& broadphase, Changes& changes) {
        ChangeOnRay callback(changes);
        broadphase.rayTest({-20, 0, 0}, {20, 0, 0}, callback, toBullet(-half), toBullet(half));
    });
}

CaseOutcome changesWithin(const CaseContext& context) {
    CaseTally tally;
    PairScene scene(context, someCubes(context));
    scene.judge(tally);
    askNested(scene, tally);

    // The same proxies, moved, destroyed, created and moved again within a frame.
    Random random(context.seed);
    for (int frame = 0; frame < 20; ++frame) {
        for (int change = 0; change < 10; ++change) {
            const auto object = static_cast<std::uint32_t>(random.unit() * 10);
            const Aabb<float> box = cubeAt({random.between(-5, 5), random.between(-5, 5), 0}, 1.5F);
            scene.move(object, box);
            scene.destroy(object);
            scene.create(object, box);
            scene.move(object, box.translated(Point(random.between(-1, 1), 0, 0)));
        }
        scene.judge(tally);
    }
    askNested(scene, tally);
    changeNested(context, tally);

    RemoveSome callback;
    btOverlappingPairCache& cache = *scene.broadphase().getOverlappingPairCache();
    const auto pairs = static_cast<std::size_t>(cache.getNumOverlappingPairs());
    cache.processAllOverlappingPairs(&callback, nullptr);
    tally.expect(callback.seen == pairs, "every pair is seen once while pairs are removed");
    return tally.outcome();
}

// --- Nothing --------------------------------------------------------------------------------------

CaseOutcome nothingThere(const CaseContext& context) {
    CaseTally tally;
    const Aabb<float> world = cubeAt({0, 0, 0}, 2);
    for (const std::size_t count : {0U, 1U, 40U}) {
        Boxes boxes;
        for (std::size_t i = 0; i < count; ++i) {
            boxes.push_back(cubeAt({1000 + 3 * static_cast<float>(i), 0, 0}, 1));
        }
        if (count > 1) {
            boxes[1] = boxes[0];  // a pair, so that not everything is nothing
        }
        PairScene scene(context, boxes, {}, world);
        scene.judge(tally);
        Objects found;
        AskWithin box(scene, found, 0);
        scene.broadphase().aabbTest(toBullet(world.min()), toBullet(world.max()), box);
        tally.compare(found, Objects{});
        RayWithin ray(scene, 0);
        ray.cast();
        tally.compare(ray.found, Objects{});
        btVector3 low, high;
        scene.broadphase().getBroadphaseAabb(low, high);
        // Destroyed to the last one.
        for (std::uint32_t i = 0; i < scene.size(); ++i) {
            scene.destroy(i);
        }
        scene.judge(tally);
    }
    return tally.outcome();
}

constexpr std::array kWithinCases{
    HardCase{
        "H32", "changes and questions within one",
        "box queries within box queries and rays within rays, by their callbacks; callbacks of "
        "both that destroy, create and move whom they are told of, and others; the same proxies "
        "moved, destroyed, created and moved again within a frame; pairs removed while walking "
        "over them; 200 cubes",
        "all answers as if asked alone, of what has not changed; exact pairs; every pair seen once",
        changesWithin},
    HardCase{
        "H44", "nobody, one, all outside",
        "0, 1 and 40 boxes 1 km outside of the region that is asked about, and of the axis sweep's "
        "world; then destroyed to the last one",
        "no pair, no hit, no harm", nothingThere},
};

}  // namespace

std::span<const HardCase> withinCases() {
    return kWithinCases;
}

}  // namespace hashphase::demos
