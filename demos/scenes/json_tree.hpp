// SPDX-License-Identifier: Zlib
#pragma once

// JSON values that know their lines.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

struct JsonValue {
    enum class Kind { null, boolean, number, text, array, object };

    Kind kind = Kind::null;
    std::size_t line = 1;  // of the name, of an array's element the array's
    std::string name{};    // in an object
    bool truth = false;
    double number = 0;
    std::string text{};                // a text's, or a number as it is written
    std::vector<JsonValue> members{};  // of an object, or elements of an array

    /// The member of that name, or nullptr.
    [[nodiscard]] const JsonValue* find(std::string_view memberName) const;
};

/// What it is, for a message: "'many'", "-3.5", "true", "an array".
[[nodiscard]] std::string describe(const JsonValue& value);

/// Throws InputError that begins with `name` and the line, and for broken syntax the column: text that
/// is no JSON or no UTF-8, a name that is given twice in one object, more than 64 KiB, more than eight
/// levels of objects and arrays.
[[nodiscard]] JsonValue parseJson(std::string_view text, const std::string& name);

}  // namespace hashphase::demos
