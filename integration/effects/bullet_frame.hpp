// SPDX-License-Identifier: Zlib
#pragma once

// Applies a declaration (scene_effects.hpp) to a Bullet world. After that, Bullet computes only the declared effects.
//
//     hashphase::WorldConfigurator configurator(world);      // integration/bullet/world_effects.hpp
//     configurator.apply(hashphase::worldEffectsOf(scene));
//     configurator.step(timeStep);                           // or world.stepSimulation()
//
//     effect       setting in Bullet                      consequence without the effect
//     motion       none: step() moves bodies              step() moves no body: it updates boxes, pairs and contacts.
//                                                         If pairs is undeclared too, step() does nothing: call
//                                                         updateAabbs() after you move bodies. Do not call
//                                                         stepSimulation(): it moves bodies
//     terrain      none: the ground is your static body   no ground: do not add its body
//                  (static_triangles.hpp)
//     pairs        the world's overlap filter             no contacts, ghost objects' lists, response or sweep
//     response     CF_NO_CONTACT_RESPONSE of objects      bodies pass through each other; contacts are reported
//     sweep        m_useContinuous; CCD thresholds of     bodies that move by more than half their width in a step
//                  bodies that are fast for their size    may pass through thin bodies
//     sleeping     deactivation, linear thresholds        Bullet also computes resting bodies
//     rotation     angular factors                        bodies keep their orientation
//     friction     all frictions                          bodies slide for ever
//     all others   none: Observers query                  no change in Bullet
//                  SpatialHashBroadphase::grid()
//
// Observers  Observers (observers.hpp) identify objects by ProxyId, and index data by ProxyId::index. When you remove
//            an object, call Observers::forget(), because a new object may get its index. After an origin shift, pass
//            shifted values to Zones::set(), setView() and setInterest().
// Ignored    ResponseEffect::restitution: each body has its own restitution (WorldEffects::restitution sets all).
//            SweepEffect::mode: set SpatialHashConfig::sweep instead. SleepingEffect::framesBeforeSleep: bodies fall
//            asleep after gDeactivationTime, 2 s. SceneEffects::grid: set SpatialHashConfig::grid instead.
// Errors     A finite face of motion.bounds, or a finite sleeping.interestRadius, is an error. Instead, put static
//            planes at the bounds, and deactivate far bodies.

#include <broadphase/core/raise.hpp>
#include <integration/bullet/world_effects.hpp>
#include <integration/effects/scene_effects.hpp>

#include <limits>
#include <string>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Returns the reason why Bullet cannot run the declaration, or an empty string if Bullet can.
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

/// Converts the declared effects to WorldEffects. To keep the bodies' own CCD thresholds, reset() `fastFrom` of the
/// result. To keep the bodies' sleeping thresholds, set SleepingEffect::slowBelow to 0. Throws std::invalid_argument
/// with bulletEffectsError(), if not empty.
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
