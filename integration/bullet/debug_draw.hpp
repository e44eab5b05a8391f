// SPDX-License-Identifier: Zlib
#pragma once

// The cells of the grid in Bullet's own debug drawing:
//
//     world.debugDrawWorld();
//     hashphase::drawCells(broadphase, *world.getDebugDrawer());
//
// Cells     Each cell that has proxies, in a colour by its load, the number of proxies filed in it: dark blue for one,
//           yellow for eight and more; where a cell has more than eight, yellow is the fullest. See filedCells()
//           (filed_cells.hpp).
// Unfiled   Proxies in no cell are drawn as their boxes, red. Every query reads them all, so many of them are slow.
// When      After stepSimulation(), cells are those of its last substep. Proxies that you have moved since are unfiled,
//           until an update or queries file them.
// Lines     A box has 12. The fullest cells come first, then unfiled proxies, then other proxies; beyond
//           CellDrawing::mostLines nothing is drawn.

#include <integration/bullet/export.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <LinearMath/btIDebugDraw.h>

#include <cstddef>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// What drawCells() draws.
struct CellDrawing {
    /// Draws the boxes of all proxies too, as the grid has them: with their margins, and around the ways of fast
    /// bodies. Resting proxies are grey, others light blue.
    bool boxes = false;

    /// At most so many lines are drawn, each cell and box as a whole. The default is 5,000 cells and boxes.
    std::size_t mostLines = 60'000;
};

/// What there is to draw, and how much of it was drawn.
struct DrawnCells {
    std::size_t cells = 0;         ///< that have proxies
    std::size_t largestLoad = 0;   ///< of a cell
    std::size_t unfiled = 0;       ///< proxies in no cell
    std::size_t lines = 0;         ///< drawn
    std::size_t linesLeftOut = 0;  ///< beyond CellDrawing::mostLines
};

/// Draws the cells that have proxies, and the proxies in no cell, by drawer.drawAabb(); then calls
/// drawer.flushLines(). Boxes that are infinite, or NaN, are not drawn. The drawer must not change the broadphase.
/// Cost: O(n log n) for n proxies, and the lines.
HASHPHASE_BULLET_EXPORT DrawnCells drawCells(const SpatialHashBroadphase& broadphase,
                                             btIDebugDraw& drawer, const CellDrawing& options = {});

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
