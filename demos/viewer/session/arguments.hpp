// SPDX-License-Identifier: Zlib
#pragma once

// The words of a command, read. Each fault is an InputError that names the word and says what would be right.

#include <demos/scenes/effects_fields.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// What a word of a command can be.
struct Parameter {
    enum class Kind : std::uint8_t { word, number, whole, field, choice, onOff };

    Kind kind = Kind::word;
    double low = 0;  // of a number, the least and the most
    double high = 0;
    std::string_view what = {};  // is chosen; else what the command's usage calls it
    std::vector<std::string_view> known = {};
    const EffectsField* of = nullptr;  // a scene file's, a NumberField: whatever it may have
    bool isOptional = false;           // with all that follow
    bool repeats = false;              // it is the last
};

struct Arguments {
    /// Words are separated by spaces; one that begins with '#' begins a comment. `usage` is the command's
    /// whole form, which names its parameters: "push [X Y Z]".
    Arguments(std::string_view line, std::string_view usage, std::span<const Parameter> parameters);

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

/// The first word of a line; empty for none.
[[nodiscard]] std::string firstWord(std::string_view line);

}  // namespace hashphase::demos
