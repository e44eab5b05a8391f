// SPDX-License-Identifier: Zlib
//
// What can be seen, as numbers by name.

#include <demos/viewer/session/session.hpp>

#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <numeric>
#include <set>

namespace hashphase::demos {
namespace {

/// What is there, or else the fault that says why not.
template <class Thing>
const Thing& need(const Thing& thing, bool isThere, const char* fault) {
    if (!isThere) {
        throw InputError(fault);
    }
    return thing;
}

const InfoCard& cardOf(const Session& session) {
    return *need(session.card, session.card.has_value(), "No body is picked: run \"pick X Y\".");
}

const PairCheck& checkOf(const Session& session) {
    return need(session.pairCheck, session.check() != nullptr,
                session.canCheck() ? "Pairs are verified after the next frame: run \"step\"."
                                   : "Pairs are not verified: run \"check on\" and \"step\", with "
                                     "the effect pairs and without sweep.");
}

const CellLoads& loadsOf(const Session& session) {
    return need(session.loads, !session.loads.isEmpty(),
                "Loads are not counted: run \"overlay heat on\" and \"step\", with an effect that "
                "uses the grid.");
}

template <class Holds>
double countBodies(const Session& session, const Holds& holds) {
    double count = 0;
    for (std::uint32_t index = 0; index < session.stage->indexLimit(); ++index) {
        const StageBody body = session.stage->body(index);
        count += body.shape != StageBody::Shape::none && holds(body) ? 1 : 0;
    }
    return count;
}

std::size_t colourCount(const Session& session) {
    need(session, session.stage->effects().proximity.has_value(),
         "Agents have no colours: run \"effect proximity on\".");
    const auto colours = session.stage->observers().colours();
    return std::set<std::uint32_t>(colours.begin(), colours.end()).size();
}

// A body in two of them counts twice.
std::size_t countInZones(const Session& session) {
    need(session, session.stage->effects().zones.has_value(),
         "There are no zones: run \"effect zones on\" and \"step\".");
    std::size_t count = 0;
    for (const InterestZone& zone : session.stage->interestZones()) {
        count += zone.bodyCount;
    }
    return count;
}

std::uint64_t countOnRadar(const Session& session) {
    const std::optional<RadarView>& radar = session.stage->radar();
    need(radar, radar.has_value(), "The radar has no data: run \"effect radar on\" and \"step\".");
    return std::accumulate(radar->counts.begin(), radar->counts.end(), std::uint64_t{0});
}

std::int64_t memoryOf(const Session& session) {
    const std::optional<std::int64_t> bytes = session.stage->memoryBytes();
    return *need(bytes, bytes.has_value(), "The heap does not show the memory of this broadphase.");
}

const FormerTimes& formerOf(const Session& session) {
    return *need(session.former, session.former.has_value(),
                 "There are no times with another broadphase: run \"step\", and then \"broadphase "
                 "next\".");
}

using Seen = const Session&;

}  // namespace

std::span<const Reading> readings() {
    static const std::array kReadings{
        Reading{"frame", [](Seen s) { return s.frame; }},
        Reading{"playing", [](Seen s) { return s.isPlaying; }},
        Reading{"bodies", [](Seen s) { return s.stage->size(); }},
        Reading{"visible", [](Seen s) { return s.visibleCount(); }},
        Reading{"frozen", [](Seen s) { return s.frozen.has_value(); }},
        Reading{"selected", [](Seen s) { return s.selected.size(); }},
        Reading{"recoloured", [](Seen s) { return s.recoloured.size(); }},
        Reading{"picked", [](Seen s) { return s.card ? static_cast<double>(s.card->index) : -1; }},
        Reading{"load", [](Seen s) { return cardOf(s).load; }},
        Reading{"neighbours", [](Seen s) { return cardOf(s).neighbours; }},
        Reading{"candidates", [](Seen s) { return cardOf(s).candidates; }},
        Reading{"x", [](Seen s) { return cardOf(s).body.centre.x(); }},
        Reading{"y", [](Seen s) { return cardOf(s).body.centre.y(); }},
        Reading{"z", [](Seen s) { return cardOf(s).body.centre.z(); }},
        Reading{"speed", [](Seen s) { return cardOf(s).body.speed; }},
        Reading{"pairs", [](Seen s) { return s.stage->pairCount(); }},
        Reading{"exact", [](Seen s) { return checkOf(s).exact.size(); }},
        Reading{"missing", [](Seen s) { return checkOf(s).missing.size(); }},
        Reading{"extra", [](Seen s) { return checkOf(s).extra.size(); }},
        Reading{
            "cellSize",
            [](Seen s) { return s.stage->grid() != nullptr ? s.stage->grid()->cellSize() : 0; }},
        Reading{"largestLoad", [](Seen s) { return loadsOf(s).largest; }},
        Reading{"columns", [](Seen s) { return loadsOf(s).columns; }},
        Reading{"colours", colourCount},
        Reading{"inZones", countInZones},
        Reading{"onRadar", countOnRadar},
        Reading{"tunnelled", [](Seen s) { return s.stage->tunnelCount(); }},
        Reading{"asleep",
                [](Seen s) {
                    return countBodies(s, [](const StageBody& body) { return body.isAsleep; });
                }},
        Reading{"moving",
                [](Seen s) {
                    return countBodies(s, [](const StageBody& body) { return body.speed > 0; });
                }},
        Reading{"memory", memoryOf},
        Reading{"phases", [](Seen s) { return s.stage->times().size(); }},
        Reading{"zones", [](Seen s) { return s.stage->zones().size(); }},
        Reading{"milliseconds", [](Seen s) { return s.history.medianTotal(); }},
        Reading{"p95", [](Seen s) { return s.history.p95Total(); }},
        Reading{"worst", [](Seen s) { return s.history.worstTotal(); }},
        Reading{"millisecondsBefore", [](Seen s) { return formerOf(s).history.medianTotal(); }},
        Reading{"eyeX", [](Seen s) { return s.pose().eye.x(); }},
        Reading{"eyeY", [](Seen s) { return s.pose().eye.y(); }},
        Reading{"eyeZ", [](Seen s) { return s.pose().eye.z(); }},
        Reading{"dragging", [](Seen s) { return s.rectangle.has_value(); }},
        Reading{"dots", [](Seen s) { return s.options.dots; }},
        Reading{"dark", [](Seen s) { return s.options.theme == Theme::dark; }},
        Reading{"panel", [](Seen s) { return s.options.panel; }},
        Reading{"help", [](Seen s) { return s.options.help; }},
        Reading{"width", [](Seen s) { return s.width; }},
        Reading{"height", [](Seen s) { return s.height; }},
        // So much of it as a double holds.
        Reading{"hash", [](Seen s) { return s.hash() >> 12; }},
    };
    return kReadings;
}

double Session::reading(std::string_view name) const {
    return rowNamed("reading", name, readings()).read(*this);
}

}  // namespace hashphase::demos
