// SPDX-License-Identifier: Zlib
#pragma once

// A declaration: the effects of a scene, each with its settings. Undeclared effects cost no time and no memory. Pass
// the declaration to a Simulation (simulation.hpp), or to Bullet (bullet_frame.hpp) and Observers (observers.hpp).
//
// Frame   A declaration is a value: copy it, change it, and declare it again between two frames.
// Units   metres, seconds
// Limits  Settings that count frames or turns are from 1 to kMostEffectFrames. If farFrames is above 1,
//         interestRadius must be finite.

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

/// The largest value of settings that count frames or turns.
inline constexpr std::uint32_t kMostEffectFrames = 1'000'000;

/// The largest and smallest valid length [m], in settings that mention these limits.
inline constexpr double kMostEffectLength = 1e30;
inline constexpr double kLeastEffectLength = 1e-30;

/// Bodies move by velocity * time step.
struct MotionEffect {
    /// Bodies whose centres would leave this box [m] turn back at the box's faces. By default, the box is all of
    /// space. Valid on each axis: min <= max, min <= kMostEffectLength, max >= -kMostEffectLength.
    Aabb<double> bounds{Vector3<double>::Constant(-std::numeric_limits<double>::infinity()),
                        Vector3<double>::Constant(std::numeric_limits<double>::infinity())};
};

/// In each frame, puts every awake body on the ground below its centre, from any height. Ground above the centre
/// counts too if it is at most as far above as the body moves in the frame: bodies climb slopes up to 45 degrees.
/// Bodies without such ground are not changed. Needs motion.
struct TerrainEffect {
    UpAxis up =
        UpAxis::y;  ///< declaring this effect with another axis removes all triangles of the ground
};

/// Finds births and deaths of overlapping pairs (pairs.hpp).
struct PairsEffect {};

/// Touching spheres that approach each other bounce. If `restitution` is 1, two spheres that take part in motion
/// exchange their velocities along the line between their centres. Needs pairs and motion.
struct ResponseEffect {
    double restitution = 1;  ///< from 0 (no bounce) to 1 (no loss)
};

/// Finds each pair of a fast body and a body on its path. If response is declared, a fast body bounces off the first
/// body on its path. A body is fast if it moves by `fastFrom` diameters or more in a frame. Needs pairs and motion.
struct SweepEffect {
    Sweep mode = Sweep::automatic;  ///< not Sweep::none
    /// Diameters per frame, 0 or more. If fastFrom is above 0.5, bodies that are not fast may pass through bodies
    /// thinner than themselves.
    double fastFrom = 0.5;
};

/// Slow bodies, and bodies far from the interest (Observers::setInterest()), fall asleep. Needs motion.
struct SleepingEffect {
    /// Bodies farther than this from the interest sleep [m].
    double interestRadius = std::numeric_limits<double>::infinity();
    double slowBelow = 0;                  ///< [m/s]; slower bodies sleep after framesBeforeSleep
    std::uint32_t framesBeforeSleep = 30;  ///< number of consecutive frames below slowBelow
};

/// Bodies rotate (only in Bullet). If undeclared, bodies keep their orientation. Needs motion.
struct RotationEffect {};

/// Friction between touching bodies in Bullet. Needs response.
struct FrictionEffect {};

/// Finds the proxies under the pointer, on request (picking/pick.hpp).
struct PickingEffect {};

/// Finds the proxies in a drag rectangle, on request (picking/drag_selection.hpp).
struct BoxSelectionEffect {};

/// Finds the proxies that a camera sees (culling/culler.hpp).
struct CullingEffect {
    /// Margin of the Culler [m]. A margin allows the Culler to keep the visible set for several frames.
    double margin = 0;  ///< from 0 to kMostEffectLength
    /// While the camera does not move, culling searches the grid only in every n-th frame. In that case, proxies that
    /// move into view are found up to n - 1 frames late (SceneCounter::framesCulledLate). Observers::forget() takes a
    /// removed proxy out of the set immediately.
    std::uint32_t restingCameraFrames = 1;
};

/// Agents (proxies that take part) take the colour (a number) that is rarest around them (ai/rarest_colour.hpp).
struct ProximityEffect {
    double radius = 10;             ///< [m]
    std::uint32_t colourCount = 4;  ///< from 1 to RadiusSearch::kMostGroups
    /// Agents farther than this from the interest (Observers::setInterest()) are far [m].
    double interestRadius = std::numeric_limits<double>::infinity();
    std::uint32_t farFrames = 1;  ///< far agents search only in every n-th frame
    /// Number n of turns: in each frame, one n-th of the agents search. If n is 1, neighbours change colour at the
    /// same time, and may alternate between colours in every frame. If n is above 1, a far agent searches only in
    /// every farFrames-th of its turns.
    std::uint32_t turns = 1;
};

/// Finds the proxies in zones that you add (ai/zones.hpp).
struct ZonesEffect {
    /// A zone is far if it does not touch the cube that extends this far [m] from the interest
    /// (Observers::setInterest()) along each axis. ConvexRegions with Containment::inside are never far.
    double interestRadius = std::numeric_limits<double>::infinity();
    std::uint32_t farFrames = 1;  ///< far zones are searched only in every n-th frame
};

/// Counts the proxies of each group in coarse cells around the interest (ai/radar.hpp). Valid: columns * rows *
/// groupCount from 1 to Radar::kMostCounts.
struct RadarEffect {
    double cellSize = 10;  ///< [m], from kLeastEffectLength to kMostEffectLength
    std::uint32_t columns = 32;
    std::uint32_t rows = 32;
    std::uint32_t groupCount = 1;
    std::uint32_t frames = 1;  ///< scans only in every n-th frame
    UpAxis up = UpAxis::y;
};

/// The declaration of a scene. An effect is declared if its member here has a value.
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

    GridConfig grid;  ///< settings of a Simulation's grid, which exists if an effect queries it

    /// Returns the declared effects.
    [[nodiscard]] EffectSet set() const noexcept;

    /// declare() adds the effect with default settings, or changes nothing if it is declared already. remove()
    /// removes the effect.
    void declare(Effect effect);
    void remove(Effect effect);
};

/// Returns all effects that `effect` needs, directly or indirectly.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT EffectSet needsOf(Effect effect) noexcept;

/// Returns the fault of the declaration and the remedy, or an empty string if there is no fault. Simulation and
/// Observers throw std::invalid_argument with this string.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::string effectsError(const SceneEffects& effects);

}  // namespace hashphase
