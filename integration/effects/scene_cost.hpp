// SPDX-License-Identifier: Zlib
#pragma once

// Costs of a scene's frame as numbers, and the tables that a scene keeps. Each belongs to some effects, and is
// exactly 0 if none of these is declared.
//
//     const SceneCost& cost = simulation.advance(1.0F / 60);
//     std::uint64_t born = cost[SceneCounter::pairsBorn];
//
// Threads  Values: any thread may use its own copies.

#include <integration/effects/effect.hpp>
#include <integration/effects/export.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hashphase {

/// The effects that query a grid. A Simulation has a grid while one of them is declared.
inline constexpr EffectSet kGridEffects{
    Effect::pairs,     Effect::picking, Effect::boxSelection, Effect::culling,
    Effect::proximity, Effect::zones,   Effect::radar,
};

/// The work of a frame. sceneCounters() lists the effects of each counter.
enum class SceneCounter : std::uint8_t {
    // Bodies.
    bodiesMoved,      ///< bodies that moved by their velocities
    fellAsleep,       ///< bodies that fell asleep
    wokeUp,           ///< sleeping bodies that woke
    sleepersAsked,    ///< sleeping bodies tested for waking
    groundsAsked,     ///< bodies put on the ground
    trianglesTested,  ///< triangles tested for these bodies
    // The grid and its pairs.
    proxiesHashed,    ///< boxes set in the grid
    entriesFiled,     ///< entries written into the grid's tables
    cellRowsVisited,  ///< rows of cells, or a ray's blocks of boxes, read by all queries
    boxesTested,      ///< boxes tested for pairs
    pairsWatched,     ///< known pairs tested for overlap
    couplesWatched [[deprecated("pairsWatched")]] = pairsWatched,
    pairsBorn,         ///< pairs that began
    pairsDied,         ///< pairs that ended
    contactsTested,    ///< pairs of spheres tested for contact
    contactsSolved,    ///< bounces among these pairs
    sweepsSolved,      ///< bodies that swept
    sweepBoxesTested,  ///< boxes tested on their ways
    sweepersStopped,   ///< sweeping bodies that hit one that they would have passed
    // Questions asked since the frame before.
    picks,                 ///< picking rays
    pickBoxesTested,       ///< boxes tested for these rays
    selections,            ///< drag rectangles
    selectionBoxesTested,  ///< boxes tested for these rectangles
    // Culling.
    viewsFound,          ///< 1 if the visible set was searched, 0 if it was kept
    cellRowsCulled,      ///< rows of cells read
    cullingBoxesTested,  ///< boxes tested against the view
    framesCulledLate,    ///< 1 if the visible set is of an earlier frame, by declaration
    // Proximity.
    agentsScanned,     ///< agents that looked around, or were looked at
    neighboursTested,  ///< distances tested
    agentsLate,        ///< agents that did not look around: far ones, or out of turn
    // Zones.
    zonesTested,      ///< zones searched
    zoneBoxesTested,  ///< boxes tested for these zones
    zonesLate,        ///< far zones not searched in this frame
    // Radar.
    radarScans,        ///< 1 if the radar was scanned
    radarBoxesTested,  ///< boxes tested for the scan
    radarsLate,        ///< 1 if the counts are of an earlier frame
};

/// Tables of a scene. sceneTables() lists the effects of each table.
enum class SceneTable : std::uint8_t {
    bodies,      ///< positions, radii, and the effects that each body takes part in
    velocities,  ///< of all bodies
    movers,      ///< which bodies are awake
    sleepers,    ///< which bodies are asleep, and how long others have been slow
    ground,      ///< triangles and the grid that holds them
    walkers,     ///< where the ground is asked for, and the answers
    proxies,     ///< ids of the bodies in the grid
    grid,        ///< boxes, and tables of boxes
    pairs,       ///< watched pairs, and changes of pairs
    contacts,    ///< the present pairs
    sweeps,      ///< ways, and scratch of the search along them
    sweepers,    ///< bodies that sweep in this frame
    rayTrees,    ///< trees over the grid, which only rays read
    visible,     ///< a bit for each body
    agents,      ///< positions by cell, counts, and colours
    zones,       ///< zones, their occupants, and events
    radar,       ///< counts
    groups,      ///< the radar group of each body
};

/// A counter or table, and its effects.
struct SceneItem {
    std::string_view name;         ///< as the enumerator is spelled: "bodiesMoved"
    EffectSet owners;              ///< empty: every scene has it
    std::string_view description;  ///< a few words in English
};

/// Numbers of counters and tables.
inline constexpr std::size_t kSceneCounterCount = 35;
inline constexpr std::size_t kSceneTableCount = 18;

/// Return all items, in the order of their enumerators, for reports and profilers.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT const std::array<SceneItem, kSceneCounterCount>&
sceneCounters() noexcept;
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT const std::array<SceneItem, kSceneTableCount>&
sceneTables() noexcept;

/// A number for each Item, SceneCounter or SceneTable: of one frame, or a sum. All are 0 at first. Items beyond the
/// last enumerator are not checked.
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

/// Costs of one frame or several, by counter.
using SceneCost = SceneNumbers<SceneCounter, kSceneCounterCount>;

/// Memory by table [bytes], capacity included: see Simulation::footprint().
using SceneFootprint = SceneNumbers<SceneTable, kSceneTableCount>;

/// Returns the sum over all tables [bytes].
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::uint64_t totalBytes(
    const SceneFootprint& footprint) noexcept;

}  // namespace hashphase
