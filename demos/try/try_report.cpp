// SPDX-License-Identifier: Zlib
#include <demos/try/try_report.hpp>

#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>

#include <ostream>
#include <utility>

namespace hashphase::demos {
namespace {

using tryout::StepRow;

constexpr std::string_view kTryDeclaration =
#include <demos/try/try.sql>
    ;

const char* nameOf(tryout::Broadphase broadphase) {
    return broadphase == tryout::Broadphase::stock  ? "bullet"
           : broadphase == tryout::Broadphase::hash ? "hashphase"
                                                    : "verified";
}

Datum orNothing(bool isKnown, auto figure) {
    return isKnown ? Datum(figure) : Datum();
}

Datum orNothing(const std::string& text) {
    return text.empty() ? Datum() : Datum(text);
}

// --- What was measured ---------------------------------------------------------------------------

void addStep(std::size_t run, const StepRow& row, Measurements& measured) {
    measured.add(
        "steps",
        {{"run", run},
         {"stepMs", orNothing(row.isStep != 0, row.step.wall)},
         {"stepProcessorMs", orNothing(row.isStep != 0, row.step.processor)},
         {"allThreadsMs", orNothing(row.allProcessor != StepRow::kNotTaken, row.allProcessor)},
         {"updateAabbsMs", row.updateAabbs.wall},
         {"updateAabbsProcessorMs", row.updateAabbs.processor},
         {"calculateMs", row.calculate.wall},
         {"calculateProcessorMs", row.calculate.processor},
         {"narrowPhaseMs", row.narrowPhase.wall},
         {"narrowPhaseProcessorMs", row.narrowPhase.processor},
         {"raysMs", row.rays},
         {"rays", row.rayCount},
         {"raysBetweenMs", row.raysBetween},
         {"raysBetween", row.rayBetweenCount},
         {"objects", row.objectCount},
         {"calculations", row.calculations},
         {"pairs", row.pairCount},
         {"overlappingPairs",
          orNothing(row.truePairCount != StepRow::kNotCounted, row.truePairCount)}});
}

void addRun(std::size_t number, const TriedRun& run, Measurements& measured) {
    Record record{{"run", number},
                  {"broadphase", nameOf(run.broadphase)},
                  {"ended", run.end.text},
                  {"isCrash", run.end.isCrash},
                  {"hasBroadphase", run.hasBroadphase()},
                  {"dbvts", run.counts.dbvts},
                  {"axisSweeps", run.counts.axisSweeps},
                  {"derivedSweeps", run.counts.derivedSweeps},
                  {"droppedSteps", run.droppedRows},
                  {"foreignCalculations", run.counts.foreignCalculations},
                  {"otherProcesses", run.counts.otherProcesses},
                  {"firstFault", orNothing(run.verification.firstFault.data())}};
    for (const tryout::VerifiedCount& each : tryout::kVerifiedCounts) {
        record.emplace_back(each.name, run.verification.*each.count);
    }
    measured.add("runs", record);
    for (const StepRow& row : run.rows) {
        addStep(number, row, measured);
    }
}

void printLines(const DataTable& lines, std::ostream& out) {
    for (const std::string& line : sentencesOf(lines)) {
        out << line << '\n';
    }
}

void printUnlessEmpty(const DataTable& table, std::ostream& out) {
    if (!table.rows.empty()) {
        printTable(table, out);
    }
}

}  // namespace

TrialReport reportOf(const Trial& trial) {
    TrialReport report;
    report.provenance = trial.provenance;
    Measurements& measured = report.measured;
    measured.add("trial", {{"program", trial.commandLine},
                           {"precision", trial.program.precision},
                           {"bullet", orNothing(trial.program.bullet)},
                           {"overload", orNothing(overloadText(trial.provenance))},
                           {"room", tryout::Record::kMaxRows}});
    addStep(0, {}, measured);  // of no run: the table is there, too, where none has made one
    for (std::size_t i = 0; i < trial.runs.size(); ++i) {
        addRun(i + 1, trial.runs[i], measured);
    }
    report.findings = findingsOf(kTryDeclaration, measured);
    return report;
}

void printTrial(const TrialReport& report, std::ostream& out) {
    const auto& rows = report.findings.rows;
    out << report.findings.verdict << "\n\n";
    printUnlessEmpty(rows.at("compared steps"), out);
    printLines(rows.at("comparison"), out);
    printUnlessEmpty(rows.at("verified pairs"), out);
    printLines(rows.at("verification"), out);
}

void writeTrialJson(TrialReport& report, std::ostream& out) {
    const auto json = [&](const char* rows) { return rowsJson(report.findings.rows.at(rows)); };
    Json runs = json("runs");
    for (Json& run : runs) {
        run["steps"] = Json::array();
    }
    for (Json& step : rowsJson(report.measured.ask("SELECT * FROM steps WHERE run > 0"))) {
        Json& steps = runs[step["run"].get<std::size_t>() - 1]["steps"];
        step.erase("run");
        steps.push_back(std::move(step));
    }
    const Json trial = json("trial").front();
    const Json means = json("means");
    const Json verified = json("verified");
    out << textOf(Json{{"format", "hashphase-try"},
                       {"version", 2},
                       {"provenance", provenanceJson(report.provenance)},
                       {"program", trial["program"]},
                       {"bullet", trial["bullet"]},
                       {"precision", trial["precision"]},
                       {"clock", trial["clock"]},
                       {"bulletStep", means.empty() ? Json() : means[0]},
                       {"hashphaseStep", means.empty() ? Json() : means[1]},
                       {"projectedStepMs", trial["projectedStepMs"]},
                       {"verification", verified.empty() ? Json() : verified[0]},
                       {"runs", std::move(runs)}});
}

}  // namespace hashphase::demos
