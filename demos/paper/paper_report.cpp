// SPDX-License-Identifier: Zlib
#include <demos/paper/paper.hpp>

#include <demos/console/columns.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>
#include <demos/system/interruption.hpp>

#include <ostream>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr std::string_view kPaperDeclaration =
#include <demos/paper/paper.sql>
    ;

constexpr const char* kPaperIntroduction =
    "Hastings, Mesit and Guha, \"Optimization of Large-Scale, Real-Time Simulations by Spatial "
    "Hashing\", timed three phases of a simulation of spheres that roam a terrain. This page "
    "compares "
    "their printed figures with the same methods on this machine, and with hashphase, a spatial "
    "hash that replaces the broadphase of the Bullet physics engine.";

/// The first two columns stand in one.
void printGraded(const GradedTable& table, const TableStyle& style, std::ostream& out) {
    if (table.rows.empty()) {
        return;
    }
    DataTable text{{{table.header[0]}}, {}};
    for (std::size_t column = 2; column < table.header.size(); ++column) {
        text.columns.push_back({table.header[column]});
    }
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const std::vector<GradedText>& row = table.rows[i];
        constexpr std::size_t kObjectsWidth = 9;
        const bool isFirst = i == 0 || table.rows[i - 1][0].text != row[0].text;
        std::string first = isFirst ? row[0].text : "";
        first.resize(kObjectsWidth, ' ');
        std::vector<Value> cells{first + " " + row[1].text};
        for (std::size_t column = 2; column < row.size(); ++column) {
            cells.emplace_back(row[column].marked());
        }
        text.add(std::move(cells));
    }
    out << table.caption << '\n';
    printTable(text, out, style);
    out << '\n';
}

}  // namespace

PaperReport::PaperReport(PaperPlan itsPlan, Measurements itsMeasured, Provenance itsProvenance)
    : plan(std::move(itsPlan)),
      measured(std::move(itsMeasured)),
      provenance(std::move(itsProvenance)),
      findings(findingsOf(kPaperDeclaration, measured)) {}

int exitCodeOf(const PaperReport& report) {
    return report.findings.holds == true ? kExitOk : kExitCheckFailed;
}

void printReport(PaperReport& report, bool showMilliseconds, const Console& console) {
    const auto print = [&](std::string_view sql) {
        printSentences(sentencesOf(report.measured.ask(sql)), console);
    };
    const TableStyle style{.columns = lineWidth(console)};
    std::ostream& out = console.out;
    printSentences(
        {"The figures of Hastings, Mesit and Guha: as printed (Pentium 4, 3.2 GHz), and on "
         "this machine. \"!\" is too slow for real time, below 20 frames a second; \"~\" is "
         "below 60.\n"},
        console);
    for (const PageSection& section : report.findings.sections) {
        if (!section.graded.empty()) {
            printGraded(section.graded[showMilliseconds ? 1 : 0], style, out);
        }
    }
    for (const auto& [caption, table] : report.findings.printed) {
        if (!table.rows.empty()) {
            printSentences({caption}, console);
            printTable(table, out, style);
            out << '\n';
        }
    }
    print("SELECT sentence FROM observations");
    out << '\n';
    print("SELECT sentence FROM how_it_was_measured");
    print("SELECT 'Left out: ' || what FROM all_left_out");
    out << '\n';
    print(
        "SELECT CASE holds WHEN 1 THEN 'holds' WHEN 0 THEN 'BROKEN' ELSE 'not checked' END || ': ' "
        "|| claim || ' (' || evidence || ')' FROM claims");
    printProvenance(report.provenance, console);
    if (isInterrupted()) {
        printSentences({interruptionText()}, console);
    }
    out << '\n';
    printVerdict(report.findings.verdict, console);
    print("SELECT sentence FROM real_time_sentences");
}

void writeJson(PaperReport& report, std::ostream& out) {
    const PaperPlan& plan = report.plan;
    const auto sentences = [&](std::string_view sql) {
        return sentencesOf(report.measured.ask(sql));
    };
    Json json{{"schema", "hashphase-paper"},
              {"schemaVersion", 1},
              {"provenance", provenanceJson(report.provenance)},
              {"settings",
               {{"objects", plan.objects},
                {"seed", plan.seed},
                {"aiRadius", plan.aiRadius},
                {"frames", plan.effort.frames},
                {"fewestFrames", plan.effort.fewestFrames}}},
              {"realTime", Json::parse(sentences("SELECT json FROM real_time_json").at(0))},
              {"leftOut", sentences("SELECT what FROM all_left_out")},
              {"howItWasMeasured", sentences("SELECT sentence FROM how_it_was_measured")}};
    const auto rows = [&](std::string_view sql) { return rowsJson(report.measured.ask(sql)); };
    json["checks"] = rows("SELECT claim, holds AS \"holds?\", evidence FROM claims");
    json["measurements"] = rows("SELECT * FROM measurements");
    json["neighboursByRadius"] = Json::array();
    for (const Json& row : rows("SELECT neighbours FROM neighbours")) {
        json["neighboursByRadius"].push_back(row["neighbours"]);
    }
    json["boundingVolumes"] = rowsJson(report.findings.printed.back().second);
    out << textOf(json);
}

void writeCsv(PaperReport& report, std::ostream& out) {
    writeCsv(report.measured.ask("SELECT * FROM measurements"), out);
}

Page pageOf(const PaperReport& report) {
    const Findings& findings = report.findings;
    return {"The paper's figures, then and today",
            kPaperIntroduction,
            findings.verdict + "." + (isInterrupted() ? " " + interruptionText() : ""),
            findings.holds,
            findings.sections,
            report.provenance};
}

}  // namespace hashphase::demos
