// SPDX-License-Identifier: Zlib
#pragma once

// Lets Bullet compute only what a scene calls for. By default everything is declared, and nothing changes.
//
//     WorldConfigurator configurator(world);
//     configurator.apply({.rotation = false, .friction = false});
//
// effect     without it                                       what is lost
// restingBoxes
//            setForceUpdateAllAabbs(false)                    after moving a static or sleeping body by hand,
//                                                             call updateSingleAabb()
// pairs      an overlap filter that refuses every pair        contacts, ghost objects' lists, response,
//                                                             sweep; rays and sweeps by hand are not
// response   CF_NO_CONTACT_RESPONSE on every object           bodies fall through each other; contacts are
//                                                             found and told all the same
// sweep      m_useContinuous and all CCD thresholds off       bodies that move by more than half their
//                                                             width in a step may pass thin ones
// sleeping   DISABLE_DEACTIVATION on dynamic bodies           resting bodies are computed in each step; heaps
//                                                             creep
// rotation   angular factor and velocity 0, no gyroscopic     bodies keep their orientation: nothing tips
//            forces                                           over, rolls, or swings about a joint
// friction   friction, rolling and spinning friction 0,       bodies slide for ever, down the least slope;
//            one friction direction                           heaps fall apart
//
// In instructions per step, a heap of 250 bodies saves 76 % without pairs, 58 % without response, 16 %
// without rotation, and 2 % without friction, which keeps its row in Bullet's solver. A heap at rest costs
// twice as much without sleeping. 2000 static bodies cost a fifteenth less without restingBoxes.
//
// response and sweep need pairs, friction and sweep need response: without these they are off, too.
//
// A frame   apply() when the declaration changes, prepare() for each body that is added to the world,
//           release() for each before it is removed; beforeStep() or step(). All between two steps.
// Settings  When an effect is declared again, and by the destructor, bodies and the world get back the
//           settings that they had before. A setting that the program changes meanwhile counts as theirs.
//           (But for DISABLE_DEACTIVATION, which bodies have anyway while sleeping is not declared.) Angular
//           velocities are not given back, nor what happened meanwhile.
// Lifetime  The world, its broadphase, the pair cache and its former filter outlive the configurator, and no
//           other filter wraps the one that it sets. Only objects in the world are touched. An object that is
//           removed without release(), as pools do, keeps the configurator's settings until it is back in the
//           world and apply() or prepare() meets it; if the configurator ends before, it keeps them for good.
//           So release() an object before it is deleted: a new object at its address that has one of these
//           settings by chance is taken for it.
// Other     Soft bodies and multibodies solve contacts of their own, and are left alone but for pairs.
// Memory    Nothing is held for an object with its own settings, unless it was removed without release():
//           then until it, or another object at its address, is back. Where memory runs out, std::bad_alloc
//           is passed on, and the call may be repeated; pairs are complete in the next step that returns.

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

/// What is declared for one body: see the table above.
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

    /// Restitution of every contact, 0 to 1; without it each body has its own.
    std::optional<btScalar> restitution{};

    /// Convex bodies that move in a step by more than this share of the smallest edge of their shape's box
    /// are swept; without it, bodies with CCD thresholds of their own are. Up to 0.5 no body passes a thin
    /// wall. Above 0.5, a body that moves by more than half its width and is not swept may have its middle
    /// beyond the wall when Bullet sees it, and is pushed out on the far side. Cost: a cast for each swept
    /// body, twice a step.
    std::optional<btScalar> fastFrom{};

    /// Bodies slower than this [m/s] may fall asleep; without it each has its own threshold.
    std::optional<btScalar> slowBelow{};

    /// Takes effects away from single objects; empty for none. Two objects pair only where both may.
    /// Also called wherever Bullet asks overlap filters, on any thread that does.
    std::function<BodyEffects(const btCollisionObject&)> effectsOf{};
};

/// Lets a Bullet world compute no more than is declared.
class HASHPHASE_BULLET_EXPORT WorldConfigurator {
public:
    explicit WorldConfigurator(btDiscreteDynamicsWorld& world);
    /// Gives back all settings. Pairs that come back take memory: where it may run out, call apply({}) first.
    ~WorldConfigurator();
    WorldConfigurator(const WorldConfigurator&) = delete;
    WorldConfigurator& operator=(const WorldConfigurator&) = delete;

    /// Sets what Bullet computes from the next step on. When this changes how bodies move, all bodies wake.
    /// Pairs change at once; under a broadphase other than SpatialHashBroadphase each object then gets a new
    /// proxy. Cost: a look at each object, and at each contact and pair where these change.
    void apply(const WorldEffects& effects);
    [[nodiscard]] const WorldEffects& effects() const noexcept { return effects_; }

    /// Configures an object that has been added to the world (asserted), as apply() would. Cost: O(1).
    void prepare(btCollisionObject& object);

    /// Gives an object its own settings back and forgets it, before it is removed from the world or
    /// deleted. Cost: O(1).
    void release(btCollisionObject& object);

    /// Returns the number of bodies that are about to be swept in a step of this length [s]. With fastFrom,
    /// Bullet boxes and sweeps ways in this step only if there are such bodies: a body that becomes fast
    /// within a step without them is swept from the next step on. Call it before each step, or never. Cost: a
    /// look at each object.
    int beforeStep(btScalar timeStep);

    /// Runs a step of this length [s]: with motion, stepSimulation(timeStep, 0), with fastFrom after
    /// beforeStep(); without motion, the pairs and contacts of bodies as they stand, where pairs are
    /// declared; else nothing.
    void step(btScalar timeStep);

    /// Number of objects whose settings are overridden, including objects removed without release().
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
