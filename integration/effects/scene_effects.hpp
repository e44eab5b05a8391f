// SPDX-License-Identifier: Zlib
#pragma once

// A declaration: the effects that a scene calls for, each with its settings. Effects that are not declared
// cost nothing, neither time nor memory, whether a Simulation (simulation.hpp) runs the scene, or Bullet
// (bullet_frame.hpp) with Observers (observers.hpp).
//
//     SceneEffects effects;
//     effects.motion.emplace();
//     effects.pairs.emplace();
//     effects.culling = CullingEffect{.margin = 1};
//
// A value: copy it, change it, declare it again between two frames.
// Units     metres, seconds

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

/// The largest value of lengths that must be finite, and the smallest of lengths that must not vanish [m].
inline constexpr double kMostEffectLength = 1e30;
inline constexpr double kLeastEffectLength = 1e-30;

/// Bodies move by velocity * time step.
struct MotionEffect {
    /// Bodies whose centres would leave this box [m] turn back at its faces; by default it is all of space.
    /// The lower corner is not above the upper one, nor above kMostEffectLength; the upper corner is not
    /// below -kMostEffectLength.
    Aabb<double> bounds{Vector3<double>::Constant(-std::numeric_limits<double>::infinity()),
                        Vector3<double>::Constant(std::numeric_limits<double>::infinity())};
};

/// Bodies that have moved are put on the ground, where there is ground below them. Needs motion.
struct TerrainEffect {
    UpAxis up =
        UpAxis::y;  ///< if it is declared again with another axis, the ground has no triangles
};

/// Finds which boxes overlap: births and deaths of pairs (pairs.hpp).
struct PairsEffect {};

/// Spheres that touch and approach each other exchange their velocities along the line between their centres.
/// Needs pairs and motion.
struct ResponseEffect {
    double restitution = 1;  ///< 0 to 1; 0: they stay together, 1: nothing is lost
};

/// Bodies that move by more than a share of their diameter in a frame meet the bodies that they pass, and
/// with response bounce off the first one. Needs pairs and motion.
struct SweepEffect {
    Sweep mode = Sweep::automatic;  ///< not Sweep::none
    /// That share, 0 or more. Above 0.5, bodies slower than that may pass bodies thinner than themselves.
    double fastFrom = 0.5;
};

/// Bodies that would move stand still where they are far from the interest, or slow. Needs motion.
struct SleepingEffect {
    double interestRadius = std::numeric_limits<double>::infinity();  ///< asleep beyond it [m]
    double slowBelow = 0;                  ///< asleep after some frames below this speed [m/s]
    std::uint32_t framesBeforeSleep = 30;  ///< how many slow frames, 1 to kMostEffectFrames
};

/// Bodies turn, under Bullet; without it they keep their orientation. Needs motion.
struct RotationEffect {};

/// Bodies that touch rub against each other, under Bullet. Needs response.
struct FrictionEffect {};

/// Finds the proxies under the pointer, when asked (picking/pick.hpp).
struct PickingEffect {};

/// Finds the proxies in a drag rectangle, when asked (picking/drag_selection.hpp).
struct BoxSelectionEffect {};

/// Finds the proxies that a camera sees (culling/culler.hpp).
struct CullingEffect {
    /// The set is kept while it is known to hold all visible proxies: see Culler [m].
    double margin = 0;  ///< 0 to kMostEffectLength
    /// While the camera rests, the set is found again in every n-th frame only. Proxies that move into view,
    /// or are added there, then are seen up to n - 1 frames late; SceneCounter::framesCulledLate counts these
    /// frames. Removed proxies are gone at once.
    std::uint32_t restingCameraFrames = 1;
};

/// What agents do about their neighbours: the paper's routine (RarestColour).
struct ProximityEffect {
    double radius = 10;             ///< [m]
    std::uint32_t colourCount = 4;  ///< 1 to RadiusSearch::kMostGroups
    double interestRadius =
        std::numeric_limits<double>::infinity();  ///< agents beyond it are far [m]
    std::uint32_t farFrames = 1;  ///< far agents look around in every n-th frame only
    /// Agents look around by turns: each in every n-th frame, an n-th of them in each frame. Without turns,
    /// all agents around change at once, and may change to and fro in every frame. Far agents, with
    /// farFrames, skip turns: they look in every farFrames-th one.
    std::uint32_t turns = 1;
};

/// Finds the proxies in zones of interest (ai/zones.hpp).
struct ZonesEffect {
    double interestRadius =
        std::numeric_limits<double>::infinity();  ///< zones beyond it are far [m]
    std::uint32_t farFrames = 1;  ///< far zones are searched in every n-th frame only
};

/// Counts proxies in coarse cells around the interest, by group (ai/radar.hpp).
struct RadarEffect {
    double cellSize = 10;  ///< [m], kLeastEffectLength to kMostEffectLength
    std::uint32_t columns = 32;
    std::uint32_t rows = 32;
    std::uint32_t groupCount = 1;
    std::uint32_t frames = 1;  ///< scanned in every n-th frame only
    UpAxis up = UpAxis::y;
};

/// What a scene calls for: an effect that has settings here is declared.
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

    /// declare() declares the effect with default settings, unless it is declared already; remove() takes it
    /// back.
    void declare(Effect effect);
    void remove(Effect effect);
};

/// Returns all effects that this one needs, directly or through others.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT EffectSet needsOf(Effect effect) noexcept;

/// Says in a sentence how the declaration contradicts itself: which effect, or which setting, is wrong, and
/// what to declare instead; empty when all is well. Simulation and Observers throw std::invalid_argument with
/// this sentence.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::string effectsError(const SceneEffects& effects);

}  // namespace hashphase
