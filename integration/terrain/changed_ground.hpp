// SPDX-License-Identifier: Zlib
#pragma once

// Finds where the ground of a terrain has changed, and the proxies that may stand there: wake them, or let them fall.
//
// Frame    Change the terrain, update the grids, call findStanding() for each grid with bodies, then clear(). Without
//          clear(), the next call finds them again, and more. Before the update, results are equal, but may cost as
//          much as another update.
// Notes    The boxes of added and removed triangles, and of replaced ones before and after. Consecutive boxes that
//          make one box are joined. A shift of the origin shifts them.
// Memory   Taken once, by the constructor. If it is full, each two consecutive boxes become the box around both: more
//          proxies may be found, never fewer.
// Units    metres
// Threads  Const functions may run on any number of threads. Changes of the terrain need this object for themselves.
// Misuse   Asserted: a reach is 0 or more, else findStanding() finds nothing; the terrain outlives this object.

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

/// Notes changes of the ground while it lives, and finds proxies there.
template <class Scalar>
class HASHPHASE_TERRAIN_TEMPLATE_EXPORT ChangedGround {
public:
    using Box = Aabb<Scalar>;

    /// Takes room for `mostBoxes`, at least 2, of 24 bytes each, 48 in double precision.
    explicit ChangedGround(Terrain<Scalar>& terrain, std::size_t mostBoxes = 16384);
    ~ChangedGround();
    ChangedGround(const ChangedGround&) = delete;
    ChangedGround& operator=(const ChangedGround&) = delete;

    /// Places where the ground has changed since clear(), in the order of changes.
    [[nodiscard]] std::span<const Box> boxes() const noexcept { return boxes_; }

    /// Finds the proxies of any grid whose boxes touch one of boxes(), grown by `reach` [m] on all sides. Replaces
    /// `standing`: sorted, each once, without the terrain's own. `filter` is asked once about each. Returns the cost.
    /// Cost: as Grid::visit() for each of boxes(), and sorting the result.
    QueryCost findStanding(const Grid<Scalar>& grid, std::type_identity_t<Scalar> reach,
                           std::vector<ProxyId>& standing, ProxyFilter filter = acceptAll) const;

    /// Forgets all changes. Cost: O(1).
    void clear() noexcept { boxes_.clear(); }

    /// Bytes held.
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
