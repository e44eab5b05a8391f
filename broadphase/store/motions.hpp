// SPDX-License-Identifier: Zlib
#pragma once

// How far proxies move in a frame: see sweeps.hpp.

#include <broadphase/aabb.hpp>
#include <broadphase/export.hpp>
#include <broadphase/moving_box.hpp>
#include <broadphase/proxy_id.hpp>
#include <broadphase/store/store.hpp>
#include <broadphase/sweep_mode.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace hashphase::detail {

/// What a proxy does that sweeps.
template <class Scalar>
struct Motion {
    ProxyId id;
    MovingBox<Scalar> way;
    Sweep sweep;
    bool isFromGrid;  // it begins at the proxy's box; way.box is that of the update under way
};

/// The motions of a store's proxies.
template <class Scalar>
struct HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Motions {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    Store<Scalar>& store;
    Motions* next;  // over the same store
    std::vector<Motion<Scalar>> all;
    // The places of what has ended since the last update: null ids, whose index is the next place.
    std::uint32_t firstVacant = kNone;
    std::uint32_t vacantCount = 0;
    std::vector<std::uint32_t> ofProxy;  // by proxyIndex; kNone where it does not sweep

    explicit Motions(Store<Scalar>& itsStore);
    ~Motions();
    Motions(const Motions&) = delete;
    Motions& operator=(const Motions&) = delete;

    /// Where memory runs out, nothing has changed.
    void set(const Motion<Scalar>& motion);
    /// What the index has met is to be given up.
    void end(std::uint32_t proxyIndex) noexcept;

    [[nodiscard]] std::size_t size() const noexcept { return all.size() - vacantCount; }
    [[nodiscard]] std::uint32_t of(std::uint32_t proxyIndex) const noexcept {
        return proxyIndex < ofProxy.size() ? ofProxy[proxyIndex] : kNone;
    }
    /// Not of one that has taken the place of another one that swept.
    [[nodiscard]] bool sweeps(ProxyId id) const noexcept {
        const std::uint32_t known = of(id.index);
        return known != kNone && all[known].id == id;
    }
    /// As it is now, of a proxy alive.
    [[nodiscard]] MovingBox<Scalar> wayOf(const Motion<Scalar>& motion) const {
        return {motion.isFromGrid ? store.proxies.records[motion.id.index].box : motion.way.box,
                motion.way.displacement};
    }
    /// The box of a proxy alive where its way begins.
    [[nodiscard]] Aabb<Scalar> boxAtStart(std::uint32_t proxyIndex) const {
        const std::uint32_t known = of(proxyIndex);
        const bool sweeps = known != kNone && all[known].id == store.proxies.idOf(proxyIndex);
        return sweeps ? wayOf(all[known]).box : store.proxies.records[proxyIndex].box;
    }

    /// For pairs that have not heard of them.
    void markAllChanged() noexcept;
    void shiftOrigin(const Vector3<Scalar>& shift) noexcept;
    /// What sweeps counts as changed in each update, whether its box has changed or not: it never comes to
    /// rest, and what it meets is looked for anew.
    void beginUpdate();
    void drop(std::uint32_t motion) noexcept;
    void makeRoom();

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(Motions& to, const Motions& from, const Visit& visit) {
        visit(to.all, from.all);
        visit(to.firstVacant, from.firstVacant);
        visit(to.vacantCount, from.vacantCount);
        visit(to.ofProxy, from.ofProxy);
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return all.capacity() * sizeof(all[0]) + ofProxy.capacity() * sizeof(ofProxy[0]);
    }
    void releaseUnusedMemory() noexcept;
    [[nodiscard]] std::string validate() const;
};

extern template struct Motions<float>;
extern template struct Motions<double>;

}  // namespace hashphase::detail
