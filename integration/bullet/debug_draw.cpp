// SPDX-License-Identifier: Zlib
#include <integration/bullet/debug_draw.hpp>

#include <broadphase/filed_cells.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/detail/sequential_ramp.hpp>

#include <algorithm>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

// Red, green and blue. People who see no difference between red and green can tell them apart.
const btVector3 kMobile(btScalar(0.34), btScalar(0.71), btScalar(0.91));
const btVector3 kResting(btScalar(0.66), btScalar(0.69), btScalar(0.75));
const btVector3 kUnfiled(btScalar(0.84), btScalar(0.37), btScalar(0));

btVector3 colourOfLoad(std::size_t load, std::size_t full) {
    const auto [red, green, blue] =
        detail::sequentialRgb(static_cast<float>(load) / static_cast<float>(full));
    return btVector3(btScalar(red), btScalar(green), btScalar(blue)) / btScalar(255);
}

/// Draws boxes up to a number of lines.
class BoxDrawer {
public:
    BoxDrawer(btIDebugDraw& drawer, std::size_t mostLines, DrawnCells& drawn)
        : drawer_(drawer), mostLines_(mostLines), drawn_(drawn) {}

    void draw(const Aabb<btScalar>& box, const btVector3& colour) {
        constexpr std::size_t kLines = 12;
        if (!box.min().allFinite() || !box.max().allFinite()) {
            return;
        }
        if (drawn_.lines + kLines > mostLines_) {
            drawn_.linesLeftOut += kLines;
            return;
        }
        drawer_.drawAabb(toBullet(box.min()), toBullet(box.max()), colour);
        drawn_.lines += kLines;
    }

private:
    btIDebugDraw& drawer_;
    std::size_t mostLines_;
    DrawnCells& drawn_;
};

}  // namespace

DrawnCells drawCells(const SpatialHashBroadphase& broadphase, btIDebugDraw& drawer,
                     const CellDrawing& options) {
    const Grid<btScalar>& grid = broadphase.grid();
    const FiledCells<btScalar> filed = filedCells(grid);
    DrawnCells drawn;
    drawn.cells = filed.cells.size();
    drawn.largestLoad = filed.cells.empty() ? 0 : filed.cells.front().load;
    drawn.unfiled = filed.unfiled.size();
    BoxDrawer boxes(drawer, options.mostLines, drawn);
    const std::size_t full = std::max<std::size_t>(drawn.largestLoad, detail::kFullLoad);
    for (const FiledCell<btScalar>& cell : filed.cells) {
        boxes.draw(cell.box, colourOfLoad(cell.load, full));
    }
    for (const ProxyId id : filed.unfiled) {
        boxes.draw(grid.box(id), kUnfiled);
    }
    if (options.boxes) {
        grid.forEach([&](ProxyId id, const Aabb<btScalar>& box) {
            if (!std::binary_search(filed.unfiled.begin(), filed.unfiled.end(), id)) {
                boxes.draw(box, grid.store().proxies.rests(id.index) ? kResting : kMobile);
            }
        });
    }
    drawer.flushLines();
    return drawn;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
