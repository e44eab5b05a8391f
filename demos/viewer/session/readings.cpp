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
        Reading{"frame", "number of simulated frames", [](Seen s) { return s.frame; }},
        Reading{"playing", "1 while the scene plays, else 0", [](Seen s) { return s.isPlaying; }},
        Reading{"bodies", "number of bodies", [](Seen s) { return s.stage->size(); }},
        Reading{"visible", "number of visible bodies; all, without the effect culling",
                [](Seen s) { return s.visibleCount(); }},
        Reading{"frozen", "1 while the frustum is frozen, else 0",
                [](Seen s) { return s.frozen.has_value(); }},
        Reading{"selected", "number of selected bodies", [](Seen s) { return s.selected.size(); }},
        Reading{"recoloured", "number of bodies that recolour has marked",
                [](Seen s) { return s.recoloured.size(); }},
        Reading{"picked", "index of the picked body; -1: none",
                [](Seen s) { return s.card ? static_cast<double>(s.card->index) : -1; }},
        Reading{"load", "number of bodies in the cell of the picked body",
                [](Seen s) { return cardOf(s).load; }},
        Reading{"neighbours",
                "number of other bodies within the radius of proximity (without it 5 m) around the "
                "picked body",
                [](Seen s) { return cardOf(s).neighbours; }},
        Reading{"candidates", "number of other bodies whose boxes touch the box of the picked body",
                [](Seen s) { return cardOf(s).candidates; }},
        Reading{"x", "x of the centre of the picked body [m]",
                [](Seen s) { return cardOf(s).body.centre.x(); }},
        Reading{"y", "y of the centre of the picked body [m]",
                [](Seen s) { return cardOf(s).body.centre.y(); }},
        Reading{"z", "z of the centre of the picked body [m]",
                [](Seen s) { return cardOf(s).body.centre.z(); }},
        Reading{"speed", "speed of the picked body [m/s]",
                [](Seen s) { return cardOf(s).body.speed; }},
        Reading{"pairs", "number of pairs that the broadphase has found",
                [](Seen s) { return s.stage->pairCount(); }},
        Reading{"exact", "number of exact pairs (needs check)",
                [](Seen s) { return checkOf(s).exact.size(); }},
        Reading{"missing", "number of exact pairs that the broadphase has not found (needs check)",
                [](Seen s) { return checkOf(s).missing.size(); }},
        Reading{"extra", "number of found pairs that do not overlap (needs check)",
                [](Seen s) { return checkOf(s).extra.size(); }},
        Reading{
            "cellSize", "cell size of the grid [m]; 0: no grid",
            [](Seen s) { return s.stage->grid() != nullptr ? s.stage->grid()->cellSize() : 0; }},
        Reading{"largestLoad",
                "number of bodies in the fullest column of cells (needs overlay heat)",
                [](Seen s) { return loadsOf(s).largest; }},
        Reading{"columns", "number of columns of cells along x (needs overlay heat)",
                [](Seen s) { return loadsOf(s).columns; }},
        Reading{"colours", "number of different colours of the agents", colourCount},
        Reading{"inZones",
                "number of bodies in zones of interest; a body in two zones counts twice",
                countInZones},
        Reading{"onRadar", "number of bodies that the radar counts", countOnRadar},
        Reading{"tunnelled", "number of times that a body has passed through a static box",
                [](Seen s) { return s.stage->tunnelCount(); }},
        Reading{"asleep", "number of sleeping bodies",
                [](Seen s) {
                    return countBodies(s, [](const StageBody& body) { return body.isAsleep; });
                }},
        Reading{"moving", "number of moving bodies",
                [](Seen s) {
                    return countBodies(s, [](const StageBody& body) { return body.speed > 0; });
                }},
        Reading{"memory", "memory of the broadphase and the grid [bytes]", memoryOf},
        Reading{"phases", "number of measured phases in the last frame",
                [](Seen s) { return s.stage->times().size(); }},
        Reading{"zones", "number of Bullet's profile zones in the last frame",
                [](Seen s) { return s.stage->zones().size(); }},
        Reading{"milliseconds", "median time of a frame, of up to 240 frames [ms]",
                [](Seen s) { return s.history.medianTotal(); }},
        Reading{"p95", "95th percentile of the time of a frame [ms]",
                [](Seen s) { return s.history.p95Total(); }},
        Reading{"worst", "longest time of a frame [ms]",
                [](Seen s) { return s.history.worstTotal(); }},
        Reading{"millisecondsBefore",
                "median time of a frame with the broadphase before the last change [ms]",
                [](Seen s) { return formerOf(s).history.medianTotal(); }},
        Reading{"eyeX", "x of the camera [m]", [](Seen s) { return s.pose().eye.x(); }},
        Reading{"eyeY", "y of the camera [m]", [](Seen s) { return s.pose().eye.y(); }},
        Reading{"eyeZ", "z of the camera [m]", [](Seen s) { return s.pose().eye.z(); }},
        Reading{"dragging", "1 while a rectangle is drawn, else 0",
                [](Seen s) { return s.rectangle.has_value(); }},
        Reading{"dots", "smallest radius that a body is drawn with [pixels]",
                [](Seen s) { return s.options.dots; }},
        Reading{"dark", "1 with the dark theme, else 0",
                [](Seen s) { return s.options.theme == Theme::dark; }},
        Reading{"panel", "1 while the panel is shown, else 0",
                [](Seen s) { return s.options.panel; }},
        Reading{"help", "1 while the list of keys is shown, else 0",
                [](Seen s) { return s.options.help; }},
        Reading{"width", "width of the picture [pixels]", [](Seen s) { return s.width; }},
        Reading{"height", "height of the picture [pixels]", [](Seen s) { return s.height; }},
        // So much of it as a double holds.
        Reading{"hash", "hash of all positions and agent colours since the scene began",
                [](Seen s) { return s.hash() >> 12; }},
    };
    return kReadings;
}

double Session::reading(std::string_view name) const {
    return rowNamed("reading", name, readings()).read(*this);
}

}  // namespace hashphase::demos
