// SPDX-License-Identifier: Zlib
#pragma once

// What a camera sees of a grid's proxies: those whose boxes touch its frustum, or any other convex
// volume, such as the ground below a camera that looks down.
//
//     Culler<float> culler;
//     culler.look(grid, frustumRegion<float>(viewProjection, DepthRange::zeroToOne));
//     culler.forEach([&](std::uint32_t index) { draw(objects[index]); });
//
// Never culls what is visible: a proxy whose box touches the volume is in the set. So are a few others: boxes
// that only come near an edge of the volume, and proxies that a margin or an earlier frame has brought in;
// overdraw() counts them.
//
// A frame   look() once, with the camera of the frame.
// Threads   look() reads the grid, as queries do, and needs this object for itself.
// Units     metres
// Bad data  With a volume without a point, or with a NaN, the set is empty; frustumError() says why.
// Memory    A bit for each index up to the highest that is visible; a frame like the last one allocates
//           nothing. Room for more than eight times as many goes after 256 frames.

#include <broadphase/convex_region.hpp>
#include <broadphase/core/peak_watch.hpp>
#include <broadphase/core/query_scope.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/culling/export.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace hashphase {

/// How exact the visible set is.
struct Overdraw {
    std::size_t visible = 0;  ///< proxies in the set
    std::size_t unseen = 0;   ///< proxies in the set whose boxes do not touch the volume
};

/// Finds and keeps the set of proxies that a camera sees.
template <class Scalar>
class HASHPHASE_CULLING_TEMPLATE_EXPORT Culler {
public:
    using Frustum = ConvexRegion<Scalar>;
    using View [[deprecated("Frustum")]] = Frustum;

    /// Also finds proxies within `margin` [m] of the volume, so that a set may serve for several frames: see
    /// look(). A negative or NaN margin counts as 0.
    explicit Culler(Scalar margin = 0);

    // --- Once a frame ----------------------------------------------------------------------------

    /// Finds the proxies that touch the frustum and pass the filter, or keeps the last set where it is known
    /// to hold them all: the frustum lies within the last set's volume, grown by the margin, no proxy was
    /// added or removed since (Grid::populationNumber()), and none can have come in. `moved` [m] is how far
    /// any corner of a box of the grid may have moved since the last call; infinite when this is unknown, or
    /// the filter has changed. A Touch::byPlanes region takes less time than an exact one. With
    /// Containment::inside no set is kept. Returns the query's cost, zeros when the set was kept. Cost: the
    /// cells at the surface of the volume; at most one test for each proxy (Grid::visit()).
    QueryCost look(const Grid<Scalar>& grid, const Frustum& frustum,
                   Scalar moved = std::numeric_limits<Scalar>::infinity());
    QueryCost look(const Grid<Scalar>& grid, const Frustum& frustum, ProxyFilter filter,
                   Scalar moved = std::numeric_limits<Scalar>::infinity());

    /// Says that corners of boxes may have moved by up to `moved` [m] in a frame without a look().
    void noteMoves(Scalar moved) noexcept;

    /// Takes the proxy with that index out of the set. Call it for a removed proxy where the set is read
    /// before the next look().
    void forget(std::uint32_t index) noexcept {
        if (index / 64 < bits_.size()) {
            bits_[index / 64] &= ~(std::uint64_t{1} << index % 64);
        }
    }

    /// How often look() has found a new set instead of keeping the last one.
    [[nodiscard]] std::uint64_t findCount() const noexcept { return findCount_; }

    /// With true, look() goes on with the volume of the last look() while the camera moves, so that you can
    /// see the set from outside, until a call with false. Boxes that move are still found.
    void freeze(bool isFrozen) noexcept { isFrozen_ = isFrozen; }
    [[nodiscard]] bool isFrozen() const noexcept { return isFrozen_; }

    // --- The visible set -------------------------------------------------------------------------

    /// True when the proxy is in the set. A proxy removed since stays in the set until the next look() or
    /// forget(); until then a new proxy with its index is taken for it.
    [[nodiscard]] bool isVisible(ProxyId id) const noexcept {
        return id.index / 64 < bits_.size() && (bits_[id.index / 64] >> (id.index % 64) & 1) != 0;
    }

    /// Bit i % 64 of word i / 64 tells whether the proxy with index i is in the set; none is beyond the end.
    [[nodiscard]] std::span<const std::uint64_t> bits() const noexcept { return bits_; }

    /// Number of proxies in the set.
    [[nodiscard]] std::size_t count() const noexcept;

    /// Calls visit(index) for the ProxyId::index of every proxy in the set, ascending; Grid::idAt() returns
    /// its id. visit() must not call look() (asserted). Cost: a 64th of the highest index in the set, and the
    /// calls.
    template <class Visit>
    void forEach(Visit&& visit) const {
        const detail::QueryScope scope(this);
        for (std::size_t word = 0; word < bits_.size(); ++word) {
            for (std::uint64_t bits = bits_[word]; bits != 0; bits &= bits - 1) {
                visit(static_cast<std::uint32_t>(64 * word) +
                      static_cast<std::uint32_t>(std::countr_zero(bits)));
            }
        }
    }

    /// The volume of the last look(), or the frozen one; not grown.
    [[nodiscard]] const Frustum& frustum() const noexcept { return frustum_; }
    [[deprecated("frustum()")]] [[nodiscard]] const Frustum& view() const noexcept {
        return frustum_;
    }

    /// Compares the set with the proxies whose boxes now share a point with frustum(). Cost: that of an
    /// exact query.
    [[nodiscard]] Overdraw overdraw(const Grid<Scalar>& grid) const;

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + bits_.capacity() * sizeof(std::uint64_t);
    }

private:
    [[nodiscard]] bool begin(const Grid<Scalar>& grid, const Frustum& frustum, Scalar moved);
    [[nodiscard]] bool keepsSet() const;

    Scalar margin_;
    Scalar moved_;  // since the set was found
    Frustum frustum_;
    Frustum grown_;  // in which the set was found
    bool isFrozen_ = false;
    std::uint64_t findCount_ = 0;
    std::uint64_t population_ = 0;  // of which the set was found
    std::vector<std::uint64_t> bits_;
    detail::PeakWatch peaks_;
};

extern template class Culler<float>;
extern template class Culler<double>;

}  // namespace hashphase
