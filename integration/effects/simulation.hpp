// SPDX-License-Identifier: Zlib
#pragma once

// The paper's simulation: spheres that move, stand on a terrain, bounce, sweep, sleep, and are observed. Source:
// Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by Spatial Hashing", 2005.
//
//     Simulation<float> simulation(effects);
//     BodyId ball = simulation.add({.position = {0, 5, 0}, .velocity = {1, 0, 0}});
//     simulation.advance(1.0F / 60);
//
// Undeclared  An undeclared effect costs nothing, not even a branch in a loop. A call that needs an undeclared effect
//             throws UndeclaredEffect. Rotation and friction run only in Bullet.
// Exact       Only motion, terrain, response, sweep and sleeping decide the positions of bodies. Positions are equal
//             to the last bit for any number of threads, and for any other declared effects.
// Bodies      A body takes part in those effects of Body::effects that are declared. If it takes no part in motion,
//             it stands still, and other bodies bounce off it. If it takes no part in response, it is a sensor: its
//             pairs are reported, but their bodies do not bounce.
// Threads     Const members may run on several threads at the same time. During other calls, no other thread may use
//             the simulation.
// Failure     If memory runs out in advance(), some bodies may have moved. The next frame works, and reports all
//             pairs as born. If add() or remove() fails, nothing has changed.
// Units       metres, seconds
// Misuse      Asserted: ids are valid, and time steps are finite and not negative. Without assertions, invalid ids
//             throw std::out_of_range. Asserted: callbacks of advance() do not add, remove or change bodies, and do
//             not call declare() or advance(). Without assertions, such a declare() or advance() does nothing.

#include <broadphase/core/fixed_list.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/parallel_for.hpp>
#include <integration/effects/detail/phase_watch.hpp>
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

/// Identifies one body of one simulation. `index` is also the index of the body's proxy.
struct BodyId {
    std::uint32_t index = 0;
    std::uint32_t generation = 0;

    /// True for BodyId{}, which identifies no body.
    [[nodiscard]] constexpr bool isNull() const noexcept { return generation == 0; }
    friend constexpr auto operator<=>(const BodyId&, const BodyId&) = default;
};

/// A sphere to add.
template <class Scalar>
struct Body {
    Vector3<Scalar> position = Vector3<Scalar>::Zero();  ///< of the centre [m]
    Scalar radius = 1;                                   ///< [m]
    Vector3<Scalar> velocity = Vector3<Scalar>::Zero();  ///< [m/s], if motion is declared
    EffectSet effects = EffectSet::all();                ///< effects in which the body takes part
    std::uint32_t group = 0;                             ///< radar group, if radar is declared
    bool isAsleep = false;                               ///< at first, if sleeping is declared
};

/// Simulates spheres with the declared effects, frame by frame.
template <class Scalar>
class HASHPHASE_EFFECTS_TEMPLATE_EXPORT Simulation {
public:
    using Point = Vector3<Scalar>;

    /// Throws std::invalid_argument with the string simulationError(effects), if this string is not empty.
    explicit Simulation(const SceneEffects& effects = {});
    ~Simulation();
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// Changes the declaration. Makes tables of new effects, and frees tables of removed effects. Bodies stay.
    ///
    ///     motion     newly declared: all bodies stand still
    ///     sleeping   newly declared: all bodies are awake
    ///     radar      newly declared: all bodies are in group 0
    ///     terrain    declared with another TerrainEffect::up: all triangles are removed
    ///     pairs      newly declared: all pairs are reported as born
    ///     the grid   newly needed, or with another GridConfig: old ProxyIds are invalid, all pairs are reported as
    ///                born, and proxies in a zone enter the zone again
    ///
    /// Throws std::invalid_argument as the constructor, and changes nothing. If it throws std::bad_alloc, nothing has
    /// changed, or the next advance() completes the change. Cost: at most as adding all bodies.
    void declare(const SceneEffects& effects);

    [[nodiscard]] const SceneEffects& declared() const noexcept { return effects_; }

    // --- Bodies ----------------------------------------------------------------------------------

    /// Adds a sphere. Cost: O(1) amortised. After one or more calls, the next frame, pick() or select() makes one
    /// pass over all bodies.
    BodyId add(const Body<Scalar>& body);

    /// Removes a body. Its id is never valid again. Cost: as add().
    void remove(BodyId id);

    /// Returns whether the id belongs to a body that was not removed.
    [[nodiscard]] bool contains(BodyId id) const noexcept;
    [[nodiscard]] std::size_t size() const noexcept { return size_; }

    /// The centre [m]. References to positions and velocities are valid until the next add() or declare().
    [[nodiscard]] const Point& position(BodyId id) const;
    [[nodiscard]] Scalar radius(BodyId id) const;
    [[nodiscard]] EffectSet effects(BodyId id) const;

    /// The velocity [m/s]. setVelocity() wakes the body. velocity() and setVelocity() need Effect::motion.
    [[nodiscard]] const Point& velocity(BodyId id) const;
    void setVelocity(BodyId id, const Point& velocity);

    /// Returns whether the body takes part in motion and is asleep. Needs Effect::sleeping.
    [[nodiscard]] bool isAsleep(BodyId id) const;

    /// Puts the body's centre at `position` [m] immediately. The body wakes, and hits no bodies between its old and
    /// new positions.
    void setPosition(BodyId id, const Point& position);

    /// Returns the body of a proxy; null if the proxy belongs to no body of this simulation.
    [[nodiscard]] BodyId bodyOf(ProxyId id) const;

    // --- Scene -----------------------------------------------------------------------------------

    /// The triangles that bodies stand on. Needs Effect::terrain. Bodies that sleep on changed or removed triangles
    /// stay asleep. Find these bodies with a ChangedGround, and wake each body by setPosition() at its present
    /// position.
    [[nodiscard]] Terrain<Scalar>& ground();

    /// Use the observers to set view, interest, zones and colours, and to read results. Bodies farther from the
    /// interest than SleepingEffect::interestRadius sleep.
    [[nodiscard]] Observers<Scalar>& observers() noexcept { return observers_; }
    [[nodiscard]] const Observers<Scalar>& observers() const noexcept { return observers_; }

    /// The grid of all bodies. add(), remove() and setPosition() change the grid immediately. advance() updates boxes
    /// only while at least one body takes part in one of kGridEffects. Needs one of kGridEffects.
    [[nodiscard]] const Grid<Scalar>& grid() const;

    // --- Frame -----------------------------------------------------------------------------------

    /// Simulates `seconds` [s] in one step. Returns the cost.
    const SceneCost& advance(Scalar seconds, ParallelFor parallelFor = serialFor);

    /// Cost of the last advance(), and of the calls between the last two advance().
    [[nodiscard]] const SceneCost& cost() const noexcept { return cost_; }

    /// Names of a frame's phases, in order, such as "move", "pair", "respond", "observe" ...
    [[nodiscard]] std::vector<std::string_view> phases() const;

    /// Calls `watch` with the phase's name after each phase, for a profiler. In the phase "observe", also calls
    /// `watch` after each observing effect, with its name. To stop the calls, pass an empty function. `watch` may
    /// call watchPhases(): the new function is called from the next phase on.
    void watchPhases(std::function<void(std::string_view)> watch);

    /// Lets two bodies bounce if they touch and approach each other. Use it for pairs from another broadphase.
    /// Returns whether they bounced. They bounce only if effects() of both contain Effect::response, which need not
    /// be declared. The order of `first` and `second` does not matter. To replace the response effect, call collide()
    /// after advance() for all touching pairs, sorted by the lower index of the two bodies, then by the higher index.
    /// Results are equal to the last bit if no body sweeps or falls asleep. `restitution`: see ResponseEffect. Needs
    /// Effect::motion. Asserted: the bodies differ. Cost: O(1).
    bool collide(BodyId first, BodyId second, double restitution = 1);

    /// Births and deaths of pairs in the last frame. Valid until the next frame. Needs Effect::pairs.
    [[nodiscard]] const PairChanges& pairChanges() const;

    /// Number of pairs in the last frame. Needs Effect::pairs.
    [[nodiscard]] std::size_t pairCount() const;

    // --- On request ------------------------------------------------------------------------------

    /// As Observers::pick() and Observers::select(), for the bodies of this simulation.
    [[nodiscard]] Picked<Scalar> pick(const RayRegion<Scalar>& ray);
    QueryCost select(const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
                     std::vector<ProxyId>& selected,
                     Containment containment = Containment::touching);

    /// Returns the bytes of each table, capacity included: exactly 0 for undeclared effects. Cost: O(zones).
    [[nodiscard]] SceneFootprint footprint() const;

    /// Returns the first broken invariant in a sentence, or an empty string if all invariants hold. Call it after
    /// advance(). If a body swept in that frame, pairs are not checked.
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

    void checkIsBetweenFrames() const;
    /// Returns the body's index. Asserted: the id is valid.
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
    /// Returns whether the velocity of the body can change.
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

    // Indexed by BodyId::index; an even generation means no body.
    std::vector<Point> positions_;
    std::vector<Scalar> radii_;
    std::vector<EffectSet> effectsOf_;
    std::vector<std::uint32_t> generations_;
    std::vector<std::uint32_t> vacant_;  // free indices, if there is no grid to choose indices
    std::vector<std::uint32_t> groups_;  // radar groups, if radar is declared
    std::size_t size_ = 0;
    EffectSet present_;  // effects in which some body takes part
    EffectSet common_;   // effects in which every body takes part

    // Tables of effects; null if not needed.
    std::unique_ptr<Motion> motion_;
    std::unique_ptr<Walkers> walkers_;
    std::unique_ptr<Sleep> sleep_;
    std::unique_ptr<Index> index_;
    std::unique_ptr<Pairing> pairing_;
    std::unique_ptr<Contacts> contacts_;
    std::unique_ptr<Sweepers> sweepers_;
    Observers<Scalar> observers_;

    // The current frame.
    Scalar seconds_ = 0;
    const ParallelFor* parallelFor_ = nullptr;
    Scalar farthestMove_ = 0;     // largest distance that a corner of a box moved
    bool changedOutside_ = true;  // changes since the last frame, by calls other than advance()
    SceneCost cost_;
    SceneCost between_;  // work since the last frame, part of the next frame's cost
    detail::PhaseWatch watch_;
};

/// Returns the reason why a Simulation cannot run the declaration: effectsError(), or an effect that runs only in
/// Bullet. Returns an empty string if a Simulation can.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::string simulationError(const SceneEffects& effects);

extern template class Simulation<float>;
extern template class Simulation<double>;

}  // namespace hashphase

/// Allows a BodyId as key of std::unordered_map.
template <>
struct std::hash<hashphase::BodyId> : hashphase::detail::IdHash<hashphase::BodyId> {};
