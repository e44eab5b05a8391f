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

Session::Session(const SceneChoice& chosen, int wide, int high)
    : choice(chosen),
      stage(makeStage(chosen)),
      ownEffects(stage->effects()),
      width(wide),
      height(high) {
    beginAnew(true);
}

void Session::run(std::string_view line) {
    const CommandKind* kind = findCommand(line);
    if (kind == nullptr) {
        return;
    }
    const Arguments arguments(line, *kind);
    const std::uint64_t frameBefore = frame;
    kind->run(*this, arguments);
    if (isLogged(kind->role)) {
        log.add(frameBefore, line);
    }
}

// --- Frame ---------------------------------------------------------------------------------------

void Session::advance() {
    if (framesToRead > 0) {
        --framesToRead;
        look();
        return;
    }
    const bool steps = isPlaying || stepsWaiting > 0;
    stepsWaiting -= stepsWaiting > 0 ? 1 : 0;
    if (stage->effects().culling) {
        stage->observers().setView(seenRegion());
    }
    stage->observers().setInterest(pose().eye);
    if (steps) {
        stage->step();
        ++frame;
        knowsPairs = true;
        history.add(stage->times());
        log.note(frame, frameHash());
        captureFrame();
    }
    look();
}

std::uint64_t Session::frameHash() const {
    ResultHash hash;
    hash.add(stage->placesHash());
    if (stage->effects().proximity) {
        const auto colours = stage->observers().colours();
        for (const std::uint32_t colour :
             colours.first(std::min<std::size_t>(colours.size(), stage->indexLimit()))) {
            hash.add(std::uint64_t{colour});
        }
    }
    return hash.value();
}

// --- What is asked about a frame -----------------------------------------------------------------

ConvexRegion<float> Session::seenRegion() const {
    return ConvexRegion<float>(cameraView(frozen.value_or(pose())).planes, Containment::touching,
                               Touch::byPlanes);
}

// The camera that follows goes with its body.
void Session::aim() {
    if (picked && camera.mode() == CameraMode::follow) {
        camera.setTarget(stage->body(*picked).centre);
    }
}

// What the stage has found serves where the picture is taken by the same camera.
void Session::see() {
    if (!stage->effects().culling) {
        usesOwnCuller = false;
        return;
    }
    const ConvexRegion<float> region = seenRegion();
    usesOwnCuller = !(stage->observers().culler().frustum() == region);
    if (usesOwnCuller) {
        ownCuller.look(*stage->grid(), region);
    }
}

const Culler<float>& Session::culler() const {
    if (usesOwnCuller) {
        return ownCuller;
    }
    return stage->observers().culler();
}

// Whether the scene has moved or not.
void Session::look() {
    const Grid<float>* grid = stage->grid();
    if (picked && !stage->contains(*picked)) {
        picked.reset();
    }
    aim();
    see();
    card.reset();
    if (picked && grid != nullptr) {
        const auto& proximity = stage->effects().proximity;
        const float radius = proximity ? static_cast<float>(proximity->radius) : 5.0F;
        card = infoCard(*stage, *grid, *picked, radius);
    }
    const bool countsLoads = options.has(Overlay::heat) || options.colouring == Colouring::load;
    loads = countsLoads && grid != nullptr ? CellLoads(*grid, stage->bounds()) : CellLoads();
    pairs.clear();
    if (card || options.has(Overlay::pairs) || options.colouring == Colouring::pairs) {
        stage->listPairs(pairs);
    }
    if (check() != nullptr) {
        pairCheck = checkPairs(*stage);
    }
}

void Session::captureFrame() {
    if (recorder == nullptr) {
        return;
    }
    try {
        recorder->add(*stage);
    } catch (const InputError& error) {
        noteFailure(error.what());
        recorder = nullptr;
        stepsWaiting = 0;
        return;
    }
    if (recorder->isComplete()) {
        say(recorder->summary());
        recorder = nullptr;
    }
}

// --- Scene ---------------------------------------------------------------------------------------

void Session::choose(const SceneChoice& chosen) {
    std::unique_ptr<Stage> next = makeStage(chosen);
    const SceneEffects own = next->effects();
    const bool isOther = chosen.name != choice.name || chosen.file != choice.file;
    if (!isOther) {
        ask([&] {
            next->declare(changed(own, stage->effects().set(), stage->effects()));
            next->setBroadphase(stage->broadphase());
        });
    }
    const bool isOtherSize =
        chosen.objects != choice.objects && !next->bounds().isApprox(stage->bounds());
    stage = std::move(next);
    ownEffects = own;
    choice = chosen;
    beginAnew(isOther || isOtherSize);
}

void Session::beginAnew(bool goesHome) {
    endCapture("the scene ends");
    frame = 0;
    ++sceneCount;
    stepsWaiting = 0;
    frozen.reset();
    forgetSelection();
    rectangle.reset();
    recoloured.clear();
    history = {};
    former.reset();
    pairs.clear();
    pairCheck = {};
    knowsPairs = false;
    camera.setBounds(stage->bounds());
    if (goesHome) {
        goHome();
    }
    log = {.choice = choice};
    logSetting(*this, log);
    look();
}

void Session::goHome() {
    camera.goHome(stage->bounds());
    aim();
}

void Session::setCameraMode(CameraMode mode) {
    if (mode == CameraMode::follow && !picked) {
        throw InputError("No body is picked to follow: click a body, or run \"pick X Y\".");
    }
    camera.setMode(mode);
    aim();
}

void Session::askForSteps(std::uint64_t count) {
    isPlaying = false;
    stepsWaiting += count;
}

void Session::declare(const SceneEffects& effects) {
    ask([&] { stage->declare(effects); });
    knowsPairs = false;
    if (!effects.culling) {
        frozen.reset();
    }
}

void Session::declare(EffectSet effects) {
    declare(changed(ownEffects, effects, stage->effects()));
}

void Session::setBroadphase(const BroadphaseKind& kind) {
    const BroadphaseKind& present = stage->broadphase();
    ask([&] { stage->setBroadphase(kind); });
    if (&kind != &present && history.frameCount() > 0) {
        former = FormerTimes{present.name, std::exchange(history, {})};
    }
    knowsPairs = false;
    framesToRead = 0;
    if (const std::size_t bodies = stage->size(); bodies > kind.liveUpTo) {
        say(std::string(kind.name) + " takes time proportional to the square of the bodies: with " +
            withThousands(bodies) + ", more than " + withThousands(kind.liveUpTo) +
            ", a frame may take long.");
        framesToRead = kFramesToRead;
    }
}

void Session::setChecking(bool isOn) {
    isChecking = isOn;
    pairCheck = {};
    look();
}

void Session::freeze(bool isFrozen) {
    if (isFrozen && !stage->effects().culling) {
        throw InputError(
            "Without culling there is no frustum to freeze: run \"effect culling on\".");
    }
    frozen = isFrozen ? std::optional(frozen.value_or(pose())) : std::nullopt;
}

CameraPose Session::pose() const {
    return camera.pose(double{static_cast<double>(width)} / height);
}

hashphase::Camera<float> Session::view() const {
    return {cameraView(pose()).viewProjection,
            kDepthRange,
            {0, 0, static_cast<double>(width), static_cast<double>(height)}};
}

// --- Selection -----------------------------------------------------------------------------------

void Session::pick(const Pixel& pixel) {
    if (!stage->effects().picking) {
        throw InputError("Picking is off: run \"effect picking on\".");
    }
    const Picked<float> found = stage->pick(view().rayThrough(pixel));
    forgetSelection();
    if (!found.id.isNull()) {
        picked = found.id.index;
        selected = {found.id.index};
        camera.setTarget(stage->body(*picked).centre);
    }
    look();
}

void Session::selectBetween(const Pixel& a, const Pixel& b) {
    if (!stage->effects().boxSelection || stage->grid() == nullptr) {
        throw InputError("Box selection is off: run \"effect boxSelection on\".");
    }
    std::vector<ProxyId> found;
    stage->observers().select({*stage->grid()}, view(), a, b, found);
    forgetSelection();
    for (const ProxyId id : found) {
        if (stage->contains(id.index)) {
            selected.push_back(id.index);
        }
    }
    std::sort(selected.begin(), selected.end());
    look();
}

void Session::forgetSelection() {
    selected.clear();
    picked.reset();
    card.reset();
}

std::size_t Session::removeSelected() {
    const std::size_t count = stage->remove(selected);
    std::erase_if(recoloured, [this](std::uint32_t index) { return !stage->contains(index); });
    knowsPairs = knowsPairs && count == 0;
    forgetSelection();
    look();
    return count;
}

std::size_t Session::recolourSelected() {
    std::vector<std::uint32_t> all;
    std::set_union(recoloured.begin(), recoloured.end(), selected.begin(), selected.end(),
                   std::back_inserter(all));
    recoloured.swap(all);
    return selected.size();
}

void Session::capture(const std::string& path, int frames) {
    if (recorder != nullptr) {
        throw InputError("A capture to " + recorder->path() +
                         " is under way: " + recorder->progress() + " are written.");
    }
    recorder = std::make_unique<BoxRecorder>(path, titleOf(choice), *stage, frames);
    stepsWaiting = std::max(stepsWaiting, static_cast<std::uint64_t>(frames));
}

void Session::endCapture(const std::string& reason) {
    if (recorder != nullptr) {
        noteFailure(recorder->faultSentence(reason));
        recorder = nullptr;
    }
}

void Session::askForScreenshot(const std::string& path) {
    screenshots.push_back(path);
    see();
}

void Session::noteFailure(const std::string& message) {
    ++failureCount;
    say(message);
}

// --- What is to be seen --------------------------------------------------------------------------

bool Session::isVisible(std::uint32_t index) const {
    return !stage->effects().culling || culler().isVisible({index, 1});
}

std::size_t Session::visibleCount() const {
    if (!stage->effects().culling) {
        return stage->size();
    }
    const ConvexRegion<float> region = seenRegion();
    if (culler().frustum() == region) {
        return culler().count();
    }
    Culler<float> now;
    now.look(*stage->grid(), region);
    return now.count();
}

const PairCheck* Session::check() const {
    return canCheck() && knowsPairs ? &pairCheck : nullptr;
}

bool Session::canCheck() const {
    return isChecking && stage->effects().pairs && !stage->effects().sweep;
}

std::string bodiesText(std::uint64_t count) {
    return withThousands(count) + (count == 1 ? " body" : " bodies");
}

}  // namespace hashphase::demos
