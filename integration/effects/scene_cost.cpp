// SPDX-License-Identifier: Zlib
#include <integration/effects/scene_cost.hpp>

namespace hashphase {

const std::array<SceneItem, kSceneCounterCount>& sceneCounters() noexcept {
    using enum Effect;
    static constexpr std::array<SceneItem, kSceneCounterCount> kItems{{
        {"bodiesMoved", {motion}, "bodies that went on with their velocities"},
        {"fellAsleep", {sleeping}, "bodies that stopped"},
        {"wokeUp", {sleeping}, "bodies that went on"},
        {"sleepersAsked", {sleeping}, "sleeping bodies looked at, whether they are to wake"},
        {"groundsAsked", {terrain}, "bodies put on the ground"},
        {"trianglesTested", {terrain}, "triangles tested for them"},
        {"proxiesHashed", kGridEffects, "boxes set in the grid"},
        {"entriesFiled", kGridEffects, "entries written into the grid's tables"},
        {"cellRowsVisited",
         {picking, boxSelection, culling, zones, radar},
         "rows of cells looked at by all that ask, or a ray's blocks of boxes"},
        {"boxesTested", {pairs}, "boxes tested for pairs"},
        {"pairsWatched", {pairs}, "pairs tested whether they still overlap"},
        {"pairsBorn", {pairs}, "pairs that began"},
        {"pairsDied", {pairs}, "pairs that ended"},
        {"contactsTested", {response}, "pairs of bodies tested whether they touch"},
        {"contactsSolved", {response}, "of these, bounces"},
        {"sweepsSolved", {sweep}, "bodies that swept"},
        {"sweepBoxesTested", {sweep}, "boxes tested along their ways"},
        {"sweepersStopped",
         {sweep},
         "of these, those that met whom they do not touch at the end of their way"},
        {"picks", {picking}, "rays asked since the frame before"},
        {"pickBoxesTested", {picking}, "boxes tested for them"},
        {"selections", {boxSelection}, "rectangles asked since the frame before"},
        {"selectionBoxesTested", {boxSelection}, "boxes tested for them"},
        {"viewsFound", {culling}, "1 where the visible set was found anew"},
        {"cellRowsCulled", {culling}, "rows of cells looked at"},
        {"cullingBoxesTested", {culling}, "boxes tested against the view"},
        {"framesCulledLate",
         {culling},
         "1 where the set is one of an earlier frame, by declaration"},
        {"agentsScanned", {proximity}, "agents that looked around, or were looked at"},
        {"neighboursTested", {proximity}, "distances tested"},
        {"agentsLate",
         {proximity},
         "agents that did not look around in this frame: far ones, or out of turn"},
        {"zonesTested", {zones}, "zones looked into"},
        {"zoneBoxesTested", {zones}, "boxes tested for them"},
        {"zonesLate", {zones}, "far zones not looked into in this frame"},
        {"radarScans", {radar}, "1 where the radar was scanned"},
        {"radarBoxesTested", {radar}, "boxes tested for it"},
        {"radarsLate", {radar}, "1 where the counts are those of an earlier frame"},
    }};
    return kItems;
}

const std::array<SceneItem, kSceneTableCount>& sceneTables() noexcept {
    using enum Effect;
    static constexpr std::array<SceneItem, kSceneTableCount> kItems{{
        {"bodies", {}, "positions, radii, and what each takes part in"},
        {"velocities", {motion}, "of all bodies"},
        {"movers", {motion}, "which bodies are awake"},
        {"sleepers", {sleeping}, "which are asleep, and how long others have been slow"},
        {"ground", {terrain}, "triangles and their grid"},
        {"walkers", {terrain}, "where the ground is asked for, and the answers"},
        {"proxies", kGridEffects, "names of bodies in the grid"},
        {"grid", kGridEffects, "boxes, and tables of them"},
        {"pairs", {pairs}, "pairs that are watched, and changes"},
        {"contacts", {response}, "the present pairs"},
        {"sweeps", {sweep}, "ways, and what is searched along them"},
        {"sweepers", {sweep}, "bodies that sweep in this frame"},
        {"rayTrees", {picking}, "what rays read of the grid"},
        {"visible", {culling}, "a bit for each body"},
        {"agents", {proximity}, "positions by cell, counts, and colours"},
        {"zones", {zones}, "zones, who is in them, events"},
        {"radar", {radar}, "counts"},
        {"groups", {radar}, "of bodies, for the radar"},
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
