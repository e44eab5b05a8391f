// SPDX-License-Identifier: Zlib
#pragma once

// The fields of a scene file: one table, by which files are read, refused, written and described.

#include <demos/scenes/effects_file.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace hashphase::demos {

/// What stands in a file for a number without a bound.
inline constexpr std::string_view kNoBound = "none";

/// An object of further fields; of an effect, also true or false.
struct ObjectField {
    std::optional<Effect> effect = std::nullopt;
};

struct TextField {
    std::string& (*place)(EffectsFile&);
};

/// How a number, or an enumerator as a number, is read and written.
struct Access {
    double (*get)(EffectsFile&);
    void (*set)(EffectsFile&, double);
};

struct NumberField {
    static constexpr double kInfinite = std::numeric_limits<double>::infinity();

    double least;
    double most;  // kInfinite: there may be no bound
    Access access;
    bool isWhole = false;
};

struct NamedValue {
    std::string_view name;
    std::uint8_t value;
};

/// One enumerator of several.
struct ChoiceField {
    std::span<const NamedValue> choices;
    Access access;
};

/// Three numbers, each of which may be without a bound.
struct CornerField {
    double noBound;  // what that means
    Vector3<double>& (*place)(EffectsFile&);
};

using FieldKind = std::variant<ObjectField, TextField, NumberField, ChoiceField, CornerField>;

struct EffectsField {
    std::string_view section;  // the path of the object that it is in; empty for the file itself
    std::string_view name;
    std::string_view meaning;
    std::string_view unit;
    FieldKind kind;  // the place of an effect's setting is there only while the effect is declared
};

/// Sections before what is in them, otherwise in the order of a file.
[[nodiscard]] std::span<const EffectsField> effectsFields();

/// "effects.sweep.mode"
[[nodiscard]] std::string pathOf(std::string_view section, std::string_view name);

/// A number as files and messages have it: "3", "0.25", "1e+30".
[[nodiscard]] std::string numberText(double number);

/// What a value must be, for messages: "a number from 0 to 1 [m]".
[[nodiscard]] std::string requirementOf(const EffectsField& field);

}  // namespace hashphase::demos
