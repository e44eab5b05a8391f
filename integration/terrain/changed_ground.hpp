// SPDX-License-Identifier: Zlib
#pragma once

// Where the ground of a terrain has changed, and what may stand there: for games that let bodies fall when the
// ground below is taken away, and wake them when it rises.
//
//     ChangedGround<float> changed(terrain);  // once: from now on changes are noted
//     terrain.remove(crater.first, crater.count);
//     changed.findStanding(grid, 0.05F, standing);
//     changed.clear();
//
// A frame    Change the terrain, update the grids, and then findStanding() in each grid with bodies; clear() at
//            last. Without clear() the same bodies are found again, and more of them. findStanding() before the
//            update finds the same, but may cost as much as another update.
// Notes      The box of each triangle that was added, of each that was removed, and of each that was replaced
//            by another, before and after. A box that makes one box with the previous one is joined to it. A shift
//            of the origin is no change, and shifts them.
// Memory     Is taken once, when this is made. Where there is no room for another box, each two that follow
//            each other become one that holds both: more may be found than stands there, and never less.
// Units      metres
// Threads    Const functions may run on any number of threads. Changes of the terrain need this for themselves.
// Misuse     A reach that is negative or NaN is asserted, and finds nothing. The terrain must outlive this
//            (asserted).

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

/// Notes where the ground changes while it lives, and finds what stands there.
template <class Scalar>
class HASHPHASE_TERRAIN_TEMPLATE_EXPORT ChangedGround {
public:
    using Box = Aabb<Scalar>;

    /// Takes room for so many boxes, at least 2, of 24 bytes each, or 48 in double precision.
    explicit ChangedGround(Terrain<Scalar>& terrain, std::size_t mostBoxes = 16384);
    ~ChangedGround();
    ChangedGround(const ChangedGround&) = delete;
    ChangedGround& operator=(const ChangedGround&) = delete;

    /// Where the ground has changed since clear(), in the order of the changes.
    [[nodiscard]] std::span<const Box> boxes() const noexcept { return boxes_; }

    /// Finds the proxies of a grid, of the terrain's or of any other, whose boxes touch one of boxes() when it
    /// is grown by `reach` [m] on all sides. Replaces `standing` by them, sorted, each once, without the
    /// terrain's own. `filter` is asked about each of them once. Returns the cost. Cost: as Grid::visit() for
    /// each of boxes(), and sorting what is found.
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
