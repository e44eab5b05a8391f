// SPDX-License-Identifier: Zlib
#pragma once

// Plays scripts on broadphases, and knows by brute force what must come out.
//
// Objects are numbers; a proxy's client is the object's Client. Pairs are pairs of objects, lower
// number first, sorted, so those of different broadphases can be compared.

#include <tests/integration/bullet/bullet_scenes.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {

using ObjectPairs = std::vector<std::pair<int, int>>;

/// Empty when the sets are equal, else the first few pairs that are missing from `pairs`, that it
/// has too many, or that it lists twice.
std::string difference(const ObjectPairs& pairs, const ObjectPairs& expected);

/// Empty when every one of `pairs` is in `superset`, else the first few that are not.
std::string excess(const ObjectPairs& pairs, const ObjectPairs& superset);

/// The filter of a broadphase that has no callback: group and mask, both ways.
bool groupsCollide(int groupA, int maskA, int groupB, int maskB);

/// What a proxy stands for. A collision object, for those queries that read one.
struct Client : btCollisionObject {
    explicit Client(int number = 0) : object(number) {}

    int object;
    bool isAlive = true;
};

[[nodiscard]] inline int objectOf(const btBroadphaseProxy* proxy) {
    return static_cast<const Client*>(proxy->m_clientObject)->object;
}

/// A filter callback that looks at the objects: refuses when their sum is a multiple of divisor.
struct DivisorFilter : btOverlapFilterCallback {
    int divisor = 1;
    [[nodiscard]] bool accepts(int a, int b) const { return (a + b) % divisor != 0; }
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
        return accepts(objectOf(a), objectOf(b));
    }
};

/// The state of a script by itself, without any broadphase.
class Truth {
public:
    explicit Truth(int objectCount) : objects_(static_cast<std::size_t>(objectCount)) {}

    void play(const Frame& frame);

    /// Every pair of the present boxes, by brute force.
    [[nodiscard]] ObjectPairs pairs() const;

    [[nodiscard]] bool isAlive(int object) const { return at(object).isAlive; }
    [[nodiscard]] const Box& box(int object) const { return at(object).box; }

private:
    struct Object {
        Box box{};
        int group = 0;
        int mask = 0;
        bool isAlive = false;
    };
    [[nodiscard]] const Object& at(int object) const {
        return objects_[static_cast<std::size_t>(object)];
    }
    [[nodiscard]] bool filterAccepts(int a, int b) const;

    std::vector<Object> objects_;
    int divisor_ = 0;
};

/// A broadphase with its proxies, one for each object that is alive.
class Player {
public:
    /// The pair cache may be one that the broadphase was given; null when it has its own.
    Player(int objectCount, std::unique_ptr<btBroadphaseInterface> broadphase,
           std::unique_ptr<btOverlappingPairCache> cache = nullptr);
    Player(Player&&) = default;
    ~Player();

    /// Everything in the frame, but no calculateOverlappingPairs.
    void play(const Frame& frame);

    /// One command.
    void play(const Command& command);
    void create(int object, const Box& box, int group = btBroadphaseProxy::DefaultFilter,
                int mask = btBroadphaseProxy::AllFilter) {
        play({Action::create, object, box, group, mask});
    }
    void set(int object, const Box& box) { play({Action::set, object, box, 0, 0}); }
    void destroy(int object) { play({Action::destroy, object, {}, 0, 0}); }
    /// Written without a word.
    void setMask(int object, int mask) { proxy(object)->m_collisionFilterMask = mask; }

    void calculate(int times = 1) {
        for (int i = 0; i < times; ++i) {
            broadphase_->calculateOverlappingPairs(nullptr);
        }
    }
    [[nodiscard]] ObjectPairs pairsAfterStep() {
        calculate();
        return pairs();
    }

    /// What the pair cache lists.
    [[nodiscard]] ObjectPairs pairs() const;

    /// What the pair cache lists and whose proxies' boxes overlap now.
    [[nodiscard]] ObjectPairs overlappingPairs() const;

    /// Null while the object is not alive.
    [[nodiscard]] btBroadphaseProxy* proxy(int object) const {
        return proxies_[static_cast<std::size_t>(object)];
    }
    [[nodiscard]] btBroadphaseInterface& broadphase() const { return *broadphase_; }
    [[nodiscard]] btOverlappingPairCache& cache() const {
        return *broadphase_->getOverlappingPairCache();
    }

private:
    void createProxy(const Command& command);
    void destroyProxy(int object);
    void changeFilter(int divisor);

    std::unique_ptr<btOverlappingPairCache> cache_;
    std::unique_ptr<btBroadphaseInterface> broadphase_;
    std::unique_ptr<DivisorFilter> filter_;
    std::vector<std::unique_ptr<Client>> clients_;
    std::vector<std::unique_ptr<Client>> deadClients_;
    std::vector<btBroadphaseProxy*> proxies_;
};

}  // namespace hashphase::test
