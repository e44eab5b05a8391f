// SPDX-License-Identifier: Zlib
//
// What can be seen, as numbers by name.

#include <demos/viewer/session/session.hpp>

#include <demos/console/nearest_name.hpp>
#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <numeric>
#include <set>

namespace hashphase::demos {
namespace {

const InfoCard& cardOf(const Session& session) {
    if (!session.card()) {
        throw InputError("Nobody is picked.");
    }
    return *session.card();
}

const PairCheck& checkOf(const Session& session) {
    const PairCheck* check = session.check();
    if (check == nullptr && session.canCheck()) {
        throw InputError("Pairs are verified after the next frame: run \"step\".");
    }
    if (check == nullptr) {
        throw InputError(
            "Pairs are not verified: run \"check on\" and a step, with pairs and without sweep.");
    }
    return *check;
}

const CellLoads& loadsOf(const Session& session) {
    if (session.loads().isEmpty()) {
        throw InputError(
            "Loads are not counted: run \"overlay heat on\" and a step, with an effect that asks "
            "the grid.");
    }
    return session.loads();
}

template <class Holds>
double countBodies(const Session& session, const Holds& holds) {
    const std::uint32_t limit = session.stage().indexLimit();
    double count = 0;
    for (std::uint32_t index = 0; index < limit; ++index) {
        const StageBody body = session.stage().body(index);
        count += body.shape != StageBody::Shape::none && holds(body) ? 1 : 0;
    }
    return count;
}

double colourCount(const Session& session) {
    const SceneEffects& effects = session.stage().effects();
    if (!effects.proximity) {
        throw InputError("Agents have no colours: run \"effect proximity on\".");
    }
    const auto colours = session.stage().observers().colours();
    return static_cast<double>(std::set<std::uint32_t>(colours.begin(), colours.end()).size());
}

double cellSizeOf(const Session& session) {
    const Grid<float>* grid = session.stage().grid();
    return grid != nullptr ? double{grid->cellSize()} : 0.0;
}

struct Reading {
    std::string_view name;
    double (*read)(const Session&);
};

template <class Number>
double number(Number value) {
    return static_cast<double>(value);
}

double inZones(const Session& session) {
    if (!session.stage().effects().zones) {
        throw InputError("No zones are declared: run \"effect zones on\" and a step.");
    }
    std::size_t count = 0;
    for (const InterestZone& zone : session.stage().interestZones()) {
        count += zone.bodyCount;
    }
    return number(count);
}

double onRadar(const Session& session) {
    const std::optional<RadarView>& radar = session.stage().radar();
    if (!radar) {
        throw InputError("The radar has not looked: run \"effect radar on\" and a step.");
    }
    return number(std::accumulate(radar->counts.begin(), radar->counts.end(), std::uint64_t{0}));
}

constexpr std::array kReadings{
    Reading{"frame", [](const Session& s) { return number(s.frame()); }},
    Reading{"playing", [](const Session& s) { return number(s.isPlaying()); }},
    Reading{"bodies", [](const Session& s) { return number(s.stage().size()); }},
    Reading{"visible", [](const Session& s) { return number(s.visibleCount()); }},
    Reading{"frozen", [](const Session& s) { return number(s.frozenPose().has_value()); }},
    Reading{"selected", [](const Session& s) { return number(s.selected().size()); }},
    Reading{"recoloured", [](const Session& s) { return number(s.recoloured().size()); }},
    Reading{"picked", [](const Session& s) { return s.card() ? number(s.card()->index) : -1.0; }},
    Reading{"load", [](const Session& s) { return number(cardOf(s).load); }},
    Reading{"neighbours", [](const Session& s) { return number(cardOf(s).neighbours); }},
    Reading{"candidates", [](const Session& s) { return number(cardOf(s).candidates); }},
    Reading{"x", [](const Session& s) { return number(cardOf(s).body.centre.x()); }},
    Reading{"y", [](const Session& s) { return number(cardOf(s).body.centre.y()); }},
    Reading{"z", [](const Session& s) { return number(cardOf(s).body.centre.z()); }},
    Reading{"speed", [](const Session& s) { return number(cardOf(s).body.speed); }},
    Reading{"pairs", [](const Session& s) { return number(s.stage().pairCount()); }},
    Reading{"exact", [](const Session& s) { return number(checkOf(s).exactCount()); }},
    Reading{"missing", [](const Session& s) { return number(checkOf(s).missing().size()); }},
    Reading{"extra", [](const Session& s) { return number(checkOf(s).extra().size()); }},
    Reading{"cellSize", cellSizeOf},
    Reading{"largestLoad", [](const Session& s) { return number(loadsOf(s).largest()); }},
    Reading{"columns", [](const Session& s) { return number(loadsOf(s).columns()); }},
    Reading{"colours", colourCount},
    Reading{"inZones", inZones},  // a body in two of them counts twice
    Reading{"onRadar", onRadar},
    Reading{"tunnelled", [](const Session& s) { return number(s.stage().tunnelMarks().size()); }},
    Reading{"asleep",
            [](const Session& s) {
                return countBodies(s, [](const StageBody& body) { return body.isAsleep; });
            }},
    Reading{"moving",
            [](const Session& s) {
                return countBodies(s, [](const StageBody& body) { return body.speed > 0; });
            }},
    Reading{"memory", [](const Session& s) { return number(s.stage().memoryBytes()); }},
    Reading{"phases", [](const Session& s) { return number(s.stage().times().size()); }},
    Reading{"zones", [](const Session& s) { return number(s.stage().zones().size()); }},
    Reading{"milliseconds", [](const Session& s) { return s.history().medianTotal(); }},
    Reading{"p95", [](const Session& s) { return s.history().p95Total(); }},
    Reading{"eyeX", [](const Session& s) { return number(s.pose().eye.x()); }},
    Reading{"eyeY", [](const Session& s) { return number(s.pose().eye.y()); }},
    Reading{"eyeZ", [](const Session& s) { return number(s.pose().eye.z()); }},
    Reading{"dragging", [](const Session& s) { return number(s.rectangle().has_value()); }},
    Reading{"dots", [](const Session& s) { return number(s.options().dots); }},
    Reading{"dark", [](const Session& s) { return number(s.options().theme == Theme::dark); }},
    Reading{"panel", [](const Session& s) { return number(s.options().panel); }},
    Reading{"help", [](const Session& s) { return number(s.options().help); }},
    Reading{"width", [](const Session& s) { return number(s.width()); }},
    Reading{"height", [](const Session& s) { return number(s.height()); }},
    // So much of it as a double holds.
    Reading{"hash", [](const Session& s) { return number(s.hash() >> 12); }},
};

constexpr auto kNames = [] {
    std::array<std::string_view, kReadings.size()> names;
    std::transform(kReadings.begin(), kReadings.end(), names.begin(),
                   [](const Reading& reading) { return reading.name; });
    return names;
}();

}  // namespace

std::span<const std::string_view> Session::readingNames() {
    return kNames;
}

double Session::reading(std::string_view name) const {
    for (const Reading& reading : kReadings) {
        if (reading.name == name) {
            return reading.read(*this);
        }
    }
    const std::vector<std::string> names(kNames.begin(), kNames.end());
    throw InputError(unknownNameSentence("reading", name, names));
}

}  // namespace hashphase::demos
