// SPDX-License-Identifier: Zlib
#pragma once

// Which cells of the hash have proxies, and how many: to draw them, or to see what is crowded.
//
//     for (const FiledCell<float>& cell : filedCells(grid).cells) { draw(cell.box, cell.load); }
//
// Cells     The grid files resting and moving proxies apart, each in cells of several sizes, so cells overlap. No edge
//           of a proxy is longer than the edges of its cell. A cell may reach through all proxies of its size along an
//           axis: the vertical one on a terrain, where cells above each other would hold few.
// A proxy   is filed in one cell: that of the least corner of its box, or of a box around the places where it trembles.
// Unfiled   Some proxies are in no cell, and every query reads them: the largest ones, all of a grid that has fewer
//           than about 32, and those that have changed since they were last filed, by an update or by queries.

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
    Aabb<Scalar> box;      ///< from its least corner to its greatest [m]
    std::size_t load = 0;  ///< how many proxies are filed in it; at least 1
};

/// Where all proxies are, but those with a NaN box.
template <class Scalar>
struct FiledCells {
    std::vector<FiledCell<Scalar>> cells;  ///< the fullest first
    std::vector<ProxyId> unfiled;          ///< in ascending order
};

/// Lists all cells that have proxies, and the proxies in no cell. Changes nothing: it files no changed proxies, as
/// queries may. Threads: as queries. Cost: O(n log n).
template <class Scalar>
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT FiledCells<Scalar> filedCells(const Grid<Scalar>& grid);

extern template FiledCells<float> filedCells(const Grid<float>&);
extern template FiledCells<double> filedCells(const Grid<double>&);

}  // namespace hashphase
