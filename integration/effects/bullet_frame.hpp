// SPDX-License-Identifier: Zlib
#pragma once

// The effects of a declaration (scene_effects.hpp) in a Bullet world. Bullet computes only declared effects.
//
//     hashphase::WorldConfigurator configurator(world);      // integration/bullet/world_effects.hpp
//     configurator.apply(hashphase::worldEffectsOf(scene));
//     configurator.step(timeStep);                           // or world.stepSimulation()
//
//     effect       setting in Bullet                         lost without the effect
//     motion       none: step() steps the world              motion. step() only finds declared pairs of bodies as
//                                                            they are. Call updateAabbs() for bodies that you move,
//                                                            not stepSimulation(): it moves bodies with a velocity
//     terrain      none: the ground is your static body      the ground: do not add it
//                  (static_triangles.hpp)
//     pairs        the world's overlap filter                contacts, ghosts' lists, response and sweep
//     response     each object's answer to contacts          bodies fall through each other; contacts are reported
//     sweep        m_useContinuous; CCD thresholds of        bodies that move by more than half their width in a
//                  bodies fast for their size                step may pass thin ones
//     sleeping     deactivation, linear thresholds           nothing: resting bodies are still computed
//     rotation     angular factors                           bodies keep their orientation
//     friction     all frictions                             bodies slide for ever
//     the others   none: they query                          nothing
//                  SpatialHashBroadphase::grid()
//
// Observers  know objects by ProxyId, and keep data by index. If you remove an object, call Observers::forget():
//            another object gets its index. After an origin shift, move zones, view and interest yourself.
// Ignored    ResponseEffect::restitution: each body has its own (WorldEffects::restitution sets all).
//            SweepEffect::mode: SpatialHashConfig::sweep sets it. SleepingEffect::framesBeforeSleep: bodies sleep
//            after gDeactivationTime, 2 s.
// Errors     finite motion.bounds and sleeping.interestRadius. Put static planes at the bounds, and deactivate far
//            bodies.

#include <broadphase/core/raise.hpp>
#include <integration/bullet/world_effects.hpp>
#include <integration/effects/scene_effects.hpp>

#include <limits>
#include <string>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Returns in a sentence why Bullet cannot run the declaration; empty if it can.
[[nodiscard]] inline std::string bulletEffectsError(const SceneEffects& effects) {
    const std::string error = effectsError(effects);
    if (!error.empty()) {
        return error;
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (effects.motion && !(effects.motion->bounds.min().maxCoeff() == -infinity &&
                            effects.motion->bounds.max().minCoeff() == infinity)) {
        return "motion.bounds is set, but Bullet has no such setting. Leave it out, and add static "
               "planes instead.";
    }
    if (effects.sleeping && effects.sleeping->interestRadius < infinity) {
        return "sleeping.interestRadius is set, but Bullet has no such setting. Leave it out, and "
               "deactivate far bodies yourself.";
    }
    return {};
}

/// Returns the declaration in Bullet's terms. Bodies keep CCD thresholds of their own if you reset() `fastFrom` of
/// the result, and sleeping thresholds with SleepingEffect::slowBelow 0. Throws std::invalid_argument with
/// bulletEffectsError().
[[nodiscard]] inline WorldEffects worldEffectsOf(const SceneEffects& effects) {
    if (const std::string error = bulletEffectsError(effects); !error.empty()) {
        detail::raiseInvalidArgument(error);
    }
    WorldEffects ofWorld;
    ofWorld.motion = effects.motion.has_value();
    ofWorld.pairs = effects.pairs.has_value();
    ofWorld.response = effects.response.has_value();
    ofWorld.sweep = effects.sweep.has_value();
    ofWorld.sleeping = effects.sleeping.has_value();
    ofWorld.rotation = effects.rotation.has_value();
    ofWorld.friction = effects.friction.has_value();
    if (effects.sweep) {
        ofWorld.fastFrom = static_cast<btScalar>(effects.sweep->fastFrom);
    }
    if (effects.sleeping && effects.sleeping->slowBelow > 0) {
        ofWorld.slowBelow = static_cast<btScalar>(effects.sleeping->slowBelow);
    }
    return ofWorld;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE

#include <broadphase/core/restore_macros.hpp>
