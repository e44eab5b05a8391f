// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies that a camera sees: proxies whose boxes touch the frustum, or another convex volume.
//
// Exact     The set contains every proxy that the filter accepts and whose box touches the volume. The set may also
//           contain other proxies: near an edge of the volume, within the margin, or from an earlier frame.
//           overdraw() counts these other proxies. If the volume has Containment::inside, "touches" in this header
//           means "lies wholly inside".
// Frame     Call look() once a frame, with the current frustum.
// Threads   During look(), other threads may query the grid, but must not change the grid or use this object.
// Units     metres
// Bad data  The set is empty if the volume has a NaN, or contains no point. frustumError() explains faults of a
//           camera's matrix.
// Memory    One bit for each index up to the highest visible index. Allocates only if a frame needs more than before.
//           After 256 consecutive searches that need less than an eighth of the memory, look() frees the unused
//           memory.

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

/// Shows how exact the visible set is.
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

    /// look() also finds proxies at most `margin` [m] outside the volume. A positive margin allows look() to keep the
    /// set for several frames. A negative or NaN margin counts as 0.
    explicit Culler(Scalar margin = 0);

    // --- Once a frame ----------------------------------------------------------------------------

    /// Finds the proxies whose boxes touch the frustum and which the filter accepts. Keeps the last set if it
    /// certainly contains all these proxies: the frustum is within the last searched volume (margin included), no
    /// proxy was added or removed since (Grid::populationNumber()), and no box can have moved into the frustum. If
    /// the frustum has Containment::inside, look() always searches. Touch::byPlanes is faster than Touch::exact.
    ///
    /// `moved` [m] is the largest distance that a corner of a box may have moved since the last look() or
    /// noteMoves(). Pass infinity if the distance is unknown, or the filter has changed. Returns the query's cost:
    /// zeros if the set was kept. Asserted: neither the filter nor visit() of forEach() calls look(). Cost:
    /// Grid::visit() of the volume, which tests only boxes in cells at the volume's surface.
    QueryCost look(const Grid<Scalar>& grid, const Frustum& frustum,
                   Scalar moved = std::numeric_limits<Scalar>::infinity());
    QueryCost look(const Grid<Scalar>& grid, const Frustum& frustum, ProxyFilter filter,
                   Scalar moved = std::numeric_limits<Scalar>::infinity());

    /// Adds `moved` [m] (as in look()) to the movement since the last search. Call it in a frame without look(), or
    /// include that frame's movement in `moved` of the next look().
    void noteMoves(Scalar moved) noexcept;

    /// Removes the proxy with this index from the set. Call it after you remove the proxy from the grid, if you read
    /// the set before the next look().
    void forget(std::uint32_t index) noexcept {
        if (index / 64 < bits_.size()) {
            bits_[index / 64] &= ~(std::uint64_t{1} << index % 64);
        }
    }

    /// Number of times that look() searched the grid.
    [[nodiscard]] std::uint64_t findCount() const noexcept { return findCount_; }

    /// While frozen, look() ignores its argument `frustum` and keeps frustum(), so that you can see the set from
    /// outside. look() still finds boxes that move into frustum().
    void freeze(bool isFrozen) noexcept { isFrozen_ = isFrozen; }
    [[nodiscard]] bool isFrozen() const noexcept { return isFrozen_; }

    // --- The visible set -------------------------------------------------------------------------

    /// Returns whether the proxy is in the set. Until the next look() or forget(), also returns true for a removed
    /// proxy of the set, and for a new proxy with the same index.
    [[nodiscard]] bool isVisible(ProxyId id) const noexcept {
        return id.index / 64 < bits_.size() && (bits_[id.index / 64] >> (id.index % 64) & 1) != 0;
    }

    /// Bit i % 64 of word i / 64 is set if the proxy with index i is in the set. Proxies with indices beyond the end
    /// are not in the set.
    [[nodiscard]] std::span<const std::uint64_t> bits() const noexcept { return bits_; }

    [[nodiscard]] std::size_t count() const noexcept;

    /// Calls visit(index) with the ProxyId::index of every proxy in the set, in ascending order. Grid::idAt() returns
    /// the proxy's id. Asserted: visit() does not call look(). Cost: O(indices / 64), and the calls.
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

    /// The volume of the last look(), without the margin. While frozen, the frozen volume.
    [[nodiscard]] const Frustum& frustum() const noexcept { return frustum_; }
    [[deprecated("frustum()")]] [[nodiscard]] const Frustum& view() const noexcept {
        return frustum_;
    }

    /// Compares the set with the proxies whose boxes touch frustum() now. Cost: Grid::visit() of frustum().
    [[nodiscard]] Overdraw overdraw(const Grid<Scalar>& grid) const;

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + bits_.capacity() * sizeof(std::uint64_t);
    }

private:
    [[nodiscard]] bool begin(const Grid<Scalar>& grid, const Frustum& frustum, Scalar moved);
    [[nodiscard]] bool keepsSet() const;

    Scalar margin_;
    Scalar moved_;  // largest movement of a corner since the last search [m]
    Frustum frustum_;
    Frustum grown_;  // the last searched volume, margin included
    bool isFrozen_ = false;
    std::uint64_t findCount_ = 0;
    std::uint64_t population_ = 0;  // Grid::populationNumber() at the last search
    std::vector<std::uint64_t> bits_;
    detail::PeakWatch peaks_;
};

extern template class Culler<float>;
extern template class Culler<double>;

}  // namespace hashphase
