// SPDX-License-Identifier: Zlib
#include <demos/scenes/effects_fields.hpp>
#include <demos/scenes/effects_file.hpp>
#include <demos/scenes/input_error.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace hashphase::demos {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

EffectsFile parse(const std::string& text) {
    return parseEffectsFile(text, "scene.json");
}

EffectsFile withAllEffects() {
    EffectsFile file;
    for (const Effect effect : kAllEffects) {
        file.effects.declare(effect);
    }
    return file;
}

// Every field, none of them as it is by default.
const std::string kEveryField = R"({
  "$schema": "scene.schema.json",
  "title": "\"Ωmega\", a test",
  "scene": {"objects": 4000, "radius": 0.1, "domain": 123.5, "terrain": 64, "speed": 7,
            "moving": 0.5, "fast": 0.01, "fastSpeed": 555, "seed": 4294967295, "zones": 20,
            "frames": 60, "timeStep": 0.01},
  "effects": {
    "motion": {"bounds": {"min": [-1, -2.5, -1e+300], "max": [1, 2, 3]}},
    "terrain": {"up": "z"},
    "pairs": {},
    "response": {"restitution": 0.9},
    "sweep": {"mode": "line", "fastFrom": 0.25},
    "sleeping": {"interestRadius": 100, "slowBelow": 0.125, "framesBeforeSleep": 31},
    "rotation": {},
    "friction": {},
    "picking": {},
    "boxSelection": {},
    "culling": {"margin": 2, "restingCameraFrames": 3},
    "proximity": {"radius": "none", "colourCount": 32, "interestRadius": 50, "farFrames": 4,
                  "turns": 8},
    "zones": {"interestRadius": 60, "farFrames": 5},
    "radar": {"cellSize": 0.5, "columns": 16, "rows": 8, "groupCount": 2, "frames": 6, "up": "x"}
  },
  "grid": {"cellSize": 3, "levelRatio": 8, "updatesBeforeRest": 1, "slack": 0.25}
}
)";

/// As it is written: an element a line, numbers as they are spelled there.
std::string written(const std::string& text) {
    return nlohmann::ordered_json::parse(text).dump(2) + '\n';
}

TEST(EffectsFile, OfEveryFieldIsReadAndWrittenAsItIs) {
    const std::string text = effectsFileText(parse(kEveryField));
    EXPECT_EQ(text, written(kEveryField));

    // Would a field be missing, or be as it is by default, the above might hold by chance.
    for (const EffectsField& field : effectsFields()) {
        EXPECT_NE(text.find('"' + std::string(field.name) + '"'), std::string::npos);
    }
    EffectsFile defaults = withAllEffects();
    defaults.title = defaults.schema = "default";
    std::istringstream given(text);
    std::istringstream byDefault(effectsFileText(defaults));
    for (std::string line, other; std::getline(given, line);) {
        ASSERT_TRUE(std::getline(byDefault, other));
        const bool isValue = line.find_last_of("{}[]") == std::string::npos;
        EXPECT_EQ(line == other, !isValue) << line;
    }
}

// Each field is that of the member of its name, and no other's.
TEST(EffectsFile, HasTheSceneInItsMembers) {
    EffectsFile file = withAllEffects();
    file.title = "\"Ωmega\", a test";
    file.schema = "scene.schema.json";
    file.scene = {.objects = 4000,
                  .radius = 0.1,
                  .domain = 123.5,
                  .terrain = 64,
                  .speed = 7,
                  .moving = 0.5,
                  .fast = 0.01,
                  .fastSpeed = 555,
                  .seed = 4294967295,
                  .zones = 20,
                  .frames = 60,
                  .timeStep = 0.01};
    SceneEffects& effects = file.effects;
    effects.grid.cellSize = 3;
    effects.grid.levelRatio = 8;
    effects.grid.updatesBeforeRest = 1;
    effects.grid.slack = 0.25;
    effects.motion->bounds = {Vector3<double>(-1, -2.5, -1e300), Vector3<double>(1, 2, 3)};
    effects.terrain->up = UpAxis::z;
    effects.response->restitution = 0.9;
    effects.sweep = {.mode = Sweep::line, .fastFrom = 0.25};
    effects.sleeping = {.interestRadius = 100, .slowBelow = 0.125, .framesBeforeSleep = 31};
    effects.culling = {.margin = 2, .restingCameraFrames = 3};
    effects.proximity = {
        .radius = kInfinity, .colourCount = 32, .interestRadius = 50, .farFrames = 4, .turns = 8};
    effects.zones = {.interestRadius = 60, .farFrames = 5};
    effects.radar = {
        .cellSize = 0.5, .columns = 16, .rows = 8, .groupCount = 2, .frames = 6, .up = UpAxis::x};
    EXPECT_EQ(effectsFileText(file), written(kEveryField));
}

TEST(EffectsFile, LeavesWhatIsNotGivenAsItIsByDefault) {
    EXPECT_EQ(effectsFileText(parse("{}")), effectsFileText(EffectsFile{}));
    EXPECT_EQ(effectsFileText(parse(R"({"scene": {}, "effects": {}, "grid": {}})")),
              effectsFileText(EffectsFile{}));
    EXPECT_EQ(parse(R"({"scene": {"objects": 7}})").scene.radius, EffectsScene{}.radius);
}

TEST(EffectsFile, DeclaresAnEffectByTrueOrByAnObject) {
    const SceneEffects effects =
        parse(R"({"effects": {"motion": true, "pairs": {}, "zones": false}})").effects;
    EXPECT_EQ(effects.set(), (EffectSet{Effect::motion, Effect::pairs}));
}

TEST(EffectsFile, MayLeaveASideOfTheBoundsOpen) {
    const Aabb<double> bounds =
        parse(R"({"effects": {"motion": {"bounds": {"min": [0, "none", 2]}}}})")
            .effects.motion->bounds;
    EXPECT_EQ(bounds.min(), Vector3<double>(0, -kInfinity, 2));
    EXPECT_EQ(bounds.max(), Vector3<double>::Constant(kInfinity));
}

TEST(EffectsFile, TakesAWholeNumberHoweverItIsSpelled) {
    EXPECT_EQ(parse(R"({"scene": {"objects": 1.0e3}})").scene.objects, 1000U);
}

TEST(EffectsFile, OfTheExamplesIsReadAndWritten) {
    for (const char* name : {"paper", "projectiles", "lookers", "budget"}) {
        SCOPED_TRACE(name);
        const EffectsFile file =
            readEffectsFile(std::string(HASHPHASE_SCENE_EXAMPLES "/") + name + ".json");
        EXPECT_EQ(effectsError(file.effects), "");
        EXPECT_FALSE(file.effects.set().isEmpty());
        EXPECT_EQ(effectsFileText(parse(effectsFileText(file))), effectsFileText(file));
    }
}

TEST(EffectsFile, HasAFieldForEveryEffect) {
    EffectSet effects;
    for (const EffectsField& field : effectsFields()) {
        const auto* object = std::get_if<ObjectField>(&field.kind);
        if (object != nullptr && object->effect) {
            EXPECT_EQ(field.name, nameOf(*object->effect));
            EXPECT_EQ(field.section, "effects");
            effects.insert(*object->effect);
        }
    }
    EXPECT_EQ(effects, EffectSet::all());
}

TEST(EffectsFile, HasTheRangesThatADeclarationHas) {
    for (const EffectsField& field : effectsFields()) {
        const auto* number = std::get_if<NumberField>(&field.kind);
        if (field.section == "scene" || number == nullptr) {
            continue;
        }
        SCOPED_TRACE(pathOf(field.section, field.name));
        const auto isAllowed = [number](double value) {
            EffectsFile file = withAllEffects();
            number->access.set(file, value);
            return effectsError(file.effects).empty();
        };
        const auto beside = [number](double value, double step) {
            return number->isWhole ? value + step : std::nextafter(value, step * kInfinity);
        };
        EXPECT_TRUE(isAllowed(number->least));
        EXPECT_TRUE(number->isWhole || isAllowed(number->most));
        EXPECT_FALSE(isAllowed(beside(number->least, -1)));
        EXPECT_EQ(isAllowed(beside(number->most, 1)), number->most == kInfinity);
    }
}

// Each byte in turn is left out, or becomes another: what comes of it is read, or refused in a sentence.
TEST(EffectsFile, WithAnyByteDamagedIsReadOrRefused) {
    for (std::size_t place = 0; place < kEveryField.size(); ++place) {
        for (const std::string with : {"", "\xff", "}", "\"", "9"}) {
            std::string text = kEveryField;
            text.replace(place, 1, with);
            try {
                const std::string again = effectsFileText(parse(text));
                EXPECT_EQ(effectsFileText(parse(again)), again);
            } catch (const InputError& error) {
                const std::string sentence = error.what();
                EXPECT_EQ(sentence.rfind("scene.json:", 0), 0U) << sentence;
                EXPECT_TRUE(sentence.back() == '.' || sentence.back() == '?') << sentence;
                EXPECT_LT(sentence.size(), 300U) << sentence;
            }
        }
    }
}

TEST(EffectsFile, CutShortIsRefused) {
    for (std::size_t length = 0; length + 2 < kEveryField.size(); ++length) {
        EXPECT_THROW(static_cast<void>(parse(kEveryField.substr(0, length))), InputError) << length;
    }
}

TEST(EffectsFile, HasItsPathInFrontOfTheFault) {
    const TemporaryFolder folder;
    const std::string path = folder.write("wrong.json", "{\n\"scene\": 1}");
    EXPECT_EQ(messageOf<InputError>([&] { return readEffectsFile(path); }),
              path + ":2: scene is 1, but must be an object.");
}

}  // namespace
}  // namespace hashphase::demos
