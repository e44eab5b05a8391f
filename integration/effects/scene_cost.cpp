// SPDX-License-Identifier: Zlib
#include <integration/effects/scene_cost.hpp>

namespace hashphase {

const std::array<SceneItem, kSceneCounterCount>& sceneCounters() noexcept {
    using enum Effect;
    static constexpr std::array<SceneItem, kSceneCounterCount> kItems{{
        {"bodiesMoved", {motion}, "bodies moved by their velocities"},
        {"fellAsleep", {sleeping}, "bodies that fell asleep"},
        {"wokeUp", {sleeping}, "bodies that woke up"},
        {"sleepersAsked", {sleeping}, "sleeping bodies tested for waking up"},
        {"groundsAsked", {terrain}, "bodies for which the ground was queried"},
        {"trianglesTested", {terrain}, "triangles tested in these queries"},
        {"proxiesHashed", kGridEffects, "boxes set in the grid"},
        {"entriesFiled", kGridEffects, "entries written into the grid's tables"},
        {"cellRowsVisited",
         {picking, boxSelection, culling, zones, radar},
         "rows of cells, or for rays blocks of boxes, that queries read"},
        {"boxesTested", {pairs}, "boxes tested for pairs"},
        {"pairsWatched", {pairs}, "pairs tested for still overlapping"},
        {"pairsBorn", {pairs}, "pairs that began"},
        {"pairsDied", {pairs}, "pairs that ended"},
        {"contactsTested", {response}, "pairs of bodies tested for touching"},
        {"contactsSolved", {response}, "pairs of bodies that bounced"},
        {"sweepsSolved", {sweep}, "bodies that swept"},
        {"sweepBoxesTested", {sweep}, "boxes tested along the paths of these bodies"},
        {"sweepersStopped", {sweep}, "swept bodies that hit a body instead of passing through it"},
        {"picks", {picking}, "picking rays since the last frame"},
        {"pickBoxesTested", {picking}, "boxes tested for these rays"},
        {"selections", {boxSelection}, "selection rectangles since the last frame"},
        {"selectionBoxesTested", {boxSelection}, "boxes tested for these rectangles"},
        {"viewsFound", {culling}, "1 if the visible set was found again, 0 if it was kept"},
        {"cellRowsCulled", {culling}, "rows of cells that culling read"},
        {"cullingBoxesTested", {culling}, "boxes tested against the view"},
        {"framesCulledLate", {culling}, "1 if the visible set is of an earlier frame, as declared"},
        {"agentsScanned", {proximity}, "agents that searched for neighbours, or were searched for"},
        {"neighboursTested", {proximity}, "distances tested"},
        {"agentsLate",
         {proximity},
         "agents that did not search in this frame: far away, or not their turn"},
        {"zonesTested", {zones}, "zones searched"},
        {"zoneBoxesTested", {zones}, "boxes tested for these zones"},
        {"zonesLate", {zones}, "far zones not searched in this frame"},
        {"radarScans", {radar}, "1 if the radar was scanned"},
        {"radarBoxesTested", {radar}, "boxes tested for the scan"},
        {"radarsLate", {radar}, "1 if the counts are of an earlier frame"},
    }};
    return kItems;
}

const std::array<SceneItem, kSceneTableCount>& sceneTables() noexcept {
    using enum Effect;
    static constexpr std::array<SceneItem, kSceneTableCount> kItems{{
        {"bodies", {}, "positions, radii and effects of each body"},
        {"velocities", {motion}, "velocities of all bodies"},
        {"movers", {motion}, "list of awake bodies"},
        {"sleepers", {sleeping}, "sleeping bodies, and how long others have been slow"},
        {"ground", {terrain}, "triangles and their grid"},
        {"walkers", {terrain}, "positions on the ground that are asked for, and the answers"},
        {"proxies", kGridEffects, "ids of the bodies in the grid"},
        {"grid", kGridEffects, "boxes, and tables of boxes"},
        {"pairs", {pairs}, "watched pairs, and changes of pairs"},
        {"contacts", {response}, "the present pairs"},
        {"sweeps", {sweep}, "paths, and scratch of the search along them"},
        {"sweepers", {sweep}, "bodies that sweep in this frame"},
        {"rayTrees", {picking}, "trees over the grid, which only rays read"},
        {"visible", {culling}, "a bit for each body"},
        {"agents", {proximity}, "positions by cell, counts, and colours"},
        {"zones", {zones}, "zones, their occupants and events"},
        {"radar", {radar}, "counts"},
        {"groups", {radar}, "groups of bodies, for the radar"},
    }};
    return kItems;
}

std::uint64_t totalBytes(const SceneFootprint& footprint) noexcept {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < kSceneTableCount; ++i) {
        sum += footprint[static_cast<SceneTable>(i)];
    }
    return sum;
}

}  // namespace hashphase
