// SPDX-License-Identifier: Zlib
#include <demos/scenes/effects_fields.hpp>

#include <broadphase/radius_search.hpp>
#include <integration/ai/radar.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <type_traits>

namespace hashphase::demos {
namespace {

constexpr std::uint32_t kMostWhole = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kMostFrames = kMostEffectFrames;
constexpr std::uint32_t kMostCounts = static_cast<std::uint32_t>(Radar<float>::kMostCounts);
constexpr double kInfinite = NumberField::kInfinite;

constexpr std::array kSweeps{
    NamedValue{"automatic", static_cast<std::uint8_t>(Sweep::automatic)},
    NamedValue{"box", static_cast<std::uint8_t>(Sweep::box)},
    NamedValue{"line", static_cast<std::uint8_t>(Sweep::line)},
};
constexpr std::array kUpAxes{
    NamedValue{"x", static_cast<std::uint8_t>(UpAxis::x)},
    NamedValue{"y", static_cast<std::uint8_t>(UpAxis::y)},
    NamedValue{"z", static_cast<std::uint8_t>(UpAxis::z)},
};

template <auto Member>
auto& fileField(EffectsFile& file) {
    return file.*Member;
}
template <auto Member>
auto& sceneField(EffectsFile& file) {
    return file.scene.*Member;
}
template <auto Member>
auto& gridField(EffectsFile& file) {
    return file.effects.grid.*Member;
}
template <auto Declared, auto Member>
auto& setting(EffectsFile& file) {
    return *(file.effects.*Declared).*Member;
}
template <auto Declared, auto Member>
constexpr ChoiceField choice(std::span<const NamedValue> choices) {
    return {choices,
            [](EffectsFile& file) {
                return static_cast<std::uint8_t>(setting<Declared, Member>(file));
            },
            [](EffectsFile& file, std::uint8_t value) {
                auto& enumerator = setting<Declared, Member>(file);
                enumerator = static_cast<std::remove_reference_t<decltype(enumerator)>>(value);
            }};
}

constexpr CornerField kLowerCorner{-kInfinite, [](EffectsFile& file) -> Vector3<double>& {
                                       return file.effects.motion->bounds.min();
                                   }};
constexpr CornerField kUpperCorner{kInfinite, [](EffectsFile& file) -> Vector3<double>& {
                                       return file.effects.motion->bounds.max();
                                   }};

constexpr std::array kFields{
    EffectsField{"", "$schema", "where an editor finds the schema of this file", "",
                 TextField{fileField<&EffectsFile::schema>}},
    EffectsField{"", "title", "what the scene shows", "",
                 TextField{fileField<&EffectsFile::title>}},
    EffectsField{"", "scene",
                 "who is there, where, and for how long: spheres on a square, and zones", "",
                 SectionField{}},
    EffectsField{"scene", "objects", "bodies", "",
                 WholeField{1, 10'000'000, sceneField<&EffectsScene::objects>}},
    EffectsField{"scene", "radius", "of every body", "m",
                 NumberField{0.001, 1000, sceneField<&EffectsScene::radius>}},
    EffectsField{"scene", "domain", "side of the square, which begins at (0, 0)", "m",
                 NumberField{1, 1e6, sceneField<&EffectsScene::domain>}},
    EffectsField{"scene", "terrain",
                 "squares of ground along a side, of two triangles each; 0: no ground", "",
                 WholeField{0, 4096, sceneField<&EffectsScene::terrain>}},
    EffectsField{"scene", "speed", "of a body that moves, on average", "m/s",
                 NumberField{0, 1e5, sceneField<&EffectsScene::speed>}},
    EffectsField{"scene", "moving", "share of the bodies that move", "",
                 NumberField{0, 1, sceneField<&EffectsScene::moving>}},
    EffectsField{"scene", "fast", "share of the bodies that fly", "",
                 NumberField{0, 1, sceneField<&EffectsScene::fast>}},
    EffectsField{"scene", "fastSpeed", "of a body that flies", "m/s",
                 NumberField{0, 1e5, sceneField<&EffectsScene::fastSpeed>}},
    EffectsField{"scene", "seed", "the same seed gives the same scene", "",
                 WholeField{0, kMostWhole, sceneField<&EffectsScene::seed>}},
    EffectsField{"scene", "zones", "zones of interest", "",
                 WholeField{0, 100'000, sceneField<&EffectsScene::zones>}},
    EffectsField{"scene", "frames", "how many are run", "",
                 WholeField{1, kMostFrames, sceneField<&EffectsScene::frames>}},
    EffectsField{"scene", "timeStep", "of a frame", "s",
                 NumberField{1e-4, 1, sceneField<&EffectsScene::timeStep>}},
    EffectsField{"", "effects", "what the scene calls for", "", SectionField{}},
    EffectsField{"effects", "motion", "bodies go on with their velocities", "",
                 EffectField{Effect::motion}},
    EffectsField{"effects.motion", "bounds",
                 "who would leave this box with its centre turns back at its face", "",
                 SectionField{}},
    EffectsField{"effects.motion.bounds", "min", "lower corner of the box; none: open on that side",
                 "m", kLowerCorner},
    EffectsField{"effects.motion.bounds", "max", "upper corner of the box; none: open on that side",
                 "m", kUpperCorner},
    EffectsField{"effects", "terrain", "bodies that have moved are put on the ground; needs motion",
                 "", EffectField{Effect::terrain}},
    EffectsField{"effects.terrain", "up", "the axis that points upwards", "",
                 choice<&SceneEffects::terrain, &TerrainEffect::up>(kUpAxes)},
    EffectsField{"effects", "pairs", "whose boxes overlap: births and deaths", "",
                 EffectField{Effect::pairs}},
    EffectsField{"effects", "response", "bodies that touch bounce off; needs pairs and motion", "",
                 EffectField{Effect::response}},
    EffectsField{"effects.response", "restitution", "0: they stay together, 1: nothing is lost", "",
                 NumberField{0, 1, setting<&SceneEffects::response, &ResponseEffect::restitution>}},
    EffectsField{"effects", "sweep", "fast bodies meet what they pass; needs pairs and motion", "",
                 EffectField{Effect::sweep}},
    EffectsField{"effects.sweep", "mode", "where to look for what a body passes", "",
                 choice<&SceneEffects::sweep, &SweepEffect::mode>(kSweeps)},
    EffectsField{"effects.sweep", "fastFrom", "way in a frame from which a body is fast",
                 "diameters",
                 NumberField{0, kInfinite, setting<&SceneEffects::sweep, &SweepEffect::fastFrom>}},
    EffectsField{"effects", "sleeping", "bodies that need not move do not; needs motion", "",
                 EffectField{Effect::sleeping}},
    EffectsField{"effects.sleeping", "interestRadius", "asleep beyond it", "m",
                 NumberField{0, kInfinite,
                             setting<&SceneEffects::sleeping, &SleepingEffect::interestRadius>}},
    EffectsField{
        "effects.sleeping", "slowBelow", "asleep after some frames below this speed", "m/s",
        NumberField{0, kInfinite, setting<&SceneEffects::sleeping, &SleepingEffect::slowBelow>}},
    EffectsField{"effects.sleeping", "framesBeforeSleep", "so many", "",
                 WholeField{1, kMostFrames,
                            setting<&SceneEffects::sleeping, &SleepingEffect::framesBeforeSleep>}},
    EffectsField{"effects", "rotation", "bodies turn, under Bullet; needs motion", "",
                 EffectField{Effect::rotation}},
    EffectsField{"effects", "friction", "bodies that touch rub, under Bullet; needs response", "",
                 EffectField{Effect::friction}},
    EffectsField{"effects", "picking", "what is under the pointer", "",
                 EffectField{Effect::picking}},
    EffectsField{"effects", "boxSelection", "what is in a rectangle that is dragged", "",
                 EffectField{Effect::boxSelection}},
    EffectsField{"effects", "culling", "what a camera sees", "", EffectField{Effect::culling}},
    EffectsField{
        "effects.culling", "margin", "the set is kept while it is known to have all that is seen",
        "m",
        NumberField{0, kMostEffectLength, setting<&SceneEffects::culling, &CullingEffect::margin>}},
    EffectsField{"effects.culling", "restingCameraFrames",
                 "while the camera rests, the set is found in every n-th frame", "",
                 WholeField{1, kMostFrames,
                            setting<&SceneEffects::culling, &CullingEffect::restingCameraFrames>}},
    EffectsField{"effects", "proximity", "agents look at who is near", "",
                 EffectField{Effect::proximity}},
    EffectsField{
        "effects.proximity", "radius", "how far they look", "m",
        NumberField{0, kInfinite, setting<&SceneEffects::proximity, &ProximityEffect::radius>}},
    EffectsField{"effects.proximity", "colourCount", "colours of agents", "",
                 WholeField{1, RadiusSearch<float>::kMostGroups,
                            setting<&SceneEffects::proximity, &ProximityEffect::colourCount>}},
    EffectsField{"effects.proximity", "interestRadius", "agents beyond it are far", "m",
                 NumberField{0, kInfinite,
                             setting<&SceneEffects::proximity, &ProximityEffect::interestRadius>}},
    EffectsField{
        "effects.proximity", "farFrames", "far agents look around in every n-th frame", "",
        WholeField{1, kMostFrames, setting<&SceneEffects::proximity, &ProximityEffect::farFrames>}},
    EffectsField{
        "effects.proximity", "turns", "agents look around by turns, each in every n-th frame", "",
        WholeField{1, kMostFrames, setting<&SceneEffects::proximity, &ProximityEffect::turns>}},
    EffectsField{"effects", "zones", "who is in which zone of interest", "",
                 EffectField{Effect::zones}},
    EffectsField{
        "effects.zones", "interestRadius", "zones beyond it are far", "m",
        NumberField{0, kInfinite, setting<&SceneEffects::zones, &ZonesEffect::interestRadius>}},
    EffectsField{
        "effects.zones", "farFrames", "who is in far zones is found in every n-th frame", "",
        WholeField{1, kMostFrames, setting<&SceneEffects::zones, &ZonesEffect::farFrames>}},
    EffectsField{"effects", "radar", "counts by coarse cells", "", EffectField{Effect::radar}},
    EffectsField{"effects.radar", "cellSize", "edge of a cell", "m",
                 NumberField{kLeastEffectLength, kMostEffectLength,
                             setting<&SceneEffects::radar, &RadarEffect::cellSize>}},
    EffectsField{"effects.radar", "columns", "across; columns * rows * groupCount is limited, too",
                 "",
                 WholeField{1, kMostCounts, setting<&SceneEffects::radar, &RadarEffect::columns>}},
    EffectsField{"effects.radar", "rows", "down", "",
                 WholeField{1, kMostCounts, setting<&SceneEffects::radar, &RadarEffect::rows>}},
    EffectsField{
        "effects.radar", "groupCount", "groups that are counted apart", "",
        WholeField{1, kMostCounts, setting<&SceneEffects::radar, &RadarEffect::groupCount>}},
    EffectsField{"effects.radar", "frames", "scanned in every n-th frame", "",
                 WholeField{1, kMostFrames, setting<&SceneEffects::radar, &RadarEffect::frames>}},
    EffectsField{"effects.radar", "up", "the axis that points upwards", "",
                 choice<&SceneEffects::radar, &RadarEffect::up>(kUpAxes)},
    EffectsField{"", "grid", "of the grid, which exists when an effect asks it", "",
                 SectionField{}},
    EffectsField{"grid", "cellSize",
                 "edge of the finest cells, from 1e-30; 0: chosen from the bodies' sizes", "m",
                 NumberField{0, 1e30, gridField<&GridConfig::cellSize>}},
    EffectsField{"grid", "levelRatio",
                 "with a fixed cell size, each coarser level's cells are so many times larger", "",
                 NumberField{2, 64, gridField<&GridConfig::levelRatio>}},
    EffectsField{"grid", "updatesBeforeRest", "after so many updates without a change a body rests",
                 "", WholeField{1, kMostFrames, gridField<&GridConfig::updatesBeforeRest>}},
};

std::string textOf(double number) {
    constexpr double kMostDigits = 1e15;
    if (std::abs(number) < kMostDigits && number == std::trunc(number)) {
        return std::to_string(static_cast<std::int64_t>(number));
    }
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

std::string requirementOf(const NumberField& field) {
    const std::string bound = textOf(field.least);
    return field.most < kInfinite ? "a number from " + bound + " to " + textOf(field.most)
                                  : "a number, " + bound + " or more, or 'none'";
}

std::string requirementOf(const ChoiceField& field) {
    std::string names;
    for (const NamedValue& choice : field.choices) {
        const bool isLast = &choice == &field.choices.back();
        names += names.empty() ? "" : isLast ? " or " : ", ";
        names += "'" + std::string(choice.name) + "'";
    }
    return names;
}

}  // namespace

std::span<const EffectsField> effectsFields() {
    return kFields;
}

std::string pathOf(std::string_view section, std::string_view name) {
    std::string path(section);
    path += section.empty() ? "" : ".";
    return path += name;
}

std::string requirementOf(const EffectsField& field) {
    std::string requirement = "an object";
    if (std::holds_alternative<EffectField>(field.kind)) {
        requirement = "true, false or an object of settings";
    } else if (std::holds_alternative<TextField>(field.kind)) {
        requirement = "a text";
    } else if (const auto* whole = std::get_if<WholeField>(&field.kind)) {
        requirement = "a whole number from " + std::to_string(whole->least) + " to " +
                      std::to_string(whole->most);
    } else if (const auto* number = std::get_if<NumberField>(&field.kind)) {
        requirement = requirementOf(*number);
    } else if (const auto* choice = std::get_if<ChoiceField>(&field.kind)) {
        requirement = requirementOf(*choice);
    } else if (std::holds_alternative<CornerField>(field.kind)) {
        requirement = "an array of three numbers, each of which may be 'none'";
    }
    return field.unit.empty() ? requirement : requirement + " [" + std::string(field.unit) + "]";
}

}  // namespace hashphase::demos
