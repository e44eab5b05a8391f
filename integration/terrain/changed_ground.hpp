// SPDX-License-Identifier: Zlib
#pragma once

// Finds where the ground of a terrain has changed, and the proxies that may stand there. Wake them, or let them fall.
//
// Frame    Change the terrain, update the grids, call findStanding() for each grid with bodies, then call clear().
//          Each findStanding() searches all places that have changed since clear(). If you do not update a grid
//          first, findStanding() finds the same proxies, but may cost as much as an update.
// Boxes    This object keeps the boxes of added and removed triangles, and the old and new boxes of triangles
//          that replace() changed. Consecutive boxes whose union is a box are joined. Terrain::shiftOrigin() shifts
//          the boxes.
// Memory   Allocated once, by the constructor. If the memory is full, the first and the second box become one box
//          around both, as do the third and the fourth, and so on. After that, findStanding() may find more proxies,
//          never fewer.
// Units    metres
// Threads  Const functions may run on several threads at once. During clear() and changes of the terrain, no other
//          thread may use this object.
// Misuse   Asserted: `reach` is 0 or more (otherwise nothing is found), and the terrain outlives this object.

#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/terrain/export.hpp>
#include <integration/terrain/terrain.hpp>

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// Records changes of the ground from construction on, and finds proxies there.
template <class Scalar>
class HASHPHASE_TERRAIN_TEMPLATE_EXPORT ChangedGround {
public:
    using Box = Aabb<Scalar>;

    /// Allocates max(`mostBoxes`, 2) boxes. A box has 24 bytes, or 48 in double precision.
    explicit ChangedGround(Terrain<Scalar>& terrain, std::size_t mostBoxes = 16384);
    ~ChangedGround();
    ChangedGround(const ChangedGround&) = delete;
    ChangedGround& operator=(const ChangedGround&) = delete;

    /// Boxes in which the ground has changed since clear(), in the order of changes.
    [[nodiscard]] std::span<const Box> boxes() const noexcept { return boxes_; }

    /// Grows each of boxes() by `reach` [m] on all sides, and finds the proxies of `grid` whose boxes touch a grown
    /// box. `grid` may be any grid. Never finds the terrain's triangles. Replaces `standing`: each proxy once, sorted
    /// by id. Calls `filter` once for each found proxy. Returns the cost. Cost: Grid::visit() for each of boxes(),
    /// and sorting the result.
    QueryCost findStanding(const Grid<Scalar>& grid, std::type_identity_t<Scalar> reach,
                           std::vector<ProxyId>& standing, ProxyFilter filter = acceptAll) const;

    /// Forgets all changes. Cost: O(1).
    void clear() noexcept { boxes_.clear(); }

    /// Bytes held, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return boxes_.capacity() * sizeof(Box);
    }

private:
    friend class Terrain<Scalar>;
    struct Others;

    void note(const Box& box) noexcept;
    void joinNeighbours() noexcept;
    void shiftOrigin(const Vector3<Scalar>& shift) noexcept;

    Terrain<Scalar>* terrain_;
    std::size_t mostBoxes_;
    std::vector<Box> boxes_;
};

extern template class ChangedGround<float>;
extern template class ChangedGround<double>;

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
