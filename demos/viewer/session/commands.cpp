// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/commands.hpp>

#include <demos/console/format.hpp>
#include <demos/console/result_file.hpp>
#include <demos/scenes/effects_fields.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/session.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <numbers>
#include <utility>

namespace hashphase::demos {
namespace {

using Kind = Parameter::Kind;

/// Of a reading to a number.
constexpr std::array<std::string_view, 6> kRelations{"=", "!=", "<", "<=", ">", ">="};
constexpr double kDegree = std::numbers::pi / 180;

// --- Parameters ----------------------------------------------------------------------------------

const Parameter kWord{};
const Parameter kFar{.kind = Kind::number, .low = -1e6, .high = 1e6};  // [m], [pixels]
const Parameter kDegrees{.kind = Kind::number, .low = -360, .high = 360};

Parameter numberFrom(double low, double high) {
    return {.kind = Kind::number, .low = low, .high = high};
}

Parameter wholeFrom(double low, double high) {
    return {.kind = Kind::whole, .low = low, .high = high};
}

template <class Things, class NameOf = std::identity>
Parameter oneOf(std::string what, const Things& things, const NameOf& nameOfEach = {}) {
    Parameter parameter{.what = std::move(what)};
    for (const auto& each : things) {
        parameter.choices.emplace_back(std::invoke(nameOfEach, each));
    }
    return parameter;
}

/// Of "a|b|next": the one that is named, or the one after the present one.
template <class Value>
void chooseOrNext(const Arguments& given, std::size_t count, Value& value) {
    const std::size_t chosen = given.has(0) ? given.index(0) : count;
    value =
        static_cast<Value>(chosen < count ? chosen : (static_cast<std::size_t>(value) + 1) % count);
}

/// Commands take what files may have, so that whatever a file has can be recorded.
Parameter fileField(std::string_view section, std::string_view name) {
    const std::span<const EffectsField> fields = effectsFields();
    return {.kind = Kind::field,
            .of = &*std::ranges::find_if(fields, [&](const EffectsField& field) {
                return field.section == section && field.name == name;
            })};
}

Parameter oneBroadphaseOrNext() {
    Parameter parameter = oneOf("broadphase", broadphaseKinds(), &BroadphaseKind::name);
    parameter.choices.emplace_back("next");
    return parameter;
}

std::vector<Parameter> ofPose() {
    std::vector<Parameter> parameters{oneOf("camera", kCameraModes)};
    for (const auto& [low, high] : Camera::stateLimits()) {
        parameters.push_back(numberFrom(double{low}, double{high}));
    }
    return parameters;
}

// "top|free|follow"
std::string anyOf(std::span<const std::string_view> names) {
    std::string all;
    for (const std::string_view name : names) {
        all += (all.empty() ? "" : "|") + std::string(name);
    }
    return all;
}

Vector3<float> vectorAt(const Arguments& given, std::size_t i) {
    return {given.number(i), given.number(i + 1), given.number(i + 2)};
}

float radiansAt(const Arguments& given, std::size_t i) {
    return static_cast<float>(given.numbers[i] * kDegree);
}

Pixel pixelAt(const Arguments& given, std::size_t i) {
    return {given.numbers[i], given.numbers[i + 1]};
}

// --- The scene, and what runs --------------------------------------------------------------------

void scene(Session& session, const Arguments& given) {
    SceneChoice choice = session.choice;
    const std::span<const ViewerScene> scenes = viewerScenes();
    const std::string word = given.has(0) ? given.words[0] : "next";
    if (word == "next" || word == "previous") {
        const auto now = std::ranges::find(scenes, choice.name, &ViewerScene::name);
        const auto place = static_cast<std::size_t>(now - scenes.begin());
        const std::size_t step = word == "next" ? 1 : scenes.size() - 1;
        choice.name = scenes[(place + step) % scenes.size()].name;
    } else {
        choice.name = word;
    }
    choice.file.clear();
    choice.objects.reset();
    session.choose(choice);
}

void objects(Session& session, const Arguments& given) {
    SceneChoice choice = session.choice;
    choice.objects = given.index(0);
    session.choose(choice);
}

void seed(Session& session, const Arguments& given) {
    SceneChoice choice = session.choice;
    choice.seed = given.index(0);
    if (isBoxRecording(choice)) {
        throw InputError("A recording of boxes has no seed.");
    }
    session.choose(choice);
}

void pause(Session& session, const Arguments& given) {
    const bool isStill = !session.isPlaying && !session.isWaiting();
    session.isPlaying = !given.onOff(0, isStill);
    if (!session.isPlaying) {
        session.stepsWaiting = 0;
    }
}

void effect(Session& session, const Arguments& given) {
    EffectSet effects = session.stage->effects().set();
    const Effect named = kAllEffects[given.index(0)];
    const bool isOn = given.onOff(1, effects.contains(named));
    if (isOn && !session.stage->possibleEffects().contains(named)) {
        throw InputError("This scene cannot have " + std::string(nameOf(named)) + "; it can have " +
                         namesOf(session.stage->possibleEffects()) + ".");
    }
    if (isOn) {
        effects = effects | needsOf(named);
        effects.insert(named);
    } else {
        for (const Effect other : kAllEffects) {
            if (needsOf(other).contains(named)) {
                effects.erase(other);
            }
        }
        effects.erase(named);
    }
    session.declare(effects);
}

// The kind after the present one with which so many bodies can be watched. Ours is one, for any number.
const BroadphaseKind& nextQuickKind(const Session& session, std::string& skipped) {
    const std::span<const BroadphaseKind> kinds = broadphaseKinds();
    auto place = static_cast<std::size_t>(&session.stage->broadphase() - kinds.data());
    for (;;) {
        place = (place + 1) % kinds.size();
        const BroadphaseKind& kind = kinds[place];
        if (session.stage->size() <= kind.liveUpTo) {
            return kind;
        }
        skipped += (skipped.empty() ? "" : " and ") + std::string(kind.name) + " (up to " +
                   withThousands(kind.liveUpTo) + " bodies)";
    }
}

void broadphase(Session& session, const Arguments& given) {
    const std::span<const BroadphaseKind> kinds = broadphaseKinds();
    if (given.index(0) < kinds.size()) {
        session.setBroadphase(kinds[given.index(0)]);
        return;
    }
    std::string skipped;
    session.setBroadphase(nextQuickKind(session, skipped));
    if (!skipped.empty()) {
        session.say("skipped " + skipped + ", because there are " +
                    withThousands(session.stage->size()) +
                    "; \"broadphase NAME\" selects one anyway");
    }
}

void changeGrid(Session& session, double GridConfig::*variable, double value) {
    SceneEffects effects = session.stage->effects();
    effects.grid.*variable = value;
    session.declare(effects);
}

void radius(Session& session, const Arguments& given) {
    SceneEffects effects = session.stage->effects();
    if (!effects.proximity) {
        throw InputError(
            "The radius belongs to the effect proximity: run \"effect proximity on\" first.");
    }
    effects.proximity->radius = given.numbers[0];
    session.declare(effects);
}

// --- The camera, and who is selected -------------------------------------------------------------

void pose(Session& session, const Arguments& given) {
    Camera::State state{};
    for (std::size_t i = 0; i < state.size(); ++i) {
        state[i] = given.number(i + 1);
    }
    session.camera.setState(static_cast<CameraMode>(given.index(0)), state);
}

void size(Session& session, const Arguments& given) {
    session.width = static_cast<int>(given.index(0));
    session.height = static_cast<int>(given.index(1));
}

void box(Session& session, const Arguments& given) {
    session.rectangle.reset();
    session.selectBetween(pixelAt(given, 0), pixelAt(given, 2));
}

void drag(Session& session, const Arguments& given) {
    session.rectangle =
        DrawnRectangle{pixelAt(given, 0).cast<float>(), pixelAt(given, 2).cast<float>()};
}

void clear(Session& session, const Arguments& /*given*/) {
    session.rectangle.reset();
    session.forgetSelection();
}

void push(Session& session, const Arguments& given) {
    const Vector3<float> velocity = given.has(0) ? vectorAt(given, 0) : Vector3<float>(0, 12, 0);
    const auto pushed = std::ranges::count_if(session.selected, [&](std::uint32_t index) {
        return session.stage->push(index, velocity);
    });
    session.say("pushed " + bodiesText(static_cast<std::uint64_t>(pushed)));
}

void overlay(Session& session, const Arguments& given) {
    bool& isShown = session.options.overlays[given.index(0)];
    isShown = given.onOff(1, isShown);
}

// --- Files and numbers ---------------------------------------------------------------------------

void save(Session& session, const Arguments& given) {
    const std::string path = given.has(0) ? given.words[0] : "hashphase-wander.json";
    ResultFile file(path);
    file.write([&session](std::ostream& out) { out << session.log.text(); });
    session.say("wrote a recording of " + withThousands(session.log.frames) + " frames to " + path);
}

void print(Session& session, const Arguments& given) {
    std::string line;
    for (const std::string& name : given.words) {
        line += (line.empty() ? "" : "  ") + name + " " + plain(session.reading(name));
    }
    session.say(line);
}

void expect(Session& session, const Arguments& given) {
    const double read = session.reading(given.words[0]);
    const double wanted = given.numbers[2];
    const std::array<bool, 6> holds{read == wanted, read != wanted,
                                    read<wanted, read <= wanted, read> wanted, read >= wanted};
    if (!holds[given.index(1)]) {
        session.noteFailure("frame " + std::to_string(session.frame) + ": " + given.words[0] +
                            " is " + plain(read) + ", expected " + given.words[1] + " " +
                            plain(wanted));
    }
}

// --- The tables ----------------------------------------------------------------------------------

using S = Session&;
using A = const Arguments&;

std::vector<CommandKind> makeCommands() {
    using enum CommandRole;
    std::vector<CommandKind> all;
    const auto add = [&all](CommandRole role, const std::string& usage, std::string_view help,
                            CommandKind::Action run, std::vector<Parameter> parameters = {}) {
        all.push_back({firstWord(usage), role, usage, help, std::move(parameters), run});
    };
    add(chooses, "scene NAME|next|previous", "show another scene", scene, {{.isOptional = true}});
    add(chooses, "objects N", "restart the scene with N bodies", objects,
        {wholeFrom(1, kMostObjects)});
    add(chooses, "seed N", "restart the scene with another seed", seed, {wholeFrom(0, kMostSeed)});
    add(steers, "restart", "restart the scene", [](S s, A) { s.choose(s.choice); });
    add(steers, "pause [on|off]", "pause or play", pause);
    add(steers, "step [N]", "simulate N frames (default: 1), then pause",
        [](S s, A a) { s.askForSteps(a.has(0) ? a.index(0) : 1); }, {wholeFrom(1, 1e6)});
    add(changes, "effect NAME [on|off]",
        "switch an effect on, with all effects that it needs, or off", effect,
        {oneOf("effect", kAllEffects, nameOf)});
    add(changes, "broadphase NAME|next",
        "find pairs with this broadphase, or with the next one that is fast enough", broadphase,
        {oneBroadphaseOrNext()});
    add(shows, "check [on|off]", "compare all pairs with the exact pairs in each frame",
        [](S s, A a) { s.setChecking(a.onOff(0, s.isChecking)); });
    add(changes, "cell SIZE", "cell size of the grid [m]; 0: automatic",
        [](S s, A a) { changeGrid(s, &GridConfig::cellSize, a.numbers[0]); },
        {fileField("grid", "cellSize")});
    add(changes, "ratio RATIO",
        "ratio of cell sizes between levels of the grid, if the cell size is fixed",
        [](S s, A a) { changeGrid(s, &GridConfig::levelRatio, a.numbers[0]); },
        {fileField("grid", "levelRatio")});
    add(changes, "radius R", "radius in which agents look for neighbours [m]", radius,
        {fileField("effects.proximity", "radius")});
    add(changes, "camera " + anyOf(kCameraModes), "look from above, fly, or follow the picked body",
        [](S s, A a) { s.setCameraMode(static_cast<CameraMode>(a.index(0))); });
    add(changes, "home", "reset the camera", [](S s, A) { s.goHome(); });
    add(changes, "move RIGHT UP FORWARD", "move the camera [m]",
        [](S s, A a) { s.camera.move(vectorAt(a, 0)); }, {kFar});
    add(changes, "turn LEFT UP", "turn the camera [degrees]",
        [](S s, A a) { s.camera.turn(radiansAt(a, 0), radiansAt(a, 1)); }, {kDegrees});
    add(changes, "zoom FACTOR", "move the camera nearer (above 1) or farther away",
        [](S s, A a) { s.camera.zoom(a.number(0)); }, {numberFrom(0.01, 100)});
    add(changes, "eye X Y Z YAW PITCH", "place the free camera [m, degrees]",
        [](S s, A a) { s.camera.place(vectorAt(a, 0), radiansAt(a, 3), radiansAt(a, 4)); },
        {kFar, kFar, kFar, kDegrees});
    add(changes, "pose MODE NUMBER...",
        "restore a recorded camera: top, free or follow, and all of its 16 numbers [m, rad]", pose,
        ofPose());
    add(changes, "freeze [on|off]", "keep culling by the present frustum while the camera moves",
        [](S s, A a) { s.freeze(a.onOff(0, s.frozen.has_value())); });
    add(changes, "size WIDTH HEIGHT", "set the picture's size, up to 8,192 x 8,192 [pixels]", size,
        {wholeFrom(kLeastSide, kMostSide)});
    add(changes, "pick X Y", "pick the body at a pixel", [](S s, A a) { s.pick(pixelAt(a, 0)); },
        {kFar});
    add(changes, "box X0 Y0 X1 Y1", "select the bodies between two pixels", box, {kFar});
    add(changes, "drag X0 Y0 X1 Y1", "draw a rectangle between two pixels, but select nothing",
        drag, {kFar});
    add(changes, "clear", "clear the selection", clear);
    add(changes, "push [X Y Z]", "add a velocity to the selected bodies [m/s]", push, {kFar});
    add(changes, "delete", "remove the selected bodies",
        [](S s, A) { s.say("removed " + bodiesText(s.removeSelected())); });
    add(changes, "recolour", "mark the selected bodies with a colour, until the scene restarts",
        [](S s, A) { s.say("marked " + bodiesText(s.recolourSelected())); });
    add(shows, "colour [" + anyOf(kColourings) + "|next]", "choose what the colours of bodies show",
        [](S s, A a) { chooseOrNext(a, kColourings.size(), s.options.colouring); },
        {{.what = "colouring"}});
    add(shows, "overlay " + anyOf(kOverlays) + " [on|off]", "show or hide a part of the picture",
        overlay);
    add(shows, "dots PIXELS", "draw bodies with at least this radius [pixels]",
        [](S s, A a) { s.options.dots = a.number(0); }, {numberFrom(0, 20)});
    add(shows, "theme [" + anyOf(kThemes) + "|next]", "choose the light or the dark theme",
        [](S s, A a) { chooseOrNext(a, kThemes.size(), s.options.theme); });
    add(steers, "panel [on|off]", "show or hide the panel",
        [](S s, A a) { s.options.panel = a.onOff(0, s.options.panel); });
    add(steers, "help [on|off]", "show or hide the list of keys",
        [](S s, A a) { s.options.help = a.onOff(0, s.options.help); });
    add(writes, "screenshot [FILE]", "write the picture to a file (PNG)",
        [](S s, A a) { s.askForScreenshot(a.has(0) ? a.words[0] : "hashphase.png"); });
    add(writes, "save [FILE]", "write a recording of all commands since the scene began (JSON)",
        save);
    add(writes, "capture FILE [FRAMES]",
        "simulate FRAMES frames (default: 60) and write all boxes (.aabbs)",
        [](S s, A a) { s.capture(a.words[0], a.has(1) ? static_cast<int>(a.index(1)) : 60); },
        {kWord, wholeFrom(1, 1e6)});
    add(steers, "quit", "end the program", [](S s, A) { s.isOver = true; });
    add(steers, "print READING...", "print these readings", print);
    add(steers, "expect READING " + anyOf(kRelations) + " NUMBER",
        "fail if the reading is not as expected", expect,
        {kWord, {.what = "relation"}, numberFrom(-1e18, 1e18)});
    return all;
}

constexpr std::array kKeys{
    KeyBinding{"P", "pause", "pause or play"},
    KeyBinding{"O", "step", "simulate one frame"},
    KeyBinding{"R", "restart", "restart the scene"},
    KeyBinding{"[", "scene previous", "previous scene"},
    KeyBinding{"]", "scene next", "next scene"},
    KeyBinding{"1", "camera top", "look from above"},
    KeyBinding{"2", "camera free", "fly (W A S D, Q E, right button)"},
    KeyBinding{"3", "camera follow", "follow the picked body"},
    KeyBinding{"Home", "home", "reset the camera"},
    KeyBinding{"C", "effect culling", "culling on or off"},
    KeyBinding{"F", "freeze", "freeze the frustum, to see it from outside"},
    KeyBinding{"B", "broadphase next", "next broadphase"},
    KeyBinding{"V", "check", "verify all pairs, or stop"},
    KeyBinding{"G", "overlay grid", "grid lines"},
    KeyBinding{"H", "overlay heat", "bucket loads as a heat map"},
    KeyBinding{"X", "overlay boxes", "boxes of selected bodies"},
    KeyBinding{"L", "overlay pairs", "lines between pairs"},
    KeyBinding{"M", "colour next", "next meaning of colours"},
    KeyBinding{"T", "theme", "light or dark theme"},
    KeyBinding{"U", "push", "push the selected bodies"},
    KeyBinding{"K", "recolour", "mark the selected bodies with a colour"},
    KeyBinding{"Delete", "delete", "remove the selected bodies"},
    KeyBinding{"Escape", "clear", "clear the selection"},
    KeyBinding{"Tab", "panel", "show or hide the panel"},
    KeyBinding{"F1", "help", "show or hide this help"},
    KeyBinding{"F5", "save", "save a recording"},
    KeyBinding{"F10", "quit", "end the program"},
    KeyBinding{"F12", "screenshot", "write the picture to a file"},
};

}  // namespace

std::span<const CommandKind> commandKinds() {
    static const std::vector<CommandKind> all = makeCommands();
    return all;
}

std::span<const KeyBinding> keyBindings() {
    return kKeys;
}

const CommandKind* findCommand(std::string_view line) {
    const std::string name = firstWord(line);
    return name.empty() ? nullptr : &rowNamed("command", name, commandKinds());
}

}  // namespace hashphase::demos
