// SPDX-License-Identifier: Zlib
#pragma once

// From a declaration and the bodies to the phases of a frame, and to the tables that they need.

#include <integration/effects/detail/simulation_parts.hpp>

#include <broadphase/collectors.hpp>
#include <broadphase/core/query_scope.hpp>

#include <string>

namespace hashphase {

// Who takes part in what, and who is awake. Asked before each frame, and looks at all bodies only after
// one of them has come, gone, fallen asleep or woken; never within a frame, which goes by what was so at
// its beginning.
template <class Scalar>
void Simulation<Scalar>::takeStock() {
    if (!stockIsStale_ || detail::QueryScope::isWithin(this)) {
        return;
    }
    present_ = {};
    common_ = EffectSet::all();
    if (motion_) {
        motion_->movers.clear();
    }
    for (std::size_t body = 0; body < positions_.size(); ++body) {
        if (!isAlive(body)) {
            continue;
        }
        present_ = present_ | effectsOf_[body];
        common_ = common_ & effectsOf_[body];
        if (isAwake(body)) {
            motion_->movers.push_back(static_cast<std::uint32_t>(body));
        }
    }
    setPairing(effects_.pairs && (pairing_ || present_.contains(Effect::pairs)));
    compile();
    stockIsStale_ = false;
}

// Each proxy has the index of its body.
template <class Scalar>
std::unique_ptr<typename Simulation<Scalar>::Index> Simulation<Scalar>::makeIndex(
    const GridConfig& config) const {
    auto index = std::make_unique<Index>(config);
    index->proxies.reserve(positions_.capacity());
    for (std::size_t body = 0; body < positions_.size(); ++body) {
        const bool isMobile = isAlive(body) && isAwake(body);
        index->proxies.push_back(
            index->grid.add(boxOf(body), isMobile ? Mobility::mobile : Mobility::resting));
    }
    for (std::size_t body = 0; body < positions_.size(); ++body) {
        if (!isAlive(body)) {
            index->grid.remove(index->proxies[body]);
            index->proxies[body] = {};
        }
    }
    return index;
}

// For those that are made, everybody is new.
template <class Scalar>
void Simulation<Scalar>::setPairing(bool isWanted) {
    if (!isWanted) {
        pairing_ = nullptr;
        return;
    }
    if (!pairing_) {
        pairing_ = std::make_unique<Pairing>(index_->grid);
        if (contacts_) {
            contacts_->present.clear();
            contacts_->isCurrent = true;
        }
    }
    pairing_->setSweeps(index_->grid, effects_.sweep.has_value());
}

// While nobody looks, nobody is filed; the first who does finds all where they are.
template <class Scalar>
void Simulation<Scalar>::setFiling(bool isFiling) {
    for (std::size_t body = 0; isFiling && !index_->isFiling && body < positions_.size(); ++body) {
        if (isAlive(body)) {
            index_->grid.move(index_->proxies[body], boxOf(body));
            ++between_[SceneCounter::proxiesHashed];
            changedOutside_ = true;
        }
    }
    index_->isFiling = isFiling;
}

template <class Scalar>
void Simulation<Scalar>::compile() {
    const EffectSet running = effects_.set() & present_;
    const auto runs = [running](Effect effect) { return running.contains(effect); };
    phases_.clear();
    const auto add = [this](bool isWanted, std::string_view name, void (Simulation::*run)()) {
        if (isWanted) {
            static_cast<void>(phases_.push({name, run}));
        }
    };
    const bool moves = runs(Effect::motion);
    const bool sweeps = moves && runs(Effect::sweep) && pairing_;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const bool isBounded = moves && !((effects_.motion->bounds.min().array() == -infinity).all() &&
                                      (effects_.motion->bounds.max().array() == infinity).all());
    const bool isFiling = index_ && running.containsAny(kGridEffects);
    const bool measures = runs(Effect::culling) && effects_.culling->margin > 0;
    const bool responds = pairing_ && runs(Effect::response);
    if (contacts_ && !responds) {
        contacts_->present.clear();
        contacts_->isCurrent = false;
    }
    if (index_) {
        setFiling(isFiling);
    }

    add(moves && runs(Effect::sleeping), "wake", &Simulation::wake);
    add(sweeps, "aim", &Simulation::aim);
    const bool stands = moves && runs(Effect::terrain);
    const Filing filing = measures ? Filing::measured : Filing::plain;
    const Phase move = movePhase(isBounded, isFiling && !stands ? filing : Filing::none);
    add(moves, move.name, move.run);
    add(stands, "stand", &Simulation::stand);
    add(stands && isFiling, "file", measures ? &Simulation::fileAndMeasure : &Simulation::file);
    add(sweeps, "sweep", &Simulation::sweep);
    add(pairing_ != nullptr, "pair", &Simulation::pair);
    add(responds, "gather", &Simulation::gather);
    add(index_ && !pairing_, "update", &Simulation::updateGrid);
    add(moves && responds, "respond", &Simulation::respond);
    add(sweeps && responds, "meet", &Simulation::meet);
    add(sweeps, "land", &Simulation::land);
    add(moves && runs(Effect::sleeping), "rest", &Simulation::rest);
    add(effects_.set().containsAny(kGridEffects - EffectSet{Effect::pairs}), "observe",
        &Simulation::observe);
}

// --- Accounts ------------------------------------------------------------------------------------

namespace {

template <class Element>
std::size_t bytesOf(const std::vector<Element>& column) {
    return column.capacity() * sizeof(Element);
}

}  // namespace

template <class Scalar>
SceneFootprint Simulation<Scalar>::footprint() const {
    SceneFootprint bytes;
    bytes[SceneTable::bodies] = sizeof(*this) + bytesOf(positions_) + bytesOf(radii_) +
                                bytesOf(effectsOf_) + bytesOf(generations_) + bytesOf(vacant_);
    bytes[SceneTable::groups] = bytesOf(groups_);
    if (motion_) {
        bytes[SceneTable::velocities] = sizeof(Motion) + bytesOf(motion_->velocities);
        bytes[SceneTable::movers] = bytesOf(motion_->movers);
    }
    if (sleep_) {
        bytes[SceneTable::sleepers] =
            sizeof(Sleep) + bytesOf(sleep_->states) + bytesOf(sleep_->slowFrames);
    }
    if (walkers_) {
        bytes[SceneTable::ground] = walkers_->grid.memoryBytes() + walkers_->terrain.memoryBytes();
        bytes[SceneTable::walkers] = sizeof(Walkers) - sizeof(walkers_->grid) +
                                     bytesOf(walkers_->bodies) + bytesOf(walkers_->centers) +
                                     bytesOf(walkers_->radii) + bytesOf(walkers_->found);
    }
    if (index_) {
        bytes[SceneTable::rayTrees] = index_->grid.rayMemoryBytes();
        bytes[SceneTable::grid] = index_->grid.memoryBytes() - index_->grid.rayMemoryBytes();
        bytes[SceneTable::proxies] =
            sizeof(Index) - sizeof(index_->grid) + bytesOf(index_->proxies);
    }
    if (pairing_) {
        bytes[SceneTable::pairs] =
            sizeof(Pairing) - sizeof(pairing_->pairs) + pairing_->pairs.memoryBytes();
        bytes[SceneTable::sweeps] = pairing_->sweeps ? pairing_->sweeps->memoryBytes() : 0;
    }
    if (contacts_) {
        bytes[SceneTable::contacts] =
            sizeof(Contacts) + bytesOf(contacts_->present) + bytesOf(contacts_->next);
    }
    if (sweepers_) {
        bytes[SceneTable::sweepers] =
            sizeof(Sweepers) + bytesOf(sweepers_->list) + bytesOf(sweepers_->ofBody);
    }
    observers_.addFootprint(bytes);
    return bytes;
}

template <class Scalar>
std::string Simulation<Scalar>::validate() const {
    if (!index_) {
        return {};
    }
    const bool nobodySwept =
        !sweepers_ || sweepers_->list.empty();  // and so moved since the update
    std::string error =
        pairing_ && nobodySwept ? pairing_->pairs.validate() : index_->grid.validate();
    if (error.empty() && pairing_ && pairing_->sweeps) {
        error = pairing_->sweeps->validate();
    }
    for (std::size_t body = 0; error.empty() && body < positions_.size(); ++body) {
        const ProxyId proxy = index_->proxies[body];
        const bool isRight = isAlive(body) ? proxy.index == body && index_->grid.contains(proxy) &&
                                                 (!index_->isFiling ||
                                                  isSameBits(index_->grid.box(proxy), boxOf(body)))
                                           : proxy.isNull();
        error = isRight ? "" : "Each body's proxy has the body's index and box: broken.";
    }
    if (error.empty() && contacts_ && contacts_->isCurrent && pairing_ &&
        contacts_->present.size() != pairing_->pairs.count()) {
        error = "Contacts are the present pairs, where some body responds: broken.";
    }
    return error;
}

}  // namespace hashphase
