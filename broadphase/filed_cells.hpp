// SPDX-License-Identifier: Zlib
#pragma once

// Lists the cells of the hash that contain proxies, with the number of proxies in each: for drawing, or to find
// crowds.
//
//     for (const FiledCell<float>& cell : filedCells(grid).cells) { draw(cell.box, cell.load); }
//
// Cells     The grid files resting and mobile proxies separately, each in cells of several sizes, so cells overlap.
//           No edge of a proxy is longer than the edges of its cell. If cells along an axis would hold few proxies,
//           for example vertically on a terrain, one cell may span all proxies of its size.
// A proxy   is filed in the cell that contains the min corner of its box. A trembling proxy is filed by a larger box,
//           within which it moves (GridConfig::slack).
// Unfiled   Some proxies are in no cell, and every query reads them: the largest proxies, all proxies of a grid with
//           fewer than about 32, and proxies that changed since an update or a query last filed them.

#include <broadphase/aabb.hpp>
#include <broadphase/export.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/proxy_id.hpp>

#include <cstddef>
#include <vector>

namespace hashphase {

/// A cell that has proxies.
template <class Scalar>
struct FiledCell {
    Aabb<Scalar> box;      ///< from the cell's min corner to its max corner [m]
    std::size_t load = 0;  ///< number of proxies filed in the cell; at least 1
};

/// Where all proxies are filed, except proxies with a NaN box.
template <class Scalar>
struct FiledCells {
    std::vector<FiledCell<Scalar>> cells;  ///< the fullest cell first
    std::vector<ProxyId> unfiled;          ///< proxies in no cell, in ascending order
};

/// Lists all cells that contain proxies, and the proxies in no cell. Changes nothing: unlike a query, it never files
/// changed proxies. Threads: as queries. Cost: O(n log n).
template <class Scalar>
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT FiledCells<Scalar> filedCells(const Grid<Scalar>& grid);

extern template FiledCells<float> filedCells(const Grid<float>&);
extern template FiledCells<double> filedCells(const Grid<double>&);

}  // namespace hashphase
