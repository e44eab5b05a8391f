// SPDX-License-Identifier: Zlib
#pragma once

// The commands of the viewer: what a line, a key or a script can say.

#include <demos/scenes/effects_fields.hpp>

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

/// What a word of a command can be that its usage has a name for: "X" of "push [X Y Z]".
struct Parameter {
    enum class Kind : std::uint8_t { word, number, whole, field };

    Kind kind = Kind::word;
    double low = 0;  // of a number, the least and the most
    double high = 0;
    const EffectsField* of = nullptr;       // a scene file's, a NumberField: whatever it may have
    std::string what = {};                  // what faults call it; else as the usage does
    std::vector<std::string> choices = {};  // one of these, unless the usage says of which
    bool isOptional = false;
};

struct CommandKind;

/// The words of a command, read. Each fault is an InputError that names the word and says what would be right.
struct Arguments {
    /// Words are separated by spaces; one that begins with '#' begins a comment.
    Arguments(std::string_view line, const CommandKind& kind);

    [[nodiscard]] bool has(std::size_t i) const { return i < words.size(); }
    [[nodiscard]] float number(std::size_t i) const { return static_cast<float>(numbers[i]); }
    [[nodiscard]] std::size_t index(std::size_t i) const {
        return static_cast<std::size_t>(numbers[i]);
    }
    /// "on", "off", or what is not so now, where there is no word.
    [[nodiscard]] bool onOff(std::size_t i, bool now) const {
        return has(i) ? numbers[i] > 0 : !now;
    }

    std::vector<std::string> words;  // after the command's own
    std::vector<double> numbers;     // the same; of a choice its place, of on 1, of other words 0
};

struct CommandKind {
    using Action = void (*)(Session& session, const Arguments& given);

    std::string name;
    CommandRole role;
    /// Its whole form. "[X Y Z]" may be left out, "a|b" is one of these, "X..." are more of the kind.
    std::string usage;
    std::string_view help;
    std::vector<Parameter> parameters;  // in this order; the last stands for all that follow
    Action run;
};

/// The first word of a line; empty for none.
[[nodiscard]] std::string firstWord(std::string_view line);

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
