// SPDX-License-Identifier: Zlib

// The schema of scene files, asked as a validator asks it, by as much of one as the schema needs.

#include <demos/scenes/effects_fields.hpp>
#include <demos/scenes/effects_file.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace hashphase::demos {
namespace {

using SchemaJson = nlohmann::json;

SchemaJson schemaOfFiles() {
    return SchemaJson::parse(effectsFileSchema());
}

bool isOfType(const SchemaJson& value, const std::string& type) {
    return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
           (type == "string" && value.is_string()) || (type == "boolean" && value.is_boolean()) ||
           (type == "number" && value.is_number()) ||
           (type == "integer" && value.is_number() &&
            value.get<double>() == std::trunc(value.get<double>()));
}

bool hasType(const SchemaJson& value, const SchemaJson& rule) {
    const SchemaJson types =
        rule["type"].is_array() ? rule["type"] : SchemaJson::array({rule["type"]});
    return std::any_of(types.begin(), types.end(),
                       [&](const SchemaJson& type) { return isOfType(value, type); });
}

bool isInRange(const SchemaJson& number, const SchemaJson& rule) {
    return number >= rule.value("minimum", number) && number <= rule.value("maximum", number);
}

bool isValid(const SchemaJson& value, const SchemaJson& rule);

bool hasValidElements(const SchemaJson& array, const SchemaJson& rule) {
    return array.size() >= rule["minItems"] && array.size() <= rule["maxItems"] &&
           std::all_of(array.begin(), array.end(),
                       [&](const SchemaJson& element) { return isValid(element, rule["items"]); });
}

// No object may have other members than those.
bool hasValidMembers(const SchemaJson& object, const SchemaJson& rule) {
    EXPECT_EQ(rule["additionalProperties"], false);
    const auto members = object.items();
    return std::all_of(members.begin(), members.end(), [&](const auto& member) {
        return rule["properties"].contains(member.key()) &&
               isValid(member.value(), rule["properties"][member.key()]);
    });
}

bool isValid(const SchemaJson& value, const SchemaJson& rule) {
    if (rule.contains("anyOf")) {
        return std::any_of(rule["anyOf"].begin(), rule["anyOf"].end(),
                           [&](const SchemaJson& each) { return isValid(value, each); });
    }
    if (rule.contains("const")) {
        return value == rule["const"];
    }
    if (rule.contains("enum")) {
        return std::count(rule["enum"].begin(), rule["enum"].end(), value) == 1;
    }
    return hasType(value, rule) && (!value.is_number() || isInRange(value, rule)) &&
           (!value.is_array() || hasValidElements(value, rule)) &&
           (!value.is_object() || hasValidMembers(value, rule));
}

TEST(EffectsSchema, IsOfTheDraftOf2020) {
    EXPECT_EQ(schemaOfFiles()["$schema"], "https://json-schema.org/draft/2020-12/schema");
}

TEST(EffectsSchema, DescribesEveryField) {
    const SchemaJson schema = schemaOfFiles();
    for (const EffectsField& field : effectsFields()) {
        std::string place;
        std::istringstream path(pathOf(field.section, field.name));
        for (std::string name; std::getline(path, name, '.');) {
            place += "/properties/" + name;
        }
        ASSERT_TRUE(schema.contains(SchemaJson::json_pointer(place))) << place;
        const SchemaJson& rule = schema[SchemaJson::json_pointer(place)];
        EXPECT_EQ(rule["description"].get<std::string>().rfind(field.meaning, 0), 0U) << place;
        const bool hasFields = std::holds_alternative<SectionField>(field.kind) ||
                               std::holds_alternative<EffectField>(field.kind);
        EXPECT_NE(rule.contains("properties"), rule.contains("default")) << place;
        EXPECT_EQ(rule.contains("properties"), hasFields) << place;
        EXPECT_TRUE(hasFields || isValid(rule["default"], rule)) << place;
    }
}

TEST(EffectsSchema, HoldsForTheExamplesAndForWhatIsWritten) {
    const SchemaJson schema = schemaOfFiles();
    for (const char* name : {"paper", "projectiles", "lookers", "budget"}) {
        const std::string text =
            readFile(std::string(HASHPHASE_SCENE_EXAMPLES "/") + name + ".json");
        EXPECT_TRUE(isValid(SchemaJson::parse(text), schema)) << name;
    }
    EffectsFile file;
    for (const Effect effect : kAllEffects) {
        file.effects.declare(effect);
    }
    EXPECT_TRUE(isValid(SchemaJson::parse(effectsFileText(file)), schema));
}

TEST(EffectsSchema, RefusesWhatTheReaderRefuses) {
    const SchemaJson schema = schemaOfFiles();
    for (const char* text : {
             "[]",
             R"({"titel": ""})",
             R"({"title": 3})",
             R"({"scene": null})",
             R"({"scene": {"objects": 0}})",
             R"({"scene": {"objects": 1.5}})",
             R"({"scene": {"seed": 4294967296}})",
             R"({"scene": {"radius": "none"}})",
             R"({"effects": {"culing": true}})",
             R"({"effects": {"motion": 5}})",
             R"({"effects": {"motion": {"bounds": {"min": [1, 2]}}}})",
             R"({"effects": {"motion": {"bounds": {"min": [1, 2, "a"]}}}})",
             R"({"effects": {"pairs": {"radius": 1}}})",
             R"({"effects": {"sweep": {"mode": "none"}}})",
             R"({"effects": {"sleeping": {"slowBelow": "fast"}}})",
             R"({"effects": {"sleeping": {"slowBelow": -1}}})",
             R"({"effects": {"radar": {"cellSize": 0}}})",
         }) {
        EXPECT_FALSE(isValid(SchemaJson::parse(text), schema)) << text;
        EXPECT_THROW(static_cast<void>(parseEffectsFile(text, "scene.json")), InputError) << text;
    }
}

}  // namespace
}  // namespace hashphase::demos
