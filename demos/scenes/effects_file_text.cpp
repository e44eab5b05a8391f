// SPDX-License-Identifier: Zlib
#include <demos/scenes/effects_fields.hpp>
#include <demos/scenes/effects_file.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

using Json = nlohmann::ordered_json;

/// Whole numbers without a point.
Json numberJson(double number) {
    constexpr double kMostDigits = 1e15;
    if (std::isinf(number)) {
        return kNoBound;
    }
    const bool isWhole = std::abs(number) < kMostDigits && number == std::trunc(number);
    return isWhole ? Json(static_cast<std::int64_t>(number)) : Json(number);
}

/// A field of a file, by its path.
struct Subject {
    EffectsFile& file;
    std::string path;
};

Json membersOf(const Subject& section);
Json rulesOf(const Subject& section);

/// What the field holds.
Json valueOf(const ObjectField& /*field*/, const Subject& of) {
    return membersOf(of);
}
Json valueOf(const TextField& field, const Subject& of) {
    return field.place(of.file);
}
Json valueOf(const NumberField& field, const Subject& of) {
    return numberJson(field.access.get(of.file));
}
Json valueOf(const ChoiceField& field, const Subject& of) {
    const auto value = static_cast<std::uint8_t>(field.access.get(of.file));
    return std::ranges::find(field.choices, value, &NamedValue::value)->name;
}
Json valueOf(const CornerField& field, const Subject& of) {
    const Vector3<double>& corner = field.place(of.file);
    return {numberJson(corner.x()), numberJson(corner.y()), numberJson(corner.z())};
}

/// What the schema says about the field's value, which the file holds by default.
Json ruleOf(const ObjectField& field, const Subject& of) {
    return {{"type", field.effect ? Json{"boolean", "object"} : Json("object")},
            {"properties", rulesOf(of)},
            {"additionalProperties", false}};
}
Json ruleOf(const TextField& field, const Subject& of) {
    return {{"type", "string"}, {"default", valueOf(field, of)}};
}
Json ruleOf(const NumberField& field, const Subject& of) {
    Json rule{{"type", field.isWhole ? "integer" : "number"}, {"minimum", numberJson(field.least)}};
    if (field.most < NumberField::kInfinite) {
        rule["maximum"] = numberJson(field.most);
    } else {
        rule = {{"anyOf", {rule, {{"const", kNoBound}}}}};
    }
    rule["default"] = valueOf(field, of);
    return rule;
}
Json ruleOf(const ChoiceField& field, const Subject& of) {
    Json names = Json::array();
    for (const NamedValue& choice : field.choices) {
        names.push_back(choice.name);
    }
    return {{"enum", names}, {"default", valueOf(field, of)}};
}
Json ruleOf(const CornerField& field, const Subject& of) {
    const Json coordinate{{"anyOf", {{{"type", "number"}}, {{"const", kNoBound}}}}};
    return {{"type", "array"},
            {"items", coordinate},
            {"minItems", 3},
            {"maxItems", 3},
            {"default", valueOf(field, of)}};
}

bool isLeftOut(const EffectsField& field, const Subject& of) {
    if (const auto* object = std::get_if<ObjectField>(&field.kind)) {
        return object->effect && !of.file.effects.set().contains(*object->effect);
    }
    const auto* text = std::get_if<TextField>(&field.kind);
    return text != nullptr && text->place(of.file).empty();
}

/// Calls add(field, its place) for each field of the section.
template <class Add>
void forEachIn(const Subject& section, const Add& add) {
    for (const EffectsField& field : effectsFields()) {
        if (field.section == section.path) {
            add(field, Subject{section.file, pathOf(field.section, field.name)});
        }
    }
}

Json membersOf(const Subject& section) {
    Json members = Json::object();
    forEachIn(section, [&](const EffectsField& field, const Subject& of) {
        if (!isLeftOut(field, of)) {
            members[std::string(field.name)] =
                std::visit([&](const auto& kind) { return valueOf(kind, of); }, field.kind);
        }
    });
    return members;
}

Json rulesOf(const Subject& section) {
    Json rules = Json::object();
    forEachIn(section, [&](const EffectsField& field, const Subject& of) {
        Json& rule = rules[std::string(field.name)];
        rule["description"] = std::string(field.meaning) +
                              (field.unit.empty() ? "" : " [" + std::string(field.unit) + "]");
        rule.update(std::visit([&](const auto& kind) { return ruleOf(kind, of); }, field.kind));
    });
    return rules;
}

std::string textOf(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace

std::string effectsFileText(const EffectsFile& file) {
    EffectsFile copy = file;
    return textOf(membersOf({copy, ""}));
}

std::string effectsFileSchema() {
    EffectsFile defaults;
    for (const Effect effect : kAllEffects) {
        defaults.effects.declare(effect);
    }
    Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                {"title", "A scene of effects"}};
    schema.update(ruleOf(ObjectField{}, {defaults, ""}));
    return textOf(schema);
}

}  // namespace hashphase::demos
