// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/report.hpp>

#include <demos/report/json_values.hpp>
#include <tests/benchmarks/cell_size.hpp>
#include <tests/benchmarks/effects_overhead.hpp>

#include <ostream>

namespace hashphase::benchmarks {
namespace {

using demos::Json;
using demos::orNull;

Json tallyJson(const AnswerTally& tally) {
    return {{"framesChecked", tally.framesChecked},
            {"answers", tally.answers},
            {"exact", tally.exact},
            {"missing", tally.missing},
            {"extra", tally.extra},
            {"duplicates", tally.duplicates}};
}

Json memoryJson(const Memory& memory) {
    return {{"heapBytes", orNull(memory.heapBytes)},
            {"ownBytesForObjects", memory.own ? Json(memory.own->forObjects) : Json(nullptr)},
            {"ownBytesForPairs", memory.own ? Json(memory.own->forPairs) : Json(nullptr)}};
}

Json contestantJson(const CaseResult& result, const ContestantResult& contestant) {
    const std::optional<demos::Spread> spread = contestant.spread();
    Json perOperation;
    if (spread && result.operations > 0) {
        perOperation = spread->median * 1e6 / static_cast<double>(result.operations);
    }
    return {{"name", contestant.kind.name},
            {"title", contestant.kind.title},
            {"package", contestant.kind.package},
            {"ours", contestant.kind.ours},
            {"fillMs", contestant.fillMs},
            {"ms", demos::spreadJson(spread)},
            {"nsPerOperation", perOperation},
            {"speedAgainstDbvt", orNull(speedAgainst(result.find(kBaseline), contestant))},
            {"droppedOut", contestant.droppedOut},
            {"answers", tallyJson(contestant.tally)},
            {"firstFault", orNull(contestant.firstFault)},
            {"memory", memoryJson(contestant.memory)},
            {"frameMs", contestant.frameMs}};
}

Json regretJson(const CaseResult& result) {
    const std::optional<CellSizeRegret> regret = cellSizeRegret(result);
    if (!regret) {
        return nullptr;
    }
    return {{"regret", regret->regret}, {"bestFixed", regret->bestFixed}};
}

Json overheadsJson(const CaseResult& result) {
    Json json = Json::array();
    for (const EffectsOverhead& overhead : effectsOverheads(result)) {
        json.push_back({{"contestant", overhead.contestant},
                        {"ratio", demos::spreadJson(overhead.ratio)},
                        {"bound", orNull(overhead.bound)},
                        {"holds", overhead.holds()}});
    }
    return json;
}

Json caseJson(const CaseResult& result) {
    Json json{{"name", result.name},
              {"group", result.group},
              {"description", result.description},
              {"objects", result.objects},
              {"operation", result.operation},
              {"operationsPerFrame", result.operations},
              {"warmUpFrames", result.warmUpFrames},
              {"framesDone", result.framesDone},
              {"timeLimitHit", result.timeLimitHit},
              {"oursExact", result.oursWereExact()},
              {"cellSizeRegret", regretJson(result)},
              {"effectsOverheads", overheadsJson(result)},
              {"contestants", Json::array()}};
    for (const ContestantResult& contestant : result.contestants) {
        json["contestants"].push_back(contestantJson(result, contestant));
    }
    return json;
}

}  // namespace

void writeJson(const BenchmarkReport& report, std::ostream& out) {
    Json json{{"schema", "hashphase-benchmarks"},
              {"schemaVersion", 1},
              {"provenance", demos::provenanceJson(report.provenance)},
              {"settings",
               {{"frames", report.settings.frames},
                {"warmUpFrames", report.settings.warmUpFrames},
                {"seed", report.options.seed},
                {"quick", report.options.quick},
                {"timeLimitSeconds", orNull(report.options.timeLimit)}}},
              {"ratios", "median over the frames of the ratio of both times in the same frame"},
              {"verdict",
               {{"oursExact", oursWereExact(report)},
                {"casesAsked", report.casesAsked},
                {"casesDone", report.cases.size()}}},
              {"cases", Json::array()}};
    for (const CaseResult& result : report.cases) {
        json["cases"].push_back(caseJson(result));
    }
    out << json.dump(1) << '\n';
}

}  // namespace hashphase::benchmarks
