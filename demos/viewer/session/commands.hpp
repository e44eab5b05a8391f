// SPDX-License-Identifier: Zlib
#pragma once

// The commands of the viewer: what a line, a key or a script can say.

#include <demos/viewer/session/arguments.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

struct Session;

/// What a command is to a recording, and to whoever looks on while one is replayed.
enum class CommandRole : std::uint8_t {
    chooses,  // what is on stage: begins another recording
    changes,  // what happens, or who is seen: belongs into a recording
    shows,  // what is told of it, and how: belongs into a recording as well, and may be done to a replay
    steers,  // when frames come, what stands beside the picture, questions: are the onlooker's own affair
    writes,  // files: no recording may do so, as it may come from anywhere
};

[[nodiscard]] constexpr bool isLogged(CommandRole role) noexcept {
    return role == CommandRole::changes || role == CommandRole::shows;
}
/// Whether what is replayed is the same recording after it.
[[nodiscard]] constexpr bool leavesReplay(CommandRole role) noexcept {
    return role != CommandRole::chooses && role != CommandRole::changes;
}

struct CommandKind {
    using Action = void (*)(Session& session, const Arguments& given);

    std::string name;
    CommandRole role;
    std::string usage;  // "pick X Y"
    std::string_view help;
    std::vector<Parameter> parameters;
    Action run;
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

}  // namespace hashphase::demos
