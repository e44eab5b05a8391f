// SPDX-License-Identifier: Zlib
#pragma once

// A broadphase of Bullet's kind with a proxy for each object of a scene, named by object number.

#include <demos/compare/broadphase_kind.hpp>
#include <demos/compare/heap_meter.hpp>
#include <demos/compare/reference_pairs.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace hashphase::demos {

/// A box as Bullet takes it. Made before anything is timed: no game converts boxes to hand them in.
struct BulletBox {
    btVector3 min;
    btVector3 max;
};

/// Replaces `converted` by the same boxes in Bullet's vectors.
void toBulletBoxes(std::span<const Aabb<float>> boxes, std::vector<BulletBox>& converted);

/// The edge of the finest cells [m]; nothing for a broadphase without a grid of ours.
[[nodiscard]] std::optional<float> cellSizeOf(const btBroadphaseInterface& broadphase);

class FilledBroadphase {
public:
    /// Makes the broadphase; needs.objects is how many numbers there are. It is empty at first.
    FilledBroadphase(const BroadphaseKind& kind, const BroadphaseNeeds& needs);
    FilledBroadphase(const FilledBroadphase&) = delete;
    FilledBroadphase& operator=(const FilledBroadphase&) = delete;
    ~FilledBroadphase();

    void create(std::uint32_t object, const BulletBox& box, CollisionFilter filter);
    void destroy(std::uint32_t object);

    /// The same for many at once, of a SpatialHashBroadphase. `boxes` and `filters` are those of all
    /// objects; without filters all may pair.
    void createInBatch(std::span<const std::uint32_t> objects, std::span<const BulletBox> boxes,
                       std::span<const CollisionFilter> filters);
    void destroyInBatch(std::span<const std::uint32_t> objects);

    /// setAabb for all objects, which must all be there.
    void setAll(std::span<const BulletBox> boxes);
    /// The same in one call, of ours.
    void setAllInBatch(std::span<const btVector3> mins, std::span<const btVector3> maxs);
    void set(std::uint32_t object, const BulletBox& box) {
        broadphase_->setAabb(proxies_[object], box.min, box.max, nullptr);
    }

    void findPairs() { broadphase_->calculateOverlappingPairs(nullptr); }

    /// Replaces `pairs` by what the pair cache lists, sorted.
    void listPairs(std::vector<PairKey>& pairs) const;

    [[nodiscard]] btBroadphaseInterface& broadphase() const noexcept { return *broadphase_; }
    [[nodiscard]] static std::uint32_t objectOf(const btBroadphaseProxy& proxy) {
        return *static_cast<const std::uint32_t*>(proxy.m_clientObject);
    }

    /// What making the broadphase took from the heap; open a HeapScope on it to add more.
    [[nodiscard]] HeapMeter& heap() noexcept { return heap_; }
    [[nodiscard]] const HeapMeter& heap() const noexcept { return heap_; }

private:
    bool freesProxies_;
    std::vector<std::uint32_t> objects_;  // what the proxies' clients point at
    std::vector<btBroadphaseProxy*> proxies_;
    std::vector<ProxyDefinition> definitions_;  // scratch
    std::vector<btBroadphaseProxy*> batch_;     // the same
    HeapMeter heap_;
    std::unique_ptr<btBroadphaseInterface> broadphase_;
};

}  // namespace hashphase::demos
