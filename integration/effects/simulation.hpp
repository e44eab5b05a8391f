// SPDX-License-Identifier: Zlib
#pragma once

// The paper's simulation: spheres that roam, stand on a terrain, bounce off each other, sweep, sleep,
// and are looked at; of all that, just what the scene declares. After Hastings, Mesit and Guha,
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
// Undeclared  an effect that is not declared has no phase, no table, no cost, and no branch in a loop. A
//             call for it throws UndeclaredEffect. Rotation and friction are Bullet's alone.
// Kinds       Motion, terrain, response, sweep and sleeping change where bodies are; that is a function
//             of these and the bodies, to the last bit. The others look at it: what they find depends on
//             where bodies are, and on themselves.
// Bodies      take part in what they are added for; in what is not declared nobody does. A body that
//             does not take part in motion stands for ever, and others bounce off it; one that does
//             not take part in response is a sensor.
// Threads     Everything needs the simulation for itself, but const members do not from each other.
// Failure     Where memory runs out in advance(), some bodies may have moved; the next frame goes on, and
//             tells all pairs as born. add() has added nothing then, and remove() has removed nothing.
// Units       metres, seconds
// Misuse      An id of no body and a time step that is negative or not finite are asserted.

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

    /// True for BodyId{}, which names nobody.
    [[nodiscard]] constexpr bool isNull() const noexcept { return generation == 0; }
    friend constexpr auto operator<=>(const BodyId&, const BodyId&) = default;
};

/// A sphere, as it is added.
template <class Scalar>
struct Body {
    Vector3<Scalar> position = Vector3<Scalar>::Zero();  // of the centre [m]
    Scalar radius = 1;                                   // [m]
    Vector3<Scalar> velocity = Vector3<Scalar>::Zero();  // [m/s]; kept if motion is declared
    EffectSet effects = EffectSet::all();                // what it takes part in
    std::uint32_t group = 0;  // in which it is counted; kept if the radar is declared
    bool isAsleep = false;    // to begin with; kept if sleeping is declared
};

/// Runs frames of spheres: what is declared, and nothing else.
template <class Scalar>
class HASHPHASE_EFFECTS_EXPORT Simulation {
public:
    using Point = Vector3<Scalar>;

    /// Throws std::invalid_argument with simulationError(effects).
    explicit Simulation(const SceneEffects& effects = {});
    ~Simulation();
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// Goes on with another declaration: tables of what is new appear, those of what is not declared
    /// any more are gone. Bodies are where they are; if motion is new they stand still, if sleeping is they
    /// are awake, if the radar is they are in group 0, and on an axis TerrainEffect::up that is another one
    /// there are no triangles. Where pairs are new, all of them are told as born. Where there was no grid,
    /// or one with another GridConfig, all bodies are filed anew: ProxyIds of before name nobody, pairs
    /// are told as born, and who is in a zone enters it again. Throws as above, and then nothing has
    /// changed; std::bad_alloc, and then nothing has changed, or the next call makes what is missing.
    /// Cost: up to that of adding all bodies.
    void declare(const SceneEffects& effects);

    [[nodiscard]] const SceneEffects& declared() const noexcept { return effects_; }

    // --- Bodies ----------------------------------------------------------------------------------

    /// Cost: O(1) amortised, and one look at all bodies in the next frame.
    BodyId add(const Body<Scalar>& body);

    /// Its id is never valid again. Cost: as above.
    void remove(BodyId id);

    [[nodiscard]] bool contains(BodyId id) const noexcept;
    [[nodiscard]] std::size_t size() const noexcept { return size_; }

    [[nodiscard]] const Point& position(BodyId id) const;
    [[nodiscard]] Scalar radius(BodyId id) const;
    [[nodiscard]] EffectSet effects(BodyId id) const;

    /// Needs motion.
    [[nodiscard]] const Point& velocity(BodyId id) const;
    void setVelocity(BodyId id, const Point& velocity);

    /// Whether it would move and does not. Needs sleeping.
    [[nodiscard]] bool isAsleep(BodyId id) const;

    /// Puts the body elsewhere at once; it does not sweep there.
    void setPosition(BodyId id, const Point& position);

    /// The body of a proxy, as events and queries name it.
    [[nodiscard]] BodyId bodyOf(ProxyId id) const;

    // --- Scene -----------------------------------------------------------------------------------

    /// What bodies stand on: add triangles here. Needs terrain.
    [[nodiscard]] Terrain<Scalar>& ground();

    /// View, interest, zones and colours are set here, and what was found is read. What lies beyond the
    /// interest radius of sleeping sleeps.
    [[nodiscard]] Observers<Scalar>& observers() noexcept { return observers_; }
    [[nodiscard]] const Observers<Scalar>& observers() const noexcept { return observers_; }

    /// The grid of all bodies, as of the last frame; while no body takes part in one of kGridEffects, it
    /// has the boxes of when one did. Needs one of kGridEffects.
    [[nodiscard]] const Grid<Scalar>& grid() const;

    // --- Frame -----------------------------------------------------------------------------------

    /// Simulates so long [s], in one step. The result does not depend on `parallelFor`. Returns the
    /// cost.
    const SceneCost& advance(Scalar seconds, ParallelFor parallelFor = serialFor);

    /// What the last frame cost, and what was asked, woken and moved before it.
    [[nodiscard]] const SceneCost& cost() const noexcept { return cost_; }

    /// The phases of a frame, in their order.
    [[nodiscard]] std::vector<std::string_view> phases() const;

    /// Calls it after each phase with the phase's name, for a profiler: also, by their effects' names, after
    /// each of the parts of "observe", which then is what remains. Null: calls nobody.
    void watchPhases(std::function<void(std::string_view)> watch);

    /// Lets two bodies bounce off each other if they touch and approach, as the frame does with its own
    /// pairs: for pairs that another broadphase has found. Returns whether they did; bodies that do not
    /// take part in response do not. Called for all pairs that touch, sorted by the bodies' indices, after
    /// advance() without response, it moves bodies as the same frame with response does, to the
    /// last bit. `restitution` is as that of ResponseEffect. Needs motion. Cost: O(1).
    bool collide(BodyId first, BodyId second, double restitution = 1);

    /// Pairs that were born and died in the last frame. Valid until the next one. Needs pairs.
    [[nodiscard]] const PairChanges& pairChanges() const;

    /// How many pairs there are since the last frame. Needs pairs.
    [[nodiscard]] std::size_t pairCount() const;

    // --- When it is asked for --------------------------------------------------------------------

    /// As those of Observers.
    [[nodiscard]] Picked<Scalar> pick(const RayRegion<Scalar>& ray);
    QueryCost select(const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
                     std::vector<ProxyId>& selected,
                     Containment containment = Containment::touching);

    /// Bytes by table, capacity included; exactly 0 for each table of an effect that is not declared.
    /// Cost: O(zones).
    [[nodiscard]] SceneFootprint footprint() const;

    /// Says which invariant is broken, in a sentence; empty when all hold (ask after advance()):
    /// - Those of the grid and the sweeps, and of the pairs in a frame in which nobody swept.
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

/// effectsError(), and what a Simulation cannot run.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::string simulationError(const SceneEffects& effects);

extern template class Simulation<float>;
extern template class Simulation<double>;

}  // namespace hashphase

/// For keys of std::unordered_map.
template <>
struct std::hash<hashphase::BodyId> : hashphase::detail::IdHash<hashphase::BodyId> {};
