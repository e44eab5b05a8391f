// SPDX-License-Identifier: Zlib
//
// The words of a command, read by its usage.

#include <demos/viewer/session/commands.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <cctype>
#include <optional>
#include <sstream>
#include <variant>

namespace hashphase::demos {
namespace {

std::vector<std::string> wordsOf(std::string_view line) {
    std::istringstream text{std::string(line)};
    std::vector<std::string> words;
    for (std::string word; text >> word && !word.starts_with('#');) {
        words.push_back(word);
    }
    return words;
}

std::optional<double> wholeOf(const std::string& word) {
    const bool isNegative = word.starts_with('-');
    const std::optional<std::uint64_t> read = wholeNumber(word.substr(isNegative ? 1 : 0));
    return read ? std::optional(static_cast<double>(*read) * (isNegative ? -1 : 1)) : std::nullopt;
}

/// What a number is to be.
std::string requirementOf(const Parameter& parameter) {
    switch (parameter.kind) {
        case Parameter::Kind::field:
            return demos::requirementOf(*parameter.of);
        case Parameter::Kind::whole:
            return "a whole number from " + std::to_string(static_cast<long long>(parameter.low)) +
                   " to " + std::to_string(static_cast<long long>(parameter.high));
        default:
            return "a number from " + plain(parameter.low) + " to " + plain(parameter.high);
    }
}

std::optional<double> numberOf(const Parameter& parameter, const std::string& word) {
    double low = parameter.low;
    double high = parameter.high;
    if (parameter.kind == Parameter::Kind::field) {
        const auto& limits = std::get<NumberField>(parameter.of->kind);
        low = limits.least;
        high = limits.most;
        if (word == kNoBound && high == NumberField::kInfinite) {
            return high;
        }
    }
    const std::optional<double> number =
        parameter.kind == Parameter::Kind::whole ? wholeOf(word) : finiteNumber(word);
    return number && *number >= low && *number <= high ? number : std::nullopt;
}

/// What stands for a word in a usage: "X" of "[X Y Z]", "top|free|follow".
struct Place {
    explicit Place(std::string text) : isOptional(text.starts_with('[')), name(std::move(text)) {
        std::erase_if(name, [](char each) { return each == '[' || each == ']' || each == '.'; });
        if (name.find('|') != std::string::npos && std::ranges::none_of(name, ::isupper)) {
            std::istringstream all(name);
            for (std::string choice; std::getline(all, choice, '|');) {
                choices.push_back(choice);
            }
        }
    }

    [[nodiscard]] bool isOnOff() const { return name == "on|off"; }

    bool isOptional;  // with all that follow
    std::string name;
    std::vector<std::string> choices;  // where the usage tells them
};

double placeIn(const std::vector<std::string>& choices, std::string_view what,
               const std::string& word) {
    const auto place = std::ranges::find(choices, word);
    if (place == choices.end()) {
        throw InputError(unknownNameSentence(what, word, choices));
    }
    return static_cast<double>(place - choices.begin());
}

}  // namespace

std::string firstWord(std::string_view line) {
    const std::vector<std::string> words = wordsOf(line);
    return words.empty() ? std::string() : words.front();
}

Arguments::Arguments(std::string_view line, const CommandKind& kind) : words(wordsOf(line)) {
    words.erase(words.begin());
    const auto fail = [&kind](const std::string& fault) {
        throw InputError(fault + " The command is: " + kind.usage);
    };
    const std::vector<std::string> usage = wordsOf(kind.usage);
    const std::span<const Parameter> parameters = kind.parameters;
    std::size_t count = std::max(usage.size() - 1, parameters.size());
    if (kind.usage.ends_with("...") && parameters.size() < usage.size()) {
        count = std::max(count, words.size());
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Place place(usage[std::min(i + 1, usage.size() - 1)]);
        const Parameter parameter =
            parameters.empty() ? Parameter() : parameters[std::min(i, parameters.size() - 1)];
        const std::vector<std::string>& choices =
            place.choices.empty() ? parameter.choices : place.choices;
        const std::string what = !parameter.what.empty() ? parameter.what
                                 : choices.empty()       ? place.name
                                                         : kind.name;
        if (!has(i) && (place.isOptional || parameter.isOptional)) {
            break;
        }
        if (!has(i)) {
            fail(what + " is missing.");
        }
        const std::string& word = words[i];
        if (place.isOnOff() && word != "on" && word != "off") {
            fail(quotedWord(word) + " is neither on nor off.");
        }
        if (place.isOnOff()) {
            numbers.push_back(word == "on" ? 1 : 0);
        } else if (!choices.empty()) {
            numbers.push_back(placeIn(choices, what, word));
        } else if (parameter.kind == Parameter::Kind::word) {
            numbers.push_back(0);
        } else if (const std::optional<double> number = numberOf(parameter, word)) {
            numbers.push_back(*number);
        } else {
            fail(what + " is " + requirementOf(parameter) + ", not " + quotedWord(word) + ".");
        }
    }
    if (words.size() > numbers.size()) {
        fail(quotedWord(words[numbers.size()]) + " is one word too many.");
    }
}

}  // namespace hashphase::demos
