// SPDX-License-Identifier: Zlib
#pragma once

// The cells of the grid in Bullet's own debug drawing:
//
//     world.debugDrawWorld();
//     hashphase::drawCells(broadphase, *world.getDebugDrawer());
//
// Cells     Draws each cell that has proxies. The colour shows the cell's load, the number of proxies in the cell:
//           from dark blue for one proxy to yellow for eight. If a cell has more than eight proxies, yellow
//           means the largest load. See filedCells() (filed_cells.hpp).
// Unfiled   Proxies that are in no cell (unfiled proxies) have red boxes. Every query tests all unfiled proxies:
//           large numbers of unfiled proxies make queries slow.
// When      After stepSimulation(), you see the cells of its last substep. Proxies that you moved afterwards are
//           unfiled until an update or queries sort them into cells.
// Lines     Each box takes 12 lines. The fullest cells come first, then unfiled proxies, then other proxies. After
//           CellDrawing::mostLines lines, no more boxes are drawn.

#include <integration/bullet/export.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <LinearMath/btIDebugDraw.h>

#include <cstddef>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// What drawCells() draws.
struct CellDrawing {
    /// If true, also draws the grid's boxes of all proxies, including margins and the whole path of a fast body.
    /// Resting proxies in cells have grey boxes, and so do proxies that move only within their slack
    /// (GridConfig::slack). All other proxies in cells have light blue boxes.
    bool boxes = false;

    /// The maximum number of lines. Each cell or box is drawn completely or not at all. The default allows 5,000
    /// cells and boxes.
    std::size_t mostLines = 60'000;
};

/// The result of drawCells().
struct DrawnCells {
    std::size_t cells = 0;         ///< number of cells that have proxies, drawn or not
    std::size_t largestLoad = 0;   ///< load of the fullest cell
    std::size_t unfiled = 0;       ///< number of proxies in no cell, drawn or not
    std::size_t lines = 0;         ///< number of lines drawn
    std::size_t linesLeftOut = 0;  ///< lines not drawn because of CellDrawing::mostLines
};

/// Draws the cells that have proxies, and the boxes of unfiled proxies, with drawer.drawAabb(). Calls
/// drawer.flushLines() at the end. Infinite or NaN boxes are not drawn. The drawer must not change the broadphase.
/// Cost: O(n log n) for n proxies, plus the lines.
HASHPHASE_BULLET_EXPORT DrawnCells drawCells(const SpatialHashBroadphase& broadphase,
                                             btIDebugDraw& drawer, const CellDrawing& options = {});

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
