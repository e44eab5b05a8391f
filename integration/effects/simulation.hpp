// SPDX-License-Identifier: Zlib
#pragma once

// The paper's simulation: spheres that roam, stand on a terrain, bounce off each other, sweep, sleep, and
// are looked at. It runs the effects that the scene declares, and no others. After Hastings, Mesit and Guha,
// "Optimization of Large-Scale, Real-Time Simulations by Spatial Hashing", 2005.
//
//     SceneEffects effects;
//     effects.motion.emplace();
//     effects.pairs.emplace();
//     effects.response.emplace();
//     Simulation<float> simulation(effects);
//     BodyId ball = simulation.add({.position = {0, 5, 0}, .velocity = {1, 0, 0}});
//     simulation.advance(1.0F / 60);
//
// Undeclared  An effect that is not declared has no phase, no table, no cost, and no branch in a loop. A
//             call for it throws UndeclaredEffect. Rotation and friction run only under Bullet.
// Kinds       Motion, terrain, response, sweep and sleeping decide where bodies are, to the last bit,
//             whatever else is declared. The other effects only look: what each of them finds depends on
//             where bodies are, and on its own settings.
// Bodies      A body takes part in the effects that it is added with, as far as these are declared. A body
//             without motion stands for ever, and others bounce off it. A body without response is a sensor.
// Threads     Const members may run at the same time. Everything else needs the simulation for itself.
// Failure     Where memory runs out in advance(), some bodies may have moved; the next frame goes on, and
//             tells all pairs as born. Where it runs out in add() or remove(), nothing has changed.
// Units       metres, seconds
// Misuse      An id of no body, and a time step that is negative or not finite, are asserted. Without
//             assertions, a call with an id of no body throws std::out_of_range.

#include <broadphase/core/fixed_list.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/parallel_for.hpp>
#include <integration/effects/export.hpp>
#include <integration/effects/observers.hpp>
#include <integration/effects/scene_cost.hpp>
#include <integration/effects/scene_effects.hpp>
#include <integration/terrain/terrain.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase {

/// A value that names one body of one simulation; zero is null. `index` is that of the body's proxy.
struct BodyId {
    std::uint32_t index = 0;
    std::uint32_t generation = 0;

    /// True for BodyId{}, which names no body.
    [[nodiscard]] constexpr bool isNull() const noexcept { return generation == 0; }
    friend constexpr auto operator<=>(const BodyId&, const BodyId&) = default;
};

/// A sphere, as it is added.
template <class Scalar>
struct Body {
    Vector3<Scalar> position = Vector3<Scalar>::Zero();  ///< of the centre [m]
    Scalar radius = 1;                                   ///< [m]
    Vector3<Scalar> velocity = Vector3<Scalar>::Zero();  ///< [m/s]; kept if motion is declared
    EffectSet effects = EffectSet::all();                ///< what the body takes part in
    std::uint32_t group = 0;  ///< in which the radar counts the body; kept if the radar is declared
    bool isAsleep = false;    ///< at first; kept if sleeping is declared
};

/// Runs frames of spheres: what is declared, and nothing else.
template <class Scalar>
class HASHPHASE_EFFECTS_TEMPLATE_EXPORT Simulation {
public:
    using Point = Vector3<Scalar>;

    /// Throws std::invalid_argument with simulationError(effects).
    explicit Simulation(const SceneEffects& effects = {});
    ~Simulation();
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// Goes on with another declaration. Tables of new effects appear; tables of effects that are not
    /// declared any more are freed. Bodies stay where they are.
    ///
    /// motion     new: all bodies stand still
    /// sleeping   new: all bodies are awake
    /// radar      new: all bodies are in group 0
    /// terrain    with another TerrainEffect::up: there are no triangles
    /// pairs      new: all pairs are told as born
    /// the grid   new, or with another GridConfig: all bodies are filed again. Old ProxyIds are not valid any
    ///            more, all pairs are told as born, and proxies in a zone enter it again.
    ///
    /// Throws std::invalid_argument with simulationError(effects); then nothing has changed. Throws
    /// std::bad_alloc; then nothing has changed, or the next call makes what is missing. Cost: up to that of
    /// adding all bodies.
    void declare(const SceneEffects& effects);

    [[nodiscard]] const SceneEffects& declared() const noexcept { return effects_; }

    // --- Bodies ----------------------------------------------------------------------------------

    /// Adds a sphere. Where memory runs out, it adds nothing. Cost: O(1) amortised, and one look at all
    /// bodies in the next frame.
    BodyId add(const Body<Scalar>& body);

    /// Removes a body; its id is never valid again. Cost: as add().
    void remove(BodyId id);

    /// Whether the id names a body that was not removed.
    [[nodiscard]] bool contains(BodyId id) const noexcept;
    /// Number of bodies.
    [[nodiscard]] std::size_t size() const noexcept { return size_; }

    /// The centre [m]. References to positions and velocities are valid until the next add() or declare().
    [[nodiscard]] const Point& position(BodyId id) const;
    [[nodiscard]] Scalar radius(BodyId id) const;
    [[nodiscard]] EffectSet effects(BodyId id) const;

    /// [m/s]. Setting it wakes the body. Both need motion.
    [[nodiscard]] const Point& velocity(BodyId id) const;
    void setVelocity(BodyId id, const Point& velocity);

    /// True when the body takes part in motion and stands still because it sleeps. Needs sleeping.
    [[nodiscard]] bool isAsleep(BodyId id) const;

    /// Puts the centre of the body at `position` [m] at once. The body wakes, and does not sweep there.
    void setPosition(BodyId id, const Point& position);

    /// The body of a proxy that an event or a query names; null for a proxy that is no body here.
    [[nodiscard]] BodyId bodyOf(ProxyId id) const;

    // --- Scene -----------------------------------------------------------------------------------

    /// What bodies stand on: add triangles here. Needs terrain. Bodies that sleep on what is changed or removed
    /// sleep on: a ChangedGround tells who stands there, and setPosition() to where they are wakes them.
    [[nodiscard]] Terrain<Scalar>& ground();

    /// Set view, interest, zones and colours here, and read what was found. Bodies beyond the interest radius
    /// of sleeping sleep.
    [[nodiscard]] Observers<Scalar>& observers() noexcept { return observers_; }
    [[nodiscard]] const Observers<Scalar>& observers() const noexcept { return observers_; }

    /// The grid of all bodies, as of the last frame. While no body takes part in one of kGridEffects, the
    /// grid keeps the boxes of the last frame in which one did. Needs one of kGridEffects.
    [[nodiscard]] const Grid<Scalar>& grid() const;

    // --- Frame -----------------------------------------------------------------------------------

    /// Simulates `seconds` [s] in one step. Returns the cost. The result does not depend on `parallelFor`.
    const SceneCost& advance(Scalar seconds, ParallelFor parallelFor = serialFor);

    /// What the last frame cost, including what was asked, woken and moved between the frame before and it.
    [[nodiscard]] const SceneCost& cost() const noexcept { return cost_; }

    /// The names of a frame's phases, in their order: "move", "pair", "respond", "observe" ...
    [[nodiscard]] std::vector<std::string_view> phases() const;

    /// Calls `watch` after each phase with the phase's name, for a profiler. Calls it after each part of
    /// "observe" too, with the name of the part's effect; "observe" then is the rest. An empty function ends
    /// the calls.
    void watchPhases(std::function<void(std::string_view)> watch);

    /// Lets two bodies bounce off each other if they touch and approach, as a frame does with its own pairs:
    /// for pairs that another broadphase has found. Returns whether they bounced; bodies without response
    /// never do. Called after advance() without response for all pairs that touch, sorted by the
    /// bodies' indices, it has the same result as a frame with response, to the last bit. For `restitution`
    /// see ResponseEffect. A body and itself are asserted. Needs motion. Cost: O(1).
    bool collide(BodyId first, BodyId second, double restitution = 1);

    /// Pairs that were born and died in the last frame. Valid until the next one. Needs pairs.
    [[nodiscard]] const PairChanges& pairChanges() const;

    /// Number of pairs as of the last frame. Needs pairs.
    [[nodiscard]] std::size_t pairCount() const;

    // --- When it is asked for --------------------------------------------------------------------

    /// As Observers::pick() and Observers::select(), over the bodies of this simulation.
    [[nodiscard]] Picked<Scalar> pick(const RayRegion<Scalar>& ray);
    QueryCost select(const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
                     std::vector<ProxyId>& selected,
                     Containment containment = Containment::touching);

    /// Returns the bytes of each table, capacity included: exactly 0 for each table of an effect that is not
    /// declared. Cost: O(zones).
    [[nodiscard]] SceneFootprint footprint() const;

    /// Says which invariant is broken, in a sentence; empty when all hold (ask after advance()):
    /// - Those of the grid and the sweeps, and of the pairs in a frame in which no body swept.
    /// - Each body's proxy has the body's index and box.
    /// - Contacts are the present pairs, where some body responds.
    [[nodiscard]] std::string validate() const;

private:
    struct Motion;
    struct Walkers;
    struct Sleep;
    struct Index;
    struct Pairing;
    struct Contacts;
    struct Sweepers;

    struct Phase {
        std::string_view name;
        void (Simulation::*run)();
    };

    /// The body's index; it is alive (asserted).
    [[nodiscard]] std::size_t indexOf(BodyId id) const;
    [[nodiscard]] bool isAlive(std::size_t body) const noexcept {
        return (generations_[body] & 1) != 0;
    }
    [[nodiscard]] static Aabb<Scalar> boxAt(const Point& position, Scalar radius) {
        const auto half = Point::Constant(radius);
        return {position - half, position + half};
    }
    [[nodiscard]] Aabb<Scalar> boxOf(std::size_t body) const {
        return boxAt(positions_[body], radii_[body]);
    }
    /// Whether anything can change its velocity.
    [[nodiscard]] bool isMovable(std::size_t body) const noexcept {
        return motion_ != nullptr && effectsOf_[body].contains(Effect::motion);
    }
    [[nodiscard]] bool isAwake(std::size_t body) const noexcept;
    [[nodiscard]] ObservedScene<Scalar> observed() const;
    void demand(Effect effect, const char* call) const;

    template <class Visit>
    void forEachColumn(const Body<Scalar>& body, const Visit& visit);
    [[nodiscard]] std::uint32_t takeIndex(const Aabb<Scalar>& box, Mobility mobility);
    void makeParts(const SceneEffects& effects);
    void dropUndeclared() noexcept;
    [[nodiscard]] std::unique_ptr<Index> makeIndex(const GridConfig& config) const;
    void takeStock();
    void setPairing(bool isWanted);
    void setFiling(bool isFiling);
    void compile();
    void recover() noexcept;
    enum class Filing { none, plain, measured };
    template <bool isBounded, Filing filing>
    void moveBodies();
    template <Filing filing>
    void fileBodies();
    template <Filing filing>
    class BodyFiler;
    void note(Filing filing, Scalar farthest);
    [[nodiscard]] static Phase movePhase(bool isBounded, Filing filing);
    [[nodiscard]] bool wakeUp(std::size_t body);
    template <bool areAwake>
    [[nodiscard]] bool bounce(std::size_t a, std::size_t b, const Point& apart, Scalar bounciness,
                              SceneCost& cost);
    [[nodiscard]] static Scalar bouncinessOf(double restitution) {
        return static_cast<Scalar>(1 + restitution);
    }
    template <bool allRespond>
    void respondTo();
    void addWalker(std::uint32_t body, Scalar moved);
    void putWalkersOnGround();
    void countStoppedSweepers();

    // The phases.
    void wake();
    void aim();
    void stand();
    void file();
    void fileAndMeasure();
    void sweep();
    void pair();
    void updateGrid();
    void gather();
    void respond();
    void meet();
    void land();
    void rest();
    void observe();

    SceneEffects effects_;
    detail::FixedList<Phase, 16> phases_;
    bool stockIsStale_ = true;

    // Bodies by index; those without one have an even generation.
    std::vector<Point> positions_;
    std::vector<Scalar> radii_;
    std::vector<EffectSet> effectsOf_;
    std::vector<std::uint32_t> generations_;
    std::vector<std::uint32_t> vacant_;  // indices without a body, where no grid gives them out
    std::vector<std::uint32_t> groups_;  // where radar is declared
    std::size_t size_ = 0;
    EffectSet present_;  // what some body takes part in
    EffectSet common_;   // what every body takes part in

    // Tables of effects.
    std::unique_ptr<Motion> motion_;
    std::unique_ptr<Walkers> walkers_;
    std::unique_ptr<Sleep> sleep_;
    std::unique_ptr<Index> index_;
    std::unique_ptr<Pairing> pairing_;
    std::unique_ptr<Contacts> contacts_;
    std::unique_ptr<Sweepers> sweepers_;
    Observers<Scalar> observers_;

    // The frame under way.
    Scalar seconds_ = 0;
    const ParallelFor* parallelFor_ = nullptr;
    Scalar farthestMove_ = 0;     // of a corner of a box
    bool changedOutside_ = true;  // since the last frame, by other than advance()
    SceneCost cost_;
    SceneCost between_;  // what happened since, which the next frame's has as well
    std::function<void(std::string_view)> watch_;
};

/// Says in a sentence why a Simulation cannot run the declaration: as effectsError(), and for effects that
/// only Bullet runs. Empty when it can.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::string simulationError(const SceneEffects& effects);

extern template class Simulation<float>;
extern template class Simulation<double>;

}  // namespace hashphase

/// For keys of std::unordered_map.
template <>
struct std::hash<hashphase::BodyId> : hashphase::detail::IdHash<hashphase::BodyId> {};
