// SPDX-License-Identifier: Zlib
#pragma once

// What the effects of a declaration (scene_effects.hpp) mean for a Bullet world. Bullet computes only
// declared effects.
//
//     hashphase::WorldConfigurator configurator(world);      // integration/bullet/world_effects.hpp
//     configurator.apply(hashphase::worldEffectsOf(scene));
//     configurator.step(timeStep);                           // or world.stepSimulation()
//
// effect       what is set in Bullet                   what is lost without it
// motion       nothing: step() steps the world         everything moves: step() finds the pairs of bodies as
//                                                      they stand, if they are declared, and else does
//                                                      nothing (call updateAabbs() for what you move); do
//                                                      not call stepSimulation(), which moves whatever
//                                                      has a velocity
// terrain      nothing: the ground is a static body    the ground: do not add it
//              of yours (static_triangles.hpp)
// pairs        the world's filter for overlaps         contacts, ghosts' lists, response and sweep
// response     every object's answer to contacts       bodies fall through each other, contacts are still
//                                                      told
// sweep        m_useContinuous; CCD thresholds for     bodies that move by more than half their width in
//              bodies that are fast for their size     a step may pass thin ones
// sleeping     deactivation, linear thresholds         nothing: bodies that rest go on being computed
// rotation     angular factors                         bodies keep their orientation
// friction     all frictions                           bodies slide for ever
// picking,     nothing: they ask the grid of           nothing in Bullet; none is made for them either
// boxSelection, SpatialHashBroadphase::grid()
// culling, proximity, zones, radar
//
// Observers over that grid know objects by ProxyId, and keep data by index (colours, a late visible set).
// Call Observers::forget() when an object is removed, because another object gets its index. After an origin
// shift, move zones, view and interest yourself.
//
// Bullet ignores some settings: ResponseEffect::restitution, because each body has its own
// (WorldEffects::restitution sets that of all); SweepEffect::mode, which belongs to the broadphase
// (SpatialHashConfig::sweep); and SleepingEffect::framesBeforeSleep, because bodies fall asleep after
// gDeactivationTime, 2 s. Finite motion.bounds and sleeping.interestRadius are errors: put static planes at
// the bounds, and deactivate far bodies.

#include <broadphase/core/raise.hpp>
#include <integration/bullet/world_effects.hpp>
#include <integration/effects/scene_effects.hpp>

#include <limits>
#include <string>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Says in a sentence why Bullet cannot run the declaration; empty when it can.
[[nodiscard]] inline std::string bulletEffectsError(const SceneEffects& effects) {
    const std::string error = effectsError(effects);
    if (!error.empty()) {
        return error;
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (effects.motion && !(effects.motion->bounds.min().maxCoeff() == -infinity &&
                            effects.motion->bounds.max().minCoeff() == infinity)) {
        return "motion.bounds is not for Bullet: leave it out, and put static planes there.";
    }
    if (effects.sleeping && effects.sleeping->interestRadius < infinity) {
        return "sleeping.interestRadius is not for Bullet: leave it out, and deactivate what is "
               "far.";
    }
    return {};
}

/// Returns the declaration in Bullet's terms. Bodies are swept as declared; where they are to have CCD
/// thresholds of their own, reset() `fastFrom` of the result. With SleepingEffect::slowBelow 0 they have
/// sleeping thresholds of their own. Throws std::invalid_argument with bulletEffectsError().
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
