// SPDX-License-Identifier: Zlib
#include <integration/effects/simulation.hpp>

#include <integration/effects/simulation_contacts.inl>
#include <integration/effects/simulation_frame.inl>
#include <integration/effects/simulation_motion.inl>
#include <integration/effects/simulation_plan.inl>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/on_failure.hpp>
#include <broadphase/core/query_scope.hpp>
#include <broadphase/core/raise.hpp>
#include <broadphase/diagnostics.hpp>
#include <integration/effects/detail/parts.hpp>
#include <integration/effects/detail/simulation_parts.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hashphase {

std::string simulationError(const SceneEffects& effects) {
    for (const Effect effect : {Effect::rotation, Effect::friction}) {
        if (effects.set().contains(effect)) {
            return std::string(nameOf(effect)) +
                   " is declared, but only Bullet simulates it. Declare it for a Bullet world, or "
                   "leave it out.";
        }
    }
    return effectsError(effects);
}

template <class Scalar>
Simulation<Scalar>::Simulation(const SceneEffects& effects) {
    declare(effects);
}

template <class Scalar>
Simulation<Scalar>::~Simulation() = default;

// --- The declaration -----------------------------------------------------------------------------

template <class Scalar>
void Simulation<Scalar>::declare(const SceneEffects& effects) {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this),
                     "Simulation::declare() was called from within advance(). Call it after that "
                     "returns.");
    if (detail::QueryScope::isWithin(this)) {
        return;
    }
    if (const std::string error = simulationError(effects); !error.empty()) {
        detail::raiseInvalidArgument(error);
    }
    const bool hasIndex = effects.set().containsAny(kGridEffects);
    const bool keepsIndex = hasIndex && index_ && index_->config == effects.grid;
    std::unique_ptr<Index> index;
    std::unique_ptr<Walkers> walkers;
    std::vector<std::uint32_t> vacant;
    const detail::OnFailure dropMade([&] { dropUndeclared(); });
    makeParts(effects);
    if (effects.terrain && walkers_->up != static_cast<Eigen::Index>(effects.terrain->up)) {
        walkers = std::make_unique<Walkers>(effects.terrain->up);
    }
    if (hasIndex && !keepsIndex) {
        index = makeIndex(effects.grid);
    }
    for (std::size_t body = hasIndex ? 0 : positions_.size(); body > 0;) {
        --body;
        if (!isAlive(body)) {
            vacant.push_back(static_cast<std::uint32_t>(body));
        }
    }
    observers_.declare(effects);
    if (effects_.sleeping && effects.sleeping &&
        effects_.sleeping->interestRadius != effects.sleeping->interestRadius) {
        sleep_->mustLook = true;
    }
    effects_ = effects;
    if (walkers) {
        walkers_ = std::move(walkers);
    }
    if (!keepsIndex) {
        observers_.forgetProxies();
        pairing_ = nullptr;  // before the grid that it refers to
        index_ = std::move(index);
    }
    vacant_ = std::move(vacant);
    dropUndeclared();
    stockIsStale_ = true;
    changedOutside_ = true;
    takeStock();
}

template <class Scalar>
void Simulation<Scalar>::dropUndeclared() noexcept {
    detail::dropUnless(effects_.motion.has_value(), motion_);
    detail::dropUnless(effects_.terrain.has_value(), walkers_);
    detail::dropUnless(effects_.sleeping.has_value(), sleep_);
    detail::dropUnless(effects_.response.has_value(), contacts_);
    detail::dropUnless(effects_.sweep.has_value(), sweepers_);
    if (!effects_.radar) {
        std::vector<std::uint32_t>().swap(groups_);
    }
    if (index_ && !effects_.picking) {
        index_->grid.releaseRayMemory();
    }
}

// What is declared and not there yet, with columns of all bodies.
template <class Scalar>
void Simulation<Scalar>::makeParts(const SceneEffects& effects) {
    const std::size_t count = positions_.size();
    if (effects.motion && !motion_) {
        auto motion = std::make_unique<Motion>();
        motion->velocities.resize(count, Point::Zero());
        motion_ = std::move(motion);
    }
    if (effects.terrain && !walkers_) {
        walkers_ = std::make_unique<Walkers>(effects.terrain->up);
    }
    if (effects.sleeping && !sleep_) {
        auto sleep = std::make_unique<Sleep>();
        sleep->states.resize(count, Sleep::State::awake);
        sleep->slowFrames.resize(count, 0);
        sleep_ = std::move(sleep);
    }
    if (effects.response && !contacts_) {
        contacts_ = std::make_unique<Contacts>();
        contacts_->isCurrent = false;
    }
    if (effects.sweep && !sweepers_) {
        auto sweepers = std::make_unique<Sweepers>();
        sweepers->ofBody.resize(count, Sweepers::kNone);
        sweepers_ = std::move(sweepers);
    }
    if (effects.radar) {
        groups_.resize(count, 0);
    }
}

template <class Scalar>
void Simulation<Scalar>::demand(Effect effect, const char* call) const {
    if (!effects_.set().contains(effect)) {
        detail::raiseUndeclared(effect, call);
    }
}

// --- Bodies --------------------------------------------------------------------------------------

// Calls visit(column, value) for all that is kept of each body, but for generations and proxies.
template <class Scalar>
template <class Visit>
void Simulation<Scalar>::forEachColumn(const Body<Scalar>& body, const Visit& visit) {
    visit(positions_, body.position);
    visit(radii_, body.radius);
    visit(effectsOf_, body.effects);
    if (effects_.radar) {
        visit(groups_, body.group);
    }
    if (motion_) {
        visit(motion_->velocities, body.velocity);
    }
    if (sleep_) {
        visit(sleep_->states, body.isAsleep ? Sleep::State::slow : Sleep::State::awake);
        visit(sleep_->slowFrames, std::uint32_t{0});
    }
    if (sweepers_) {
        visit(sweepers_->ofBody, Sweepers::kNone);
    }
}

// The grid gives out indices; where there is none, the last one that became vacant.
template <class Scalar>
std::uint32_t Simulation<Scalar>::takeIndex(const Aabb<Scalar>& box, Mobility mobility) {
    if (index_) {
        detail::ensureCapacity(index_->proxies, index_->proxies.size() + 1);
        const ProxyId proxy = index_->grid.add(box, mobility);
        if (proxy.index == index_->proxies.size()) {
            index_->proxies.emplace_back();
        }
        index_->proxies[proxy.index] = proxy;
        return proxy.index;
    }
    if (vacant_.empty()) {
        return static_cast<std::uint32_t>(positions_.size());
    }
    const std::uint32_t index = vacant_.back();
    vacant_.pop_back();
    return index;
}

template <class Scalar>
void Simulation<Scalar>::checkIsBetweenFrames() const {
    HASHPHASE_ASSERT(
        !detail::QueryScope::isWithin(this),
        "Simulation: a body was added, removed or changed from within advance(). Change it "
        "after that returns.");
}

// There is room for all before the grid has the body, so that a body is there wholly or not at all.
template <class Scalar>
BodyId Simulation<Scalar>::add(const Body<Scalar>& body) {
    checkIsBetweenFrames();
    const std::size_t limit = positions_.size();
    detail::ensureCapacity(generations_, limit + 1);
    forEachColumn(body, [limit](auto& column, const auto& /*value*/) {
        detail::ensureCapacity(column, limit + 1);
    });
    const bool isAtRest =
        !motion_ || !body.effects.contains(Effect::motion) || (sleep_ && body.isAsleep);
    const std::uint32_t index = takeIndex(boxAt(body.position, body.radius),
                                          isAtRest ? Mobility::resting : Mobility::mobile);
    if (index == limit) {
        generations_.push_back(0);
    }
    forEachColumn(body, [&](auto& column, const auto& value) {
        if (index == limit) {
            column.push_back(value);
        } else {
            column[index] = value;
        }
    });
    ++size_;
    stockIsStale_ = true;
    changedOutside_ = true;
    return {index, ++generations_[index]};
}

template <class Scalar>
void Simulation<Scalar>::remove(BodyId id) {
    checkIsBetweenFrames();
    const std::size_t body = indexOf(id);
    if (index_) {
        index_->grid.remove(index_->proxies[body]);
        index_->proxies[body] = {};
    } else {
        vacant_.push_back(id.index);
    }
    if (sleep_ && sleep_->states[body] == Sleep::State::distant) {
        --sleep_->farCount;
    }
    observers_.forget(id.index);
    ++generations_[body];
    --size_;
    stockIsStale_ = true;
    changedOutside_ = true;
}

template <class Scalar>
bool Simulation<Scalar>::contains(BodyId id) const noexcept {
    return id.index < generations_.size() && generations_[id.index] == id.generation &&
           isAlive(id.index);
}

template <class Scalar>
std::size_t Simulation<Scalar>::indexOf(BodyId id) const {
    constexpr const char* kSentence =
        "Simulation: the id is null or stale. Pass an id that add() returned and that was not "
        "removed.";
    HASHPHASE_ASSERT(contains(id), kSentence);
    if (!contains(id)) {
        detail::raiseOutOfRange(kSentence);
    }
    return id.index;
}

template <class Scalar>
const Vector3<Scalar>& Simulation<Scalar>::position(BodyId id) const {
    return positions_[indexOf(id)];
}

template <class Scalar>
Scalar Simulation<Scalar>::radius(BodyId id) const {
    return radii_[indexOf(id)];
}

template <class Scalar>
EffectSet Simulation<Scalar>::effects(BodyId id) const {
    return effectsOf_[indexOf(id)];
}

template <class Scalar>
const Vector3<Scalar>& Simulation<Scalar>::velocity(BodyId id) const {
    demand(Effect::motion, "velocity()");
    return motion_->velocities[indexOf(id)];
}

template <class Scalar>
void Simulation<Scalar>::setVelocity(BodyId id, const Point& velocity) {
    demand(Effect::motion, "setVelocity()");
    checkIsBetweenFrames();
    const std::size_t body = indexOf(id);
    motion_->velocities[body] = velocity;
    between_[SceneCounter::wokeUp] += wakeUp(body) ? 1 : 0;
}

template <class Scalar>
bool Simulation<Scalar>::isAwake(std::size_t body) const noexcept {
    return isMovable(body) && (!sleep_ || sleep_->states[body] == Sleep::State::awake);
}

template <class Scalar>
bool Simulation<Scalar>::isAsleep(BodyId id) const {
    demand(Effect::sleeping, "isAsleep()");
    const std::size_t body = indexOf(id);
    return isMovable(body) && !isAwake(body);
}

template <class Scalar>
void Simulation<Scalar>::setPosition(BodyId id, const Point& position) {
    checkIsBetweenFrames();
    const std::size_t body = indexOf(id);
    positions_[body] = position;
    between_[SceneCounter::wokeUp] += wakeUp(body) ? 1 : 0;
    if (index_) {
        index_->grid.move(index_->proxies[body], boxOf(body));
        ++between_[SceneCounter::proxiesHashed];
    }
    changedOutside_ = true;
}

template <class Scalar>
void Simulation<Scalar>::watchPhases(std::function<void(std::string_view)> watch) {
    detail::PhaseWatch next;
    next.set(watch);
    observers_.watchPhases(std::move(watch));  // may run out of memory, as what is above
    watch_ = std::move(next);
}

template <class Scalar>
BodyId Simulation<Scalar>::bodyOf(ProxyId id) const {
    const bool isPresent =
        index_ && id.index < index_->proxies.size() && index_->proxies[id.index] == id;
    return isPresent && isAlive(id.index) ? BodyId{id.index, generations_[id.index]} : BodyId{};
}

// --- The scene -----------------------------------------------------------------------------------

template <class Scalar>
Terrain<Scalar>& Simulation<Scalar>::ground() {
    demand(Effect::terrain, "ground()");
    return walkers_->terrain;
}

template <class Scalar>
const Grid<Scalar>& Simulation<Scalar>::grid() const {
    if (!index_) {
        detail::raiseUndeclared(kGridEffects, "grid()");
    }
    return index_->grid;
}

template <class Scalar>
const PairChanges& Simulation<Scalar>::pairChanges() const {
    static constexpr PairChanges kNone;
    demand(Effect::pairs, "pairChanges()");
    return pairing_ ? pairing_->changes : kNone;
}

template <class Scalar>
std::size_t Simulation<Scalar>::pairCount() const {
    demand(Effect::pairs, "pairCount()");
    return pairing_ ? pairing_->pairs.count() : 0;
}

template <class Scalar>
std::vector<std::string_view> Simulation<Scalar>::phases() const {
    std::vector<std::string_view> names;
    for (const Phase& phase : phases_) {
        names.push_back(phase.name);
    }
    return names;
}

template <class Scalar>
ObservedScene<Scalar> Simulation<Scalar>::observed() const {
    return {.grid = index_->grid,
            .effects = effectsOf_,
            .groups = groups_,
            .present = present_,
            .common = common_};
}

template <class Scalar>
Picked<Scalar> Simulation<Scalar>::pick(const RayRegion<Scalar>& ray) {
    demand(Effect::picking, "pick()");
    takeStock();
    return observers_.pick(observed(), ray);
}

template <class Scalar>
QueryCost Simulation<Scalar>::select(const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
                                     std::vector<ProxyId>& selected, Containment containment) {
    demand(Effect::boxSelection, "select()");
    takeStock();
    return observers_.select(observed(), camera, a, b, selected, containment);
}

template class HASHPHASE_INSTANCE_EXPORT Simulation<float>;
template class HASHPHASE_INSTANCE_EXPORT Simulation<double>;

}  // namespace hashphase
