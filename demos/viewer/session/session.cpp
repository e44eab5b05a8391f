// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/session.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/scenes/result_hash.hpp>
#include <demos/viewer/session/commands.hpp>

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace hashphase::demos {
namespace {

// A message is said after a picture, and seen with the next one.
constexpr int kFramesToRead = 2;

// Of what a scene declares by itself, commands change which effects there are, the grid's variables, and the
// radius of proximity. So much a recording has at its beginning: see logSetting().
SceneEffects changed(SceneEffects own, EffectSet declared, const SceneEffects& now) {
    for (const Effect effect : kAllEffects) {
        if (declared.contains(effect)) {
            own.declare(effect);
        } else {
            own.remove(effect);
        }
    }
    own.grid = now.grid;
    if (own.proximity && now.proximity) {
        own.proximity->radius = now.proximity->radius;
    }
    return own;
}

// What a stage refuses, as a fault of whoever has asked for it.
template <class Call>
void ask(const Call& call) {
    try {
        call();
    } catch (const std::invalid_argument& error) {
        throw InputError(error.what());
    }
}

}  // namespace

Session::Session(const SceneChoice& choice, int width, int height)
    : choice_(choice),
      stage_(makeStage(choice)),
      ownEffects_(stage_->effects()),
      width_(width),
      height_(height) {
    beginAnew(true);
}

void Session::run(std::string_view line) {
    const CommandKind* kind = findCommand(line);
    if (kind == nullptr) {
        return;
    }
    Arguments arguments(line, kind->usage);
    const std::uint64_t frame = frame_;
    kind->run(*this, arguments);
    if (isLogged(kind->role)) {
        log_.add(frame, line);
    }
}

// --- Frame ---------------------------------------------------------------------------------------

void Session::advance() {
    if (framesToRead_ > 0) {
        --framesToRead_;
        look();
        return;
    }
    const bool steps = isPlaying_ || stepsWaiting_ > 0;
    stepsWaiting_ -= stepsWaiting_ > 0 ? 1 : 0;
    setView();
    if (steps) {
        stage_->step();
        ++frame_;
        knowsPairs_ = true;
        history_.add(stage_->times());
        log_.note(frame_, frameHash());
        captureFrame();
    }
    look();
}

std::uint64_t Session::frameHash() const {
    ResultHash hash;
    hash.add(stage_->placesHash());
    if (stage_->effects().proximity) {
        const auto colours = stage_->observers().colours();
        for (const std::uint32_t colour :
             colours.first(std::min<std::size_t>(colours.size(), stage_->indexLimit()))) {
            hash.add(std::uint64_t{colour});
        }
    }
    return hash.value();
}

void Session::setView() {
    if (stage_->effects().culling) {
        stage_->observers().setView(seenRegion());
    }
    stage_->observers().setInterest(pose().eye);
}

// --- What is asked about a frame -----------------------------------------------------------------

ConvexRegion<float> Session::seenRegion() const {
    return ConvexRegion<float>(cameraView(frozen_.value_or(pose())).planes, Containment::touching,
                               Touch::byPlanes);
}

// The camera that follows goes with its body.
void Session::aim() {
    if (picked_ && camera_.mode() == CameraMode::follow) {
        camera_.setTarget(stage_->body(*picked_).centre);
    }
}

// What the stage has found serves where the picture is taken by the same camera.
void Session::see() {
    if (!stage_->effects().culling) {
        usesOwnCuller_ = false;
        return;
    }
    const ConvexRegion<float> region = seenRegion();
    usesOwnCuller_ = !(stage_->observers().culler().frustum() == region);
    if (usesOwnCuller_) {
        ownCuller_.look(*stage_->grid(), region);
    }
}

const Culler<float>& Session::culler() const {
    if (usesOwnCuller_) {
        return ownCuller_;
    }
    return stage_->observers().culler();
}

// Whether the scene has moved or not.
void Session::look() {
    const Grid<float>* grid = stage_->grid();
    if (picked_ && !stage_->contains(*picked_)) {
        picked_.reset();
    }
    aim();
    see();
    card_.reset();
    if (picked_ && grid != nullptr) {
        const auto& proximity = stage_->effects().proximity;
        const float radius = proximity ? static_cast<float>(proximity->radius) : 5.0F;
        card_ = infoCard(*stage_, *grid, *picked_, radius);
    }
    const bool countsLoads = options_.has(Overlay::heat) || options_.colouring == Colouring::load;
    if (countsLoads && grid != nullptr) {
        loads_.count(*grid, stage_->bounds());
    } else {
        loads_ = {};
    }
    pairs_.clear();
    if (card_ || options_.has(Overlay::pairs) || options_.colouring == Colouring::pairs) {
        stage_->listPairs(pairs_);
    }
    if (check() != nullptr) {
        check_.look(*stage_);
    }
}

void Session::captureFrame() {
    if (capture_ == nullptr) {
        return;
    }
    try {
        capture_->add(*stage_);
    } catch (const InputError& error) {
        giveUpCapture(error.what());
        stepsWaiting_ = 0;
        return;
    }
    if (capture_->isComplete()) {
        const std::string leftOut = capture_->leftOutText();
        say("wrote the boxes of " + withThousands(capture_->frameCount()) + " frames to " +
            capture_->path() + (leftOut.empty() ? "" : ", without " + leftOut));
        capture_ = nullptr;
    }
}

void Session::giveUpCapture(const std::string& fault) {
    noteFailure(fault);
    capture_ = nullptr;
}

// --- Scene ---------------------------------------------------------------------------------------

void Session::choose(const SceneChoice& choice) {
    std::unique_ptr<Stage> next = makeStage(choice);
    const SceneEffects own = next->effects();
    const bool isOther = choice.name != choice_.name || choice.file != choice_.file;
    if (!isOther) {
        ask([&] {
            next->declare(changed(own, stage_->effects().set(), stage_->effects()));
            next->setBroadphase(stage_->broadphase());
        });
    }
    const bool isOtherSize =
        choice.objects != choice_.objects && !next->bounds().isApprox(stage_->bounds());
    stage_ = std::move(next);
    ownEffects_ = own;
    choice_ = choice;
    beginAnew(isOther || isOtherSize);
}

void Session::beginAnew(bool goesHome) {
    endCapture("the scene ends");
    frame_ = 0;
    ++sceneCount_;
    stepsWaiting_ = 0;
    frozen_.reset();
    forgetSelection();
    rectangle_.reset();
    recoloured_.clear();
    history_.clear();
    pairs_.clear();
    check_ = {};
    knowsPairs_ = false;
    camera_.setBounds(stage_->bounds());
    if (goesHome) {
        goHome();
    }
    log_.begin(choice_);
    logSetting(*this, log_);
    look();
}

void Session::goHome() {
    camera_.goHome(stage_->bounds());
    aim();
}

void Session::setCameraMode(CameraMode mode) {
    if (mode == CameraMode::follow && !picked_) {
        throw InputError("Nobody is picked to be followed: click on a body, or run \"pick X Y\".");
    }
    camera_.setMode(mode);
    aim();
}

void Session::standStill() noexcept {
    isPlaying_ = false;
    stepsWaiting_ = 0;
}

void Session::askForSteps(std::uint64_t count) {
    isPlaying_ = false;
    stepsWaiting_ += count;
}

void Session::declare(const SceneEffects& effects) {
    ask([&] { stage_->declare(effects); });
    knowsPairs_ = false;
    if (!effects.culling) {
        frozen_.reset();
    }
}

void Session::declare(EffectSet effects) {
    declare(changed(ownEffects_, effects, stage_->effects()));
}

void Session::setBroadphase(const BroadphaseKind& kind) {
    ask([&] { stage_->setBroadphase(kind); });
    knowsPairs_ = false;
    framesToRead_ = 0;
    if (const std::size_t bodies = stage_->size(); bodies > kind.liveUpTo) {
        say(std::string(kind.name) + " takes a time that grows with the square of the bodies: " +
            withThousands(bodies) + " are many, above " + withThousands(kind.liveUpTo) +
            " the scene may stand still for long.");
        framesToRead_ = kFramesToRead;
    }
}

void Session::setChecking(bool isChecking) {
    isChecking_ = isChecking;
    check_ = {};
    look();
}

void Session::freeze(bool isFrozen) {
    if (isFrozen && !stage_->effects().culling) {
        throw InputError(
            "Without culling there is no frustum to freeze: run \"effect culling on\".");
    }
    frozen_ = isFrozen ? std::optional(frozen_.value_or(pose())) : std::nullopt;
}

void Session::resize(int width, int height) {
    width_ = width;
    height_ = height;
}

CameraPose Session::pose() const {
    return camera_.pose(double{static_cast<double>(width_)} / height_);
}

hashphase::Camera<float> Session::view() const {
    return {cameraView(pose()).viewProjection,
            kDepthRange,
            {0, 0, static_cast<double>(width_), static_cast<double>(height_)}};
}

// --- Selection -----------------------------------------------------------------------------------

void Session::pick(const Pixel& pixel) {
    if (!stage_->effects().picking) {
        throw InputError("Picking is not declared: run \"effect picking on\".");
    }
    const Picked<float> found = stage_->pick(view().rayThrough(pixel));
    forgetSelection();
    if (!found.id.isNull()) {
        picked_ = found.id.index;
        selected_ = {found.id.index};
        camera_.setTarget(stage_->body(*picked_).centre);
    }
    look();
}

void Session::selectBetween(const Pixel& a, const Pixel& b) {
    if (!stage_->effects().boxSelection || stage_->grid() == nullptr) {
        throw InputError("Box selection is not declared: run \"effect boxSelection on\".");
    }
    std::vector<ProxyId> found;
    stage_->observers().select({*stage_->grid()}, view(), a, b, found);
    forgetSelection();
    for (const ProxyId id : found) {
        if (stage_->contains(id.index)) {
            selected_.push_back(id.index);
        }
    }
    std::sort(selected_.begin(), selected_.end());
    look();
}

void Session::forgetSelection() {
    selected_.clear();
    picked_.reset();
    card_.reset();
}

std::size_t Session::pushSelected(const Vector3<float>& velocity) {
    return static_cast<std::size_t>(
        std::count_if(selected_.begin(), selected_.end(),
                      [&](std::uint32_t index) { return stage_->push(index, velocity); }));
}

std::size_t Session::removeSelected() {
    const std::size_t count = stage_->remove(selected_);
    std::erase_if(recoloured_, [this](std::uint32_t index) { return !stage_->contains(index); });
    knowsPairs_ = knowsPairs_ && count == 0;
    forgetSelection();
    look();
    return count;
}

std::size_t Session::recolourSelected() {
    std::vector<std::uint32_t> all;
    std::set_union(recoloured_.begin(), recoloured_.end(), selected_.begin(), selected_.end(),
                   std::back_inserter(all));
    recoloured_.swap(all);
    return selected_.size();
}

void Session::capture(const std::string& path, int frames) {
    if (capture_ != nullptr) {
        throw InputError("Boxes are captured to " + capture_->path() +
                         " already: " + capture_->progress() + " are there.");
    }
    capture_ = std::make_unique<BoxRecorder>(path, titleOf(choice_), *stage_, frames);
    stepsWaiting_ = std::max(stepsWaiting_, static_cast<std::uint64_t>(frames));
}

void Session::endCapture(const std::string& reason) {
    if (capture_ != nullptr) {
        giveUpCapture(capture_->faultSentence(reason));
    }
}

void Session::askForScreenshot(const std::string& path) {
    screenshots_.push_back(path);
    see();
}

void Session::noteFailure(const std::string& message) {
    ++failureCount_;
    say(message);
}

// --- What is to be seen --------------------------------------------------------------------------

bool Session::isVisible(std::uint32_t index) const {
    return !stage_->effects().culling || culler().isVisible({index, 1});
}

std::size_t Session::visibleCount() const {
    if (!stage_->effects().culling) {
        return stage_->size();
    }
    const ConvexRegion<float> region = seenRegion();
    if (culler().frustum() == region) {
        return culler().count();
    }
    Culler<float> now;
    now.look(*stage_->grid(), region);
    return now.count();
}

bool Session::isSelected(std::uint32_t index) const {
    return std::binary_search(selected_.begin(), selected_.end(), index);
}

bool Session::isRecoloured(std::uint32_t index) const {
    return std::binary_search(recoloured_.begin(), recoloured_.end(), index);
}

const PairCheck* Session::check() const {
    return canCheck() && knowsPairs_ ? &check_ : nullptr;
}

bool Session::canCheck() const {
    return isChecking_ && stage_->effects().pairs && !stage_->effects().sweep;
}

std::vector<std::string> Session::takeScreenshots() {
    return std::exchange(screenshots_, {});
}

std::vector<std::string> Session::takeMessages() {
    return std::exchange(messages_, {});
}

}  // namespace hashphase::demos
