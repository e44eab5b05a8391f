// SPDX-License-Identifier: Zlib

// What is wrong with a scene file, for its reader and for its schema.

#include <demos/scenes/effects_fields.hpp>
#include <demos/scenes/effects_file.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

// --- The schema, asked as a validator asks it, by as much of one as it needs ----------------------

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
        const bool hasFields = std::holds_alternative<ObjectField>(field.kind);
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

// --- Faults --------------------------------------------------------------------------------------

struct Fault {
    std::string text;
    std::string sentence;  // behind the file's name
};

void expectFaults(const std::vector<Fault>& faults) {
    for (const Fault& fault : faults) {
        const std::string found =
            messageOf<InputError>([&] { return parseEffectsFile(fault.text, "scene.json"); });
        EXPECT_EQ(found, "scene.json" + fault.sentence) << fault.text;
    }
}

/// Of which the schema knows, too.
void expectFaultsBySchema(const std::vector<Fault>& faults) {
    expectFaults(faults);
    const SchemaJson schema = schemaOfFiles();
    for (const Fault& fault : faults) {
        EXPECT_FALSE(isValid(SchemaJson::parse(fault.text), schema)) << fault.text;
    }
}

TEST(EffectsFileFaults, NameAnUnknownField) {
    expectFaultsBySchema({
        {"{\"effects\": {\n  \"culing\": true}}",
         ":2: effects.culing: there is no such effect; did you mean culling?"},
        {R"({"effects": {"levitation": true}})",
         ":1: effects.levitation: there is no such effect; there are motion, terrain, pairs, "
         "response, sweep, sleeping, rotation, friction, picking, boxSelection, culling, "
         "proximity, zones, radar."},
        {R"({"titel": "x"})", ":1: titel: there is no such field; did you mean title?"},
        {"{\"scene\": {\n\n\"timestep\": 1}}",
         ":3: scene.timestep: there is no such field; did you mean timeStep?"},
        {R"({"effects": {"pairs": {"radius": 1}}})",
         ":1: effects.pairs.radius: there is no such field; effects.pairs has no settings."},
        {R"({"scene.objects": 3})",
         ":1: scene.objects: there is no such field; there are $schema, title, scene, effects, "
         "grid."},
    });
}

TEST(EffectsFileFaults, NameAFieldOfTheWrongKind) {
    expectFaultsBySchema({
        {"[]", ":1: the file holds an array, but must hold an object."},
        {"3", ":1: the file holds 3, but must hold an object."},
        {R"({"title": 3})", ":1: title is 3, but must be a text."},
        {R"({"scene": null})", ":1: scene is null, but must be an object."},
        {"{\"scene\":\n{\"radius\":\n\"large\"}}",
         ":2: scene.radius is 'large', but must be a number from 0.001 to 1000 [m]."},
        {R"({"scene": {"radius": "none"}})",
         ":1: scene.radius is 'none', but must be a number from 0.001 to 1000 [m]."},
        {R"({"effects": {"sleeping": {"slowBelow": "fast"}}})",
         ":1: effects.sleeping.slowBelow is 'fast', but must be a number, 0 or more, or 'none' "
         "[m/s]."},
        {R"({"scene": {"objects": true}})",
         ":1: scene.objects is true, but must be a whole number from 1 to 10000000."},
        {R"({"scene": {"objects": {}}})",
         ":1: scene.objects is an object, but must be a whole number from 1 to 10000000."},
        {R"({"scene": {"objects": []}})",
         ":1: scene.objects is an array, but must be a whole number from 1 to 10000000."},
        {R"({"effects": {"motion": 5}})",
         ":1: effects.motion is 5, but must be true, false or an object of settings."},
        {R"({"effects": {"sweep": {"mode": "none"}}})",
         ":1: effects.sweep.mode is 'none', but must be 'automatic', 'box' or 'line'."},
        {R"({"effects": {"radar": {"up": 1}}})",
         ":1: effects.radar.up is 1, but must be 'x', 'y' or 'z'."},
        {R"({"effects": {"culling": {"margin": "none"}}})",
         ":1: effects.culling.margin is 'none', but must be a number from 0 to 1e+30 [m]."},
        {R"({"effects": {"motion": {"bounds": {"min": [1, 2]}}}})",
         ":1: effects.motion.bounds.min is [1, 2], but must be an array of three numbers, each of "
         "which may be 'none' [m]."},
        {R"({"effects": {"motion": {"bounds": {"max": [1, "a", {}]}}}})",
         ":1: effects.motion.bounds.max is [1, 'a', an object], but must be an array of three "
         "numbers, each of which may be 'none' [m]."},
    });
}

TEST(EffectsFileFaults, NameANumberOutOfItsRange) {
    expectFaultsBySchema({
        {R"({"scene": {"objects": 0}})",
         ":1: scene.objects is 0, but must be a whole number from 1 to 10000000."},
        {R"({"scene": {"objects": -1}})",
         ":1: scene.objects is -1, but must be a whole number from 1 to 10000000."},
        {R"({"scene": {"objects": 1.5}})",
         ":1: scene.objects is 1.5, but must be a whole number from 1 to 10000000."},
        {R"({"scene": {"seed": 4294967296}})",
         ":1: scene.seed is 4294967296, but must be a whole number from 0 to 4294967295."},
        {R"({"scene": {"seed": 123456789012345678901234567890}})",
         ":1: scene.seed is 123456789012345678901234567890, but must be a whole number from 0 to "
         "4294967295."},
        {R"({"scene": {"radius": 1e-9}})",
         ":1: scene.radius is 1e-9, but must be a number from 0.001 to 1000 [m]."},
        {R"({"effects": {"response": {"restitution": 1.01}}})",
         ":1: effects.response.restitution is 1.01, but must be a number from 0 to 1."},
        {R"({"effects": {"sleeping": {"slowBelow": -1}}})",
         ":1: effects.sleeping.slowBelow is -1, but must be a number, 0 or more, or 'none' [m/s]."},
        {R"({"effects": {"radar": {"cellSize": 0}}})",
         ":1: effects.radar.cellSize is 0, but must be a number from 1e-30 to 1e+30 [m]."},
    });
}

TEST(EffectsFileFaults, NameTheLineOfAContradiction) {
    expectFaults({
        {"{\"effects\": {\n  \"terrain\":\n true}}",
         ":2: effects.terrain is declared without motion, but it puts moved bodies on the ground. "
         "Declare motion too, or leave out terrain."},
        {"{\"effects\": {\"motion\": {\n\"bounds\": {\"min\": [5, 0, 0],\n\"max\": [1, 1, 1]}}}}",
         ":2: effects.motion.bounds: the lower corner is 5, but must be not above the upper one "
         "[m]."},
        {"{\"effects\": {\n\"zones\": {\n\"farFrames\": 2}}}",
         ":3: effects.zones.farFrames is 2, but no distance counts as far. Set "
         "zones.interestRadius too [m]."},
        {"{\"effects\": {\n\"radar\": {\"columns\": 100000, \"rows\": 100000}}}",
         ":2: effects.radar: columns * rows * groupCount is 1e+10, but must be from 1 to "
         "268435456."},
        {"{\"grid\": {\n\"cellSize\": 1e-31}}",
         ":2: grid.cellSize is 1e-31, but must be 0 (choose automatically) or between 1e-30 and "
         "1e30 [m]."},
        {"{\"scene\": {\n\"radius\": 300}}",
         ":2: scene.radius is 300, but a body must fit into scene.domain, which is 400 [m]."},
        {"{\"scene\": {\n\"domain\": 1}}",
         ":1: scene.radius is 1, but a body must fit into scene.domain, which is 1 [m]."},
    });
}

TEST(EffectsFileFaults, NameLineAndColumnOfBrokenSyntax) {
    expectFaults({
        {"{", ":1:2: broken JSON: unexpected end of input; expected string literal."},
        {"{\"title\": \"x\",\n}", ":2:1: broken JSON: unexpected '}'; expected string literal."},
        {"{\n \"scene\": {\"objects\": 5 \"radius\": 2}}",
         ":2:32: broken JSON: unexpected string literal; expected ',' or '}'."},
        {R"({"scene": {"objects": tru}})",
         ":1:26: broken JSON: invalid literal 'tru'; expected a value."},
        {R"({"scene": {"radius": NaN}})",
         ":1:22: broken JSON: invalid literal 'NaN'; expected a value."},
        {R"({"scene": {"radius": .5}})",
         ":1:22: broken JSON: invalid literal '.5'; expected a value."},
        {R"({"scene": {"radius": 5.}})",
         ":1:24: broken JSON: invalid number; expected digit after '.'."},
        {R"({"scene": {"radius": 1e999}})", ":1:26: 1e999 is beyond the largest number, 1.8e308."},
        {R"({"scene": {"radius"}})", ":1:20: broken JSON: unexpected '}'; expected ':'."},
        {R"({"effects": {"motion": {"bounds": {"min": [1 2]}}}})",
         ":1:46: broken JSON: unexpected number literal; expected ',' or ']'."},
        {"{\"title\": \"a\nb\"}",
         ":1:13: broken JSON: invalid string: control character U+000A (LF) must be escaped to "
         "\\u000A or \\n."},
        {R"({"title": "a)", ":1:13: broken JSON: invalid string: missing closing quote."},
        {"{} {}", ":1:4: broken JSON: unexpected '{'; expected end of input."},
        {"// a scene\n{}", ":1:1: broken JSON: invalid literal '/'; expected a value."},
        {"{'title': 1}", ":1:2: broken JSON: invalid literal '''; expected string literal."},
    });
}

TEST(EffectsFileFaults, NameAFieldThatIsGivenTwice) {
    expectFaults({
        {"{\"scene\": {\"domain\":\n300,\n\"domain\": 300}}",
         ":3: 'domain' appears twice, first in line 1."},
        {"{\"title\": \"\",\n\"title\": \"\"}", ":2: 'title' appears twice, first in line 1."},
    });
}

TEST(EffectsFileFaults, NameWhatIsNotUtf8) {
    expectFaults({
        {"{\"title\": \"\xff\"}", ":1:12: broken JSON: the text is not UTF-8."},
        {"\xff\xfe{", ":1:1: broken JSON: this is not UTF-8, or is text outside quotes."},
    });
}

TEST(EffectsFileFaults, NameWhatIsNoSceneAtAll) {
    const std::string empty =
        " is empty; a scene is an object, such as {\"effects\": {\"motion\": true}}.";
    expectFaults({
        {"", empty},
        {" \t\r\n", empty},
        {"\n" + std::string(60'000, '['),
         ":2: objects and arrays are nested more than 8 levels deep."},
        {std::string(70'000, '1'), " has 70000 bytes; a declaration may have at most 65536."},
        {"{\"" + std::string(50'000, 'x') + "\": 1}",
         ":1: " + std::string(40, 'x') +
             "...: there is no such field; there are $schema, title, scene, effects, grid."},
        {"{\"\\u001b[2J\": 1}",
         ":1: ?[2J: there is no such field; there are $schema, title, scene, effects, grid."},
    });
}

}  // namespace
}  // namespace hashphase::demos
