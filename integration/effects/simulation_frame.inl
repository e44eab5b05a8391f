// SPDX-License-Identifier: Zlib
#pragma once

// The phases of a frame, but for motion and contacts. Each loops over those that it is about; what is not
// declared is not among the phases.

#include <integration/effects/detail/simulation_parts.hpp>

#include <broadphase/core/on_failure.hpp>
#include <broadphase/core/query_scope.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hashphase {

template <class Scalar>
const SceneCost& Simulation<Scalar>::advance(Scalar seconds, ParallelFor parallelFor) {
    HASHPHASE_ASSERT(seconds >= 0 && std::isfinite(seconds),
                     "Simulation::advance(): the time step is negative, NaN or infinite. Pass a "
                     "finite time of 0 s or more.");
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this),
                     "Simulation::advance() was called from within advance(). Call it after that "
                     "returns.");
    if (detail::QueryScope::isWithin(this)) {
        return cost_;
    }
    if (pairing_ && pairing_->isSpent) {
        pairing_ = nullptr;
        stockIsStale_ = true;
    }
    takeStock();
    const detail::QueryScope scope(this);
    seconds_ = seconds;
    parallelFor_ = &parallelFor;
    farthestMove_ = 0;
    cost_ = std::exchange(between_, {});
    const detail::OnFailure recovered([&] { recover(); });
    for (const Phase& phase : phases_) {
        (this->*phase.run)();
        watch_.tell(phase.name);
    }
    parallelFor_ = nullptr;
    changedOutside_ = false;
    return cost_;
}

// Where a frame has failed, pairs may have been told that nobody has heard of: they begin anew. Who has
// moved may not be filed.
template <class Scalar>
void Simulation<Scalar>::recover() noexcept {
    parallelFor_ = nullptr;
    pairing_ = nullptr;
    if (contacts_) {
        contacts_->present.clear();
    }
    if (sweepers_) {
        sweepers_->list.clear();
        std::fill(sweepers_->ofBody.begin(), sweepers_->ofBody.end(), Sweepers::kNone);
    }
    if (walkers_) {
        walkers_->clear();
    }
    if (index_) {
        index_->isFiling = false;
    }
    if (sleep_) {
        sleep_->mustLook = true;
    }
    stockIsStale_ = true;
    changedOutside_ = true;
}

// --- Where bodies are ----------------------------------------------------------------------------

// Who fell asleep because nobody was near wakes when the player has come.
template <class Scalar>
void Simulation<Scalar>::wake() {
    Sleep& sleep = *sleep_;
    const std::optional<Point> interest = observers_.interest();
    const bool isWhereItWas = sleep.interest == interest && !sleep.mustLook;
    sleep.interest = interest;
    sleep.mustLook = false;
    if (sleep.farCount == 0 || isWhereItWas) {
        return;
    }
    const auto radius = static_cast<Scalar>(effects_.sleeping->interestRadius);
    for (std::size_t body = 0; body < positions_.size(); ++body) {
        if (!isAlive(body) || sleep.states[body] != Sleep::State::distant) {
            continue;
        }
        ++cost_[SceneCounter::sleepersAsked];
        if (!interest || (positions_[body] - *interest).norm() <= radius) {
            sleep.states[body] = Sleep::State::awake;
            --sleep.farCount;
            ++cost_[SceneCounter::wokeUp];
            motion_->movers.push_back(static_cast<std::uint32_t>(body));
        }
    }
    std::sort(motion_->movers.begin(), motion_->movers.end());
}

// Notes who is fast for its size, and where it starts.
template <class Scalar>
void Simulation<Scalar>::aim() {
    Sweepers& sweepers = *sweepers_;
    sweepers.list.clear();
    const auto fastFrom = static_cast<Scalar>(effects_.sweep->fastFrom);
    for (const std::uint32_t body : motion_->movers) {
        const Scalar distance = motion_->velocities[body].norm() * seconds_;
        if (effectsOf_[body].contains(Effect::sweep) && distance > 0 &&
            distance >= fastFrom * 2 * radii_[body]) {
            sweepers.list.push_back(
                {.body = body, .start = positions_[body], .velocity = motion_->velocities[body]});
        }
    }
}

template <class Scalar>
void Simulation<Scalar>::stand() {
    for (const std::uint32_t body : motion_->movers) {
        if (effectsOf_[body].contains(Effect::terrain)) {
            addWalker(body, motion_->velocities[body].norm() * seconds_);
        }
    }
    putWalkersOnGround();
}

// The ground is asked for from as much higher as the body has moved, so that it climbs what is no
// steeper than 45 degrees.
template <class Scalar>
void Simulation<Scalar>::addWalker(std::uint32_t body, Scalar moved) {
    Walkers& walkers = *walkers_;
    Point center = positions_[body];
    center[walkers.up] += moved;
    walkers.bodies.push_back(body);
    walkers.centers.push_back(center);
    walkers.radii.push_back(radii_[body]);
}

template <class Scalar>
void Simulation<Scalar>::putWalkersOnGround() {
    Walkers& walkers = *walkers_;
    walkers.found.resize(walkers.bodies.size());
    const QueryCost cost = walkers.terrain.restingHeights(walkers.centers, walkers.radii,
                                                          walkers.found, *parallelFor_);
    for (std::size_t i = 0; i < walkers.bodies.size(); ++i) {
        if (walkers.found[i]) {
            positions_[walkers.bodies[i]][walkers.up] = walkers.found[i]->height;
        }
    }
    cost_[SceneCounter::groundsAsked] += walkers.bodies.size();
    cost_[SceneCounter::trianglesTested] += cost.boxesTested;
    walkers.clear();
}

// --- Where the grid has them ---------------------------------------------------------------------

// Where sweepers start, and how far they go.
template <class Scalar>
void Simulation<Scalar>::sweep() {
    Sweepers& sweepers = *sweepers_;
    for (std::size_t i = 0; i < sweepers.list.size(); ++i) {
        auto& sweeper = sweepers.list[i];
        Point& position = positions_[sweeper.body];
        sweeper.way = position - sweeper.start;
        position = sweeper.start;
        sweepers.ofBody[sweeper.body] = static_cast<std::uint32_t>(i);
        const ProxyId proxy = index_->proxies[sweeper.body];
        index_->grid.move(proxy, boxOf(sweeper.body));
        pairing_->sweeps->set(proxy, sweeper.way, effects_.sweep->mode);
    }
    cost_[SceneCounter::sweepsSolved] += sweepers.list.size();
    cost_[SceneCounter::proxiesHashed] += sweepers.list.size();
}

template <class Scalar>
void Simulation<Scalar>::pair() {
    Pairs<Scalar>& pairs = pairing_->pairs;
    if (common_.contains(Effect::pairs)) {
        const auto accept = [](std::span<const ProxyPair> /*asked*/, std::span<char> accepted) {
            std::fill(accepted.begin(), accepted.end(), char{1});
        };
        pairing_->changes = pairs.update(accept, *parallelFor_);
    } else {
        const auto takePart = [this](ProxyId a, ProxyId b) {
            return (effectsOf_[a.index] & effectsOf_[b.index]).contains(Effect::pairs);
        };
        pairing_->changes = pairs.update(takePart, *parallelFor_);
    }
    pairing_->isSpent = pairs.count() == 0 && !present_.contains(Effect::pairs);
    const PairCost& cost = pairs.lastCost();
    cost_[SceneCounter::entriesFiled] += cost.grid.filed;
    cost_[SceneCounter::boxesTested] += cost.boxesTested;
    cost_[SceneCounter::pairsWatched] += cost.pairsWatched;
    cost_[SceneCounter::pairsBorn] += pairing_->changes.born.size();
    cost_[SceneCounter::pairsDied] += pairing_->changes.died.size();
    if (pairing_->sweeps) {
        cost_[SceneCounter::sweepBoxesTested] += pairing_->sweeps->lastCost().boxesTested;
    }
}

template <class Scalar>
void Simulation<Scalar>::updateGrid() {
    cost_[SceneCounter::entriesFiled] += index_->grid.update(*parallelFor_).filed;
}

// --- What comes of it ----------------------------------------------------------------------------

template <class Scalar>
void Simulation<Scalar>::rest() {
    Sleep& sleep = *sleep_;
    const SleepingEffect& effect = *effects_.sleeping;
    const auto slowBelow = static_cast<Scalar>(effect.slowBelow);
    const auto radius = static_cast<Scalar>(effect.interestRadius);
    const std::optional<Point>& interest = sleep.interest;  // of those who woke in this frame
    const auto fallsAsleep = [&](std::uint32_t body) {
        Point& velocity = motion_->velocities[body];
        std::uint32_t& slowFrames = sleep.slowFrames[body];
        slowFrames = velocity.norm() < slowBelow ? slowFrames + 1 : 0;
        if (!effectsOf_[body].contains(Effect::sleeping)) {
            return false;
        }
        if (slowFrames >= effect.framesBeforeSleep) {
            sleep.states[body] = Sleep::State::slow;
            velocity.setZero();
            return true;
        }
        if (interest && (positions_[body] - *interest).norm() > radius) {
            sleep.states[body] = Sleep::State::distant;
            ++sleep.farCount;
            return true;
        }
        return false;
    };
    std::vector<std::uint32_t>& movers = motion_->movers;
    const auto end = std::remove_if(movers.begin(), movers.end(), fallsAsleep);
    cost_[SceneCounter::fellAsleep] += static_cast<std::size_t>(movers.end() - end);
    movers.erase(end, movers.end());
}

template <class Scalar>
void Simulation<Scalar>::observe() {
    const Scalar moved = changedOutside_ ? std::numeric_limits<Scalar>::infinity() : farthestMove_;
    cost_ += observers_.observe(observed(), moved, *parallelFor_);
}

}  // namespace hashphase
