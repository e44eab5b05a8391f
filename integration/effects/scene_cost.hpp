// SPDX-License-Identifier: Zlib
#pragma once

// What a frame of a scene cost, as numbers, and which tables a scene keeps. Each number and each table
// belongs to some effects. Where none of these is declared, the number or the size of the table is exactly 0.
//
//     SceneCost sum;
//     sum += simulation.advance(1.0F / 60);
//     std::uint64_t born = sum[SceneCounter::pairsBorn];
//     for (std::size_t i = 0; i < kSceneCounterCount; ++i) {
//         print(sceneCounters()[i].name, sum[static_cast<SceneCounter>(i)]);
//     }
//
// Threads   plain values: any thread may use its own copies

#include <integration/effects/effect.hpp>
#include <integration/effects/export.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hashphase {

/// The effects that ask a grid. A Simulation has a grid while one of them is declared.
inline constexpr EffectSet kGridEffects{
    Effect::pairs,     Effect::picking, Effect::boxSelection, Effect::culling,
    Effect::proximity, Effect::zones,   Effect::radar,
};

/// What is counted in a frame. sceneCounters() tells which effects a counter belongs to.
enum class SceneCounter : std::uint8_t {
    // Bodies.
    bodiesMoved,      ///< bodies that moved by their velocities
    fellAsleep,       ///< bodies that stopped
    wokeUp,           ///< sleeping bodies that go on
    sleepersAsked,    ///< sleeping bodies tested whether they are to wake
    groundsAsked,     ///< bodies put on the ground
    trianglesTested,  ///< triangles tested for these bodies
    // The grid and its pairs.
    proxiesHashed,    ///< boxes set in the grid
    entriesFiled,     ///< entries written into the grid's tables
    cellRowsVisited,  ///< rows of cells read by all that ask, or a ray's blocks of boxes
    boxesTested,      ///< boxes tested for pairs
    pairsWatched,     ///< pairs tested whether they still overlap
    couplesWatched [[deprecated("pairsWatched")]] = pairsWatched,
    pairsBorn,         ///< pairs that began
    pairsDied,         ///< pairs that ended
    contactsTested,    ///< pairs of bodies tested whether the spheres touch
    contactsSolved,    ///< bounces among these pairs
    sweepsSolved,      ///< bodies that swept
    sweepBoxesTested,  ///< boxes tested along the ways of these bodies
    sweepersStopped,   ///< sweeping bodies that met one which they no longer touch at the end
    // Questions asked since the frame before.
    picks,                 ///< picking rays
    pickBoxesTested,       ///< boxes tested for these rays
    selections,            ///< drag rectangles
    selectionBoxesTested,  ///< boxes tested for these rectangles
    // Culling.
    viewsFound,          ///< 1 where the visible set was found again, 0 where it was kept
    cellRowsCulled,      ///< rows of cells read
    cullingBoxesTested,  ///< boxes tested against the view
    framesCulledLate,    ///< 1 where the visible set is that of an earlier frame, by declaration
    // Proximity.
    agentsScanned,     ///< agents that looked around, or were looked at
    neighboursTested,  ///< distances tested
    agentsLate,        ///< agents that did not look around: far ones, or out of turn
    // Zones.
    zonesTested,      ///< zones searched
    zoneBoxesTested,  ///< boxes tested for these zones
    zonesLate,        ///< far zones not searched in this frame
    // Radar.
    radarScans,        ///< 1 where the radar was scanned
    radarBoxesTested,  ///< boxes tested for the scan
    radarsLate,        ///< 1 where the counts are those of an earlier frame
};

/// What a scene keeps in memory. sceneTables() tells which effects a table belongs to.
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

/// The name of a counter or table, and the effects that it belongs to.
struct SceneItem {
    std::string_view name;         ///< as the enumerator is spelled: "bodiesMoved"
    EffectSet owners;              ///< effects that count or keep it; empty: every scene does
    std::string_view description;  ///< a few words in English
};

/// How many counters and tables there are.
inline constexpr std::size_t kSceneCounterCount = 35;
inline constexpr std::size_t kSceneTableCount = 18;

/// Return all items, in the order of SceneCounter and of SceneTable: for reports and profilers.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT const std::array<SceneItem, kSceneCounterCount>&
sceneCounters() noexcept;
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT const std::array<SceneItem, kSceneTableCount>&
sceneTables() noexcept;

/// A number for each Item: of one frame, or the sum of several frames. All numbers are 0 at first. Item is
/// SceneCounter or SceneTable; items beyond the last enumerator are not checked.
template <class Item, std::size_t count>
class SceneNumbers {
public:
    [[nodiscard]] std::uint64_t operator[](Item item) const noexcept {
        return numbers_[static_cast<std::size_t>(item)];
    }
    [[nodiscard]] std::uint64_t& operator[](Item item) noexcept {
        return numbers_[static_cast<std::size_t>(item)];
    }
    /// Adds number by number.
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

/// What one frame or several cost, by counter.
using SceneCost = SceneNumbers<SceneCounter, kSceneCounterCount>;

/// Memory by table [bytes], capacity included: see Simulation::footprint().
using SceneFootprint = SceneNumbers<SceneTable, kSceneTableCount>;

/// Returns the sum over all tables [bytes].
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::uint64_t totalBytes(
    const SceneFootprint& footprint) noexcept;

}  // namespace hashphase
