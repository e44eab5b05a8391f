// SPDX-License-Identifier: Zlib
#pragma once

// Makes Bullet compute only the effects that a scene needs. By default every effect is declared, and nothing changes.
//
//     WorldConfigurator configurator(world);
//     configurator.apply({.rotation = false, .friction = false});
//
// Effect        Without it                                   Consequences
// restingBoxes  setForceUpdateAllAabbs(false)                call updateSingleAabb() after moving a static or
//                                                            sleeping body by hand
// pairs         an overlap filter that refuses every pair    no contacts, ghost lists, response or sweep; ray tests
//                                                            and sweep tests still work
// response      CF_NO_CONTACT_RESPONSE on every object       bodies fall through each other; Bullet still reports
//                                                            contacts
// sweep         m_useContinuous off, CCD thresholds 0        bodies that move by more than half their width in a
//                                                            step may pass through thin bodies
// sleeping      DISABLE_DEACTIVATION on dynamic bodies       Bullet computes resting bodies in each step; heaps
//                                                            creep
// rotation      angular factor and velocity 0, no            bodies keep their orientation: nothing tips over,
//               gyroscopic forces                            rolls, or swings about a joint
// friction      all friction 0, one friction direction       bodies slide for ever on any slope; heaps fall apart
//
// response needs pairs. sweep and friction need pairs and response. An effect is off if an effect that it needs is
// off.
//
// A heap of 250 bodies takes 76 % fewer instructions per step without pairs, 58 % without response, 16 % without
// rotation, 2 % without friction. A resting heap costs twice as much without sleeping. 2000 static bodies cost 7 %
// less without restingBoxes.
//
// A frame   Between two steps, call apply() if declarations change, prepare() after adding a body, and release()
//           before removing a body. Afterwards, call step() alone. Or call stepSimulation(), and optionally
//           beforeStep() before it.
// Settings  When an effect is declared again, apply() restores the former settings of bodies and the world; the
//           destructor restores all. If your program sets another value while the effect is off, that value is
//           restored instead. A value equal to the configurator's (friction 0 while friction is off,
//           DISABLE_DEACTIVATION while sleeping is off) is not noticed, and not restored. Angular velocities are not
//           restored.
// Lifetime  The world, its broadphase, its pair cache and its former overlap filter must outlive the configurator. No
//           other filter may call the configurator's filter. The configurator changes only objects in the world.
// Removal   Call release() before you remove or delete an object. Without this call, a removed object keeps the
//           configurator's settings until it is in the world again and apply() or prepare() configures it. If the
//           configurator is destroyed first, the object keeps them for ever. A new object at a deleted object's
//           address is mistaken for the deleted object if no apply() ran after the deletion and before the new
//           object was added. Even if apply() ran, the new object is mistaken if it already has a setting that the
//           configurator gave the deleted object (such as friction 0), or if the configurator had changed only CCD
//           settings of the deleted object.
// Other     Soft bodies and multibodies solve their own contacts. Only `pairs`, `restingBoxes` and, in step(),
//           WorldEffects::motion apply to such bodies. Without friction, multibodies too have one friction direction.
// Memory    Used only for objects with overridden settings. After a removal without release(), memory is kept until
//           an object is at that address again. Throws std::bad_alloc when memory runs out; repeat the call. The next
//           step that does not throw completes the pairs.

#include <integration/bullet/detail/kept_setting.hpp>
#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// The declared effects of one body: see the table above.
struct BodyEffects {
    bool pairs = true;
    bool response = true;
    bool sweep = true;
    bool sleeping = true;
    bool rotation = true;
    bool friction = true;
};

/// The declared effects of a world.
struct WorldEffects {
    bool motion = true;        ///< if false, WorldConfigurator::step() moves no body
    bool restingBoxes = true;  ///< each step updates the boxes of all objects, as in Bullet
    bool pairs = true;
    bool response = true;
    bool sweep = true;
    bool sleeping = true;
    bool rotation = true;
    bool friction = true;

    /// Restitution of every contact, 0 to 1. If unset, bodies keep their own values.
    std::optional<btScalar> restitution{};

    /// Sweeps each convex body that moves in a step by more than this share of the smallest edge of its shape's box.
    /// If unset, bodies keep their own CCD thresholds. Up to 0.5, no body passes through a thin wall. Above 0.5, an
    /// unswept body may move by more than half its width. If its middle gets beyond a thin wall, the wall pushes it
    /// out on the far side. Cost: two casts per step for each swept body.
    std::optional<btScalar> fastFrom{};

    /// Bodies slower than this [m/s] may fall asleep. If unset, bodies keep their own thresholds.
    std::optional<btScalar> slowBelow{};

    /// Returns the effects of an object, to switch effects off for single objects. If this function is not set, none
    /// is switched off. Two objects pair only if both have `pairs`. The overlap filter calls this function too, on
    /// the thread that asks the filter. Asserted: the function does not call apply(). Without assertions, such a call
    /// does nothing.
    std::function<BodyEffects(const btCollisionObject&)> effectsOf{};
};

/// Makes a Bullet world compute only the declared effects.
class HASHPHASE_BULLET_EXPORT WorldConfigurator {
public:
    explicit WorldConfigurator(btDiscreteDynamicsWorld& world);
    /// Restores all settings. Restored pairs need memory. If memory may run out, call apply({}) first: an exception
    /// here ends the program.
    ~WorldConfigurator();
    WorldConfigurator(const WorldConfigurator&) = delete;
    WorldConfigurator& operator=(const WorldConfigurator&) = delete;

    /// Sets what Bullet computes from the next step on. If this changes how bodies move, all bodies wake. Pairs
    /// change immediately. If pairs may change under a broadphase other than SpatialHashBroadphase, each object gets
    /// a new proxy. Cost: one pass over all objects, plus one over contacts and pairs if these may change.
    void apply(const WorldEffects& effects);
    [[nodiscard]] const WorldEffects& effects() const noexcept { return effects_; }

    /// Configures an object of the world, as apply() does. Asserted: the object is in the world. Cost: O(1).
    void prepare(btCollisionObject& object);

    /// Restores an object's own settings, and forgets the object. Call it before you remove or delete the object.
    /// Cost: O(1).
    void release(btCollisionObject& object);

    /// Returns the number of bodies that Bullet will sweep in a step of `timeStep` [s]. If fastFrom is set and the
    /// number is 0, switches Bullet's sweeps off for this step: a body that becomes fast during such a step is swept
    /// only from the next step on. This call is optional: without it, sweeps are not switched off. If you use it,
    /// call it before each step, because sweeps that it switched off stay off until the next call. Cost: one pass
    /// over all objects.
    int beforeStep(btScalar timeStep);

    /// Runs a step of `timeStep` [s]. If motion is declared, calls beforeStep() (only if fastFrom is set), then
    /// stepSimulation(timeStep, 0). If motion is off, only updates pairs and contacts. If pairs is off too,
    /// does nothing.
    void step(btScalar timeStep);

    /// Returns the number of objects with overridden settings, including objects removed without release().
    [[nodiscard]] std::size_t heldCount() const noexcept { return kept_.size(); }

private:
    struct KeptBody {
        detail::KeptSetting<int> noResponse;
        detail::KeptSetting<btScalar> friction;
        detail::KeptSetting<btScalar> rollingFriction;
        detail::KeptSetting<btScalar> spinningFriction;
        detail::KeptSetting<btScalar> restitution;
        detail::KeptSetting<btVector3> angularFactor;
        detail::KeptSetting<int> gyroscopicFlags;
        detail::KeptSetting<btScalar> ccdThreshold;
        detail::KeptSetting<btScalar> ccdRadius;
        detail::KeptSetting<btScalar> slowBelow;
        bool isKeptAwake = false;
        bool wasAway = false;  // was not in the world during an apply()
        std::uint64_t lastSeen = 0;

        [[nodiscard]] bool isHeld() const noexcept;
        [[nodiscard]] bool mayBeOf(const btCollisionObject& object) const;
    };

    /// Refuses pairs that are not declared. Asks the former filter about all other pairs.
    class Filter final : public btOverlapFilterCallback {
    public:
        explicit Filter(const WorldConfigurator& owner) : owner_(&owner) {}
        bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;

        btOverlapFilterCallback* former = nullptr;

    private:
        const WorldConfigurator* owner_;
    };

    [[nodiscard]] BodyEffects effectsOf(const btCollisionObject& object) const;
    [[nodiscard]] KeptBody* keptOf(const btCollisionObject& object, bool isWanted);
    bool configure(btCollisionObject& object, const BodyEffects& effects,
                   const WorldEffects& ofWorld);
    void setFilter();
    void askAboutPairsAgain();
    void configureWorld();
    void renewContacts();
    void wakeAll();

    static bool setContacts(btCollisionObject& object, KeptBody& kept, const BodyEffects& effects,
                            const WorldEffects& ofWorld);
    static bool setRotation(btRigidBody& body, KeptBody& kept, bool isWithout);
    static void setSweep(btRigidBody& body, KeptBody& kept, const BodyEffects& effects,
                         const WorldEffects& ofWorld);
    static void setSleeping(btRigidBody& body, KeptBody& kept, const BodyEffects& effects,
                            const WorldEffects& ofWorld);

    btDiscreteDynamicsWorld* world_;
    WorldEffects effects_;
    Filter filter_{*this};
    detail::KeptSetting<bool> forcesBoxes_;
    detail::KeptSetting<bool> useContinuous_;
    detail::KeptSetting<int> frictionDirections_;
    std::unordered_map<const btCollisionObject*, KeptBody> kept_;  // overridden objects
    std::uint64_t applyCount_ = 0;
    bool arePairsOld_ = false;       // must ask the filter about all pairs again
    bool areBodiesChanged_ = false;  // must wake all bodies
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
