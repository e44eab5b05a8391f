// SPDX-License-Identifier: Zlib
#pragma once

// Broadphases that all live as one script says.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/support/oracles.hpp>
#include <tests/support/script.hpp>

#include <algorithm>
#include <deque>
#include <memory>
#include <set>
#include <vector>

namespace hashphase::test {

/// A World of tests/support/script.hpp. The colours are collision groups and masks, or what a filter
/// callback knows.
struct ScriptedBoxes {
    ProxyId add(const Aabb<btScalar>& box, Mobility /*mobility*/) {
        const ProxyId id{static_cast<std::uint32_t>(clients.size()), 1};
        clients.push_back(std::make_unique<Client>(static_cast<int>(id.index)));
        alive.push_back(id);
        for (AnyBoxes& boxes : all) {
            boxes.create(boxOf(box), btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter,
                         clients.back().get());
        }
        return id;
    }
    void move(ProxyId id, const Aabb<btScalar>& box) {
        forEach(id,
                [&](AnyBoxes& boxes, btBroadphaseProxy* proxy) { boxes.set(proxy, boxOf(box)); });
    }
    void remove(ProxyId id) {
        forEach(id, [](AnyBoxes& boxes, btBroadphaseProxy* proxy) { boxes.destroy(proxy); });
        clients[id.index]->isAlive = false;
        std::erase(alive, id);
    }
    void paint(ProxyId id, std::uint32_t colour) {
        colours.set(id, colour);
        painted.insert(id);
        writeGroups(id, isByFilter ? 0 : colour);
    }
    /// From now on a filter decides, and groups and masks say nothing; or they do again.
    void decideByFilter(bool doesFilter) {
        isByFilter = doesFilter;
        for (AnyBoxes& boxes : all) {
            boxes.pairCache().setOverlapFilterCallback(doesFilter ? &filter : nullptr);
        }
        for (const ProxyId id : alive) {
            paint(id, colours.of(id));
        }
    }

    /// What the cache lists, sorted.
    [[nodiscard]] static std::vector<ProxyPair> pairs(const AnyBoxes& boxes) {
        std::vector<ProxyPair> pairs;
        const btBroadphasePairArray& array = boxes.pairCache().getOverlappingPairArray();
        for (int i = 0; i < array.size(); ++i) {
            const auto idOf = [](const btBroadphaseProxy* proxy) {
                return ProxyId{static_cast<std::uint32_t>(objectOf(proxy)), 1};
            };
            pairs.push_back(makePair(idOf(array[i].m_pProxy0), idOf(array[i].m_pProxy1)));
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

    std::vector<std::unique_ptr<Client>> clients;  // by number, of the dead, too
    std::vector<ProxyId> alive;                    // in the order of the proxies of each
    Colours colours;
    std::set<ProxyId> painted;  // since a test last cleared it
    bool isByFilter = false;
    FilterBy filter{[this](btBroadphaseProxy& a, btBroadphaseProxy& b) {
        return colours.accept({static_cast<std::uint32_t>(objectOf(&a)), 1},
                              {static_cast<std::uint32_t>(objectOf(&b)), 1});
    }};
    std::deque<AnyBoxes> all;

private:
    template <class Act>
    void forEach(ProxyId id, const Act& act) {
        const auto place = std::lower_bound(alive.begin(), alive.end(), id) - alive.begin();
        for (AnyBoxes& boxes : all) {
            act(boxes, boxes.proxies[static_cast<std::size_t>(place)]);
        }
    }
    void writeGroups(ProxyId id, std::uint32_t colour) {
        // Static ones, and characters, which some have at once.
        const int group = colour == 0   ? btBroadphaseProxy::DefaultFilter
                          : colour == 1 ? btBroadphaseProxy::StaticFilter
                                        : btBroadphaseProxy::CharacterFilter;
        forEach(id, [&](AnyBoxes& boxes, btBroadphaseProxy* proxy) {
            proxy->m_collisionFilterGroup = group;
            proxy->m_collisionFilterMask =
                colour == 0 ? btBroadphaseProxy::AllFilter : btBroadphaseProxy::AllFilter ^ group;
            askFilterAgain(*boxes.over, proxy);
        });
    }
};

}  // namespace hashphase::test
