// SPDX-License-Identifier: Zlib

// SpatialHashBroadphase over several pair caches, and btDbvtBroadphase over ours, against brute force.

#include <tests/fuzz/bullet_life_world.hpp>
#include <tests/integration/bullet/queries.hpp>

#include <algorithm>
#include <iterator>
#include <limits>

namespace hashphase::test {
namespace {

/// Lists the objects that a ray is to be cast at, and casts at none.
struct AskedRay : btCollisionWorld::RayResultCallback {
    bool needsCollision(btBroadphaseProxy* proxy) const override {
        asked.push_back(objectOf(proxy));
        return false;
    }
    btScalar addSingleResult(btCollisionWorld::LocalRayResult& /*result*/,
                             bool /*isInWorld*/) override {
        return 1;
    }
    mutable std::vector<int> asked;
};

class BroadphasePlay {
public:
    BroadphasePlay(const Operation& first, OperationLog& story)
        : story_(story),
          world_(first),
          life_(first, world_, story),
          isSeldomStepped_(first.arguments[7] % 4 == 3) {
        if (world_.hash() == nullptr) {
            life_.palette().calm();
        }
    }

    void play(const Operation& operation) {
        life_.play(operation, *this, kOwn);
        EXPECT_TRUE(world_.journal.errors.empty()) << world_.journal.errors[0];
        EXPECT_TRUE(world_.ours() == nullptr || world_.ours()->validate().empty())
            << world_.ours()->validate();
        EXPECT_TRUE(!world_.hasGhosts() || world_.journal.alive == uidPairs(world_.cache()))
            << "ghosts were told otherwise";
        if (world_.hash() != nullptr) {
            EXPECT_EQ(world_.hash()->grid().validate(), "");
            EXPECT_EQ(world_.hash()->grid().size(), life_.proxies().size());
        }
    }

private:
    void calculateOnce(Arguments& arguments) { calculate(1, arguments); }
    void calculateOften(Arguments& arguments) { calculate(1 + arguments.below(12), arguments); }
    void calculate(std::uint32_t count, Arguments& arguments) {
        if (isSeldomStepped_ && arguments.byte() % 16 != 15) {
            story_.tell("nothing");
            return;
        }
        if (count % 4 == 3 && world_.hash() != nullptr) {
            story_.tell("release unused memory; ");
            world_.hash()->releaseUnusedMemory();
        }
        story_.tell("calculate ", count, " times");
        for (std::uint32_t i = 0; i < count; ++i) {
            world_.broadphase().calculateOverlappingPairs(nullptr);
            EXPECT_EQ(differences(world_.pairs(), expectedPairs()), "");
            if (world_.hash() != nullptr) {
                EXPECT_EQ(world_.hash()->validate(), "");
            }
        }
    }

    void regroup(Arguments& arguments) {
        const ProxyId id = life_.proxies()[life_.any(arguments)].id;
        const int group = 1 << arguments.below(6);
        const int mask = arguments.flag() ? btBroadphaseProxy::AllFilter : arguments.byte() % 64;
        story_.tell("group ", group, " and mask ", mask, " for ", id.index);
        writeTo(id, group, mask);
        askFilterAgain(world_.broadphase(), world_.proxyOf(id));
    }

    void writeTo(ProxyId id, int group, int mask) {
        world_.proxyOf(id)->m_collisionFilterGroup = group;
        world_.proxyOf(id)->m_collisionFilterMask = mask;
    }

    void regroupMany(Arguments& arguments) {
        const std::uint32_t each = 1 + arguments.below(12);
        const int group = 1 << arguments.below(6);
        const int mask = arguments.flag() ? btBroadphaseProxy::AllFilter : arguments.byte() % 64;
        const bool areAll = arguments.flag();
        if (world_.hash() == nullptr) {
            return;
        }
        story_.tell("group ", group, " and mask ", mask, " for each ", each, "th at once",
                    areAll ? ", and all filtered again" : "");
        std::vector<btBroadphaseProxy*> proxies;
        for (std::size_t i = 0; i < life_.list().size(); i += each) {
            writeTo(life_.list()[i].id, group, mask);
            proxies.push_back(world_.proxyOf(life_.list()[i].id));
        }
        if (areAll) {
            world_.hash()->refilterAll(nullptr);
        } else {
            world_.hash()->refilter(proxies, nullptr);
        }
    }

    // Without a word: what may pair now is a pair when pairs are calculated, where groups and masks decide; what
    // may not any more stays one.
    void writeGroups(Arguments& arguments) {
        const std::size_t count = 1 + arguments.below(4);
        if (world_.hash() == nullptr) {
            return;
        }
        const ObjectPairs before = world_.pairs();
        std::vector<btBroadphaseProxy*> proxies;
        for (std::size_t i = 0; i < count; ++i) {
            const Placed<btScalar> placed = life_.proxies()[life_.any(arguments)];
            btBroadphaseProxy* const proxy = world_.proxyOf(placed.id);
            const int group = 1 << arguments.below(6);
            writeTo(placed.id, group, arguments.below(3) == 0 ? 0 : arguments.byte() % 64);
            story_.tell("group ", group, " and mask ", proxy->m_collisionFilterMask, " for ",
                        placed.id.index, "; ");
            proxies.push_back(proxy);
        }
        for (btBroadphaseProxy* const proxy : proxies) {
            const btVector3 min = proxy->m_aabbMin;
            const btVector3 max = proxy->m_aabbMax;
            world_.broadphase().setAabb(proxy, min, max, nullptr);
        }
        world_.broadphase().calculateOverlappingPairs(nullptr);
        EXPECT_EQ(world_.hash()->validate(), "");
        const ObjectPairs pairs = world_.pairs();
        const ObjectPairs expected = expectedPairs();
        const bool doGroupsDecide =
            world_.filter.divisor == 0 && dynamic_cast<PairCache*>(&world_.cache()) != nullptr;
        EXPECT_TRUE(!doGroupsDecide ||
                    std::includes(pairs.begin(), pairs.end(), expected.begin(), expected.end()))
            << differences(pairs, expected);
        ObjectPairs others;
        std::set_difference(pairs.begin(), pairs.end(), expected.begin(), expected.end(),
                            std::back_inserter(others));
        EXPECT_TRUE(std::includes(before.begin(), before.end(), others.begin(), others.end()))
            << "what may not pair begins to";
        world_.hash()->refilter(proxies, nullptr);
        EXPECT_EQ(differences(world_.pairs(), expected), "");
    }

    void changeFilter(Arguments& arguments) {
        const int divisor = static_cast<int>(arguments.below(4));
        story_.tell("filter with the divisor ", divisor);
        world_.filter.divisor = divisor;
        world_.cache().setOverlapFilterCallback(divisor != 0 ? &world_.filter : nullptr);
        if (world_.hash() != nullptr && arguments.flag()) {
            world_.hash()->refilterAll(nullptr);
        } else {
            for (btBroadphaseProxy* const proxy : world_.proxies) {
                if (proxy != nullptr) {
                    askFilterAgain(world_.broadphase(), proxy);
                }
            }
        }
    }

    void setMargins(Arguments& arguments) {
        const std::uint32_t count = 1 + arguments.below(5);
        if (world_.hash() == nullptr) {
            return;
        }
        for (std::uint32_t i = 0; i < count; ++i) {
            const ProxyId id = life_.proxies()[life_.any(arguments)].id;
            const btScalar extent = life_.palette().extent(arguments.byte());
            const btScalar margin =
                extent <= std::numeric_limits<btScalar>::max() && i % 4 < 3 ? extent : 0;
            story_.tell("margin ", margin, " for ", id.index, "; ");
            world_.hash()->setMargin(world_.proxyOf(id), margin, nullptr);
            EXPECT_EQ(world_.hash()->margin(world_.proxyOf(id)), margin);
        }
    }

    void ignore(Arguments& arguments) {
        const ProxyId first = life_.proxies()[life_.any(arguments)].id;
        const std::uint32_t count = 1 + arguments.below(8);
        const bool isIgnored = arguments.below(3) > 0;
        if (world_.hash() == nullptr) {
            return;
        }
        btBroadphaseProxy* const a = world_.proxyOf(first);
        for (std::uint32_t i = 0; i < count; ++i) {
            btBroadphaseProxy* const b = world_.proxyOf(life_.proxies()[life_.any(arguments)].id);
            if (a == b) {
                continue;
            }
            story_.tell(isIgnored ? "ignore " : "ignore no more ", objectOf(a), " and ",
                        objectOf(b), "; ");
            const std::pair<int, int> pair = std::minmax({objectOf(a), objectOf(b)});
            if (isIgnored) {
                world_.ignored.insert(pair);
                world_.hash()->ignorePair(a, b, nullptr);
                EXPECT_EQ(world_.cache().findPair(a, b), nullptr);
            } else {
                world_.ignored.erase(pair);
                world_.hash()->stopIgnoringPair(a, b, nullptr);
            }
            EXPECT_EQ(world_.hash()->isIgnoredPair(b, a), isIgnored);
        }
    }

    void createMany(Arguments& arguments) {
        const std::uint32_t count = arguments.below(20);
        if (world_.hash() == nullptr || life_.proxies().size() + count > kMostProxies) {
            return;
        }
        story_.tell("create ", count, " at once");
        Random random = arguments.random();
        std::vector<ProxyDefinition> definitions;
        std::vector<Aabb<btScalar>> boxes;
        for (std::uint32_t i = 0; i < count; ++i) {
            boxes.push_back(anyBox(random));
            definitions.push_back({toBullet(boxes.back().min()), toBullet(boxes.back().max()),
                                   world_.newClient(), 1 << random.below(6),
                                   btBroadphaseProxy::AllFilter});
        }
        std::vector<btBroadphaseProxy*> created(count);
        world_.hash()->createProxies(definitions, created, nullptr);
        for (std::size_t i = 0; i < count; ++i) {
            Placed<btScalar> proxy;
            proxy.box = boxes[i];
            proxy.id = world_.note(created[i]);
            life_.list().push_back(proxy);
        }
    }

    void setMany(Arguments& arguments) {
        const std::uint32_t each = 1 + arguments.below(5);
        if (world_.hash() == nullptr) {
            return;
        }
        story_.tell("set each ", each, "th at once");
        Random random = arguments.random();
        std::vector<btBroadphaseProxy*> proxies;
        std::vector<btVector3> mins;
        std::vector<btVector3> maxs;
        for (std::size_t i = 0; i < life_.list().size(); i += each) {
            Placed<btScalar>& proxy = life_.list()[i];
            proxy.box = random.chance(0.3) ? proxy.box : anyBox(random);
            proxies.push_back(world_.proxyOf(proxy.id));
            mins.push_back(toBullet(proxy.box.min()));
            maxs.push_back(toBullet(proxy.box.max()));
        }
        world_.hash()->setAabbs(proxies, mins, maxs, nullptr);
    }

    void destroyMany(Arguments& arguments) {
        const std::uint32_t each = 1 + arguments.below(5);
        if (world_.hash() == nullptr) {
            return;
        }
        story_.tell("destroy each ", each, "th at once");
        std::vector<btBroadphaseProxy*> proxies;
        std::vector<int> objects;
        std::vector<Placed<btScalar>> left;
        for (std::size_t i = 0; i < life_.list().size(); ++i) {
            const Placed<btScalar>& proxy = life_.list()[i];
            if (i % each == 0) {
                proxies.push_back(world_.proxyOf(proxy.id));
                objects.push_back(world_.numberOf(proxy.id));
            } else {
                left.push_back(proxy);
            }
        }
        world_.hash()->destroyProxies(proxies, nullptr);
        for (const int object : objects) {
            world_.noteDestroyed(object);
        }
        life_.list() = left;
        world_.hash()->resetPool(nullptr);
    }

    Aabb<btScalar> anyBox(Random& random) {
        const Operation drawn = drawOperation(random);
        Arguments from(drawn);
        return life_.palette().box(from, life_.proxies());
    }

    void askBox(Arguments& arguments) {
        const Aabb<btScalar> box = life_.palette().box(arguments, life_.proxies());
        story_.tell("box ", box);
        if (world_.hash() == nullptr || hasNan(box)) {
            return;
        }
        const Box asked{toBullet(box.min()), toBullet(box.max())};
        CollectBox found;
        world_.broadphase().aabbTest(asked.min, asked.max, found);
        EXPECT_EQ(found.sorted(), expected(asked));
    }

    [[nodiscard]] Ray anyRay(Arguments& arguments) {
        Ray ray{toBullet(life_.palette().point(arguments)),
                toBullet(life_.palette().point(arguments))};
        const std::uint8_t form = arguments.byte();
        if (form % 4 == 1) {
            ray.to[form / 4 % 3] = ray.from[form / 4 % 3];
        } else if (form % 4 == 2) {
            const btScalar half = life_.palette().extent(arguments.byte());
            ray.castMin = btVector3(-half, -half, -half);
            ray.castMax = btVector3(half, half, half);
        }
        return ray;
    }
    /// Whether Bullet's own arithmetic of rays holds.
    [[nodiscard]] bool castsRays() {
        const btScalar scale = life_.palette().scale();
        return world_.hash() != nullptr && scale >= btScalar(1e-3) && scale <= btScalar(1e4);
    }
    template <class Question>
    [[nodiscard]] std::vector<int> expected(const Question& question) const {
        return metByBruteForce(world_.grown(life_.proxies()), question,
                               [this](ProxyId id) { return world_.numberOf(id); });
    }
    [[nodiscard]] ObjectPairs expectedPairs() const {
        return world_.expectedPairs(life_.proxies());
    }

    void askRay(Arguments& arguments) {
        const Ray ray = anyRay(arguments);
        story_.tell(describe(ray));
        if (!castsRays()) {
            return;
        }
        CollectRay found(ray);
        world_.broadphase().rayTest(ray.from, ray.to, found, ray.castMin, ray.castMax);
        EXPECT_EQ(found.sorted(), expected(ray));
    }

    void askClosest(Arguments& arguments) {
        Ray ray = anyRay(arguments);
        ray.castMin = ray.castMax = btVector3(0, 0, 0);
        story_.tell("closest: ", describe(ray));
        if (!castsRays()) {
            return;
        }
        const std::vector<int> expectedOfEach = expected(ray);
        const auto expectAll = [&](AskedRay& callback) {  // about from near to far
            std::sort(callback.asked.begin(), callback.asked.end());
            EXPECT_EQ(callback.asked, expectedOfEach);
        };
        AskedRay one;
        world_.hash()->closestRay(ray.from, ray.to, one);
        expectAll(one);
        std::array<AskedRay, 3> callbacks;
        std::vector<ClosestRay> rays;
        for (AskedRay& callback : callbacks) {
            rays.push_back({ray.from, ray.to, &callback});
        }
        world_.hash()->closestRays(rays);
        for (AskedRay& callback : callbacks) {
            expectAll(callback);
        }
    }

    // What changes no pair.
    void cleanAndSort(Arguments& arguments) {
        const ProxyId id = life_.proxies()[life_.any(arguments)].id;
        story_.tell("clean ", id.index, " from pairs, and sort");
        const auto before = uidPairs(world_.cache());
        world_.cache().cleanProxyFromPairs(world_.proxyOf(id), nullptr);
        if (world_.ours() != nullptr) {
            world_.cache().sortOverlappingPairs(nullptr);
        }
        EXPECT_EQ(uidPairs(world_.cache()), before);
    }

    using Self = BroadphasePlay;
    static constexpr std::array<void (Self::*)(Arguments&), 18> kOwn{
        &Self::calculateOnce, &Self::calculateOnce, &Self::calculateOnce, &Self::calculateOften,
        &Self::regroup,       &Self::changeFilter,  &Self::createMany,    &Self::setMany,
        &Self::destroyMany,   &Self::askBox,        &Self::askRay,        &Self::askRay,
        &Self::askClosest,    &Self::regroupMany,   &Self::writeGroups,   &Self::cleanAndSort,
        &Self::ignore,        &Self::setMargins};

    OperationLog& story_;
    BulletLifeWorld world_;
    BoxModel<btScalar, BulletLifeWorld> life_;
    bool isSeldomStepped_;
};

}  // namespace

Verdict playBroadphase(std::span<const Operation> operations, bool tellsStory) {
    return playLife<BroadphasePlay>(operations, tellsStory);
}

}  // namespace hashphase::test
