// SPDX-License-Identifier: Zlib
#pragma once

// Boxes in many worlds at one place, and the judge of their pairs, who looks at every two of them.

#include <integration/bullet/worlds_broadphase.hpp>
#include <tests/integration/bullet/boxes.hpp>

#include <deque>
#include <set>
#include <vector>

namespace hashphase::test {

/// Of objects whose user index is the number of their world.
[[nodiscard]] inline WorldsConfig worldsByUserIndex(int count, const SpatialHashConfig& each = {}) {
    return {.worldCount = count,
            .worldOf = [](const btCollisionObject& object) { return object.getUserIndex(); },
            .each = each};
}

/// Many worlds over a pair cache of ours.
struct ManyWorlds : AnyBoxes {
    static constexpr int kCharacter = btBroadphaseProxy::CharacterFilter;
    static inline const Box kPlace = boxAround({0, 0, 0}, {1, 1, 1});

    explicit ManyWorlds(int count, const SpatialHashConfig& each = {},
                        PairOrder order = PairOrder::arrival)
        : ManyWorlds(new PairCache(order), worldsByUserIndex(count, each)) {}

    btBroadphaseProxy* createIn(int world, const Box& box,
                                int group = btBroadphaseProxy::DefaultFilter,
                                int mask = btBroadphaseProxy::AllFilter) {
        void* client = nullptr;
        {
            const WorkingAllocations working;
            clients.emplace_back().setUserIndex(world);
            client = &clients.back();
        }
        return create(box, group, mask, client);
    }
    /// As btCollisionWorld::refreshBroadphaseProxy(), for an object that belongs to another world by now.
    void moveToWorld(std::size_t i, int world) {
        btBroadphaseProxy*& proxy = proxies[i];
        const btBroadphaseProxy before = *proxy;
        over->destroyProxy(proxy, nullptr);
        static_cast<Client*>(before.m_clientObject)->setUserIndex(world);
        proxy =
            over->createProxy(before.m_aabbMin, before.m_aabbMax, 0, before.m_clientObject,
                              before.m_collisionFilterGroup, before.m_collisionFilterMask, nullptr);
    }

    [[nodiscard]] bool areOfOneWorld(const btBroadphaseProxy& a, const btBroadphaseProxy& b) const {
        return worlds.worldOf(&a) == worlds.worldOf(&b);
    }
    /// What overlaps in one world and is not ignored, sorted.
    [[nodiscard]] std::vector<Uids> pairsByBruteForce() const {
        std::vector<Uids> pairs;
        for (const btBroadphaseProxy* a : proxies) {
            for (const btBroadphaseProxy* b : proxies) {
                if (a->m_uniqueId < b->m_uniqueId && overlap(boxOf(*a), boxOf(*b)) &&
                    areOfOneWorld(*a, *b) && groupsCollide(*a, *b) &&
                    !ignored.contains(uidsOf(*a, *b))) {
                    pairs.push_back(uidsOf(*a, *b));
                }
            }
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }
    /// After a step the pairs are those, and all accounts agree.
    void check() {
        step();
        EXPECT_EQ(worlds.validate(), "");
        EXPECT_EQ(cache.validate(), "");
        std::vector<Uids> pairs = list();
        std::sort(pairs.begin(), pairs.end());
        EXPECT_EQ(pairs, pairsByBruteForce());
    }

    PairCache& cache = dynamic_cast<PairCache&>(*given);
    WorldsBroadphase& worlds = dynamic_cast<WorldsBroadphase&>(*over);
    std::deque<Client> clients;
    std::set<Uids> ignored;

private:
    ManyWorlds(PairCache* newCache, const WorldsConfig& config)
        : AnyBoxes(std::make_unique<WorldsBroadphase>(newCache, config),
                   std::unique_ptr<btOverlappingPairCache>(newCache)) {}
};

}  // namespace hashphase::test
