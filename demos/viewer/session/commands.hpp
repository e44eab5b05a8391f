// SPDX-License-Identifier: Zlib
#pragma once

// The commands of the viewer: what a line, a key or a script can say.

#include <demos/viewer/session/arguments.hpp>
#include <demos/viewer/session/command_log.hpp>

#include <span>
#include <string>
#include <string_view>

namespace hashphase::demos {

class Session;

struct CommandKind {
    std::string_view name;
    std::string_view usage;  // "pick X Y"
    std::string_view help;
    void (*run)(Session& session, Arguments& arguments);
    /// Whether it changes what happens or what is seen, and so belongs into a recording.
    bool isLogged = true;
};

[[nodiscard]] std::span<const CommandKind> commandKinds();

/// The one that the line begins with; null for a line without a word. Throws InputError for unknown ones.
[[nodiscard]] const CommandKind* findCommand(std::string_view line);

/// What a key does while it is pressed once.
struct KeyBinding {
    std::string_view key;  // "P", "F1", "Home", "["
    std::string_view command;
    std::string_view help;
};

[[nodiscard]] std::span<const KeyBinding> keyBindings();

/// Adds the commands that set up a new session as this one is set: size, camera, options.
void logSetting(Session& session, CommandLog& log);

}  // namespace hashphase::demos
