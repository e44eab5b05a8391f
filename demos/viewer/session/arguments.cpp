// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/arguments.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>

#include <algorithm>
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

double placeOf(const Parameter& parameter, const std::string& word) {
    const auto place = std::ranges::find(parameter.known, word);
    if (place == parameter.known.end()) {
        const std::vector<std::string> names(parameter.known.begin(), parameter.known.end());
        throw InputError(unknownNameSentence(parameter.what, word, names));
    }
    return static_cast<double>(place - parameter.known.begin());
}

/// Of a usage, as "X" of "[X Y Z]".
std::string nameIn(std::string word) {
    std::erase_if(word,
                  [](char letter) { return letter == '[' || letter == ']' || letter == '.'; });
    return word;
}

template <class Fail>
double valueOf(const Parameter& parameter, const std::string& name, const std::string& word,
               const Fail& fail) {
    switch (parameter.kind) {
        case Parameter::Kind::word:
            return 0;
        case Parameter::Kind::choice:
            return placeOf(parameter, word);
        case Parameter::Kind::onOff:
            if (word != "on" && word != "off") {
                fail(quotedWord(word) + " is neither on nor off.");
            }
            return word == "on" ? 1 : 0;
        default:
            break;
    }
    const std::optional<double> number = numberOf(parameter, word);
    if (!number) {
        fail(name + " is " + requirementOf(parameter) + ", not " + quotedWord(word) + ".");
    }
    return number.value_or(0);
}

}  // namespace

std::string firstWord(std::string_view line) {
    const std::vector<std::string> words = wordsOf(line);
    return words.empty() ? std::string() : words.front();
}

Arguments::Arguments(std::string_view line, std::string_view usage,
                     std::span<const Parameter> parameters)
    : words(wordsOf(line)) {
    words.erase(words.begin());
    const auto fail = [usage](const std::string& fault) {
        throw InputError(fault + " The command is: " + std::string(usage));
    };
    const std::vector<std::string> names = wordsOf(usage);
    const bool repeats = !parameters.empty() && parameters.back().repeats;
    const std::size_t count = repeats ? std::max(words.size(), std::size_t{1}) : parameters.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Parameter& parameter = parameters[std::min(i, parameters.size() - 1)];
        const std::string name = parameter.what.empty()
                                     ? nameIn(names[std::min(i + 1, names.size() - 1)])
                                     : std::string(parameter.what);
        if (!has(i) && parameter.isOptional) {
            break;
        }
        if (!has(i)) {
            fail(name + " is missing.");
        }
        numbers.push_back(valueOf(parameter, name, words[i], fail));
    }
    if (words.size() > numbers.size()) {
        fail(quotedWord(words[numbers.size()]) + " is one word too many.");
    }
}

}  // namespace hashphase::demos
