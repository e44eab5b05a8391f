// SPDX-License-Identifier: Zlib
#pragma once

// A declaration: the effects of a scene, each with its settings. Undeclared effects cost no time and no memory, in a
// Simulation (simulation.hpp) and in Bullet (bullet_frame.hpp) with Observers (observers.hpp).
//
// Frame   A value: copy it, change it, and declare it again between two frames.
// Units   metres, seconds
// Limits  Settings that count frames are 1 to kMostEffectFrames. farFrames above 1 needs a finite interestRadius.

#include <broadphase/aabb.hpp>
#include <broadphase/grid_config.hpp>
#include <broadphase/sweep_mode.hpp>
#include <broadphase/up_axis.hpp>
#include <integration/effects/effect.hpp>
#include <integration/effects/export.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace hashphase {

/// The largest value of settings that count frames.
inline constexpr std::uint32_t kMostEffectFrames = 1'000'000;

/// The largest finite length, and the smallest length that must not vanish [m].
inline constexpr double kMostEffectLength = 1e30;
inline constexpr double kLeastEffectLength = 1e-30;

/// Bodies move by velocity * time step.
struct MotionEffect {
    /// Bodies turn back at this box [m] if their centres would leave it; by default it is all of space. Valid: lower
    /// corner not above the upper one, nor above kMostEffectLength; upper corner not below -kMostEffectLength.
    Aabb<double> bounds{Vector3<double>::Constant(-std::numeric_limits<double>::infinity()),
                        Vector3<double>::Constant(std::numeric_limits<double>::infinity())};
};

/// Puts moved bodies on the ground, if there is ground below them. Needs motion.
struct TerrainEffect {
    UpAxis up =
        UpAxis::y;  ///< if it is declared again with another axis, the ground has no triangles
};

/// Finds births and deaths of overlapping pairs (pairs.hpp).
struct PairsEffect {};

/// Touching spheres that approach each other exchange their velocities along the line between their centres. Needs
/// pairs and motion.
struct ResponseEffect {
    double restitution = 1;  ///< from 0, no bounce, to 1, no loss
};

/// Bodies that move by a share of their diameter or more in a frame hit bodies on their way; with response, they
/// bounce off the first one. Needs pairs and motion.
struct SweepEffect {
    Sweep mode = Sweep::automatic;  ///< not Sweep::none
    /// That share, 0 or more. Above 0.5, slower bodies may pass bodies thinner than themselves.
    double fastFrom = 0.5;
};

/// Moving bodies stand still if they are far from the interest, or slow. Needs motion.
struct SleepingEffect {
    double interestRadius = std::numeric_limits<double>::infinity();  ///< asleep beyond it [m]
    double slowBelow = 0;                  ///< asleep after some frames below this speed [m/s]
    std::uint32_t framesBeforeSleep = 30;  ///< number of slow frames
};

/// Bodies turn, under Bullet; without it they keep their orientation. Needs motion.
struct RotationEffect {};

/// Touching bodies rub, under Bullet. Needs response.
struct FrictionEffect {};

/// Finds the proxies under the pointer, on request (picking/pick.hpp).
struct PickingEffect {};

/// Finds the proxies in a drag rectangle, on request (picking/drag_selection.hpp).
struct BoxSelectionEffect {};

/// Finds the proxies that a camera sees (culling/culler.hpp).
struct CullingEffect {
    /// The set is kept while it certainly contains all visible proxies: see Culler [m].
    double margin = 0;  ///< 0 to kMostEffectLength
    /// While the camera rests, the set is searched in every n-th frame only. Proxies that come into view are then up
    /// to n - 1 frames late (SceneCounter::framesCulledLate). Removed proxies are gone at once.
    std::uint32_t restingCameraFrames = 1;
};

/// Agents take the rarest colour around them: the paper's routine (RarestColour).
struct ProximityEffect {
    double radius = 10;             ///< [m]
    std::uint32_t colourCount = 4;  ///< 1 to RadiusSearch::kMostGroups
    double interestRadius =
        std::numeric_limits<double>::infinity();  ///< agents beyond it are far [m]
    std::uint32_t farFrames = 1;  ///< far agents look around in every n-th frame only
    /// Agents look by turns: each in every n-th frame, an n-th of them in each frame. Without turns, neighbours
    /// change at once, perhaps to and fro in every frame. Far agents look in every farFrames-th turn.
    std::uint32_t turns = 1;
};

/// Finds the proxies in zones of interest (ai/zones.hpp).
struct ZonesEffect {
    double interestRadius =
        std::numeric_limits<double>::infinity();  ///< zones beyond it are far [m]
    std::uint32_t farFrames = 1;  ///< far zones are searched in every n-th frame only
};

/// Counts proxies in coarse cells around the interest, by group (ai/radar.hpp). Valid: columns * rows * groupCount
/// from 1 to Radar::kMostCounts.
struct RadarEffect {
    double cellSize = 10;  ///< [m], kLeastEffectLength to kMostEffectLength
    std::uint32_t columns = 32;
    std::uint32_t rows = 32;
    std::uint32_t groupCount = 1;
    std::uint32_t frames = 1;  ///< scanned in every n-th frame only
    UpAxis up = UpAxis::y;
};

/// The declaration of a scene: an effect with settings here is declared.
struct HASHPHASE_EFFECTS_EXPORT SceneEffects {
    std::optional<MotionEffect> motion;
    std::optional<TerrainEffect> terrain;
    std::optional<PairsEffect> pairs;
    std::optional<ResponseEffect> response;
    std::optional<SweepEffect> sweep;
    std::optional<SleepingEffect> sleeping;
    std::optional<RotationEffect> rotation;
    std::optional<FrictionEffect> friction;
    std::optional<PickingEffect> picking;
    std::optional<BoxSelectionEffect> boxSelection;
    std::optional<CullingEffect> culling;
    std::optional<ProximityEffect> proximity;
    std::optional<ZonesEffect> zones;
    std::optional<RadarEffect> radar;

    GridConfig grid;  ///< settings of the grid, which exists when an effect asks it

    /// Returns the declared effects.
    [[nodiscard]] EffectSet set() const noexcept;

    /// declare() declares the effect with default settings, unless it is declared; remove() removes it.
    void declare(Effect effect);
    void remove(Effect effect);
};

/// Returns all effects that this one needs, directly or through others.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT EffectSet needsOf(Effect effect) noexcept;

/// Returns the fault of the declaration in a sentence, with the remedy; empty if there is none. Simulation and
/// Observers throw std::invalid_argument with it.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::string effectsError(const SceneEffects& effects);

}  // namespace hashphase
