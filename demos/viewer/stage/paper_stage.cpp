// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/paper_stage.hpp>

#include <demos/scenes/result_hash.hpp>
#include <demos/scenes/simulation_scene.hpp>
#include <demos/scenes/terrain.hpp>
#include <demos/viewer/stage/threads.hpp>

#include <algorithm>
#include <stdexcept>

namespace hashphase::demos {

PaperStage::PaperStage(const EffectsFile& file)
    : Stage(file.effects),
      scene_(file.scene),
      ground_(groundOf(file.scene)),
      simulation_(ofScene(effects())),
      kind_(&broadphaseKinds().front()) {
    bodies_ = addBodies(scene_, simulation_);
    simulation_.watchPhases([this](std::string_view phase) { clock_.end(phase); });
    if (simulation_.declared().terrain) {
        simulation_.ground().add(ground_);
    }
    if (simulation_.declared().zones) {
        addZones(scene_, simulation_);
    }
    declareToSimulation();
}

// --- Frame ---------------------------------------------------------------------------------------

void PaperStage::runFrame() {
    clock_.begin();
    simulation_.advance(kFrameSeconds, stageFor);
    if (!effects().pairs) {
        return;
    }
    if (rival_ == nullptr) {
        takeChanges();
        return;
    }
    listBoxes(boxes_, noFilters_);
    rival_->update(boxes_, noFilters_, clock_);
    if (effects().response) {
        collideRivals();
    }
}

// The present pairs, from those of the last frame and what has changed; all are sorted. Those of bodies that
// were removed have died, too, and are not among them any more. The simulation has such a list only while
// somebody responds.
void PaperStage::takeChanges() {
    const auto keyOf = [](const ProxyPair& pair) {
        return pairKey(pair.first.index, pair.second.index);
    };
    const auto [born, died] = simulation_.pairChanges();
    nextPairs_.clear();
    auto fresh = born.begin();
    auto gone = died.begin();
    for (const PairKey key : pairs_) {
        while (gone != died.end() && keyOf(*gone) < key) {
            ++gone;
        }
        if (gone != died.end() && keyOf(*gone) == key) {
            ++gone;
            continue;
        }
        for (; fresh != born.end() && keyOf(*fresh) < key; ++fresh) {
            nextPairs_.push_back(keyOf(*fresh));
        }
        nextPairs_.push_back(key);
    }
    for (; fresh != born.end(); ++fresh) {
        nextPairs_.push_back(keyOf(*fresh));
    }
    pairs_.swap(nextPairs_);
}

void PaperStage::collideRivals() {
    for (const PairKey key : rival_->pairs()) {
        simulation_.collide(bodies_[firstOf(key)], bodies_[secondOf(key)],
                            effects().response->restitution);
    }
    clock_.end("respond");
}

// --- Who is there --------------------------------------------------------------------------------

StageBody PaperStage::body(std::uint32_t index) const {
    StageBody body;
    if (index >= bodies_.size() || bodies_[index].isNull()) {
        return body;
    }
    const BodyId id = bodies_[index];
    const SceneEffects& declared = simulation_.declared();
    body.shape = StageBody::Shape::sphere;
    body.centre = simulation_.position(id);
    body.size.setConstant(simulation_.radius(id));
    body.isStatic = !simulation_.effects(id).contains(Effect::motion);
    body.speed = declared.motion && !body.isStatic ? simulation_.velocity(id).norm() : 0;
    body.isAsleep = declared.sleeping && simulation_.isAsleep(id);
    return body;
}

std::size_t PaperStage::remove(std::span<const std::uint32_t> indices) {
    const auto count = static_cast<std::size_t>(std::count_if(
        indices.begin(), indices.end(), [this](std::uint32_t index) { return removeOne(index); }));
    const auto isGone = [this](PairKey pair) {
        return bodies_[firstOf(pair)].isNull() || bodies_[secondOf(pair)].isNull();
    };
    std::erase_if(pairs_, isGone);
    if (rival_ != nullptr) {
        rival_->eraseIf(isGone);
    }
    return count;
}

bool PaperStage::removeOne(std::uint32_t index) {
    if (!contains(index)) {
        return false;
    }
    simulation_.remove(bodies_[index]);
    bodies_[index] = {};
    return true;
}

bool PaperStage::push(std::uint32_t index, const Vector3<float>& velocity) {
    if (!contains(index) || !simulation_.declared().motion) {
        return false;
    }
    const BodyId id = bodies_[index];
    if (!simulation_.effects(id).contains(Effect::motion)) {
        return false;
    }
    simulation_.setVelocity(id, simulation_.velocity(id) + velocity);
    return true;
}

std::span<const Vector3<float>> PaperStage::ground() const {
    return effects().terrain ? std::span(ground_) : std::span<const Vector3<float>>();
}

Aabb<float> PaperStage::bounds() const {
    const auto side = static_cast<float>(scene_.domain);
    return {Vector3<float>(0, 0, 0), Vector3<float>(side, Terrain::kHighest, side)};
}

float PaperStage::heightAt(float x, float z) const {
    return groundHeight(scene_, x, z);
}

std::uint64_t PaperStage::placesHash() const {
    ResultHash hash;
    for (std::uint32_t index = 0; index < bodies_.size(); ++index) {
        if (contains(index)) {
            hash.add(std::uint64_t{index});
            hash.add(simulation_.position(bodies_[index]));
        }
    }
    return hash.value();
}

// --- What runs -----------------------------------------------------------------------------------

SceneEffects PaperStage::withoutPairs(SceneEffects effects) {
    effects.sweep.reset();
    effects.response.reset();
    effects.pairs.reset();
    return effects;
}

// What bodies are made with: velocities as well, which are kept where they do not move by themselves.
SceneEffects PaperStage::ofScene(SceneEffects effects) {
    effects.declare(Effect::motion);
    return withoutPairs(std::move(effects));
}

// What asks the grid has one, whatever finds the pairs. Pairs are declared after they were not, so that
// all are told as born.
void PaperStage::declareToSimulation() {
    const SceneEffects& before = simulation_.declared();
    const bool hadMotion = before.motion.has_value();
    const bool hadTerrain = before.terrain.has_value();
    const bool hadZones = before.zones.has_value();
    pairs_.clear();
    if (hadMotion && !effects().motion) {
        keepVelocities();
    }
    simulation_.declare(withoutPairs(effects()));
    if (rival_ == nullptr) {
        simulation_.declare(effects());
    }
    if (effects().motion && !hadMotion) {
        giveVelocitiesBack();
    }
    if (simulation_.declared().terrain && !hadTerrain) {
        simulation_.ground().add(ground_);
    }
    if (simulation_.declared().zones && !hadZones) {
        addZones(scene_, simulation_);
    }
}

void PaperStage::keepVelocities() {
    kept_.resize(bodies_.size());
    for (std::size_t index = 0; index < bodies_.size(); ++index) {
        if (!bodies_[index].isNull()) {
            kept_[index] = simulation_.velocity(bodies_[index]);
        }
    }
}

void PaperStage::giveVelocitiesBack() {
    for (std::size_t index = 0; index < bodies_.size(); ++index) {
        if (!bodies_[index].isNull()) {
            simulation_.setVelocity(bodies_[index], kept_[index]);
        }
    }
}

std::string PaperStage::faultOf(const SceneEffects& effects) const {
    if (effects.sweep && rival_ != nullptr) {
        return "Only the grid finds whom a sweep passes: choose the broadphase hash to declare "
               "sweep.";
    }
    return simulationError(effects);
}

EffectSet PaperStage::possibleEffects() const {
    return EffectSet::all() - EffectSet{Effect::rotation, Effect::friction};
}

void PaperStage::setBroadphase(const BroadphaseKind& kind) {
    if (&kind == kind_) {
        return;
    }
    if (effects().sweep && !kind.ours) {
        throw std::invalid_argument(
            "Only the grid finds whom a sweep passes: take back sweep to "
            "choose another broadphase.");
    }
    // Bodies may bounce up, and axis sweeps must know how far.
    Aabb<float> room = bounds();
    room.extend(Vector3<float>(room.max() + Vector3<float>::Constant(100)));
    room.extend(Vector3<float>(room.min() - Vector3<float>::Constant(100)));
    rival_ = kind.ours ? nullptr : std::make_unique<RivalPairs>(kind, room, bodies_.size());
    kind_ = &kind;
    declareToSimulation();
}

const std::vector<PairKey>& PaperStage::presentPairs() const {
    return rival_ && effects().pairs ? rival_->pairs() : pairs_;
}

void PaperStage::listBoxes(std::vector<Aabb<float>>& boxes,
                           std::vector<CollisionFilter>& filters) const {
    filters.clear();
    boxes.clear();
    for (const BodyId id : bodies_) {
        if (id.isNull()) {
            boxes.push_back(nowhere());
            continue;
        }
        const Vector3<float> half = Vector3<float>::Constant(simulation_.radius(id));
        boxes.emplace_back(simulation_.position(id) - half, simulation_.position(id) + half);
    }
}

const Grid<float>* PaperStage::grid() const {
    return simulation_.declared().set().containsAny(kGridEffects) ? &simulation_.grid() : nullptr;
}

std::uint64_t PaperStage::memoryBytes() const {
    return totalBytes(simulation_.footprint()) + (rival_ ? rival_->memoryBytes() : 0);
}

}  // namespace hashphase::demos
