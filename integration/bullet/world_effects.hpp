// SPDX-License-Identifier: Zlib
#pragma once

// Lets Bullet compute only what a scene needs. By default every effect is declared, and nothing changes.
//
//     WorldConfigurator configurator(world);
//     configurator.apply({.rotation = false, .friction = false});
//
// Effect        Without it                                   Consequences
// restingBoxes  setForceUpdateAllAabbs(false)                call updateSingleAabb() after moving a static or
//                                                            sleeping body by hand
// pairs         an overlap filter that refuses every pair    no contacts, ghost lists, response or sweep; rays and
//                                                            sweeps by hand still work
// response      CF_NO_CONTACT_RESPONSE on every object       bodies fall through each other; contacts are reported
// sweep         m_useContinuous, all CCD thresholds off      bodies that move by more than half their width in a
//                                                            step may pass thin ones
// sleeping      DISABLE_DEACTIVATION on dynamic bodies       resting bodies are computed in each step; heaps creep
// rotation      angular factor and velocity 0, no            bodies keep their orientation: nothing tips over,
//               gyroscopic forces                            rolls, or swings about a joint
// friction      all friction 0, one friction direction       bodies slide for ever on any slope; heaps fall apart
//
// response and sweep need pairs; friction and sweep need response. Without these they are off, too.
//
// In instructions per step, a heap of 250 bodies saves 76 % without pairs, 58 % without response, 16 % without
// rotation, 2 % without friction. A resting heap costs twice as much without sleeping. 2000 static bodies cost a
// fifteenth less without restingBoxes.
//
// A frame   Between two steps: apply() when the declaration changes, prepare() for each added body, release()
//           before its removal, and beforeStep() or step().
// Settings  Bodies and the world get their own settings back when an effect is declared again, and from the
//           destructor. A value that the program sets meanwhile counts as their own, except DISABLE_DEACTIVATION
//           while sleeping is off. Angular velocities do not come back.
// Lifetime  The world, its broadphase, pair cache and former filter must outlive the configurator. No other filter
//           may wrap the configurator's. Only objects in the world are touched.
// Removal   An object removed without release() keeps the settings until it is back and apply() or prepare() meets
//           it, or for good if the configurator ends first. Call release() before you delete an object: a new one
//           at its address that has one of these settings is taken for it.
// Other     Soft bodies and multibodies solve contacts of their own: only pairs affects them.
// Memory    Held only for objects with overridden settings; after removal without release(), until an object is
//           back at the address. Throws std::bad_alloc when memory runs out; repeat the call. Pairs are complete in
//           the next step that returns.

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
    bool motion = true;        ///< only for WorldConfigurator::step()
    bool restingBoxes = true;  ///< updated in each step, Bullet's default
    bool pairs = true;
    bool response = true;
    bool sweep = true;
    bool sleeping = true;
    bool rotation = true;
    bool friction = true;

    /// Restitution of every contact, 0 to 1; without it each body has its own.
    std::optional<btScalar> restitution{};

    /// Sweeps convex bodies that move in a step by more than this share of the smallest edge of their shape's box;
    /// without it, bodies with CCD thresholds of their own. Up to 0.5, no body passes a thin wall. Above, an
    /// unswept body that moves by more than half its width may get its middle beyond the wall, and is pushed out on
    /// the far side. Cost: a cast for each swept body, twice a step.
    std::optional<btScalar> fastFrom{};

    /// Bodies slower than this [m/s] may fall asleep; without it each has its own threshold.
    std::optional<btScalar> slowBelow{};

    /// Takes effects away from single objects; empty for none. Two objects pair only if both may. Also called when
    /// Bullet asks overlap filters, on the asking thread.
    std::function<BodyEffects(const btCollisionObject&)> effectsOf{};
};

/// Lets a Bullet world compute no more than is declared.
class HASHPHASE_BULLET_EXPORT WorldConfigurator {
public:
    explicit WorldConfigurator(btDiscreteDynamicsWorld& world);
    /// Gives back all settings. Pairs that return take memory: if it may run out, call apply({}) first.
    ~WorldConfigurator();
    WorldConfigurator(const WorldConfigurator&) = delete;
    WorldConfigurator& operator=(const WorldConfigurator&) = delete;

    /// Sets what Bullet computes from the next step on. If this changes how bodies move, all bodies wake. Pairs
    /// change at once; under a broadphase other than SpatialHashBroadphase, each object then gets a new proxy.
    /// Cost: a look at each object, and at each contact and pair if these change.
    void apply(const WorldEffects& effects);
    [[nodiscard]] const WorldEffects& effects() const noexcept { return effects_; }

    /// Configures an added object, as apply() would. Asserted: it is in the world. Cost: O(1).
    void prepare(btCollisionObject& object);

    /// Gives an object its own settings back and forgets it, before it is removed from the world or deleted. Cost:
    /// O(1).
    void release(btCollisionObject& object);

    /// Returns how many bodies will be swept in a step of this length [s]. With fastFrom, Bullet boxes and sweeps
    /// ways only in steps with such bodies: a body that becomes fast within another step is swept from the next one
    /// on. Call it before each step, or never. Cost: a look at each object.
    int beforeStep(btScalar timeStep);

    /// Runs a step of this length [s]. With motion: stepSimulation(timeStep, 0), after beforeStep() if fastFrom is
    /// set. Without motion: only pairs and contacts of the bodies where they are, if pairs are declared.
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
        bool wasAway = false;  // in an apply()
        std::uint64_t lastSeen = 0;

        [[nodiscard]] bool isHeld() const noexcept;
        [[nodiscard]] bool mayBeOf(const btCollisionObject& object) const;
    };

    /// Refuses pairs that are not declared, and asks the former filter about the rest.
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
    std::unordered_map<const btCollisionObject*, KeptBody> kept_;  // of overridden objects
    std::uint64_t applyCount_ = 0;
    bool arePairsOld_ = false;       // until the filter was asked about every pair
    bool areBodiesChanged_ = false;  // until all are awake
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
