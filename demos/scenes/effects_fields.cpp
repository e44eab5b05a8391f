// SPDX-License-Identifier: Zlib
#include <demos/scenes/effects_fields.hpp>

#include <demos/console/format.hpp>

#include <broadphase/radius_search.hpp>
#include <integration/ai/radar.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <vector>

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

/// The part of the file of that class.
template <class Part>
Part& partOf(EffectsFile& file) {
    [[maybe_unused]] SceneEffects& effects = file.effects;
    if constexpr (std::is_same_v<Part, EffectsFile>) {
        return file;
    } else if constexpr (std::is_same_v<Part, EffectsScene>) {
        return file.scene;
    } else if constexpr (std::is_same_v<Part, GridConfig>) {
        return effects.grid;
    } else {
        return *std::get<std::optional<Part>&>(std::tie(
            effects.motion, effects.terrain, effects.response, effects.sweep, effects.sleeping,
            effects.culling, effects.proximity, effects.zones, effects.radar));
    }
}

template <class Part, class Value>
Part partOfMember(Value Part::*);

template <auto Member>
auto& place(EffectsFile& file) {
    return partOf<decltype(partOfMember(Member))>(file).*Member;
}

template <auto Member>
constexpr Access kAccess{[](EffectsFile& file) { return static_cast<double>(place<Member>(file)); },
                         [](EffectsFile& file, double value) {
                             auto& member = place<Member>(file);
                             member = static_cast<std::remove_reference_t<decltype(member)>>(value);
                         }};

// Empty, and without a bound in a file: the grid follows the motion.
constexpr Access kSlack{
    [](EffectsFile& file) { return file.effects.grid.slack.value_or(NumberField::kInfinite); },
    [](EffectsFile& file, double value) {
        file.effects.grid.slack =
            value < NumberField::kInfinite ? std::optional(value) : std::nullopt;
    }};

template <auto Member>
constexpr NumberField number(double least, double most) {
    return {least, most, kAccess<Member>};
}
template <auto Member>
constexpr NumberField whole(std::uint32_t least, std::uint32_t most) {
    return {static_cast<double>(least), static_cast<double>(most), kAccess<Member>, true};
}
template <auto Member>
constexpr ChoiceField choice(std::span<const NamedValue> choices) {
    return {choices, kAccess<Member>};
}

constexpr CornerField kLowerCorner{-kInfinite, [](EffectsFile& file) -> Vector3<double>& {
                                       return file.effects.motion->bounds.min();
                                   }};
constexpr CornerField kUpperCorner{kInfinite, [](EffectsFile& file) -> Vector3<double>& {
                                       return file.effects.motion->bounds.max();
                                   }};

EffectsField ofEffect(Effect effect, std::string_view meaning) {
    return {"effects", nameOf(effect), meaning, "", ObjectField{effect}};
}

const std::vector<EffectsField>& allFields() {
    static const std::vector<EffectsField> fields{
        {"", "$schema", "where an editor finds the schema of this file", "",
         TextField{place<&EffectsFile::schema>}},
        {"", "title", "what the scene shows", "", TextField{place<&EffectsFile::title>}},
        {"", "scene", "who is there, where, and for how long: spheres on a square, and zones", "",
         ObjectField{}},
        {"scene", "objects", "bodies", "", whole<&EffectsScene::objects>(1, 10'000'000)},
        {"scene", "radius", "of every body", "m", number<&EffectsScene::radius>(0.001, 1000)},
        {"scene", "domain", "side of the square, which begins at (0, 0)", "m",
         number<&EffectsScene::domain>(1, 1e6)},
        {"scene", "terrain", "squares of ground along a side, of two triangles each; 0: no ground",
         "", whole<&EffectsScene::terrain>(0, 4096)},
        {"scene", "speed", "of a body that moves, on average", "m/s",
         number<&EffectsScene::speed>(0, 1e5)},
        {"scene", "moving", "share of the bodies that move", "",
         number<&EffectsScene::moving>(0, 1)},
        {"scene", "fast", "share of the bodies that fly", "", number<&EffectsScene::fast>(0, 1)},
        {"scene", "fastSpeed", "of a body that flies", "m/s",
         number<&EffectsScene::fastSpeed>(0, 1e5)},
        {"scene", "seed", "the same seed gives the same scene", "",
         whole<&EffectsScene::seed>(0, kMostWhole)},
        {"scene", "zones", "zones of interest", "", whole<&EffectsScene::zones>(0, 100'000)},
        {"scene", "frames", "how many are run", "", whole<&EffectsScene::frames>(1, kMostFrames)},
        {"scene", "timeStep", "of a frame", "s", number<&EffectsScene::timeStep>(1e-4, 1)},
        {"", "effects", "what the scene calls for", "", ObjectField{}},
        ofEffect(Effect::motion, "bodies go on with their velocities"),
        {"effects.motion", "bounds",
         "who would leave this box with its centre turns back at its face", "", ObjectField{}},
        {"effects.motion.bounds", "min", "lower corner of the box; none: open on that side", "m",
         kLowerCorner},
        {"effects.motion.bounds", "max", "upper corner of the box; none: open on that side", "m",
         kUpperCorner},
        ofEffect(Effect::terrain, "bodies that have moved are put on the ground; needs motion"),
        {"effects.terrain", "up", "the axis that points upwards", "",
         choice<&TerrainEffect::up>(kUpAxes)},
        ofEffect(Effect::pairs, "whose boxes overlap: births and deaths"),
        ofEffect(Effect::response, "bodies that touch bounce off; needs pairs and motion"),
        {"effects.response", "restitution", "0: they stay together, 1: nothing is lost", "",
         number<&ResponseEffect::restitution>(0, 1)},
        ofEffect(Effect::sweep, "fast bodies meet what they pass; needs pairs and motion"),
        {"effects.sweep", "mode", "where to look for what a body passes", "",
         choice<&SweepEffect::mode>(kSweeps)},
        {"effects.sweep", "fastFrom", "way in a frame from which a body is fast", "diameters",
         number<&SweepEffect::fastFrom>(0, kInfinite)},
        ofEffect(Effect::sleeping, "bodies that need not move do not; needs motion"),
        {"effects.sleeping", "interestRadius", "asleep beyond it", "m",
         number<&SleepingEffect::interestRadius>(0, kInfinite)},
        {"effects.sleeping", "slowBelow", "asleep after some frames below this speed", "m/s",
         number<&SleepingEffect::slowBelow>(0, kInfinite)},
        {"effects.sleeping", "framesBeforeSleep", "so many", "",
         whole<&SleepingEffect::framesBeforeSleep>(1, kMostFrames)},
        ofEffect(Effect::rotation, "bodies turn, under Bullet; needs motion"),
        ofEffect(Effect::friction, "bodies that touch rub, under Bullet; needs response"),
        ofEffect(Effect::picking, "what is under the pointer"),
        ofEffect(Effect::boxSelection, "what is in a rectangle that is dragged"),
        ofEffect(Effect::culling, "what a camera sees"),
        {"effects.culling", "margin", "the set is kept while it is known to have all that is seen",
         "m", number<&CullingEffect::margin>(0, kMostEffectLength)},
        {"effects.culling", "restingCameraFrames",
         "while the camera rests, the set is found in every n-th frame", "",
         whole<&CullingEffect::restingCameraFrames>(1, kMostFrames)},
        ofEffect(Effect::proximity, "agents look at who is near"),
        {"effects.proximity", "radius", "how far they look", "m",
         number<&ProximityEffect::radius>(0, kInfinite)},
        {"effects.proximity", "colourCount", "colours of agents", "",
         whole<&ProximityEffect::colourCount>(1, RadiusSearch<float>::kMostGroups)},
        {"effects.proximity", "interestRadius", "agents beyond it are far", "m",
         number<&ProximityEffect::interestRadius>(0, kInfinite)},
        {"effects.proximity", "farFrames", "far agents look around in every n-th frame", "",
         whole<&ProximityEffect::farFrames>(1, kMostFrames)},
        {"effects.proximity", "turns", "agents look around by turns, each in every n-th frame", "",
         whole<&ProximityEffect::turns>(1, kMostFrames)},
        ofEffect(Effect::zones, "who is in which zone of interest"),
        {"effects.zones", "interestRadius", "zones beyond it are far", "m",
         number<&ZonesEffect::interestRadius>(0, kInfinite)},
        {"effects.zones", "farFrames", "who is in far zones is found in every n-th frame", "",
         whole<&ZonesEffect::farFrames>(1, kMostFrames)},
        ofEffect(Effect::radar, "counts by coarse cells"),
        {"effects.radar", "cellSize", "edge of a cell", "m",
         number<&RadarEffect::cellSize>(kLeastEffectLength, kMostEffectLength)},
        {"effects.radar", "columns", "across; columns * rows * groupCount is limited, too", "",
         whole<&RadarEffect::columns>(1, kMostCounts)},
        {"effects.radar", "rows", "down", "", whole<&RadarEffect::rows>(1, kMostCounts)},
        {"effects.radar", "groupCount", "groups that are counted apart", "",
         whole<&RadarEffect::groupCount>(1, kMostCounts)},
        {"effects.radar", "frames", "scanned in every n-th frame", "",
         whole<&RadarEffect::frames>(1, kMostFrames)},
        {"effects.radar", "up", "the axis that points upwards", "",
         choice<&RadarEffect::up>(kUpAxes)},
        {"", "grid", "of the grid, which exists when an effect asks it", "", ObjectField{}},
        {"grid", "cellSize",
         "edge of the finest cells, from 1e-30; 0: chosen from the bodies' sizes", "m",
         number<&GridConfig::cellSize>(0, 1e30)},
        {"grid", "levelRatio",
         "with a fixed cell size, each coarser level's cells are so many times larger", "",
         number<&GridConfig::levelRatio>(2, 64)},
        {"grid", "updatesBeforeRest", "after so many updates without a change a body rests", "",
         whole<&GridConfig::updatesBeforeRest>(1, kMostFrames)},
        {"grid", "slack",
         "how far a body moves before it is filed anew, to 1e30; 'none': as its motion asks for",
         "m", NumberField{0, kInfinite, kSlack}},
    };
    return fields;
}

std::string requirementOf(const NumberField& field) {
    if (field.most == kInfinite) {
        return "a number, " + numberText(field.least) + " or more, or 'none'";
    }
    return std::string(field.isWhole ? "a whole number" : "a number") + " from " +
           numberText(field.least) + " to " + numberText(field.most);
}

std::string requirementOf(const ChoiceField& field) {
    std::vector<std::string> names;
    for (const NamedValue& choice : field.choices) {
        names.push_back("'" + std::string(choice.name) + "'");
    }
    const std::string last = names.back();
    names.pop_back();
    return joined(names, ", ") + " or " + last;
}

}  // namespace

std::span<const EffectsField> effectsFields() {
    return allFields();
}

std::string pathOf(std::string_view section, std::string_view name) {
    std::string path(section);
    path += section.empty() ? "" : ".";
    return path += name;
}

std::string numberText(double number) {
    constexpr double kMostDigits = 1e15;
    if (std::abs(number) < kMostDigits && number == std::trunc(number)) {
        return std::to_string(static_cast<std::int64_t>(number));
    }
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

std::string requirementOf(const EffectsField& field) {
    std::string requirement;
    if (const auto* object = std::get_if<ObjectField>(&field.kind)) {
        requirement = object->effect ? "true, false or an object of settings" : "an object";
    } else if (std::holds_alternative<TextField>(field.kind)) {
        requirement = "a text";
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
