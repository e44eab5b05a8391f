// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/benchmark_command.hpp>

#include <demos/console/format.hpp>
#include <demos/experiment/findings.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>
#include <demos/system/interruption.hpp>

#include <algorithm>
#include <ostream>

namespace hashphase::benchmarks {
namespace {

using demos::valueText;

constexpr std::string_view kCaseDeclaration =
#include <tests/benchmarks/case.sql>
    ;
constexpr std::string_view kSummaryDeclaration =
#include <tests/benchmarks/summary.sql>
    ;

}  // namespace

void printSetting(const BenchmarkReport& report, const std::vector<ContestantKind>& kinds,
                  std::ostream& out) {
    demos::printProvenance(report.provenance, out);
    out << "Our compiler flags: " << report.provenance.compilerFlags << '\n';
    for (const ContestantKind& kind : kinds) {
        out << "  " << kind.name
            << std::string(16 - std::min<std::size_t>(kind.name.size(), 15), ' ') << kind.title
            << " (" << kind.package << ")\n";
    }
    if (report.options.quick) {
        out << "QUICK: few objects and frames, so the times mean nothing.\n";
    }
    out << '\n'
        << report.settings.frames << " different frames"
        << (report.options.frames || report.options.quick
                ? ""
                : " (" + std::to_string(MeasurementSettings::kFramesOfSmall) + " up to " +
                      demos::withThousands(MeasurementSettings::kSmall) + " objects)")
        << " after " << report.settings.warmUpFrames
        << " to warm up, the contestants in turn in each; seed " << report.options.seed << ".\n"
        << "Times: median (5th-95th percentile). Answers, missing, extra and twice: mean of a "
           "frame.\nHeap: bytes per object. Own: bytes per object + per pair, as the broadphase "
           "reports them.\n\n";
}

void printCase(BenchmarkReport& report, std::int64_t number, std::ostream& out) {
    static_cast<void>(demos::findingsOf(kCaseDeclaration, report.measured));
    const auto ask = [&](std::string_view sql) {
        return report.measured.ask(sql, {{"case", number}});
    };
    const demos::DataTable outcome = ask(
        "SELECT name || ': ' || description, operation, frames_done, frames_done < frames_asked "
        "FROM outcomes WHERE \"case\" = :case");
    const std::vector<demos::Value>& row = outcome.rows.at(0);
    out << valueText(row[0]) << '\n';
    if (row[3] == demos::Value(1.0)) {
        out << report.stopped << " after " << valueText(row[2]) << " frames.\n";
    }
    demos::DataTable table = ask(
        "SELECT contestant, \"ms a frame\", ns, \"/ dbvt\", answers, missing, extra, twice, heap, "
        "own FROM case_tables WHERE \"case\" = :case");
    table.columns[2].title = "ns/" + valueText(row[1]);
    printTable(table, out);
    for (const std::vector<demos::Value>& fault :
         ask("SELECT 'WRONG: ''' || contestant || ''' ' || first_fault FROM case_tables "
             "WHERE \"case\" = :case AND ours AND first_fault IS NOT NULL")
             .rows) {
        out << valueText(fault[0]) << '\n';
    }
    out << std::endl;
}

bool printSummary(BenchmarkReport& report, std::ostream& out) {
    const demos::Findings findings = demos::findingsOf(kSummaryDeclaration, report.measured);
    for (const auto& [caption, table] : findings.printed) {
        if (!table.rows.empty()) {
            out << caption << "\n\n";
            printTable(table, out);
            out << '\n';
        }
    }
    for (const std::string& sentence : findings.conclusions) {
        out << sentence << '\n';
    }
    const std::size_t done = report.measured.ask("SELECT * FROM cases").rows.size();
    if (done < report.casesAsked) {
        out << report.stopped << ": " << report.casesAsked - done << " of " << report.casesAsked
            << " cases are left out.\n";
    }
    if (const std::string overload = demos::overloadSentence(report.provenance);
        !overload.empty()) {
        out << overload << '\n';
    }
    out << findings.verdict << '\n';
    return findings.holds == true;
}

void writeJson(BenchmarkReport& report, std::ostream& out) {
    using demos::Json;
    Json cases = Json::array();
    bool areExact = true;
    for (const std::vector<demos::Value>& row :
         report.measured.ask("SELECT json FROM case_json").rows) {
        cases.push_back(Json::parse(std::get<std::string>(row[0])));
        areExact = areExact && cases.back()["oursExact"] == true;
    }
    Json json{{"schema", "hashphase-benchmarks"},
              {"schemaVersion", 1},
              {"provenance", demos::provenanceJson(report.provenance)},
              {"settings",
               {{"frames", report.settings.frames},
                {"warmUpFrames", report.settings.warmUpFrames},
                {"seed", report.options.seed},
                {"quick", report.options.quick},
                {"timeLimitSeconds", demos::orNull(report.options.timeLimit)}}},
              {"ratios", "median over the frames of the ratio of both times in the same frame"},
              {"verdict",
               {{"oursExact", areExact},
                {"casesAsked", report.casesAsked},
                {"casesDone", cases.size()},
                {"interrupted", demos::isInterrupted()}}}};
    json["cases"] = std::move(cases);
    out << json.dump(1) << '\n';
}

}  // namespace hashphase::benchmarks
