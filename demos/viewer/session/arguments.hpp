// SPDX-License-Identifier: Zlib
#pragma once

// The words of a command, taken one by one. Each fault is an InputError that names the word and says what
// would be right.

#include <demos/scenes/effects_fields.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

class Arguments {
public:
    /// Words are separated by spaces; one that begins with '#' begins a comment. `usage` is the whole form, for messages: "pick X Y".
    Arguments(std::string_view line, std::string_view usage);

    [[nodiscard]] bool isEmpty() const noexcept { return next_ == words_.size(); }

    /// A number from `low` to `high`; `name` is what it stands for.
    [[nodiscard]] double number(std::string_view name, double low, double high);
    [[nodiscard]] double numberOr(std::string_view name, double low, double high, double otherwise);
    /// One that a scene file may have in that field, which is a NumberField; without a bound as there.
    [[nodiscard]] double number(std::string_view name, const EffectsField& field);
    /// The same as the first of a whole one.
    [[nodiscard]] long long whole(std::string_view name, long long low, long long high);
    [[nodiscard]] long long wholeOr(std::string_view name, long long low, long long high,
                                    long long otherwise);

    /// The position of the word among those that are known.
    [[nodiscard]] std::size_t choice(std::string_view name,
                                     std::span<const std::string_view> known);

    /// "on", "off", or what is not so now, where there is no word.
    [[nodiscard]] bool onOff(bool now);

    [[nodiscard]] std::string word(std::string_view name);

    /// Nothing may follow.
    void end() const;

private:
    [[noreturn]] void fail(const std::string& fault) const;
    [[nodiscard]] const std::string& take(std::string_view name);

    std::vector<std::string> words_;
    std::size_t next_ = 1;  // the first word is the command
    std::string usage_;
};

/// The first word of a line; empty for none.
[[nodiscard]] std::string firstWord(std::string_view line);

}  // namespace hashphase::demos
