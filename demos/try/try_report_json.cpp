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

Json runJson(const TriedRun& run) {
    Json rows = Json::array();
    for (const StepRow& row : run.rows) {
        const bool isStep = row.isStep != 0;
        rows.push_back(
            {{"stepMs", isStep ? Json(row.step.wall) : Json(nullptr)},
             {"stepProcessorMs", isStep ? Json(row.step.processor) : Json(nullptr)},
             {"allThreadsMs",
              row.allProcessor != StepRow::kNotTaken ? Json(row.allProcessor) : Json(nullptr)},
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
             {"overlappingPairs", row.truePairCount != StepRow::kNotCounted
                                      ? Json(row.truePairCount)
                                      : Json(nullptr)}});
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
            {"stepWallMs", summary.step ? Json(summary.stepOnWall) : Json(nullptr)},
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
    const tryout::Verification& pairs = run.verification;
    return {{"calculations", pairs.calculations},
            {"pairs", pairs.pairs},
            {"missing", pairs.missing},
            {"extra", pairs.extra},
            {"waitForAMove", pairs.unasked},
            {"removedByProgram", pairs.removed},
            {"notJudged", pairs.late},
            {"bulletPairs", pairs.stockPairs},
            {"bulletMissing", pairs.stockMissing},
            {"bulletExtra", pairs.stockExtra},
            {"firstFault", orNull(std::string(pairs.firstFault.data()))}};
}

}  // namespace

void writeTrialJson(const Trial& trial, std::ostream& out) {
    Json json{
        {"format", "hashphase-try"},
        {"version", 2},
        {"provenance", provenanceJson(trial.provenance)},
        {"program", trial.commandLine},
        {"bullet", orNull(trial.program.bullet)},
        {"precision", trial.program.precision == BulletPrecision::kSingle ? "single" : "double"}};
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
