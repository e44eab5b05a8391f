// SPDX-License-Identifier: Zlib
#include <demos/scenes/json_tree.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <iterator>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr std::size_t kMostBytes = 65536;
constexpr std::size_t kMostLevels = 8;

/// Counts the lines that it passes. The parser looks ahead behind numbers alone, never behind names.
struct LineCounter {
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    reference operator*() const { return *place; }
    LineCounter& operator++() {
        *line += *place == '\n' ? 1U : 0U;
        ++place;
        return *this;
    }
    friend bool operator==(const LineCounter& a, const LineCounter& b) {
        return a.place == b.place;
    }
    friend bool operator!=(const LineCounter& a, const LineCounter& b) { return !(a == b); }

    const char* place;
    std::size_t* line;
};

/// The word around a place, or the one letter there.
std::string_view wordAt(std::string_view text, std::size_t place) {
    const auto isOfWord = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '+';
    };
    std::size_t begin = std::min(place, text.size());
    while (begin > 0 && isOfWord(text[begin - 1])) {
        --begin;
    }
    std::size_t end = begin;
    while (end < text.size() && isOfWord(text[end])) {
        ++end;
    }
    return text.substr(begin, std::max(end - begin, std::size_t{1}));
}

/// What the parser says is wrong, without its place, and with the faulty word for what it read last.
std::string reasonOf(const std::string& sentence, std::string_view word) {
    const std::size_t begin = sentence.find(" - ") + 3;
    const std::size_t lastRead = std::min(sentence.find("; last read: ", begin), sentence.size());
    std::size_t expected = sentence.rfind("; expected ");
    if (expected == std::string::npos || (lastRead < sentence.size() && expected < lastRead)) {
        expected = sentence.size();
    }
    std::string reason = sentence.substr(begin, std::min(lastRead, expected) - begin);
    std::string rest = printable(sentence.substr(expected));
    const bool isLiteral = reason == "invalid literal";
    const bool isBeyondAscii = !word.empty() && (static_cast<unsigned char>(word[0]) & 0x80U) != 0;
    if (reason.find("UTF-8") != std::string::npos) {
        return "the text is not UTF-8";
    }
    if (isLiteral && isBeyondAscii) {
        return "this is not UTF-8, or is text outside quotes";
    }
    // Behind a value a container need not end.
    if (rest == "; expected '}'" || rest == "; expected ']'") {
        rest.insert(rest.size() - 3, "',' or ");
    }
    if (isLiteral) {
        reason += " " + quotedWord(word) + (rest.empty() ? "; expected a value" : "");
    }
    return reason + rest;
}

/// Builds the tree while the parser reads; the names of the functions are the parser's.
class TreeBuilder {
public:
    TreeBuilder(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    [[nodiscard]] LineCounter begin() { return {text_.data(), &line_}; }
    [[nodiscard]] LineCounter end() { return {text_.data() + text_.size(), &line_}; }
    [[nodiscard]] JsonValue takeRoot() { return std::move(root_); }

    bool null() { return add({.kind = JsonValue::Kind::null}); }
    bool boolean(bool truth) { return add({.kind = JsonValue::Kind::boolean, .truth = truth}); }
    bool number_integer(std::int64_t number) {
        return number_float(static_cast<double>(number), std::to_string(number));
    }
    bool number_unsigned(std::uint64_t number) {
        return number_float(static_cast<double>(number), std::to_string(number));
    }
    bool number_float(double number, const std::string& spelling) {
        return add({.kind = JsonValue::Kind::number, .number = number, .text = spelling});
    }
    bool string(std::string& text) {
        return add({.kind = JsonValue::Kind::text, .text = std::move(text)});
    }
    // The text form has none.
    bool binary(std::vector<std::uint8_t>& /*bytes*/) { return false; }
    bool start_object(std::size_t /*count*/) { return open(JsonValue::Kind::object); }
    bool start_array(std::size_t /*count*/) { return open(JsonValue::Kind::array); }
    bool end_object() { return end_array(); }
    bool end_array() {
        open_.pop_back();
        return true;
    }

    bool key(std::string& name) {
        if (const JsonValue* const first = open_.back()->find(name)) {
            fail(std::to_string(line_),
                 quotedWord(name) + " appears twice, first in line " + std::to_string(first->line));
        }
        nextName_ = std::move(name);
        nextLine_ = line_;
        return true;
    }

    bool parse_error(std::size_t bytesRead, const std::string& lastToken,
                     const nlohmann::json::exception& error) {
        // Behind the end, another byte counts as read.
        const std::size_t at = std::min(bytesRead - 1, text_.size());
        const auto line = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at), '\n');
        const std::size_t lineStart = at == 0 ? 0 : text_.rfind('\n', at - 1) + 1;
        const std::string place = std::to_string(line) + ":" + std::to_string(at - lineStart + 1);
        if (dynamic_cast<const nlohmann::json::out_of_range*>(&error) != nullptr) {
            fail(place, printable(lastToken) + " is beyond the largest number, 1.8e308");
        }
        fail(place, "broken JSON: " + reasonOf(error.what(), wordAt(text_, at)));
    }

private:
    [[noreturn]] void fail(const std::string& place, const std::string& fault) const {
        throw InputError(name_ + ":" + place + ": " + fault + ".");
    }

    bool add(JsonValue value) {
        const bool isMember = !open_.empty() && open_.back()->kind == JsonValue::Kind::object;
        value.line = isMember || open_.empty() ? nextLine_ : open_.back()->line;
        value.name = isMember ? std::move(nextName_) : "";
        last_ = open_.empty() ? &root_ : &open_.back()->members.emplace_back();
        *last_ = std::move(value);
        return true;
    }
    bool open(JsonValue::Kind kind) {
        if (open_.size() == kMostLevels) {
            fail(std::to_string(line_), "objects and arrays are nested more than " +
                                            std::to_string(kMostLevels) + " levels deep");
        }
        add({.kind = kind});
        // Where it lies stays there until it is closed, for until then nothing is added beside it.
        open_.push_back(last_);
        return true;
    }

    std::string_view text_;
    const std::string& name_;
    JsonValue root_;
    JsonValue* last_ = nullptr;  // that was added
    std::vector<JsonValue*> open_;
    std::size_t line_ = 1;
    std::string nextName_;
    std::size_t nextLine_ = 1;
};

}  // namespace

const JsonValue* JsonValue::find(std::string_view memberName) const {
    const auto found = std::find_if(members.begin(), members.end(), [&](const JsonValue& member) {
        return member.name == memberName;
    });
    return found == members.end() ? nullptr : &*found;
}

std::string describe(const JsonValue& value) {
    switch (value.kind) {
        case JsonValue::Kind::null:
            return "null";
        case JsonValue::Kind::boolean:
            return value.truth ? "true" : "false";
        case JsonValue::Kind::number:
            return printable(value.text);
        case JsonValue::Kind::text:
            return quotedWord(value.text);
        case JsonValue::Kind::array:
            return "an array";
        case JsonValue::Kind::object:
            return "an object";
    }
    return {};
}

JsonValue parseJson(std::string_view text, const std::string& name) {
    if (text.size() > kMostBytes) {
        throw InputError(name + " has " + std::to_string(text.size()) +
                         " bytes; a declaration may have at most " + std::to_string(kMostBytes) +
                         ".");
    }
    TreeBuilder builder(text, name);
    nlohmann::json::sax_parse(builder.begin(), builder.end(), &builder);
    return builder.takeRoot();
}

}  // namespace hashphase::demos
