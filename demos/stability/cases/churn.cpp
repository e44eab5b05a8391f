// SPDX-License-Identifier: Zlib
//
// Changes: in the midst of a question, again and again, by a hair, of everything and of nothing.

#include <demos/stability/cases/cases.hpp>

#include <broadphase/pairs.hpp>
#include <demos/scenes/random.hpp>
#include <demos/stability/grid_scene.hpp>
#include <demos/stability/isolation.hpp>
#include <demos/stability/pair_scene.hpp>
#include <integration/bullet/conversions.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

struct RayWithin final : btBroadphaseRayCallback {
    RayWithin(PairScene& asked, int howDeep) : scene(asked), depth(howDeep) {
        m_rayDirectionInverse = btVector3(1, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
        m_signs[0] = m_signs[1] = m_signs[2] = 0;
        m_lambda_max = 40;
    }

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

void askNested(PairScene& scene, CaseTally& tally) {
    Objects found;
    AskWithin callback(scene, found, 1);
    const Aabb<float> region = cubeAt({0, 0, 0}, 6);
    scene.broadphase().aabbTest(toBullet(region.min()), toBullet(region.max()), callback);
    Objects exact;
    for (std::uint32_t i = 0; i < scene.size(); ++i) {
        if (overlaps(scene.boxes()[i], region)) {
            exact.push_back(i);
        }
    }
    std::sort(found.begin(), found.end());
    tally.compare(found, exact);
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

// Destroys, moves and creates while it is told who is there.
struct ChangeWithin final : btBroadphaseAabbCallback {
    explicit ChangeWithin(PairScene& asked) : scene(asked), isChanged(asked.size(), false) {}

    bool process(const btBroadphaseProxy* proxy) override {
        const std::uint32_t object = FilledBroadphase::objectOf(*proxy);
        found.push_back(object);
        isDeadOffered |= hasNan(scene.boxes()[object]);
        const std::uint32_t other = (object * 7 + 3) % scene.size();
        if (object % 2 == 0 && !isChanged[other]) {
            isChanged[other] = true;
            const Aabb<float> box = scene.boxes()[other];
            if (object % 4 == 0) {
                scene.destroy(other);
                if (object % 8 == 0) {
                    scene.create(other, box.translated(Point(0.25F, 0, 0)));
                }
            } else {
                scene.move(other, box.translated(Point(0, 20, 0)));
            }
        }
        return true;
    }

    PairScene& scene;
    Objects found;
    std::vector<bool> isChanged;
    bool isDeadOffered = false;
};

// What was not changed is found, once; nobody is found who is no more.
void changeNested(PairScene& scene, CaseTally& tally) {
    const Aabb<float> region = cubeAt({0, 0, 0}, 6);
    Objects before;
    for (std::uint32_t i = 0; i < scene.size(); ++i) {
        if (overlaps(scene.boxes()[i], region)) {
            before.push_back(i);
        }
    }
    ChangeWithin callback(scene);
    scene.broadphase().aabbTest(toBullet(region.min()), toBullet(region.max()), callback);
    const auto isChanged = [&](std::uint32_t object) { return callback.isChanged[object]; };
    std::erase_if(before, isChanged);
    std::erase_if(callback.found, isChanged);
    std::sort(callback.found.begin(), callback.found.end());
    tally.compare(callback.found, before);
    tally.expect(!callback.isDeadOffered, "a query finds nobody whom its callback has destroyed");
    scene.judge(tally);
}

CaseOutcome changesWithin(const CaseContext& context) {
    CaseTally tally;
    PairScene scene(context, scatteredCubes(200, 10, 0.5F, 1.5F, context.seed));
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
    changeNested(scene, tally);

    RemoveSome callback;
    btOverlappingPairCache& cache = *scene.broadphase().getOverlappingPairCache();
    const auto pairs = static_cast<std::size_t>(cache.getNumOverlappingPairs());
    cache.processAllOverlappingPairs(&callback, nullptr);
    tally.expect(callback.seen == pairs, "every pair is seen once while pairs are removed");
    return tally.outcome();
}

// --- Once -----------------------------------------------------------------------------------------

CaseOutcome duplicates(const CaseContext& context) {
    CaseTally tally;
    Boxes boxes;
    for (const float edge : {0.9F, 1.1F, 3.5F, 4.5F, 15.0F, 20.0F}) {
        for (int i = 0; i < 5; ++i) {
            boxes.push_back(cubeAt(Point::Constant(0.125F * static_cast<float>(i)), edge));
        }
    }
    PairScene scene(context, boxes, {.cellSize = 1, .levelRatio = 4});
    scene.judge(tally);
    if (context.kind.ours) {
        Grid<float> grid({.cellSize = 1, .levelRatio = 4});
        Pairs<float> pairs(grid);
        std::vector<ProxyId> ids;
        for (const Aabb<float>& box : boxes) {
            ids.push_back(grid.add(box));
        }
        const auto all = [](ProxyId, ProxyId) { return true; };
        const auto keysOf = [](std::span<const ProxyPair> of) {
            std::vector<PairKey> keys;
            for (const ProxyPair& pair : of) {
                keys.push_back(keyOf(pair));
            }
            return keys;
        };
        tally.compare(keysOf(pairs.update(all).born), scene.exact());
        tally.expect(pairs.update(all).born.empty(), "a pair is born once");
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const float far = 100 * static_cast<float>(i + 1);
            grid.move(ids[i], boxes[i].translated(Point(far, 0, 0)));
        }
        tally.compare(keysOf(pairs.update(all).died), scene.exact());
        tally.expect(pairs.update(all).died.empty(), "a pair dies once");
    }
    return tally.outcome();
}

CaseOutcome smallMoves(const CaseContext& context) {
    CaseTally tally;
    Boxes boxes{cubeAt({0, 0, 0}, 1)};
    const int frames = context.quickOrFull(1000, 10'000);
    for (int i = 0; i < frames / 100; ++i) {
        boxes.push_back(cubeAt({5 * static_cast<float>(i), 1, 0}, 1));
    }
    PairScene scene(
        context, boxes, {},
        Aabb<float>(Point::Constant(-10), Point::Constant(0.1F * static_cast<float>(frames))));
    constexpr float kMargin = 0.05F;  // by which btDbvtBroadphase fattens boxes [m]
    const std::array steps{kMargin, std::nextafter(kMargin, 1.0F), std::nextafter(kMargin, 0.0F)};
    std::vector<PairKey> exact;
    for (int frame = 0; frame < frames; ++frame) {
        const float step = steps[static_cast<std::size_t>(frame) % 3];
        scene.move(0, scene.boxes()[0].translated(Point(step, 0, 0)));
        scene.findPairs();
        exact.clear();
        // The others stand apart: only pairs with the first box can be.
        for (std::uint32_t i = 1; i < scene.size(); ++i) {
            if (overlaps(scene.boxes()[0], scene.boxes()[i])) {
                exact.push_back(pairKey(0, i));
            }
        }
        tally.compare(scene.reported(), exact);
    }
    return tally.outcome();
}

// --- Everything, at random ------------------------------------------------------------------------

// The pairs by brute force, kept up to date change by change.
class Truth {
public:
    explicit Truth(std::size_t count) : boxes_(count), isThere_(count, false) {}

    void set(std::uint32_t object, const Aabb<float>& box) {
        remove(object);
        boxes_[object] = box;
        isThere_[object] = true;
        for (std::uint32_t other = 0; other < boxes_.size(); ++other) {
            if (other != object && isThere_[other] && overlaps(box, boxes_[other])) {
                const PairKey pair = pairKey(object, other);
                pairs_.insert(std::lower_bound(pairs_.begin(), pairs_.end(), pair), pair);
            }
        }
    }
    void remove(std::uint32_t object) {
        isThere_[object] = false;
        std::erase_if(pairs_, [object](PairKey pair) {
            return firstOf(pair) == object || secondOf(pair) == object;
        });
    }
    [[nodiscard]] bool has(std::uint32_t object) const { return isThere_[object]; }
    [[nodiscard]] const std::vector<PairKey>& pairs() const noexcept { return pairs_; }

private:
    Boxes boxes_;
    std::vector<char> isThere_;
    std::vector<PairKey> pairs_;
};

// Mostly cubes in a crowd; sometimes points, plates, far ones, large ones.
Aabb<float> anyBox(Random& random) {
    const auto near = [&] { return random.between(-4, 4); };
    const Point at(near(), near(), near());
    const float kind = random.unit();
    if (kind < 0.02F) {
        return cubeAt(at, 1e4F);
    }
    if (kind < 0.05F) {
        return cubeAt(1000 * at, 0.5F);
    }
    if (kind < 0.1F) {
        return {at, at};
    }
    if (kind < 0.4F) {  // on borders of cells, so that many touch exactly
        const Point low = at.array().floor();
        return {low, low + Point::Ones()};
    }
    return cubeAt(at, random.between(0.1F, 1.5F));
}

CaseOutcome randomChanges(const CaseContext& context) {
    constexpr std::uint32_t kObjects = 40;
    const int changes = context.quickOrFull(20'000, 1'000'000) / (context.kind.ours ? 1 : 50);
    CaseTally tally;
    Random random(context.seed);
    Boxes boxes;
    Truth truth(kObjects);
    for (std::uint32_t i = 0; i < kObjects; ++i) {
        boxes.push_back(anyBox(random));
        truth.set(i, boxes[i]);
    }
    PairScene scene(context, boxes, {}, cubeAt({0, 0, 0}, 1e4F));
    for (int i = 0; i < changes; ++i) {
        const auto object = static_cast<std::uint32_t>(random.unit() * kObjects);
        if (!truth.has(object)) {
            const Aabb<float> box = anyBox(random);
            scene.create(object, box);
            truth.set(object, box);
        } else if (random.unit() < 0.2F) {
            scene.destroy(object);
            truth.remove(object);
        } else {
            const Aabb<float> box =
                random.unit() < 0.5F
                    ? anyBox(random)
                    : scene.boxes()[object].translated(Point(random.between(-0.1F, 0.1F), 0, 0));
            scene.move(object, box);
            truth.set(object, box);
        }
        scene.findPairs();
        tally.compare(scene.reported(), truth.pairs());
    }
    if (const SpatialHashBroadphase* hash = scene.hash()) {
        tally.expect(hash->validate().empty(), "all invariants hold");
    }
    tally.note(std::to_string(changes) + " changes, compared after each.");
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

constexpr std::array kChurnCases{
    HardCase{
        "H32", "changes and questions within one",
        "box queries within box queries and rays within rays, by their callbacks; callbacks that "
        "destroy, create and move; the same proxies moved, destroyed, created and moved again "
        "within a frame; pairs removed while walking over them; 200 cubes",
        "all answers as if asked alone, of what has not changed; exact pairs; every pair seen once",
        changesWithin},
    HardCase{
        "H33", "one pair in many cells",
        "30 cubes of 0.9 to 20 m in each other, cells of 1, 4 and 16 m: pairs that share up to 8 "
        "cells and span 3 levels",
        "each pair once; born once, died once", duplicates},
    HardCase{
        "H34", "moves by a margin, again and again",
        "a cube that moves by 5 cm, and 1 ulp more and less, in each of 10,000 frames (--quick: "
        "1,000), past others; btDbvtBroadphase fattens boxes by 5 cm",
        "exact pairs in every frame", smallMoves},
    HardCase{
        "H35", "changes at random",
        "1,000,000 (--quick: 20,000; a fiftieth of it for the others) creations, moves and "
        "removals of 40 boxes, among them points, large and far ones, and such as touch exactly",
        "the pairs of brute force after each", randomChanges},
    HardCase{
        "H44", "nobody, one, all outside",
        "0, 1 and 40 boxes 1 km outside of the region that is asked about, and of the axis sweep's "
        "world; then destroyed to the last one",
        "no pair, no hit, no harm", nothingThere},
};

}  // namespace

std::span<const HardCase> churnCases() {
    return kChurnCases;
}

}  // namespace hashphase::demos
