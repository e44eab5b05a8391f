// SPDX-License-Identifier: Zlib
#pragma once

// A broadphase by Bullet's interface, in Bullet's precision.

#include <demos/stability/scene.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <memory>
#include <vector>

namespace hashphase::demos {

class BulletSubject final : public Subject<btScalar> {
public:
    using Box = Aabb<btScalar>;
    using Point = Vector3<btScalar>;

    /// With numbers for so many objects; `freesProxies`: its destructor frees those that are alive.
    BulletSubject(std::unique_ptr<btBroadphaseInterface> broadphase, std::size_t objects,
                  bool freesProxies);
    ~BulletSubject() override;

    void create(std::uint32_t object, const Box& box) override;
    void move(std::uint32_t object, const Box& box) override;
    void destroy(std::uint32_t object) override;
    void findPairs() override { broadphase_->calculateOverlappingPairs(nullptr); }
    void listPairs(Keys& pairs) const override;
    [[nodiscard]] Objects touching(const Box& region) const override;

    [[nodiscard]] std::optional<Objects> rayTest(const Point& from, const Point& to,
                                                 const Box& cast) const override;
    [[nodiscard]] bool passesRayTest(const Point& from, const Point& to, const Box& cast,
                                     const Box& box) const override;
    [[nodiscard]] std::optional<Objects> behindAll(
        std::span<const Plane<btScalar>> planes) const override;
    [[nodiscard]] GroundBelow groundOf(std::span<const Point> corners) const override;

    [[nodiscard]] const Grid<btScalar>* grid() const override;
    [[nodiscard]] PairCost cost() const override;
    [[nodiscard]] std::size_t memoryBytes() const override;
    [[nodiscard]] std::string validate() const override;

    [[nodiscard]] btBroadphaseInterface& broadphase() const noexcept { return *broadphase_; }
    [[nodiscard]] static std::uint32_t objectOf(const btBroadphaseProxy& proxy) {
        return *static_cast<const std::uint32_t*>(proxy.m_clientObject);
    }

private:
    bool freesProxies_;
    Objects objects_;  // what the proxies' clients point at
    std::vector<btBroadphaseProxy*> proxies_;
    std::unique_ptr<btBroadphaseInterface> broadphase_;
};

/// Of a run whose subjects are BulletSubjects.
[[nodiscard]] inline btBroadphaseInterface& broadphaseOf(const Subject<btScalar>& subject) {
    return dynamic_cast<const BulletSubject&>(subject).broadphase();
}

/// The pairs that a cache lists, sorted; objectOf() tells a proxy's number.
template <class ObjectOf>
[[nodiscard]] Keys pairsIn(btOverlappingPairCache& cache, const ObjectOf& objectOf) {
    Keys pairs;
    const int count = cache.getNumOverlappingPairs();
    const btBroadphasePair* listed = count > 0 ? cache.getOverlappingPairArrayPtr() : nullptr;
    for (int i = 0; i < count; ++i) {
        pairs.push_back(pairKey(objectOf(*listed[i].m_pProxy0), objectOf(*listed[i].m_pProxy1)));
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// Bodies in a world, and worlds that go back in time; in bulletCases() beside questions and
/// changes within questions.
[[nodiscard]] std::span<const HardCase> bodyCases();
[[nodiscard]] std::span<const HardCase> worldRollbackCases();

}  // namespace hashphase::demos
