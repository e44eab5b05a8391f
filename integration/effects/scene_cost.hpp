// SPDX-License-Identifier: Zlib
#pragma once

// What a frame of a scene cost, as numbers, and which tables a scene keeps. Each number and table
// belongs to effects: where none of them is declared it is exactly 0.

#include <integration/effects/effect.hpp>
#include <integration/effects/export.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hashphase {

/// The effects that ask a grid: where one of them is declared, there is one.
inline constexpr EffectSet kGridEffects{
    Effect::pairs,     Effect::picking, Effect::boxSelection, Effect::culling,
    Effect::proximity, Effect::zones,   Effect::radar,
};

enum class SceneCounter : std::uint8_t {
    bodiesMoved,
    fellAsleep,
    wokeUp,
    sleepersAsked,
    groundsAsked,
    trianglesTested,
    proxiesHashed,
    entriesFiled,
    cellRowsVisited,
    boxesTested,
    pairsWatched,
    couplesWatched [[deprecated("pairsWatched")]] = pairsWatched,
    pairsBorn,
    pairsDied,
    contactsTested,
    contactsSolved,
    sweepsSolved,
    sweepBoxesTested,
    sweepersStopped,
    picks,
    pickBoxesTested,
    selections,
    selectionBoxesTested,
    viewsFound,
    cellRowsCulled,
    cullingBoxesTested,
    framesCulledLate,
    agentsScanned,
    neighboursTested,
    agentsLate,
    zonesTested,
    zoneBoxesTested,
    zonesLate,
    radarScans,
    radarBoxesTested,
    radarsLate,
};

enum class SceneTable : std::uint8_t {
    bodies,
    velocities,
    movers,
    sleepers,
    ground,
    walkers,
    proxies,
    grid,
    pairs,
    contacts,
    sweeps,
    sweepers,
    rayTrees,
    visible,
    agents,
    zones,
    radar,
    groups,
};

/// How a counter or table is called, and whose it is.
struct SceneItem {
    std::string_view name;
    EffectSet owners;  // none: of every scene
    std::string_view description;
};

inline constexpr std::size_t kSceneCounterCount = 35;
inline constexpr std::size_t kSceneTableCount = 18;

/// In the order of SceneCounter, and of SceneTable.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT const std::array<SceneItem, kSceneCounterCount>&
sceneCounters() noexcept;
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT const std::array<SceneItem, kSceneTableCount>&
sceneTables() noexcept;

/// A number for each Item: of a frame, or the sum of some.
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

using SceneCost = SceneNumbers<SceneCounter, kSceneCounterCount>;

/// Bytes, capacity included.
using SceneFootprint = SceneNumbers<SceneTable, kSceneTableCount>;

[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::uint64_t totalBytes(
    const SceneFootprint& footprint) noexcept;

}  // namespace hashphase
