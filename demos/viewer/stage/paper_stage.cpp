// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/paper_stage.hpp>

#include <demos/scenes/result_hash.hpp>
#include <demos/scenes/simulation_scene.hpp>
#include <demos/scenes/terrain.hpp>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#if HASHPHASE_HAS_TBB
#include <integration/tbb/tbb_parallel_for.hpp>

#include <tbb/global_control.h>
#endif

namespace hashphase::demos {
namespace {

#if HASHPHASE_HAS_TBB
constexpr auto* kParallelFor = tbbFor;
#else
constexpr auto* kParallelFor = serialFor;
#endif

SceneEffects withoutPairs(SceneEffects effects) {
    effects.sweep.reset();
    effects.response.reset();
    effects.pairs.reset();
    return effects;
}

// What bodies are made with: velocities as well, which are kept where they do not move by themselves.
SceneEffects effectsOfBodies(SceneEffects effects) {
    effects.declare(Effect::motion);
    return withoutPairs(std::move(effects));
}

std::vector<PairKey> keysOf(std::span<const ProxyPair> pairs) {
    std::vector<PairKey> keys(pairs.size());
    std::ranges::transform(pairs, keys.begin(), [](const ProxyPair& pair) {
        return pairKey(pair.first.index, pair.second.index);
    });
    return keys;
}

}  // namespace

PaperStage::PaperStage(const EffectsFile& file)
    : Stage(file.effects, EffectSet::all() - EffectSet{Effect::rotation, Effect::friction}),
      scene_(file.scene),
      ground_(groundOf(file.scene)),
      simulation_(effectsOfBodies(effects())) {
    observers_ = &simulation_.observers();
    const auto side = static_cast<float>(scene_.domain);
    bounds_ = {Vector3<float>::Zero(), Vector3<float>(side, Terrain::kHighest, side)};
    bodies_ = addBodies(scene_, simulation_);
    simulation_.watchPhases([this](std::string_view phase) { clock_.end(phase); });
    addGroundAndZones(false, false);
    declareToSimulation();
}

// --- Frame ---------------------------------------------------------------------------------------

void PaperStage::runFrame() {
    clock_.begin();
    simulation_.advance(kFrameSeconds, kParallelFor);
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
        for (const PairKey key : rival_->pairs()) {
            simulation_.collide(bodies_[firstOf(key)], bodies_[secondOf(key)],
                                effects().response->restitution);
        }
        clock_.end("respond");
    }
}

// The present pairs, from those of the last frame and what has changed; all are sorted. Those of bodies that
// were removed have died, too, and are not among them any more. The simulation has such a list only while
// somebody responds.
void PaperStage::takeChanges() {
    const auto [born, died] = simulation_.pairChanges();
    std::vector<PairKey> kept;
    std::ranges::set_difference(pairs_, keysOf(died), std::back_inserter(kept));
    pairs_.clear();
    std::ranges::merge(kept, keysOf(born), std::back_inserter(pairs_));
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

bool PaperStage::removeOne(std::uint32_t index) {
    if (!contains(index)) {
        return false;
    }
    simulation_.remove(bodies_[index]);
    bodies_[index] = {};
    return true;
}

void PaperStage::forgetRemoved() {
    const auto isGone = [this](PairKey pair) {
        return bodies_[firstOf(pair)].isNull() || bodies_[secondOf(pair)].isNull();
    };
    std::erase_if(pairs_, isGone);
    if (rival_ != nullptr) {
        rival_->eraseIf(isGone);
    }
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

// What asks the grid has one, whatever finds the pairs. Pairs are declared after they were not, so that
// all are told as born. Bodies that stop moving get their velocities back when they move again.
void PaperStage::declareToSimulation() {
    const EffectSet before = simulation_.declared().set();
    const bool hadMotion = before.contains(Effect::motion);
    pairs_.clear();
    if (hadMotion && !effects().motion) {
        kept_.resize(bodies_.size());
        std::ranges::transform(bodies_, kept_.begin(), [this](BodyId id) {
            return id.isNull() ? Vector3<float>(Vector3<float>::Zero()) : simulation_.velocity(id);
        });
    }
    simulation_.declare(withoutPairs(effects()));
    if (rival_ == nullptr) {
        simulation_.declare(effects());
    }
    for (std::size_t index = 0; effects().motion && !hadMotion && index < bodies_.size(); ++index) {
        if (!bodies_[index].isNull()) {
            simulation_.setVelocity(bodies_[index], kept_[index]);
        }
    }
    addGroundAndZones(before.contains(Effect::terrain), before.contains(Effect::zones));
}

void PaperStage::addGroundAndZones(bool hadGround, bool hadZones) {
    if (simulation_.declared().terrain && !hadGround) {
        simulation_.ground().add(ground_);
    }
    if (simulation_.declared().zones && !hadZones) {
        addZones(scene_, simulation_);
    }
}

std::string PaperStage::faultOf(const SceneEffects& effects) const {
    if (effects.sweep && rival_ != nullptr) {
        return "The effect sweep needs the broadphase hash: run \"broadphase hash\" first.";
    }
    return simulationError(effects);
}

void PaperStage::useBroadphase(const BroadphaseKind& kind) {
    if (effects().sweep && !kind.ours) {
        throw std::invalid_argument(
            "The effect sweep needs the broadphase hash: run \"effect sweep off\" first.");
    }
    // Bodies may bounce up, and axis sweeps must know how far.
    const Aabb<float> room = withRoom(bounds(), Vector3<float>::Constant(100));
    rival_ = kind.ours ? nullptr : std::make_unique<RivalPairs>(kind, room, bodies_.size());
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

std::optional<std::int64_t> PaperStage::memoryBytes() const {
    return sumOf(totalBytes(simulation_.footprint()), rival_ ? rival_->memoryBytes() : 0);
}

std::shared_ptr<void> limitThreads([[maybe_unused]] std::size_t count) {
#if HASHPHASE_HAS_TBB
    using Limit = tbb::global_control;
    return std::make_shared<Limit>(Limit::max_allowed_parallelism, count);
#else
    return nullptr;
#endif
}

}  // namespace hashphase::demos
