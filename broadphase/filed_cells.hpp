// SPDX-License-Identifier: Zlib
#pragma once

// Lists the hash cells that contain proxies, with the number of proxies in each cell. Use it to draw the cells, or to
// find crowds.
//
//     for (const FiledCell<float>& cell : filedCells(grid).cells) { draw(cell.box, cell.load); }
//
// Cells     Resting and mobile proxies have separate cells, both in several sizes, so cells overlap. No edge of a
//           proxy is longer than the edges of its cell. Along y or z, the cells of one size may span all proxies
//           stored in these cells, if this makes searches cheaper: for example vertically on a terrain, where few
//           proxies lie above each other.
// A proxy   is stored in the cell that contains the min corner of its box. For a trembling proxy, the grid uses
//           a larger box, within which the proxy moves (GridConfig::slack).
// Unfiled   Some proxies are in no cell, and every query reads them: the largest proxies, all proxies of a grid with
//           fewer than about 32 proxies, and proxies that changed since the last sort into cells.

#include <broadphase/aabb.hpp>
#include <broadphase/export.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/proxy_id.hpp>

#include <cstddef>
#include <vector>

namespace hashphase {

/// A cell with at least one proxy.
template <class Scalar>
struct FiledCell {
    Aabb<Scalar> box;      ///< from the cell's min corner to its max corner [m]
    std::size_t load = 0;  ///< number of proxies stored in the cell; at least 1
};

/// All cells that contain proxies, and the proxies in no cell. Proxies with a NaN box are in neither list.
template <class Scalar>
struct FiledCells {
    std::vector<FiledCell<Scalar>> cells;  ///< sorted by load, the largest first
    std::vector<ProxyId> unfiled;          ///< proxies in no cell, sorted by id
};

/// Lists all cells that contain proxies, and the proxies in no cell. Unlike a query, it does not sort changed proxies
/// into cells (except to finish an earlier call, such as a shiftOrigin() or a failed update()). Threads: as queries.
/// Cost: O(n log n) for n proxies.
template <class Scalar>
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT FiledCells<Scalar> filedCells(const Grid<Scalar>& grid);

extern template FiledCells<float> filedCells(const Grid<float>&);
extern template FiledCells<double> filedCells(const Grid<double>&);

}  // namespace hashphase
