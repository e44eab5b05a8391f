// SPDX-License-Identifier: Zlib
#pragma once

// A declaration: the effects that a scene calls for, each with its settings. What is not declared costs
// nothing, neither time nor memory, whoever runs the scene: a Simulation (simulation.hpp), or Bullet
// (bullet_frame.hpp) with Observers (observers.hpp).
//
//     SceneEffects effects;
//     effects.motion.emplace();
//     effects.pairs.emplace();
//     effects.culling = CullingEffect{.margin = 1};
//
// A value: copy it, change it, declare it anew between two frames.
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

/// Settings that count frames go up to this.
inline constexpr std::uint32_t kMostEffectFrames = 1'000'000;

/// Between these are lengths that must be finite, and those that must not vanish [m].
inline constexpr double kMostEffectLength = 1e30;
inline constexpr double kLeastEffectLength = 1e-30;

/// Bodies move by velocity * time step.
struct MotionEffect {
    /// Who would leave this box with its centre turns back at its face [m]; by default it has none. Its
    /// lower corner is at most kMostEffectLength, its upper one at least as far below 0.
    Aabb<double> bounds{Vector3<double>::Constant(-std::numeric_limits<double>::infinity()),
                        Vector3<double>::Constant(std::numeric_limits<double>::infinity())};
};

/// Bodies that have moved are put on the ground, where there is any below them. Needs motion.
struct TerrainEffect {
    UpAxis up =
        UpAxis::y;  ///< if it is declared anew with another one, the ground has no triangles
};

struct PairsEffect {};

/// Spheres that touch and approach each other exchange what they have of their velocities along the line
/// between their centres. Needs pairs and motion.
struct ResponseEffect {
    double restitution = 1;  ///< 0: they stay together, 1: nothing is lost
};

/// Bodies that move by more than a share of their diameter in a frame meet what they pass, and with
/// response bounce off the first of it. Needs pairs and motion.
struct SweepEffect {
    Sweep mode = Sweep::automatic;  ///< not Sweep::none
    /// That share. Above 0.5, those between may pass what is thinner than they are.
    double fastFrom = 0.5;
};

/// Bodies that would move stand still where nobody looks, or when they are slow. Needs motion.
struct SleepingEffect {
    double interestRadius = std::numeric_limits<double>::infinity();  ///< asleep beyond it [m]
    double slowBelow = 0;                  ///< asleep after some frames below this speed [m/s]
    std::uint32_t framesBeforeSleep = 30;  ///< so many
};

/// Bodies turn, under Bullet; without it they have their orientation for ever.
struct RotationEffect {};

/// Bodies that touch rub against each other, under Bullet. Needs response.
struct FrictionEffect {};

struct PickingEffect {};

struct BoxSelectionEffect {};

struct CullingEffect {
    /// The set is kept while it is known to have all that is seen: see Culler [m].
    double margin = 0;  ///< 0 to kMostEffectLength
    /// While the camera rests, the set is found anew in every n-th frame only. Above 1, what moves into
    /// view, or is added there, is seen so many frames late, less one; SceneCounter::framesCulledLate
    /// counts them. What is removed is gone at once.
    std::uint32_t restingCameraFrames = 1;
};

/// What an agent does about who is near: the paper's routine (RarestColour).
struct ProximityEffect {
    double radius = 10;             ///< [m]
    std::uint32_t colourCount = 4;  ///< 1 to RadiusSearch::kMostGroups
    double interestRadius =
        std::numeric_limits<double>::infinity();  ///< agents beyond it are far [m]
    std::uint32_t farFrames = 1;  ///< far agents look around in every n-th frame only
    /// Agents look around by turns, each in every n-th frame, an n-th of them in each. Those around do not
    /// all change at once then, which they else may do in every frame, to and fro. Far ones, with farFrames,
    /// look in every so many of their turns.
    std::uint32_t turns = 1;
};

struct ZonesEffect {
    double interestRadius =
        std::numeric_limits<double>::infinity();  ///< zones beyond it are far [m]
    std::uint32_t farFrames = 1;  ///< who is in far zones is found in every n-th frame only
};

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

    GridConfig grid;  ///< of the grid, which exists when an effect asks it

    /// What is declared.
    [[nodiscard]] EffectSet set() const noexcept;

    /// Declares the effect with default settings, unless it is declared already; or takes it back.
    void declare(Effect effect);
    void remove(Effect effect);
};

/// The effects without which that one cannot be declared, those that these need included.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT EffectSet needsOf(Effect effect) noexcept;

/// Says in a sentence how the declaration contradicts itself: which effect, or which setting, is wrong,
/// and what to declare instead; empty when all is well. Who runs a declaration throws
/// std::invalid_argument with this sentence.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::string effectsError(const SceneEffects& effects);

}  // namespace hashphase
