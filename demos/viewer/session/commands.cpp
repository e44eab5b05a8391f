// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/commands.hpp>

#include <demos/console/format.hpp>
#include <demos/console/nearest_name.hpp>
#include <demos/console/result_file.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/box_recorder.hpp>
#include <demos/viewer/session/session.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

namespace hashphase::demos {
namespace {

constexpr double kFar = 1e6;  // [m], [pixels]
constexpr double kDegree = std::numbers::pi / 180;

float metres(Arguments& words, std::string_view name) {
    return static_cast<float>(words.number(name, -kFar, kFar));
}

float degrees(Arguments& words, std::string_view name) {
    return static_cast<float>(words.number(name, -360, 360) * kDegree);
}

Pixel pixel(Arguments& words) {
    const double x = words.number("X", -kFar, kFar);
    const double y = words.number("Y", -kFar, kFar);
    return {x, y};
}

// --- Scene ---------------------------------------------------------------------------------------

void scene(Session& session, Arguments& words) {
    SceneChoice choice = session.choice();
    const std::span<const ViewerScene> scenes = viewerScenes();
    const std::string word = words.isEmpty() ? "next" : words.word("scene");
    words.end();
    if (word == "next" || word == "previous") {
        const auto now = std::find_if(scenes.begin(), scenes.end(), [&](const ViewerScene& known) {
            return known.name == choice.name;
        });
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

void objects(Session& session, Arguments& words) {
    SceneChoice choice = session.choice();
    choice.objects = static_cast<std::size_t>(words.whole("N", 1, 1'000'000));
    words.end();
    session.choose(choice);
}

void seed(Session& session, Arguments& words) {
    SceneChoice choice = session.choice();
    choice.seed = static_cast<std::uint64_t>(words.whole("N", 0, 4'294'967'295));
    words.end();
    session.choose(choice);
}

void restart(Session& session, Arguments& words) {
    words.end();
    session.choose(session.choice());
}

void pause(Session& session, Arguments& words) {
    const bool isPaused = words.onOff(!session.isPlaying());
    words.end();
    session.setPlaying(!isPaused);
}

void step(Session& session, Arguments& words) {
    const long long count = words.wholeOr("N", 1, 1'000'000, 1);
    words.end();
    session.askForSteps(static_cast<std::uint64_t>(count));
}

// --- What runs -----------------------------------------------------------------------------------

Effect effectNamed(Arguments& words) {
    std::array<std::string_view, kAllEffects.size()> names;
    std::transform(kAllEffects.begin(), kAllEffects.end(), names.begin(), nameOf);
    return kAllEffects[words.choice("effect", names)];
}

void effect(Session& session, Arguments& words) {
    SceneEffects effects = session.stage().effects();
    const Effect named = effectNamed(words);
    const bool isOn = words.onOff(effects.set().contains(named));
    words.end();
    if (isOn && !session.stage().possibleEffects().contains(named)) {
        throw InputError("This scene cannot have " + std::string(nameOf(named)) + "; it can have " +
                         namesOf(session.stage().possibleEffects()) + ".");
    }
    if (isOn) {
        for (const Effect needed : kAllEffects) {
            if (needsOf(named).contains(needed)) {
                effects.declare(needed);
            }
        }
        effects.declare(named);
    } else {
        for (const Effect other : kAllEffects) {
            if (needsOf(other).contains(named)) {
                effects.remove(other);
            }
        }
        effects.remove(named);
    }
    session.declare(effects);
}

void broadphase(Session& session, Arguments& words) {
    const std::span<const BroadphaseKind> kinds = broadphaseKinds();
    std::vector<std::string_view> names;
    for (const BroadphaseKind& kind : kinds) {
        names.push_back(kind.name);
    }
    names.push_back("next");
    std::size_t chosen = words.choice("broadphase", names);
    words.end();
    if (chosen == kinds.size()) {
        const auto now = static_cast<std::size_t>(&session.stage().broadphase() - kinds.data());
        chosen = (now + 1) % kinds.size();
    }
    session.setBroadphase(kinds[chosen]);
}

void check(Session& session, Arguments& words) {
    const bool isOn = words.onOff(session.isChecking());
    words.end();
    session.setChecking(isOn);
}

void cell(Session& session, Arguments& words) {
    SceneEffects effects = session.stage().effects();
    effects.grid.cellSize = words.number("SIZE", 0, 1000);
    words.end();
    session.declare(effects);
}

void ratio(Session& session, Arguments& words) {
    SceneEffects effects = session.stage().effects();
    effects.grid.levelRatio = words.number("RATIO", 2, 64);
    words.end();
    session.declare(effects);
}

void radius(Session& session, Arguments& words) {
    SceneEffects effects = session.stage().effects();
    if (!effects.proximity) {
        throw InputError("The radius is that of proximity: run \"effect proximity on\" before.");
    }
    effects.proximity->radius = words.number("R", 0, 1000);
    words.end();
    session.declare(effects);
}

// --- Camera --------------------------------------------------------------------------------------

void camera(Session& session, Arguments& words) {
    const std::size_t chosen = words.choice("camera", kCameraModes);
    words.end();
    const auto mode = static_cast<CameraMode>(chosen);
    if (mode == CameraMode::follow && !session.card()) {
        throw InputError("Nobody is picked to be followed: click on a body, or run \"pick X Y\".");
    }
    session.camera().setMode(mode);
}

void home(Session& session, Arguments& words) {
    words.end();
    session.goHome();
}

void move(Session& session, Arguments& words) {
    const float right = metres(words, "RIGHT");
    const float up = metres(words, "UP");
    const float forward = metres(words, "FORWARD");
    words.end();
    session.camera().move({right, up, forward});
}

void turn(Session& session, Arguments& words) {
    const float yaw = degrees(words, "LEFT");
    const float pitch = degrees(words, "UP");
    words.end();
    session.camera().turn(yaw, pitch);
}

void zoom(Session& session, Arguments& words) {
    const auto factor = static_cast<float>(words.number("FACTOR", 0.01, 100));
    words.end();
    session.camera().zoom(factor);
}

void eye(Session& session, Arguments& words) {
    const float x = metres(words, "X");
    const float y = metres(words, "Y");
    const float z = metres(words, "Z");
    const float yaw = degrees(words, "YAW");
    const float pitch = degrees(words, "PITCH");
    words.end();
    session.camera().place({x, y, z}, yaw, pitch);
}

void pose(Session& session, Arguments& words) {
    const auto mode = static_cast<CameraMode>(words.choice("camera", kCameraModes));
    Camera::State state{};
    for (float& number : state) {
        number = metres(words, "NUMBER");
    }
    words.end();
    session.camera().setState(mode, state);
}

void freeze(Session& session, Arguments& words) {
    const bool isOn = words.onOff(session.frozenPose().has_value());
    words.end();
    session.freeze(isOn);
}

void size(Session& session, Arguments& words) {
    const long long width = words.whole("WIDTH", 16, 16'384);
    const long long height = words.whole("HEIGHT", 16, 16'384);
    words.end();
    session.resize(static_cast<int>(width), static_cast<int>(height));
}

// --- Selection -----------------------------------------------------------------------------------

void pick(Session& session, Arguments& words) {
    const Pixel at = pixel(words);
    words.end();
    session.pick(at);
}

void box(Session& session, Arguments& words) {
    const Pixel from = pixel(words);
    const Pixel to = pixel(words);
    words.end();
    session.setRectangle(std::nullopt);
    session.selectBetween(from, to);
}

void drag(Session& session, Arguments& words) {
    const Pixel from = pixel(words);
    const Pixel to = pixel(words);
    words.end();
    session.setRectangle(DrawnRectangle{from.cast<float>(), to.cast<float>()});
}

void clear(Session& session, Arguments& words) {
    words.end();
    session.setRectangle(std::nullopt);
    session.forgetSelection();
}

void push(Session& session, Arguments& words) {
    Vector3<float> velocity(0, 12, 0);
    if (!words.isEmpty()) {
        const float x = metres(words, "X");
        const float y = metres(words, "Y");
        const float z = metres(words, "Z");
        velocity = {x, y, z};
    }
    words.end();
    session.say("pushed " + withThousands(session.pushSelected(velocity)));
}

void remove(Session& session, Arguments& words) {
    words.end();
    session.say("removed " + withThousands(session.removeSelected()));
}

void recolour(Session& session, Arguments& words) {
    words.end();
    session.say("recoloured " + withThousands(session.recolourSelected()));
}

// --- How it is shown -----------------------------------------------------------------------------

void colour(Session& session, Arguments& words) {
    std::vector<std::string_view> names(kColourings.begin(), kColourings.end());
    names.push_back("next");
    std::size_t chosen = words.choice("colouring", names);
    words.end();
    if (chosen == kColourings.size()) {
        chosen = (static_cast<std::size_t>(session.options().colouring) + 1) % kColourings.size();
    }
    session.options().colouring = static_cast<Colouring>(chosen);
}

void overlay(Session& session, Arguments& words) {
    bool& isShown = session.options().overlays[words.choice("overlay", kOverlays)];
    const bool isOn = words.onOff(isShown);
    words.end();
    isShown = isOn;
}

void dots(Session& session, Arguments& words) {
    const double radius = words.number("PIXELS", 0, 20);
    words.end();
    session.options().dots = static_cast<float>(radius);
}

void theme(Session& session, Arguments& words) {
    constexpr std::array<std::string_view, 3> kNames{"light", "dark", "next"};
    const std::size_t chosen = words.isEmpty() ? 2 : words.choice("theme", kNames);
    words.end();
    const bool isDark = chosen == 2 ? session.options().theme == Theme::light : chosen == 1;
    session.options().theme = isDark ? Theme::dark : Theme::light;
}

void panel(Session& session, Arguments& words) {
    const bool isOn = words.onOff(session.options().panel);
    words.end();
    session.options().panel = isOn;
}

void help(Session& session, Arguments& words) {
    const bool isOn = words.onOff(session.options().help);
    words.end();
    session.options().help = isOn;
}

// --- Files and numbers ---------------------------------------------------------------------------

void screenshot(Session& session, Arguments& words) {
    const std::string path = words.isEmpty() ? "hashphase.png" : words.word("FILE");
    words.end();
    session.askForScreenshot(path);
}

void save(Session& session, Arguments& words) {
    const std::string path = words.isEmpty() ? "hashphase-wander.json" : words.word("FILE");
    words.end();
    ResultFile file(path);
    file.write([&session](std::ostream& out) { out << session.log().text(); });
    session.say("recorded " + withThousands(session.log().frameCount()) + " frames in " + path);
}

void capture(Session& session, Arguments& words) {
    const std::string path = words.word("FILE");
    const long long frames = words.wholeOr("FRAMES", 1, 1'000'000, 60);
    words.end();
    recordBoxes(session, path, static_cast<int>(frames));
    session.say("wrote the boxes of " + withThousands(static_cast<std::uint64_t>(frames)) +
                " frames to " + path);
}

void print(Session& session, Arguments& words) {
    std::string line;
    do {
        const std::string name = words.word("READING");
        line += (line.empty() ? "" : "  ") + name + " " + plain(session.reading(name));
    } while (!words.isEmpty());
    session.say(line);
}

void expect(Session& session, Arguments& words) {
    constexpr std::array<std::string_view, 6> kRelations{"=", "!=", "<", "<=", ">", ">="};
    const std::string name = words.word("READING");
    const std::size_t relation = words.choice("relation", kRelations);
    const double wanted = words.number("NUMBER", -1e18, 1e18);
    words.end();
    const double read = session.reading(name);
    const std::array<bool, 6> holds{read == wanted, read != wanted,
                                    read<wanted, read <= wanted, read> wanted, read >= wanted};
    if (!holds[relation]) {
        session.noteFailure("frame " + std::to_string(session.frame()) + ": " + name + " is " +
                            plain(read) + ", but was to be " + std::string(kRelations[relation]) +
                            " " + plain(wanted));
    }
}

constexpr std::array kCommands{
    CommandKind{"scene", "scene NAME|next|previous", "put another scene on stage", scene, false},
    CommandKind{"objects", "objects N", "begin again with so many bodies", objects, false},
    CommandKind{"seed", "seed N", "begin again with another seed", seed, false},
    CommandKind{"restart", "restart", "begin again", restart, false},
    CommandKind{"pause", "pause [on|off]", "stand still, or go on", pause, false},
    CommandKind{"step", "step [N]", "stand still after so many frames", step, false},
    CommandKind{"effect", "effect NAME [on|off]",
                "declare an effect, with what it needs, or take it back", effect},
    CommandKind{"broadphase", "broadphase NAME|next", "who finds the pairs", broadphase},
    CommandKind{"check", "check [on|off]", "compare all pairs with the exact ones", check},
    CommandKind{"cell", "cell SIZE", "edge of the grid's cells [m]; 0 chooses by itself", cell},
    CommandKind{"ratio", "ratio RATIO", "between the grid's levels, where the cell size is fixed",
                ratio},
    CommandKind{"radius", "radius R", "how far agents look around [m]", radius},
    CommandKind{"camera", "camera top|free|follow", "look from above, fly, or follow who is picked",
                camera},
    CommandKind{"home", "home", "take the camera to where it began", home},
    CommandKind{"move", "move RIGHT UP FORWARD", "move the camera [m]", move},
    CommandKind{"turn", "turn LEFT UP", "turn the camera [degrees]", turn},
    CommandKind{"zoom", "zoom FACTOR", "go nearer (above 1) or farther away", zoom},
    CommandKind{"eye", "eye X Y Z YAW PITCH", "put the free camera there [m, degrees]", eye},
    CommandKind{"pose", "pose MODE NUMBER...", "put the camera as a recording has it", pose},
    CommandKind{"freeze", "freeze [on|off]",
                "cull by the camera of this moment, and look from outside", freeze},
    CommandKind{"size", "size WIDTH HEIGHT", "of the picture [pixels]", size},
    CommandKind{"pick", "pick X Y", "ask who is at the pixel", pick},
    CommandKind{"box", "box X0 Y0 X1 Y1", "select who is between two pixels", box},
    CommandKind{"drag", "drag X0 Y0 X1 Y1", "show the rectangle between two pixels", drag},
    CommandKind{"clear", "clear", "select nobody", clear},
    CommandKind{"push", "push [X Y Z]", "add a velocity to who is selected [m/s]", push},
    CommandKind{"delete", "delete", "remove who is selected", remove},
    CommandKind{"recolour", "recolour", "mark who is selected", recolour},
    CommandKind{"colour", "colour agents|cells|load|speed|pairs|rest|next", "what colours tell",
                colour},
    CommandKind{"overlay", "overlay grid|heat|boxes|pairs [on|off]", "lay something over the scene",
                overlay},
    CommandKind{"dots", "dots PIXELS", "draw bodies at least with that radius", dots},
    CommandKind{"theme", "theme [light|dark]", "light or dark", theme},
    CommandKind{"panel", "panel [on|off]", "show the panel", panel},
    CommandKind{"help", "help [on|off]", "show keys and commands", help},
    CommandKind{"screenshot", "screenshot [FILE]", "write a picture (PNG)", screenshot, false},
    CommandKind{"save", "save [FILE]",
                "write a recording of all that was done since the scene began", save, false},
    CommandKind{"capture", "capture FILE [FRAMES]",
                "simulate so many frames, and write their boxes (.aabbs)", capture, false},
    CommandKind{"print", "print READING...", "say numbers", print, false},
    CommandKind{"expect", "expect READING =|!=|<|<=|>|>= NUMBER", "complain unless it is so",
                expect, false},
};

constexpr std::array kKeys{
    KeyBinding{"P", "pause", "pause and go on"},
    KeyBinding{"O", "step", "one frame"},
    KeyBinding{"R", "restart", "begin again"},
    KeyBinding{"[", "scene previous", "scene before"},
    KeyBinding{"]", "scene next", "scene after"},
    KeyBinding{"1", "camera top", "look from above"},
    KeyBinding{"2", "camera free", "fly (W A S D, Q E, right button)"},
    KeyBinding{"3", "camera follow", "follow who is picked"},
    KeyBinding{"Home", "home", "camera where it began"},
    KeyBinding{"C", "effect culling", "cull or not"},
    KeyBinding{"F", "freeze", "freeze the frustum, and look from outside"},
    KeyBinding{"B", "broadphase next", "next broadphase"},
    KeyBinding{"V", "check", "verify all pairs"},
    KeyBinding{"G", "overlay grid", "grid lines"},
    KeyBinding{"H", "overlay heat", "bucket loads as a heat map"},
    KeyBinding{"X", "overlay boxes", "boxes of who is selected"},
    KeyBinding{"L", "overlay pairs", "lines between pairs"},
    KeyBinding{"M", "colour next", "what colours tell"},
    KeyBinding{"T", "theme", "light or dark"},
    KeyBinding{"U", "push", "push who is selected"},
    KeyBinding{"K", "recolour", "mark who is selected"},
    KeyBinding{"Delete", "delete", "remove who is selected"},
    KeyBinding{"Escape", "clear", "select nobody"},
    KeyBinding{"Tab", "panel", "hide or show the panel"},
    KeyBinding{"F1", "help", "this help"},
    KeyBinding{"F5", "save", "save a recording"},
    KeyBinding{"F12", "screenshot", "write a picture"},
};

}  // namespace

std::span<const CommandKind> commandKinds() {
    return kCommands;
}

std::span<const KeyBinding> keyBindings() {
    return kKeys;
}

const CommandKind* findCommand(std::string_view line) {
    const std::string_view name = firstWord(line);
    if (name.empty()) {
        return nullptr;
    }
    std::vector<std::string> names;
    for (const CommandKind& kind : kCommands) {
        if (kind.name == name) {
            return &kind;
        }
        names.emplace_back(kind.name);
    }
    throw InputError(unknownNameSentence("command", name, names));
}

void logSetting(Session& session, CommandLog& log) {
    std::ostringstream line;
    line.precision(9);
    const auto add = [&] {
        log.add(0, line.str());
        line.str({});
    };
    line << "size " << session.width() << ' ' << session.height();
    add();
    line << "pose " << kCameraModes[static_cast<std::size_t>(session.camera().mode())];
    for (const float number : session.camera().state()) {
        line << ' ' << number;
    }
    add();
    line << "colour " << kColourings[static_cast<std::size_t>(session.options().colouring)];
    add();
    for (std::size_t i = 0; i < kOverlays.size(); ++i) {
        line << "overlay " << kOverlays[i] << (session.options().overlays[i] ? " on" : " off");
        add();
    }
    line << "dots " << session.options().dots;
    add();
    line << "theme " << (session.options().theme == Theme::dark ? "dark" : "light");
    add();
}

}  // namespace hashphase::demos
