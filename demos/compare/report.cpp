// SPDX-License-Identifier: Zlib
#include <demos/compare/report.hpp>

#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>

#include <algorithm>
#include <ostream>

namespace hashphase::demos {
namespace {

constexpr std::string_view kCompareDeclaration =
#include <demos/compare/compare.sql>
    ;

constexpr const char* kIntroduction =
    "A broadphase finds the pairs of bodies whose bounding boxes overlap. This page compares "
    "hashphase, a spatial hash for the Bullet physics engine, with Bullet's own broadphases in one "
    "scene. Did each broadphase list exactly the overlapping pairs, in every frame? How long did "
    "it "
    "take? All broadphases ran the same frames, in turn within each frame.";

}  // namespace

Findings compareFindings(Measurements& measured) {
    return findingsOf(kCompareDeclaration, measured);
}

void printReport(const CompareReport& report, bool isVerbose, const Console& console) {
    const auto& rows = report.findings.rows;
    const auto print = [&](const char* sentences) {
        printSentences(sentencesOf(rows.at(sentences)), console);
    };
    print("setting");
    printProvenance(report.provenance, console);
    print("stopped");
    print("left out");
    console.out << '\n';
    print(isVerbose ? "explanation" : "short explanation");
    console.out << '\n';
    printTable(withoutEmptyColumns(rows.at(isVerbose ? "table" : "short table")), console.out);
    if (const char* steps = isVerbose ? "step sentences" : "step gains";
        !rows.at(steps).rows.empty()) {
        console.out << '\n';
        print(steps);
    }
    if (const auto& steps = rows.at("step table"); isVerbose && !steps.rows.empty()) {
        console.out << '\n';
        printTable(steps, console.out);
    }
    console.out << '\n';
    printVerdict(report.findings.verdict, console);
}

void writeJson(const CompareReport& report, std::ostream& out) {
    const auto& rows = report.findings.rows;
    Json broadphases = rowsJson(rows.at("broadphases"));
    const auto addToEach = [&](const char* member, const char* theirRows) {
        for (Json& broadphase : broadphases) {
            broadphase[member] = Json::array();
        }
        for (Json& row : rowsJson(rows.at(theirRows))) {
            const auto owner = std::ranges::find_if(
                broadphases, [&row](const Json& each) { return each["name"] == row["name"]; });
            row.erase("name");
            (*owner)[member].push_back(std::move(row));
        }
    };
    addToEach("stepParts", "step parts");
    addToEach("frames", "frames");
    out << textOf(Json{{"schema", "hashphase-compare"},
                       {"schemaVersion", 1},
                       {"provenance", provenanceJson(report.provenance)},
                       {"settings", rowsJson(rows.at("settings")).front()},
                       {"verdict", rowsJson(rows.at("end")).front()},
                       {"broadphases", std::move(broadphases)}});
}

Page pageOf(const CompareReport& report) {
    const Findings& findings = report.findings;
    Page page{"Broadphases compared: " + report.scene,
              kIntroduction,
              findings.verdict + ".",
              findings.holds,
              findings.sections,
              report.provenance};
    for (const std::string& sentence : sentencesOf(findings.rows.at("stopped"))) {
        page.verdict += " " + sentence;
    }
    DataTable& times = page.sections.at(1).tables.at(0);
    times = withoutEmptyColumns(times);
    if (report.wasAnythingTimed) {
        PageSection drawn;
        drawn.heading = "The times, drawn";
        drawn.charts = findings.charts;
        page.sections.push_back(std::move(drawn));
    }
    if (report.replay) {
        addReplayTab(*report.replay, static_cast<std::size_t>(report.framesDone), page);
    }
    return page;
}

}  // namespace hashphase::demos
