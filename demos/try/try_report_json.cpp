// SPDX-License-Identifier: Zlib
#include <demos/try/try_report.hpp>

#include <demos/report/json_values.hpp>

#include <ostream>
#include <utility>

namespace hashphase::demos {
namespace {

using tryout::Broadphase;
using tryout::StepRow;

const char* jsonName(Broadphase broadphase) {
    return broadphase == Broadphase::stock  ? "bullet"
           : broadphase == Broadphase::hash ? "hashphase"
                                            : "verified";
}

Json nullUnless(bool isKnown, auto figure) {
    return isKnown ? Json(figure) : Json(nullptr);
}

Json runJson(const TriedRun& run) {
    Json rows = Json::array();
    for (const StepRow& row : run.rows) {
        rows.push_back(
            {{"stepMs", nullUnless(row.isStep != 0, row.step.wall)},
             {"stepProcessorMs", nullUnless(row.isStep != 0, row.step.processor)},
             {"allThreadsMs", nullUnless(row.allProcessor != StepRow::kNotTaken, row.allProcessor)},
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
              nullUnless(row.truePairCount != StepRow::kNotCounted, row.truePairCount)}});
    }
    return {{"broadphase", jsonName(run.broadphase)},
            {"ended", textOf(run.end)},
            {"dbvts", run.dbvtCount},
            {"axisSweeps", run.axisSweepCount},
            {"derivedSweeps", run.derivedSweepCount},
            {"droppedSteps", run.droppedRows},
            {"foreignCalculations", run.foreignCalculations},
            {"otherProcesses", run.otherProcesses},
            {"steps", std::move(rows)}};
}

Json summaryJson(const StepSummary& summary) {
    return {{"steps", summary.stepCount},
            {"updateAabbsMs", summary.updateAabbs},
            {"calculateMs", summary.calculate},
            {"raysMs", summary.rays},
            {"narrowPhaseMs", orNull(summary.narrowPhase)},
            {"stepMs", orNull(summary.step)},
            {"stepWallMs", nullUnless(summary.step.has_value(), summary.stepOnWall)},
            {"processorShare", summary.processorShare},
            {"rays", summary.rayCount},
            {"raysBetweenMs", summary.raysBetween},
            {"raysBetween", summary.rayBetweenCount},
            {"objects", summary.objectCount},
            {"pairs", summary.pairCount},
            {"overlappingPairs", orNull(summary.truePairCount)},
            {"stalePairs", orNull(summary.stalePairCount())}};
}

Json verifiedJson(const TriedRun& run) {
    if (run.broadphase != Broadphase::verifying) {
        return nullptr;
    }
    Json json;
    for (const tryout::VerifiedCount& each : tryout::kVerifiedCounts) {
        json[each.name] = run.verification.*each.count;
    }
    json["firstFault"] = orNull(std::string(run.verification.firstFault.data()));
    return json;
}

}  // namespace

void writeTrialJson(const Trial& trial, std::ostream& out) {
    Json json{{"format", "hashphase-try"},
              {"version", 2},
              {"provenance", provenanceJson(trial.provenance)},
              {"program", trial.commandLine},
              {"bullet", orNull(trial.program.bullet)},
              {"precision", nameOf(trial.program.precision)}};
    const std::optional<StepComparison> steps = compareSteps(trial);
    json["clock"] = !steps ? Json(nullptr) : Json(steps->onThreads ? "wall" : "processor");
    json["bulletStep"] = steps ? summaryJson(steps->stock) : Json(nullptr);
    json["hashphaseStep"] = steps ? summaryJson(steps->ours) : Json(nullptr);
    json["projectedStepMs"] =
        steps ? orNull(projectedStep(steps->stock, steps->ours)) : Json(nullptr);
    json["verification"] = verifiedJson(trial.runs.front());
    for (const TriedRun& run : trial.runs) {
        json["runs"].push_back(runJson(run));
    }
    out << textOf(json);
}

}  // namespace hashphase::demos
