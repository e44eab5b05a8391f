// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/recording_stage.hpp>

#include <demos/scenes/list_pairs.hpp>
#include <demos/scenes/result_hash.hpp>

namespace hashphase::demos {
RecordingStage::RecordingStage(const std::filesystem::path& path, std::size_t objects)
    : Stage(effectsOf({Effect::pairs, Effect::picking, Effect::boxSelection, Effect::culling}),
            {Effect::pairs, Effect::picking, Effect::boxSelection, Effect::culling,
             Effect::proximity, Effect::radar}),
      scene_(path, objects),
      ownObservers_(effects()) {
    observers_ = &ownObservers_;
    bounds_ = scene_.bounds();
    makeGrid();
}

void RecordingStage::makeGrid() {
    pairs_ = nullptr;
    grid_ = std::make_unique<Grid<float>>(effects().grid);
    ownObservers_.forgetProxies();
    proxies_.clear();
    for (const Aabb<float>& box : scene_.boxes()) {
        proxies_.push_back(grid_->add(box));
    }
}

void RecordingStage::runFrame() {
    if (++frame_ == scene_.frameLimit()) {
        scene_.rewind();
        frame_ = 0;
    } else {
        scene_.advance();
    }
    clock_.begin();
    for (std::size_t i = 0; i < proxies_.size(); ++i) {
        grid_->move(proxies_[i], scene_.boxes()[i]);
    }
    clock_.end("set boxes");
    findPairs();
    ownObservers_.watchPhases([this](std::string_view phase) { clock_.end(phase); });
    ownObservers_.observe({*grid_});
}

void RecordingStage::findPairs() {
    if (effects().pairs && rival_ == nullptr) {
        if (pairs_ == nullptr) {
            pairs_ = std::make_unique<Pairs<float>>(*grid_);
        }
        pairs_->update([](ProxyId, ProxyId) { return true; });
        clock_.end("find pairs");
        return;
    }
    pairs_ = nullptr;
    grid_->update();
    clock_.end("update");
    if (effects().pairs) {
        rival_->update(scene_.boxes(), scene_.filters(), clock_);
    }
}

StageBody RecordingStage::body(std::uint32_t index) const {
    StageBody body;
    if (index < proxies_.size()) {
        const Aabb<float>& box = scene_.boxes()[index];
        body.shape = StageBody::Shape::box;
        body.centre = box.center();
        body.size = box.sizes() / 2;
    }
    return body;
}

std::uint64_t RecordingStage::placesHash() const {
    ResultHash hash;
    for (const Aabb<float>& box : scene_.boxes()) {
        hash.add(box.min());
        hash.add(box.max());
    }
    return hash.value();
}

std::string RecordingStage::faultOf(const SceneEffects& effects) const {
    if (const EffectSet others = effects.set() - possibleEffects(); !others.isEmpty()) {
        return "A recording has no " + namesOf(others) + ".";
    }
    return effectsError(effects);
}

void RecordingStage::follow(const SceneEffects& before) {
    ownObservers_.declare(effects());
    if (effects().grid != before.grid) {
        makeGrid();
    }
    if (!effects().pairs) {
        pairs_ = nullptr;
        if (rival_ != nullptr) {
            rival_->eraseIf([](PairKey) { return true; });
        }
    }
}

void RecordingStage::useBroadphase(const BroadphaseKind& kind) {
    rival_ = kind.ours ? nullptr : std::make_unique<RivalPairs>(kind, bounds(), proxies_.size());
}

void RecordingStage::listPairs(std::vector<PairKey>& pairs) const {
    pairs.clear();
    if (rival_ != nullptr) {
        pairs = rival_->pairs();
    } else if (pairs_ != nullptr) {
        demos::listPairs(*pairs_, pairs);
    }
}

std::size_t RecordingStage::pairCount() const {
    return rival_ ? rival_->pairs().size() : pairs_ ? pairs_->count() : 0;
}

void RecordingStage::listBoxes(std::vector<Aabb<float>>& boxes,
                               std::vector<CollisionFilter>& filters) const {
    boxes = scene_.boxes();
    filters = scene_.filters();
}

std::optional<std::int64_t> RecordingStage::memoryBytes() const {
    return sumOf(grid_->memoryBytes() + (pairs_ ? pairs_->memoryBytes() : 0),
                 rival_ ? rival_->memoryBytes() : 0);
}

}  // namespace hashphase::demos
