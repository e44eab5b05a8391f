// SPDX-License-Identifier: Zlib
#pragma once

// Lets Bullet compute only what a scene calls for. Everything is declared by default, and then nothing
// is changed.
//
//     WorldConfigurator configurator(world);
//     configurator.apply({.rotation = false, .friction = false});
//
// effect     without it                                       what is lost
// restingBoxes
//            setForceUpdateAllAabbs(false)                    who moves a body that is static or asleep by
//                                                             hand calls updateSingleAabb()
// pairs      an overlap filter that refuses every pair        contacts, ghost objects' lists, response,
//                                                             sweep; rays and sweeps by hand are not
// response   CF_NO_CONTACT_RESPONSE on every object           bodies fall through each other; contacts are
//                                                             found and told all the same
// sweep      m_useContinuous and all CCD thresholds off       bodies that move by more than half their
//                                                             width in a step may pass what is thin
// sleeping   DISABLE_DEACTIVATION on dynamic bodies           nothing is saved on what rests; heaps creep
// rotation   angular factor and velocity 0, no gyroscopic     bodies keep their orientation: nothing tips
//            forces                                           over, rolls, or swings about a joint
// friction   friction, rolling and spinning friction 0,       bodies slide for ever, down the least slope;
//            one friction direction                           heaps fall apart
//
// In instructions per step, a heap of 250 bodies saves 76 % without pairs, 58 % without response, 16 %
// without rotation, and 2 % without friction, for which Bullet has a row in its solver all the same; one
// that has come to rest costs twice as much without sleeping. 2000 static bodies cost a fifteenth less
// without restingBoxes.
//
// response and sweep need pairs, friction and sweep need response: without it they are off, too.
//
// A frame   apply() when the declaration changes, prepare() for each body that is added to the world,
//           release() for each before it is removed; beforeStep() or step(). All between two steps.
// Settings  What a body or the world had before is given back when the effect is declared again and by
//           the destructor. Who changes a setting meanwhile is believed: that is given back. (But for a
//           body that is given DISABLE_DEACTIVATION while sleeping is not declared, as it has that then.)
//           Angular velocities are not given back, nor what happened meanwhile.
// Lifetime  The world, its broadphase, the pair cache and its former filter outlive the configurator, and
//           nobody wraps the filter that it sets. Only objects that are in the world are touched: one that
//           is removed without release(), as pools do, keeps what is set until it is back and apply() or
//           prepare() meets it, which then treat it as if it had been there all the time; where the
//           configurator ends before that, for good. So release() one before it is deleted: a new object
//           at its address that has something of what was set, by chance, is taken for it.
// Other     Soft bodies and multibodies solve contacts of their own, and are left alone but for pairs.
// Memory    Nothing is held for an object whose settings are its own, but for one that was removed without
//           release(): until it is back, or another one at its address. Where memory runs out,
//           std::bad_alloc is passed on, and the call may be repeated; pairs are complete in the next step
//           that returns.

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

/// What is declared for one body.
struct BodyEffects {
    bool pairs = true;
    bool response = true;
    bool sweep = true;
    bool sleeping = true;
    bool rotation = true;
    bool friction = true;
};

/// What is declared for a world.
struct WorldEffects {
    bool motion = true;        ///< heeded by WorldConfigurator::step() alone
    bool restingBoxes = true;  ///< looked at in each step, as Bullet does by default
    bool pairs = true;
    bool response = true;
    bool sweep = true;
    bool sleeping = true;
    bool rotation = true;
    bool friction = true;

    /// Of every contact, between 0 and 1; without it each body has its own.
    std::optional<btScalar> restitution{};

    /// Convex bodies that move by more than this share of the smallest edge of their shape's box in a step
    /// are swept; without it those with CCD thresholds of their own. Up to 0.5 nothing passes a thin
    /// wall; from there on who moves by more than half its width, and is not swept, may have its
    /// middle beyond the wall when Bullet sees it, and is pushed out on the far side. Cost: a cast for
    /// each of them, twice a step.
    std::optional<btScalar> fastFrom{};

    /// Bodies slower than this may fall asleep [m/s]; without it each has its own threshold.
    std::optional<btScalar> slowBelow{};

    /// Takes effects away from single objects; empty for none. Both of a pair must be accepted.
    /// Called from where Bullet asks for overlap filters as well, in any thread that does.
    std::function<BodyEffects(const btCollisionObject&)> effectsOf{};
};

/// Lets a Bullet world compute no more than is declared.
class HASHPHASE_BULLET_EXPORT WorldConfigurator {
public:
    explicit WorldConfigurator(btDiscreteDynamicsWorld& world);
    /// Gives back all settings. Pairs that come back take memory: where that may run out, apply({})
    /// before.
    ~WorldConfigurator();
    WorldConfigurator(const WorldConfigurator&) = delete;
    WorldConfigurator& operator=(const WorldConfigurator&) = delete;

    /// Sets what Bullet computes from the next step on. When that changes what bodies do, all are woken.
    /// Where pairs change, they change at once; under a broadphase other than SpatialHashBroadphase each
    /// object gets a new proxy for that. Cost: a look at each object, and at each contact and pair where
    /// they change.
    void apply(const WorldEffects& effects);
    [[nodiscard]] const WorldEffects& effects() const noexcept { return effects_; }

    /// Treats an object that has been added to the world (asserted) as apply() would have. Cost: O(1).
    void prepare(btCollisionObject& object);

    /// Gives an object its own settings back and forgets it, before it is removed from the world or
    /// deleted. Cost: O(1).
    void release(btCollisionObject& object);

    /// Counts the bodies that are about to be swept in a step of this length [s]. With fastFrom, Bullet
    /// boxes and sweeps the ways of bodies in this step only if there are any: a body that is made fast
    /// within a step in which nobody else is, is swept from the next one on. Call it before each step, or
    /// never. Cost: a look at each object.
    int beforeStep(btScalar timeStep);

    /// A step of what is declared: with motion stepSimulation(timeStep, 0), with fastFrom after beforeStep();
    /// without motion the pairs and contacts of bodies as they stand, where pairs are declared; else
    /// nothing.
    void step(btScalar timeStep);

    /// Objects whose settings are overridden, those included that were removed without release().
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

    /// Refuses what is not declared, and asks the former filter for the rest.
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
    std::unordered_map<const btCollisionObject*, KeptBody> kept_;  // of those that are overridden
    std::uint64_t applyCount_ = 0;
    bool arePairsOld_ = false;       // until every pair has been asked about again
    bool areBodiesChanged_ = false;  // until all have been woken
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
