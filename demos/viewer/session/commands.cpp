// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/commands.hpp>

#include <demos/console/nearest_name.hpp>
#include <demos/scenes/effects_fields.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/command_actions.hpp>

#include <array>
#include <charconv>
#include <sstream>
#include <vector>

namespace hashphase::demos {
namespace {

// "top|free|follow"
std::string anyOf(std::span<const std::string_view> names) {
    std::string all;
    for (const std::string_view name : names) {
        all += (all.empty() ? "" : "|") + std::string(name);
    }
    return all;
}

const auto& commands() {
    using enum CommandRole;
    static const std::array all{
        CommandKind{"scene", chooses, "scene NAME|next|previous", "put another scene on stage",
                    actions::scene},
        CommandKind{"objects", chooses, "objects N", "begin again with so many bodies",
                    actions::objects},
        CommandKind{"seed", chooses, "seed N", "begin again with another seed", actions::seed},
        CommandKind{"restart", steers, "restart", "begin again", actions::restart},
        CommandKind{"pause", steers, "pause [on|off]", "stand still, or go on", actions::pause},
        CommandKind{"step", steers, "step [N]", "stand still after so many frames", actions::step},
        CommandKind{"effect", changes, "effect NAME [on|off]",
                    "declare an effect as the scene does, with what it needs, or take it back",
                    actions::effect},
        CommandKind{"broadphase", changes, "broadphase NAME|next",
                    "who finds the pairs; the next one that is quick enough", actions::broadphase},
        CommandKind{"check", shows, "check [on|off]", "compare all pairs with the exact ones",
                    actions::check},
        CommandKind{"cell", changes, "cell SIZE",
                    "edge of the grid's cells [m]; 0 chooses by itself", actions::cell},
        CommandKind{"ratio", changes, "ratio RATIO",
                    "between the grid's levels, where the cell size is fixed", actions::ratio},
        CommandKind{"radius", changes, "radius R", "how far agents look around [m]",
                    actions::radius},
        CommandKind{"camera", changes, "camera " + anyOf(kCameraModes),
                    "look from above, fly, or follow who is picked", actions::camera},
        CommandKind{"home", changes, "home", "take the camera to where it began", actions::home},
        CommandKind{"move", changes, "move RIGHT UP FORWARD", "move the camera [m]", actions::move},
        CommandKind{"turn", changes, "turn LEFT UP", "turn the camera [degrees]", actions::turn},
        CommandKind{"zoom", changes, "zoom FACTOR", "go nearer (above 1) or farther away",
                    actions::zoom},
        CommandKind{"eye", changes, "eye X Y Z YAW PITCH", "put the free camera there [m, degrees]",
                    actions::eye},
        CommandKind{"pose", changes, "pose MODE NUMBER...", "put the camera as a recording has it",
                    actions::pose},
        CommandKind{"freeze", changes, "freeze [on|off]",
                    "cull by the camera of this moment, and look from outside", actions::freeze},
        CommandKind{"size", changes, "size WIDTH HEIGHT",
                    "of the picture, up to 8,192 each way [pixels]", actions::size},
        CommandKind{"pick", changes, "pick X Y", "ask who is at the pixel", actions::pick},
        CommandKind{"box", changes, "box X0 Y0 X1 Y1", "select who is between two pixels",
                    actions::box},
        CommandKind{"drag", changes, "drag X0 Y0 X1 Y1", "show the rectangle between two pixels",
                    actions::drag},
        CommandKind{"clear", changes, "clear", "select nobody", actions::clear},
        CommandKind{"push", changes, "push [X Y Z]", "add a velocity to who is selected [m/s]",
                    actions::push},
        CommandKind{"delete", changes, "delete", "remove who is selected", actions::remove},
        CommandKind{"recolour", changes, "recolour", "mark who is selected", actions::recolour},
        CommandKind{"colour", shows, "colour [" + anyOf(kColourings) + "|next]",
                    "what colours tell", actions::colour},
        CommandKind{"overlay", shows, "overlay " + anyOf(kOverlays) + " [on|off]",
                    "what is shown of the scene, and laid over it", actions::overlay},
        CommandKind{"dots", shows, "dots PIXELS", "draw bodies at least with that radius",
                    actions::dots},
        CommandKind{"theme", shows, "theme [" + anyOf(kThemes) + "|next]", "light or dark",
                    actions::theme},
        CommandKind{"panel", steers, "panel [on|off]", "show the panel", actions::panel},
        CommandKind{"help", steers, "help [on|off]", "show keys and commands", actions::help},
        CommandKind{"screenshot", writes, "screenshot [FILE]", "write a picture (PNG)",
                    actions::screenshot},
        CommandKind{"save", writes, "save [FILE]",
                    "write a recording of all that was done since the scene began", actions::save},
        CommandKind{"capture", writes, "capture FILE [FRAMES]",
                    "write the boxes of so many frames as they are simulated (.aabbs)",
                    actions::capture},
        CommandKind{"quit", steers, "quit", "end the program", actions::quit},
        CommandKind{"print", steers, "print READING...", "say numbers", actions::print},
        CommandKind{"expect", steers, "expect READING " + anyOf(actions::kRelations) + " NUMBER",
                    "complain unless it is so", actions::expect},
    };
    return all;
}

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
    KeyBinding{"F10", "quit", "end"},
    KeyBinding{"F12", "screenshot", "write a picture"},
};

}  // namespace

std::span<const CommandKind> commandKinds() {
    return commands();
}

std::span<const KeyBinding> keyBindings() {
    return kKeys;
}

const CommandKind* findCommand(std::string_view line) {
    const std::string name = firstWord(line);
    if (name.empty()) {
        return nullptr;
    }
    std::vector<std::string> names;
    for (const CommandKind& kind : commands()) {
        if (kind.name == name) {
            return &kind;
        }
        names.emplace_back(kind.name);
    }
    throw InputError(unknownNameSentence("command", name, names));
}

namespace {

// Read back as the same number, and not as the nearest with so many digits.
std::string exactText(double number) {
    if (number == NumberField::kInfinite) {
        return std::string(kNoBound);
    }
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

// First what is not declared, then what is, which needs nothing that is not.
void logEffects(const Stage& stage, CommandLog& log) {
    const SceneEffects& effects = stage.effects();
    for (const bool isOn : {false, true}) {
        for (const Effect effect : kAllEffects) {
            if (stage.possibleEffects().contains(effect) &&
                effects.set().contains(effect) == isOn) {
                log.add(0, "effect " + std::string(nameOf(effect)) + (isOn ? " on" : " off"));
            }
        }
    }
    log.add(0, "cell " + exactText(effects.grid.cellSize));
    log.add(0, "ratio " + exactText(effects.grid.levelRatio));
    if (effects.proximity) {
        log.add(0, "radius " + exactText(effects.proximity->radius));
    }
    log.add(0, "broadphase " + std::string(stage.broadphase().name));
}

}  // namespace

void logSetting(Session& session, CommandLog& log) {
    std::ostringstream line;
    line.precision(9);  // which a float is read back by
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
    logEffects(session.stage(), log);
    line << "colour " << kColourings[static_cast<std::size_t>(session.options().colouring)];
    add();
    for (std::size_t i = 0; i < kOverlays.size(); ++i) {
        line << "overlay " << kOverlays[i] << (session.options().overlays[i] ? " on" : " off");
        add();
    }
    line << "dots " << session.options().dots;
    add();
    line << "theme " << kThemes[static_cast<std::size_t>(session.options().theme)];
    add();
    line << "check " << (session.isChecking() ? "on" : "off");
    add();
}

}  // namespace hashphase::demos
