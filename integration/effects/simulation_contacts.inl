// SPDX-License-Identifier: Zlib
#pragma once

// What comes of pairs: who touches, and how it bounces off.

#include <integration/effects/detail/simulation_parts.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace hashphase {
namespace {

/// When two spheres, of which one moves by `way` against the other, first touch, as a share of the way;
/// more than 1 when they do not, or when they only part. `apart` is from the one that moves to the
/// other. By the quadratic formula that does not cancel.
template <class Scalar>
double timeOfContact(const Vector3<Scalar>& apart, const Vector3<Scalar>& way, Scalar radii) {
    const Vector3<double>& p = apart.template cast<double>();
    const Vector3<double>& d = way.template cast<double>();
    const auto r = static_cast<double>(radii);
    constexpr double never = 2;
    const double closing = p.dot(d);
    if (!(closing > 0)) {
        return never;
    }
    const double distance = p.squaredNorm() - r * r;
    if (distance <= 0) {
        return 0;
    }
    const double discriminant = closing * closing - d.squaredNorm() * distance;
    return discriminant >= 0 ? distance / (closing + std::sqrt(discriminant)) : never;
}

/// Merges what is present with what has changed since; all are sorted.
template <class BodyPair, class BodyPairOf>
void applyChanges(const std::vector<BodyPair>& present, const PairChanges& changes,
                  const BodyPairOf& bodyPairOf, std::vector<BodyPair>& next) {
    next.clear();
    auto fresh = changes.born.begin();
    auto gone = changes.died.begin();
    for (const BodyPair& pair : present) {
        if (gone != changes.died.end() && bodyPairOf(*gone) == pair) {
            ++gone;
            continue;
        }
        for (; fresh != changes.born.end() && bodyPairOf(*fresh) < pair; ++fresh) {
            next.push_back(bodyPairOf(*fresh));
        }
        next.push_back(pair);
    }
    std::transform(fresh, changes.born.end(), std::back_inserter(next), bodyPairOf);
}

}  // namespace

// The present pairs, from those of the last frame and what has changed; all three are sorted. Where
// nobody responded in the last frame, all are asked for.
template <class Scalar>
void Simulation<Scalar>::gather() {
    using BodyPair = typename Contacts::BodyPair;
    const auto bodyPairOf = [](const ProxyPair& pair) {
        return BodyPair{pair.first.index, pair.second.index};
    };
    std::vector<BodyPair>& present = contacts_->present;
    if (!contacts_->isCurrent) {
        std::vector<ProxyPair> pairs;
        pairing_->pairs.collect(pairs);
        present.resize(pairs.size());
        std::transform(pairs.begin(), pairs.end(), present.begin(), bodyPairOf);
        contacts_->isCurrent = true;
        return;
    }
    const PairChanges& changes = pairing_->changes;
    if (!changes.born.empty() || !changes.died.empty()) {
        applyChanges(present, changes, bodyPairOf, contacts_->next);
        present.swap(contacts_->next);
    }
}

template <class Scalar>
bool Simulation<Scalar>::wakeUp(std::size_t body) {
    if (!sleep_ || !isMovable(body) || sleep_->states[body] == Sleep::State::awake) {
        return false;
    }
    sleep_->farCount -= sleep_->states[body] == Sleep::State::distant ? 1 : 0;
    sleep_->states[body] = Sleep::State::awake;
    sleep_->slowFrames[body] = 0;
    stockIsStale_ = true;
    return true;
}

// Exchanges what two bodies of the same mass have of their velocities along `apart`, from a to b, if
// they approach each other, and says whether they do; one that does not move has all the mass of the
// world.
template <class Scalar>
template <bool areAwake>
inline bool Simulation<Scalar>::bounce(std::size_t a, std::size_t b, const Point& apart,
                                       Scalar bounciness, SceneCost& cost) {
    const Scalar distance = apart.norm();
    const Point normal = distance > 0 ? Point(apart / distance) : Point(Point::UnitX());
    Point& velocityA = motion_->velocities[a];
    Point& velocityB = motion_->velocities[b];
    const bool movesA = areAwake || isMovable(a);
    const bool movesB = areAwake || isMovable(b);
    // Who sleeps stands still, whatever its velocity will be.
    const Scalar approach = (areAwake || isAwake(a) ? velocityA.dot(normal) : Scalar(0)) -
                            (areAwake || isAwake(b) ? velocityB.dot(normal) : Scalar(0));
    if (!(approach > 0)) {
        return false;
    }
    if constexpr (!areAwake) {
        for (const std::size_t body : {a, b}) {
            if (isMovable(body) && !isAwake(body)) {
                motion_->velocities[body].setZero();
                cost[SceneCounter::wokeUp] += wakeUp(body) ? 1 : 0;
            }
        }
    }
    const Point change = normal * (approach * bounciness / (movesA && movesB ? 2 : 1));
    if (movesA) {
        velocityA -= change;
    }
    if (movesB) {
        velocityB += change;
    }
    return true;
}

// Where all take part and are awake, nobody is asked whether they do.
template <class Scalar>
void Simulation<Scalar>::respond() {
    const bool someSweep = sweepers_ && !sweepers_->list.empty();
    const bool allAreAwake = motion_->movers.size() == size_;
    if (allAreAwake && !someSweep && common_.contains(Effect::response)) {
        respondTo<true>();
    } else if (!motion_->movers.empty()) {
        respondTo<false>();
    }
}

template <class Scalar>
template <bool allRespond>
void Simulation<Scalar>::respondTo() {
    const auto sweeps = [this](std::uint32_t body) { return sweepers_ && sweepers_->has(body); };
    const std::span<const Point> positions = positions_;
    const std::span<const Scalar> radii = radii_;
    const Scalar bounciness = bouncinessOf(effects_.response->restitution);
    std::uint64_t tested = 0;
    std::uint64_t solved = 0;
    for (const auto& [a, b] : contacts_->present) {
        if constexpr (!allRespond) {
            const EffectSet both = effectsOf_[a] & effectsOf_[b];
            if (!both.contains(Effect::response) || !(isAwake(a) || isAwake(b)) || sweeps(a) ||
                sweeps(b)) {
                continue;
            }
        }
        ++tested;
        const Point apart = positions[b] - positions[a];
        const Scalar reach = radii[a] + radii[b];
        if (apart.squaredNorm() <= reach * reach) {
            solved += bounce<allRespond>(a, b, apart, bounciness, cost_) ? 1 : 0;
        }
    }
    cost_[SceneCounter::contactsTested] += tested;
    cost_[SceneCounter::contactsSolved] += solved;
}

// Whom each sweeper meets first, and when.
template <class Scalar>
void Simulation<Scalar>::meet() {
    Sweepers& sweepers = *sweepers_;
    if (sweepers.list.empty()) {
        return;
    }
    for (const auto& [a, b] : contacts_->present) {
        const EffectSet both = effectsOf_[a] & effectsOf_[b];
        if (!both.contains(Effect::response) || !(sweepers.has(a) || sweepers.has(b))) {
            continue;
        }
        ++cost_[SceneCounter::contactsTested];
        const Point way = sweepers.wayOf(a) - sweepers.wayOf(b);
        const double time =
            timeOfContact<Scalar>(positions_[b] - positions_[a], way, radii_[a] + radii_[b]);
        for (const auto& [body, other] : {std::pair(a, b), std::pair(b, a)}) {
            if (sweepers.has(body) && time < sweepers.list[sweepers.ofBody[body]].time) {
                sweepers.list[sweepers.ofBody[body]].time = time;
                sweepers.list[sweepers.ofBody[body]].hit = other;
            }
        }
    }
    countStoppedSweepers();
}

template <class Scalar>
void Simulation<Scalar>::countStoppedSweepers() {
    for (const auto& [body, hit, start, velocity, way, time] : sweepers_->list) {
        if (hit != Sweepers::kNone) {
            const Scalar radii = radii_[hit] + radii_[body];
            const Point apartInTheEnd = positions_[hit] + sweepers_->wayOf(hit) - start - way;
            cost_[SceneCounter::sweepersStopped] +=
                apartInTheEnd.squaredNorm() > radii * radii ? 1 : 0;
        }
    }
}

// Sweepers go as far as what they meet first, and bounce off it. What is left of the frame is lost.
template <class Scalar>
void Simulation<Scalar>::land() {
    const std::span<const typename Sweepers::Sweeper> list = sweepers_->list;
    for (const auto& [body, hit, start, velocity, way, time] : list) {
        positions_[body] = start + way * static_cast<Scalar>(time);
        if (hit != Sweepers::kNone) {
            motion_->velocities[body] = velocity;
            if (walkers_ && effectsOf_[body].contains(Effect::terrain)) {
                addWalker(body, way.norm() * static_cast<Scalar>(time));
            }
        }
    }
    if (walkers_) {
        putWalkersOnGround();  // between where they started and where they would have ended
    }
    for (const auto& sweeper : list) {
        index_->grid.move(index_->proxies[sweeper.body], boxOf(sweeper.body));
        pairing_->sweeps->set(index_->proxies[sweeper.body], Point::Zero());
        sweepers_->ofBody[sweeper.body] = Sweepers::kNone;
    }
    cost_[SceneCounter::proxiesHashed] += list.size();
    for (const auto& [body, hit, start, velocity, way, time] : list) {
        if (hit != Sweepers::kNone) {
            const Point apart = positions_[hit] - positions_[body];
            const Scalar bounciness = bouncinessOf(effects_.response->restitution);
            cost_[SceneCounter::contactsSolved] +=
                bounce<false>(body, hit, apart, bounciness, cost_) ? 1 : 0;
        }
    }
}

template <class Scalar>
bool Simulation<Scalar>::collide(BodyId first, BodyId second, double restitution) {
    demand(Effect::motion, "collide()");
    checkIsBetweenFrames();
    const std::size_t a = indexOf(std::min(first, second));
    const std::size_t b = indexOf(std::max(first, second));
    HASHPHASE_ASSERT(
        a != b, "Simulation::collide(): both ids are of the same body. Pass two different bodies.");
    const Point apart = positions_[b] - positions_[a];
    const Scalar reach = radii_[a] + radii_[b];
    return (effectsOf_[a] & effectsOf_[b]).contains(Effect::response) &&
           apart.squaredNorm() <= reach * reach &&
           bounce<false>(a, b, apart, bouncinessOf(restitution), between_);
}

}  // namespace hashphase
