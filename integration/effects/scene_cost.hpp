// SPDX-License-Identifier: Zlib
#pragma once

// Counters of the work in a scene's frame, and the bytes of the scene's tables. Each counter and table belongs to one
// or more effects, and is exactly 0 if none of these effects is declared. Exception: every scene has the table
// `bodies`.
//
//     const SceneCost& cost = simulation.advance(1.0F / 60);
//     std::uint64_t born = cost[SceneCounter::pairsBorn];
//
// Threads  These types are values: each thread may use its own copies.

#include <integration/effects/effect.hpp>
#include <integration/effects/export.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hashphase {

/// The effects that query a grid. A Simulation has a grid while any of these effects is declared.
inline constexpr EffectSet kGridEffects{
    Effect::pairs,     Effect::picking, Effect::boxSelection, Effect::culling,
    Effect::proximity, Effect::zones,   Effect::radar,
};

/// The work of a frame. sceneCounters() lists all counters, each with the effects to which it belongs.
enum class SceneCounter : std::uint8_t {
    // Bodies.
    bodiesMoved,      ///< bodies that moved by their velocities
    fellAsleep,       ///< bodies that fell asleep
    wokeUp,           ///< sleeping bodies that woke up
    sleepersAsked,    ///< sleeping bodies tested for waking
    groundsAsked,     ///< bodies for which the ground was queried
    trianglesTested,  ///< triangles tested in ground queries
    // The grid and its pairs.
    proxiesHashed,    ///< boxes passed to Grid::move()
    entriesFiled,     ///< entries written into the grid's tables
    cellRowsVisited,  ///< rows of cells (for rays: blocks of boxes) read by picks, selections, culling, zones, radar
    boxesTested,      ///< boxes tested for pairs
    pairsWatched,     ///< existing pairs tested for overlap
    couplesWatched [[deprecated("pairsWatched")]] = pairsWatched,
    pairsBorn,         ///< pairs that began
    pairsDied,         ///< pairs that ended
    contactsTested,    ///< pairs of spheres tested for contact
    contactsSolved,    ///< pairs of spheres that bounced
    sweepsSolved,      ///< bodies that swept a path
    sweepBoxesTested,  ///< boxes tested on the paths of swept bodies
    sweepersStopped,   ///< swept bodies that hit a body instead of passing through it
    // Picks and selections since the previous frame.
    picks,                 ///< picking rays
    pickBoxesTested,       ///< boxes tested for picking rays
    selections,            ///< drag rectangles
    selectionBoxesTested,  ///< boxes tested for drag rectangles
    // Culling.
    viewsFound,          ///< 1 if culling searched the grid, 0 if the visible set was kept
    cellRowsCulled,      ///< rows of cells read by culling
    cullingBoxesTested,  ///< boxes tested against the view
    framesCulledLate,    ///< 1 if restingCameraFrames skipped the search, so the set is old
    // Proximity.
    agentsScanned,     ///< agents that searched and, if ProximityEffect::turns is 1, late agents near them
    neighboursTested,  ///< tested distances between agents
    agentsLate,        ///< agents that did not search: far, or not their turn
    // Zones.
    zonesTested,      ///< zones searched
    zoneBoxesTested,  ///< boxes tested for searched zones
    zonesLate,        ///< far zones not searched in this frame
    // Radar.
    radarScans,        ///< 1 if the radar was scanned
    radarBoxesTested,  ///< boxes tested by the radar
    radarsLate,        ///< 1 if the counts are from an earlier frame
};

/// Tables that hold a scene's data. sceneTables() lists all tables, each with the effects to which it belongs.
enum class SceneTable : std::uint8_t {
    bodies,      ///< positions, radii, and the effects that each body takes part in
    velocities,  ///< velocities of all bodies
    movers,      ///< list of awake bodies
    sleepers,    ///< sleep states of bodies, and their numbers of slow frames
    ground,      ///< triangles and their grid
    walkers,     ///< positions at which the ground is queried, and results
    proxies,     ///< ids of the bodies' proxies
    grid,        ///< boxes, and the tables of cells
    pairs,       ///< pairs, and their changes
    contacts,    ///< list of present pairs
    sweeps,      ///< paths, and scratch memory of the search along them
    sweepers,    ///< bodies that sweep in this frame
    rayTrees,    ///< trees over the grid, which only rays read
    visible,     ///< visible set: a bit for each body
    agents,      ///< positions of agents, sorted by cell; counts of neighbours; colours
    zones,       ///< zones, their occupants, and events
    radar,       ///< counts by cell and group
    groups,      ///< the radar group of each body
};

/// A counter or table, and the effects to which it belongs.
struct SceneItem {
    std::string_view name;         ///< spelled like the enumerator: "bodiesMoved"
    EffectSet owners;              ///< empty: every scene has the item
    std::string_view description;  ///< a few words in English
};

/// Number of counters, and number of tables.
inline constexpr std::size_t kSceneCounterCount = 35;
inline constexpr std::size_t kSceneTableCount = 18;

/// Return all items in the order of their enumerators, for reports and profilers.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT const std::array<SceneItem, kSceneCounterCount>&
sceneCounters() noexcept;
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT const std::array<SceneItem, kSceneTableCount>&
sceneTables() noexcept;

/// One number for each Item (SceneCounter or SceneTable), of one frame or summed over frames. All numbers are 0 at
/// first. Operator [] does not check that the item is valid.
template <class Item, std::size_t count>
class SceneNumbers {
public:
    [[nodiscard]] std::uint64_t operator[](Item item) const noexcept {
        return numbers_[static_cast<std::size_t>(item)];
    }
    [[nodiscard]] std::uint64_t& operator[](Item item) noexcept {
        return numbers_[static_cast<std::size_t>(item)];
    }
    SceneNumbers& operator+=(const SceneNumbers& other) noexcept {
        for (std::size_t i = 0; i < count; ++i) {
            numbers_[i] += other.numbers_[i];
        }
        return *this;
    }
    friend bool operator==(const SceneNumbers&, const SceneNumbers&) = default;

private:
    std::array<std::uint64_t, count> numbers_{};
};

/// The value of each counter, for one frame or several.
using SceneCost = SceneNumbers<SceneCounter, kSceneCounterCount>;

/// Memory of each table [bytes], capacity included: see Simulation::footprint().
using SceneFootprint = SceneNumbers<SceneTable, kSceneTableCount>;

/// Returns the sum over all tables [bytes].
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::uint64_t totalBytes(
    const SceneFootprint& footprint) noexcept;

}  // namespace hashphase
