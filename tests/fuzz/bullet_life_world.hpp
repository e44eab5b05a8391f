// SPDX-License-Identifier: Zlib
#pragma once

// A broadphase of Bullet's kind with its proxies and clients, beside what brute force knows of them.

#include <tests/fuzz/grid_world.hpp>
#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/callbacks.hpp>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace hashphase::test {

/// Of objects, by their numbers, the lower one first; sorted.
using ObjectPairs = std::vector<std::pair<int, int>>;

/// Refuses those whose sum is a multiple of the divisor; with 0 it is not to be asked.
struct DivisorFilter : btOverlapFilterCallback {
    int divisor = 0;
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
        return (objectOf(a) + objectOf(b)) % divisor != 0;
    }
};

/// The broadphase as a World. Objects have the lowest numbers that are free.
class BulletLifeWorld {
public:
    explicit BulletLifeWorld(const Operation& first) {
        constexpr int all = btBroadphaseProxy::AllFilter;
        SpatialHashConfig config;
        config.grid = configOf(first);
        config.eagerGroups = first.arguments[6] / 2 % 3 == 0
                                 ? eagerCharactersAndSensors().eagerGroups
                             : first.arguments[6] / 2 % 3 == 1 ? 0
                                                               : all;
        const int kind = first.arguments[5] % 7;
        if (kind == 0) {
            hash_ = std::make_unique<SpatialHashBroadphase>(config);
        } else if (kind == 1 || kind == 2) {
            cache_ = std::make_unique<btHashedOverlappingPairCache>();
            if (kind == 2) {
                cache_ = std::make_unique<btSortedOverlappingPairCache>();
            }
            hash_ = std::make_unique<SpatialHashBroadphase>(cache_.get(), config);
        } else {
            auto cache = std::make_unique<PairCache>(kind % 2 == 0 ? PairOrder::canonical
                                                                   : PairOrder::arrival);
            ours_ = cache.get();
            cache_ = std::move(cache);
            if (kind < 5) {
                hash_ = std::make_unique<SpatialHashBroadphase>(ours_, config);
            } else {
                dbvt_ = std::make_unique<ExactDbvt>(ours_);
            }
        }
        // btSortedOverlappingPairCache does not tell its ghosts of all that it removes.
        hasGhosts_ = first.arguments[6] % 2 == 1 && kind != 2;
        journal.hasLivingClient = hasLivingClient;
        if (hasGhosts_) {
            cache().setInternalGhostPairCallback(&journal);
        }
    }
    ~BulletLifeWorld() {
        for (std::size_t i = 0; i < proxies.size(); ++i) {
            if (proxies[i] != nullptr) {
                broadphase().destroyProxy(proxies[i], nullptr);
            }
        }
    }
    BulletLifeWorld(const BulletLifeWorld&) = delete;
    BulletLifeWorld& operator=(const BulletLifeWorld&) = delete;

    [[nodiscard]] btBroadphaseInterface& broadphase() {
        return hash_ != nullptr ? static_cast<btBroadphaseInterface&>(*hash_) : *dbvt_;
    }
    [[nodiscard]] bool hasGhosts() const noexcept { return hasGhosts_; }
    [[nodiscard]] SpatialHashBroadphase* hash() { return hash_.get(); }
    [[nodiscard]] PairCache* ours() { return ours_; }
    [[nodiscard]] btOverlappingPairCache& cache() {
        return *broadphase().getOverlappingPairCache();
    }

    /// A client for the proxy that is created next; it has its number already, which filters ask for.
    [[nodiscard]] Client* newClient() {
        const auto free = std::find(isTaken_.begin(), isTaken_.end(), 0);
        const auto object = static_cast<int>(free - isTaken_.begin());
        if (free == isTaken_.end()) {
            isTaken_.push_back(0);
            proxies.push_back(nullptr);
        }
        isTaken_[static_cast<std::size_t>(object)] = 1;
        clients_.push_back(std::make_unique<Client>(object));
        return clients_.back().get();
    }

    ProxyId add(const Aabb<btScalar>& box, Mobility /*mobility*/) {
        const int group = 1 << (created_++ % 6);
        return note(broadphase().createProxy(toBullet(box.min()), toBullet(box.max()),
                                             BOX_SHAPE_PROXYTYPE, newClient(), group,
                                             btBroadphaseProxy::AllFilter, nullptr));
    }
    void move(ProxyId id, const Aabb<btScalar>& box) {
        broadphase().setAabb(proxyOf(id), toBullet(box.min()), toBullet(box.max()), nullptr);
    }
    void remove(ProxyId id) {
        const int object = numberOf(id);
        broadphase().destroyProxy(proxyOf(id), nullptr);
        noteDestroyed(object);
    }

    [[nodiscard]] btBroadphaseProxy* proxyOf(ProxyId id) const {
        return hash_ != nullptr ? hash_->proxyOf(id) : proxies[id.index];
    }
    /// The object's number.
    [[nodiscard]] int numberOf(ProxyId id) const { return objectOf(proxyOf(id)); }

    ProxyId note(btBroadphaseProxy* proxy) {
        auto* const client = static_cast<Client*>(proxy->m_clientObject);
        client->setBroadphaseHandle(proxy);
        const int object = client->object;
        proxies[static_cast<std::size_t>(object)] = proxy;
        return hash_ != nullptr ? SpatialHashBroadphase::idOf(proxy)
                                : ProxyId{static_cast<std::uint32_t>(object), 1};
    }
    void noteDestroyed(int object) {
        proxies[static_cast<std::size_t>(object)] = nullptr;
        isTaken_[static_cast<std::size_t>(object)] = 0;
        std::erase_if(ignored, [object](const auto& pair) {
            return pair.first == object || pair.second == object;
        });
        for (const auto& client : clients_) {
            client->isAlive = client->isAlive && client->object != object;
        }
    }

    [[nodiscard]] ObjectPairs pairs() {
        ObjectPairs pairs;
        const btBroadphasePairArray& array = cache().getOverlappingPairArray();
        for (int i = 0; i < array.size(); ++i) {
            pairs.push_back(
                std::minmax({objectOf(array[i].m_pProxy0), objectOf(array[i].m_pProxy1)}));
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

    /// Every pair of these boxes, by brute force: as the filter says, or groups and masks.
    [[nodiscard]] ObjectPairs expectedPairs(std::span<const Placed<btScalar>> boxes) const {
        ObjectPairs pairs;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                btBroadphaseProxy* const a = proxyOf(boxes[i].id);
                btBroadphaseProxy* const b = proxyOf(boxes[k].id);
                if (overlap(grown(boxes[i]), grown(boxes[k])) &&
                    !ignored.contains(std::minmax({objectOf(a), objectOf(b)})) &&
                    (filter.divisor != 0 ? filter.needBroadphaseCollision(a, b)
                                         : groupsCollide(*a, *b))) {
                    pairs.push_back(std::minmax({objectOf(a), objectOf(b)}));
                }
            }
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

    /// Boxes with their margins, of which queries are answered.
    [[nodiscard]] std::vector<Placed<btScalar>> grown(
        std::span<const Placed<btScalar>> boxes) const {
        std::vector<Placed<btScalar>> all(boxes.begin(), boxes.end());
        for (Placed<btScalar>& each : all) {
            const Box box = grown(each);
            each.box = toAabb(box.min, box.max);
        }
        return all;
    }
    [[nodiscard]] Box grown(const Placed<btScalar>& placed) const {
        const Box box = boxOf(placed.box);
        return hash_ != nullptr ? grownBy(box, hash_->margin(proxyOf(placed.id))) : box;
    }

    PairJournal journal;
    DivisorFilter filter;
    std::vector<btBroadphaseProxy*> proxies;  // by object
    std::set<std::pair<int, int>> ignored;    // of objects, the lower one first

private:
    std::vector<char> isTaken_;  // by object: has a client
    std::vector<std::unique_ptr<Client>> clients_;
    std::unique_ptr<btOverlappingPairCache> cache_;
    PairCache* ours_ = nullptr;
    std::unique_ptr<SpatialHashBroadphase> hash_;
    std::unique_ptr<ExactDbvt> dbvt_;
    int created_ = 0;
    bool hasGhosts_ = false;
};

}  // namespace hashphase::test
