// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/arguments.hpp>

#include <demos/console/format.hpp>
#include <demos/console/nearest_name.hpp>
#include <demos/console/number_words.hpp>
#include <demos/scenes/input_error.hpp>

#include <limits>
#include <optional>
#include <sstream>
#include <variant>

namespace hashphase::demos {
namespace {

bool isNumber(const std::string& word, double& number) {
    const std::optional<double> read = finiteNumber(word);
    number = read.value_or(0);
    return read.has_value();
}

bool isNumber(const std::string& word, long long& number) {
    const bool isNegative = word.starts_with('-');
    const std::optional<std::uint64_t> read = wholeNumber(word.substr(isNegative ? 1 : 0));
    if (!read || *read > std::uint64_t{std::numeric_limits<long long>::max()}) {
        return false;
    }
    number = static_cast<long long>(*read) * (isNegative ? -1 : 1);
    return true;
}

}  // namespace

std::string firstWord(std::string_view line) {
    std::istringstream words{std::string(line)};
    std::string first;
    words >> first;
    return first.starts_with('#') ? std::string() : first;
}

Arguments::Arguments(std::string_view line, std::string_view usage) : usage_(usage) {
    std::istringstream words{std::string(line)};
    for (std::string word; words >> word && !word.starts_with('#');) {
        words_.push_back(word);
    }
}

void Arguments::fail(const std::string& fault) const {
    throw InputError(fault + " The command is: " + usage_);
}

const std::string& Arguments::take(std::string_view name) {
    if (isEmpty()) {
        fail(std::string(name) + " is missing.");
    }
    return words_[next_++];
}

double Arguments::number(std::string_view name, double low, double high) {
    const std::string& word = take(name);
    double number = 0;
    if (!isNumber(word, number) || !(number >= low && number <= high)) {
        fail(std::string(name) + " is a number from " + plain(low) + " to " + plain(high) +
             ", not " + quotedWord(word) + ".");
    }
    return number;
}

double Arguments::number(std::string_view name, const EffectsField& field) {
    const auto& limits = std::get<NumberField>(field.kind);
    const std::string& word = take(name);
    if (word == kNoBound && limits.most == NumberField::kInfinite) {
        return NumberField::kInfinite;
    }
    double number = 0;
    if (!isNumber(word, number) || !(number >= limits.least && number <= limits.most)) {
        fail(std::string(name) + " is " + requirementOf(field) + ", not " + quotedWord(word) + ".");
    }
    return number;
}

double Arguments::numberOr(std::string_view name, double low, double high, double otherwise) {
    return isEmpty() ? otherwise : number(name, low, high);
}

long long Arguments::whole(std::string_view name, long long low, long long high) {
    const std::string& word = take(name);
    long long number = 0;
    if (!isNumber(word, number) || number < low || number > high) {
        fail(std::string(name) + " is a whole number from " + std::to_string(low) + " to " +
             std::to_string(high) + ", not " + quotedWord(word) + ".");
    }
    return number;
}

long long Arguments::wholeOr(std::string_view name, long long low, long long high,
                             long long otherwise) {
    return isEmpty() ? otherwise : whole(name, low, high);
}

std::size_t Arguments::choice(std::string_view name, std::span<const std::string_view> known) {
    const std::string& word = take(name);
    for (std::size_t i = 0; i < known.size(); ++i) {
        if (known[i] == word) {
            return i;
        }
    }
    const std::vector<std::string> names(known.begin(), known.end());
    throw InputError(unknownNameSentence(name, word, names));
}

bool Arguments::onOff(bool now) {
    if (isEmpty()) {
        return !now;
    }
    const std::string& word = take("on or off");
    if (word != "on" && word != "off") {
        fail(quotedWord(word) + " is neither on nor off.");
    }
    return word == "on";
}

std::string Arguments::word(std::string_view name) {
    return take(name);
}

void Arguments::end() const {
    if (!isEmpty()) {
        fail(quotedWord(words_[next_]) + " is one word too many.");
    }
}

}  // namespace hashphase::demos
