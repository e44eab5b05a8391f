// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies that a camera sees: their boxes touch its frustum, or another convex volume.
//
// Exact     Every proxy whose box touches the volume is in the set. So are a few others: near an edge of the volume,
//           from a margin, or from an earlier frame. overdraw() counts them.
// Frame     Call look() once, with the camera of the frame.
// Threads   look() reads the grid, as queries do, and needs this object for itself.
// Units     metres
// Bad data  With a volume without a point, or with a NaN, the set is empty. frustumError() returns the reason.
// Memory    A bit for each index up to the highest visible one. A frame like the last one allocates nothing. Room for
//           more than eight times the need is released after 256 searches.

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

/// Finds the set of proxies that a camera sees, and keeps it.
template <class Scalar>
class HASHPHASE_CULLING_TEMPLATE_EXPORT Culler {
public:
    using Frustum = ConvexRegion<Scalar>;
    using View [[deprecated("Frustum")]] = Frustum;

    /// With a `margin` [m], look() also finds proxies at most that far from the volume, and may keep the set for
    /// several frames. A negative or NaN margin counts as 0.
    explicit Culler(Scalar margin = 0);

    // --- Once a frame ----------------------------------------------------------------------------

    /// Finds the proxies that touch the frustum and pass the filter, or keeps the last set if it certainly contains
    /// them: the frustum is within the last set's volume, grown by the margin, no proxy was added or removed
    /// (Grid::populationNumber()), and none can have come in. With Containment::inside no set is kept.
    /// Touch::byPlanes is faster than exact.
    ///
    /// `moved` [m] is how far any corner of a box may have moved since the last call; infinite if unknown, or if the
    /// filter has changed. Returns the query's cost, zeros if the set was kept. Asserted: not called from the filter
    /// or forEach(). Cost: Grid::visit() of the volume; only boxes in cells at its surface are tested.
    QueryCost look(const Grid<Scalar>& grid, const Frustum& frustum,
                   Scalar moved = std::numeric_limits<Scalar>::infinity());
    QueryCost look(const Grid<Scalar>& grid, const Frustum& frustum, ProxyFilter filter,
                   Scalar moved = std::numeric_limits<Scalar>::infinity());

    /// Notes that corners of boxes may have moved by up to `moved` [m] in a frame without look().
    void noteMoves(Scalar moved) noexcept;

    /// Removes the proxy with that index from the set. Call it for a removed proxy if you read the set before the
    /// next look().
    void forget(std::uint32_t index) noexcept {
        if (index / 64 < bits_.size()) {
            bits_[index / 64] &= ~(std::uint64_t{1} << index % 64);
        }
    }

    /// Number of times that look() has searched, instead of keeping the set.
    [[nodiscard]] std::uint64_t findCount() const noexcept { return findCount_; }

    /// While frozen, look() keeps its volume, whatever the camera does, so that you see the set from outside. Moving
    /// boxes are still found.
    void freeze(bool isFrozen) noexcept { isFrozen_ = isFrozen; }
    [[nodiscard]] bool isFrozen() const noexcept { return isFrozen_; }

    // --- The visible set -------------------------------------------------------------------------

    /// Returns whether the proxy is in the set. A removed proxy is, until the next look() or forget(), and so is a
    /// new proxy with its index.
    [[nodiscard]] bool isVisible(ProxyId id) const noexcept {
        return id.index / 64 < bits_.size() && (bits_[id.index / 64] >> (id.index % 64) & 1) != 0;
    }

    /// Bit i % 64 of word i / 64 is set if the proxy with index i is in the set. No index beyond the end is.
    [[nodiscard]] std::span<const std::uint64_t> bits() const noexcept { return bits_; }

    [[nodiscard]] std::size_t count() const noexcept;

    /// Calls visit(index) for the ProxyId::index of every proxy in the set, ascending. Grid::idAt() returns its id.
    /// Asserted: visit() does not call look(). Cost: a 64th of the highest index, and the calls.
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

    /// The volume of the last look(), or the frozen one, without the margin.
    [[nodiscard]] const Frustum& frustum() const noexcept { return frustum_; }
    [[deprecated("frustum()")]] [[nodiscard]] const Frustum& view() const noexcept {
        return frustum_;
    }

    /// Compares the set with the proxies whose boxes touch frustum() now. Cost: as an exact query.
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
